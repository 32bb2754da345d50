"""Particles that nearly fill their box, and others that only starts in the box can meet."""

import numpy as np
import pytest

from benchmarks.independent import measured
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.coarsening.optimiser.starts import grouped_start, hull_triangles
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere

KEPT = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")
CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
NO_FACES = np.empty((0, 3), dtype=np.int64)


def rounded_brick(*scales: float) -> Mesh:
    ball = icosphere(4)
    return Mesh(np.clip(1.6 * ball.vertices, -1.0, 1.0) * scales, ball.faces)


def coin(radius: float) -> Mesh:
    turn = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    rim = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    ends = [np.column_stack([rim, np.full(64, z)]) for z in (-1.0, 1.0)]
    return Mesh(np.vstack(ends), NO_FACES).hull


def errors_by_scipy(target: Target, n_facets: int) -> FloatArray:
    """Of the kept descriptors. Facets may be lost, which is then stated: a body that fills its box leaves no
    room for further cuts where all is kept exactly."""
    found = coarsen(target, n_facets)
    if found.n_facets < n_facets:
        assert found.n_facets >= min(n_facets - 2, 20)
        assert found.reason is not None
        assert found.reason.startswith(f"The result has {found.n_facets} facets instead of {n_facets}")
    else:
        assert found.reason is None
    planes = target.in_unit_frame(found.half_spaces)
    values = measured(planes.normals, planes.offsets, 2.0)
    return np.array([abs(values[key] / target.descriptors[key] - 1.0) for key in KEPT])


@pytest.mark.parametrize("scales", [(10.0, 10.0, 1.0), (20.0, 20.0, 1.0), (10.0, 9.0, 1.0), (2.0, 2.0, 1.0)])
@pytest.mark.parametrize("n_facets", [12, 20, 50])
@pytest.mark.slow
def test_that_bricks_with_rounded_corners_are_met(scales: tuple[float, ...], n_facets: int) -> None:
    assert errors_by_scipy(Target.of(rounded_brick(*scales)), n_facets).max() <= 1e-6


@pytest.mark.parametrize("n_facets", [20, pytest.param(50, marks=pytest.mark.slow)])
def test_that_a_coin_is_met(n_facets: int) -> None:
    assert errors_by_scipy(Target.of(coin(2.0)), n_facets).max() <= 1e-6


@pytest.mark.slow
def test_that_a_smooth_needle_is_met_with_twelve_facets_or_has_a_reason() -> None:
    ball = icosphere(4)
    for thick in (1.0, 1.3, 1.7):
        needle = coarsen(Mesh(ball.vertices * (15.0, thick, 1.0), ball.faces), 12)
        worst = max(needle.errors[key] for key in KEPT)
        assert worst <= 1e-6 or (needle.reason is not None and worst < 0.1)


def test_that_starts_of_needles_end_within_reach() -> None:
    ball = icosphere(4)
    target = Target.of(Mesh(ball.vertices * (15.0, 1.7, 1.0), ball.faces))
    for seed in range(5):
        start = grouped_start(target, hull_triangles(target), 12, np.random.default_rng(seed))
        assert measure_polyhedron(np.array(start.normals), np.array(start.offsets)).status == FINE


def test_that_a_box_with_a_corner_cut_off_is_its_own_result() -> None:
    box, normal = CUBE * (1.5, 1.2, 0.9), np.array([1.0, 0.8, 0.9])
    inside = box[box @ normal <= 2.2]
    ends = [(a, b) for a in inside for b in box[box @ normal > 2.2] if np.count_nonzero(a != b) == 1]
    cut = [a + (b - a) * (2.2 - a @ normal) / ((b - a) @ normal) for a, b in ends]
    found = coarsen(Mesh(np.vstack([inside, *cut]), NO_FACES).hull, 100)
    assert found.n_facets == 7
    assert max(found.errors.values()) <= 1e-6
    assert found.jaccard_distance <= 1e-6
