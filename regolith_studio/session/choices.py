"""What the user wants: one frozen snapshot of every choice."""

import dataclasses
from dataclasses import dataclass, field
from typing import Any, Self

from regolith_studio.coarsening.coarsen import DEFAULT_METHOD, DEFAULT_PRESET, FACETS_LIMITS, settings_of
from regolith_studio.coarsening.stopping_criteria import check_limit, facets_for_triangles
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.shape_cache import BOX_METRICS
from regolith_studio.errors import InputError
from regolith_studio.harmonics.fit import DEFAULT_FIT_OPTIONS, FitOptions
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.readers.units import unit_factor

Scalar = bool | int | float | str

L_MAX_LIMIT = 30
"""Highest degree that is fitted; every lower one is a truncation of that fit."""
LEVEL_LIMITS = (0, 7)
TARGETS = {"fit": "surface of the spherical-harmonics fit", "particle": "CT particle itself"}


STOPS = {
    "facets": "a number of facets",
    "triangles": "a number of triangles",
    "error": "the fewest facets whose errors are all small enough",
}
"""What says how fine a polyhedron is."""


@dataclass(frozen=True)
class Choices:
    """Every setting that decides what is computed.

    Parameters
    ----------
    selected
        Id of the particle on screen; empty for none.
    star_point, rule, reference
        Of the :class:`~regolith_studio.harmonics.fit.FitOptions`: where radii begin, which crossing
        of a ray counts, what they are divided by.
    l_max
        Degree at which the spherical-harmonics series is cut, 0 to 30.
    level
        Subdivisions of the icosahedron that the fit is drawn on; 4 gives 5,120 triangles.
    stop_at
        Key of :data:`STOPS`; of the next three numbers only one counts, the others are kept.
    n_facets
        Facets asked of the coarsened polyhedron.
    n_triangles
        Most triangles that it may have.
    largest_error
        That its weighted descriptors may have, a fraction.
    method, settings
        Key of the coarsening method, and those of its settings that differ from its defaults, as
        sorted (name, value) pairs.
    weights, preset
        Weights of the loss (Eq. 9), and the preset that they came from; :attr:`preset_modified`
        says whether they still agree.
    seed
        Of all randomness.
    target
        What the coarsening imitates: ``fit`` (section 3.2 of the paper) or ``particle``.
    unit
        Length unit in which files without one are read.
    repair
        Whether what is wrong with meshes is mended as they are read.
    box_metric
        How the minimum-volume box of the descriptors is found.

    Raises
    ------
    InputError
        If a value is out of its range, or there is no such method or setting.
    """

    selected: str = ""
    star_point: str = DEFAULT_FIT_OPTIONS.star_point
    rule: str = DEFAULT_FIT_OPTIONS.rule
    reference: str = DEFAULT_FIT_OPTIONS.reference
    l_max: int = 10
    level: int = 4
    stop_at: str = "facets"
    n_facets: int = 20
    n_triangles: int = 68
    largest_error: float = 0.01
    method: str = DEFAULT_METHOD
    settings: tuple[tuple[str, Scalar], ...] = ()
    weights: LossWeights = field(default_factory=lambda: LossWeights.from_preset(DEFAULT_PRESET))
    preset: str = DEFAULT_PRESET
    seed: int = 0
    target: str = "fit"
    unit: str = "um"
    repair: bool = True
    box_metric: str = "exact"

    def __post_init__(self) -> None:
        _within("l_max", self.l_max, 0, L_MAX_LIMIT)
        _within("The subdivision level", self.level, *LEVEL_LIMITS)
        _within("The number of facets", self.n_facets, *FACETS_LIMITS)
        _one_of("number that coarsening stops at", self.stop_at, tuple(STOPS))
        facets_for_triangles(self.n_triangles)
        check_limit(self.largest_error)
        _within("The seed", self.seed, 0, 2**63 - 1)
        _one_of("target of the coarsening", self.target, tuple(TARGETS))
        _one_of("box metric", self.box_metric, tuple(BOX_METRICS))
        unit_factor(self.unit)
        settings_of(self.method, dict(self.settings))
        FitOptions(self.star_point, self.rule, self.reference)
        object.__setattr__(self, "settings", tuple(sorted(dict(self.settings).items())))

    def replaced(self, **changes: Any) -> Self:
        """A copy with `changes`; a preset brings its weights, another method drops the old settings.

        Raises
        ------
        InputError
            If a name is not a choice or a value is out of its range.
        """
        known = {each.name for each in dataclasses.fields(self)}
        if unknown := sorted(set(changes) - known):
            raise InputError(f"There is no choice called {unknown[0]}; there are {', '.join(sorted(known))}.")
        if "preset" in changes and "weights" not in changes:
            changes["weights"] = LossWeights.from_preset(changes["preset"])
        if changes.get("method", self.method) != self.method and "settings" not in changes:
            changes["settings"] = ()
        return dataclasses.replace(self, **changes)

    def changed_from(self, before: Self) -> frozenset[str]:
        """Names of the fields that differ."""
        names = (each.name for each in dataclasses.fields(self))
        return frozenset(name for name in names if getattr(self, name) != getattr(before, name))

    @property
    def fit_options(self) -> FitOptions:
        """How a radius function is taken and expanded."""
        return FitOptions(self.star_point, self.rule, self.reference)

    @property
    def facet_count(self) -> int:
        """Facets that are asked for; where the errors say so, those that studies take."""
        return facets_for_triangles(self.n_triangles) if self.stop_at == "triangles" else self.n_facets

    @property
    def fineness(self) -> tuple[int, float | None]:
        """What of :attr:`stop_at` and its numbers makes a difference to a polyhedron."""
        return (0, self.largest_error) if self.stop_at == "error" else (self.facet_count, None)

    @property
    def order(self) -> CoarseningRequest:
        """What is asked of a coarsening."""
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
            largest_error=self.fineness[1],
        )

    @property
    def preset_modified(self) -> bool:
        """Whether the weights are no longer those of the preset."""
        return self.weights != LossWeights.from_preset(self.preset)


def _within(what: str, value: Any, low: int, high: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise InputError(f"{what} must be a whole number from {low} to {high}, got {value!r}.")


def _one_of(what: str, value: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise InputError(f"There is no {what} called {value!r}; there are {', '.join(known)}.")
