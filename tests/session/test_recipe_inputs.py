"""Recipes that begin with volumes, fitted models, tables of coefficients or a sample to draw like."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError, RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.events import Progress, Started
from regolith_studio.jobs.extraction_jobs import extract_file
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.readers.particles import read_mesh
from regolith_studio.resources import resource
from regolith_studio.session.recipe import recipe_of
from regolith_studio.session.run_recipe import run_recipe
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import write_model
from regolith_studio.steps import result_of
from tests.files import contents

BASE: dict[str, Any] = {"method": "quadric", "level": 2, "l_max": 4, "n_facets": 12, "target": "particle"}
GREY = str(resource("samples", "ct", "synthetic-grey.tif"))


def run(folder: Path, resume: bool = False, workers: int = 1, **entries: Any) -> Any:
    return result_of(run_recipe(recipe_of(**{**BASE, **entries}), folder.parent, folder, workers, resume))


def described(folder: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((folder / "descriptors.json").read_text())
    return found


def test_that_tables_of_a_recipe_are_cut_at_the_degree_of_their_entry(tmp_path: Path) -> None:
    text = "\n".join(
        f"{n} {m} {20.0 if n == 0 else 1.0 if abs(m) == n == 2 else 0.3 * (m == 0)} 0"
        for n in range(9)
        for m in range(-n, n + 1)
    )
    (tmp_path / "grain.anm").write_text(text)
    entry = {"files": ["grain.anm"], "unit": "um"}
    for name, given in (("whole", entry), ("cut", {**entry, "l_max": 3})):
        run(tmp_path / name, inputs=[given])
    areas = [described(tmp_path / name)[0]["surface_area"] for name in ("whole", "cut")]
    wanted = [read_mesh(tmp_path / "grain.anm", l_max=degree).mesh.surface_area for degree in (None, 3)]
    assert areas == pytest.approx(wanted, rel=1e-9)
    assert areas[1] < 0.99 * areas[0]


@pytest.fixture
def grains(tmp_path: Path) -> Path:
    """Six bumpy ellipsoids of 10 to 30 micrometres."""
    folder = tmp_path / "grains"
    folder.mkdir()
    sphere = icosphere(3)
    for index in range(6):
        axes = np.random.default_rng(index).uniform(10, 30, 3)
        mesh = Mesh(sphere.vertices * axes * (1 + 0.1 * sphere.vertices[:, :1] ** 3), sphere.faces)
        (folder / f"grain-{index}.stl").write_bytes(stl_bytes(mesh.triangles, "test"))
    return folder


@pytest.fixture(scope="module")
def scan(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Five labelled ellipsoids of 10 to 22 voxels and one at the border, 2 micrometres a voxel."""
    path = tmp_path_factory.mktemp("scan") / "labels.npy"
    z, y, x = np.indices((36, 60, 60), dtype=float)
    labels = np.zeros(x.shape, dtype=np.uint16)
    bodies = [((15, 15, 14), 10), ((44, 14, 18), 9), ((15, 44, 18), 8), ((44, 44, 18), 11), ((30, 30, 18), 5)]
    for number, ((a, b, c), radius) in enumerate([*bodies, ((0, 30, 30), 6)], start=1):
        labels[((x - a) / radius) ** 2 + ((y - b) / radius) ** 2 + ((z - c) / radius) ** 2 < 1] = number
    np.save(path, labels)
    return {"file": str(path), "voxel_size": 2.0, "unit": "um"}


def extracted(scan: dict[str, Any]) -> Any:
    given = VolumeInput(Path(scan["file"]), scan["voxel_size"], scan["unit"])
    return result_of(extract_file(given, GrainSettings())).extraction.particles


def test_that_the_grains_of_a_volume_are_those_that_extract_finds(
    tmp_path: Path, scan: dict[str, Any]
) -> None:
    done = run(tmp_path / "out", volumes=[scan])
    assert not done.problems
    wanted = extracted(scan)
    assert len(wanted) == 5
    rows = described(tmp_path / "out")
    assert [row["name"] for row in rows] == [each.name for each in wanted]
    volumes = [each.mesh.volume for each in wanted]
    assert [row["volume"] for row in rows] == pytest.approx(volumes, rel=1e-12)
    document = json.loads((tmp_path / "out" / "volumes" / "labels.json").read_text())
    assert document["n_particles"] == len(rows)
    assert document["border"] == [6]
    assert "labels.npy" in (tmp_path / "out" / "summary.html").read_text()


def test_that_a_region_in_a_recipe_gives_its_whole_grains(tmp_path: Path, scan: dict[str, Any]) -> None:
    done = run(tmp_path / "out", volumes=[{**scan, "region": {"crop": "60:120um,0:30,:"}}])
    assert not done.problems
    (row,) = described(tmp_path / "out")
    wanted = next(each for each in extracted(scan) if each.name == row["name"] == "particle_0002")
    assert row["volume"] == pytest.approx(wanted.mesh.volume, rel=1e-12)
    document = json.loads((tmp_path / "out" / "volumes" / "labels.json").read_text())
    assert document["region"] == {"crop": "60:120um,0:30,:", "bin": 1, "outside": "auto"}


@pytest.mark.slow
def test_that_settings_of_the_extraction_change_what_is_found(tmp_path: Path, scan: dict[str, Any]) -> None:
    small = run(tmp_path / "a", volumes=[{**scan, "extraction": {"min_voxels": 100}}])
    large = run(tmp_path / "b", volumes=[{**scan, "extraction": {"min_voxels": 4000}}])
    assert small.tally.n_read > large.tally.n_read > 0
    (tmp_path / "settings.json").write_text(json.dumps({"extraction": {"min_voxels": 4000}}))
    by_file = run(tmp_path / "c", volumes=[{**scan, "recipe": "settings.json"}])
    assert described(tmp_path / "c") == described(tmp_path / "b")
    assert by_file.tally.n_read == large.tally.n_read


@pytest.mark.slow
def test_that_a_run_given_up_while_grains_are_extracted_or_worked_on_ends_with_the_same_bytes(
    tmp_path: Path, scan: dict[str, Any]
) -> None:
    entries = {"volumes": [scan], "outputs": {"summary": False}}
    run(tmp_path / "whole", **entries)
    for moment in ("Extracting particles", "Working on particles"):
        folder = tmp_path / moment / "whole"
        steps = run_recipe(recipe_of(**BASE, **entries), tmp_path, folder)
        seen = ""
        for step in steps:
            seen = step.title if isinstance(step, Started) else seen
            if seen == moment and isinstance(step, Progress) and step.done >= 2:
                break
        steps.close()
        run(folder, resume=True, **entries)
        assert contents(folder) == contents(tmp_path / "whole")
        assert run(folder, resume=True, **entries).problems == []
        assert not list(folder.rglob("*.npz"))
        assert contents(folder) == contents(tmp_path / "whole")
    again = run(tmp_path / "whole", **entries)
    assert again.tally.n_read > 0


@pytest.mark.parametrize(
    ("volume", "sentence"),
    [
        ({"file": "none.tif"}, "no volume"),
        ({"extraction": {"smallest": 7}}, "no setting extraction.smallest"),
        ({"segmentation": {"denoise": {"sigma_": 7}}}, r"denoise\.sigma_"),
        ({"extraction": {"min_voxels": "many"}}, "min_voxels"),
        ({"extraction": {"min_voxels": 10**9}}, "None of the grains"),
        ({"recipe": "none.json"}, "cannot be opened"),
    ],
)
def test_that_a_volume_that_gives_no_grains_is_a_sentence_and_leaves_nothing(
    tmp_path: Path, scan: dict[str, Any], volume: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(RegolithError, match=sentence):
        run(tmp_path / "out", volumes=[{**scan, **volume}])
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_that_particles_are_drawn_like_measured_ones_with_the_model_named(
    tmp_path: Path, grains: Path
) -> None:
    population = {"sources": ["grains"], "model": "gaussian_field", "n": 5, "l_max": 4}
    done = run(tmp_path / "out", population=population, seed=3)
    assert done.tally.n_read == 5
    assert described(tmp_path / "out")[0]["name"] == "grains-0000"
    other = run(tmp_path / "other", population={**population, "model": "log_field"}, seed=3)
    assert described(other.folder) != described(done.folder)
    by_two = run(
        tmp_path / "two" / "out", workers=2, population={**population, "sources": [str(grains)]}, seed=3
    )
    assert described(by_two.folder) == described(done.folder)


def test_that_a_model_file_a_card_and_its_file_draw_the_same_particles(tmp_path: Path) -> None:
    card = materials()["ma165"]
    write_model(tmp_path / "ma165-model.json", card.model(6))
    (tmp_path / "mine.json").write_text(card.model_dump_json())
    given_recipe = {"n": 3, "l_max": 6}
    volumes = []
    for number, source in enumerate(("ma165", "mine.json", "ma165-model", "ma165-model.json")):
        run(tmp_path / str(number), population={**given_recipe, "sources": [source]})
        volumes.append([row["volume"] for row in described(tmp_path / str(number))])
    assert volumes[1:] == [volumes[0]] * 3


@pytest.mark.slow
def test_that_tables_of_coefficients_are_particles_and_make_a_model(tmp_path: Path, grains: Path) -> None:
    folder = tmp_path / "tables"
    folder.mkdir()
    for path in sorted(grains.glob("*.stl")):
        coefficients = fit_harmonics(read_mesh(path).mesh, l_max=6).coefficients
        (folder / f"{path.stem}.sh").write_text(table_of(coefficients))
    run(tmp_path / "meshes", inputs=["grains"])
    run(tmp_path / "read", inputs=["tables"])
    for row, wanted in zip(described(tmp_path / "read"), described(tmp_path / "meshes"), strict=True):
        assert row["volume"] == pytest.approx(wanted["volume"], rel=0.03)
    done = run(tmp_path / "drawn", population={"sources": ["tables"], "n": 4, "l_max": 4})
    assert done.tally.n_read == 4


def table_of(coefficients: Any) -> str:
    """Lines ``l, m, C, S`` as pyshtools writes them: real, 4-pi normalised, without the phase, m >= 0."""
    rows = []
    for degree in range(coefficients.l_max + 1):
        for order in range(degree + 1):
            cosine = coefficients.values[degree * degree + degree + order]
            sine = coefficients.values[degree * degree + degree - order] if order else 0.0
            pair = np.array([cosine, sine]) / np.sqrt(4 * np.pi)
            rows.append(f"{degree}, {order}, {pair[0]:.17g}, {pair[1]:.17g}")
    return "\n".join(rows) + "\n"


@pytest.mark.parametrize(
    ("population", "error", "sentence"),
    [
        ({"sources": ["nowhere"], "n": 3}, InputError, "no material card 'nowhere'"),
        ({"sources": ["ma165", "grains"], "n": 3}, InputError, "from one card, fit or model, or"),
        ({"sources": ["ma165"], "n": 3, "model": "gaussian_field"}, InputError, "no particles"),
        ({"sources": ["grains"], "n": 3, "model": "hamster"}, InputError, "hamster"),
        ({"sources": ["grains"], "n": 3, "settings": {"magic": 1}}, InputError, "magic"),
        ({"sources": ["ma165"], "n": 3, "size_range": [9.0, 2.0]}, InputError, "size"),
        ({"sources": ["broken.json"], "n": 3}, FileError, "not JSON"),
    ],
)
def test_that_a_population_that_cannot_be_drawn_is_a_sentence_and_leaves_nothing(
    tmp_path: Path, grains: Path, population: dict[str, Any], error: type[Exception], sentence: str
) -> None:
    assert grains.is_dir()
    (tmp_path / "broken.json").write_text("{")
    with pytest.raises(error, match=sentence):
        run(tmp_path / "out", population=population)
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_that_a_grey_volume_becomes_a_dataset(tmp_path: Path) -> None:
    volume = {"file": GREY, "segmentation": {"splitting": {"h_maxima": 1.0}}}
    done = run(tmp_path / "out", workers=2, volumes=[volume])
    assert done.tally.n_coarse > 10
