"""Wadell's roundness against closed forms: fillets, ellipses, superellipses, lobes, rounded boxes."""

import numpy as np
import pytest

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.harmonics.radius_function import Ellipsoid
from regolith_studio.harmonics.roundness import inscribed_radius, outline_roundness, wadell_roundness

ANGLES = np.linspace(0.0, 2 * np.pi, 2048, endpoint=False)
UNIT = ShCoefficients(np.array([np.sqrt(4 * np.pi)]))
"""A radius of 1."""


def _polar(radius: np.ndarray) -> np.ndarray:
    return np.column_stack((np.cos(ANGLES), np.sin(ANGLES))) * np.broadcast_to(radius, ANGLES.shape)[:, None]


def _rounded_polygon(n_sides: int, fillet: float, n: int = 240) -> np.ndarray:
    """A regular polygon about a circle of radius 1 whose corners are arcs of radius `fillet`."""
    half = np.pi / n_sides
    reach = (1 - fillet) / np.cos(half)
    points = []
    for corner in (2 * np.arange(n_sides) + 1) * half:
        turn = np.linspace(corner - half, corner + half, n)
        arc = fillet * np.column_stack((np.cos(turn), np.sin(turn)))
        arc += reach * np.array([np.cos(corner), np.sin(corner)])
        after = corner + 2 * half
        end = reach * np.array([np.cos(after), np.sin(after)])
        end += fillet * np.array([np.cos(corner + half), np.sin(corner + half)])
        points += [arc, np.linspace(arc[-1], end, n)[1:-1]]
    return np.concatenate(points)


def _rounded_box(half: tuple[float, float, float], fillet: float) -> Mesh:
    """A box whose edges are parts of cylinders and spheres of radius `fillet`, by bisection along rays."""
    sphere = icosphere(5)
    low, high = np.zeros(len(sphere.vertices)), np.full(len(sphere.vertices), 4.0)
    for _ in range(50):
        middle = (low + high) / 2
        beyond = np.abs(sphere.vertices * middle[:, None]) - (np.array(half) - fillet)
        inside = np.linalg.norm(np.maximum(beyond, 0), axis=1) < fillet
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return Mesh(sphere.vertices * low[:, None], sphere.faces)


@pytest.mark.parametrize("n_sides", [3, 4, 6])
@pytest.mark.parametrize("fillet", [0.05, 0.3, 0.8])
def test_that_a_rounded_polygon_has_its_fillet_over_its_inscribed_circle(n_sides, fillet):
    assert outline_roundness(_rounded_polygon(n_sides, fillet)) == pytest.approx(fillet, rel=1e-3)


@pytest.mark.parametrize("ratio", [0.9, 0.6, 0.3])
def test_that_an_ellipse_has_the_ratio_of_its_axes(ratio):
    """Its ends have the radius of curvature b^2 / a, its inscribed circle b."""
    ellipse = np.column_stack((np.cos(ANGLES), ratio * np.sin(ANGLES)))
    assert outline_roundness(ellipse) == pytest.approx(ratio, rel=1e-3)


@pytest.mark.parametrize("power", [3, 4])
def test_that_a_superellipse_has_the_curvature_of_its_diagonal(power):
    """|x|^p + |y|^p = 1 bends by (p - 1) 2^(1/p - 1/2) at x = y, and holds the unit circle."""
    curve = _polar((np.abs(np.cos(ANGLES)) ** power + np.abs(np.sin(ANGLES)) ** power) ** (-1 / power))
    truth = 1 / ((power - 1) * 2 ** (1 / power - 0.5))
    assert outline_roundness(curve) == pytest.approx(truth, rel=1e-3)


def test_that_lobes_count_and_the_hollows_between_them_do_not():
    """r = 1 + .1 cos 5t: at its lobes r = 1.1, r'' = -2.5, and its hollows hold a circle of .9."""
    truth = 1.1**3 / (1.1**2 + 1.1 * 2.5) / 0.9
    assert outline_roundness(_polar(1 + 0.1 * np.cos(5 * ANGLES))) == pytest.approx(truth, rel=1e-3)


def test_that_neither_size_place_nor_the_first_point_matter():
    curve = _rounded_polygon(5, 0.2)
    moved = np.add(np.roll(7.0 * curve, 100, axis=0), [30.0, -4.0])
    assert outline_roundness(moved) == pytest.approx(outline_roundness(curve), rel=1e-3)


def test_that_a_circle_and_a_stadium_are_wholly_round():
    turn = np.linspace(-np.pi / 2, np.pi / 2, 400)
    end = np.column_stack((np.cos(turn), np.sin(turn)))
    side = np.linspace([1.0, 1.0], [-1.0, 1.0], 300)[1:-1]
    stadium = np.concatenate((np.add(end, [1.0, 0.0]), side, np.subtract(-end, [1.0, 0.0]), -side))
    assert outline_roundness(_polar(np.ones(1))) == 1.0
    assert outline_roundness(stadium) == pytest.approx(1.0, abs=1e-3)


def test_that_the_inscribed_circle_may_lie_off_the_middle():
    """Of a circle of radius 1 with a bay, the largest circle inside lies beside the bay."""
    triangle = _rounded_polygon(3, 0.1)
    assert inscribed_radius(np.add(triangle, [5.0, 0.0])) == pytest.approx(1.0, rel=1e-3)
    bay = _polar(1 - 0.8 * np.exp(-(((ANGLES - np.pi) / 0.3) ** 2)))
    centres = np.stack(np.meshgrid(np.linspace(-1, 1, 81), np.linspace(-1, 1, 81)), axis=-1).reshape(-1, 2)
    angle = np.arctan2(centres[:, 1], centres[:, 0]) % (2 * np.pi)
    rim = 1 - 0.8 * np.exp(-(((angle - np.pi) / 0.3) ** 2))
    centres = centres[np.hypot(*centres.T) < rim]
    searched = np.linalg.norm(centres[:, None] - bay[None, ::8], axis=2).min(axis=1).max()
    assert inscribed_radius(bay) == pytest.approx(searched, abs=0.02)


def test_that_the_section_holds_the_two_longer_axes_of_an_ellipsoid():
    axes = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    ellipsoid = HarmonicFit(UNIT, np.zeros(3), reference=Ellipsoid(axes, np.array([1.0, 3.0, 2.0])))
    assert wadell_roundness(ellipsoid) == pytest.approx(2 / 3, rel=1e-3)
    assert wadell_roundness(HarmonicFit(UNIT, np.zeros(3))) == 1.0


@pytest.mark.slow
@pytest.mark.parametrize("half", [(1.1, 1.0, 0.9), (1.5, 1.0, 0.7)])
@pytest.mark.parametrize("fillet", [0.3, 0.5, 0.6])
def test_that_the_fit_of_a_rounded_box_finds_its_fillets(half, fillet):
    fit = fit_harmonics(_rounded_box(half, fillet), 30)
    for l_max in (20, 30):
        assert wadell_roundness(fit.truncated(l_max)) == pytest.approx(fillet, rel=0.25)


def test_that_an_expansion_with_a_negative_radius_is_refused():
    values = np.zeros(9)
    values[0], values[6] = 1.0, 5.0
    with pytest.raises(GeometryError, match="negative"):
        wadell_roundness(HarmonicFit(ShCoefficients(values), np.zeros(3)))
