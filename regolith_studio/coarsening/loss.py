"""The loss of Eq. 9, of known errors and as a fast function of half-spaces."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from regolith_studio.coarsening.core.evaluate import (
    AREA,
    LONGEST,
    SHARED,
    SHORTEST,
    VOLUME,
    evaluate,
    weighted_loss,
)
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.overlap import crossings_of
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.comparison import relative_errors
from regolith_studio.geometry.arrays import FloatArray


def loss(weights: LossWeights, errors: Mapping[str, float], jaccard_distance: float) -> float:
    """Eq. 9: the weighted sum of the Jaccard distance (Eq. 7) and the relative errors (Eq. 8).

    Parameters
    ----------
    weights
        alpha of each term.
    errors
        Relative error of every descriptor of the loss.
    jaccard_distance
        In [0, 1]; may be NaN where its weight is 0.
    """
    total = sum(weights[key] * errors[key] for key in LOSS_KEYS if weights[key])
    return float(total + (weights[JACCARD] * jaccard_distance if weights[JACCARD] else 0.0))


BOX_KEYS = ("min_diameter", "max_diameter", "aspect_ratio")


@dataclass(frozen=True)
class Evaluation:
    """Errors of one polyhedron against the target.

    Parameters
    ----------
    errors
        Relative error of each descriptor (Eq. 8); NaN where it was not asked for.
    jaccard_distance
        Eq. 7; NaN where it was not asked for.
    loss
        Eq. 9.
    """

    errors: dict[str, float]
    jaccard_distance: float
    loss: float


class LossFunction:
    """Eq. 9 as a function of half-spaces.

    Parameters
    ----------
    everything
        Whether to evaluate terms with weight 0 too.
    """

    def __init__(self, target: Target, weights: LossWeights, everything: bool = False) -> None:
        self._target = target
        self._weights = weights
        with_box = everything or any(weights[key] for key in BOX_KEYS)
        rays = target.rays
        self._crossings = np.empty((5, 0))
        if everything or weights[JACCARD]:
            self._crossings = crossings_of(rays.directions, rays.first, rays.distance, rays.sign)
        self._wanted = np.array([target.descriptors[key] for key in LOSS_KEYS])
        self._alphas = np.array([weights[key] for key in (*LOSS_KEYS, JACCARD)])
        self._weight, self._with_box = rays.weight, with_box

    def __call__(self, normals: FloatArray, offsets: FloatArray) -> Evaluation | None:
        """Errors and loss, or ``None`` where the half-spaces bound no proper polyhedron."""
        values = self._measured(normals, offsets)
        return None if values is None else self._judged(values)

    def value(self, normals: FloatArray, offsets: FloatArray) -> float:
        """The loss alone, infinite where the half-spaces bound no proper polyhedron: quicker."""
        values = self._measured(normals, offsets)
        return np.inf if values is None else weighted_loss(values, self._wanted, self._alphas)

    def _measured(self, normals: FloatArray, offsets: FloatArray) -> FloatArray | None:
        """As :func:`evaluate`; ``None`` where there is no polyhedron with a box of some thickness."""
        values, planes, distances = np.empty(6), np.array(normals), np.array(offsets)
        status = evaluate(planes, distances, self._crossings, self._weight, self._with_box, values)
        return values if status == FINE and not values[SHORTEST] <= 0.0 else None

    def of(self, values: FloatArray) -> float:
        """The loss of values as from :func:`regolith_studio.coarsening.core.evaluate.evaluate`."""
        return weighted_loss(values, self._wanted, self._alphas)

    def _judged(self, values: FloatArray) -> Evaluation:
        volume, area, shared = float(values[VOLUME]), float(values[AREA]), float(values[SHARED])
        shortest, longest = float(values[SHORTEST]), float(values[LONGEST])
        found = {
            "volume": volume,
            "sphericity": float(np.cbrt(np.pi) * (6 * volume) ** (2 / 3) / area),
            "min_diameter": shortest,
            "max_diameter": longest,
            "aspect_ratio": longest / shortest,
            "convex_hull_volume": volume,
        }
        errors = relative_errors(self._target.descriptors, found)
        jaccard = 1.0 - shared / (1.0 + volume - shared)
        return Evaluation(errors, jaccard, loss(self._weights, errors, jaccard))
