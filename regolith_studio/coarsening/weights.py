"""Weights of the loss (Eq. 9), and the shipped sets of them."""

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Self

from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.resources import resource

JACCARD = "jaccard_distance"
"""Key of the term that the paper calls IoU (Eq. 7)."""
WEIGHT_KEYS: tuple[str, ...] = (JACCARD, *LOSS_KEYS)
"""Terms of the loss in the order of the paper's Figure 8."""
KEPT = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")
"""Terms that are kept exactly by default, where their weight is above 0."""
MAX_WEIGHT = 1_000_000


@dataclass(frozen=True)
class LossWeights(Mapping[str, float]):
    """One weight for each term of Eq. 9, and which terms are kept exactly.

    Parameters
    ----------
    values_by_key
        Weights in the order of :data:`WEIGHT_KEYS`: what the loss pays for a relative error of 1.
    keep
        Terms that are met to 1e-6 whatever their weight; ``None`` leaves the choice to the weights, see
        :attr:`kept`. Only the exact methods know such terms.

    Raises
    ------
    InputError
        If a weight is negative or above a million, or a term cannot be kept.
    """

    values_by_key: tuple[float, ...]
    keep: frozenset[str] | None = None

    def __post_init__(self) -> None:
        for key in self.keep or ():
            if key not in LOSS_KEYS:
                raise InputError(
                    f"The term {key!r} cannot be kept exactly; these can: {', '.join(LOSS_KEYS)}."
                )
        values = tuple(float(value) for value in self.values_by_key)
        if len(values) != len(WEIGHT_KEYS):
            raise ValueError(f"there are {len(WEIGHT_KEYS)} weights, got {len(values)}")
        for key, value in zip(WEIGHT_KEYS, values, strict=True):
            if not 0.0 <= value <= MAX_WEIGHT:
                raise InputError(f"The weight of {key} must lie between 0 and {MAX_WEIGHT:,}, got {value}.")
        object.__setattr__(self, "values_by_key", values)

    @property
    def kept(self) -> frozenset[str]:
        """Terms that the exact methods keep: `keep`, or those of :data:`KEPT` with a weight.

        The convex hull volume takes the place of a volume without a weight.
        """
        if self.keep is not None:
            return self.keep
        kept = {key for key in KEPT if self[key] > 0.0}
        if self["convex_hull_volume"] > 0.0 and not self["volume"] > 0.0:
            kept.add("convex_hull_volume")
        return frozenset(kept)

    @classmethod
    def of(cls, **weights: float) -> Self:
        """From keyword arguments; terms that are not named get weight 0.

        Raises
        ------
        InputError
            If a name is no term of the loss or a weight is negative or not finite.
        """
        for key in weights:
            if key not in WEIGHT_KEYS:
                raise InputError(f"The loss has no term {key!r}; it has {', '.join(WEIGHT_KEYS)}.")
        return cls(tuple(weights.get(key, 0.0) for key in WEIGHT_KEYS))

    def keeping(self, keys: Iterable[str] | None) -> Self:
        """A copy in which these terms are kept exactly; ``None`` leaves the choice to the weights."""
        return replace(self, keep=None if keys is None else frozenset(keys))

    @classmethod
    def from_preset(cls, name: str) -> Self:
        """The weights of the shipped preset `name`.

        Raises
        ------
        InputError
            If there is no such preset.
        """
        known = presets()
        if name not in known:
            raise InputError(f"There is no preset {name!r}; there are {', '.join(known)}.")
        return cls(known[name].weights.values_by_key)

    def replaced(self, **weights: float) -> Self:
        """A copy in which the named weights are changed."""
        return self.of(**{**self, **weights}).keeping(self.keep)

    def __getitem__(self, key: str) -> float:
        try:
            return self.values_by_key[WEIGHT_KEYS.index(key)]
        except ValueError:
            raise KeyError(key) from None

    def __iter__(self) -> Iterator[str]:
        return iter(WEIGHT_KEYS)

    def __len__(self) -> int:
        return len(WEIGHT_KEYS)

    @property
    def all_zero(self) -> bool:
        """Whether nothing is asked for."""
        return not any(self.values_by_key)


@dataclass(frozen=True)
class Preset:
    """A named set of weights: file stem in ``resources/presets``, label, weights and where they come from."""

    name: str
    label: str
    weights: LossWeights
    origin: str


@cache
def presets() -> dict[str, Preset]:
    """The shipped presets by name, in the order that their files give."""
    documents = [json.loads(path.read_text("utf-8")) for path in sorted(resource("presets").glob("*.json"))]
    documents.sort(key=lambda document: document["order"])
    return {
        document["name"]: Preset(
            document["name"], document["label"], LossWeights.of(**document["weights"]), document["origin"]
        )
        for document in documents
    }
