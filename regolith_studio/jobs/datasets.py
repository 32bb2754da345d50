"""Reads and checks dataset folders in the background."""

from pathlib import Path

from regolith_studio.dataset.folder import read_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.jobs.events import Started, Steps


def open_dataset_folder(folder: Path) -> Steps:
    """Returns the folder and its dataset."""
    yield Started("Reading the dataset")
    return folder, read_dataset(folder)


def validate_dataset_folder(folder: Path) -> Steps:
    """Returns the problems of the folder, one sentence each."""
    yield Started("Checking the dataset")
    return tuple(validate_dataset(folder))
