"""A section of the pile as in Fig. 9, with draggable limits of the regression."""

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, Signal

from regolith_studio.dem.evaluation.profile import Discs, project
from regolith_studio.dem.evaluation.section import Section
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import IntArray
from regolith_studio.messages import N_
from regolith_studio.studies.figures.repose import framed
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.plots.base import Numbers, Plot

MILLIMETRE = 1e3
LEFT, RIGHT, BOTH = "#0072b2", "#e69f00", "#009e73"
"""Colours of left flank, right flank and symmetric model, as in the paper's figure."""
HOVER_DISTANCE = 12.0
"""Pixels from a surface point within which the tool tip describes it."""
MANY_DISCS = 5000
"""Of which more take longer to draw than to look at: 100,000 take two seconds a plot."""
LEFT_SIDE = N_("left flank: {z:.3g} mm, {angle:.1f}°")
RIGHT_SIDE = N_("right flank: {z:.3g} mm, {angle:.1f}°")


class SectionPlot(Plot):
    """Projected particles, surface points used in the regression, and both models.

    ``cutDragged`` carries the cut (``low`` or ``high``) that the user has moved and its share of the height.
    """

    cutDragged = Signal(str, float)  # noqa: N815

    def __init__(self, axis: str) -> None:
        self._pile: ParticleState | None = None
        self._section: Section | None = None
        self._items: list[pg.GraphicsObject] = []
        self._cuts: dict[str, pg.InfiniteLine] = {}
        self._discs: Discs | None = None
        super().__init__(f"{axis} [mm]", "z [mm]", tr("Run a test or open positions to see its section."))
        self.canvas.setAspectLocked(True)

    @property
    def section(self) -> Section | None:
        """The section."""
        return self._section

    def cut(self, name: str) -> pg.InfiniteLine:
        """The line of a cut, ``low`` or ``high``."""
        return self._cuts[name]

    def show_section(self, pile: ParticleState, section: Section) -> None:
        """Draw a section of a pile."""
        self._pile, self._section = pile, section
        two, one = section.asymmetric, section.symmetric
        self.set_legend(
            [
                (LEFT, tr("left {angle:.1f}°", angle=two.left.angle)),
                (RIGHT, tr("right {angle:.1f}°", angle=two.right.angle)),
                (BOTH, tr("symmetric {angle:.1f}°", angle=one.angle)),
            ]
        )
        self.set_empty(False)
        self.redraw()

    def show_nothing(self, sentence: str) -> None:
        """Show why there is no section."""
        self._pile = self._section = self._discs = None
        self.set_empty(True, sentence)
        self.redraw()

    def value_at(self, place: QPointF) -> str:
        """The nearest surface point with both models, or the particle at a position."""
        if self._pile is None or self._section is None:
            return ""
        here = self.canvas.getViewBox().mapSceneToView(place)
        u, z = here.x() / MILLIMETRE, here.y() / MILLIMETRE
        reach = HOVER_DISTANCE / MILLIMETRE * self.canvas.getViewBox().viewPixelSize()[0]
        return surface_text(self._section, u, z, reach) or particle_text(self._discs, u, z)

    def numbers(self) -> Numbers:
        if self._section is None:
            return (), []
        profile, used = self._section.profile, self._section.used
        rows = zip(MILLIMETRE * profile.u, MILLIMETRE * profile.height, used, strict=True)
        columns = (self._labels[0], tr("surface z [mm]"), tr("in the regression"))
        return columns, [(float(u), float(z), "yes" if taken else "no") for u, z, taken in rows if z == z]

    def redraw(self) -> None:
        for item in (*self._items, *self._cuts.values()):
            self.canvas.removeItem(item)
        self._items, self._cuts = [], {}
        if self._pile is None or self._section is None:
            return
        self._draw_particles(self._pile, self._section)
        self._draw_models(self._section)
        self._draw_cuts(self._section)
        reach, top = framed(self._section)
        box = self.canvas.getViewBox()
        box.setRange(
            xRange=(-MILLIMETRE * reach, MILLIMETRE * reach), yRange=(0.0, MILLIMETRE * top), padding=0.02
        )

    def _draw_particles(self, pile: ParticleState, section: Section) -> None:
        discs = self._discs = project(pile.points, pile.diameters, 0.0, np.radians(section.azimuth))
        drawn = drawn_discs(discs)
        grains = pg.ScatterPlotItem(
            x=MILLIMETRE * discs.u[drawn],
            y=MILLIMETRE * discs.z[drawn],
            size=2 * MILLIMETRE * discs.radius[drawn],
            pxMode=False,
            pen=pg.mkPen(self.theme.border),
            brush=pg.mkBrush(self.theme.raised if self.theme.dark else "#dcdfe3"),
        )
        used, profile = section.used, section.profile
        surface = pg.ScatterPlotItem(
            x=MILLIMETRE * profile.u[used],
            y=MILLIMETRE * profile.height[used],
            size=5,
            pen=None,
            brush=pg.mkBrush(self.theme.text),
        )
        self._add(grains)
        self._add(surface)

    def _draw_models(self, section: Section) -> None:
        two, one = section.asymmetric, section.symmetric
        for line, colour in ((two.left, LEFT), (two.right, RIGHT)):
            u = np.array([two.apex[0], -line.intercept / line.slope])
            self._line(u, line.slope * u + line.intercept, colour, False)
        reach = one.apex[1] / one.slope
        u = np.array([one.apex[0] - reach, one.apex[0], one.apex[0] + reach])
        self._line(u, np.array([0.0, one.apex[1], 0.0]), BOTH, True)

    def _draw_cuts(self, section: Section) -> None:
        top = MILLIMETRE * section.profile.top
        for name, height in (("low", section.low), ("high", section.high)):
            cut = pg.InfiniteLine(
                MILLIMETRE * height,
                angle=0,
                movable=True,
                bounds=(0.02 * top, 0.98 * top),
                pen=self.pen(self.theme.muted, dash=True),
                hoverPen=self.pen(self.theme.accent, 2.0),
            )
            cut.sigPositionChangeFinished.connect(
                lambda line, name=name: self.cutDragged.emit(name, float(line.value()) / top)
            )
            self.canvas.addItem(cut, ignoreBounds=True)
            self._cuts[name] = cut

    def _line(self, u: np.ndarray, z: np.ndarray, colour: str, dash: bool) -> None:
        self._add(pg.PlotDataItem(MILLIMETRE * u, MILLIMETRE * z, pen=self.pen(colour, 2.0, dash)))

    def _add(self, item: pg.GraphicsObject) -> None:
        self.canvas.addItem(item)
        self._items.append(item)


def drawn_discs(discs: Discs) -> IntArray:
    """Indices of the discs that are drawn: of many, the highest in each square of a mean radius."""
    if len(discs.u) <= MANY_DISCS:
        return np.arange(len(discs.u))
    squares = np.floor(np.column_stack([discs.u, discs.z]) / discs.radius.mean()).astype(np.int64)
    from_top = np.argsort(-(discs.z + discs.radius), kind="stable")
    return np.sort(from_top[np.unique(squares[from_top], axis=0, return_index=True)[1]])


def surface_text(section: Section, u: float, z: float, reach: float) -> str:
    """Describe the surface point within `reach` (metres) of a position, and the models there."""
    profile = section.profile
    away = np.hypot(profile.u - u, profile.height - z)
    if not np.isfinite(away).any() or np.nanmin(away) > reach:
        return ""
    at = int(np.nanargmin(away))
    x, high = float(profile.u[at]), float(profile.height[at])
    two, one = section.asymmetric, section.symmetric
    side, flank = (LEFT_SIDE, two.left) if x < two.apex[0] else (RIGHT_SIDE, two.right)
    line = flank.slope * x + flank.intercept
    tent = one.apex[1] - one.slope * abs(x - one.apex[0])
    taken = tr("between the cuts") if section.used[at] else tr("not used: outside the cuts")
    return "\n".join(
        (
            tr(
                "surface at {x:.3g} mm: {z:.3g} mm ({taken})",
                x=MILLIMETRE * x,
                z=MILLIMETRE * high,
                taken=taken,
            ),
            tr(side, z=MILLIMETRE * line, angle=flank.angle),
            tr("symmetric model: {z:.3g} mm, {angle:.1f}°", z=MILLIMETRE * tent, angle=one.angle),
        )
    )


def particle_text(discs: Discs | None, u: float, z: float) -> str:
    """Describe the particle at a position, the smallest if there are several; empty elsewhere."""
    if discs is None:
        return ""
    over = np.flatnonzero(np.hypot(discs.u - u, discs.z - z) <= discs.radius)
    if not len(over):
        return ""
    grain = over[np.argmin(discs.radius[over])]
    size = 2 * MILLIMETRE * discs.radius[grain]
    return tr(
        "grain {number}: {size:.3g} mm at {x:.3g}, {z:.3g} mm",
        number=grain + 1,
        size=size,
        x=MILLIMETRE * u,
        z=MILLIMETRE * z,
    )
