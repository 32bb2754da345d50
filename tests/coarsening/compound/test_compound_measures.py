"""Exposed edges, areas, overlap and terms of unions against manifold3d and differences."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.core.line_overlap import fill_shared_with_lines, scan_lines
from regolith_studio.coarsening.core.parts import (
    N_EXPOSED,
    N_FACES,
    Hull,
    Planes,
    fill_hull,
    hull_for,
    parts_for,
)
from regolith_studio.coarsening.optimiser.body import (
    BODY_VOLUME,
    HULL,
    JACCARD,
    N_BOXES,
    N_VERTICES,
    SURFACE,
    Prices,
    body_scratch,
    empty_body,
)
from regolith_studio.coarsening.optimiser.descent import (
    fill_overlap,
    fill_overlap_gradient,
    move,
)
from regolith_studio.coarsening.optimiser.followed_boxes import box_memory, check_boxes
from regolith_studio.coarsening.optimiser.memory import memory_for
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from tests.coarsening.compound.unions import WANTED, manifold_of, measured, random_planes, solid_of
from tests.geometry.solids import rotation, rough_stone


def stone() -> Mesh:
    return rough_stone(3).normalised()


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("parts", [2, 4, 7])
def test_that_volume_and_exposed_area_are_those_of_manifold3d(seed: int, parts: int) -> None:
    planes = random_planes(seed, parts)
    (body, _, _), solid = measured(planes), solid_of(planes)
    numbers = body.numbers
    assert numbers[BODY_VOLUME] == pytest.approx(solid.volume(), rel=1e-12)
    assert numbers[SURFACE] == pytest.approx(solid.surface_area(), rel=1e-12)
    assert body.areas.sum() == pytest.approx(numbers[SURFACE], rel=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_that_parts_hang_together_where_manifold3d_finds_one_body(seed: int) -> None:
    """Parts thrown into a larger room than they fill: some touch others, some do not."""
    planes = random_planes(seed, 5)
    moved = planes.inner * 2.0
    part = np.repeat(np.arange(5), 10)
    shifted = planes.offsets + np.einsum("ij,ij->i", planes.normals, (moved - planes.inner)[part])
    _, _, sound = measured(planes._replace(offsets=shifted, inner=moved))
    bodies = solid_of(planes._replace(offsets=shifted, inner=moved)).decompose()
    assert sound == (len(bodies) == 1)


def test_that_apart_cubes_are_added_up() -> None:
    cube = np.vstack([np.eye(3), -np.eye(3)])
    far = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    offsets = np.concatenate([0.5 + cube @ place for place in far])
    body, parts, sound = measured(Planes(np.vstack([cube, cube]), offsets, np.array([0, 6, 12]), far))
    assert not sound
    assert body.numbers[[BODY_VOLUME, SURFACE]] == pytest.approx((2.0, 12.0))
    assert np.count_nonzero(parts.edge_planes[: parts.counts[N_EXPOSED], 2] < 0) == 0


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
        found, _, _ = measured(Planes(normals, offsets + normals @ shift, np.array([0, 6, 12]), inner))
        assert found.areas[[2, 11]] == pytest.approx([0.68, 0.32 / np.cos(angle)], abs=1e-6)
        assert found.numbers[BODY_VOLUME] == pytest.approx(1.64 - 0.064 * np.tan(angle), abs=1e-7)


def test_that_a_part_that_does_not_hold_its_inner_point_is_refused() -> None:
    planes = random_planes(0)
    assert not measured(planes._replace(inner=planes.inner + 9.0))[2]


def hull_of(corners: FloatArray) -> tuple[float, Hull, int]:
    """Volume and triangles of a hull, and how many there are."""
    hull, counts = hull_for(len(corners)), np.zeros(3, np.int64)
    return fill_hull(np.ascontiguousarray(corners), counts, hull), hull, counts[N_FACES]


@pytest.mark.parametrize("seed", range(6))
def test_that_the_hull_of_all_corners_is_that_of_qhull(seed: int) -> None:
    body, _, _ = measured(random_planes(seed, 2 + seed))
    corners = body.vertices[: body.counts[N_VERTICES]]
    (volume, hull, m), wanted = hull_of(corners), ConvexHull(corners)
    faces, edges = hull.faces[:m], hull.edges[: 3 * m // 2]
    assert volume == pytest.approx(wanted.volume, rel=1e-13)
    assert np.unique(faces).tolist() == sorted(wanted.vertices.tolist())
    assert np.linalg.norm(hull.area_vectors[:m], axis=1).sum() == pytest.approx(wanted.area, rel=1e-13)
    for start, end, one, other in edges:
        assert [start, end] in [np.roll(faces[one], -k)[:2].tolist() for k in range(3)]
        assert [end, start] in [np.roll(faces[other], -k)[:2].tolist() for k in range(3)]
    assert len(np.unique(edges[:, :2], axis=0)) == 3 * len(faces) // 2


@pytest.mark.parametrize("seed", range(6))
def test_that_corners_in_one_plane_and_on_one_line_have_a_hull(seed: int) -> None:
    """Two bars at a right angle: six corners a plane, three a line, two in one place."""
    bars = [np.indices((2, 2, 2)).reshape(3, 8).T * edges for edges in ((6.0, 2.0, 1.0), (2.0, 6.0, 1.0))]
    volume, _, _ = hull_of(np.concatenate(bars) @ rotation(seed).T)
    assert volume == pytest.approx(36.0 - 8.0, rel=1e-9)


def test_that_corners_in_one_plane_have_no_hull() -> None:
    corners = np.indices((2, 2, 1)).reshape(3, 4).T.astype(float)
    assert hull_of(corners @ rotation(1).T)[0] == 0.0


def test_that_lines_measure_the_shared_volume_of_a_boolean() -> None:
    planes, mesh = random_planes(2), stone()
    body, parts, _ = measured(planes)
    lines = scan_lines(mesh, 60_000)
    shared = fill_shared_with_lines(
        body.normals, body.offsets, body.centroids, body.tangents, body.scales, lines, parts
    )
    boolean = (solid_of(planes) ^ manifold_of(mesh)).volume()
    assert shared == pytest.approx(boolean, abs=3e-4)


def test_that_the_lines_of_a_mesh_alternate_between_entering_and_leaving() -> None:
    lines = scan_lines(stone(), 3000)
    assert set(np.diff(lines.first) % 2) == {0}
    for one, two in zip(lines.first[:-1], lines.first[1:], strict=True):
        assert lines.sign[one:two].tolist() == [-1.0, 1.0] * ((two - one) // 2)


@pytest.mark.slow  # steps of the optimiser are compiled for it that no other caller needs
@pytest.mark.parametrize("seed", [0, 2, 3])
def test_that_rows_are_the_derivatives_of_the_terms_and_of_the_overlap(seed: int) -> None:
    lines, planes, bound = scan_lines(stone(), 2000), random_planes(seed), np.ones(6)
    (here, parts, _), n = measured(planes), len(planes.offsets)
    prices, scratch, work = (
        Prices(WANTED, -bound, bound, 1.0),
        body_scratch(n),
        memory_for(n, 0, planes).steps,
    )
    assert check_boxes(here, prices, np.eye(3), box_memory(4 * n, 2 * n), scratch)
    corners = Mesh(here.vertices[: here.counts[N_VERTICES]], np.empty((0, 3), dtype=np.int64))
    assert here.extents[0].prod() == pytest.approx(minimum_volume_box(corners.hull).volume, rel=1e-6)
    here.counts[N_BOXES] = 1
    fill_overlap(here, parts, lines, work)
    gradient = np.empty(3 * n)
    fill_overlap_gradient(here, parts, lines, 1.0, work, gradient)
    step, found = np.random.default_rng(seed).normal(size=3 * n), []
    for sign in (1.0, -1.0):
        there = empty_body(n, parts_for(planes))
        assert move(here, there, sign * 1e-6 * step, prices, True, scratch)
        fill_overlap(there, there.parts, lines, work)
        found.append((there.residuals, there.numbers[JACCARD]))
    difference = (found[0][0] - found[1][0]) / 2e-6
    assert here.rows @ step == pytest.approx(difference, rel=1e-5, abs=1e-6)
    assert gradient @ step == pytest.approx((found[0][1] - found[1][1]) / 2e-6, rel=1e-3)
    assert here.residuals[HULL] == pytest.approx(solid_of(planes).hull().volume() / WANTED[HULL] - 1.0)
