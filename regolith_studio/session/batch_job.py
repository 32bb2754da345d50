"""Run a recipe on local processes or a Dask cluster, as the window does in the background."""

import contextlib
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.errors import FileError
from regolith_studio.io.checkpoint import read_note
from regolith_studio.jobs.events import Partial, Started, Steps
from regolith_studio.jobs.executor import ExecutorSettings
from regolith_studio.messages import N_
from regolith_studio.session.recipe import Recipe


@dataclass(frozen=True)
class ExecutorReady:
    """Executor details, emitted once the workers are ready.

    ``workers``: jobs at the same time. ``dashboard``: address of a cluster's page; empty where there is
    none.
    """

    workers: int
    dashboard: str = ""


def run_recipe_job(
    recipe: Recipe, base: Path, folder: Path, settings: ExecutorSettings, resume: bool = False
) -> Steps:
    """Run a recipe with an executor of its own, which is closed at the end.

    The first partial result is :class:`ExecutorReady`.
    """
    from regolith_studio.session.run_recipe import run_recipe  # with all that a batch needs, figures included

    yield Started(
        N_("Connecting to the cluster") if settings.runner == "dask" else N_("Starting the workers")
    )
    with contextlib.closing(settings.open()) as executor:
        yield Partial(ExecutorReady(executor.workers, executor.dashboard))
        return (yield from run_recipe(recipe, base, folder, executor, resume))


def is_unfinished(folder: Path) -> bool:
    """Whether a run into `folder` was begun and has not ended."""
    from regolith_studio.io.atomic import JOURNAL
    from regolith_studio.session.run_recipe import CHECKPOINT, ENDED

    path = folder / JOURNAL / CHECKPOINT
    try:
        return path.exists() and read_note(path, ENDED) is None
    except FileError:  # damaged, or being written
        return True
