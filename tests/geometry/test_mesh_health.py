"""What the inspection of a mesh finds, against shapes whose faults are known."""

import numpy as np
import pytest
import trimesh

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import MeshHealth, inspect
from regolith_studio.geometry.self_intersection import count_self_intersections
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.geometry.topology import edge_table, find_bodies, genus, neighbours
from tests.geometry.solids import CUBE, joined, turned_round


def grid_surface(n, m, place, twist=False):
    """A closed band of n by m quadrilaterals; with `twist` its ends meet upside down."""
    vertices = [place(i / n, j / m) for i in range(n) for j in range(m)]
    faces = []
    for i in range(n):
        for j in range(m - twist):
            k, flip = (i + 1) % n, twist and i == n - 1
            a, b = i * m + j, i * m + (j + 1) % m
            c, d = k * m + (m - 1 - j if flip else j), k * m + ((m - 2 - j) if flip else (j + 1) % m)
            faces += [(a, c, b), (b, c, d)]
    return Mesh(vertices, faces)


def torus(n=24, m=12, large=2.0, small=0.5):
    def place(s, t):
        u, v = 2 * np.pi * s, 2 * np.pi * t
        ring = large + small * np.cos(v)
        return ring * np.cos(u), ring * np.sin(u), small * np.sin(v)

    return grid_surface(n, m, place)


def moebius(n=24, m=4):
    def place(s, t):
        u, v = 2 * np.pi * s, t - 3 / 8
        ring = 1 + v * np.cos(u / 2)
        return ring * np.cos(u), ring * np.sin(u), v * np.sin(u / 2)

    return grid_surface(n, m, place, twist=True)


def test_that_a_cube_is_sound():
    health = inspect(CUBE)
    assert health == MeshHealth(
        faces=12,
        vertices=8,
        bodies=1,
        watertight=True,
        consistent_winding=True,
        volume=1.0,
        euler_number=2,
        degenerate_faces=0,
        duplicate_faces=0,
        open_edges=0,
        non_manifold_edges=0,
        inverted_bodies=0,
        seam_vertices=0,
        self_intersections=0,
    )
    assert health.sound
    assert health.problems == ()


def test_that_a_torus_has_one_tunnel_and_is_sound():
    health = inspect(torus())
    assert (health.euler_number, health.handles, health.sound) == (0, 1, True)
    assert health.problems == ("It has 1 tunnel through it (Euler number 0).",)


def test_that_an_inside_out_cube_has_negative_volume():
    health = inspect(turned_round(CUBE))
    assert health.volume == pytest.approx(-1.0)
    assert not health.sound
    assert "Its normals point inwards." in health.problems


def test_that_one_turned_face_breaks_the_winding_only():
    faces = CUBE.faces.copy()
    faces[3] = faces[3][::-1]
    health = inspect(Mesh(CUBE.vertices, faces))
    assert (health.watertight, health.consistent_winding, health.sound) == (True, False, False)


def test_that_a_missing_face_opens_three_edges():
    health = inspect(Mesh(CUBE.vertices, CUBE.faces[1:]))
    assert (health.open_edges, health.watertight, health.sound) == (3, False, False)
    assert "It is not closed: 3 edges belong to one face only." in health.problems


def test_that_separate_bodies_are_counted():
    health = inspect(joined(CUBE, CUBE.moved(shift=(3, 0, 0)), CUBE.moved(shift=(0, 5, 0))))
    assert (health.bodies, health.euler_number, health.sound) == (3, 6, False)
    assert health.volume == pytest.approx(3.0)


def test_that_a_cavity_counts_as_an_inverted_body():
    health = inspect(joined(CUBE, turned_round(CUBE.moved(scale=0.5).moved(shift=(0.25, 0.25, 0.25)))))
    assert (health.bodies, health.inverted_bodies) == (2, 1)
    assert health.volume == pytest.approx(1 - 1 / 8)
    assert "1 closed body is turned inwards: cavities or nested shells." in health.problems


def test_that_faces_without_area_are_counted():
    vertices = np.concatenate([CUBE.vertices, [[0.5, 0.0, 0.0]]])
    faces = np.concatenate([CUBE.faces, [[0, 0, 1], [0, 8, 4]]])
    assert inspect(Mesh(vertices, faces)).degenerate_faces == 2


def test_that_thin_faces_are_not_degenerate():
    needle = Mesh([[0, 0, 0], [1, 0, 0], [0.5, 1e-6, 0]], [[0, 1, 2]])
    assert inspect(needle).degenerate_faces == 0


def test_that_double_faces_are_counted_whatever_their_winding():
    faces = np.concatenate([CUBE.faces, CUBE.faces[:2], CUBE.faces[2:3, ::-1]])
    health = inspect(Mesh(CUBE.vertices, faces))
    assert health.duplicate_faces == 3
    assert health.non_manifold_edges > 0


def test_that_a_seam_is_told_from_other_openings():
    split = Mesh(CUBE.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3))
    assert inspect(split).seam_vertices == 28
    assert inspect(split).problems[0] == "28 vertices lie exactly on another: seams cut the surface."
    assert inspect(CUBE).seam_vertices == 0


def test_that_two_cubes_on_one_edge_have_a_crowded_edge():
    both = joined(CUBE, CUBE.moved(shift=(1, 1, 0)))
    faces = np.where(both.faces == 8, 6, np.where(both.faces == 9, 7, both.faces))
    health = inspect(Mesh(both.vertices, faces))
    assert (health.non_manifold_edges, health.watertight) == (1, False)
    assert "It is not manifold: 1 edge belongs to three faces or more." in health.problems


def test_that_a_moebius_strip_has_no_consistent_winding():
    mesh = moebius()
    table = edge_table(mesh.faces, len(mesh.vertices))
    assert find_bodies(neighbours(table), table.forward).conflicts > 0
    assert not inspect(mesh).consistent_winding


def test_that_a_flat_mesh_has_no_volume_and_is_not_sound():
    back_to_back = np.concatenate([CUBE.faces[:1], CUBE.faces[:1, ::-1]])
    health = inspect(Mesh(CUBE.vertices @ [[0.1, 0.7, 0], [0.3, 0.3, 0.3], [0.9, 0.2, 0.1]], back_to_back))
    assert health.volume == 0.0
    assert not health.sound
    assert "It encloses no volume." in health.problems


def test_that_a_mesh_without_faces_says_so():
    health = inspect(Mesh(CUBE.vertices, np.zeros((0, 3))))
    assert not health.sound
    assert health.problems == ("It has no faces.",)


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1.0, 1e6, 1e12])
def test_that_findings_do_not_depend_on_unit_or_place(scale):
    mesh = joined(torus(), CUBE.moved(shift=(0.1, 1.3, 0.2)), turned_round(CUBE.moved(shift=(9, 0, 0))))
    plain, moved = inspect(mesh).as_dict(), inspect(mesh.moved(shift=(3, -5, 7), scale=scale)).as_dict()
    assert moved.pop("volume") == pytest.approx(plain.pop("volume") * scale**3)
    assert moved == plain


def _side(a, b, c, d):
    return int(np.sign(round(np.linalg.det(np.array([b - a, c - a, d - a], dtype=float)))))


def _crosses(one, other):
    """Whether an edge of one integer triangle passes through the inside of the other, by signs of volumes."""
    for a, b in ((one, other), (other, one)):
        for k in range(3):
            p, q = a[k], a[(k + 1) % 3]
            if _side(p, *b) * _side(q, *b) < 0:
                around = {_side(p, q, b[i], b[(i + 1) % 3]) for i in range(3)}
                if len(around) == 1 and 0 not in around:
                    return True
    return False


@pytest.mark.slow
def test_that_crossing_triangles_are_counted_as_a_plain_search_counts_them():
    rng = np.random.default_rng(5)
    corners = rng.integers(0, 40, (150, 1, 3)) + rng.integers(-9, 10, (150, 3, 3))
    expected = sum(_crosses(corners[i], corners[j]) for i in range(150) for j in range(i))
    assert expected > 20
    assert (
        count_self_intersections(corners.reshape(-1, 3).astype(float), np.arange(450).reshape(-1, 3))
        == expected
    )


def test_that_closed_convex_meshes_do_not_cross_themselves():
    assert count_self_intersections(icosphere(4).vertices, icosphere(4).faces) == 0


def test_that_two_cubes_that_interpenetrate_cross():
    health = inspect(joined(CUBE, CUBE.moved(shift=(0.5, 0.4, 0.3))))
    assert health.self_intersections
    assert any("cross each other" in problem for problem in health.problems)


def test_that_the_search_for_crossings_can_be_left_out():
    assert inspect(CUBE, self_intersections=False).self_intersections is None
    assert inspect(CUBE, self_intersections=False).problems == ()


def test_that_a_hopeless_search_for_crossings_is_given_up_and_said():
    rng = np.random.default_rng(1)
    tangle = Mesh(rng.random((9000, 3)), np.arange(9000).reshape(-1, 3))
    health = inspect(tangle)
    assert health.self_intersections is None
    assert any("not searched" in problem for problem in health.problems)


@pytest.mark.parametrize("turned", [False, True])
def test_that_cones_that_meet_in_their_tips_touch_in_a_corner_and_have_no_tunnel(turned) -> None:
    """Two tetrahedra that share a vertex have one corner less than two spheres."""
    corners = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 1], [-1, -1, 1.0]])
    faces = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]])
    both = np.vstack([corners, -corners[1:]])
    mirrored = np.where(faces == 0, 0, faces + 3)[:, ::-1]
    found = inspect(Mesh(both, np.vstack([faces, mirrored[:, ::-1] if turned else mirrored])))
    assert (found.euler_number, found.pinched_corners, found.handles) == (3, 1, 0)
    assert "Its surface touches itself in 1 corner." in found.problems


def test_that_one_body_may_touch_itself_in_a_corner() -> None:
    """Two opposite corners of a ball made one: Euler number 1, and not a tunnel."""
    ball = icosphere(2)
    far = int(np.argmin(ball.vertices @ ball.vertices[0]))
    found = inspect(Mesh(ball.vertices, np.where(ball.faces == far, 0, ball.faces)))
    assert (found.euler_number, found.pinched_corners, found.handles, found.bodies) == (1, 1, 0, 1)
    assert not any("tunnel" in problem for problem in found.problems)


def test_that_the_genus_of_a_ball_is_0_and_of_two_rings_2() -> None:
    ball = trimesh.creation.icosphere(1)
    ring = trimesh.creation.torus(3.0, 1.0, major_sections=12, minor_sections=8)
    assert genus(ball.faces, len(ball.vertices)) == 0
    assert genus(ring.faces, len(ring.vertices)) == 1
    pair = trimesh.util.concatenate([ring, ring.copy().apply_translation((20.0, 0.0, 0.0))])
    assert genus(pair.faces, len(pair.vertices)) == 2
    assert genus(ring.faces[1:], len(ring.vertices)) == 0
