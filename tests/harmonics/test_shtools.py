"""What is loaded of pyshtools, and that the rest of it is left as it was."""

import subprocess
import sys

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from regolith_studio.harmonics.transform import call_shtools

ALONE = """
import sys
from regolith_studio.harmonics.transform import call_shtools
zeros, weights = call_shtools("expand.SHGLQ", 6)
assert abs(weights.sum() - 2) < 1e-14
heavy = {"pandas", "xarray", "matplotlib", "pyshtools"} & set(sys.modules)
assert not heavy, heavy
import pyshtools
assert (pyshtools.expand.SHGLQ(6)[0] == zeros).all()
assert pyshtools.backends.preferred_backend() in ("shtools", "ducc0")
"""


THREADS = """
from concurrent.futures import ThreadPoolExecutor
import numpy as np
import pytest
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.transform import analyse, evaluate_on_grid, ray_grid

kept = ShCoefficients(np.random.default_rng(0).normal(size=21**2))
grids = [ray_grid(degree) for degree in (20, 22, 24, 28, 31, 35)]
def there_and_back(grid):
    return analyse(grid, evaluate_on_grid(grid, kept), 20).values
wanted = [there_and_back(grid) for grid in grids]
with ThreadPoolExecutor(4) as pool:
    found = list(pool.map(there_and_back, grids * 100))
for k, values in enumerate(found):
    np.testing.assert_array_equal(values, wanted[k % len(grids)])
"""


@pytest.mark.slow
def test_that_four_threads_get_what_one_gets_and_nothing_crashes() -> None:
    """In its own process: what this looks for kills the one that it happens in."""
    subprocess.run([sys.executable, "-c", THREADS], check=True, timeout=120)


@pytest.mark.slow
def test_that_only_the_fortran_is_loaded_and_the_package_can_still_be_imported() -> None:
    subprocess.run([sys.executable, "-W", "ignore", "-c", ALONE], check=True, timeout=120)


def test_that_the_nodes_are_those_of_gauss_and_legendre() -> None:
    zeros, weights = call_shtools("expand.SHGLQ", 12)
    nodes, expected = leggauss(13)
    assert np.allclose(np.sort(zeros), nodes, atol=1e-14)
    assert np.allclose(np.sort(weights), np.sort(expected), atol=1e-14)
