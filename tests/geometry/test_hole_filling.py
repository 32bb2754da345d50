"""How open surfaces go round what is inside them: solid angles, cubes without faces, sheets."""

import numpy as np
import pytest

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.hole_filling import enclosure, solid_angles
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.repair import repair
from regolith_studio.geometry.sphere_points import icosphere

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
SQUARES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
BOX = Mesh(CORNERS, [f for a, b, c, d in SQUARES for f in ((a, b, c), (a, c, d))])
BALL = icosphere(4)


def cut(shape, share):
    """An ellipsoid without the share of its surface that lies highest along its first axis."""
    height = BALL.triangles[:, :, 0].mean(axis=1)
    return Mesh(BALL.vertices * shape, BALL.faces[height < np.quantile(height, 1 - share)])


def sheet(place):
    """A square of 39 x 39 x 2 triangles, moved by a function of the plane's points."""
    n = 40
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(-1, 1, n)] * 2, indexing="ij"))
    at = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    return Mesh(place(x, y), np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])]))


def crumpled(seed):
    rng = np.random.default_rng(seed)

    def place(x, y):
        moved = 0.6 * np.column_stack([x, y, 0 * x])
        for _ in range(12):
            across, phase = rng.normal(size=2) * 4, rng.uniform(0, 2 * np.pi)
            moved += 0.2 * np.sin(across[0] * x + across[1] * y + phase)[:, None] * rng.normal(size=3)
        return moved

    return sheet(place)


def bowl(x, y):
    return np.column_stack([x, y, 0.2 * (x**2 + y**2)])


def test_that_a_closed_surface_fills_all_directions_from_inside_and_none_from_outside():
    seen = solid_angles(BALL.triangles, np.array([[0.0, 0.1, 0.2], [0.5, 0.5, -0.5], [0.0, 0.0, 1.5]]))
    assert seen == pytest.approx([4 * np.pi, 4 * np.pi, 0.0], abs=1e-9)


def test_that_a_face_of_a_cube_takes_a_sixth_of_the_directions_from_its_middle():
    assert solid_angles(BOX.triangles[:2], np.zeros((1, 3))) == pytest.approx([4 * np.pi / 6])


@pytest.mark.parametrize("missing", [1, 2, 3])
def test_that_a_cube_winds_by_a_sixth_less_for_each_face_that_it_lacks(missing):
    """By symmetry each face takes a sixth of the directions in the mean over the points inside."""
    found = enclosure(BOX, 2 * missing)
    assert found.winding == pytest.approx(1 - missing / 6, abs=0.01)
    assert found.wrapped_once == pytest.approx(1.0)


def test_that_two_balls_that_overlap_wrap_twice_what_they_share():
    """Two balls at distance 1 share a lens of 5 / 27 of their union: 5 pi / 12 of 27 pi / 12."""
    balls = Mesh(
        np.vstack([BALL.vertices, BALL.vertices + np.eye(3)[0]]), np.vstack([BALL.faces, BALL.faces + 2562])
    )
    assert enclosure(balls, 0).wrapped_once == pytest.approx(1 - 5 / 27, abs=0.01)


def test_that_no_volume_has_no_inside():
    flat = Mesh(CORNERS * (1, 1, 0), BOX.faces)
    assert enclosure(flat, 2).inside == 0.0


@pytest.mark.parametrize("shape", [(1, 1, 1), (2, 1, 0.5), (0.5, 1, 2)])
@pytest.mark.parametrize("share", [0.01, 0.1, 0.3, 0.5])
def test_that_ellipsoids_with_a_hole_of_up_to_a_half_are_closed(shape, share):
    lid = repair(cut(shape, share))
    assert lid.health_after.sound
    assert lid.holes == 1
    if share == 0.5:
        assert lid.mesh.volume == pytest.approx(2 / 3 * np.pi, rel=0.08)


def test_that_half_a_bumpy_ball_is_a_body():
    half = cut((1, 1, 1), 0.5)
    bumps = 1 + 0.1 * np.random.default_rng(1).normal(size=(len(half.vertices), 1))
    assert repair(Mesh(half.vertices * bumps, half.faces)).health_after.sound


@pytest.mark.parametrize("seed", range(6))
def test_that_crumpled_sheets_are_refused_however_short_their_rim_is(seed):
    with pytest.raises(GeometryError, match="open sheet"):
        repair(crumpled(seed))


def test_that_a_shallow_bowl_is_a_sheet():
    with pytest.raises(GeometryError, match="open sheet"):
        repair(sheet(bowl))
