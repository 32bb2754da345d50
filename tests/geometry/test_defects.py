"""The triangles that are shown to a user as faulty are those that were made faulty."""

import numpy as np

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import locate_defects
from regolith_studio.geometry.particle import Particle, defect_triangles
from regolith_studio.geometry.repair import repair
from regolith_studio.geometry.sphere_points import icosphere

BALL = icosphere(2)


def test_that_a_sound_mesh_has_no_trouble_spots():
    assert locate_defects(BALL) == {}
    assert locate_defects(Mesh(BALL.vertices, np.zeros((0, 3)))) == {}


def test_that_turned_faces_are_found():
    faces = BALL.faces.copy()
    faces[[3, 50]] = faces[[3, 50], ::-1]
    spots = locate_defects(Mesh(BALL.vertices, faces))
    assert list(spots) == ["turned"]
    assert spots["turned"].tolist() == [3, 50]


def test_that_the_faces_around_a_hole_are_found():
    spots = locate_defects(Mesh(BALL.vertices, BALL.faces[1:]))
    assert list(spots) == ["open"]
    assert len(spots["open"]) == 3


def test_that_double_and_degenerate_faces_are_found():
    faces = np.concatenate([BALL.faces, BALL.faces[7:8], [[5, 5, 9]]])
    spots = locate_defects(Mesh(BALL.vertices, faces))
    assert spots["double"].tolist() == [7, len(faces) - 2]
    assert spots["degenerate"].tolist() == [len(faces) - 1]
    assert 7 in spots["non-manifold"]


def test_that_small_and_crossing_bodies_are_found():
    small = BALL.moved(scale=0.5).moved(shift=(1, 0, 0))
    both = Mesh(
        np.concatenate([small.vertices, BALL.vertices]),
        np.concatenate([small.faces, BALL.faces + len(BALL.vertices)]),
    )
    spots = locate_defects(both)
    assert spots["small bodies"].tolist() == list(range(len(small.faces)))
    assert {bool(face < len(small.faces)) for face in spots["crossing"]} == {True, False}


def test_that_a_mended_mesh_shows_its_rim_and_what_now_fills_it():
    """Of a ball that lacks one triangle three others lie at the rim; one fills it, where it was missing."""
    done = repair(Mesh(BALL.vertices, BALL.faces[1:]))
    shown = defect_triangles(Particle("ball", done.mesh, repair=done))
    assert set(shown) == {"open", "filled"}
    assert len(shown["open"]) == 3
    (filling,) = shown["filled"]
    assert sorted(map(tuple, filling.round(9))) == sorted(map(tuple, BALL.triangles[0].round(9)))


def test_that_a_mesh_left_as_it_is_shows_its_own_faults():
    shown = defect_triangles(Particle("ball", Mesh(BALL.vertices, BALL.faces[1:])))
    assert set(shown) == {"open"}
