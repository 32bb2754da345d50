"""Directions: spread evenly, on the sphere, closed."""

import numpy as np
import pytest

from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere


@pytest.mark.parametrize("n", [1, 2, 37, 2000])
def test_that_fibonacci_directions_are_unit_vectors(n: int) -> None:
    directions = fibonacci_directions(n)
    assert directions.shape == (n, 3)
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1.0, abs=1e-14)


def test_that_directions_belong_to_who_asked_for_them() -> None:
    fibonacci_directions(30)[:] = 0.0
    assert np.linalg.norm(fibonacci_directions(30), axis=1) == pytest.approx(1.0)


def test_that_fibonacci_directions_integrate_polynomials_over_the_sphere() -> None:
    x, y, z = fibonacci_directions(4000).T
    assert np.mean(z**2) == pytest.approx(1 / 3, abs=1e-6)
    assert np.mean(x**4) == pytest.approx(1 / 5, abs=1e-4)
    assert np.mean(x**2 * y**2) == pytest.approx(1 / 15, abs=1e-4)
    assert abs(np.mean(x * y * z)) < 1e-5


@pytest.mark.parametrize("level", range(5))
def test_that_an_icosphere_has_the_known_counts_and_is_closed(level: int) -> None:
    sphere = icosphere(level)
    edges = np.sort(sphere.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, shared_by = np.unique(edges, axis=0, return_counts=True)
    assert len(sphere.vertices) == 10 * 4**level + 2
    assert len(sphere.faces) == 20 * 4**level
    assert set(shared_by) == {2}
    assert np.linalg.norm(sphere.vertices, axis=1) == pytest.approx(1.0, abs=1e-14)


def test_that_icospheres_converge_to_the_ball_with_the_square_of_the_edge() -> None:
    missing = [4 * np.pi / 3 - icosphere(level).volume for level in (3, 4)]
    assert missing[0] > missing[1] > 0.0
    assert missing[0] / missing[1] == pytest.approx(4.0, rel=0.01)


def test_that_vertices_of_a_level_come_first_in_the_next() -> None:
    assert np.array_equal(icosphere(3).vertices[: len(icosphere(2).vertices)], icosphere(2).vertices)


def test_that_impossible_counts_are_refused() -> None:
    with pytest.raises(ValueError, match="at least 1"):
        fibonacci_directions(0)
    with pytest.raises(ValueError, match="0 to 8"):
        icosphere(9)
