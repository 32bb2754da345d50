"""Reads, checks and lists dataset folders in the background."""

from collections.abc import Iterator
from pathlib import Path

from regolith_studio.dataset.folder import read_dataset
from regolith_studio.dataset.library import LibraryEntry, scan_library
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.jobs.events import Partial, Progress, Started, Steps


def open_dataset_folder(folder: Path) -> Steps:
    """Returns the folder and its dataset."""
    yield Started("Reading the dataset")
    return folder, read_dataset(folder)


def validate_dataset_folder(folder: Path) -> Steps:
    """Returns the problems of the folder, one sentence each."""
    yield Started("Checking the dataset")
    return tuple(validate_dataset(folder))


def list_library(root: Path, results: Path | None = None) -> Steps:
    """Datasets, exports and results below a folder; partial results are single ones, the result all.

    Parameters
    ----------
    results
        Where simulations are kept if not below `root`; those of its datasets are listed too.
    """
    yield Started("Looking for datasets")
    found: list[LibraryEntry] = []
    for entry in _entries(root, results):
        found.append(entry)
        yield Partial(entry)
        yield Progress(len(found), 0, entry.name)
    return tuple(found)


def _entries(root: Path, results: Path | None) -> Iterator[LibraryEntry]:
    seen, known = set(), set()
    for entry in scan_library(root):
        seen.add(entry.folder)
        known.add(entry.sha256)
        yield entry
    if results is None or not results.is_dir():
        return
    for entry in scan_library(results):
        if entry.kind == "result" and entry.sha256 in known - {""} and entry.folder not in seen:
            yield entry
