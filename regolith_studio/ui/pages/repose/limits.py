"""What limits the answer: particles across the cylinder, number of particles, coarse graining."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QWidget

from regolith_studio.dataset.parameters import PAPER_COARSE_GRAINING
from regolith_studio.dem.angle_of_repose import RELIABLE_N
from regolith_studio.messages import N_
from regolith_studio.ui.pages.repose.runs import duration_text
from regolith_studio.ui.pages.repose.setup import MAX_PARTICLES
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import number_text, tr
from regolith_studio.ui.widgets.labels import ElidedLabel

RELIABLE_ACROSS = 20.0
"""Particles across the cylinder from which walls and single particles do not matter."""
TOLERANCE = 2.0
"""Factor from the recommended value within which a value is doubtful, and beyond which it is bad."""
ROWS = (
    (N_("{value} across the cylinder (≥ {limit})"), ".1f", RELIABLE_ACROSS, False),
    (N_("{value} particles (≥ {limit})"), ",", float(RELIABLE_N), False),
    (
        N_("{value} × particle size (paper: {limit})"),
        ".0f",
        PAPER_COARSE_GRAINING,
        True,
    ),
)
"""Text, format of the value, recommended value, and whether that is a maximum."""


@dataclass(frozen=True)
class CaseScale:
    """Numbers of a case that limit its answer; `None` where they are not known, as of imported positions."""

    n_particles: int
    across: float | None = None
    coarse_graining: float | None = None

    def values(self) -> tuple[float | None, ...]:
        """In the order of :data:`ROWS`."""
        return self.across, self.n_particles, self.coarse_graining

    def sufficient_number(self, place: int) -> int:
        """Number of particles of the same mass, with two digits, at which a value is as recommended."""
        value = self.values()[place]
        assert value is not None, "a value that is not known is not shown"
        ratio = value / ROWS[place][2] if ROWS[place][3] else ROWS[place][2] / value
        number = self.n_particles * (ratio if place == 1 else ratio**3)
        step = 10.0 ** (math.floor(math.log10(number)) - 1)
        return int(step * math.ceil(round(number / step, 6)))


class LimitsStrip(QWidget):
    """Three values with their state, and a button where a larger number of particles would mend it."""

    runRequested = Signal(int)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("repose_limits")
        self._scale: CaseScale | None = None
        self._theme = current_theme()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        self.lights = tuple(QLabel("●") for _ in ROWS)
        self.texts = tuple(ElidedLabel() for _ in ROWS)
        self.buttons = tuple(QPushButton() for _ in ROWS)
        for place, (light, text, button) in enumerate(
            zip(self.lights, self.texts, self.buttons, strict=True)
        ):
            frame = QFrame()
            frame.setProperty("role", "card")
            inside = QHBoxLayout(frame)
            inside.setContentsMargins(8, 3, 6, 3)
            inside.addWidget(light)
            inside.addWidget(text, 1)
            inside.addWidget(button)
            button.setObjectName(f"repose_limit_{place}")
            button.clicked.connect(lambda _=False, place=place: self._ask(place))
            row.addWidget(frame, 1)
        self.show_scale(None)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        self._colour()

    def show_scale(self, scale: CaseScale | None, seconds: Callable[[int], float] | None = None) -> None:
        """Show the values of a case.

        ``seconds``: estimated time of a run with a number of particles; without it there are no buttons.
        """
        self._scale = scale
        values = (None,) * len(ROWS) if scale is None else scale.values()
        for place, (value, (text, form, limit, _)) in enumerate(zip(values, ROWS, strict=True)):
            limits = number_text(limit, ",.0f")
            self.texts[place].setText(
                "–" if value is None else tr(text, value=number_text(value, form), limit=limits)
            )
            self._offer(place, seconds if value is not None and self._level(place) else None)
        self._colour()

    def _offer(self, place: int, seconds: Callable[[int], float] | None) -> None:
        button = self.buttons[place]
        button.setVisible(seconds is not None)
        if seconds is None or self._scale is None:
            return
        number = self._scale.sufficient_number(place)
        possible = number <= MAX_PARTICLES
        button.setEnabled(possible)
        count = number_text(number, ",")
        if possible:
            button.setText(tr("Run with {count}: {time}", count=count, time=duration_text(seconds(number))))
            button.setToolTip(
                tr("A run with {count} particles, with all other values as in the set-up", count=count)
            )
        else:
            button.setText(tr("{count} needed", count=count))
            button.setToolTip(
                tr("More than can be simulated here: take a smaller mass, or larger particles.")
            )

    def _level(self, place: int) -> int:
        """0 where a value is as recommended, 1 if it is doubtful, 2 if it is bad."""
        value = None if self._scale is None else self._scale.values()[place]
        if value is None:
            return 0
        _, _, limit, is_maximum = ROWS[place]
        ratio = value / limit if is_maximum else limit / value
        return int(ratio > 1.0) + int(ratio > TOLERANCE)

    def _colour(self) -> None:
        colours = (self._theme.good, self._theme.doubtful, self._theme.bad)
        names = (tr("as recommended"), tr("doubtful"), tr("far from what is recommended"))
        known = (None,) * len(ROWS) if self._scale is None else self._scale.values()
        for place, light in enumerate(self.lights):
            level = self._level(place)
            colour = self._theme.border if known[place] is None else colours[level]
            light.setText(f'<span style="color:{colour}">●</span>')
            light.setAccessibleName("" if known[place] is None else names[level])
            light.setToolTip(light.accessibleName())

    def _ask(self, place: int) -> None:
        if self._scale is not None:
            self.runRequested.emit(self._scale.sufficient_number(place))
