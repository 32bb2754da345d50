"""The loss of Eq. 9."""

from collections.abc import Mapping

from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS


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
