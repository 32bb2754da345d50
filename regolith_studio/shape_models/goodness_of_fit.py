"""Goodness of fit of drawn particles: distances of distributions, a classifier test, and novelty."""

from itertools import combinations

import numpy as np
from scipy.spatial.distance import cdist

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray

N_FOLDS = 5
RIDGE = 1e-2
NEWTON_STEPS = 25
MAX_ROWS_FOR_PAIRS = 2000
"""Rows of each table beyond which the quadratic energy distance takes evenly spaced ones."""


def relative_wasserstein(
    measured: FloatArray, drawn: FloatArray, weights: FloatArray, drawn_weights: FloatArray
) -> float:
    """Wasserstein-1 distance of two weighted samples, as a share of the measured mean's size."""
    from scipy.stats import wasserstein_distance  # 30 MB that a window need not hold from its start

    mean = abs(float(weights @ measured / weights.sum()))
    return float(wasserstein_distance(measured, drawn, weights, drawn_weights)) / max(mean, 1e-300)


def kolmogorov_smirnov(
    measured: FloatArray, drawn: FloatArray, weights: FloatArray, drawn_weights: FloatArray
) -> float:
    """Largest difference of two weighted empirical distribution functions, 0 to 1."""
    places = np.sort(np.concatenate([measured, drawn]))
    gap = _rising_share(measured, weights, places) - _rising_share(drawn, drawn_weights, places)
    return float(np.abs(gap).max())


def resampled_distances(
    measured: FloatArray, drawn: FloatArray, weights: FloatArray, drawn_weights: FloatArray, scale: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """:func:`relative_wasserstein` and :func:`kolmogorov_smirnov` for many weightings of the same values.

    Parameters
    ----------
    measured, drawn
        Shapes (n,) and (m,).
    weights, drawn_weights
        A row for each weighting, shapes (b, n) and (b, m).
    scale
        Weights of the measured mean whose share the first distance is, shape (n,).

    Returns
    -------
    Both distances of each weighting, shapes (b,).
    """
    places = np.concatenate([measured, drawn])
    order = np.argsort(places, kind="stable")
    signed = np.hstack(
        [
            weights / weights.sum(axis=1, keepdims=True),
            -drawn_weights / drawn_weights.sum(axis=1, keepdims=True),
        ]
    )
    rising = np.abs(np.cumsum(signed[:, order], axis=1))[:, :-1]
    steps = np.diff(places[order])
    mean = max(abs(float(scale @ measured / scale.sum())), 1e-300)
    return rising @ steps / mean, np.where(steps > 0, rising, 0.0).max(axis=1)


def energy_distance(measured: FloatArray, drawn: FloatArray) -> float:
    """2 E|X - Y| - E|X - X'| - E|Y - Y'| of Szekely and Rizzo (2004) between two tables (n, d).

    Columns are divided by their standard deviation in `measured`; the estimate is unbiased, so that it is
    about zero, of either sign, for equal distributions.
    """
    spread = np.maximum(measured.std(axis=0), 1e-300)
    x, y = _thinned(measured) / spread, _thinned(drawn) / spread
    within = [cdist(z, z).sum() / (len(z) * (len(z) - 1)) for z in (x, y)]
    return float(2 * cdist(x, y).mean() - within[0] - within[1])


def pairs_of(n_columns: int) -> list[tuple[int, int]]:
    """The pairs of columns, in order."""
    return list(combinations(range(n_columns), 2))


def classifier_accuracy(measured: FloatArray, drawn: FloatArray, rng: np.random.Generator) -> float:
    """Cross-validated accuracy of a logistic classifier of drawn against measured particles; 0.5 is chance.

    Features are the standardised columns with their squares and products; as many particles of either kind;
    five-fold cross-validation (Lopez-Paz and Oquab 2017).

    Raises
    ------
    InputError
        If there are fewer than ten particles of one kind.
    """
    n = min(len(measured), len(drawn))
    if n < 2 * N_FOLDS:
        raise InputError(f"A classifier needs at least {2 * N_FOLDS} particles of either kind, got {n}.")
    rows = np.concatenate([rng.permutation(measured)[:n], rng.permutation(drawn)[:n]])
    kinds = np.repeat([0.0, 1.0], n)
    features = _features(rows)
    folds = rng.permutation(2 * n) % N_FOLDS
    right = 0
    for fold in range(N_FOLDS):
        train, test = folds != fold, folds == fold
        slopes = _logistic(features[train], kinds[train])
        right += int(((features[test] @ slopes > 0) == (kinds[test] > 0.5)).sum())
    return right / (2 * n)


def _rising_share(values: FloatArray, weights: FloatArray, places: FloatArray) -> FloatArray:
    order = np.argsort(values)
    rising = np.concatenate([[0.0], np.cumsum(weights[order])])
    return np.asarray(rising[np.searchsorted(values[order], places, side="right")] / rising[-1])


def _thinned(table: FloatArray) -> FloatArray:
    if len(table) <= MAX_ROWS_FOR_PAIRS:
        return table
    return table[np.linspace(0, len(table) - 1, MAX_ROWS_FOR_PAIRS).astype(np.int64)]


def _features(rows: FloatArray) -> FloatArray:
    scaled = (rows - rows.mean(axis=0)) / np.maximum(rows.std(axis=0), 1e-300)
    d = rows.shape[1]
    products = [scaled[:, i] * scaled[:, j] for i in range(d) for j in range(i, d)]
    return np.column_stack([np.ones(len(rows)), scaled, *products])


def _logistic(features: FloatArray, kinds: FloatArray) -> FloatArray:
    """Slopes of a logistic regression with a ridge, by Newton's method."""
    slopes = np.zeros(features.shape[1])
    ridge = RIDGE * len(features) * np.eye(features.shape[1])
    for _ in range(NEWTON_STEPS):
        chance = 1 / (1 + np.exp(-np.clip(features @ slopes, -30, 30)))
        slope = features.T @ (kinds - chance) - ridge @ slopes
        step = np.linalg.solve((features.T * (chance * (1 - chance))) @ features + ridge, slope)
        slopes = slopes + step
        if np.abs(step).max() < 1e-6:
            break
    return slopes
