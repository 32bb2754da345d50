"""Coarsens a sample and writes it as a dataset folder (section 2.5)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import CoarseningRecord, Dataset, Provenance
from regolith_studio.dataset.folder import write_dataset
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.sample_spectrum import sample_spectrum
from regolith_studio.jobs.coarsening import CoarsenedParticle, CoarseningOrder, coarsen_sample
from regolith_studio.jobs.events import Progress, Started, Steps


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
        Processes that coarsen at the same time; 0 for one a core.
    """

    name: str = ""
    preset: str | None = None
    overwrite: bool = False
    workers: int = 1


@dataclass(frozen=True)
class Built:
    """A dataset on disk, and what became of each particle."""

    folder: Path
    dataset: Dataset
    outcomes: tuple[CoarsenedParticle, ...]


def build_dataset_folder(
    particles: Sequence[Particle], order: CoarseningOrder, folder: Path, options: DatasetOptions
) -> Steps:
    """Coarsen every particle and write those that succeeded as a dataset; returns :class:`Built`.

    Raises
    ------
    DatasetError
        If the folder holds a dataset that may not be replaced, or no particle could be coarsened.
    """
    check_place(folder, options.overwrite)
    outcomes = yield from coarsen_sample(particles, order, options.workers)
    yield Started("Writing the dataset")
    dataset = dataset_of(particles, outcomes, order, options.name or folder.name, options.preset)
    write_dataset(folder, dataset, overwrite=options.overwrite)
    yield Progress(1, 1, folder.name)
    return Built(folder, dataset, outcomes)


def check_place(folder: Path, overwrite: bool) -> None:
    """Refuse a folder that is not empty, before hours of work and not after them.

    Raises
    ------
    DatasetError
        If something stands there that may not be replaced.
    """
    if folder.is_file() or (folder.is_dir() and any(folder.iterdir()) and not overwrite):
        raise DatasetError(f"{folder} is there already; choose another folder or allow it to be overwritten.")


def dataset_of(
    particles: Sequence[Particle],
    outcomes: Sequence[CoarsenedParticle],
    order: CoarseningOrder,
    name: str,
    preset: str | None = None,
) -> Dataset:
    """The dataset in which every particle that could be coarsened stands for itself.

    Raises
    ------
    DatasetError
        If there is none.
    """
    good = [(particles[each.index], each.coarsened) for each in outcomes if each.coarsened]
    if not good:
        first = next((each.problem for each in outcomes), "there are no particles")
        raise DatasetError(f"No particle could be coarsened, so there is no dataset: {first}")
    return build_dataset(good, name=name, provenance=provenance(outcomes, order, preset))


def provenance(
    outcomes: Sequence[CoarsenedParticle], order: CoarseningOrder, preset: str | None
) -> Provenance:
    """How the shapes came about, in the words of section 2.5."""
    return story(
        [each.coefficients for each in outcomes if each.coarsened and each.coefficients], order, preset
    )


def story(fitted: Sequence[ShCoefficients], order: CoarseningOrder, preset: str | None) -> Provenance:
    """As :func:`provenance`, from the coefficients of the particles that were fitted and coarsened."""
    fit = (f"Spherical-harmonics surface up to l = {order.l_max}.",) if order.target == "fit" else ()
    record = CoarseningRecord(
        method=order.method,
        n_faces=order.n_faces,
        seed=order.seed,
        target=order.target,
        preset=preset,
        weights=dict(order.weights),
        settings=dict(order.settings),
    )
    return Provenance(
        processing_steps=(
            "Meshes read and repaired.",
            *fit,
            f"Coarsened to {order.n_faces} faces by the method {order.method}.",
            "Turned to principal axes and scaled to unit volume.",
        ),
        seed=order.seed,
        l_max=order.l_max if fitted else None,
        angular_power_spectrum=tuple(sample_spectrum(fitted).values) if len(fitted) > 1 else None,
        coarsening=record,
    )
