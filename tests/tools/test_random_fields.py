"""Random fields on the sphere have the variance that was asked, and no more than the degrees asked."""

import numpy as np
import pytest
from scipy.special import eval_legendre

from tools.make_samples.grains import even_sphere
from tools.make_samples.random_fields import SphereField


def test_that_the_variance_at_a_point_is_that_of_the_coefficients() -> None:
    amplitudes = {2: 0.3, 5: 0.1}
    points = even_sphere(50).vertices
    draws = [SphereField(amplitudes, np.random.default_rng(seed))(points) for seed in range(400)]
    expected = sum((2 * degree + 1) * a**2 for degree, a in amplitudes.items()) / (4 * np.pi)
    assert np.var(draws) == pytest.approx(expected, rel=0.1)
    assert np.mean(draws) == pytest.approx(0.0, abs=0.02)


def test_that_a_field_of_degree_three_is_reproduced_by_the_kernel_of_degree_three() -> None:
    """Funk-Hecke: the mean of (2 l + 1) P_l(<u, v>) f(v) over the sphere is f(u), and 0 for other degrees."""
    sphere = even_sphere(6000).vertices
    field = SphereField({3: 1.0}, np.random.default_rng(1))
    values = field(sphere)
    for degree, expected in ((3, values[:20]), (4, np.zeros(20))):
        kernel = (2 * degree + 1) * eval_legendre(degree, np.clip(sphere[:20] @ sphere.T, -1, 1))
        assert kernel @ values / len(sphere) == pytest.approx(expected, abs=5e-3)
