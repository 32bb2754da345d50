from collections.abc import Callable

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.protocol import EditableModel, FittedModel, relative_amplitudes
from regolith_studio.shape_models.sample import Sample
from tests.plugin import lunar_kinds


@pytest.mark.parametrize(
    "key",
    [pytest.param(key, marks=pytest.mark.slow) if key == "hull_field" else key for key in sorted(MODELS)],
)
def test_that_every_model_shows_about_the_amplitudes_of_its_sample(
    key: str, rough_sample: Callable[..., Sample], quick_fit: Callable[..., FittedModel]
) -> None:
    """Root of the mean of (c_lm / c_00)^2, from the coefficients; models of ln r agree to first order."""
    sample = rough_sample(200, 4, spread=0.05)
    shares = (sample.coefficients / sample.coefficients[:, :1]) ** 2
    expected = [np.sqrt(shares[:, degree**2 : (degree + 1) ** 2].mean()) for degree in range(1, 5)]
    fitted = quick_fit(key, sample, 4)
    np.testing.assert_allclose(relative_amplitudes(fitted), expected, rtol=0.1)


def test_that_the_amplitudes_of_a_card_are_those_that_it_prints() -> None:
    card = materials()["ma165"]
    np.testing.assert_allclose(relative_amplitudes(card.field(8)), card.relative_amplitudes[:8])


@pytest.mark.parametrize("key", ["gaussian_field", "log_field"])
def test_that_amplitudes_that_were_set_are_shown(key: str, rough_sample: Callable[..., Sample]) -> None:
    fitted = MODELS[key].fit(rough_sample(20, 4), MODELS[key].Settings(l_max=4))
    wanted = np.array([0.01, 0.2, 0.0, 0.03])
    np.testing.assert_allclose(relative_amplitudes(fitted.with_amplitudes(wanted)), wanted)
    with pytest.raises(InputError, match="4 amplitudes are needed"):
        fitted.with_amplitudes(-wanted)


def test_that_a_sample_itself_has_no_spectrum_to_edit(rough_sample: Callable[..., Sample]) -> None:
    fitted = MODELS["sample_matched"].fit(rough_sample(20, 4), MODELS["sample_matched"].Settings(l_max=4))
    assert not isinstance(fitted, EditableModel)


def test_that_a_model_of_another_package_shows_the_amplitudes_of_its_draws() -> None:
    """Its coefficients have a deviation of 1 % of c_00."""
    field = lunar_kinds.LunarField(5.0, 6)
    assert not isinstance(field, EditableModel)
    np.testing.assert_allclose(relative_amplitudes(field), np.full(6, 0.01), rtol=0.1)
