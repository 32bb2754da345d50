"""The minimum-volume box: closed forms, an independent optimiser, invariance."""

import gc
import weakref

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from benchmarks.independent import least_box
from regolith_studio.errors import GeometryError
from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces, Mesh, oriented_box
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.oriented_box import OrientedBox, heuristic_box, minimum_volume_box
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import cloud, cuboid, random_polyhedron, rotation, rough_stone, tetrahedron


def by_simplex_search(points: FloatArray, starts: int, seed: int) -> float:
    """Least box volume over rotation vectors, by Nelder-Mead from many starts."""

    def volume(vector: FloatArray) -> float:
        return float(np.prod(np.ptp(points @ Rotation.from_rotvec(vector).as_matrix().T, axis=0)))

    rng = np.random.default_rng(seed)
    first = rng.uniform(-2.0, 2.0, (20 * starts, 3))
    best = first[np.argsort([volume(vector) for vector in first])[:starts]]
    options = {"xatol": 1e-7, "fatol": 1e-9, "maxiter": 400}
    return min(minimize(volume, vector, method="Nelder-Mead", options=options).fun for vector in best)


@pytest.mark.parametrize("edges", [(1.0, 1.0, 1.0), (3.0, 2.0, 1.0), (10.0, 9.9, 0.1), (1.0, 1.0, 5.0)])
@pytest.mark.parametrize("seed", range(4))
def test_that_a_turned_cuboid_is_its_own_box(edges: tuple[float, ...], seed: int) -> None:
    box = minimum_volume_box(cuboid(*edges).moved(rotation=rotation(seed), shift=(5.0, -3.0, 2.0)))
    assert box.extents == pytest.approx(sorted(edges, reverse=True), rel=1e-12)
    assert box.centre == pytest.approx(rotation(seed) @ (5.0, -3.0, 2.0), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_that_the_box_of_a_regular_tetrahedron_is_the_cube_of_its_face_diagonals(seed: int) -> None:
    box = minimum_volume_box(tetrahedron(2.0).moved(rotation=rotation(seed)))
    assert box.extents == pytest.approx(np.full(3, 2.0 / np.sqrt(2.0)), rel=1e-9)


def test_that_the_box_of_a_prism_stands_on_its_triangle() -> None:
    corners = [[0.0, 0.0], [4.0, 0.0], [2.0, 1.5]]
    prism = cloud(np.array([[*corner, z] for corner in corners for z in (0.0, 9.0)]))
    assert minimum_volume_box(prism).extents == pytest.approx([9.0, 4.0, 1.5], rel=1e-9)


def test_that_the_box_of_a_ball_is_the_cube_around_it() -> None:
    assert minimum_volume_box(icosphere(3)).extents == pytest.approx(np.full(3, 2.0), rel=0.01)


@pytest.mark.parametrize("sides", [64, 256])
def test_that_a_cylinder_of_many_sides_stands_in_the_square_around_them(sides: int) -> None:
    """A regular polygon whose number of sides is a multiple of four has its least rectangle on two sides."""
    angles = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    corners = np.vstack([np.column_stack([ring, np.full(sides, z)]) for z in (-1.0, 1.0)])
    mesh = Mesh(corners @ rotation(3).T, np.empty((0, 3), dtype=np.int64))
    box = minimum_volume_box(mesh)
    assert box.volume == pytest.approx(8.0 * np.cos(np.pi / sides) ** 2, rel=1e-6)


@pytest.mark.slow
def test_that_the_search_for_the_box_of_a_cylinder_of_many_sides_ends() -> None:
    sides = 1000
    angles = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    ends = [np.column_stack([ring, np.full(sides, z)]) for z in (0.0, 0.5)]
    cylinder = cloud(np.concatenate(ends)).moved(rotation=rotation(1))
    assert minimum_volume_box(cylinder).extents == pytest.approx([2.0, 2.0, 0.5], rel=1e-3)


@pytest.mark.parametrize(("seed", "stretch"), [(0, 0.0), (2, 0.6), (5, 0.0), (5, 0.6)])
def test_that_no_simplex_search_finds_a_smaller_box(seed: int, stretch: float) -> None:
    solid = random_polyhedron(seed, n_facets=8 + 5 * seed, stretch=stretch)
    assert minimum_volume_box(solid).volume <= by_simplex_search(solid.vertices, 3, seed) * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_that_unit_and_orientation_do_not_matter(seed: int, scale: float) -> None:
    solid = random_polyhedron(seed, n_facets=20, stretch=0.3)
    turned = solid.moved(rotation=rotation(seed), shift=(0.3, -0.2, 0.1), scale=scale)
    wanted = minimum_volume_box(solid).extents
    assert minimum_volume_box(turned).extents / scale == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_that_the_box_of_a_stone_holds_it_and_touches_it(seed: int) -> None:
    stone = rough_stone(seed)
    box = minimum_volume_box(stone)
    inside = (stone.vertices - box.centre) @ box.axes.T
    assert inside.max(axis=0) == pytest.approx(box.extents / 2, rel=1e-12)
    assert inside.min(axis=0) == pytest.approx(-box.extents / 2, rel=1e-12)
    assert np.linalg.det(box.axes) == pytest.approx(1.0, abs=1e-12)


MISSED = HalfSpaces(
    [
        [0.23676309, 0.6913441, -0.68263209],
        [0.75597182, -0.63361907, -0.16441861],
        [-0.03285601, -0.61779659, -0.78565123],
        [0.02320208, 0.50016525, -0.86561908],
        [0.09416543, 0.4405724, 0.89276471],
        [-0.38071053, 0.29481295, 0.87643872],
        [-0.64739956, 0.59548527, 0.47567963],
        [0.08151174, 0.99440947, 0.06712403],
        [-0.16525405, -0.5612006, 0.81101478],
        [-0.88494098, 0.43875457, -0.15612139],
        [-0.51833195, -0.76518414, -0.38187069],
        [0.45862187, -0.50257678, 0.73285916],
    ],
    [
        *(0.40804985, 0.52079377, 0.43921724, 0.41062492, 0.48616902, 0.46030908),
        *(0.52895443, 0.53079368, 0.46292313, 0.6290911, 0.5469868, 0.44598899),
    ],
)


@pytest.mark.parametrize("seed", range(6))
def test_that_a_box_on_a_short_part_of_an_arc_is_found_in_every_orientation(seed: int) -> None:
    solid = ConvexPolyhedron.from_half_spaces(MISSED).moved(rotation=rotation(seed))
    assert minimum_volume_box(solid).volume == pytest.approx(1.7522615, rel=1e-7)


@pytest.mark.parametrize("apart", [1e-13, 1e-11, 1e-9, 1e-7, 1e-5])
@pytest.mark.parametrize("seed", range(3))
def test_that_vertices_beside_each_other_do_not_disturb_the_box(seed: int, apart: float) -> None:
    solid = random_polyhedron(seed, n_facets=12)
    steps = apart * np.random.default_rng(seed).normal(size=solid.vertices.shape)
    doubled = cloud(np.vstack([solid.vertices, solid.vertices + steps])).hull
    wanted = minimum_volume_box(solid)
    assert minimum_volume_box(doubled).volume == pytest.approx(wanted.volume, rel=1e-8 + 20 * apart)


@pytest.mark.parametrize("seed", range(6))
def test_that_rectangles_that_tie_around_a_triangle_do_not_make_the_box_ambiguous(seed: int) -> None:
    corners = np.random.default_rng(seed).normal(size=(3, 2))
    prism = cloud(np.array([[*corner, z] for corner in corners for z in (0.0, 0.4)]))
    turned = prism.moved(rotation=rotation(seed))
    assert minimum_volume_box(turned).extents == pytest.approx(minimum_volume_box(prism).extents, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("block", range(8))
def test_that_an_exhaustive_search_finds_no_smaller_box(block: int) -> None:
    for seed in range(25 * block, 25 * block + 25):
        solid = random_polyhedron(seed, n_facets=5 + seed % 16, stretch=seed % 4 / 4)
        least = np.prod(least_box(ConvexHull(solid.vertices), step=2.0))
        assert minimum_volume_box(solid).volume <= least * (1 + 1e-8)


def test_that_a_grid_of_points_with_many_in_one_plane_has_its_box() -> None:
    grid = np.stack(np.meshgrid(*[np.arange(6.0)] * 3), -1).reshape(-1, 3)
    layers = grid[np.linalg.norm(grid - 2.5, axis=1) < 3.3]
    plain = minimum_volume_box(cloud(layers))
    turned = minimum_volume_box(cloud(layers @ rotation(4).T))
    assert plain.extents == pytest.approx(turned.extents, rel=1e-8)


def test_that_a_polyhedron_and_its_mesh_have_the_same_box() -> None:
    planes = HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), [1.0, 2.0, 3.0, 1.0, 2.0, 3.0])
    polyhedron = ConvexPolyhedron.from_half_spaces(planes)
    assert minimum_volume_box(polyhedron).extents == pytest.approx([6.0, 4.0, 2.0])
    assert minimum_volume_box(polyhedron.mesh).extents == pytest.approx([6.0, 4.0, 2.0])


def test_that_a_hull_whose_triangles_do_not_close_still_has_its_box() -> None:
    whole = cuboid(3.0, 2.0, 1.0)
    torn = Mesh(whole.vertices, whole.faces[1:])
    vars(torn)["hull"] = torn
    assert minimum_volume_box(torn).extents == pytest.approx([3.0, 2.0, 1.0], rel=1e-6)


def test_that_a_flat_mesh_is_refused() -> None:
    with pytest.raises(GeometryError, match="flat"):
        minimum_volume_box(cloud(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])))
    with pytest.raises(GeometryError, match="single point"):
        minimum_volume_box(cloud(np.zeros((5, 3))))


def test_that_the_heuristic_box_is_never_smaller() -> None:
    for seed in range(10):
        solid = random_polyhedron(seed)
        heuristic, exact = heuristic_box(solid), minimum_volume_box(solid)
        assert heuristic.volume >= exact.volume * (1 - 1e-9)
        reach = np.abs((solid.vertices - heuristic.centre) @ heuristic.axes.T).max(axis=0)
        assert reach == pytest.approx(heuristic.extents / 2, rel=1e-6)


def test_that_a_box_checks_itself() -> None:
    with pytest.raises(ValueError, match="orthonormal"):
        OrientedBox(np.zeros(3), np.ones((3, 3)), np.array([3.0, 2.0, 1.0]))
    with pytest.raises(ValueError, match="fall"):
        OrientedBox(np.zeros(3), np.eye(3), np.array([1.0, 2.0, 3.0]))


def test_that_the_corners_of_a_box_span_it() -> None:
    box = OrientedBox(np.array([1.0, 2.0, 3.0]), np.eye(3), np.array([3.0, 2.0, 1.0]))
    assert np.ptp(box.corners, axis=0) == pytest.approx(box.extents)
    assert box.corners.mean(axis=0) == pytest.approx(box.centre)
    assert (box.max_diameter, box.intermediate_diameter, box.min_diameter) == (3.0, 2.0, 1.0)


def test_that_two_slivers_on_one_edge_of_a_hull_do_not_disturb_the_box() -> None:
    corners = np.vstack([cuboid(3.0, 2.0, 1.0).vertices, [[0.0, -1.0, -0.5], [0.3, -1.0 - 1e-11, -0.5]]])
    mesh = cloud(corners)
    vars(mesh)["hull"] = Mesh(corners, split_edge(cuboid(3.0, 2.0, 1.0).faces.tolist(), corners))
    assert minimum_volume_box(mesh).extents == pytest.approx([3.0, 2.0, 1.0], rel=1e-8)


def split_edge(faces: list[list[int]], corners: FloatArray) -> list[list[int]]:
    """The cuboid's faces with both points put on one of its long edges: two triangles without height."""
    on_edge = np.flatnonzero((corners[:8, 1] == -1.0) & (corners[:8, 2] == -0.5))
    left, right = (int(i) for i in on_edge[np.argsort(corners[on_edge, 0])])
    split: list[list[int]] = []
    for face in faces:
        for k in range(3):
            a, b, c = (face[(k + step) % 3] for step in range(3))
            if (a, b) == (left, right):
                split += [[a, 8, c], [8, b, c]]
                break
            if (a, b) == (right, left):
                split += [[a, 9, c], [9, b, c]]
                break
        else:
            split.append(face)
    return [*split, [8, left, 9], [right, 8, 9]]


def test_that_the_box_of_a_mesh_is_looked_for_once_and_does_not_keep_the_mesh(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stone = rough_stone(3)
    first = minimum_volume_box(stone)
    monkeypatch.setattr(oriented_box, "minimum_box", None)
    assert minimum_volume_box(stone) is first
    alive = weakref.ref(stone)
    del stone
    gc.collect()
    assert alive() is None
