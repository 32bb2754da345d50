"""Exposed edges, areas, overlap and conditions of unions against manifold3d and differences."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.compound.conditions import (
    KEYS,
    CompoundProblem,
    point_of,
    stepped,
)
from regolith_studio.coarsening.compound.hull import hull_of
from regolith_studio.coarsening.compound.line_overlap import shared_with_lines
from regolith_studio.coarsening.compound.measures import Planes, is_one_body, measure_compound
from regolith_studio.coarsening.compound.scan_lines import scan_lines
from regolith_studio.coarsening.core.box_search import FINE_ANGLE
from regolith_studio.geometry.mesh import Mesh
from tests.coarsening.compound.unions import manifold_of, random_planes, solid_of
from tests.geometry.solids import rotation, rough_stone


def stone() -> Mesh:
    return rough_stone(3).normalised()


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("parts", [2, 4, 7])
def test_that_volume_and_exposed_area_are_those_of_manifold3d(seed: int, parts: int) -> None:
    planes = random_planes(seed, parts)
    found, solid = measure_compound(planes), solid_of(planes)
    assert found is not None
    assert found.volume == pytest.approx(solid.volume(), rel=1e-12)
    assert found.surface_area == pytest.approx(solid.surface_area(), rel=1e-12)
    assert found.areas.sum() == pytest.approx(found.surface_area, rel=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_that_parts_hang_together_where_manifold3d_finds_one_body(seed: int) -> None:
    """Parts thrown into a larger room than they fill: some touch others, some do not."""
    planes = random_planes(seed, 5)
    moved = planes.inner * 2.0
    part = np.repeat(np.arange(5), 10)
    shifted = planes.offsets + np.einsum("ij,ij->i", planes.normals, (moved - planes.inner)[part])
    found = measure_compound(planes._replace(offsets=shifted, inner=moved))
    assert found is not None
    bodies = solid_of(planes._replace(offsets=shifted, inner=moved)).decompose()
    assert is_one_body(found) == (len(bodies) == 1)


def test_that_apart_cubes_are_added_up() -> None:
    cube = np.vstack([np.eye(3), -np.eye(3)])
    far = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    offsets = np.concatenate([0.5 + cube @ place for place in far])
    found = measure_compound(Planes(np.vstack([cube, cube]), offsets, np.array([0, 6, 12]), far))
    assert found is not None
    assert (found.volume, found.surface_area) == pytest.approx((2.0, 12.0))
    assert np.count_nonzero(found.edge_planes[:, 2] < 0) == 0


@pytest.mark.parametrize("angle", [1e-2, 4e-6, 1e-7])
def test_that_facets_that_nearly_touch_are_exposed_where_the_gap_is_open(angle: float) -> None:
    """A narrower block on a cube, its bottom turned by a small angle about a middle line: half is open.

    The normals are longer or shorter than 1 by what many small steps leave.
    """
    cube = np.vstack([np.eye(3), -np.eye(3)])
    tilted = cube.copy()
    tilted[5] = [np.sin(angle), 0.0, -np.cos(angle)]
    offsets = np.array([0.5, 0.5, 0.0, 0.5, 0.5, 1.0, 0.4, 0.4, 1.0, 0.4, 0.4, 0.0])
    for seed in range(40):
        rng = np.random.default_rng(seed)
        turn = rotation(seed) * (1.0 + 2e-15 * rng.normal())
        shift = np.random.default_rng(seed).normal(size=3)
        normals = np.vstack([cube, tilted]) @ turn.T
        inner = np.array([[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]]) @ turn.T + shift
        found = measure_compound(Planes(normals, offsets + normals @ shift, np.array([0, 6, 12]), inner))
        assert found is not None
        assert found.areas[[2, 11]] == pytest.approx([0.68, 0.32 / np.cos(angle)], abs=1e-6)
        assert found.volume == pytest.approx(1.64 - 0.064 * np.tan(angle), abs=1e-7)


def test_that_a_part_that_does_not_hold_its_inner_point_is_refused() -> None:
    planes = random_planes(0)
    assert measure_compound(planes._replace(inner=planes.inner + 9.0)) is None


@pytest.mark.parametrize("seed", range(6))
def test_that_the_hull_of_all_corners_is_that_of_qhull(seed: int) -> None:
    compound = measure_compound(random_planes(seed, 2 + seed))
    assert compound is not None
    found, wanted = hull_of(compound.vertices), ConvexHull(compound.vertices)
    assert found is not None
    assert found.volume == pytest.approx(wanted.volume, rel=1e-13)
    assert np.unique(found.faces).tolist() == sorted(wanted.vertices.tolist())
    assert np.linalg.norm(found.area_vectors, axis=1).sum() == pytest.approx(wanted.area, rel=1e-13)
    for start, end, one, other in found.edges:
        assert [start, end] in [np.roll(found.faces[one], -k)[:2].tolist() for k in range(3)]
        assert [end, start] in [np.roll(found.faces[other], -k)[:2].tolist() for k in range(3)]
    assert len(np.unique(found.edges[:, :2], axis=0)) == 3 * len(found.faces) // 2


@pytest.mark.parametrize("seed", range(6))
def test_that_corners_in_one_plane_and_on_one_line_have_a_hull(seed: int) -> None:
    """Two bars at a right angle: six corners a plane, three a line, two in one place."""
    bars = [np.indices((2, 2, 2)).reshape(3, 8).T * edges for edges in ((6.0, 2.0, 1.0), (2.0, 6.0, 1.0))]
    found = hull_of(np.concatenate(bars) @ rotation(seed).T)
    assert found is not None
    assert found.volume == pytest.approx(36.0 - 8.0, rel=1e-9)


def test_that_corners_in_one_plane_have_no_hull() -> None:
    corners = np.indices((2, 2, 1)).reshape(3, 4).T.astype(float)
    assert hull_of(corners @ rotation(1).T) is None


def test_that_lines_measure_the_shared_volume_of_a_boolean() -> None:
    planes, mesh = random_planes(2), stone()
    compound = measure_compound(planes)
    assert compound is not None
    shared, _, _ = shared_with_lines(compound, scan_lines(mesh, 60_000), np.zeros((40, 2, 3)), np.ones(40))
    boolean = (solid_of(planes) ^ manifold_of(mesh)).volume()
    assert shared == pytest.approx(boolean, abs=3e-4)


def test_that_the_lines_of_a_mesh_alternate_between_entering_and_leaving() -> None:
    lines = scan_lines(stone(), 3000)
    assert set(np.diff(lines.first) % 2) == {0}
    for one, two in zip(lines.first[:-1], lines.first[1:], strict=True):
        assert lines.sign[one:two].tolist() == [-1.0, 1.0] * ((two - one) // 2)


@pytest.mark.parametrize("seed", [0, *(pytest.param(each, marks=pytest.mark.slow) for each in (2, 3))])
def test_that_derivatives_of_conditions_and_overlap_agree_with_differences(seed: int) -> None:
    lines = scan_lines(stone(), 2000)
    problem = CompoundProblem(lines, np.zeros(6), np.arange(6), FINE_ANGLE)
    point = point_of(problem, random_planes(seed))
    assert point is not None
    direction = np.random.default_rng(seed).normal(size=3 * len(point.scales))
    step = 1e-6
    ahead, behind = stepped(problem, point, step * direction), stepped(problem, point, -step * direction)
    assert ahead is not None
    assert behind is not None
    difference = (ahead.logs - behind.logs) / (2.0 * step)
    assert point.rows @ direction == pytest.approx(difference, rel=1e-5, abs=1e-6), KEYS
    _, gradient, _ = shared_with_lines(point.compound, lines, point.tangents, point.scales)
    shared = [shared_with_lines(p.compound, lines, p.tangents, p.scales)[0] for p in (ahead, behind)]
    assert gradient @ direction == pytest.approx((shared[0] - shared[1]) / (2.0 * step), rel=1e-3)
