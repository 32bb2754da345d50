"""What is loaded of pyshtools, and that the rest of it is left as it was."""

import subprocess
import sys

import numpy as np
from numpy.polynomial.legendre import leggauss

from regolith_studio.harmonics import shtools

ALONE = """
import sys
from regolith_studio.harmonics import shtools
zeros, weights = shtools.call("expand.SHGLQ", 6)
assert abs(weights.sum() - 2) < 1e-14
heavy = {"pandas", "xarray", "matplotlib", "pyshtools"} & set(sys.modules)
assert not heavy, heavy
import pyshtools
assert (pyshtools.expand.SHGLQ(6)[0] == zeros).all()
assert pyshtools.backends.preferred_backend() in ("shtools", "ducc0")
"""


def test_that_only_the_fortran_is_loaded_and_the_package_can_still_be_imported() -> None:
    subprocess.run([sys.executable, "-W", "ignore", "-c", ALONE], check=True, timeout=120)


def test_that_the_nodes_are_those_of_gauss_and_legendre() -> None:
    zeros, weights = shtools.call("expand.SHGLQ", 12)
    nodes, expected = leggauss(13)
    assert np.allclose(np.sort(zeros), nodes, atol=1e-14)
    assert np.allclose(np.sort(weights), np.sort(expected), atol=1e-14)
