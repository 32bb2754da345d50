"""Coarsen one particle by any of the methods."""

import dataclasses
import math
import numbers
from collections.abc import Generator, Iterator, Mapping
from typing import Any

import numpy as np

from regolith_studio.coarsening.core.line_overlap import compound_distance
from regolith_studio.coarsening.core.polyhedron_measures import polyhedron_of
from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.lower_bounds import attainable_errors
from regolith_studio.coarsening.methods import METHODS, CoarseningMethod
from regolith_studio.coarsening.optimiser.search import TERMS
from regolith_studio.coarsening.progress import CoarseningProgress, MethodStep
from regolith_studio.coarsening.result import CoarseningResult, MethodResult
from regolith_studio.coarsening.settings import DEFAULT_METHOD, DEFAULT_PRESET, FACETS_LIMITS
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, WEIGHT_KEYS, LossWeights
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.descriptors.describe import Descriptors, describe, relative_errors
from regolith_studio.errors import InputError
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle, solid_of
from regolith_studio.geometry.topology import genus
from regolith_studio.settings import is_whole
from regolith_studio.steps import as_events, result_of

SIZE_LIMITS = (1e-50, 1e50)
"""Cube root of a particle's volume: moments of inertia go with its fifth power."""


def facets_for_triangles(n_triangles: int) -> int:
    """Most facets whose polyhedron has at most `n_triangles` triangles: 4 n - 12 in general position.

    For solvers that count triangles.

    Raises
    ------
    InputError
        If the budget is no whole number or does not reach for 5 facets.
    """
    return _facets_within(n_triangles, "triangles", 4, 12)


def facets_for_vertices(n_vertices: int) -> int:
    """Most facets whose polyhedron has at most `n_vertices` vertices: 2 n - 4 in general position.

    For solvers that limit them (64 in PhysX, 128 in Box3D, 8 in exaDEM).
    """
    return _facets_within(n_vertices, "vertices", 2, 4)


def _facets_within(budget: int, what: str, factor: int, less: int) -> int:
    """Most facets n with factor n - less <= budget."""
    if not is_whole(budget):
        raise InputError(f"The number of {what} must be a whole number, got {budget}.")
    low, high = FACETS_LIMITS
    n_facets = (int(budget) + less) // factor
    if n_facets < low:
        raise InputError(f"{budget} {what} are too few: {low} facets have up to {factor * low - less}.")
    return min(n_facets, high)


def coarsen(
    particle: Particle | Mesh | Target,
    n_facets: int = 20,
    method: str = DEFAULT_METHOD,
    weights: LossWeights | None = None,
    seed: int = 0,
    settings: Any = None,
    fewer: HalfSpaces | None = None,
    max_vertices: int | None = None,
) -> CoarseningResult:
    """The polyhedron with `n_facets` facets for `particle` (section 2.4), convex but for `compound`.

    Parameters
    ----------
    particle
        Or its closed surface in any unit, or a :class:`Target` that was made from one.
    n_facets
        Facets of the polyhedron, 5 to 500.
    method
        Key of :data:`regolith_studio.coarsening.methods.METHODS`.
    weights
        Of the loss (Eq. 9); preset ``all`` where not given.
    seed
        Of the random numbers. Results do not depend on where a particle stands in a sample.
    settings
        The method's ``Settings``, or a mapping of those that differ from the defaults.
    fewer
        ``half_spaces`` of a result for the same particle with fewer facets. A method that can grow facets
        makes one more start from it, so that in a sweep more facets are never worse; others ignore it.
    max_vertices
        The polyhedron has at most so many vertices, in place of `n_facets`.

    Raises
    ------
    InputError
        If a number or a name is out of its range.
    GeometryError
        If the mesh is open, flat or encloses no volume.
    """
    if max_vertices is not None:
        n_facets = facets_for_vertices(max_vertices)
    _, run = _prepare(particle, n_facets, method, weights, seed, settings, fewer)
    return result_of(run)


def coarsening_steps(
    particle: Particle | Mesh | Target,
    n_facets: int = 20,
    method: str = DEFAULT_METHOD,
    weights: LossWeights | None = None,
    seed: int = 0,
    settings: Any = None,
    fewer: HalfSpaces | None = None,
) -> Generator[CoarseningProgress, None, CoarseningResult]:
    """As :func:`coarsen`, yielding each step; the first one has a polyhedron and comes at once."""
    target, run = _prepare(particle, n_facets, method, weights, seed, settings, fewer)

    def progress_of(step: MethodStep) -> Iterator[CoarseningProgress]:
        polyhedron: Polyhedron | None = None
        if step.half_spaces is not None:
            polyhedron = polyhedron_of(target.in_particle_frame(step.half_spaces))
        elif step.compound is not None:
            polyhedron = step.compound().moved(rotation=target.axes.T, scale=target.scale)
        yield CoarseningProgress(step.step, step.steps, step.loss, polyhedron, target.centre)

    return (yield from as_events(run, progress_of))


def _prepare(
    particle: Particle | Mesh | Target,
    n_facets: int,
    method: str,
    weights: LossWeights | None,
    seed: int,
    settings: Any,
    fewer: HalfSpaces | None,
) -> tuple[Target, Generator[MethodStep, None, CoarseningResult]]:
    """The target, and the method's steps with the measured result at their end."""
    chosen, n_facets = _method(method), _checked_facets(n_facets)
    weights = LossWeights.from_preset(DEFAULT_PRESET) if weights is None else weights
    _check(chosen, weights, seed)
    target = particle if isinstance(particle, Target) else Target.of(solid_of(particle))
    low, high = SIZE_LIMITS
    if not low <= target.scale <= high:
        raise InputError(
            f"The cube root of the particle's volume must be between {low:g} and {high:g}, got"
            f" {target.scale:.2g}; use another unit."
        )
    random, chosen_settings = np.random.SeedSequence(seed), settings_of(method, settings)
    few = None if fewer is None else target.in_unit_frame(fewer)
    run = chosen.run(target, n_facets, weights, random, chosen_settings, few)
    return target, _run_and_measure(run, target, method, n_facets, weights)


def _run_and_measure(
    run: Generator[MethodStep, None, MethodResult],
    target: Target,
    method: str,
    n_facets: int,
    weights: LossWeights,
) -> Generator[MethodStep, None, CoarseningResult]:
    return _measured(target, (yield from run), method, n_facets, weights)


def settings_of(method: str, settings: Any = None) -> Any:
    """The settings of `method` from ``None``, a mapping of changes, or settings already made."""
    kind = _method(method).Settings
    if isinstance(settings, kind):
        return settings
    changes = dict(settings) if isinstance(settings, Mapping) else {}
    if settings is not None and not isinstance(settings, Mapping):
        raise InputError(f"The settings of {method} must be {kind.__name__}, got {type(settings).__name__}.")
    known = {each.name: each.default for each in dataclasses.fields(kind)}
    for name, value in changes.items():
        if name not in known:
            raise InputError(f"The method {method} has no setting {name!r}; it has {', '.join(known)}.")
        if wanted := _wrong_kind(value, known[name]):
            raise InputError(f"The setting {name} of the method {method} must be {wanted}, got {value!r}.")
        if type(known[name]) is int:
            changes[name] = int(value)
    return kind(**changes)


def _wrong_kind(value: Any, default: Any) -> str:
    """What a setting must be, if `value` is of another kind than its default; else nothing."""
    if isinstance(default, str):
        return "" if isinstance(value, str) else "a word"
    if type(default) is int:
        return "" if is_whole(value) else "a whole number"
    return "" if isinstance(value, numbers.Real) and math.isfinite(value) else "a number"


def check_kept(method: str, weights: LossWeights) -> None:
    """Refuse terms to be kept for a method that knows weights only."""
    if weights.keep and not _method(method).keeps_terms:
        able = ", ".join(key for key, each in METHODS.items() if each.keeps_terms)
        raise InputError(f"The method {method} knows weights only and keeps no term exactly; use {able}.")


def _method(key: str) -> CoarseningMethod:
    if key not in METHODS:
        raise InputError(f"There is no coarsening method {key!r}; there are {', '.join(METHODS)}.")
    return METHODS[key]


def _checked_facets(n_facets: int) -> int:
    low, high = FACETS_LIMITS
    if not is_whole(n_facets) or not low <= n_facets <= high:
        raise InputError(f"The number of facets must be a whole number from {low} to {high}, got {n_facets}.")
    return int(n_facets)


def _check(method: CoarseningMethod, weights: Any, seed: Any) -> None:
    if not isinstance(weights, LossWeights):
        kind = type(weights).__name__
        raise InputError(f"The weights must be LossWeights, such as LossWeights.of(volume=1), got {kind}.")
    check_kept(method.key, weights)
    foreign = [key for key in LOSS_KEYS if key not in TERMS and (weights[key] or key in (weights.keep or ()))]
    # The descents of these methods have derivatives of their own terms only; others measure by the public
    # descriptors.
    if foreign and method.keeps_terms:
        raise InputError(
            f"The method {method.key} does not know the term {foreign[0]}; give it the weight 0, or take"
            f" {', '.join(key for key, each in METHODS.items() if not each.keeps_terms)}."
        )
    if weights.all_zero and not weights.keep and method.key != "quadric":
        raise InputError("All weights of the loss are 0, so there is nothing to optimise; raise one of them.")
    if not is_whole(seed) or seed < 0:
        raise InputError(f"The seed must be a whole number, 0 or above, got {seed!r}.")


def _measured(
    target: Target, result: MethodResult, method: str, n_facets: int, weights: LossWeights
) -> CoarseningResult:
    """Measure the result by the public descriptors, independently of the method."""
    solid = result.solid
    unit: Polyhedron
    if isinstance(solid, ConvexCompound):
        # A union can meet V and CH at the same time, so that no error is unavoidable.
        unit, overlap = solid, compound_distance(target.mesh, solid)
        bounds = dict.fromkeys(WEIGHT_KEYS, 0.0)
    else:
        # Not the compiled intersection, which keeps corners apart where more than three planes meet, as those
        # of decimated hulls do.
        unit = result.polyhedron or ConvexPolyhedron.from_half_spaces(solid)
        known = result.jaccard_distance
        overlap = target.jaccard_distance(unit.half_spaces) if known is None else known
        bounds = attainable_errors(target.descriptors, n_facets, weights)
        if result.makes_compounds:
            bounds |= dict.fromkeys((JACCARD, "volume", "convex_hull_volume"), 0.0)
    polyhedron = unit.moved(rotation=target.axes.T, scale=target.scale)
    achieved = result.achieved or describe(unit)
    errors = relative_errors(target.descriptors, achieved)
    return CoarseningResult(
        polyhedron=polyhedron,
        centre=target.centre,
        target=in_unit(target.descriptors, target.scale),
        achieved=in_unit(achieved, target.scale),
        errors=errors,
        jaccard_distance=overlap,
        loss=loss(weights, errors, overlap),
        loss_history=result.loss_history,
        method=method,
        n_facets_asked=n_facets,
        bounds=bounds,
        reason=result.reason,
        steps=result.steps,
        variants=result.variants,
        free_jaccard_distance=result.free_distance,
        genus=_genus(target.mesh, solid.mesh) if isinstance(solid, ConvexCompound) else None,
    )


def _genus(particle: Mesh, union: Mesh) -> tuple[int, int] | None:
    """Tunnels of both; ``None`` where the particle has none."""
    found = genus(particle.faces, len(particle.vertices))
    return (found, genus(union.faces, len(union.vertices))) if found else None


def in_unit(descriptors: Descriptors, scale: float) -> Descriptors:
    """Descriptors of the unit-volume shape, in the unit of the particle."""
    return Descriptors({key: value * scale ** CATALOGUE[key].dimension for key, value in descriptors.items()})
