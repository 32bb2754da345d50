"""How soon a slider that is dragged is seen and its polyhedron follows, and what the window takes at rest."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from statistics import median
from typing import Any

from benchmarks.window_driving import settle, spin, until

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
    import psutil
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
    draw, canvas = view.draw, getattr(view, "_canvas", None)

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
    if canvas is not None:
        canvas.frameSwapped.connect(seen)
    else:
        view._render = rendered
    try:
        yield times
    finally:
        del view.draw
        if canvas is not None:
            canvas.frameSwapped.disconnect(seen)
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
