"""The jobs themselves on small bodies: load, measure, fit, coarsen, warm up."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import DatasetError, FileError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.fit_options import FIT_DEGREE
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest, coarsen_one, coarsen_sample
from regolith_studio.jobs.dataset_jobs import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.events import Partial, Progress, Started
from regolith_studio.jobs.particle_jobs import load_particles, measure_particle, measure_particles
from regolith_studio.readers.particles import unique_names
from tests.steps import played

SPHERE = icosphere(3)
GRAIN = Mesh(SPHERE.vertices * [30.0, 20.0, 15.0], SPHERE.faces)
FLAT = Mesh([[0, 0, 0], [9, 0, 0], [0, 9, 0], [9, 9, 0]], [[0, 1, 2], [0, 2, 1], [1, 3, 2], [1, 2, 3]])
ORDER = CoarseningRequest(LossWeights.from_preset("all"), method="quadric", target="fit", l_max=4, level=2)


def test_that_a_story_begins_with_its_title_and_counts_to_its_end(tmp_path: Path) -> None:
    for name in ("b", "a"):
        (tmp_path / f"{name}.stl").write_bytes(stl_bytes(GRAIN.triangles, "test"))
    received, loaded = played(load_particles([tmp_path]))
    assert received[0] == Started("Reading particles", 2)
    assert received[-1] == Progress(2, 2, "b.stl")
    assert [particle.name for particle in loaded.particles] == ["a", "b"]


def test_that_loading_nothing_is_an_error_with_the_first_sentence(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="holds no mesh file"):
        played(load_particles([tmp_path]))


def test_that_an_empty_folder_does_not_hide_the_others(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "a.stl").write_bytes(stl_bytes(GRAIN.triangles, "test"))
    _, loaded = played(load_particles([tmp_path / "empty", tmp_path / "a.stl"]))
    assert len(loaded.particles) == 1
    assert len(loaded.problems) == 1


def test_that_names_become_unique_by_group_and_then_by_number() -> None:
    grains = [
        Particle("a", GRAIN),
        Particle("a", GRAIN, "left/low"),
        Particle("a", GRAIN),
        Particle("b", GRAIN),
    ]
    assert [each.name for each in unique_names(grains, ["b"])] == ["a", "left_low_a", "a_2", "b_2"]


def test_that_a_flat_mesh_is_examined_and_its_trouble_named() -> None:
    facts = measure_particle(Particle("flat", FLAT))
    assert facts.descriptors is None
    assert facts.problem.endswith(".")
    assert not facts.health.sound


def test_that_partial_results_grow_to_the_result() -> None:
    received, seen = played(measure_particles([Particle("a", GRAIN), Particle("b", GRAIN)]))
    parts = [step.value for step in received if isinstance(step, Partial)]
    assert [len(part) for part in parts] == [1, 2]
    assert parts[-1] == seen


def test_that_a_sample_goes_on_after_a_particle_that_fails() -> None:
    grains = [Particle("flat", FLAT), Particle("good", GRAIN)]
    _, (flat, good) = played(coarsen_sample(grains, ORDER))
    assert flat.coarsened is None
    assert flat.problem
    assert good.coarsened is not None
    assert good.coefficients is not None
    assert good.coefficients.l_max == 4


def test_that_a_grain_has_one_polyhedron_wherever_it_stands_in_a_sample() -> None:
    request = replace(ORDER, method="annealing", settings=(("iterations", 10),), target="particle", seed=3)
    other = Particle("other", Mesh(SPHERE.vertices * [60.0, 50.0, 20.0], SPHERE.faces))
    grain = Particle("grain", GRAIN)
    _, outcomes = played(coarsen_sample([grain, other, grain], request))
    _, alone = played(coarsen_one(GRAIN, request))
    wanted = coarsen(GRAIN, request.n_facets, "annealing", request.weights, 3, {"iterations": 10})
    for found in (outcomes[0].coarsened, outcomes[2].coarsened, alone):
        assert np.array_equal(found.half_spaces.points, wanted.half_spaces.points)


def test_that_a_sample_without_a_single_polyhedron_is_no_dataset(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="No particle could be coarsened"):
        played(build_dataset_folder([Particle("flat", FLAT)], ORDER, tmp_path / "d", DatasetOptions()))
    assert not (tmp_path / "d").exists()


def test_that_a_particle_carries_the_warnings_of_the_fit_at_the_degree_that_is_coarsened() -> None:
    flake = Particle("flake", Mesh(SPHERE.vertices * [60.0, 50.0, 6.0], SPHERE.faces))
    wanted = fit_harmonics(flake.mesh, FIT_DEGREE).truncated(ORDER.l_max).warnings
    assert any("up to l = 4" in sentence for sentence in wanted)
    _, (outcome,) = played(coarsen_sample([flake], ORDER))
    assert set(wanted) <= set(outcome.notes)
