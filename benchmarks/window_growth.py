"""Whether a window that is used for long grows: megabytes against what has been done in it."""

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from benchmarks.window_driving import resident, settle, spin, until

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
    from regolith_studio.ui.app import IDLE

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
