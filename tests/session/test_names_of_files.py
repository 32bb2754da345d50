"""No name leads a writer out of the folder that it was given, and the name itself stays in the tables."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.export import ExportOptions, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.folder_io import read_dataset, write_dataset
from regolith_studio.errors import FileError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.imaging.extraction import ExtractedParticle
from regolith_studio.io.file_names import file_stem
from regolith_studio.io.tables import read_csv
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest, coarsen_sample
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.particle_jobs import measure_particle
from regolith_studio.readers.particles import read_particles
from regolith_studio.resources import resource
from regolith_studio.session.batch.scan_groups import extract_groups, group_names
from regolith_studio.session.outputs.coarsening import write_coarsening
from regolith_studio.session.outputs.measurements import FittedSample, write_fits
from regolith_studio.session.outputs.particles import write_particle
from regolith_studio.session.recipe import recipe_of
from regolith_studio.session.run_recipe import run_recipe
from regolith_studio.steps import result_of
from tests.dataset.example import entry

BALL = icosphere(2)
GRAIN = Mesh(BALL.vertices * [30.0, 20.0, 15.0], BALL.faces)
BASE: dict[str, Any] = {"method": "quadric", "level": 2, "l_max": 4, "n_facets": 12}
NAMES = ("../../escaped", "{outside}/absolute", "CON", "", "a\\..\\b", "A", "b", "x" * 300, "=1+1", "n\nl")


@pytest.fixture
def output(tmp_path: Path) -> Iterator[Path]:
    """A folder for results, at a depth at which names with dots lead to places that are watched."""
    inputs, folder = tmp_path / "inputs", tmp_path / "deep" / "er" / "out"
    inputs.mkdir()
    folder.parent.mkdir(parents=True)
    for number in range(len(NAMES)):
        (inputs / f"grain-{number}.stl").write_bytes(stl_bytes(GRAIN.triangles, "test"))
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*") if path.is_file()}
    yield folder
    files = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*") if path.is_file()}
    outside = {path: time for path, time in files.items() if not path.is_relative_to(folder)}
    assert outside == before
    assert len({str(path).casefold() for path in files}) == len(files)
    assert all(path.stem == file_stem(path.stem) or ".part" in path.stem for path in files)


def names_for(folder: Path) -> list[str]:
    return [name.format(outside=folder.parent) for name in NAMES]


def hostile(folder: Path) -> list[Particle]:
    return [Particle(name, GRAIN, group=name) for name in names_for(folder)]


@pytest.mark.slow
def test_that_a_recipe_writes_its_particles_below_its_output_whatever_they_are_called(output: Path) -> None:
    called = names_for(output)
    particles = [{"name": f"grain-{k}", "called": name} for k, name in enumerate(called)]
    inputs = [str(output.parents[2] / "inputs")]
    recipe = recipe_of(**BASE, inputs=inputs, particles=particles, outputs={"fits": True})
    run = result_of(run_recipe(recipe, output.parent, output))
    assert not run.problems
    assert len(list((output / "meshes").glob("*.stl"))) == len(NAMES)
    with (output / "descriptors.csv").open(newline="") as table:
        written = [row["name"] for row in read_csv(table)]
    assert written[:3] == called[:3]
    assert written[8] == "=1+1"
    coarse = json.loads((output / "meshes" / "coarsening.json").read_text())["particles"]
    assert [each["file"] for each in coarse] == [f"{file_stem(each['name'])}.stl" for each in coarse]


@pytest.mark.parametrize("name", ["../../escaped", "{outside}/absolute", "CON", "n\nl"])
def test_that_a_population_is_written_below_the_output_whatever_it_is_called(output: Path, name: str) -> None:
    population = {"sources": ["lunar_soil"], "n": 2, "name": name.format(outside=output.parent)}
    outputs = {"descriptors": False, "dataset": False, "summary": False}
    recipe = recipe_of(**BASE, inputs=[], population=population, outputs=outputs)
    result_of(run_recipe(recipe, output.parent, output))
    assert len(list((output / "meshes").glob("*.stl"))) == 2


def test_that_the_writers_of_meshes_stay_in_their_folder(output: Path) -> None:
    for number, particle in enumerate(hostile(output)):
        folder = output / str(number)
        (folder / "coarse").mkdir(parents=True)
        grain = ExtractedParticle(particle, 1, 100, 1.0)
        write_particle(folder, grain, measure_particle(particle))
        request = CoarseningRequest(LossWeights.from_preset("all"), method="quadric", n_facets=12)
        write_coarsening(folder / "coarse", request, result_of(coarsen_sample([particle], request)))
        fits = FittedSample.of([particle], [fit_harmonics(GRAIN, l_max=4)])
        write_fits(folder / "fit.json", fits, folder / "surfaces", level=2)
        assert len(list(folder.rglob("*.stl"))) == 3


def test_that_datasets_and_their_exports_stay_in_their_folder(output: Path) -> None:
    entries = [(Particle(name, GRAIN), entry(k)[1]) for k, name in enumerate(names_for(output))]
    for name in NAMES[:5]:
        dataset = build_dataset(entries[:4], name=name)
        write_dataset(output / "dataset", dataset)
        written = read_dataset(output / "dataset")
        assert [each.name for each in written.representatives[:2]] == names_for(output)[:2]
    for key, exporter in EXPORTERS.items():
        if not exporter.alters:
            write_export(dataset, exporter, output / "exports" / key, ExportOptions())


def test_that_the_names_of_scans_make_folders_in_the_output_only() -> None:
    scans = [Path(".."), Path("x/CON.tif"), Path("y/a.tif"), Path("z/A.tif"), Path("w/n.tif")]
    assert group_names(scans) == ("_", "CON_", "y_a", "z_A", "n")


def test_that_a_group_of_grains_is_a_folder_in_the_output_or_refused(output: Path) -> None:
    output.mkdir()
    given = VolumeInput(resource("samples", "ct", "synthetic-labels.tif"), group="../../escaped")
    groups = result_of(extract_groups([(given, GrainSettings())], output))
    assert not groups.extracted
    assert "would not be in the folder" in groups.problems[0][1]


def test_that_weights_find_the_meshes_of_names_that_are_no_file_names(tmp_path: Path) -> None:
    folder = tmp_path / "extracted"
    folder.mkdir()
    (folder / "a_b.stl").write_bytes(stl_bytes(GRAIN.triangles, "test"))
    (folder / "=1+1.stl").write_bytes(stl_bytes(GRAIN.triangles, "test"))
    (folder / "particles.csv").write_text("name,weight\na/b,2.5\n'=1+1,3.5\n")
    assert {each.name: each.weight for each in read_particles([folder])} == {"=1+1": 3.5, "a_b": 2.5}


def test_that_an_input_whose_name_no_file_can_have_is_one_sentence(output: Path) -> None:
    recipe = recipe_of(**BASE, inputs=["a\0b.stl"], outputs={"dataset": False})
    with pytest.raises(FileError, match="cannot be the name of a file"):
        result_of(run_recipe(recipe, output.parent, output))
