"""Variants of a loss to be compared by a study: losses by name, numbers of facets, varied weights."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import combinations
from typing import Any, Self

from regolith_studio.coarsening.settings import DEFAULT_METHOD
from regolith_studio.coarsening.weights import JACCARD, WEIGHT_KEYS, LossWeights, presets
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.messages import N_, Message, Number, join_messages

PAPER_LOSSES = (
    "quadric",
    "descriptors",
    "volume_sphericity_aspect_ratio",
    "overlap",
    "aspect_ratio_overlap",
    "all",
)
"""Presets that stand for the rows of Fig. 8."""
ALONE = "only_"
"""Begins the name of a loss with a single descriptor: ``only_volume``."""
FACET_COUNTS = (8, 12, 16, 20, 30, 50)
OVERLAP_FACTORS = (0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
CHANGE_FACTORS = (0.0, 4.0)
GROUPS: Mapping[str, tuple[str, ...]] = {
    N_("size"): ("volume", "convex_hull_volume"),
    N_("box"): ("min_diameter", "max_diameter", "aspect_ratio"),
    N_("sphericity"): ("sphericity",),
}
"""Descriptors that are kept or left together when conditions are traded for overlap."""
BASELINES = ("quadric", "pchs")
"""Methods without a loss."""
CONDITION_METHODS = ("exact", "compound")
"""Methods in which a weight above 0 makes a condition, so that its size alone changes little."""


@dataclass(frozen=True)
class LossVariant:
    """One way to coarsen every particle: a row of a study.

    - ``label``: as printed.
    - ``weights``: of the loss; all 0 stands for the quadric start itself.
    - ``method``: key of the coarsening method.
    - ``n_facets``: facets.
    - ``settings``: of the method, as (name, value) pairs.
    """

    label: str
    weights: LossWeights
    method: str = DEFAULT_METHOD
    n_facets: int = 20
    settings: tuple[tuple[str, Any], ...] = ()

    @property
    def is_baseline(self) -> bool:
        """Whether no loss has a part in the result, as in the first row of Fig. 8."""
        return self.weights.all_zero or self.method in BASELINES

    @property
    def method_run(self) -> str:
        """Key of the method that makes the row: without weights ``quadric``, whatever was named."""
        return "quadric" if self.weights.all_zero and self.method not in BASELINES else self.method

    @property
    def settings_run(self) -> tuple[tuple[str, Any], ...]:
        """Settings of that method: none if another was named."""
        return self.settings if self.method_run == self.method else ()

    def relabelled(self, label: str, **changes: Any) -> Self:
        """A copy with `changes` under another name."""
        return replace(self, label=label, **changes)


@dataclass(frozen=True)
class Loss:
    """A loss with a name: a preset, or a single descriptor."""

    label: str
    weights: LossWeights


@cache
def losses() -> dict[str, Loss]:
    """The presets by name, then each descriptor of the loss alone (overlap alone is a preset)."""
    alone = {
        f"{ALONE}{key}": Loss(
            Message(N_("{name} only"), name=Message(CATALOGUE[key].label)), LossWeights.of(**{key: 1.0})
        )
        for key in LOSS_KEYS
    }
    return {name: Loss(each.label, each.weights) for name, each in presets().items()} | alone


def loss_variants(names: Sequence[str], like: LossVariant) -> tuple[LossVariant, ...]:
    """A row for each name of :func:`losses`, in all else as `like`.

    Raises InputError if there is no such loss.
    """
    known = losses()
    for name in names:
        if name not in known:
            raise InputError(f"There is no loss called {name!r}; there are {', '.join(known)}.")
    return tuple(like.relabelled(known[name].label, weights=known[name].weights) for name in names)


def paper_variants(
    method: str = DEFAULT_METHOD, n_facets: int = 20, **settings: Any
) -> tuple[LossVariant, ...]:
    """The rows of Fig. 8, coarsened by `method`."""
    like = LossVariant("", LossWeights.of(), method, n_facets, tuple(settings.items()))
    return loss_variants(PAPER_LOSSES, like)


def facet_count_variants(
    like: LossVariant, counts: Sequence[float] = FACET_COUNTS
) -> tuple[LossVariant, ...]:
    """One row for each number of facets, ascending.

    Raises InputError if a number is no whole number.
    """
    for count in counts:
        if count != int(count):
            raise InputError(f"Numbers of facets are whole numbers, got {count:g}.")
    return tuple(
        like.relabelled(Message(N_("{count} facets"), count=int(count)), n_facets=int(count))
        for count in sorted(set(counts))
    )


def tradeoff_variants(
    like: LossVariant, factors: Sequence[float] = OVERLAP_FACTORS
) -> tuple[LossVariant, ...]:
    """Overlap against descriptors.

    Where weights are weighed against each other, one row for each factor on the weight of the overlap, and
    the overlap alone. Where they make conditions, what each choice of conditions costs: the overlap alone,
    and every choice of the :data:`GROUPS` that `like` has weights for.

    Raises InputError if `like` has no weight on a descriptor, a factor is negative, or the method has no
    loss.
    """
    _check_factors(like, factors)
    overlap = like.weights[JACCARD] or 1.0
    descriptors = {key: like.weights[key] for key in LOSS_KEYS if like.weights[key]}
    if not descriptors:
        raise InputError("A trade-off needs a weight above 0 on at least one descriptor.")
    alone = like.relabelled(N_("Overlap only"), weights=LossWeights.of(**{JACCARD: overlap}))
    if like.method in CONDITION_METHODS:
        return (alone, *_condition_variants(like, overlap, descriptors))
    weighed = [
        like.relabelled(
            _scaled(JACCARD, factor), weights=like.weights.replaced(**{JACCARD: overlap * factor})
        )
        for factor in sorted(set(factors))
    ]
    return (*weighed, alone)


def _condition_variants(
    like: LossVariant, overlap: float, descriptors: Mapping[str, float]
) -> tuple[LossVariant, ...]:
    groups = {name: [key for key in keys if key in descriptors] for name, keys in GROUPS.items()}
    present = [name for name, keys in groups.items() if keys]
    rows = []
    for count in range(1, len(present) + 1):
        for chosen in combinations(present, count):
            weights = {key: descriptors[key] for name in chosen for key in groups[name]}
            label = join_messages([Message(N_("Overlap")), *map(Message, chosen)], " + ")
            rows.append(like.relabelled(label, weights=LossWeights.of(**{JACCARD: overlap}, **weights)))
    return tuple(rows)


def sensitivity_variants(
    like: LossVariant, factors: Sequence[float] = CHANGE_FACTORS
) -> tuple[LossVariant, ...]:
    """The weights themselves, then each of them multiplied by each factor, alone.

    Raises InputError if no weight is above 0, a factor is negative, or the method has no loss.
    """
    _check_factors(like, factors)
    rows = [like.relabelled(N_("As given"))]
    for key in WEIGHT_KEYS:
        for factor in sorted(set(factors) - {1.0}):
            changed = like.weights.replaced(**{key: like.weights[key] * factor})
            if like.weights[key] and not changed.all_zero:
                rows.append(like.relabelled(_scaled(key, factor), weights=changed))
    return tuple(rows)


def _check_factors(like: LossVariant, factors: Sequence[float]) -> None:
    if like.is_baseline:
        raise InputError("A baseline has no loss whose weights could be varied; take another method.")
    for factor in factors:
        if not factor >= 0:
            raise InputError(f"A factor on a weight must be 0 or a positive number, got {factor:g}.")


def _scaled(key: str, factor: float) -> Message:
    name = Message(N_("Overlap") if key == JACCARD else CATALOGUE[key].label)
    return Message(N_("{name} × {factor}"), name=name, factor=Number(factor, "g"))
