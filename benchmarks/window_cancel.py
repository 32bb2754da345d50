"""How soon the window is at rest again when work is stopped."""

import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

from benchmarks.window_driving import settle, spin, until
from benchmarks.window_heartbeat import Heartbeat

BEFORE, AFTER = 1.0, 0.5
"""Seconds of work before it is stopped, and of watching afterwards."""
Start = Callable[[Any, Path], object]


@dataclass(frozen=True)
class Stop:
    """What followed when one kind of work was stopped.

    Parameters
    ----------
    gap
        Longest time without a beat, in seconds, from the request to :data:`AFTER` later, or until the
        list was empty if that took longer.
    listed
        Seconds from the request until the list of tasks was empty.
    place
        What the thread of the window did in the gap, where it was long.
    missed
        The work had ended before it could be stopped.
    """

    title: str
    gap: float
    listed: float
    place: str = ""
    missed: bool = False

    def __str__(self) -> str:
        if self.missed:
            return f"{self.title:<34} had ended before"
        times = f"gap {1e3 * self.gap:5.0f} ms   gone after {1e3 * self.listed:6.0f} ms"
        return f"{self.title:<34} {times}   {self.place}"


def stops(window: Any) -> Iterator[Stop]:
    """Start each kind of work, stop it after a second, and watch."""
    with Heartbeat() as heart, tempfile.TemporaryDirectory() as folder:
        for title, (prepare, start) in works().items():
            prepare(window)
            settle(window)
            with _usual_choices(window):
                start(window, Path(folder) / title.replace(" ", "-"))
                spin(BEFORE)
                yield _stopped(window, heart, title)
                settle(window)


def works() -> Mapping[str, tuple[Callable[[Any], object], Start]]:
    """What can be stopped: what must be there before, and how it is begun."""
    return {
        "study of l_max": (_nothing, lambda window, _: window.session.start_study("lmax_study")),
        "study of losses": (_nothing, lambda window, _: window.session.start_study("coarsening_study")),
        "study of faces": (_nothing, lambda window, _: window.go("studies").sweeps.start("faces")),
        "gallery of polyhedra": (_nothing, lambda window, _: window.go("studies").draw_gallery()),
        "annealing, 1,000,000 iterations": (_nothing, _anneal),
        "dataset of the sample": (_nothing, lambda window, to: window.session.export_dataset(to)),
        "batch, one worker": (_nothing, lambda window, to: _batch(window, to, 1)),
        "batch, two workers": (_nothing, lambda window, to: _batch(window, to, 2)),
        "drawing 100,000 particles": (_fit, lambda window, _: _draw(window)),
        "finding grains": (_open_scan, lambda window, _: window.go("scan").find_grains()),
        "making particles of grains": (_find_grains, lambda window, _: window.go("scan").make_particles()),
        "judging all models": (_adopt, _judge),
    }


def _stopped(window: Any, heart: Heartbeat, title: str) -> Stop:
    tasks = window.session.tasks
    if not tasks:
        return Stop(title, 0.0, 0.0, missed=True)
    heart.restart()
    began = perf_counter()
    for task in tasks:
        window.commands.stop(task.id)
    until(lambda: not window.session.tasks)
    listed = perf_counter() - began
    spin(max(0.0, AFTER - listed))
    gap = heart.longest
    return Stop(title, gap.seconds, listed, next(iter(gap.places), ""))


@contextmanager
def _usual_choices(window: Any) -> Iterator[None]:
    """Bring the choices back afterwards."""
    before = window.session.choices
    try:
        yield
    finally:
        names = ("method", "settings", "n_facets", "seed", "level")
        window.session.choose(**{name: getattr(before, name) for name in names})


def _nothing(_window: Any) -> None:
    """Everything is there."""


def _anneal(window: Any, _folder: Path) -> None:
    window.go("explore")
    window.session.choose(method="annealing", settings=(("iterations", 1_000_000),))


def _batch(window: Any, folder: Path, workers: int) -> None:
    from regolith_studio.jobs.events import Job
    from regolith_studio.jobs.executor import ExecutorSettings
    from regolith_studio.session.batch_job import run_recipe_job
    from regolith_studio.session.project import SessionRecipe

    recipe = SessionRecipe.of(window.session.particles, window.session.choices).recipe
    job = Job(run_recipe_job, (recipe, folder.parent, folder, ExecutorSettings(workers=workers), False))
    window.session.run("batch", "Batch", job, lambda _done: None)


def _fit(window: Any) -> None:
    page = window.go("model")
    page.fit_model()
    until(lambda: page._fitted is not None)


def _adopt(window: Any) -> None:
    """Thirty drawn particles: judging needs more than the sample has."""
    page = window.go("model")
    page.drawing.setValue(page.drawing.value() | {"n": 30})
    page.draw()
    settle(window)
    page.adopt()
    until(lambda: len(window.session.particles) > 20)
    settle(window)
    page._fitted = None
    _fit(window)


def _draw(window: Any) -> None:
    page = window.go("model")
    page.drawing.setValue(page.drawing.value() | {"n": 100_000})
    page.draw()


def _judge(window: Any, _folder: Path) -> None:
    page = window.go("model")
    page.evaluation.setValue({"all_models": True, "splits": 5, "repeats": 5})
    page.judge()


def _open_scan(window: Any) -> None:
    page = window.go("scan")
    page.opening.open_sample()
    until(lambda: page.scan is not None)


def _find_grains(window: Any) -> None:
    page = window.go("scan")
    page.find_grains()
    until(lambda: page.grains is not None)
