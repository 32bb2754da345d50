"""Radii, star points and visibility: spheres off centre, brackets and rings."""

import pickle

import numpy as np
import pytest

from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.radius_function import (
    RULES,
    is_closed,
    require_solid,
    sample_radius,
)
from regolith_studio.harmonics.star_point import (
    centre_of_mass,
    hidden_faces,
    hidden_surface_share,
    hidden_volume,
    inner_point,
    kernel_centre,
    least_hidden_volume,
    star_point_visibility,
)
from regolith_studio.harmonics.transform import ray_grid


def test_that_the_radius_of_a_sphere_off_centre_has_its_closed_form():
    away, directions = np.array([0.4, -0.2, 0.3]), fibonacci_directions(300)
    along = directions @ -away
    wanted = along + np.sqrt(along**2 + 1 - away @ away)
    found = sample_radius(icosphere(5), away, directions)
    np.testing.assert_allclose(found.radii, wanted, atol=8e-4)
    assert (found.n_crossings == 1).all()


def test_that_the_default_rule_keeps_the_volume_of_a_bracket(bracket):
    grid = ray_grid(60)
    radius = sample_radius(bracket, (0.5, 2.0, 0.5), grid.directions)
    assert radius.n_crossings.max() == 3
    assert 4 * np.pi / 3 * grid.mean(radius.radii**3) == pytest.approx(5.0, rel=0.01)
    assert 4 * np.pi / 3 * grid.mean(radius.outermost**3) > 5.4
    assert 4 * np.pi / 3 * grid.mean(radius.first**3) == pytest.approx(5 - 1.75, rel=0.02)


def test_that_the_rules_are_ordered_and_equal_on_star_shaped_particles(bracket):
    many = sample_radius(bracket, (0.5, 2.0, 0.5), fibonacci_directions(500))
    assert (many.first <= many.volume).all()
    assert (many.volume <= many.outermost + 1e-12).all()
    once = many.n_crossings == 1
    np.testing.assert_allclose(many.first[once], many.outermost[once])
    np.testing.assert_allclose(many.first[once], many.volume[once])


def test_that_a_star_point_outside_is_refused_in_one_sentence(bracket):
    for outside in ((2.5, 2.5, 0.5), (50.0, 0.0, 0.0)):
        with pytest.raises(GeometryError, match=r"star point \(.*\) lies outside the particle\.$"):
            sample_radius(bracket, outside, fibonacci_directions(100))


def test_that_an_unknown_rule_is_refused(bracket):
    with pytest.raises(InputError, match=", ".join(RULES)):
        sample_radius(bracket, (0.5, 0.5, 0.5), fibonacci_directions(10), "nearest")


def test_that_a_radius_function_survives_pickling(bracket):
    radius = sample_radius(bracket, (0.5, 0.5, 0.5), fibonacci_directions(10), "first")
    copy = pickle.loads(pickle.dumps(radius))
    np.testing.assert_array_equal(copy.radii, radius.radii)


def test_that_closed_is_told_from_open_and_from_badly_wound(bracket):
    faces = bracket.faces
    assert is_closed(bracket)
    assert not is_closed(Mesh(bracket.vertices, faces[1:]))
    flipped = faces.copy()
    flipped[0] = flipped[0, ::-1]
    assert not is_closed(Mesh(bracket.vertices, flipped))
    seams = Mesh(bracket.triangles.reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3))
    assert is_closed(seams)


def test_that_open_flat_and_inverted_meshes_are_refused(bracket):
    with pytest.raises(GeometryError, match=r"open"):
        require_solid(Mesh(bracket.vertices, bracket.faces[1:]))
    with pytest.raises(GeometryError, match=r"inside out"):
        require_solid(Mesh(bracket.vertices, bracket.faces[:, ::-1]))
    with pytest.raises(GeometryError, match=r"no volume"):
        require_solid(Mesh(bracket.vertices * [1, 1, 0], bracket.faces))
    with pytest.raises(GeometryError, match=r"at least four triangles"):
        require_solid(Mesh(bracket.vertices, bracket.faces[:3]))


def test_that_the_kernel_centre_of_a_bracket_is_the_middle_of_its_corner(bracket):
    np.testing.assert_allclose(kernel_centre(bracket), [0.5, 0.5, 0.5], atol=1e-9)
    np.testing.assert_allclose(kernel_centre(bracket.moved(scale=1e-6)), 5e-7, rtol=1e-6)


def test_that_a_ring_has_no_kernel(torus):
    with pytest.raises(GeometryError, match=r"kernel is empty"):
        kernel_centre(torus(2.0, 0.5))


def test_that_least_hidden_volume_improves_on_the_centre_of_mass(prism):
    """A foot of four cells and one on top of the first: (1.7, 0.7) does not see 0.785 of its 5 squares."""
    outline = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 2), (0, 2)]
    boot = prism(outline, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)], 1.0)
    np.testing.assert_allclose(centre_of_mass(boot), [1.7, 0.7, 0.5], atol=1e-12)
    start = hidden_volume(boot, centre_of_mass(boot))
    assert start == pytest.approx(0.785 / 5, abs=0.02)
    assert hidden_volume(boot, least_hidden_volume(boot)) < 0.8 * start


def test_that_a_point_inside_a_ring_is_found_where_the_centre_of_mass_lies_outside(torus):
    ring = torus(2.0, 0.5)
    assert hidden_volume(ring, centre_of_mass(ring)) == np.inf
    x, y, z = inner_point(ring)
    assert (np.hypot(x, y) - 2.0) ** 2 + z**2 < 0.5**2
    x, y, z = least_hidden_volume(ring)
    assert (np.hypot(x, y) - 2.0) ** 2 + z**2 < 0.5**2


def test_that_no_volume_of_a_star_shaped_body_is_hidden_not_even_by_rounding():
    radius = sample_radius(icosphere(3), (0.3, 0.1, -0.2), fibonacci_directions(500))
    assert (radius.hidden_cubes == 0.0).all()


def test_that_the_hidden_share_of_a_bracket_is_what_geometry_says(prism):
    """From the middle of the left arm's upper part the right arm hides behind the inner corner.

    Seen from (0.5, 2, 0.5) the line through the inner corner (1, 1) meets the floor y = 0 at x = 1.5:
    of the outline hidden are the arm's top from x = 1 to 3 (2), its end (1) and its floor from 1.5 (1.5).
    """
    n = 40
    arm = [(1.0 + 2.0 * k / n, 1.0) for k in range(n, -1, -1)]
    floor = [(3.0 * k / n, 0.0) for k in range(n + 1)]
    outline = [*floor, *arm, (1.0, 3.0), (0.0, 3.0)]
    columns = prism(outline, [(0, 1, 2)], 1.0)
    sides = Mesh(columns.vertices, columns.faces[2:])
    hidden = hidden_faces(sides, np.array([0.5, 2.0, 0.5]))
    assert sides.face_areas[hidden].sum() == pytest.approx(2.0 + 1.0 + 1.5, abs=0.15)


def test_that_the_share_of_a_large_mesh_is_estimated_from_probes(torus):
    coarse, fine = torus(2.0, 0.5, n=60), torus(2.0, 0.5, n=180)
    point = np.array([2.0, 0.0, 0.0])
    assert len(coarse.faces) < 8000 < len(fine.faces)
    assert hidden_surface_share(fine, point) == pytest.approx(hidden_surface_share(coarse, point), abs=0.02)


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
