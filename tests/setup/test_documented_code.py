"""What README and guide show runs: Python, commands and recipes, in a folder with files of the names used."""

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import tifffile
import typer.main

import regolith_studio
from regolith_studio.cli.commands import app
from regolith_studio.cli.entry import run
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.imaging.volume import sample_file
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs import repose_jobs
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.readers.particles import sample_particles
from regolith_studio.session.recipe import Recipe
from tests.dem.cone_engine import cone_engine, true_angle

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
INDENTED = re.compile(r"(?:^    regolith-studio .*\n)+", re.MULTILINE)
SPAN = re.compile(r"`regolith-studio ([a-z][^`]*)`")
ELSEWHERE = ("on_cluster", ">>> ", "simulate_repose")
"""Code that needs a cluster, and exercises and heaps, which are tested by themselves."""
SHORT = ("README.md",)
"""Pages whose commands are run, in the folder of the fixture."""
LONG = ("study", "demo", "run")


def blocks(kind: str) -> Iterator[tuple[str, str]]:
    for page in PAGES:
        content = page.read_text(encoding="utf-8")
        for language, text in BLOCK.findall(content):
            if language == kind:
                yield page.name, text
        if not kind:
            yield from ((page.name, text) for text in INDENTED.findall(content))


def commands() -> list[tuple[str, list[str]]]:
    """Page and words of every whole command in a block."""
    found = []
    for page, text in blocks(""):
        lines = (line.split("  #")[0].strip() for line in text.splitlines())
        found += [(page, shlex.split(line)[1:]) for line in lines if line.startswith("regolith-studio ")]
    return found


def spans() -> list[tuple[str, list[str]]]:
    """Page and words of every command in a sentence."""
    return [
        (page.name, shlex.split(words))
        for page in PAGES
        for words in SPAN.findall(page.read_text(encoding="utf-8"))
    ]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The files that the pages speak of."""
    grains = tmp_path / "grains"
    grains.mkdir()
    meshes = {each.name: each.mesh for each in sample_particles()[:2]}
    for name, mesh in meshes.items():
        (grains / f"{name}.stl").write_bytes(stl_bytes(mesh.triangles, name))
    first = next(iter(meshes.values()))
    (tmp_path / "grain.stl").write_bytes(stl_bytes(first.triangles, "grain"))
    (tmp_path / "grain.anm").write_text(table(fit_harmonics(first, l_max=4).coefficients.values))
    with h5py.File(tmp_path / "scan.h5", "w") as file:
        file["exported_data"] = np.zeros((256, 256, 256), dtype=np.uint8)
    (tmp_path / "pile.csv").write_text("x,y,z,d\n0,0,1,2\n3,0,1,2\n0,3,1,2\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def table(values: np.ndarray) -> str:
    """Lines ``l m Re Im`` of real orthonormal coefficients, as complex ones with the phase."""
    lines = []
    for degree in range(round(len(values) ** 0.5)):
        middle = degree * degree + degree
        for order in range(-degree, degree + 1):
            m = abs(order)
            cosine, sine = values[middle + m], values[middle - m] if m else 0.0
            number = complex(cosine, -sine) * (-1) ** m / (2**0.5 if m else 1.0)
            number = number if order >= 0 else (-1) ** m * number.conjugate()
            lines.append(f"{degree} {order} {number.real:.12g} {number.imag:.12g}")
    return "\n".join(lines) + "\n"


PYTHON = [(page, text) for page, text in blocks("python") if not any(word in text for word in ELSEWHERE)]


@pytest.mark.slow
@pytest.mark.parametrize(("page", "text"), PYTHON, ids=[f"{page}-{i}" for i, (page, _) in enumerate(PYTHON)])
@pytest.mark.usefixtures("here")
def test_that_the_python_of_the_pages_runs(page: str, text: str) -> None:
    if "FIT.json" in text:
        assert run(["fit", "grain.stl", "-o", "FIT.json", "--l-max", "4"]) == 0
    exec(compile(text, page, "exec"), {})


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_that_the_page_on_python_goes_from_a_scan_to_friction(
    here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All steps of the page for 2 virtual particles, and its heaps on an engine that makes cones."""
    monkeypatch.setattr(repose_jobs, "run_engine", cone_engine)
    slices = tifffile.imread(sample_file("grey"))
    tifffile.imwrite(here / "scan.tif", slices[: len(slices) // 2])
    [text] = [text for page, text in blocks("python") if page == "python.md"]
    [heaps] = [text for page, text in blocks("pycon") if page == "python.md"]
    names: dict[str, Any] = {}
    few = text.replace("rs.draw_particles(model, 20", "rs.draw_particles(model, 2")
    exec(compile(few, "python.md", "exec"), names)
    assert len(names["fits"]) == len(names["grains"]) > 5
    assert len(names["dataset"]) == 2
    friction = ReposeRequest().case.contact.static_friction
    assert names["run"].measurement.angle == pytest.approx(true_angle(friction), abs=2.0)
    names["rs"] = regolith_studio
    (here / "heap").rename(here / "first_heap")
    code = heaps.replace(">>> ", "").replace("... ", "").replace(", workers=4", "")
    code = "\n".join(line for line in code.splitlines() if "drum" not in line)  # the engine makes cones
    exec(compile(code, "python.md", "exec"), names)
    study = names["study"]
    assert study.values == (0.2, 0.4, 0.8)
    for value in study.values:
        assert np.mean(study.angles(value)) == pytest.approx(true_angle(value), abs=2.0)


@pytest.mark.slow
@pytest.mark.usefixtures("here")
def test_that_the_short_commands_of_the_pages_run_one_after_the_other() -> None:
    for page, words in commands():
        if (
            page in SHORT
            and not words[0].startswith(LONG)
            and " ".join(words[:2]) not in LONG
            and words[0] != "run"
        ):
            assert run(words) == 0, (page, words)


@pytest.mark.slow
@pytest.mark.usefixtures("here")
def test_that_a_study_and_a_pile_of_the_pages_run() -> None:
    assert run(["dataset", "build", "grains/", "-o", "dataset"]) == 0
    for page, told in commands():
        if page in SHORT and told[0] in ("study", "repose"):
            words = told
            if words[0] == "repose":
                words = [
                    *words[: words.index("--particles")],
                    "--particles",
                    "150",
                    "--coarse-graining",
                    "12",
                ]
            assert run(words) == 0, (page, words)


@pytest.mark.parametrize(
    ("page", "words"), [*commands(), *spans()], ids=lambda value: value if isinstance(value, str) else None
)
def test_that_every_command_of_the_pages_has_the_options_that_are_told(page: str, words: list[str]) -> None:
    command: Any = typer.main.get_command(app)
    rest = list(words)
    while hasattr(command, "commands") and rest and not rest[0].startswith("-"):
        name = rest.pop(0)
        assert name in command.commands, (page, name)
        command = command.commands[name]
    options = {option for each in command.params for option in (*each.opts, *each.secondary_opts)}
    known = options | {"-h", "--help", "--version"}
    given = {word.split("=")[0] for word in rest if re.match(r"--?[a-z]", word)}
    assert given <= known, page


def test_that_the_recipes_of_the_guide_are_recipes() -> None:
    texts = [text for _, text in blocks("json")]
    assert len(texts) >= 2
    for text in texts:
        Recipe.model_validate_json(text)
