"""The user's choices as one frozen snapshot, and which results depend on which of them."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any, Self

from regolith_studio.coarsening.coarsen import (
    check_kept,
    facets_for_triangles,
    facets_for_vertices,
    settings_of,
)
from regolith_studio.coarsening.settings import DEFAULT_PRESET, CoarseningSettings
from regolith_studio.coarsening.stopping_criteria import check_limit
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import BOX_METRICS
from regolith_studio.errors import InputError
from regolith_studio.harmonics.fit_options import FitOptions, FitSurfaceSettings
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.readers.settings import ReadingSettings, unit_factor
from regolith_studio.settings import setting

Scalar = bool | int | float | str


@dataclass(frozen=True)
class Choices(ReadingSettings, CoarseningSettings, FitSurfaceSettings, FitOptions):
    """Every setting that decides what is computed.

    Fields made by :func:`~regolith_studio.settings.setting` describe themselves, and are entries of a recipe.

    - ``selected``: id of the particle on screen; empty for none.
    - ``settings``: settings of the method that differ from its defaults, as sorted (name, value) pairs.
    - ``weights``: of the loss (Eq. 9); :attr:`preset_modified` says whether they still are those of the
      preset.
    """

    selected: str = ""
    settings: tuple[tuple[str, Scalar], ...] = ()
    weights: LossWeights = field(default_factory=lambda: LossWeights.from_preset(DEFAULT_PRESET))
    box_metric: str = setting(
        "exact",
        "Bounding box",
        "How the minimum-volume box of the descriptors is found.",
        choices={key: key for key in BOX_METRICS},
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        facets_for_triangles(self.n_triangles)
        facets_for_vertices(self.n_vertices)
        check_limit(self.largest_error)
        unit_factor(self.unit)
        settings_of(self.method, dict(self.settings))
        check_kept(self.method, self.weights)
        object.__setattr__(self, "settings", tuple(sorted(dict(self.settings).items())))

    def replaced(self, **changes: Any) -> Self:
        """A copy with `changes`; a preset brings its weights, another method drops the old settings and
        what was to be kept.
        """
        known = {each.name for each in dataclasses.fields(self)}
        if unknown := sorted(set(changes) - known):
            raise InputError(f"There is no choice called {unknown[0]}; there are {', '.join(sorted(known))}.")
        if "preset" in changes and "weights" not in changes:
            changes["weights"] = LossWeights.from_preset(changes["preset"])
        if changes.get("method", self.method) != self.method:
            changes.setdefault("settings", ())
            changes.setdefault("weights", self.weights.keeping(None))
        return dataclasses.replace(self, **changes)

    def changed_from(self, before: Self) -> frozenset[str]:
        """Names of the fields that differ."""
        names = (each.name for each in dataclasses.fields(self))
        return frozenset(name for name in names if getattr(self, name) != getattr(before, name))

    @property
    def fit_options(self) -> FitOptions:
        """How a radius function is taken and expanded."""
        return FitOptions(**{each.name: getattr(self, each.name) for each in dataclasses.fields(FitOptions)})

    @property
    def facet_count(self) -> int:
        """Maximum number of facets; studies use it also where the largest error is the criterion."""
        match self.stop_at:
            case "triangles":
                return facets_for_triangles(self.n_triangles)
            case "vertices":
                return facets_for_vertices(self.n_vertices)
        return self.n_facets

    @property
    def stopping_criterion(self) -> tuple[int, float | None]:
        """Number of facets and largest error; the one that :attr:`stop_at` ignores is 0 or ``None``."""
        return (0, self.largest_error) if self.stop_at == "error" else (self.facet_count, None)

    @property
    def coarsening_request(self) -> CoarseningRequest:
        """The settings of a coarsening."""
        return CoarseningRequest(
            weights=self.weights,
            n_facets=self.facet_count,
            method=self.method,
            settings=self.settings,
            seed=self.seed,
            target=self.target,
            l_max=self.l_max,
            level=self.level,
            fit_options=self.fit_options,
            largest_error=self.stopping_criterion[1],
        )

    @property
    def preset_modified(self) -> bool:
        """Whether the weights are no longer those of the preset."""
        return self.weights != LossWeights.from_preset(self.preset)


class Kind(StrEnum):
    """Kinds of results; each is a queue of its own, in which the newest request wins."""

    FIT = "fit"
    SURFACE = "surface"
    DESCRIPTORS = "descriptors"
    COARSENING = "coarsening"
    COMPARISON = "comparison"
    LMAX_STUDY = "lmax_study"
    COARSENING_STUDY = "coarsening_study"


LIVE = (Kind.FIT, Kind.SURFACE, Kind.DESCRIPTORS, Kind.COARSENING, Kind.COMPARISON)
"""Kinds that are recomputed after every change of a choice."""
STUDIES = (Kind.LMAX_STUDY, Kind.COARSENING_STUDY)
"""Kinds that are computed on demand."""

_FIT_OPTIONS = tuple(each.name for each in fields(FitOptions))
PARTICLE_CHOICES = ("selected",)
"""Choices that say which mesh is shown, fitted, measured and coarsened; one that changes it stands here."""
PARTICLE_DESCRIPTORS = (*PARTICLE_CHOICES, "box_metric")
"""What the descriptors of the particle itself depend on."""
_FIT = (*PARTICLE_CHOICES, *_FIT_OPTIONS)
_OF_FIT = (*_FIT_OPTIONS, "l_max", "level")
_SURFACE = (*PARTICLE_CHOICES, *_OF_FIT)
_COARSENING = (*PARTICLE_CHOICES, "target", "stopping_criterion", "method", "settings", "weights", "seed")
DEPENDS_ON: Mapping[Kind, tuple[str, ...]] = {
    Kind.FIT: _FIT,
    Kind.SURFACE: _SURFACE,
    Kind.DESCRIPTORS: (*_SURFACE, "box_metric"),
    Kind.COARSENING: _COARSENING,
    Kind.COMPARISON: (*_COARSENING, "box_metric"),
    Kind.LMAX_STUDY: (*_FIT_OPTIONS, "level"),
    Kind.COARSENING_STUDY: ("target", "facet_count", "method", "settings", "seed"),
}
"""The choices, and properties of them, that each kind of result depends on."""

_UPSTREAM: Mapping[Kind, tuple[Kind, ...]] = {
    Kind.SURFACE: (Kind.FIT,),
    Kind.DESCRIPTORS: (Kind.SURFACE,),
    Kind.COARSENING: (Kind.SURFACE,),
    Kind.COMPARISON: (Kind.DESCRIPTORS, Kind.COARSENING),
}


@dataclass(frozen=True)
class ComputationRequest:
    """A kind of result to compute, and the kinds that it is computed from."""

    kind: Kind
    needs: tuple[Kind, ...] = ()


def plan(before: Choices | None, after: Choices, is_fitted: bool = False) -> tuple[ComputationRequest, ...]:
    """The results to compute after a change from `before` to `after`, in the order of dependence.

    ``before``: ``None`` when nothing has been computed yet. ``is_fitted``: whether the fit that `after` asks
    for is cached, and need not be made again.
    """
    if not after.selected:
        return ()
    due = [kind for kind in LIVE if before is None or depends(kind, before, after)]
    if is_fitted and Kind.FIT in due:
        due.remove(Kind.FIT)
    if after.target == "particle" and Kind.COMPARISON in due:  # it is what the coarsening measures
        due.remove(Kind.COMPARISON)
    return tuple(ComputationRequest(kind, needs(kind, after)) for kind in due)


def depends(kind: Kind, before: Choices, after: Choices) -> bool:
    """Whether a result of `kind` for `before` is not the result for `after`."""
    names = dependencies(kind, after)
    return inputs(before, names) != inputs(after, names)


def dependencies(kind: Kind, choices: Choices) -> tuple[str, ...]:
    """The choices, and properties of them, that a result of `kind` depends on."""
    of_fit = kind in (Kind.COARSENING, Kind.COMPARISON, Kind.COARSENING_STUDY) and choices.target == "fit"
    return DEPENDS_ON[kind] + (_OF_FIT if of_fit else ())


def inputs(choices: Choices, names: tuple[str, ...]) -> tuple[Any, ...]:
    """The values of these choices and properties: what a cached result is found by."""
    return tuple(getattr(choices, name) for name in names)


def needs(kind: Kind, choices: Choices) -> tuple[Kind, ...]:
    """The kinds that a result of `kind` is computed from."""
    if kind is Kind.COARSENING and choices.target == "particle":
        return ()
    return _UPSTREAM.get(kind, ())
