"""Descriptors as conditions: met to 1e-6, or a reason given; the rest of the freedom goes into overlap."""

from collections.abc import Generator
from dataclasses import dataclass, field, replace

import numpy as np

from regolith_studio.coarsening.bounds import sphericity_reason
from regolith_studio.coarsening.core.box_search import DENSE_ANGLE, FINE_ANGLE, SAMPLE_ANGLE
from regolith_studio.coarsening.core.cuts import SMALLEST_FACET
from regolith_studio.coarsening.evaluation import LossFunction
from regolith_studio.coarsening.exact.course import Attempt, compromise, course, densely_checked, start_planes
from regolith_studio.coarsening.exact.growth import grown, numbers_to_grow_from
from regolith_studio.coarsening.exact.problem import Problem
from regolith_studio.coarsening.exact.request import CONDITION_KEYS, EXACT, Request, reason_for
from regolith_studio.coarsening.polyhedra import facet_areas, polyhedron_of
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.comparison import relative_errors
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


COMPROMISE_STEPS = 64
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
        fine = request.problem(target.rays, FINE_ANGLE)
        dense = request.problem(target.rays, DENSE_ANGLE)
        judge = LossFunction(target, weights, everything=True)
        hopeless = (
            request.asked[1] and sphericity_reason(target.descriptors["sphericity"], n_faces) is not None
        )
        numbers = (n_faces,) if hopeless else numbers_to_grow_from(target, n_faces, request.asked[1])
        total = 2 if hopeless else level.starts + settings.retries
        best: Attempt | None = None
        history: list[float] = []
        tried = 0
        for tried in range(1, total + 1):
            planes = start_planes(target, n_faces, rng)
            if tried == 1:
                yield MethodStep(0, total, judge.value(*planes, SAMPLE_ANGLE), HalfSpaces(*planes))
            steps = (level.free_steps, level.bound_steps)
            few = numbers[(tried - 1) % len(numbers)]
            if few < n_faces:
                attempts = grown(target, free, full, n_faces, few, level.few_starts, rng, *steps)
            else:
                attempts = course(target, free, full, planes, *steps)
            for found in attempts:
                if not found.better_than(best):
                    continue
                best = found
                history.append(judge.of(best.values))
                yield MethodStep(tried, total, history[-1], HalfSpaces(best.normals, best.offsets))
            if tried >= level.starts and best is not None and best.exact:
                best = confirmed(request, (fine, dense), best)
                if best.exact and (best.n_facets == n_faces or tried >= level.starts + STARTS_FOR_FACETS):
                    break
        if best is None:
            raise GeometryError("No start of the exact method bounds a polyhedron.")
        if not best.exact and request.asked[1]:
            rest = request.problem(target.rays, SAMPLE_ANGLE, sphericity=False)
            for begun in (planes, (best.normals, best.offsets)):
                for found in compromise(full, rest, begun, COMPROMISE_STEPS):
                    value = judge.of(found.values)
                    if value < min(history[-1:], default=np.inf):
                        best = found
                        history.append(value)
                        yield MethodStep(total, total, value, HalfSpaces(best.normals, best.offsets))
        planes_kept = real_planes(best)
        errors = relative_errors(target.descriptors, describe(polyhedron_of(planes_kept), LOSS_KEYS))
        reason = reason_for(target, request, n_faces, len(planes_kept), errors)
        counts = {"starts": float(tried), "exact": float(best.exact)}
        return MethodResult(planes_kept, tuple(history), reason, counts)


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
