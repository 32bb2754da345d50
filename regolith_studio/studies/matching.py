"""How near simulants, and the best mixture of their fractions, are to a soil.

The energy distance of a mixture to the target is a quadratic form in the shares of its parts, K_ij being the
product of the differences of parts i and j to the target (Szekely and Rizzo 2013). So the nearest mixture
over the joint distribution of size and shape is a problem of non-negative least squares, |R w| with R'R = K.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import nnls
from scipy.spatial.distance import cdist

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_
from regolith_studio.readers.error_messages import plural
from regolith_studio.shape_models.goodness_of_fit import relative_wasserstein

SIZES = ("equivalent_radius", "width")
"""What counts as size, the first that all tables have; its logarithm is compared."""
SHAPES = ("sphericity", "aspect_ratio", "convexity", "width_over_length", "thickness_over_width")
N_RESAMPLES = 200
CONFIDENCE = 0.95
MAX_ROWS = 4000
"""Particles of target and parts whose distances are in memory, 128 MB; more are thinned at random."""
MIN_ROWS = 20
"""Particles below which a table says nothing about its material."""
QUANTILES = (0.1, 0.5, 0.9)


@dataclass(frozen=True)
class ComparedMaterial:
    """Descriptors of particles of a material or fraction: values by keys, of shape (n,), in micrometres."""

    name: str
    columns: Mapping[str, FloatArray]

    @property
    def volumes(self) -> FloatArray:
        """Of the particles, in cubic micrometres."""
        if "volume" in self.columns:
            return np.asarray(self.columns["volume"])
        if "equivalent_radius" in self.columns:
            return np.asarray(4 / 3 * np.pi * self.columns["equivalent_radius"] ** 3)
        return np.asarray(np.pi / 6 * self.columns["width"] ** 3)


@dataclass(frozen=True, eq=False)
class MatchedPart:
    """One part by itself and in the best mixture; intervals are (low, high) at :data:`CONFIDENCE`.

    - ``energy``, ``energy_interval``, ``energy_floor``: energy distance of the part to the target, and what
      one of twenty samples of the target of this size exceeds. Of the mixture, an estimate for other
      particles than those that its shares were fitted to.
    - ``wasserstein``: by descriptor, as a share of the target's mean.
    - ``number_share``, ``mass_share``, ``mass_interval``: in the mixture, at equal densities.
    - ``sizes``: quantiles of the size by mass.
    """

    name: str
    n_particles: int
    energy: float
    energy_interval: tuple[float, float]
    energy_floor: float
    wasserstein: Mapping[str, float]
    number_share: float
    mass_share: float
    mass_interval: tuple[float, float]
    sizes: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Match:
    """The parts in their order, and the mixture of them that is nearest to the target."""

    target: str
    keys: tuple[str, ...]
    weighting: str
    parts: tuple[MatchedPart, ...]
    mixture: MatchedPart
    target_sizes: tuple[float, ...]

    @property
    def nearest(self) -> MatchedPart:
        """The single part that is nearest to the target."""
        return min(self.parts, key=lambda part: part.energy)

    @property
    def is_reached(self) -> bool:
        """Whether the mixture is as near to the target as samples of the target itself are."""
        return self.mixture.energy <= self.mixture.energy_floor

    @property
    def notes(self) -> tuple[str, ...]:
        """How distances and masses are to be read, and whether the target is out of reach."""
        if self.is_reached:
            return (MASSES,)
        floors = self.mixture.energy / self.mixture.energy_floor
        return (
            f"No mixture of the candidates is as near to {self.target} as samples of it are to each other: "
            f"the nearest is at {floors:.1f} floors. Masses are those of this nearest mixture, and their "
            "intervals do not include what it misses.",
            MASSES,
        )

    def table(self, mass: float = 100.0) -> Table:
        """Each part and the mixture, with the grams of each part in `mass` grams of the mixture."""
        shapes = [f"wasserstein_{key}" for key in self.keys]
        columns = (
            Column("material"),
            Column("particles"),
            *map(Column, ("energy_distance", "energy_low", "energy_high", "energy_in_floors")),
            *(Column(name, "%") for name in shapes),
            *(Column(f"{self.keys[0]}_{q:.0%}".rstrip("%"), "um") for q in QUANTILES),
            Column("number_share", "%"),
            *(Column(name, "g") for name in ("mass", "mass_low", "mass_high")),
        )
        rows = [_row(part, self.keys, mass) for part in (*self.parts, self.mixture)]
        title = N_("Nearness of each material, and of the best mixture, to the target")
        return Table(title, columns, tuple(rows), (f"Target: {self.target}.", *self.notes))


MASSES = (
    "Sizes are by mass. Masses hold for parts of one density; tables without volumes count as ellipsoids. "
    "Distances within one floor are no larger than those of samples of the target itself."
)


def _row(part: MatchedPart, keys: Sequence[str], mass: float) -> tuple[Any, ...]:
    floors = part.energy / part.energy_floor
    far = [100 * part.wasserstein[key] for key in keys]
    grams = [mass * share for share in (part.mass_share, *part.mass_interval)]
    energies = (part.energy, *part.energy_interval, floors)
    return (part.name, part.n_particles, *energies, *far, *part.sizes, 100 * part.number_share, *grams)


def match(
    target: ComparedMaterial, candidates: Sequence[ComparedMaterial], weighting: str = "number", seed: int = 0
) -> Match:
    """Compare materials with a target and find the mixture of them that is nearest to it.

    Each has a size and one or more shapes that all others have too. ``weighting``: whether a particle counts
    as one (``number``) or by its volume (``volume``). ``seed``: of resampling and thinning.

    Raises InputError if a table is too small, two have one name, or they have no size or shape in common.
    """
    if weighting not in ("number", "volume"):
        raise InputError(f"Particles count by number or by volume, not by {weighting!r}.")
    _check(target, candidates)
    keys = _common_keys([target, *candidates])
    rng = np.random.default_rng(seed)
    most = MAX_ROWS // (len(candidates) + 1)
    materials = [_thinned(each, most, rng) for each in (target, *candidates)]
    comparison = _Comparison(materials, keys, weighting)
    ones = [np.ones((1, len(each.volumes))) for each in materials]
    resamples = [rng.multinomial(n, np.full(n, 1 / n), N_RESAMPLES).astype(float) for n in comparison.counts]
    (form_of_all,), samples = comparison.forms(ones), np.array(comparison.forms(resamples))
    shares, drawn = _nearest_shares(form_of_all), np.array([_nearest_shares(form) for form in samples])
    rows = np.vstack([np.eye(len(candidates)), shares])
    energies = np.einsum("pi,ij,pj->p", rows, form_of_all, rows)
    energies[-1] += _optimism(form_of_all, samples, drawn)
    spreads = np.einsum("pi,bij,pj->bp", rows, samples, rows)
    floors = comparison.floors(rows, rng)
    masses = comparison.mass_shares(shares[None], ones)[0]
    low, high = np.quantile(comparison.mass_shares(drawn, resamples), _ENDS, axis=0)
    parts = []
    for number, row in enumerate(rows):
        weights = comparison.weights(row)
        single = number < len(candidates)
        name = candidates[number].name if single else "mixture"
        span = (float(low[number]), float(high[number])) if single else (1.0, 1.0)
        parts.append(
            MatchedPart(
                name,
                len(candidates[number].volumes) if single else sum(len(e.volumes) for e in candidates),
                float(energies[number]),
                _interval(spreads[:, number], energies[number]),
                float(floors[number]),
                comparison.wasserstein(weights),
                float(shares[number]) if single else 1.0,
                float(masses[number]) if single else 1.0,
                span,
                comparison.size_quantiles(row),
            )
        )
    return Match(target.name, keys, weighting, tuple(parts[:-1]), parts[-1], comparison.size_quantiles(None))


_ENDS = ((1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2)


def _check(target: ComparedMaterial, candidates: Sequence[ComparedMaterial]) -> None:
    if not candidates:
        raise InputError("Name at least one candidate to compare with the target.")
    names = [each.name for each in candidates]
    if twice := next((name for name in names if names.count(name) > 1), ""):
        raise InputError(f"Two candidates are called {twice}; rename one.")
    for each in (target, *candidates):
        if not each.columns.keys() & {"volume", *SIZES}:
            raise InputError(f"{each.name} has no size: neither volume, equivalent_radius nor width.")
        check_count(each.name, len(next(iter(each.columns.values()), ())))


def check_count(name: str, count: int) -> None:
    """Check that a material has enough particles for a comparison."""
    if count < MIN_ROWS:
        raise InputError(f"{name} has {plural(count, 'particle')}; a comparison needs at least {MIN_ROWS}.")


def _common_keys(materials: Sequence[ComparedMaterial]) -> tuple[str, ...]:
    common = set.intersection(*(set(each.columns) for each in materials))
    size = next((key for key in SIZES if key in common), "")
    shapes = [key for key in SHAPES if key in common]
    if not size or not shapes:
        have = "; ".join(f"{each.name}: {', '.join(each.columns)}" for each in materials)
        raise InputError(f"Target and candidates have no size and shape in common ({have}).")
    return (size, *shapes)


def _thinned(material: ComparedMaterial, most: int, rng: np.random.Generator) -> ComparedMaterial:
    count = len(material.volumes)
    if count <= most:
        return material
    chosen = np.sort(rng.choice(count, most, replace=False))
    return ComparedMaterial(material.name, {key: column[chosen] for key, column in material.columns.items()})


class _Comparison:
    """Distances between all particles of target and parts, target first."""

    def __init__(self, materials: Sequence[ComparedMaterial], keys: Sequence[str], weighting: str) -> None:
        self.keys = keys
        self.counts = [len(each.volumes) for each in materials]
        self.values = np.concatenate([np.column_stack([m.columns[key] for key in keys]) for m in materials])
        self._volumes = np.concatenate([each.volumes for each in materials])
        self._by_volume = weighting == "volume"
        self._weights = self._volumes if self._by_volume else np.ones(len(self._volumes))
        self._parts = np.split(np.arange(len(self._volumes)), np.cumsum(self.counts)[:-1])
        features = np.column_stack([np.log(self.values[:, 0]), self.values[:, 1:]])
        own = self._parts[0]
        share = self._weights[own] / self._weights[own].sum()
        mean = share @ features[own]
        scatter = np.sqrt(share @ (features[own] - mean) ** 2)
        # What the target has one value of, but for rounding, is measured by the scatter of all.
        for unit in (features.std(axis=0), np.ones(len(keys))):
            scatter = np.where(scatter > 1e-9 * (1.0 + np.abs(mean)), scatter, unit)
        features = features / scatter
        self._distances = cdist(features, features)

    def forms(self, counts: Sequence[FloatArray]) -> list[FloatArray]:
        """K of each resample, whose `counts` (b, n) say how often it has each particle of each part."""
        k = len(self.counts)
        weights = [c * self._weights[part] for c, part in zip(counts, self._parts, strict=True)]
        squares = [(w**2).sum(axis=1) for w in weights]
        sums = [w.sum(axis=1) for w in weights]
        mean = np.empty((len(counts[0]), k, k))
        for i, first in enumerate(self._parts):
            for j, second in enumerate(self._parts[i:], start=i):
                product = weights[i] @ self._distances[np.ix_(first, second)]
                total = np.einsum("bn,bn->b", product, weights[j])
                # Without pairs of a particle with itself, also of one that was drawn several times: their
                # distance of 0 would lower the mean within a part and so move small parts away from the
                # target.
                pairs = sums[i] * sums[j] - (squares[i] if i == j else 0.0)
                mean[:, i, j] = mean[:, j, i] = total / pairs
        to_target, within = mean[:, 0, 1:], mean[:, 0, 0]
        return list(to_target[:, :, None] + to_target[:, None, :] - mean[:, 1:, 1:] - within[:, None, None])

    def floors(self, rows: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Energy distance that 1 of 20 pairs of samples of the target exceeds, as large as the compared."""
        own, n = self._parts[0], self.counts[0]
        within = self._distances[np.ix_(own, own)]
        shares = np.full(n, 1 / n)
        floors = []
        for row in rows:
            # Kish's effective number of particles of a mixture with these shares.
            count = round(1.0 / float((row**2 / np.array(self.counts[1:])).sum()))
            both = [rng.multinomial(m, shares, N_RESAMPLES).astype(float) for m in (n, max(count, 2))]
            x, y = (each * self._weights[own] for each in both)
            squares = [(each * self._weights[own] ** 2).sum(axis=1) for each in both]
            cross = np.einsum("bn,bn->b", x @ within, y) / (x.sum(axis=1) * y.sum(axis=1))
            inner = [
                np.einsum("bn,bn->b", z @ within, z) / (z.sum(axis=1) ** 2 - s)
                for z, s in zip((x, y), squares, strict=True)
            ]
            floors.append(float(np.quantile(2 * cross - inner[0] - inner[1], CONFIDENCE)))
        return np.maximum(floors, 1e-300)

    def mass_shares(self, shares: FloatArray, counts: Sequence[FloatArray]) -> FloatArray:
        """Of the parts, from `shares` (b, k) and the `counts` of :meth:`forms`, whose mean volumes differ."""
        if self._by_volume:
            return shares
        pairs = zip(counts[1:], self._parts[1:], strict=True)
        means = [(own @ self._volumes[part]) / own.sum(axis=1) for own, part in pairs]
        masses = shares * np.column_stack(means)
        return np.asarray(masses / masses.sum(axis=1, keepdims=True))

    def weights(self, row: FloatArray) -> FloatArray:
        """Of all particles of the parts in a mixture with these shares."""
        own = [self._weights[part] for part in self._parts[1:]]
        return np.concatenate([share * each / each.sum() for share, each in zip(row, own, strict=True)])

    def wasserstein(self, weights: FloatArray) -> dict[str, float]:
        """Distance of the mixture to the target in each descriptor, as a share of the target's mean."""
        n = self.counts[0]
        return {
            key: relative_wasserstein(column[:n], column[n:], self._weights[:n], weights)
            for key, column in zip(self.keys, self.values.T, strict=True)
        }

    def size_quantiles(self, row: FloatArray | None) -> tuple[float, ...]:
        """Quantiles of the size by mass, of a mixture or of the target."""
        n = self.counts[0]
        sizes, volumes = self.values[:, 0], self._volumes
        if row is None:
            return weighted_quantiles(sizes[:n], volumes[:n])
        factor = 1.0 if self._by_volume else volumes[n:]
        return weighted_quantiles(sizes[n:], self.weights(row) * factor)


def weighted_quantiles(values: FloatArray, weights: FloatArray) -> tuple[float, ...]:
    """Values at or below which :data:`QUANTILES` of the weight lie."""
    order = np.argsort(values)
    rising = np.cumsum(weights[order])
    places = np.searchsorted(rising, np.array(QUANTILES) * rising[-1])
    return tuple(float(v) for v in values[order][np.minimum(places, len(values) - 1)])


def _nearest_shares(form: FloatArray) -> FloatArray:
    """Shares that are not negative, add up to one and minimise w'Kw.

    The sum is one more row of the least squares: whatever its weight, the solution is on the same ray.
    """
    values, vectors = np.linalg.eigh(form)
    scale = max(float(np.abs(values).max()), 1e-300)
    # An unbiased estimate of K may have negative eigenvalues, which have no root.
    root = np.sqrt(np.maximum(values, 1e-12 * scale))[:, None] * vectors.T
    shares, _ = nnls(
        np.vstack([root, np.full(len(form), np.sqrt(scale))]), np.r_[np.zeros(len(form)), np.sqrt(scale)]
    )
    return np.asarray(shares / shares.sum())


def _optimism(form: FloatArray, samples: FloatArray, drawn: FloatArray) -> float:
    """By how much the fit of shares lowers the energy distance to the particles that it is made to.

    Shares of resamples are compared on all particles and on their own resample (Efron 1983).
    """
    everywhere = np.einsum("bi,ij,bj->b", drawn, form, drawn)
    return float((everywhere - np.einsum("bi,bij,bj->b", drawn, samples, drawn)).mean())


def _interval(resampled: FloatArray, estimate: float) -> tuple[float, float]:
    """As far as the resamples are spread; shifted, as resampling itself adds distance."""
    low, high = np.quantile(resampled, _ENDS) - (resampled.mean() - estimate)
    return float(low), float(high)
