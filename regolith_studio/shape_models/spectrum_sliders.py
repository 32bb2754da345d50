"""Amplitudes of a model's spectrum as shares of the mean radius, as plots and sliders show them.

The amplitude of degree l is sqrt(A_l) / mu, as in publications. For fields in ln r it is
sqrt(A_l / 4 pi), which is the same to first order.
"""

from typing import Any

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.shape_models.models.gaussian_field import GaussianField
from regolith_studio.shape_models.models.gaussian_mixture import GaussianMixture
from regolith_studio.shape_models.models.hull_field import HullField
from regolith_studio.shape_models.models.log_field import LogField
from regolith_studio.shape_models.models.mixture_field import MixtureField
from regolith_studio.shape_models.models.recombined import Recombined
from regolith_studio.shape_models.models.sample_matched import SampleMatched
from regolith_studio.shape_models.protocol import FittedModel


def can_be_edited(model: FittedModel) -> bool:
    """Whether the model has one spectrum that may be changed by hand."""
    return hasattr(model, "with_spectrum")


def relative_amplitudes(model: FittedModel) -> FloatArray:
    """sqrt(A_l) / mu for l = 1 .. l_max, the mean over parts or measured particles, shape (l_max,).

    Raises
    ------
    InputError
        If the model is of a kind that has no spectrum.
    """
    match model:
        case GaussianField():
            squares = model.spectrum / model.mean**2
        case LogField() | HullField():
            squares = model.spectrum / (4 * np.pi)
        case GaussianMixture():
            squares = model.weights @ (model.spectra / model.means[:, None] ** 2) / model.weights.sum()
        case MixtureField():
            squares = model.sizes.weights @ model.spectra / model.sizes.weights.sum() / (4 * np.pi)
        case SampleMatched() | Recombined():
            shares = model.coefficients / model.coefficients[:, :1]
            powers = np.add.reduceat(
                (shares**2).mean(axis=0), np.arange(shares.shape[1] ** 0.5, dtype=int) ** 2
            )
            squares = (powers / (2 * np.arange(len(powers)) + 1))[: model.l_max + 1]
        case _:
            raise InputError(f"The model {model.key} has no spectrum.")
    return np.asarray(np.sqrt(squares[1:]))


def with_amplitudes(model: Any, amplitudes: FloatArray) -> Any:
    """The same model with other amplitudes (l_max,) for all its particles; the size is left as it is.

    Raises
    ------
    InputError
        If an amplitude is negative, or the model has no spectrum of its own.
    """
    if not can_be_edited(model):
        raise InputError(f"The model {model.key} has no spectrum that can be edited.")
    values = np.asarray(amplitudes, dtype=np.float64)
    if values.shape != (model.l_max,) or not (np.isfinite(values).all() and (values >= 0).all()):
        raise InputError(f"{model.l_max} amplitudes are needed, none of them negative.")
    unit = model.mean**2 if isinstance(model, GaussianField) else 4 * np.pi
    return model.with_spectrum(np.concatenate([model.spectrum[:1], unit * values**2]))
