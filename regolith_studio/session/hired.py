"""A recipe worked through by whoever is hired for it: what the window runs in the background."""

import contextlib
import json
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.jobs.chunked import JOURNAL
from regolith_studio.jobs.events import Partial, Started, Steps
from regolith_studio.jobs.executor import ExecutorSettings
from regolith_studio.session.recipe import Recipe


@dataclass(frozen=True)
class Hired:
    """Who works; told once they are there.

    Parameters
    ----------
    workers
        Jobs at the same time.
    dashboard
        Address of a cluster's page; empty where there is none.
    """

    workers: int
    dashboard: str = ""


def perform_hired(
    recipe: Recipe, base: Path, folder: Path, settings: ExecutorSettings, resume: bool = False
) -> Steps:
    """As :func:`~regolith_studio.session.performing.perform`, with an executor of its own, closed at the end.

    The first partial result is :class:`Hired`.
    """
    from regolith_studio.session.performing import perform  # with all that a batch needs, figures included

    yield Started("Looking for the cluster" if settings.runner == "dask" else "Starting the workers")
    with contextlib.closing(settings.open()) as executor:
        yield Partial(Hired(executor.workers, executor.dashboard))
        return (yield from perform(recipe, base, folder, executor, resume))


def is_unfinished(folder: Path) -> bool:
    """Whether a run into `folder` was begun and has not ended."""
    from regolith_studio.session.performing import JOURNAL_FOLDER

    try:
        lines = (folder / JOURNAL_FOLDER / JOURNAL).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return False
    return not any("ended" in _entry(line) for line in lines[1:])


def _entry(line: str) -> dict[str, object]:
    try:
        entry = json.loads(line)
    except ValueError:  # the last line of a process that died
        return {}
    return entry if isinstance(entry, dict) else {}
