"""Coarsens a sample and writes it as a dataset folder."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.coarsening import CoarseningOrder
from regolith_studio.jobs.events import Started, Steps


@dataclass(frozen=True)
class DatasetOptions:
    """What is written besides the shapes.

    Parameters
    ----------
    name
        Of the dataset; the folder's name if empty.
    overwrite
        Whether a dataset that is there already may be replaced.
    workers
        Processes that coarsen at the same time; 0 for one a core.
    """

    name: str = ""
    overwrite: bool = False
    workers: int = 1


def build_dataset_folder(
    particles: Sequence[Particle], order: CoarseningOrder, folder: Path, options: DatasetOptions
) -> Steps:
    """Coarsen every particle and write the dataset; returns the path of the folder."""
    raise NotImplementedError
    yield Started("Building the dataset")
