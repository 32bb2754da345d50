"""Goodness of fit of drawn particles: distances of distributions, a classifier test, and novelty.

How new drawn particles are: the distance to the nearest measured one over all rotations.

Particles are compared at equivalent radius one in the frames of their principal axes
(:func:`~regolith_studio.shape_models.inertia_ellipsoid.canonical`). Each is tried in the 24 rotations that
permute and flip the axes, and the nearest of these are brought nearer by Gauss-Newton steps over small
rotations: the derivative of a turned radius function is a linear map of its coefficients.
"""

from functools import cache
from itertools import combinations
from math import isqrt

import numpy as np
from scipy.spatial.distance import cdist
from scipy.spatial.transform import Rotation

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.transform import rotated

N_STARTS = 20
"""Nearest pairs of rotation and measured particle that the local search begins with."""
STEPS = 6
MAX_TURN = 0.3
"""Largest rotation of a step, in radians."""
# By central differences: at degree 10 an error of (10 x 1e-4)^2 / 6 = 2e-7, and 1e-12 by rounding.
_SMALL_TURN = 1e-4
# The first term left out is at most (l_max MAX_TURN)^17 / 17!: 4e-7 at degree 10, the highest in use.
_TAYLOR_TERMS = 16


def nearest_over_rotations(measured: FloatArray, drawn: FloatArray) -> tuple[FloatArray, IntArray]:
    """Distance from each drawn particle to the nearest measured one over rotations, and which it is.

    ``measured``, ``drawn``: rows of ``canonical``, shapes (n, k) and (m, k).

    Returns root-mean-square differences of the radii, and indices of measured particles, shapes (m,).
    """
    nearest = [_nearest(measured, row) for row in drawn]
    return np.array([distance for distance, _ in nearest]), np.array(
        [index for _, index in nearest], np.int64
    )


def distances_among(measured: FloatArray, picks: IntArray) -> FloatArray:
    """Distance from each picked measured particle to the nearest of the others, shape (picks,).

    The novelty of a particle is its distance over the median of these: copies have 0, particles from the same
    source 1 in the median.
    """
    return np.array([_nearest(np.delete(measured, pick, axis=0), measured[pick])[0] for pick in picks])


def _nearest(measured: FloatArray, row: FloatArray) -> tuple[float, int]:
    starts = row @ _axis_rotations(isqrt(len(row)) - 1)
    overlaps = starts @ measured.T
    # The distance |s - m|^2 over rotations s of one row: |s| is the same, so that only these terms differ.
    pairs = np.argsort((overlaps - 0.5 * (measured**2).sum(axis=1)).ravel())[: -N_STARTS - 1 : -1]
    rotation, index = np.unravel_index(pairs, overlaps.shape)
    turned, goal = starts[rotation], measured[index]
    for _ in range(STEPS):
        turned = _turned(turned, _best_small_turn(turned, goal))
    distances = np.linalg.norm(turned - goal, axis=1)
    best = int(distances.argmin())
    return float(distances[best]) / np.sqrt(4 * np.pi), int(index[best])


def _best_small_turn(rows: FloatArray, goal: FloatArray) -> FloatArray:
    """Rotation vectors (p, 3) that bring rows nearest to the goal, to first order in the rotation."""
    slopes = np.stack([rows @ generator for generator in _generators(isqrt(rows.shape[1]) - 1)], axis=2)
    # A body of revolution has a rotation that changes nothing: the matrix would be singular.
    normal = np.swapaxes(slopes, 1, 2) @ slopes + 1e-12 * np.eye(3)
    right = np.swapaxes(slopes, 1, 2) @ (goal - rows)[:, :, None]
    turns = np.linalg.solve(normal, right)[:, :, 0]
    lengths = np.linalg.norm(turns, axis=1, keepdims=True)
    # The first order holds for small turns only; beyond, a step may lead to another minimum.
    return np.asarray(turns * np.minimum(1.0, MAX_TURN / np.maximum(lengths, 1e-300)))


def _turned(rows: FloatArray, turns: FloatArray) -> FloatArray:
    """Rows (p, k) rotated by rotation vectors (p, 3): the exponential of the generators, term by term."""
    generators = _generators(isqrt(rows.shape[1]) - 1)
    total, term = rows.copy(), rows
    for order in range(1, _TAYLOR_TERMS + 1):
        term = np.sum([turns[:, [i]] * (term @ generators[i]) for i in range(3)], axis=0) / order
        total = total + term
    return total


@cache
def _generators(l_max: int) -> FloatArray:
    """Derivative of rotated rows after the angle about x, y and z: ``row @ generator``, shape (3, k, k)."""
    ends = [
        [_matrix(l_max, Rotation.from_rotvec(sign * _SMALL_TURN * axis).as_matrix()) for sign in (1, -1)]
        for axis in np.eye(3)
    ]
    return np.stack([(one - other) / (2 * _SMALL_TURN) for one, other in ends])


@cache
def _axis_rotations(l_max: int) -> FloatArray:
    """The 24 rotations that map axes to axes: ``row @ matrix``, shape (24, k, k)."""
    return np.stack([_matrix(l_max, each) for each in Rotation.create_group("O").as_matrix()])


def _matrix(l_max: int, rotation: FloatArray) -> FloatArray:
    """``row @ matrix`` are the coefficients of the rotated radius function, shape (k, k)."""
    basis = np.eye((l_max + 1) ** 2)
    return np.stack([rotated(ShCoefficients(row), rotation).values for row in basis])


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

    - ``measured``, ``drawn``: shapes (n,) and (m,).
    - ``weights``, ``drawn_weights``: a row for each weighting, shapes (b, n) and (b, m).
    - ``scale``: weights of the measured mean whose share the first distance is, shape (n,).

    Returns both distances of each weighting, shapes (b,).
    """
    places = np.concatenate([measured, drawn])
    order = np.argsort(places, kind="stable")
    signed = np.hstack(
        [
            weights / weights.sum(axis=1, keepdims=True),
            -drawn_weights / drawn_weights.sum(axis=1, keepdims=True),
        ]
    )
    # The gap behind the last value is the rounding of the sums of weights.
    rising = np.abs(np.cumsum(signed[:, order], axis=1))[:, :-1]
    steps = np.diff(places[order])
    mean = max(abs(float(scale @ measured / scale.sum())), 1e-300)
    # Between equal values the distribution functions have not both risen yet: no gap there counts.
    return rising @ steps / mean, np.where(steps > 0, rising, 0.0).max(axis=1)


def energy_distance(measured: FloatArray, drawn: FloatArray) -> float:
    """2 E|X - Y| - E|X - X'| - E|Y - Y'| of Szekely and Rizzo (2004) between two tables (n, d).

    Columns are divided by their standard deviation in `measured`; the estimate is unbiased, so that it is
    about zero, of either sign, for equal distributions.
    """
    spread = np.maximum(measured.std(axis=0), 1e-300)
    x, y = _thinned(measured) / spread, _thinned(drawn) / spread
    # Without the zeros of the diagonal, which would bias the mean.
    within = [cdist(z, z).sum() / (len(z) * (len(z) - 1)) for z in (x, y)]
    return float(2 * cdist(x, y).mean() - within[0] - within[1])


def pairs_of(n_columns: int) -> list[tuple[int, int]]:
    """The pairs of columns, in order."""
    return list(combinations(range(n_columns), 2))


def classifier_accuracy(measured: FloatArray, drawn: FloatArray, rng: np.random.Generator) -> float:
    """Cross-validated accuracy of a logistic classifier of drawn against measured particles; 0.5 is chance.

    Features are the standardised columns with their squares and products; as many particles of either kind;
    five-fold cross-validation (Lopez-Paz and Oquab 2017).

    Raises InputError if there are fewer than ten particles of one kind.
    """
    # As many of either kind, or guessing the more frequent one would beat chance.
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
    # Kinds that can be told apart without error have no finite slopes.
    ridge = RIDGE * len(features) * np.eye(features.shape[1])
    for _ in range(NEWTON_STEPS):
        # Beyond 30 the weights of Newton's step underflow and the matrix is the ridge alone.
        chance = 1 / (1 + np.exp(-np.clip(features @ slopes, -30, 30)))
        slope = features.T @ (kinds - chance) - ridge @ slopes
        step = np.linalg.solve((features.T * (chance * (1 - chance))) @ features + ridge, slope)
        slopes = slopes + step
        if np.abs(step).max() < 1e-6:
            break
    return slopes
