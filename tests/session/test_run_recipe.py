"""A recipe is the same bytes whoever works on it and however often it is killed; failures are told."""

import csv
import json
import multiprocessing
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.events import Progress, Started
from regolith_studio.session.recipe import Recipe, recipe_of
from regolith_studio.session.run_recipe import RecipeRun, run_recipe
from regolith_studio.steps import result_of
from regolith_studio.studies import lmax
from tests.files import contents

BASE: dict[str, Any] = {"method": "quadric", "level": 2, "l_max": 4, "n_facets": 12}


@pytest.fixture(scope="module")
def grains(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Nine ellipsoids, a flat one and a file that is none."""
    folder = tmp_path_factory.mktemp("grains")
    sphere = icosphere(3)
    for index in range(9):
        axes = np.random.default_rng(index).uniform(10, 30, 3)
        content = stl_bytes(Mesh(sphere.vertices * axes, sphere.faces).triangles, "test")
        (folder / f"grain-{index}.stl").write_bytes(content)
    (folder / "broken.stl").write_bytes(b"solid nothing")
    return folder


def recipe(grains: Path, **entries: Any) -> Recipe:
    outputs = {"fits": True, **entries.pop("outputs", {})}
    return recipe_of(**{**BASE, "inputs": [str(grains)], "outputs": outputs, **entries})


def done(*arguments: Any, **options: Any) -> RecipeRun:
    return result_of(run_recipe(*arguments, **options))


@pytest.fixture(scope="module")
def alone(grains: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[RecipeRun, dict[str, bytes]]:
    """The recipe by one worker, each particle a chunk."""
    found = done(recipe(grains), grains, tmp_path_factory.mktemp("one") / "out")
    return found, contents(found.folder)


def test_that_failed_particles_are_listed_and_the_rest_goes_on(alone: tuple[RecipeRun, dict]) -> None:
    found, files = alone
    (sentence,) = found.problems
    assert "broken.stl" in sentence
    with (found.folder / "failed.csv").open() as table:
        rows = list(csv.DictReader(table))
    assert [(row["name"], row["stage"]) for row in rows] == [("broken", "reading")]
    assert rows[0]["reason"] == sentence
    assert sum(name.startswith("meshes/") and name.endswith(".stl") for name in files) == 9
    assert validate_dataset(found.folder / "dataset") == []
    assert "broken.stl" in (found.folder / "summary.html").read_text()


@pytest.mark.parametrize(("workers", "chunk"), [(1, 4), pytest.param(2, 3, marks=pytest.mark.slow)])
def test_that_workers_and_chunks_change_no_byte(
    grains: Path, tmp_path: Path, alone: tuple[RecipeRun, dict], workers: int, chunk: int
) -> None:
    found = done(recipe(grains), grains, tmp_path / "out", workers, chunk=chunk)
    assert contents(found.folder) == alone[1]


@pytest.mark.parametrize(
    "after",
    [
        pytest.param(0, marks=pytest.mark.slow),
        3,
        *(pytest.param(each, marks=pytest.mark.slow) for each in (6, 9)),
    ],
)
def test_that_a_run_given_up_after_any_particle_goes_on_to_the_same_bytes(
    grains: Path, tmp_path: Path, alone: tuple[RecipeRun, dict], after: int
) -> None:
    steps = run_recipe(recipe(grains), grains, tmp_path / "out")
    for step in steps:
        if isinstance(step, Progress) and step.done == after:
            break
    steps.close()
    again = run_recipe(recipe(grains), grains, tmp_path / "out", resume=True)
    first = next(step for step in again if isinstance(step, Progress))
    assert first.done == min(after, 10)
    for _ in again:
        pass
    assert contents(tmp_path / "out") == alone[1]


@pytest.mark.slow
def test_that_a_run_given_up_while_it_writes_leaves_the_earlier_results(
    grains: Path, tmp_path: Path, alone: tuple[RecipeRun, dict]
) -> None:
    done(recipe(grains), grains, tmp_path / "out")
    steps = run_recipe(recipe(grains, n_facets=8), grains, tmp_path / "out")
    writing = False
    for step in steps:
        writing = writing or step == Started("Writing the results", 10)
        if writing and isinstance(step, Progress) and step.done == 10:
            break
    steps.close()
    assert writing
    assert contents(tmp_path / "out") == alone[1]
    assert not [*tmp_path.glob(".*")]


@pytest.mark.slow
def test_that_a_study_given_up_within_a_run_goes_on_to_the_same_bytes(
    grains: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    outputs = {"meshes": False, "dataset": False, "lmax_study": True}
    given_recipe = recipe(grains, outputs=outputs, inputs=["grain-0.stl", "grain-1.stl"])
    steps = run_recipe(given_recipe, grains, tmp_path / "out")
    studied = False
    for step in steps:
        studied = studied or step == Started("RMSRE against l_max", 2)
        if studied and isinstance(step, Progress) and step.done == 1:
            break
    steps.close()
    work, given = lmax.errors_or_reason, []

    def counted(mesh: Mesh, **options: Any) -> Any:
        given.append(mesh)
        return work(mesh, **options)

    monkeypatch.setattr(lmax, "errors_or_reason", counted)
    done(given_recipe, grains, tmp_path / "out", resume=True)
    assert len(given) == 1
    assert contents(tmp_path / "out") == contents(done(given_recipe, grains, tmp_path / "whole").folder)


def test_that_a_run_that_has_ended_is_not_done_again(grains: Path, tmp_path: Path) -> None:
    first = done(recipe(grains), grains, tmp_path / "out")
    stamp = {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("*.stl")}
    again = done(recipe(grains), grains, tmp_path / "out", resume=True)
    assert again.problems == first.problems
    assert again.files == first.files
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("*.stl")} == stamp
    left = {path.name for path in (tmp_path / "out" / "journal").iterdir()}
    assert left == {"checkpoint.sqlite", "times.csv"}


def test_that_an_unfinished_run_is_neither_overwritten_nor_mixed(grains: Path, tmp_path: Path) -> None:
    steps = run_recipe(recipe(grains), grains, tmp_path / "out")
    while not (isinstance(step := next(steps), Progress) and step.done == 3):
        pass
    steps.close()
    with pytest.raises(FileError, match="--resume"):
        done(recipe(grains), grains, tmp_path / "out")
    with pytest.raises(FileError, match="begun with another recipe"):
        done(recipe(grains, n_facets=13), grains, tmp_path / "out", resume=True)


def test_that_a_changed_input_is_noticed(tmp_path: Path, grains: Path) -> None:
    (tmp_path / "in").mkdir()
    for index in range(3):
        (tmp_path / "in" / f"{index}.stl").write_bytes((grains / f"grain-{index}.stl").read_bytes())
    given_recipe = recipe(tmp_path / "in")
    steps = run_recipe(given_recipe, tmp_path, tmp_path / "out")
    while not (isinstance(step := next(steps), Progress) and step.done == 1):
        pass
    steps.close()
    (tmp_path / "in" / "2.stl").write_bytes((grains / "grain-5.stl").read_bytes() + b" ")
    with pytest.raises(FileError, match="another set of input files"):
        done(given_recipe, tmp_path, tmp_path / "out", resume=True)


def test_that_nothing_is_left_where_nothing_can_be_read(tmp_path: Path, grains: Path) -> None:
    with pytest.raises(FileError, match=r"broken\.stl"):
        done(recipe(grains / "broken.stl"), tmp_path, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_that_a_population_is_drawn_measured_coarsened_and_written(tmp_path: Path) -> None:
    entries = {"inputs": [], "population": {"sources": ["ma165"], "n": 4, "l_max": 6}, "target": "particle"}
    given_recipe = recipe_of(**{**BASE, **entries}, outputs={"fits": False, "summary": False})
    found = done(given_recipe, tmp_path, tmp_path / "out")
    names = [entry["name"] for entry in json.loads((tmp_path / "out" / "descriptors.json").read_text())]
    assert names == [f"ma165-{index:04d}" for index in range(4)]
    assert validate_dataset(tmp_path / "out" / "dataset") == []
    longer = recipe_of(
        **{**given_recipe.model_dump(), "population": {"sources": ["ma165"], "n": 6, "l_max": 6}}
    )
    more = done(longer, tmp_path, tmp_path / "more")
    same = {name: digest for name, digest in contents(found.folder).items() if name.startswith("meshes/ma")}
    assert len(same) == 4
    assert same.items() <= contents(more.folder).items()


def test_that_a_recipe_divides_radii_by_the_reference_that_it_names(tmp_path: Path, grains: Path) -> None:
    """Coefficients of the ratio to an ellipsoid are no lengths, so there is no spectrum of lengths."""
    given_recipe = recipe(grains, reference="ellipsoid", target="fit")
    folder = done(given_recipe, grains, tmp_path / "out").folder
    (first, *_) = json.loads((folder / "fit.json").read_text())["particles"]
    assert first["reference"]
    document = json.loads((folder / "dataset" / "dataset.json").read_text())["metadata"]
    assert document["angular_power_spectrum_um2"] is None
    assert "reference ellipsoid" in " ".join(document["processing_steps"])


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
def test_that_a_worker_killed_in_mid_run_changes_no_byte(
    grains: Path, tmp_path: Path, alone: tuple[RecipeRun, dict]
) -> None:
    steps = run_recipe(recipe(grains), grains, tmp_path / "out", 2, chunk=2)
    killed_one = False
    for step in steps:
        if isinstance(step, Progress) and step.done >= 2 and not killed_one:
            os.kill(multiprocessing.active_children()[0].pid or 0, signal.SIGKILL)
            killed_one = True
    assert killed_one
    assert contents(tmp_path / "out") == alone[1]


def test_that_a_dataset_too_large_to_be_read_again_is_refused_before_the_work(tmp_path: Path) -> None:
    given_recipe = recipe_of(inputs=[], population={"sources": ["ma165"], "n": 120_000}, n_facets=20)
    with pytest.raises(InputError, match="make several of at most 104,"):
        done(given_recipe, tmp_path, tmp_path / "out")
    assert not (tmp_path / "out").exists()
