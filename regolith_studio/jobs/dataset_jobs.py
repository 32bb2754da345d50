"""Jobs that choose representatives, and write, export, read, check and list dataset folders (section 2.5)."""

import math
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from itertools import count
from pathlib import Path

from regolith_studio.dataset.build import build_dataset, singleton_class
from regolith_studio.dataset.dataset import Dataset, Provenance
from regolith_studio.dataset.export import (
    Exporter,
    ExportOptions,
    ExportResult,
    check_compounds,
    check_loss_accepted,
    prepared_export,
)
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.folder_io import check_count, dataset_hash, read_dataset, write_dataset
from regolith_studio.dataset.parameters import RepresentativesSettings
from regolith_studio.dataset.representatives import (
    NEEDED,
    QualityCurve,
    QualityPoint,
    RepresentativeSelection,
    choose_representatives,
    curve_counts,
    polyhedra_errors,
    quality_steps,
    representation_of,
)
from regolith_studio.dataset.schema import CoarseningRecord, Representation
from regolith_studio.dataset.size_distributions import ShapeClass, SizeRule, Weighting, parse_sizes
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.descriptors.describe import Descriptors
from regolith_studio.errors import DatasetError, InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.coefficients import ShCoefficients, sample_spectrum
from regolith_studio.harmonics.fit_options import DEFAULT_FIT_OPTIONS, FitOptions
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest, coarsen_sample
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.particle_jobs import measure_sample
from regolith_studio.messages import N_, count_message
from regolith_studio.steps import as_events


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
    numbers = count(1)

    def events_of(point: QualityPoint) -> Iterator[Step]:
        yield Partial(point)
        message = count_message(N_("1 representative"), N_("{count} representatives"), point.count)
        yield Progress(next(numbers), len(counts), message)

    return (yield from as_events(steps, events_of))


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
) -> Steps:
    """Measure a sample, unless that is done, and its quality curve; returns :class:`RepresentativesSurvey`.

    Partial results are the points of the curve.
    """
    if population is None:
        population = yield from measure_population(particles)
    if len(population.kept) < 2:
        raise InputError("Representatives need at least two particles that can be described.")
    curve = yield from measure_quality(population, request)
    return RepresentativesSurvey(population, curve)


def choose_job(population: MeasuredPopulation, request: RepresentativesRequest) -> Steps:
    """As :func:`choose_particles`, for a runner."""
    yield from compile_first("representatives")
    yield Started(N_("Choosing representatives"))
    return choose_particles(population, request)


@dataclass(frozen=True)
class DatasetOptions:
    """What is written besides the shapes.

    - ``name``: of the dataset; the folder's name if empty.
    - ``preset``: name of the preset that the weights came from, if they still are it.
    - ``overwrite``: whether a dataset that is there already may be replaced.
    - ``workers``: processes that coarsen at the same time, 0 for one a core; or an open executor.
    - ``representatives``: how representatives are chosen; ``None`` if each particle represents itself.
    - ``sizes``: size distributions of the classes, as :mod:`regolith_studio.dataset.size_distributions`
      writes them.
    """

    name: str = ""
    preset: str | None = None
    overwrite: bool = False
    workers: int | Executor = 1
    representatives: RepresentativesRequest | None = None
    sizes: str = "measured"


@dataclass(frozen=True)
class DatasetBuildResult:
    """A dataset on disk, and what became of each particle."""

    folder: Path
    dataset: Dataset
    outcomes: tuple[CoarsenedParticle, ...]


def build_dataset_folder(
    particles: Sequence[Particle],
    request: CoarseningRequest,
    folder: Path,
    options: DatasetOptions,
    population: MeasuredPopulation | None = None,
) -> Steps:
    """Coarsen all particles or their representatives and write a dataset.

    Returns :class:`DatasetBuildResult`.

    ``population``: descriptors of the particles, if they have been measured.
    """
    check_place(folder, options.overwrite)
    chosen_count = len(particles) if options.representatives is None else options.representatives.count
    check_count(chosen_count, request.max_facets)
    sizing = parse_sizes(options.sizes)
    if options.representatives is None:
        chosen, outcomes = None, (yield from coarsen_sample(particles, request, options.workers))
    else:
        if population is None:
            population = yield from measure_population(particles, options.workers)
        chosen, outcomes = yield from coarsen_chosen(particles, population, request, options)
    yield Started(N_("Writing the dataset"))
    name = options.name or folder.name
    dataset = dataset_of(particles, outcomes, request, name, options.preset, chosen, sizing)
    write_dataset(folder, dataset, overwrite=options.overwrite)
    yield Progress(1, 1, folder.name)
    return DatasetBuildResult(folder, dataset, outcomes)


def coarsen_chosen(
    particles: Sequence[Particle],
    population: MeasuredPopulation,
    request: CoarseningRequest,
    options: DatasetOptions,
) -> Generator[Step, None, tuple[ChosenParticles, tuple[CoarsenedParticle, ...]]]:
    """Choose representatives and coarsen them; one that fails makes way, and the choice is made anew.

    Returns the choice, and what became of its particles, in its order.
    """
    wanted = options.representatives or RepresentativesRequest()
    known: dict[int, CoarsenedParticle] = {}
    while True:
        chosen = choose_particles(population, wanted)
        fresh = [at for at in chosen.places if at not in known]
        fresh_particles = [particles[at] for at in fresh]
        outcomes = yield from coarsen_sample(fresh_particles, request, options.workers, fresh)
        known |= {one.index: one for one in outcomes}
        failed = {at for at in chosen.places if known[at].coarsened is None}
        if not failed:
            return chosen.measured(population), tuple(known[at] for at in chosen.places)
        if len(population.kept) - len(failed) < wanted.count:
            first = known[min(failed)]
            raise DatasetError(f"Too few particles can be coarsened; {first.name}: {first.problem}")
        population = population.without(failed)


def check_place(folder: Path, overwrite: bool) -> None:
    """Refuse a folder that is not empty, before hours of work and not after them."""
    if folder.is_file() or (folder.is_dir() and any(folder.iterdir()) and not overwrite):
        raise DatasetError(
            f"{folder} is there already; choose another folder or allow it to be overwritten (--overwrite)."
        )


def dataset_of(
    particles: Sequence[Particle],
    outcomes: Sequence[CoarsenedParticle],
    request: CoarseningRequest,
    name: str,
    preset: str | None = None,
    chosen: ChosenParticles | None = None,
    sizing: SizeRule | None = None,
) -> Dataset:
    """The dataset of the particles that could be coarsened.

    ``chosen``: the representatives in the order of `outcomes`; by default each particle represents itself.
    ``sizing``: from measured sizes to those that are written.
    """
    good = [(particles[each.index], each.coarsened) for each in outcomes if each.coarsened]
    if not good:
        first = next((each.problem for each in outcomes), "there are no particles")
        raise DatasetError(f"No particle could be coarsened, so there is no dataset: {first}")
    fitted = [each.coefficients for each in outcomes if each.coarsened and each.coefficients]
    source = dataset_provenance(fitted, request, preset)
    weighting: Weighting = "number"
    classes: list[ShapeClass] = [singleton_class(particle) for particle, _ in good]
    if chosen is not None:
        weighting, classes = chosen.representatives.weighting, list(chosen.representatives.classes)
        step = (
            f"{len(classes)} representatives of {chosen.n_particles} particles by k-medoids on shape "
            f"descriptors, weighted by {weighting}."
        )
        steps = (source.processing_steps[0], step, *source.processing_steps[1:])
        source = replace(source, processing_steps=steps, representation=chosen.representation)
    if sizing is not None:
        classes = [replace(one, sizes=sizing(one)) for one in classes]
    dataset = build_dataset(good, classes, name=name, weighting=weighting, provenance=source)
    if (known := source.representation) is None:
        return dataset
    known = known.model_copy(update={"errors": polyhedra_errors(dataset, known)})
    return replace(dataset, provenance=replace(dataset.provenance, representation=known))


def dataset_provenance(
    fitted: Sequence[ShCoefficients], request: CoarseningRequest, preset: str | None
) -> Provenance:
    """How the shapes were made, from the coefficients of the particles that were fitted and coarsened."""
    fit = (f"Spherical-harmonics surface up to l = {request.l_max}{_changed_options(request.fit_options)}.",)
    lengths = request.fit_options.reference == DEFAULT_FIT_OPTIONS.reference
    record = CoarseningRecord(
        method=request.method,
        n_facets=request.max_facets,
        seed=request.seed,
        target=request.target,
        preset=preset,
        weights=dict(request.weights),
        settings=dict(request.settings),
        max_error=request.largest_error,
    )
    return Provenance(
        processing_steps=(
            "Meshes read and repaired.",
            *(fit if request.target == "fit" else ()),
            f"Coarsened to {request.stopping_criterion} by the method {request.method}.",
            "Turned to principal axes and scaled to unit volume.",
        ),
        seed=request.seed,
        l_max=request.l_max if fitted else None,
        angular_power_spectrum_um2=(
            tuple(sample_spectrum(fitted).values) if len(fitted) > 1 and lengths else None
        ),
        coarsening=record,
    )


def _changed_options(fit_options: FitOptions) -> str:
    """What was not done as usual, to be put into a sentence."""
    changed = [
        f"{name.replace('_', ' ')} {value}"
        for name, value in asdict(fit_options).items()
        if value != getattr(DEFAULT_FIT_OPTIONS, name)
    ]
    return f" ({', '.join(changed)})" if changed else ""


def export_dataset_folder(
    source: Path, keys: Sequence[str], target: Path, options: ExportOptions, accept_loss: bool = False
) -> Steps:
    """Export the dataset in `source` to ``target/<key>`` for each key; returns the exports.

    All formats are complete before the first takes its place, so that a stop leaves the earlier ones. ``all``
    leaves out those that cannot hold compounds if the dataset has any.
    """
    exporters = chosen_exporters(keys)
    yield Started(N_("Exporting"), len(exporters))
    for exporter in exporters:
        check_loss_accepted(exporter, accept_loss)
    dataset, digest = read_dataset(source), dataset_hash(source)
    if "all" in keys and dataset.compounds:
        exporters = tuple(each for each in exporters if not each.convex_only)
    check_compounds(dataset, exporters)
    with ExitStack() as stack:
        finishes: list[Callable[[], ExportResult]] = []
        for number, exporter in enumerate(exporters):
            yield Progress(number, len(exporters), exporter.label)
            prepared = prepared_export(
                *(dataset, exporter, target / exporter.key, options),
                dataset_hash=digest,
                accept_loss=accept_loss,
            )
            finishes.append(stack.enter_context(prepared))
        done = tuple(finish() for finish in finishes)
    for result in done:
        yield Partial(result)
    yield Progress(len(exporters), len(exporters), str(target))
    return done


def chosen_exporters(keys: Sequence[str]) -> tuple[Exporter, ...]:
    """The formats of these keys, each once; all of them for ``all``."""
    wanted = list(EXPORTERS) if "all" in keys else list(dict.fromkeys(keys))
    for key in wanted:
        if key not in EXPORTERS:
            raise InputError(f"There is no format {key!r}; there are {', '.join(sorted(EXPORTERS))}.")
    if not wanted:
        raise InputError("No format was chosen.")
    return tuple(EXPORTERS[key] for key in wanted)


def open_dataset_folder(folder: Path) -> Steps:
    """Returns the folder and its dataset."""
    yield Started(N_("Reading the dataset"))
    return folder, read_dataset(folder)


def validate_dataset_folder(folder: Path) -> Steps:
    """Returns the problems of the folder, one sentence each."""
    yield Started(N_("Checking the dataset"))
    return tuple(validate_dataset(folder))
