"""Representatives of a sample: descriptors of all particles, then one or many choices."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from regolith_studio.dataset.quality import QualityCurve, curve_counts, quality_steps, representation_of
from regolith_studio.dataset.representatives import (
    NEEDED,
    RepresentativeSelection,
    choose_representatives,
)
from regolith_studio.dataset.schema import Representation
from regolith_studio.dataset.settings import RepresentativesSettings
from regolith_studio.descriptors.describe import Descriptors
from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Partial, Progress, Started, Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.particle_jobs import measure_sample
from regolith_studio.messages import N_, count_message


@dataclass(frozen=True)
class RepresentativesRequest(RepresentativesSettings):
    """What is asked of a choice; ``seed``: only for populations too large for a table of distances."""

    seed: int = 0


@dataclass(frozen=True)
class MeasuredPopulation:
    """The particles of a sample that can be described.

    - ``kept``: their places in the sample.
    - ``descriptors``: of each of them.
    - ``omitted``: name of each other particle, and why it has no descriptors.
    """

    kept: tuple[int, ...]
    descriptors: tuple[Descriptors, ...]
    omitted: tuple[tuple[str, str], ...] = ()

    def without(self, places: set[int]) -> "MeasuredPopulation":
        """The population without the particles at these places of the sample."""
        pairs = [pair for pair in zip(self.kept, self.descriptors, strict=True) if pair[0] not in places]
        return MeasuredPopulation(tuple(at for at, _ in pairs), tuple(one for _, one in pairs), self.omitted)


@dataclass(frozen=True)
class RepresentativesSurvey:
    """A measured population with the errors of its representatives over their number."""

    population: MeasuredPopulation
    curve: QualityCurve

    def chosen(self, count: int) -> "ChosenParticles | None":
        """The choice of this number, if the curve has made it."""
        for point, choice in zip(self.curve.points, self.curve.choices, strict=True):
            if point.count == count:
                return ChosenParticles.of(self.population, choice)
        return None


@dataclass(frozen=True)
class ChosenParticles:
    """Representatives of a population, with their places in the sample."""

    places: tuple[int, ...]
    representatives: RepresentativeSelection
    n_particles: int
    representation: Representation | None = None

    @classmethod
    def of(cls, population: MeasuredPopulation, selection: RepresentativeSelection) -> "ChosenParticles":
        """With the places of the population's particles in the sample."""
        places = tuple(population.kept[index] for index in selection.chosen)
        return cls(places, selection, len(population.kept))

    def measured(self, population: MeasuredPopulation) -> "ChosenParticles":
        """With the quality of the representation of their population."""
        return replace(self, representation=representation_of(population.descriptors, self.representatives))


def measure_population(particles: Sequence[Particle], workers: int | Executor = 1) -> Steps:
    """Descriptors of every particle; returns :class:`MeasuredPopulation`."""
    examined = yield from measure_sample(particles, workers=workers)
    kept: list[tuple[int, Descriptors]] = []
    omitted = []
    for at, (particle, one) in enumerate(zip(particles, examined, strict=True)):
        problem = one.problem if one.descriptors is None else _problem_of(one.descriptors)
        if one.descriptors is None or problem:
            omitted.append((particle.name, problem))
        else:
            kept.append((at, one.descriptors))
    if not kept:
        raise InputError("No particle can be described, so no representatives can be chosen.")
    return MeasuredPopulation(
        tuple(at for at, _ in kept), tuple(descriptors for _, descriptors in kept), tuple(omitted)
    )


def _problem_of(descriptors: Descriptors) -> str:
    """Why a choice cannot look at these descriptors, or nothing."""
    for key in NEEDED:
        if not (math.isfinite(descriptors[key]) and descriptors[key] > 0.0):
            return f"Its {key} is {descriptors[key]:g}, which is no measure."
    return ""


def measure_quality(population: MeasuredPopulation, request: RepresentativesRequest) -> Steps:
    """Errors over the number of representatives; partial results are points, returns ``QualityCurve``."""
    yield from compile_first("representatives")
    counts = curve_counts(len(population.kept), request.count)
    yield Started(N_("Choosing representatives"), len(counts))
    steps = quality_steps(
        population.descriptors,
        counts,
        weighting=request.weighting,
        size_importance=request.size_importance,
        seed=request.seed,
    )
    done = 0
    while True:
        try:
            point = next(steps)
        except StopIteration as end:
            curve: QualityCurve = end.value
            return curve
        done += 1
        yield Partial(point)
        progress = count_message(N_("1 representative"), N_("{count} representatives"), point.count)
        yield Progress(done, len(counts), progress)


def choose_particles(population: MeasuredPopulation, request: RepresentativesRequest) -> ChosenParticles:
    """The representatives of a population."""
    selection = choose_representatives(
        population.descriptors,
        request.count,
        weighting=request.weighting,
        size_importance=request.size_importance,
        seed=request.seed,
    )
    return ChosenParticles.of(population, selection)


def survey_representatives(
    particles: Sequence[Particle],
    request: RepresentativesRequest,
    population: MeasuredPopulation | None = None,
    workers: int | Executor = 1,
) -> Steps:
    """Measure a sample, unless that is done, and its quality curve; returns :class:`RepresentativesSurvey`.

    Partial results are the points of the curve.
    """
    if population is None:
        population = yield from measure_population(particles, workers)
    if len(population.kept) < 2:
        raise InputError("Representatives need at least two particles that can be described.")
    curve = yield from measure_quality(population, request)
    return RepresentativesSurvey(population, curve)


def choose_job(population: MeasuredPopulation, request: RepresentativesRequest) -> Steps:
    """As :func:`choose_particles`, for a runner."""
    yield from compile_first("representatives")
    yield Started(N_("Choosing representatives"))
    return choose_particles(population, request)
