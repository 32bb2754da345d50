"""Hidden parts of meshes where they are known, and agreement with the fit of the same mesh."""

import numpy as np
import pytest

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.visibility import star_point_visibility

BALL = icosphere(3)


def revolved(profile):
    """A closed surface about z through points (radius, height), the first and last on the axis."""
    n, turns = len(profile), 48
    angle = np.arange(turns) * 2 * np.pi / turns
    rings = [(r * np.cos(angle), r * np.sin(angle), np.full(turns, z)) for r, z in profile[1:-1]]
    points = np.vstack(
        [(0, 0, profile[0][1]), *[np.column_stack(ring) for ring in rings], (0, 0, profile[-1][1])]
    )
    ring = 1 + np.arange(turns)
    onward = np.roll(ring, -1)
    faces = [np.column_stack([np.zeros(turns, int), onward, ring])]
    for k in range(n - 3):
        a, b, c, d = ring + k * turns, onward + k * turns, onward + (k + 1) * turns, ring + (k + 1) * turns
        faces += [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
    last = (n - 3) * turns
    faces.append(np.column_stack([ring + last, onward + last, np.full(turns, len(points) - 1)]))
    return Mesh(points, np.concatenate(faces))


def test_that_nothing_of_a_ball_is_hidden():
    seen = star_point_visibility(BALL.moved(shift=(5, 6, 7), scale=3.0))
    assert seen.hidden_surface_share == seen.unrepresentable_volume_share == 0.0
    assert seen.star_point == pytest.approx((15, 18, 21))
    assert seen.rule == "centre_of_mass"


def test_that_a_hat_brim_hides_what_a_fit_says_is_hidden():
    mushroom = revolved([(0, -2), (0.5, -2), (0.5, 0), (2, -1.2), (2.2, 0.3), (1, 1), (0, 1.2)])
    seen, fit = star_point_visibility(mushroom), fit_harmonics(mushroom, star_point=None)
    assert seen.hidden_surface_share == fit.hidden_surface_share > 0.02
    assert seen.unrepresentable_volume_share == pytest.approx(fit.unrepresentable_volume_share, abs=0.005)


def test_that_a_bowl_is_seen_from_a_point_inside_its_wall():
    bowl = revolved([(0, -1), (0.8, -0.6), (1, 0), (0.95, 0), (0.75, -0.5), (0, -0.9)])
    seen = star_point_visibility(bowl)
    assert seen.rule == "least_hidden_volume"
    assert seen.hidden_surface_share > 0.2


def test_that_an_open_mesh_has_no_inside_to_look_from():
    with pytest.raises(GeometryError, match="open"):
        star_point_visibility(Mesh(BALL.vertices, BALL.faces[1:]))
