"""Mixtures of Gaussian fields in ln r, by expectation and maximisation, and how many parts the data ask for.

Of a particle only ln r_eq and the power P_l of each degree enter: directions within a degree are even in an
isotropic field. With r = 2 l + 1 orders, ::

    ln p(i | k) = ln N(ln r_i; mu_k, s_k^2) - 1/2 sum over l of (r ln A_lk + P_il / A_lk) + constant
"""

from dataclasses import dataclass

import numpy as np
from scipy.cluster.vq import kmeans2
from scipy.special import logsumexp

from regolith_studio.geometry.arrays import FloatArray

MOST_STEPS = 300
TOLERANCE = 1e-7
LEAST_SHARE = 1e-3
LEAST_DEVIATION = 1e-3
"""Of ln r_eq within a component."""


@dataclass(frozen=True, eq=False)
class Mixture:
    """A fitted mixture with k parts.

    Parameters
    ----------
    weights
        Shares by number, descending, shape (k,).
    means, deviations
        Of ln r_eq, shape (k,).
    spectra
        A_l of ln r, shape (k, l_max + 1), A_0 = 0.
    log_likelihood
        Of the sample, without its constant.
    """

    weights: FloatArray
    means: FloatArray
    deviations: FloatArray
    spectra: FloatArray
    log_likelihood: float

    @property
    def n_parameters(self) -> int:
        """Free numbers of the mixture."""
        k, length = self.spectra.shape
        return int(k - 1 + 2 * k + k * (length - 1))

    def bic(self, n: int) -> float:
        """Bayes' information criterion of Schwarz (1978) for `n` particles; lower is better."""
        return self.n_parameters * float(np.log(n)) - 2 * self.log_likelihood

    def responsibilities(self, logs: FloatArray, powers: FloatArray) -> FloatArray:
        """Probability of each part for each particle, shape (n, k)."""
        joint = self._joint(logs, powers)
        return np.asarray(np.exp(joint - logsumexp(joint, axis=1, keepdims=True)))

    def _joint(self, logs: FloatArray, powers: FloatArray) -> FloatArray:
        orders = 2 * np.arange(1, self.spectra.shape[1]) + 1
        variances = self.spectra[:, 1:]
        shape = powers[:, 1:] @ (1 / variances).T + (np.log(variances) @ orders)[None]
        size = ((logs[:, None] - self.means) / self.deviations) ** 2 + 2 * np.log(self.deviations)
        return np.asarray(np.log(self.weights) - 0.5 * (shape + size))


def fit_mixture(logs: FloatArray, powers: FloatArray, k: int, rng: np.random.Generator) -> Mixture:
    """The mixture of `k` parts from one start by k-means++ on ln r_eq and the ln P_l.

    Parameters
    ----------
    logs
        ln r_eq, shape (n,).
    powers
        Sum of squares at each degree, shape (n, l_max + 1).
    """
    floor = np.maximum(powers.mean(axis=0) * 1e-9, 1e-300)
    shares = _start(logs, np.log(np.maximum(powers[:, 1:], floor[1:])), k, rng)
    before = -np.inf
    for _ in range(MOST_STEPS):
        mixture = _maximised(logs, powers, shares, floor)
        joint = mixture._joint(logs, powers)
        total = logsumexp(joint, axis=1, keepdims=True)
        shares, now = np.exp(joint - total), float(total.sum())
        if now - before < TOLERANCE * abs(now):
            break
        before = now
    order = np.argsort(-mixture.weights, kind="stable")
    return Mixture(
        mixture.weights[order],
        mixture.means[order],
        mixture.deviations[order],
        mixture.spectra[order],
        now,
    )


def _start(logs: FloatArray, heights: FloatArray, k: int, rng: np.random.Generator) -> FloatArray:
    """Shares of 0 and 1, softened so that no part is empty, shape (n, k)."""
    features = np.column_stack([logs, heights[:, : min(6, heights.shape[1])]])
    features = (features - features.mean(axis=0)) / np.maximum(features.std(axis=0), 1e-9)
    labels = (
        kmeans2(features, k, minit="++", rng=rng, missing="warn")[1] if k > 1 else np.zeros(len(logs), int)
    )
    return np.asarray(0.98 * np.eye(k)[labels] + 0.02 / k)


def _maximised(logs: FloatArray, powers: FloatArray, shares: FloatArray, floor: FloatArray) -> Mixture:
    members = np.maximum(shares.sum(axis=0), LEAST_SHARE)
    means = shares.T @ logs / members
    variances = (shares * (logs[:, None] - means) ** 2).sum(axis=0) / members
    orders = 2 * np.arange(powers.shape[1]) + 1
    spectra = np.maximum(shares.T @ powers / members[:, None], floor) / orders
    spectra[:, 0] = 0.0
    deviations = np.sqrt(np.maximum(variances, LEAST_DEVIATION**2))
    return Mixture(members / members.sum(), means, deviations, spectra, 0.0)
