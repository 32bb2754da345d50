"""The choices of an expansion are those of the fit, and a wrong one is a sentence."""

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.geometry.directions import icosphere
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.expansion import USUAL, Expansion
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics


@pytest.fixture(scope="module")
def spheroid() -> Mesh:
    ball = icosphere(3)
    return Mesh(ball.vertices * (1.0, 1.0, 0.25), ball.faces)


def test_that_the_usual_expansion_is_that_of_a_bare_fit(spheroid: Mesh) -> None:
    bare, usual = fit_harmonics(spheroid, 12), USUAL.fit(spheroid, 12)
    assert np.array_equal(bare.coefficients.values, usual.coefficients.values)


def test_that_an_ellipsoid_divided_by_itself_has_one_coefficient(spheroid: Mesh) -> None:
    assert _largest_share(Expansion(reference="ellipsoid").fit(spheroid, 12)) < 1e-3
    assert _largest_share(USUAL.fit(spheroid, 12)) > 0.3


def _largest_share(fit: HarmonicFit) -> float:
    values = np.abs(fit.coefficients.values)
    return float(values[1:].max() / values[0])


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"star_point": "middle"}, "The star point must be one of centre_of_mass"),
        ({"rule": "second"}, "The rule must be one of volume"),
        ({"reference": "cube"}, "The reference must be one of sphere"),
    ],
)
def test_that_an_unknown_choice_is_refused_with_what_there_is(changes: dict[str, str], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Expansion(**changes)
