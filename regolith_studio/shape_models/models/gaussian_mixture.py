"""The paper's outlook taken literally (section 4): a mixture of its Gaussian fields of the radius.

Each component is a field of :mod:`~regolith_studio.shape_models.models.gaussian_field`: c_00 is N(mu_k,
s_k^2), c_lm is N(0, A_lk). The number of components is the one with the lowest information criterion of
Bayes. Draws whose radius is not positive are rejected and counted.

It is fitted by expectation and maximisation. Of a particle only its size x_i = c_00 and the power P_l of each
degree enter: directions within a degree are even in an isotropic field. ::

    ln p(i | k) = ln N(x_i; mu_k, s_k^2) - 1/2 sum over l of ((2 l + 1) ln A_lk + P_il / A_lk) + constant
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.special import logsumexp

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.messages import N_, Message
from regolith_studio.settings import setting
from regolith_studio.shape_models.chunked_sampling import RejectionSampler
from regolith_studio.shape_models.sample import Sample

MAX_STEPS = 300
TOLERANCE = 1e-7
MIN_SHARE = 1e-3
MIN_DEVIATION = 1e-3
"""Of the size within a component, a share of the mean size."""


@dataclass(frozen=True)
class MixtureSettings:
    """Settings of mixtures of Gaussians.

    - ``l_max``: degree of the particles.
    - ``n_components``: number of components; 0 for the best by the criterion.
    - ``max_components``: highest number tried.
    - ``n_starts``: starts for each number; the most likely one is kept.
    - ``seed``: of the starts.
    """

    l_max: int = 10
    n_components: int = setting(
        0,
        N_("Components"),
        N_("0 for the number with the lowest Bayesian information criterion."),
        maximum=50,
    )
    max_components: int = setting(8, N_("At most"), N_("Highest number tried."), minimum=1, maximum=50)
    n_starts: int = setting(2, N_("Starts"), N_("For each number."), minimum=1, maximum=50)
    seed: int = setting(0, N_("Seed of starts"))


@dataclass(frozen=True, eq=False)
class Mixture:
    """A fitted mixture with k components.

    - ``weights``: shares by number, descending, shape (k,).
    - ``means``, ``deviations``: of the size, shape (k,).
    - ``spectra``: a_l, shape (k, l_max + 1), A_0 = 0: the size stands for it.
    - ``log_likelihood``: of the sample, without its constant.
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

    def responsibilities(self, sizes: FloatArray, powers: FloatArray) -> FloatArray:
        """Probability of each component for each particle, shape (n, k)."""
        joint = self._joint(sizes, powers)
        return np.asarray(np.exp(joint - logsumexp(joint, axis=1, keepdims=True)))

    def _joint(self, sizes: FloatArray, powers: FloatArray) -> FloatArray:
        orders = 2 * np.arange(1, self.spectra.shape[1]) + 1
        variances = self.spectra[:, 1:]
        shape = powers[:, 1:] @ (1 / variances).T + (np.log(variances) @ orders)[None]
        far = ((sizes[:, None] - self.means) / self.deviations) ** 2 + 2 * np.log(self.deviations)
        return np.asarray(np.log(self.weights) - 0.5 * (shape + far))


def component_names(names: Sequence[str], k: int) -> tuple[str, ...]:
    """One name for each of `k` parts: those given, or "part 1", "part 2" and so on.

    Raises InputError if there are not as many.
    """
    labels = tuple(names) or tuple(f"part {i + 1}" for i in range(k))
    if len(labels) != k:
        raise InputError(f"A mixture of {k} parts needs {k} names, got {len(labels)}.")
    return labels


def chosen_mixture(
    sizes: FloatArray, powers: FloatArray, settings: MixtureSettings
) -> tuple[Mixture, tuple[float, ...]]:
    """The mixture with the number of parts that was asked for, or the lowest criterion; and the criterion.

    ``sizes``, ``powers``: as for :func:`fit_mixture`.

    Returns the mixture, and the criterion for 1, 2, ... parts; nothing if the number was given.

    Raises InputError if there are fewer than four particles for each part, or there is nothing to tell
    parts by.
    """
    if settings.l_max < 1:
        sentence = N_("A mixture tells parts by their spectra and needs l_max of at least 1, got {degree}.")
        raise InputError(Message(sentence, degree=settings.l_max))
    fits = [_best_start(sizes, powers, k, settings) for k in _numbers(len(sizes), settings)]
    criterion = [fit.bic(len(sizes)) for fit in fits]
    best = fits[int(np.argmin(criterion))]
    return best, () if settings.n_components else tuple(criterion)


def _numbers(n: int, settings: MixtureSettings) -> list[int]:
    most = max(1, n // 4)
    if settings.n_components == 0:
        return list(range(1, max(1, min(settings.max_components, most)) + 1))
    if not 1 <= settings.n_components <= most:
        sentence = N_(
            "{n} particles are enough for 1 to {most} parts, got {count}: four particles are needed for each."
        )
        raise InputError(Message(sentence, n=n, most=most, count=settings.n_components))
    return [settings.n_components]


def _best_start(sizes: FloatArray, powers: FloatArray, k: int, settings: MixtureSettings) -> Mixture:
    starts = 1 if k == 1 else settings.n_starts
    generators = [
        np.random.default_rng(np.random.SeedSequence(settings.seed, spawn_key=(k, i))) for i in range(starts)
    ]
    return max((fit_mixture(sizes, powers, k, rng) for rng in generators), key=lambda fit: fit.log_likelihood)


def fit_mixture(sizes: FloatArray, powers: FloatArray, k: int, rng: np.random.Generator) -> Mixture:
    """The mixture of `k` parts from one start by k-means++ on the sizes and the ln P_l.

    ``sizes``: c_00 over its mean, shape (n,). ``powers``: sum of squares at each degree, shape
    (n, l_max + 1).
    """
    # A degree without power in one component would have a variance of 0 and an infinite likelihood.
    floor = np.maximum(powers.mean(axis=0) * 1e-9, 1e-300)
    shares = _start(sizes, np.log(np.maximum(powers[:, 1:], floor[1:])), k, rng)
    before = -np.inf
    for _ in range(MAX_STEPS):
        mixture = _maximised(sizes, powers, shares, floor)
        joint = mixture._joint(sizes, powers)
        total = logsumexp(joint, axis=1, keepdims=True)
        shares, now = np.exp(joint - total), float(total.sum())
        if now - before < TOLERANCE * abs(now):
            break
        before = now
    # Components have no order of their own: the largest first, so that two starts can be compared.
    order = np.argsort(-mixture.weights, kind="stable")
    return Mixture(
        mixture.weights[order],
        mixture.means[order],
        mixture.deviations[order],
        mixture.spectra[order],
        now,
    )


def _start(sizes: FloatArray, heights: FloatArray, k: int, rng: np.random.Generator) -> FloatArray:
    """Shares of 0 and 1, softened so that no part is empty, shape (n, k)."""
    # The low degrees separate constituents; the many high ones, all alike, would outweigh them in distances.
    features = np.column_stack([sizes, heights[:, : min(6, heights.shape[1])]])
    features = (features - features.mean(axis=0)) / np.maximum(features.std(axis=0), 1e-9)
    labels = (
        kmeans2(features, k, minit="++", rng=rng, missing="warn")[1] if k > 1 else np.zeros(len(sizes), int)
    )
    return np.asarray(0.98 * np.eye(k)[labels] + 0.02 / k)


def _maximised(sizes: FloatArray, powers: FloatArray, shares: FloatArray, floor: FloatArray) -> Mixture:
    members = np.maximum(shares.sum(axis=0), MIN_SHARE)
    means = shares.T @ sizes / members
    variances = (shares * (sizes[:, None] - means) ** 2).sum(axis=0) / members
    orders = 2 * np.arange(powers.shape[1]) + 1
    spectra = np.maximum(shares.T @ powers / members[:, None], floor) / orders
    spectra[:, 0] = 0.0
    # Without a lowest deviation a component shrinks to one particle, where the likelihood has no bound.
    deviations = np.sqrt(np.maximum(variances, MIN_DEVIATION**2))
    return Mixture(members / members.sum(), means, deviations, spectra, 0.0)


KEY = "gaussian_mixture"


@dataclass(frozen=True, eq=False)
class GaussianMixture(RejectionSampler, LockedRecord):
    """A fitted mixture, the component with the largest share first.

    - ``weights``: shares by number, before draws are thrown away, shape (k,).
    - ``means``: mu_k, shape (k,).
    - ``spectra``: a_lk, with the variance of c_00 as A_0k, shape (k, l_max + 1).
    - ``unit``: length unit of the sample.
    - ``bic``: criterion for 1, 2, ... components; empty if the number was given.
    - ``names``: of the components, for display.
    - ``labels``: most probable component of each measured particle, shape (n,).

    Raises InputError if a share or variance is negative, or there are not as many names as components.
    """

    weights: FloatArray
    means: FloatArray
    spectra: FloatArray
    unit: str = "um"
    bic: tuple[float, ...] = ()
    names: tuple[str, ...] = ()
    labels: IntArray | None = None
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        k = len(self.weights)
        object.__setattr__(self, "weights", locked_floats(self.weights, (None,), "weights"))
        object.__setattr__(self, "means", locked_floats(self.means, (k,), "means"))
        spectra = locked_floats(self.spectra, (k, None), "spectra")
        if not (spectra >= 0).all():
            raise InputError("A spectrum needs one variance A_l for each degree, none of them negative.")
        object.__setattr__(self, "spectra", spectra)
        object.__setattr__(self, "bic", tuple(float(value) for value in self.bic))
        object.__setattr__(self, "names", component_names(self.names, k))
        if not ((self.weights >= 0).all() and self.weights.sum() > 0):
            raise InputError("Shares of a mixture must not be negative.")

    @property
    def l_max(self) -> int:
        """Degree of the particles."""
        return int(self.spectra.shape[1]) - 1

    @property
    def n_components(self) -> int:
        """Number of components."""
        return len(self.weights)

    def renamed(self, names: Sequence[str]) -> Self:
        """The same mixture with other names of its components.

        Raises InputError if there are not as many names as parts.
        """
        return replace(self, names=tuple(names))

    def relative_amplitudes(self) -> FloatArray:
        """Root of the mean over the components of A_lk / mu_k^2, shape (l_max,)."""
        shares = self.weights / self.weights.sum()
        return np.asarray(np.sqrt(shares @ (self.spectra[:, 1:] / self.means[:, None] ** 2)))

    def propose(self, rng: np.random.Generator, n: int) -> FloatArray:
        """Coefficients of `n` draws, and the component of each in a last column."""
        component = rng.choice(len(self.weights), n, p=self.weights / self.weights.sum())
        length = (self.l_max + 1) ** 2
        rows = rng.standard_normal((n, length)) * np.sqrt(self.spectra)[component][:, degrees(length)]
        rows[:, 0] += self.means[component]
        return np.column_stack([rows, component])

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON; the labels of the measured particles."""
        values = {
            "weights": self.weights.tolist(),
            "means": self.means.tolist(),
            "spectra": self.spectra.tolist(),
            "unit": self.unit,
            "bic": list(self.bic),
            "names": list(self.names),
        }
        return values, {} if self.labels is None else {"labels": self.labels}


class GaussianMixtureModel:
    """Expectation and maximisation on c_00 and the power of each degree."""

    key = KEY
    label = N_("Mixture of Gaussian fields")
    summary = N_("A mixture of components, each with its own sizes and spectrum, in the radius itself.")
    Settings = MixtureSettings

    def fit(self, sample: Sample, settings: MixtureSettings | None = None) -> GaussianMixture:
        """The mixture of a sample."""
        chosen = settings or MixtureSettings()
        rows = sample.truncated(chosen.l_max).coefficients
        # The lowest deviation of a component is a share of the mean.
        scale = float(rows[:, 0].mean())
        powers = np.add.reduceat((rows / scale) ** 2, np.arange(chosen.l_max + 1) ** 2, axis=1)
        powers[:, 0] = 0.0
        sizes = rows[:, 0] / scale
        best, curve = chosen_mixture(sizes, powers, chosen)
        spectra = best.spectra * scale**2
        spectra[:, 0] = (best.deviations * scale) ** 2
        labels = best.responsibilities(sizes, powers).argmax(axis=1)
        return GaussianMixture(best.weights, best.means * scale, spectra, sample.unit, curve, labels=labels)

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> GaussianMixture:
        """The mixture from its stored values."""
        numbers = (values["weights"], values["means"], values["spectra"])
        names, bic = tuple(values["names"]), tuple(values["bic"])
        return GaussianMixture(*numbers, str(values["unit"]), bic, names, arrays.get("labels"))


MODEL = GaussianMixtureModel()
