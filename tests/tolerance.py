"""Comparison of numbers of any magnitude."""

from typing import Any

import pytest


def relative(expected: Any, rel: float = 1e-6) -> Any:
    """`expected` within a relative tolerance only.

    ``pytest.approx`` adds an absolute tolerance of 1e-12, which any mass, volume or moment of inertia of a
    small particle in SI units passes.
    """
    return pytest.approx(expected, rel=rel, abs=0.0)
