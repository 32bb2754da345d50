"""The triangles that are shown to a user as faulty are those that were made faulty."""

import numpy as np

from regolith_studio.geometry.directions import icosphere
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.trouble_spots import trouble_spots

BALL = icosphere(2)


def test_that_a_sound_mesh_has_no_trouble_spots():
    assert trouble_spots(BALL) == {}
    assert trouble_spots(Mesh(BALL.vertices, np.zeros((0, 3)))) == {}


def test_that_turned_faces_are_found():
    faces = BALL.faces.copy()
    faces[[3, 50]] = faces[[3, 50], ::-1]
    spots = trouble_spots(Mesh(BALL.vertices, faces))
    assert list(spots) == ["turned"]
    assert spots["turned"].tolist() == [3, 50]


def test_that_the_faces_around_a_hole_are_found():
    spots = trouble_spots(Mesh(BALL.vertices, BALL.faces[1:]))
    assert list(spots) == ["open"]
    assert len(spots["open"]) == 3


def test_that_double_and_degenerate_faces_are_found():
    faces = np.concatenate([BALL.faces, BALL.faces[7:8], [[5, 5, 9]]])
    spots = trouble_spots(Mesh(BALL.vertices, faces))
    assert spots["double"].tolist() == [7, len(faces) - 2]
    assert spots["degenerate"].tolist() == [len(faces) - 1]
    assert 7 in spots["crowded"]


def test_that_small_and_crossing_bodies_are_found():
    small = BALL.moved(scale=0.5).moved(shift=(1, 0, 0))
    both = Mesh(
        np.concatenate([small.vertices, BALL.vertices]),
        np.concatenate([small.faces, BALL.faces + len(BALL.vertices)]),
    )
    spots = trouble_spots(both)
    assert spots["small bodies"].tolist() == list(range(len(small.faces)))
    assert {bool(face < len(small.faces)) for face in spots["crossing"]} == {True, False}
