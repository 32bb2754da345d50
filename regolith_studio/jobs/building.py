"""Coarsens a sample and writes it as a dataset folder (section 2.5)."""

from collections.abc import Generator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from regolith_studio.dataset.build import ShapeClass, build_dataset, own_class
from regolith_studio.dataset.dataset import CoarseningRecord, Dataset, Provenance
from regolith_studio.dataset.folder import write_dataset
from regolith_studio.dataset.size_distribution import Weighting
from regolith_studio.dataset.size_spec import Sizing, parse_sizes
from regolith_studio.dataset.streaming import check_count
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import DEFAULT_FIT_OPTIONS, FitOptions
from regolith_studio.harmonics.sample_spectrum import sample_spectrum
from regolith_studio.jobs.coarsening import CoarsenedParticle, CoarseningOrder, coarsen_sample
from regolith_studio.jobs.events import Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.representing import (
    ChosenParticles,
    Population,
    RepresentativesOrder,
    choose,
    measure_population,
)


@dataclass(frozen=True)
class DatasetOptions:
    """What is written besides the shapes.

    Parameters
    ----------
    name
        Of the dataset; the folder's name if empty.
    preset
        Name of the preset that the weights came from, if they still are it.
    overwrite
        Whether a dataset that is there already may be replaced.
    workers
        Processes that coarsen at the same time, 0 for one a core; or an open executor.
    representatives
        How particles that stand for all are chosen; ``None`` lets every particle stand for itself.
    sizes
        Size distributions of the classes, as :mod:`regolith_studio.dataset.size_spec` writes them.
    """

    name: str = ""
    preset: str | None = None
    overwrite: bool = False
    workers: int | Executor = 1
    representatives: RepresentativesOrder | None = None
    sizes: str = "measured"


@dataclass(frozen=True)
class Built:
    """A dataset on disk, and what became of each particle."""

    folder: Path
    dataset: Dataset
    outcomes: tuple[CoarsenedParticle, ...]


def build_dataset_folder(
    particles: Sequence[Particle],
    order: CoarseningOrder,
    folder: Path,
    options: DatasetOptions,
    population: Population | None = None,
) -> Steps:
    """Coarsen the particles, or those that stand for all, and write a dataset; returns :class:`Built`.

    Parameters
    ----------
    population
        Descriptors of the particles, if they have been measured.

    Raises
    ------
    DatasetError
        If the folder holds a dataset that may not be replaced, or no particle could be coarsened.
    InputError
        If more representatives are asked for than there are particles, the sizes make no sense, or the
        dataset would be too large to be read again.
    """
    check_place(folder, options.overwrite)
    chosen_count = len(particles) if options.representatives is None else options.representatives.count
    check_count(chosen_count, order.max_facets)
    sizing = parse_sizes(options.sizes)
    if options.representatives is None:
        chosen, outcomes = None, (yield from coarsen_sample(particles, order, options.workers))
    else:
        if population is None:
            population = yield from measure_population(particles, options.workers)
        chosen, outcomes = yield from coarsen_chosen(particles, population, order, options)
    yield Started("Writing the dataset")
    name = options.name or folder.name
    dataset = dataset_of(particles, outcomes, order, name, options.preset, chosen, sizing)
    write_dataset(folder, dataset, overwrite=options.overwrite)
    yield Progress(1, 1, folder.name)
    return Built(folder, dataset, outcomes)


def coarsen_chosen(
    particles: Sequence[Particle], population: Population, order: CoarseningOrder, options: DatasetOptions
) -> Generator[Step, None, tuple[ChosenParticles, tuple[CoarsenedParticle, ...]]]:
    """Choose representatives and coarsen them; one that fails makes way, and the choice is made anew.

    Returns
    -------
    tuple
        The choice, and what became of its particles, in its order.

    Raises
    ------
    DatasetError
        If so many fail that too few particles are left.
    """
    wish = options.representatives or RepresentativesOrder()
    known: dict[int, CoarsenedParticle] = {}
    while True:
        chosen = choose(population, wish)
        fresh = [at for at in chosen.places if at not in known]
        wanted = [particles[at] for at in fresh]
        outcomes = yield from coarsen_sample(wanted, order, options.workers, fresh)
        known |= {one.index: one for one in outcomes}
        failed = {at for at in chosen.places if known[at].coarsened is None}
        if not failed:
            return chosen.measured(population), tuple(known[at] for at in chosen.places)
        if len(population.kept) - len(failed) < wish.count:
            first = known[min(failed)]
            raise DatasetError(f"Too few particles can be coarsened; {first.name}: {first.problem}")
        population = population.without(failed)


def check_place(folder: Path, overwrite: bool) -> None:
    """Refuse a folder that is not empty, before hours of work and not after them.

    Raises
    ------
    DatasetError
        If something stands there that may not be replaced.
    """
    if folder.is_file() or (folder.is_dir() and any(folder.iterdir()) and not overwrite):
        raise DatasetError(
            f"{folder} is there already; choose another folder or allow it to be overwritten (--overwrite)."
        )


def dataset_of(
    particles: Sequence[Particle],
    outcomes: Sequence[CoarsenedParticle],
    order: CoarseningOrder,
    name: str,
    preset: str | None = None,
    chosen: ChosenParticles | None = None,
    sizing: Sizing | None = None,
) -> Dataset:
    """The dataset of the particles that could be coarsened.

    Parameters
    ----------
    chosen
        What `outcomes` stand for, in their order; each for itself if not given.
    sizing
        From measured sizes to those that are written.

    Raises
    ------
    DatasetError
        If there is none.
    """
    good = [(particles[each.index], each.coarsened) for each in outcomes if each.coarsened]
    if not good:
        first = next((each.problem for each in outcomes), "there are no particles")
        raise DatasetError(f"No particle could be coarsened, so there is no dataset: {first}")
    told = provenance(outcomes, order, preset)
    weighting: Weighting = "number"
    classes: list[ShapeClass] = [own_class(particle) for particle, _ in good]
    if chosen is not None:
        weighting, classes = chosen.representatives.weighting, list(chosen.representatives.classes)
        step = (
            f"{len(classes)} representatives of {chosen.n_particles} particles by k-medoids on shape "
            f"descriptors, weighted by {weighting}."
        )
        steps = (told.processing_steps[0], step, *told.processing_steps[1:])
        told = replace(told, processing_steps=steps, representation=chosen.representation)
    if sizing is not None:
        classes = [replace(one, sizes=sizing(one)) for one in classes]
    return build_dataset(good, classes, name=name, weighting=weighting, provenance=told)


def provenance(
    outcomes: Sequence[CoarsenedParticle], order: CoarseningOrder, preset: str | None
) -> Provenance:
    """How the shapes came about, in the words of section 2.5."""
    return story(
        [each.coefficients for each in outcomes if each.coarsened and each.coefficients], order, preset
    )


def story(fitted: Sequence[ShCoefficients], order: CoarseningOrder, preset: str | None) -> Provenance:
    """As :func:`provenance`, from the coefficients of the particles that were fitted and coarsened."""
    fit = (f"Spherical-harmonics surface up to l = {order.l_max}{_unusual(order.fit_options)}.",)
    lengths = order.fit_options.reference == DEFAULT_FIT_OPTIONS.reference
    record = CoarseningRecord(
        method=order.method,
        n_facets=order.max_facets,
        seed=order.seed,
        target=order.target,
        preset=preset,
        weights=dict(order.weights),
        settings=dict(order.settings),
        largest_error=order.largest_error,
    )
    return Provenance(
        processing_steps=(
            "Meshes read and repaired.",
            *(fit if order.target == "fit" else ()),
            f"Coarsened to {order.fineness} by the method {order.method}.",
            "Turned to principal axes and scaled to unit volume.",
        ),
        seed=order.seed,
        l_max=order.l_max if fitted else None,
        angular_power_spectrum=(
            tuple(sample_spectrum(fitted).values) if len(fitted) > 1 and lengths else None
        ),
        coarsening=record,
    )


def _unusual(fit_options: FitOptions) -> str:
    """What was not done as usual, to be put into a sentence."""
    told = [
        f"{name.replace('_', ' ')} {value}"
        for name, value in asdict(fit_options).items()
        if value != getattr(DEFAULT_FIT_OPTIONS, name)
    ]
    return f" ({', '.join(told)})" if told else ""
