"""Descriptors as conditions: met to 1e-6, or a reason given; the rest of the freedom goes into overlap."""

from collections.abc import Generator
from dataclasses import dataclass, field, replace

import numpy as np

from regolith_studio.coarsening.bounds import sphericity_reason
from regolith_studio.coarsening.core.box_search import DENSE_ANGLE, FINE_ANGLE, SAMPLE_ANGLE
from regolith_studio.coarsening.core.cuts import SMALLEST_FACET
from regolith_studio.coarsening.evaluation import LossFunction
from regolith_studio.coarsening.exact.compromise import compromise, with_facets_back
from regolith_studio.coarsening.exact.course import Attempt, course, densely_checked, start_planes
from regolith_studio.coarsening.exact.growth import grown, numbers_to_grow_from, with_waiting
from regolith_studio.coarsening.exact.problem import Problem
from regolith_studio.coarsening.exact.record import Record
from regolith_studio.coarsening.exact.request import CONDITION_KEYS, EXACT, Request, reason_for
from regolith_studio.coarsening.polyhedra import facet_areas, polyhedron_of
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.half_spaces import HalfSpaces


@dataclass(frozen=True)
class Level:
    """Effort: starts, polyhedra with few facets at each to grow many from, steps of both descents."""

    starts: int
    few_starts: int
    free_steps: int
    bound_steps: int


COMPROMISES = (12, 20)
"""Facets to start from, besides all, where conditions cannot be met together."""
ROUND_STARTS = 2
"""Starts from which polyhedra as round as can be are sought where the particle is rounder than the first."""
OUT_OF_REACH = 4e-3
"""Where they miss the sphericity by more (in logarithms, added up), no further start is tried."""
STARTS_FOR_FACETS = 3
"""Further starts where all conditions are met, but a half-space bounds no facet."""
LEVELS = {"fast": Level(1, 2, 12, 16), "best": Level(3, 3, 20, 40)}


@dataclass(frozen=True)
class ExactSettings:
    """Effort of the exact method.

    Parameters
    ----------
    level
        ``fast`` (one start) or ``best`` (several starts, longer descents: better overlap).
    retries
        Further starts where no polyhedron meets all conditions.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    level: str = field(default="fast", metadata={"label": "Level", "choices": tuple(LEVELS)})
    retries: int = field(default=8, metadata={"label": "Retries", "minimum": 0, "maximum": 100})

    def __post_init__(self) -> None:
        if self.level not in LEVELS:
            raise InputError(f"The level must be one of {', '.join(LEVELS)}, got {self.level!r}.")
        if not 0 <= self.retries <= 100:
            raise InputError(f"The retries must lie between 0 and 100, got {self.retries}.")


class ExactMethod:
    """Constrained optimisation of the half-spaces.

    Weights above 0 make conditions: volume (or, if the weights of Eq. 9 prefer it, convex hull volume),
    sphericity, shortest and longest edge of the exact minimum-volume box, aspect ratio. On the surface where
    all hold, the Jaccard distance goes down; it is the tie-break even where its own weight is 0, since
    shapes that only meet descriptors drift away from the particle.
    """

    key = "exact"
    label = "Exact descriptors"
    Settings = ExactSettings

    def run(
        self,
        target: Target,
        n_faces: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,
        settings: ExactSettings,
    ) -> Generator[MethodStep, None, MethodResult]:
        """A step for each better polyhedron; the first is the start."""
        rng = np.random.default_rng(seed)
        request, level = Request.of(target, weights), LEVELS[settings.level]
        free = request.problem(target.rays, SAMPLE_ANGLE, only_volume=True)
        full = request.problem(target.rays, SAMPLE_ANGLE)
        rest = request.problem(target.rays, SAMPLE_ANGLE, sphericity=False)
        checks = tuple(request.problem(target.rays, angle) for angle in (FINE_ANGLE, DENSE_ANGLE))
        judge = LossFunction(target, weights, everything=True)
        round_asked = request.asked[1]
        hopeless = round_asked and sphericity_reason(target.descriptors["sphericity"], n_faces) is not None
        numbers = (n_faces,) if hopeless else numbers_to_grow_from(target, n_faces, round_asked)
        total = ROUND_STARTS if hopeless else level.starts + settings.retries
        record, steps, misses = Record(judge, total), (level.free_steps, level.bound_steps), []
        for tried in range(1, total + 1):
            planes = start_planes(target, n_faces, rng)
            if tried == 1:
                yield MethodStep(0, total, judge.value(*planes, SAMPLE_ANGLE), HalfSpaces(*planes))
            few = numbers[(tried - 1) % len(numbers)]
            if few < n_faces:
                attempts = grown(target, free, full, n_faces, few, level.few_starts, rng, *steps)
                yield from record.told(tried, attempts)
            elif not hopeless:
                yield from record.told(tried, course(target, free, full, planes, *steps))
            if round_asked and not record.met and tried <= ROUND_STARTS:
                rounder = list(compromise(target, full, rest, planes, level.bound_steps, True))
                yield from record.told(tried, rounder)
                misses += [rounder[-1].worst] if rounder else []
            if record.best is None:
                yield from record.told(tried, course(target, free, full, planes, *steps))
            if tried >= level.starts and record.best is not None and record.best.exact:
                best = record.best = confirmed(request, checks, record.best)
                if best.exact and (best.n_facets == n_faces or tried >= level.starts + STARTS_FOR_FACETS):
                    break
            if sum(misses) > OUT_OF_REACH:
                break
        if record.best is None or record.outcome is None:
            raise GeometryError("No start of the exact method bounds a polyhedron.")
        if round_asked and not record.met and not misses:
            few_planes = [
                with_waiting(*start_planes(target, few, rng), n_faces) for few in COMPROMISES if few < n_faces
            ]
            for begun in (planes, (record.best.normals, record.best.offsets), *few_planes):
                yield from record.told(total, compromise(target, full, rest, begun, level.bound_steps))
        planes_kept = real_planes(with_facets_back(target, full, record.outcome))
        found = describe(polyhedron_of(planes_kept), LOSS_KEYS)
        reason = reason_for(target, request, n_faces, len(planes_kept), found)
        counts = {"starts": float(tried), "exact": float(record.met)}
        return MethodResult(planes_kept, tuple(record.history), reason, counts)


def confirmed(request: Request, problems: tuple[Problem, ...], found: Attempt) -> Attempt:
    """The attempt, polished with ever finer searches for boxes until the public descriptors agree.

    Its residual is the largest error of the public descriptors where they never do.
    """
    wanted = dict(zip(CONDITION_KEYS, request.values, strict=True))
    for problem in problems:
        found = densely_checked(problem, found)
        if not found.exact:
            return found
        values = describe(polyhedron_of(real_planes(found)), CONDITION_KEYS)
        worst = max((abs(values[key] / wanted[key] - 1.0) for key in request.keys), default=0.0)
        if worst <= EXACT / 2:  # so that the ratio of two diameters has no more than EXACT
            return found
    return replace(found, worst=worst)


def real_planes(found: Attempt) -> HalfSpaces:
    """Half-spaces whose facets are more than rounding."""
    planes = HalfSpaces(found.normals, found.offsets)
    areas = facet_areas(planes)
    kept = areas >= SMALLEST_FACET
    return planes if kept.all() else HalfSpaces(found.normals[kept], found.offsets[kept])


METHOD = ExactMethod()
