"""What is copied out of the window runs, and does what the window did."""

import json
import shlex
from pathlib import Path

import pytest

from regolith_studio.cli.entry import run
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.resources import SAMPLE, resource
from regolith_studio.session.choices import Choices
from regolith_studio.session.code_export import as_command, as_python
from regolith_studio.session.project import Project, input_shown, inputs_of, read_project, without_file
from regolith_studio.session.session import Session

CHOICES = Choices(method="quadric", target="fit", level=2, l_max=4, n_facets=14, seed=3)


@pytest.fixture
def grain(tmp_path: Path) -> Path:
    path = tmp_path / "a grain.stl"
    path.write_bytes(stl_bytes(icosphere(3).moved(scale=12.0).triangles, "test"))
    return path


@pytest.fixture
def session(grain: Path) -> Session:
    made = Session(InlineRunner(), CHOICES)
    made.open([grain])
    return made


def test_that_the_copied_script_finds_the_polyhedron_of_the_window(session: Session) -> None:
    session.choose(star_point="kernel_centre", reference="ellipsoid")
    names: dict[str, object] = {}
    exec(as_python(session.choices, input_shown(session)), names)
    done, shown = names["done"], session.results.coarsened
    assert shown is not None
    assert done.loss == pytest.approx(shown.loss, rel=1e-9)  # type: ignore[attr-defined]
    assert done.n_facets == shown.n_facets  # type: ignore[attr-defined]


def test_that_the_script_of_the_sample_and_of_the_bare_particle_compile() -> None:
    for choices in (CHOICES, CHOICES.replaced(target="particle")):
        compile(as_python(choices, SAMPLE), "copied", "exec")


@pytest.mark.slow
def test_that_the_copied_command_is_understood_and_coarsens(
    session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    weights = session.choices.weights.replaced(volume=0.5)
    session.choose(weights=weights, star_point="kernel_centre", level=4)  # the window's and the command's
    words = shlex.split(as_command(session.choices, inputs_of(session)))
    assert words[0] == "regolith-studio"
    monkeypatch.chdir(tmp_path)
    assert run(words[1:]) == 0
    assert (tmp_path / "coarsened" / "a grain.stl").exists()
    document = json.loads((tmp_path / "coarsened" / "coarsening.json").read_text())
    shown = session.results.coarsened
    assert shown is not None
    (row,) = document["particles"] if isinstance(document, dict) else document
    assert row["errors"] == pytest.approx(dict(shown.errors), abs=1e-9)


@pytest.mark.slow
def test_that_the_command_that_is_copied_for_the_shipped_particles_coarsens_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    words = shlex.split(as_command(CHOICES.replaced(target="particle"), [SAMPLE]))
    assert run(words[1:]) == 0
    names = {path.name for path in (tmp_path / "coarsened").glob("*.stl")}
    assert names == {path.name for path in resource("samples", "particles").glob("*.stl")}


@pytest.mark.parametrize(
    "criterion",
    [
        {"stop_at": "triangles", "n_triangles": 59},
        {"stop_at": "vertices", "n_vertices": 31},
        {"stop_at": "error", "largest_error": 0.035},
    ],
)
@pytest.mark.slow
def test_that_what_is_copied_stops_where_the_window_does(
    session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, criterion: dict[str, object]
) -> None:
    weights = LossWeights.of(volume=1.0, max_diameter=1.0).keeping(["volume"])
    session.choose(method="exact", weights=weights, target="particle", **criterion)
    shown = session.results.coarsened
    assert shown is not None
    names: dict[str, object] = {}
    exec(as_python(session.choices, input_shown(session)), names)
    monkeypatch.chdir(tmp_path)
    assert run(shlex.split(as_command(session.choices, inputs_of(session)))[1:]) == 0
    (row,) = json.loads((tmp_path / "coarsened" / "coarsening.json").read_text())["particles"]
    for errors in (names["done"].errors, row["errors"]):  # type: ignore[attr-defined]
        assert errors == pytest.approx(dict(shown.errors), abs=1e-12)
    assert row["n_facets"] == shown.n_facets


def test_that_the_copied_script_takes_the_particle_on_screen() -> None:
    session = Session(InlineRunner(), CHOICES)
    session.open_sample()
    session.select("angular-2")
    names: dict[str, object] = {}
    exec(as_python(session.choices, input_shown(session)), names)
    shown = session.results.coarsened
    assert shown is not None
    assert names["particle"].name == "angular-2"  # type: ignore[attr-defined]
    assert names["done"].errors == pytest.approx(dict(shown.errors), abs=1e-9)  # type: ignore[attr-defined]


def test_that_a_project_brings_back_particles_choices_and_pages(session: Session, tmp_path: Path) -> None:
    session.choose(n_facets=11, l_max=3)
    Project.of(session, "sample", {"sample": {"filter": "S<1"}}).save(tmp_path / "work.regolith")
    again = Session(InlineRunner())
    project = read_project(tmp_path / "work.regolith")
    project.open_in(again, tmp_path)
    assert again.choices == session.choices
    assert [entry.id for entry in again.particles] == ["a grain"]
    assert (project.page, project.pages) == ("sample", {"sample": {"filter": "S<1"}})


def test_that_a_project_says_what_it_cannot_bring_back(session: Session) -> None:
    assert without_file(session) == []
    particle = session.particles[0].particle
    session.adopt([type(particle)("virtual", particle.mesh)], add=True)
    assert without_file(session) == ["virtual"]
    assert inputs_of(session) == [session.particles[0].particle.source.path]  # type: ignore[union-attr]


def test_that_what_is_no_project_is_refused_in_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "work.regolith"
    for text in ("", "{}x", '{"format": "something else"}', '{"recipe": {"l_max": "ten"}}'):
        path.write_text(text)
        with pytest.raises(Exception, match="is not a project"):
            read_project(path)
    with pytest.raises(Exception, match="cannot be opened"):
        read_project(tmp_path / "nowhere.regolith")


def test_that_what_is_copied_leaves_meshes_as_they_are_where_the_window_does(session: Session) -> None:
    assert "repair" not in as_command(session.choices, ["a.stl"]) + as_python(session.choices, "a.stl")
    session.choose(repair=False)
    assert "--no-repair" in shlex.split(as_command(session.choices, ["a.stl"]))
    assert "read_mesh('a.stl', unit='um', repair=False)" in as_python(session.choices, "a.stl")
