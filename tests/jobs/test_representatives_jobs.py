"""Representatives of samples that hold particles which cannot be described or coarsened."""

from pathlib import Path

import numpy as np
import pytest

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.errors import DatasetError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs import dataset_jobs
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest
from regolith_studio.jobs.dataset_jobs import (
    DatasetOptions,
    RepresentativesRequest,
    build_dataset_folder,
    choose_particles,
    measure_population,
    survey_representatives,
)
from regolith_studio.jobs.events import Partial, Steps
from tests.steps import played

ORDER = CoarseningRequest(LossWeights.from_preset("all"), method="quadric", target="particle")
FLAT = Mesh([[0, 0, 0], [9, 0, 0], [0, 9, 0], [9, 9, 0]], [[0, 1, 2], [0, 2, 1], [1, 3, 2], [1, 2, 3]])


def sample(count: int = 8) -> list[Particle]:
    """Rounder and longer grains in turn, a flat one in third place."""
    made = []
    for index in range(count):
        stretch = np.diag([1.0, 1.2, 1.3 if index % 2 else 2.6])
        made.append(Particle(f"grain-{index}", icosphere(2).moved(rotation=stretch, scale=20.0 + index)))
    return [*made[:2], Particle("flat", FLAT), *made[2:]]


def test_that_a_particle_without_descriptors_is_left_out_and_named() -> None:
    _, population = played(measure_population(sample()))
    assert population.kept == (0, 1, 3, 4, 5, 6, 7, 8)
    ((name, reason),) = population.omitted
    assert name == "flat"
    assert reason
    chosen = choose_particles(population, RepresentativesRequest(2))
    assert 2 not in chosen.places


def test_that_a_survey_tells_its_points_and_holds_every_choice() -> None:
    received, found = played(survey_representatives(sample(), RepresentativesRequest(3)))
    points = [each.value for each in received if isinstance(each, Partial)]
    assert tuple(points) == found.curve.points
    assert found.chosen(3).representatives.chosen.shape == (3,)
    assert found.chosen(7) is None
    again, _ = played(survey_representatives(sample(), RepresentativesRequest(3), found.population))
    assert len(again) < len(received)


def test_that_nothing_to_describe_is_told() -> None:
    with pytest.raises(InputError, match="No particle can be described"):
        played(measure_population([Particle("flat", FLAT)]))
    with pytest.raises(InputError, match="at least two"):
        played(survey_representatives(sample(1)[:1], RepresentativesRequest(1)))


def failing(names: set[str]):
    """A coarsening that fails for particles of these names."""
    real = dataset_jobs.coarsen_sample

    def coarsen(particles, order, workers=1, indices=None) -> Steps:
        outcomes = yield from real(particles, order, workers, indices)
        return tuple(
            CoarsenedParticle(one.name, one.index, None, "It is cursed.") if one.name in names else one
            for one in outcomes
        )

    return coarsen


def test_that_a_representative_that_cannot_be_coarsened_makes_way(tmp_path: Path, monkeypatch) -> None:
    options = DatasetOptions(representatives=RepresentativesRequest(2))
    _, first = played(build_dataset_folder(sample(), ORDER, tmp_path / "a", options))
    cursed = first.dataset.representatives[0].name
    monkeypatch.setattr(dataset_jobs, "coarsen_sample", failing({cursed}))
    _, built = played(build_dataset_folder(sample(), ORDER, tmp_path / "b", options))
    names = [one.name for one in built.dataset.representatives]
    assert len(names) == 2
    assert cursed not in names
    assert sum(one.n_members for one in read_dataset(tmp_path / "b").representatives) == 7


def test_that_too_few_that_can_be_coarsened_are_told_with_the_reason(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(dataset_jobs, "coarsen_sample", failing({f"grain-{index}" for index in range(8)}))
    options = DatasetOptions(representatives=RepresentativesRequest(6))
    with pytest.raises(DatasetError, match="It is cursed"):
        played(build_dataset_folder(sample(), ORDER, tmp_path / "x", options))
    assert not (tmp_path / "x").exists()
