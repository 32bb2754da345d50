"""Cubes and other shapes broken on purpose: what comes back has the volume and area of closed forms."""

import contextlib
import itertools

import numpy as np
import pytest
from scipy.ndimage import generate_binary_structure, label

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.hole_filling import least_area_triangles
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.repair import repair
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.geometry.topology import merged_vertices
from tests.filling import filled
from tests.geometry.solids import CORNERS, CUBE, FACES, joined, turned_round


def soup(mesh):
    """Every triangle with three vertices of its own."""
    return Mesh(mesh.triangles.reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3))


def without(mesh, *rows):
    return Mesh(mesh.vertices, np.delete(mesh.faces, rows, axis=0))


def boxes(*places, weld=True):
    """Unit cubes at whole-numbered places, with common vertices and without the walls between them."""
    both = joined(*(CUBE.moved(shift=place) for place in places))
    return Mesh(*merged_vertices(both.vertices, both.faces)) if weld else both


BROKEN = {
    "inside out": (turned_round(CUBE), "Reoriented all faces: the normals pointed inwards."),
    "one face turned": (turned_round(CUBE, [4]), "Reoriented 1 face."),
    "most faces turned": (turned_round(CUBE, slice(2, 11)), "Reoriented 3 faces."),
    "a triangular hole": (without(CUBE, 0), "Filled 1 hole with 8.3 % of the surface."),
    "a square hole": (without(CUBE, 0, 6), "Filled 1 hole with 17 % of the surface."),
    "two holes": (without(CUBE, 0, 1), "Filled 2 holes with 17 % of the surface."),
    "two holes that touch in a corner": (without(CUBE, 0, 2), "Filled 2 holes with 17 % of the surface."),
    "seams everywhere": (soup(CUBE), "Joined 28 vertices with another at the same place."),
    "rounded coordinates": (
        Mesh(soup(CUBE).vertices + np.random.default_rng(1).uniform(-1, 1, (36, 3)) * 1e-9, soup(CUBE).faces),
        "Joined 28 vertices with another within 1e-07 of the mesh's size.",
    ),
    "a face twice": (
        Mesh(CUBE.vertices, np.concatenate([CUBE.faces, CUBE.faces[3:4]])),
        "Removed 1 double face.",
    ),
    "a face and its back": (
        Mesh(CUBE.vertices, np.concatenate([CUBE.faces, CUBE.faces[3:4], CUBE.faces[3:4, ::-1]])),
        "Removed 2 double faces.",
    ),
    "a face without area": (
        Mesh(CUBE.vertices, np.concatenate([CUBE.faces, [[0, 0, 1], [2, 2, 2]]])),
        "Removed 2 faces without area.",
    ),
    "a small body beside it": (
        joined(CUBE.moved(scale=0.2).moved(shift=(3, 3, 3)), CUBE),
        "Kept the largest of 2 bodies, with 99.2 % of their volume.",
    ),
    "a cavity": (
        joined(CUBE, turned_round(CUBE.moved(scale=0.5).moved(shift=(0.25, 0.25, 0.25)))),
        "Kept the largest of 2 bodies, with 89 % of their volume.",
    ),
    "a small body that is inside out": (
        joined(CUBE, turned_round(CUBE.moved(scale=0.2).moved(shift=(3, 3, 3)))),
        "Kept the largest of 2 bodies, with 99.2 % of their volume.",
    ),
    "a loose triangle": (
        joined(CUBE, Mesh([[5, 0, 0], [6, 0, 0], [5, 1, 0]], [[0, 1, 2]])),
        "Kept the largest of 2 bodies, with over 99.9 % of their volume.",
    ),
    "a fin on an edge": (
        Mesh(np.concatenate([CUBE.vertices, [[-1, -1, 0.5]]]), np.concatenate([CUBE.faces, [[0, 1, 8]]])),
        "Split the surface along 1 edge of more than two faces.",
    ),
    "everything at once": (
        turned_round(
            joined(soup(turned_round(without(CUBE, 5), [1, 2])), CUBE.moved(scale=0.1, shift=(30, 0, 0)))
        ),
        "Filled 1 hole with 8.3 % of the surface.",
    ),
}


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("kind", BROKEN)
def test_that_a_broken_cube_comes_back_with_volume_one_and_area_six(kind, scale):
    mesh, action = BROKEN[kind]
    result = repair(mesh.moved(scale=scale, shift=(2, -1, 5)))
    assert result.mesh.volume == pytest.approx(scale**3, rel=1e-6)
    assert result.mesh.surface_area == pytest.approx(6 * scale**2, rel=1e-6)
    assert result.health_after.sound
    assert action in result.actions


def test_that_a_sound_mesh_comes_back_itself():
    result = repair(CUBE)
    assert result.mesh is CUBE
    assert result.actions == ()
    assert result.health_before is result.health_after
    assert result.given is None
    assert result.as_dict()["filled_area"] == 0.0


@pytest.mark.parametrize("place", [(1, 1, 0), (1, 1, 1)], ids=["an edge", "a corner"])
def test_that_boxes_that_only_touch_are_two_bodies_of_which_one_is_kept(place):
    result = repair(boxes((0, 0, 0), place))
    assert result.mesh.volume == pytest.approx(1.0)
    assert "Kept the largest of 2 bodies, with 50 % of their volume." in result.actions


def test_that_a_ring_of_boxes_that_closes_over_an_edge_stays_whole():
    """Five boxes in a chain, whose ends touch along an edge that the chain goes round."""
    places = [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (1, 1, 0)]
    result = repair(boxes(*places))
    assert result.mesh.volume == pytest.approx(5.0)
    assert result.mesh.surface_area == pytest.approx(22.0)
    assert result.health_after.non_manifold_edges == 0


VOXEL_SIDES = {
    (-1, 0, 0): [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
    (1, 0, 0): [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
    (0, -1, 0): [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
    (0, 1, 0): [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
    (0, 0, -1): [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
    (0, 0, 1): [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
}


@pytest.mark.parametrize("seed", range(4))
def test_that_of_random_voxels_the_largest_component_is_kept_to_the_voxel(seed):
    """Voxels that meet in an edge are apart: as `scipy.ndimage.label` counts them by default."""
    solid = np.pad(np.random.default_rng(seed).random((9, 9, 9)) < 0.42, 1)
    corners = [
        np.array(side)[[0, 1, 2, 0, 2, 3]] + place
        for place in np.argwhere(solid)
        for step, side in VOXEL_SIDES.items()
        if not solid[tuple(place + step)]
    ]
    points = np.concatenate(corners).astype(float)
    result = repair(Mesh(*merged_vertices(points, np.arange(len(points)).reshape(-1, 3))))
    labels, _ = label(solid)
    largest = labels == np.argmax(np.bincount(labels[solid]))
    void, _ = label(~largest, generate_binary_structure(3, 2))
    assert result.health_before.non_manifold_edges > 50
    assert result.mesh.volume == pytest.approx(np.count_nonzero(void != void[0, 0, 0]))


def test_that_a_concave_flat_hole_is_closed_within_its_outline():
    """The lid of a prism over an L is missing: base area 3, height 1."""
    base = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    vertices = [(x, y, z) for z in (0, 1) for x, y in base]
    bottom = [(0, 5, 3), (5, 4, 3), (0, 3, 1), (1, 3, 2)]
    sides = [((k, (k + 1) % 6, (k + 1) % 6 + 6), (k, (k + 1) % 6 + 6, k + 6)) for k in range(6)]
    result = repair(Mesh(vertices, bottom + [face for pair in sides for face in pair]))
    assert result.mesh.volume == pytest.approx(3.0)
    assert result.mesh.surface_area == pytest.approx(14.0)
    assert result.filled_area == pytest.approx(3.0)


def test_that_a_sphere_with_a_hundred_holes_keeps_its_volume():
    sphere = icosphere(4)
    rows = np.random.default_rng(3).choice(len(sphere.faces), 100, replace=False)
    result = repair(without(sphere, *rows))
    assert result.mesh.volume == pytest.approx(sphere.volume, rel=2e-3)
    assert result.mesh.surface_area == pytest.approx(sphere.surface_area, rel=2e-3)


@pytest.mark.parametrize("seed", range(5))
def test_that_a_scan_with_every_fault_at_once_keeps_its_volume(seed):
    """Rounded triangle soup with one face in twenty missing, one in five turned, and twenty twice."""
    rng = np.random.default_rng(seed)
    rough = 1 + 0.1 * rng.random((len(icosphere(4).vertices), 1))
    whole = Mesh(icosphere(4).vertices * rough * (2.0, 1.0, 0.7), icosphere(4).faces)
    kept = rng.permutation(len(whole.faces))[len(whole.faces) // 20 :]
    corners = whole.triangles[np.concatenate([kept, kept[:20]])]
    corners[::5] = corners[::5, ::-1]
    corners = corners + rng.uniform(-3e-8, 3e-8, corners.shape)
    result = repair(Mesh(corners.reshape(-1, 3), np.arange(corners.size // 3).reshape(-1, 3)))
    assert result.mesh.volume == pytest.approx(whole.volume, rel=0.01)
    assert result.mesh.surface_area == pytest.approx(whole.surface_area, rel=0.02)


@pytest.mark.slow
def test_that_a_rim_of_many_corners_is_closed_about_its_middle():
    """Half a sphere is refused, a sphere without its cap above 0.9 is closed by a disc."""
    sphere = icosphere(6)
    low = np.flatnonzero(sphere.triangles[:, :, 2].mean(axis=1) > 0.9)
    result = repair(without(sphere, *low))
    cap = np.pi * 0.1**2 * (3 - 0.1) / 3
    assert result.mesh.volume == pytest.approx(4 * np.pi / 3 - cap, rel=2e-3)
    assert result.filled_area == pytest.approx(np.pi * (1 - 0.9**2), rel=0.05)


def test_that_a_repair_tells_the_mesh_as_it_came_and_what_was_done_in_numbers():
    """A cube of 3 without a face (9 of 54 units of area), and a cube of 1 beside it."""
    small = Mesh(CORNERS, FACES).moved(shift=(5, 0, 0))
    large = without(CUBE, 0, 6).moved(scale=3)
    both = Mesh(
        np.concatenate([large.vertices, small.vertices]),
        np.concatenate([large.faces, small.faces + len(large.vertices)]),
    )
    result = repair(both)
    assert result.given is both
    assert not result.health_before.watertight
    assert result.health_before.bodies == 2
    assert result.health_after.watertight
    told = result.as_dict()
    assert told["filled_area"] == pytest.approx(9.0)
    assert told["filled_share"] == pytest.approx(9 / 54)
    assert (told["filled_holes"], told["dropped_bodies"]) == (1, 1)
    assert told["actions"] == list(result.actions)
    filling = result.mesh.triangles[-result.filling_faces :]
    assert np.ptp(filling.reshape(-1, 3), axis=0).min() == pytest.approx(0.0, abs=1e-12)


NOTHING = {
    "no faces": (Mesh(CORNERS, np.zeros((0, 3))), "point cloud"),
    "nothing": (Mesh(np.zeros((0, 3)), np.zeros((0, 3))), "point cloud"),
    "one triangle": (Mesh(CORNERS, FACES[:1]), "open sheet"),
    "a square": (Mesh(CORNERS, FACES[[0, 6]]), "open sheet"),
    "two sides": (Mesh(CORNERS, FACES[[0, 6, 1, 7]]), "(open sheet|flat)"),
    "three sides": (Mesh(CORNERS, FACES[[0, 6, 2, 8, 4, 10]]), "open sheet"),
    "a tenth of a sphere": (
        Mesh(icosphere(3).vertices, icosphere(3).faces[icosphere(3).triangles[:, :, 2].mean(axis=1) > 0.8]),
        "open sheet",
    ),
    "a sheet with two sides": (
        Mesh(CORNERS, np.concatenate([FACES[[0, 6]], FACES[[0, 6], ::-1]])),
        "(two sides|flat|open sheet)",
    ),
    "a flattened cube": (Mesh(CORNERS * (1, 1, 0), FACES), "(flat|two sides|open sheet)"),
    "a nearly flattened cube": (Mesh(CORNERS * (1, 1, 1e-11), FACES), "(flat|open sheet)"),
    "a line": (Mesh(CORNERS * (1, 0, 0), FACES), "(point or a line|flat)"),
    "a point": (Mesh(CORNERS * 0, FACES), "point or a line"),
}


@pytest.mark.parametrize("kind", NOTHING)
def test_that_what_encloses_nothing_is_refused_in_one_sentence(kind):
    mesh, expected = NOTHING[kind]
    with pytest.raises(GeometryError, match=expected) as caught:
        repair(mesh)
    assert str(caught.value).endswith(".")


def test_that_a_tangle_is_refused_before_it_is_closed():
    """Twenty thousand random triangles between points about a centre."""
    rng = np.random.default_rng(0)
    with pytest.raises(GeometryError, match=r"is a tangle: its faces have [0-9,]+ times the surface"):
        repair(Mesh(rng.normal(size=(300, 3)), rng.integers(0, 300, (20_000, 3))))


def test_that_a_moebius_strip_is_refused():
    n = 30
    angle = 2 * np.pi * np.arange(n) / n
    spoke = np.column_stack(
        [np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)]
    )
    ring = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    vertices = np.concatenate([ring - 0.3 * spoke, ring + 0.3 * spoke])
    quads = [(k, (k + 1) % n + n * (k == n - 1), (k + 1) % n + n * (k != n - 1), k + n) for k in range(n)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    with pytest.raises(GeometryError, match=r"(one-sided|open sheet)"):
        repair(Mesh(vertices, faces))


def test_that_repairing_twice_changes_nothing_more():
    for mesh, _ in BROKEN.values():
        once = repair(mesh)
        assert repair(once.mesh).mesh is once.mesh


@pytest.mark.parametrize("seed", range(20))
def test_that_any_broken_sphere_gives_a_sound_mesh_or_one_sentence(seed):
    rng = np.random.default_rng(seed)
    faces = icosphere(2).faces.copy()
    faces = np.delete(faces, rng.integers(0, len(faces), rng.integers(0, 40)), axis=0)
    faces = np.concatenate([faces, rng.integers(0, 162, (rng.integers(0, 12), 3))])
    flips = rng.random(len(faces)) < rng.choice([0.0, 0.1, 0.5])
    faces[flips] = faces[flips, ::-1]
    with contextlib.suppress(GeometryError):
        result = repair(Mesh(icosphere(2).vertices, faces))
        assert result.health_after.sound
        assert 0.5 < result.mesh.volume / icosphere(2).volume < 1.2


def all_triangulations(corners):
    """Every triangulation of a polygon with these corners, as lists of triples."""
    if len(corners) < 3:
        return [[]]
    first, last = corners[0], corners[-1]
    return [
        [*left, (first, corners[k], last), *right]
        for k in range(1, len(corners) - 1)
        for left, right in itertools.product(
            all_triangulations(corners[: k + 1]), all_triangulations(corners[k:])
        )
    ]


def area(points, triangles):
    a, b, c = np.moveaxis(points[np.asarray(triangles)], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.mark.parametrize("n", [3, 4, 5, 6, 7, 8])
def test_that_a_rim_in_space_gets_the_least_of_all_triangulations(n):
    points = np.random.default_rng(n).random((n, 3))
    expected = min(area(points, triangles) for triangles in all_triangulations(list(range(n))))
    arguments, nothing = (points, np.zeros((n, n), dtype=np.bool_)), np.zeros((n - 2, 3), dtype=np.int64)
    found, closed = filled(least_area_triangles, arguments, nothing)
    assert closed
    assert area(points, found) == pytest.approx(expected)
