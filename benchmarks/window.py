"""What the window takes: ``python -m benchmarks.window start`` (or moves, cycles and so on).

``start`` starts windows one after the other and prints when splash, views and bodies were seen.
``moves`` drags all sliders of the page *Explore*, ``cycles`` makes and draws polyhedra by the quick
method, ``samples`` opens drawn particles and then the shipped ones again; all three print the megabytes
at each look and their slope with its standard error. ``sliders`` times the way from a move to the painted
view, ``releases`` that from the end of a drag to the polyhedron, ``rest`` what an idle window takes.
``--views live`` needs a display.
"""

import argparse
import ctypes
import gc
import os
import random
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from statistics import median
from typing import Any

import psutil

from benchmarks.window_start import starts

PATIENCE = 120.0
"""Seconds after which something that should have happened is given up."""


@contextmanager
def opened(views: str, size: tuple[int, int] = (1920, 1080)) -> Iterator[Any]:
    """A window on the shipped sample with its first polyhedron, at rest; nobody's preferences are touched."""
    if views == "image" and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["REGOLITH_STUDIO_CONFIG"] = folder
        from regolith_studio.ui.startup import make_application

        make_application(["benchmark"])
        from regolith_studio.session.preferences import Preferences
        from regolith_studio.ui.startup import open_window

        window = open_window(views=views, preferences=Preferences())
        window.resize(*size)
        window.show()
        until(lambda: window.session.results.coarsened is not None)
        settle(window)
        try:
            yield window
        finally:
            window.session.close()
            window.deleteLater()


def spin(seconds: float = 0.0) -> None:
    """Let the event loop run for a while, at least once."""
    from PySide6.QtWidgets import QApplication

    end = time.monotonic() + seconds
    QApplication.processEvents()
    while (left := end - time.monotonic()) > 0:
        time.sleep(min(left, 0.002))
        QApplication.processEvents()


def until(true: Callable[[], bool], seconds: float = PATIENCE) -> None:
    """Let the event loop run until something is true.

    Raises
    ------
    TimeoutError
        If it does not become true.
    """
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            raise TimeoutError("waited in vain")
        spin(0.001)


def settle(window: Any) -> None:
    """Wait until the window computes nothing and has shown all that it knows."""
    from regolith_studio.ui.bindings import Bindings

    def rests() -> bool:
        return not window.session.tasks and all(each.idle for each in window.findChildren(Bindings))

    until(rests)
    spin()
    until(rests)


def resident() -> float:
    """Megabytes (1e6 bytes) of this process, when what can be given back has been given back."""
    for _ in range(2):
        gc.collect()
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).malloc_trim(0)
    return float(psutil.Process().memory_info().rss) / 1e6


DRAWN, LOOKED_AT = 60, 6
"""Particles of a sample that is opened, and those of them that are looked at."""
MOVES_IN_A_DRAG = 10
"""Slider moves between two rests; the dragged slider is one step of undo."""


@dataclass(frozen=True)
class Growth:
    """Memory of one process against the number of acts.

    Parameters
    ----------
    acts
        How many had been done when each sample was taken, after the warming up.
    megabytes
        Resident at each of them, with garbage collected and free memory returned.
    target
        Megabytes that are allowed, over how many acts.
    """

    title: str
    acts: tuple[int, ...]
    megabytes: tuple[float, ...]
    target: tuple[float, int]

    @property
    def slope(self) -> tuple[float, float]:
        """Megabytes over as many acts as the target names, and the standard error of that."""
        from scipy.stats import linregress  # not before the memory is measured

        line = linregress(self.acts, self.megabytes)
        return float(line.slope) * self.target[1], float(line.stderr) * self.target[1]

    def __str__(self) -> str:
        grown, error = self.slope
        limit, acts = self.target
        return (
            f"{self.title}: {self.acts[-1]:,} acts, {self.megabytes[0]:.1f} to {self.megabytes[-1]:.1f} MB; "
            f"{grown:+.2f} +- {error:.2f} MB in {acts:,} (target {limit:g})"
        )


def followed(
    title: str,
    act: Callable[[int], None],
    rest: Callable[[], None],
    count: int,
    target: tuple[float, int],
    samples: int = 40,
) -> Growth:
    """Act `count` times after a quarter of that for warming up, and look at the memory now and then."""
    warm = count // 4
    for number in range(warm):
        act(number)
    acts, held = [], []
    for sample in range(samples + 1):
        rest()
        acts.append(sample * count // samples)
        held.append(resident())
        if sample < samples:
            for number in range(acts[-1], (sample + 1) * count // samples):
                act(warm + number)
    return Growth(title, tuple(acts), tuple(held), target)


def slider_moves(window: Any, count: int) -> Growth:
    """All sliders of the page *Explore* are dragged, one after the other, to random places."""
    from PySide6.QtWidgets import QSlider

    chance = random.Random(0)
    sliders = [each for each in window.page.findChildren(QSlider) if each.isVisible() and each.isEnabled()]

    def act(number: int) -> None:
        slider = sliders[number // MOVES_IN_A_DRAG % len(sliders)]
        ending = number % MOVES_IN_A_DRAG == MOVES_IN_A_DRAG - 1
        slider.setSliderDown(not ending)
        slider.setValue(chance.randint(slider.minimum(), slider.maximum()))
        if ending:
            settle(window)
        else:
            spin(0.012)

    title = f"slider moves ({len(sliders)} sliders)"
    return followed(title, act, lambda: settle(window), count, (1.0, 1_000))


def coarsened_and_drawn(window: Any, count: int) -> Growth:
    """A face count is chosen, the polyhedron is made by the quick method, and its view is drawn."""
    session, three_views = window.session, window.page.three_views
    session.choose(method="quadric", level=2)
    settle(window)

    def shown() -> bool:
        done = session.results.coarsened
        return done is not None and any(each.polyhedron is done.polyhedron for each in three_views.shapes)

    def act(number: int) -> None:
        session.choose(n_facets=12 + number % 20)
        until(shown)

    return followed("coarsen and draw", act, lambda: settle(window), count, (20.0, 20_000))


def samples_opened(window: Any, count: int) -> Growth:
    """Drawn particles are opened, some are looked at, and the shipped sample is opened again."""
    from regolith_studio.ui.startup import IDLE

    page, session = window.go("model"), window.session
    session.choose(method="quadric", level=2)
    page.fit_model()
    until(lambda: page._fitted is not None)
    page.drawing.setValue(page.drawing.value() | {"n": DRAWN})
    page.draw()
    until(lambda: page._drawn is not None)
    shipped = len(session.particles)

    def act(number: int) -> None:
        page.adopt()
        until(lambda: len(session.particles) == DRAWN)
        for key in ("sample", "explore"):
            window.go(key)
            for place in range(number % LOOKED_AT, DRAWN, DRAWN // LOOKED_AT):
                session.select(session.particles[place].id)
                settle(window)
        session.open_sample()
        until(lambda: len(session.particles) == shipped)
        settle(window)

    def rest() -> None:
        settle(window)
        spin(IDLE / 1_000 + 0.5)  # then hidden pages have let go what is closed
        settle(window)

    return followed("samples opened", act, rest, count, (5.0, 1), samples=count)


MOVE = 0.016
"""Seconds between two moves of a mouse that is dragged."""
SECONDS = 4.0
"""Of one drag."""
STEPS = 20
"""Single moves whose way to the screen is timed."""
DEGREES = (6, 14, 9, 20, 10, 26, 12)
"""At which drags of l_max end."""
AT_REST = 10.0
"""Seconds without work."""


@dataclass(frozen=True)
class Response:
    """One slider, first moved step by step, then dragged.

    Parameters
    ----------
    delays
        Seconds from each single move until the view that it changes was painted.
    pauses
        Seconds between two painted changes during the drag, and before the first.
    """

    title: str
    delays: tuple[float, ...]
    pauses: tuple[float, ...]

    def __str__(self) -> str:
        rate = len(self.pauses) / sum(self.pauses)
        return (
            f"{self.title:<24} event to paint {1e3 * median(self.delays):4.0f} ms, at most "
            f"{1e3 * max(self.delays):4.0f}; dragged {rate:5.1f} a second, longest pause "
            f"{1e3 * max(self.pauses):4.0f} ms"
        )


def responses(window: Any) -> Iterator[Response]:
    """All sliders of the page *Explore* that change a view, each from the usual choices."""
    from PySide6.QtWidgets import QSlider

    views = window.page.three_views.views
    sliders = [each for each in window.page.findChildren(QSlider) if each.isVisible() and each.isEnabled()]
    for number, slider in enumerate(sliders):
        name = next((word for each in _upwards(slider) if (word := each.objectName())), str(number))
        usual = slider.value()
        with _painted(views["fit" if "l_max" in name else "polyhedron"]) as times:
            delays = [_delay(window, slider, times, place) for place in _places(slider, STEPS)]
            pauses = _drag(slider, times)
        slider.setValue(usual)
        settle(window)
        yield Response(name, tuple(delays), tuple(pauses))


def releases(window: Any) -> Iterator[str]:
    """Seconds from the end of a drag of l_max to its painted polyhedron, and frames of an annealing run."""
    from PySide6.QtWidgets import QSlider

    slider = window.page.findChild(QSlider, "l_max_slider")
    with _painted(window.page.three_views.views["polyhedron"]) as times:
        waits = [_after_release(window, slider, times, degree) for degree in DEGREES]
        each = ", ".join(f"{degree}: {wait:.2f}" for degree, wait in zip(DEGREES, waits, strict=True))
        yield f"polyhedron {median(waits):.2f} s after a drag of l_max, at most {max(waits):.2f} ({each})"
        times.clear()
        window.session.choose(method="annealing")
        until(lambda: window.session.results.coarsened is not None)
        until(lambda: not window.page.replay.playing)
        settle(window)
        yield f"annealing: {len(times)} frames in {times[-1] - times[0]:.1f} s"


def _after_release(window: Any, slider: Any, times: list[float], degree: int) -> float:
    settle(window)
    slider.setSliderDown(True)
    for place in range(slider.value(), degree, 1 if degree > slider.value() else -1):
        slider.setValue(place)
        spin(MOVE)
    slider.setValue(degree)
    slider.setSliderDown(False)
    began = time.perf_counter()
    until(lambda: window.session.results.coarsened is None)
    until(lambda: window.session.results.coarsened is not None)
    done = time.perf_counter()
    until(lambda: any(each >= done for each in times))
    return next(each for each in times if each >= done) - began


def rest(window: Any) -> str:
    """Processor time and memory of a window that nobody touches."""
    from PySide6.QtCore import QEventLoop, QTimer

    settle(window)
    spin(4.0)  # what waits for a rest has been done
    loop, began, clock = QEventLoop(), time.process_time(), time.perf_counter()
    QTimer.singleShot(round(1e3 * AT_REST), loop.quit)
    loop.exec()
    used, passed = time.process_time() - began, time.perf_counter() - clock
    process = psutil.Process()
    held = [process.memory_info().rss / 1e6, sum(c.memory_info().rss for c in process.children(True)) / 1e6]
    return f"{used:.3f} s of processor in {passed:.0f} s; {held[0]:.0f} MB, other processes {held[1]:.0f} MB"


@contextmanager
def _painted(view: Any) -> Iterator[list[float]]:
    """Times at which something new was on the screen."""
    times: list[float] = []
    fresh = [False]
    draw, swapped = view.draw, getattr(view._plotter, "frameSwapped", None)

    def drawn(fill: Callable[[Any], None]) -> None:
        draw(fill)
        fresh[0] = True

    def seen() -> None:
        if fresh[0]:
            fresh[0] = False
            times.append(time.perf_counter())

    render: Callable[[], None] | None = getattr(view, "_render", None)

    def rendered() -> None:
        if render is not None:
            render()
        seen()

    view.draw = drawn
    if swapped is not None:
        swapped.connect(seen)
    else:
        view._render = rendered
    try:
        yield times
    finally:
        del view.draw
        if swapped is not None:
            swapped.disconnect(seen)
        else:
            del view._render


def _delay(window: Any, slider: Any, times: list[float], place: int) -> float:
    settle(window)
    spin(0.05)
    times.clear()
    began = time.perf_counter()
    slider.setValue(place)
    until(lambda: bool(times))
    return times[0] - began


def _drag(slider: Any, times: list[float]) -> list[float]:
    """A hand that goes to and fro for some seconds."""
    low, high = slider.minimum(), slider.maximum()
    slider.setSliderDown(True)
    times.clear()
    began = now = time.perf_counter()
    while (now := time.perf_counter()) < began + SECONDS:
        share = abs((now - began) % 2.0 - 1.0)
        slider.setValue(round(low + share * (high - low)))
        spin(MOVE)
    slider.setSliderDown(False)
    seen = [began, *(each for each in times if each < now), now]
    return [after - before for before, after in pairwise(seen)]


def _places(slider: Any, count: int) -> list[int]:
    """Different places all over a slider, one after the other never the same."""
    low, high = slider.minimum(), slider.maximum()
    wanted = [low + round((high - low) * (number * 7 % count) / (count - 1)) for number in range(count)]
    return [
        place for place, before in zip(wanted, [slider.value(), *wanted], strict=False) if place != before
    ]


def _upwards(widget: Any) -> Iterator[Any]:
    while widget is not None:
        yield widget
        widget = widget.parentWidget()


GROWING = {"moves": slider_moves, "cycles": coarsened_and_drawn, "samples": samples_opened}
LISTING = {"sliders": responses, "releases": releases}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.window", description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["start", *GROWING, *LISTING, "rest"])
    parser.add_argument("--views", choices=["image", "live"], default="image")
    parser.add_argument("--count", type=int, help="of moves, cycles and samples (1000) or starts (5)")
    options = parser.parse_args()
    if options.what == "start":
        for line in starts(options.count or 5, options.views):
            print(line, flush=True)
        return
    with opened(options.views) as window:
        if options.what in LISTING:
            for line in LISTING[options.what](window):
                print(line, flush=True)
        elif options.what == "rest":
            print(rest(window))
        else:
            _grow(window, options.what, options.count or 1000)


def _grow(window: Any, what: str, count: int) -> None:
    growth = GROWING[what](window, count)
    print(growth)
    print(*(f"{n}: {mb:.1f}" for n, mb in zip(growth.acts, growth.megabytes, strict=True)))


if __name__ == "__main__":
    main()
