"""In a sweep more facets are never worse: each number has a start from the result with fewer."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.core.facet_insertion import insert_lost_facets
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron, polyhedron_of
from regolith_studio.coarsening.optimiser.starts import with_waiting
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.stopping_criteria import Trial, fewest_facets
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.readers.particles import read_mesh, sample_particles
from regolith_studio.studies.coarsening import coarsened_rows
from regolith_studio.studies.loss_variants import LossVariant, facet_count_variants

RISE = 5e-3
"""Of the loss that counts as none: starts of more facets may end beside the best polyhedron of fewer."""
LADDER = (12, 20, 31, 60)
N_PARTICLES = {"cement140/smooth": 11, "cement140/voxel": 22, "apollo": 11}
ALL = LossVariant("all", LossWeights.from_preset("all"))


def ladder_of(mesh: Mesh, facets: tuple[int, ...] = LADDER) -> list[CoarseningResult]:
    return coarsened_rows(Target.of(mesh), facet_count_variants(ALL, facets), seed=0)


def check_that_it_falls(results: list[CoarseningResult]) -> None:
    """No loss lies above that of fewer facets where the request is met; met once, it is met by more."""
    met = [found.reason is None for found in results]
    assert met == sorted(met)
    losses = [found.loss for found in results if found.reason is None]
    assert np.all(losses <= np.minimum.accumulate(losses) + RISE)


def test_that_the_loss_of_a_sweep_falls_where_single_calls_rise(particle: Mesh) -> None:
    target = Target.of(particle)
    swept = coarsened_rows(target, facet_count_variants(ALL, (12, 20, 31)), seed=0)
    check_that_it_falls(swept)
    alone = coarsen(target, 31)
    assert swept[-1].loss <= alone.loss + RISE
    again = coarsen(target, 31)  # whatever was computed before
    assert np.array_equal(again.half_spaces.equations, alone.half_spaces.equations)


@pytest.mark.slow
@pytest.mark.parametrize("place", range(12))
def test_that_the_loss_of_a_sweep_falls_on_the_shipped_particles(place: int) -> None:
    check_that_it_falls(ladder_of(list(sample_particles())[place].mesh))


@pytest.mark.slow
@pytest.mark.real_data
@pytest.mark.parametrize("kind", N_PARTICLES)
def test_that_the_loss_of_a_sweep_falls_on_real_particles(
    kind: str, real_data: Callable[[str], Path]
) -> None:
    paths = sorted(each for each in real_data(kind).iterdir() if each.suffix in (".stl", ".ply"))
    for path in paths[: N_PARTICLES[kind]]:
        check_that_it_falls(ladder_of(read_mesh(path, "um").mesh))


@pytest.mark.slow
def test_that_only_fewer_facets_with_the_same_weights_are_begun_with(particle: Mesh) -> None:
    size = ALL.relabelled("size", weights=LossWeights.of(volume=1.0))
    rows = (size.relabelled("eight", n_facets=8), ALL.relabelled("twelve", n_facets=12))
    swept = coarsened_rows(Target.of(particle), rows, seed=0)
    alone = coarsen(particle, 12)
    assert np.array_equal(swept[1].half_spaces.equations, alone.half_spaces.equations)


@pytest.mark.slow
def test_that_a_trial_that_meets_all_is_never_worse_than_earlier_ones_with_fewer_facets(
    particle: Mesh,
) -> None:
    losses: dict[int, float] = {}
    for step in fewest_facets(particle, 1e-6):
        if isinstance(step, Trial) and step.result.reason is None:
            fewer = [loss for number, loss in losses.items() if number < step.n_facets]
            assert step.result.loss <= min(fewer, default=np.inf) + RISE
            losses[step.n_facets] = step.result.loss
    assert len(losses) > 2


def test_that_corners_are_cut_where_there_is_room() -> None:
    cube = np.vstack([np.eye(3), -np.eye(3)])
    target = Target.of(polyhedron_of(HalfSpaces(cube, np.full(6, 0.5))).mesh)
    rays = target.rays
    for n_facets in (14, 30):  # each corner of the cube once, and then some
        waiting = with_waiting(HalfSpaces(cube, np.full(6, 0.5)), n_facets)
        cuts, normals, offsets = insert_lost_facets(
            waiting.normals, waiting.offsets, rays.directions, rays.first, rays.distance, 0.3
        )
        areas = measure_polyhedron(normals, offsets).areas
        assert cuts == n_facets - 6
        assert areas.min() > 1e-3
