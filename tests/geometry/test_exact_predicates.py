"""Signs of determinants against rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.ray_casting import sign_of_cross_product, sign_of_triple_product


def exact_sign(a: FloatArray, b: FloatArray, c: FloatArray) -> int:
    """Of a . (b x c), in fractions."""
    u, v, w = ([Fraction(float(value)) for value in vector] for vector in (a, b, c))
    total = sum(u[i] * (v[(i + 1) % 3] * w[(i + 2) % 3] - v[(i + 2) % 3] * w[(i + 1) % 3]) for i in range(3))
    return (total > 0) - (total < 0)


@pytest.mark.parametrize("seed", range(200))
def test_that_signs_of_nearly_flat_triples_are_true(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(2, 3))
    c = rng.normal() * a + rng.normal() * b
    c[seed % 3] = np.nextafter(c[seed % 3], np.inf * (-1) ** seed)
    assert sign_of_triple_product(a, b, c) == exact_sign(a, b, c)
    assert sign_of_triple_product(b, a, c) == -exact_sign(a, b, c)


def test_that_truly_flat_triples_have_sign_zero() -> None:
    a, b = np.array([1.0, 2.0, 3.0]), np.array([-4.0, 5.0, 6.0])
    assert sign_of_triple_product(a, b, 2.0 * a - 3.0 * b) == 0
    assert sign_of_triple_product(a, a, b) == 0


@pytest.mark.parametrize("seed", range(20))
def test_that_signs_of_nearly_parallel_cross_products_are_true(seed: int) -> None:
    a = np.random.default_rng(seed).normal(size=3)
    b = 3.0 * a
    b[1] = np.nextafter(b[1], np.inf)
    for axis in range(3):
        unit = np.eye(3)[axis]
        assert sign_of_cross_product(a, b, axis) == exact_sign(unit, a, b)
