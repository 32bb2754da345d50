"""Relative errors by hand."""

import numpy as np
import pytest

from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe, relative_errors, rmsre
from tests.geometry.solids import cuboid


def test_that_the_error_of_equation_8_is_relative_to_the_measured_shape() -> None:
    errors = relative_errors(
        {"volume": 4.0, "sphericity": 0.5}, {"volume": 5.0, "sphericity": 0.4}, ["volume"]
    )
    assert errors == {"volume": pytest.approx(0.25)}


def test_that_a_doubled_cube_has_the_errors_of_its_dimensions() -> None:
    errors = relative_errors(describe(cuboid(1.0, 1.0, 1.0)), describe(cuboid(2.0, 2.0, 2.0)))
    assert tuple(errors) == LOSS_KEYS
    wanted = {"volume": 7.0, "sphericity": 0.0, "min_diameter": 1.0, "max_diameter": 1.0, "aspect_ratio": 0.0}
    assert errors == pytest.approx({**wanted, "convex_hull_volume": 7.0}, abs=1e-9)


def test_that_equation_10_is_the_root_of_the_mean_square() -> None:
    measured = [{"volume": 1.0}, {"volume": 2.0}, {"volume": 4.0}]
    others = [{"volume": 1.1}, {"volume": 1.0}, {"volume": 4.0}]
    wanted = np.sqrt((0.1**2 + 0.5**2 + 0.0) / 3)
    assert rmsre(measured, others, ["volume"]) == {"volume": pytest.approx(wanted)}


def test_that_nonsense_is_refused() -> None:
    with pytest.raises(ValueError, match="zero"):
        relative_errors({"volume": 0.0}, {"volume": 1.0}, ["volume"])
    with pytest.raises(ValueError, match="pairs"):
        rmsre([], [], ["volume"])
    with pytest.raises(ValueError, match="pairs"):
        rmsre([{"volume": 1.0}], [], ["volume"])
