"""The heap: the record of its angle for the card, and the plot of its sections."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, Signal
from PySide6.QtWidgets import QWidget

from regolith_studio.dem.angle_of_repose import PAPER_AZIMUTHS, ReposeMeasurement
from regolith_studio.dem.drum_angle import compare_angles
from regolith_studio.dem.evaluation.profile import Discs, Profile, project
from regolith_studio.dem.evaluation.section import NotAPileError, Section
from regolith_studio.dem.run_io import RunSummary
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import IntArray
from regolith_studio.messages import N_
from regolith_studio.studies.figures.repose import framed, framed_profile
from regolith_studio.ui.layout import STRETCH, hbox, vbox
from regolith_studio.ui.pages.repose.setup import CaseScale
from regolith_studio.ui.result_card import ResultRecord, ResultState
from regolith_studio.ui.translation import localized, tr, translate
from regolith_studio.ui.widgets.fields import choice
from regolith_studio.ui.widgets.labels import hint_label
from regolith_studio.ui.widgets.plots.base import Numbers, Plot
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

MILLIMETRE = 1e3
LEFT, RIGHT, BOTH = "#0072b2", "#e69f00", "#009e73"
"""Colours of left flank, right flank and symmetric model, as in the paper's figure."""
HOVER_DISTANCE = 12.0
"""Pixels from a surface point within which the tool tip describes it."""
MANY_DISCS = 5000
"""Of which more take longer to draw than to look at: 100,000 take two seconds a plot."""
LEFT_SIDE = N_("left flank: {z:.3g} mm, {angle:.1f}°")
RIGHT_SIDE = N_("right flank: {z:.3g} mm, {angle:.1f}°")


@dataclass(frozen=True, eq=False)
class HeapSection:
    """A vertical section of particles at rest.

    - ``pile``: the particles.
    - ``azimuth``: degrees from the x axis.
    - ``base``: level of the plate.
    - ``profile``, ``section``: the surface and what was fitted to it, where there is any.
    - ``half_width``: of the interval of the angle in degrees; 0 for none.
    """

    pile: ParticleState
    azimuth: float
    base: float = 0.0
    profile: Profile | None = None
    section: Section | None = None
    half_width: float = 0.0

    def frame(self) -> tuple[float, float]:
        """Half width and height of its picture in metres."""
        if self.section is not None:
            return framed(self.section)
        if self.profile is not None:
            return framed_profile(self.profile)
        flat = self.pile.points[:, :2] - np.median(self.pile.points[:, :2], axis=0)
        reach = np.quantile(np.abs(flat), 0.97) + self.pile.diameters.mean()
        return 1.15 * float(reach), 1.1 * float((self.pile.points[:, 2] - self.base).max())


class SectionPlot(Plot):
    """Projected particles, surface points used in the regression, and both models with their interval.

    ``cutDragged`` carries the cut (``low`` or ``high``) that the user has moved and its share of the height.
    """

    cutDragged = Signal(str, float)  # noqa: N815

    def __init__(self) -> None:
        self._heap: HeapSection | None = None
        self._items: list[pg.GraphicsObject] = []
        self._cuts: dict[str, pg.InfiniteLine] = {}
        self._discs: Discs | None = None
        super().__init__("x [mm]", "z [mm]", tr("Run a test or open positions to see its section."))
        self.canvas.getViewBox().setAspectLocked(True)
        self.canvas.getViewBox().sigResized.connect(lambda *_: self._frame())

    @property
    def section(self) -> Section | None:
        """The section, if anything was fitted."""
        return None if self._heap is None else self._heap.section

    def cut(self, name: str) -> pg.InfiniteLine:
        """The line of a cut, ``low`` or ``high``."""
        return self._cuts[name]

    def show_heap(self, heap: HeapSection) -> None:
        """Draw a section, with what was fitted."""
        self._heap = heap
        plane = {0.0: "x", 90.0: "y"}.get(heap.azimuth)
        self.set_labels(
            f"{plane} [mm]" if plane else tr("along {azimuth:g}° [mm]", azimuth=heap.azimuth), "z [mm]"
        )
        self.set_legend(_legend(heap.section))
        self.set_empty(False)
        self.redraw()

    def show_nothing(self, sentence: str) -> None:
        self._heap = self._discs = None
        self.set_empty(True, sentence)
        self.redraw()

    def value_at(self, place: QPointF) -> str:
        """The nearest surface point with both models, or the particle at a position."""
        if self._heap is None:
            return ""
        here = self.canvas.getViewBox().mapSceneToView(place)
        u, z = here.x() / MILLIMETRE, here.y() / MILLIMETRE
        reach = HOVER_DISTANCE / MILLIMETRE * self.canvas.getViewBox().viewPixelSize()[0]
        surface = "" if self.section is None else surface_text(self.section, u, z, reach)
        return surface or particle_text(self._discs, u, z)

    def numbers(self) -> Numbers:
        if self._heap is None or self._heap.profile is None:
            return (), []
        profile, section = self._heap.profile, self._heap.section
        used = np.zeros(len(profile.u), dtype=bool) if section is None else section.used
        rows = zip(MILLIMETRE * profile.u, MILLIMETRE * profile.height, used, strict=True)
        columns = (self._labels[0], tr("surface z [mm]"), tr("in the regression"))
        return columns, [(float(u), float(z), "yes" if taken else "no") for u, z, taken in rows if z == z]

    def redraw(self) -> None:
        for item in (*self._items, *self._cuts.values()):
            self.canvas.removeItem(item)
        self._items, self._cuts = [], {}
        if self._heap is None:
            return
        self._draw_particles(self._heap)
        if self._heap.section is not None:
            self._draw_band(self._heap.section, self._heap.half_width)
            self._draw_models(self._heap.section)
            self._draw_cuts(self._heap.section)
        self._frame()

    def _frame(self) -> None:
        """Show the heap as large as it can be, with the plate at the bottom and equal axes."""
        if self._heap is None:
            return
        box = self.canvas.getViewBox()
        width, height = max(1.0, box.width()), max(1.0, box.height())
        reach, top = self._heap.frame()
        pixel = MILLIMETRE * max(2 * reach / width, 1.04 * top / height)
        low = -0.02 * pixel * height
        half = pixel * width / 2
        box.setRange(xRange=(-half, half), yRange=(low, low + pixel * height), padding=0.0)

    def _draw_particles(self, heap: HeapSection) -> None:
        pile = heap.pile
        discs = self._discs = project(pile.points, pile.diameters, heap.base, np.radians(heap.azimuth))
        drawn = drawn_discs(discs)
        particles = pg.ScatterPlotItem(
            x=MILLIMETRE * discs.u[drawn],
            y=MILLIMETRE * discs.z[drawn],
            size=2 * MILLIMETRE * discs.radius[drawn],
            pxMode=False,
            pen=pg.mkPen(self.theme.border),
            brush=pg.mkBrush(self.theme.raised if self.theme.dark else "#dcdfe3"),
        )
        self._add(particles)
        if heap.profile is None:
            return
        seen = heap.profile.height > 0.0 if heap.section is None else heap.section.used
        surface = pg.ScatterPlotItem(
            x=MILLIMETRE * heap.profile.u[seen],
            y=MILLIMETRE * heap.profile.height[seen],
            size=5,
            pen=None,
            brush=pg.mkBrush(self.theme.text),
        )
        self._add(surface)

    def _draw_band(self, section: Section, half_width: float) -> None:
        """The flanks turned about their middle by the interval of the angle."""
        two, profile = section.asymmetric, section.profile
        for line, side, colour in (
            (two.left, profile.u < two.break_point, LEFT),
            (two.right, profile.u >= two.break_point, RIGHT),
        ):
            u = profile.u[side & section.used]
            ends = np.array([u.min(), u.max()])
            height = line.slope * u.mean() + line.intercept
            edges = []
            for turn in (-half_width, half_width):
                slope = np.sign(line.slope) * np.tan(np.radians(line.angle + turn))
                edges.append(
                    pg.PlotCurveItem(MILLIMETRE * ends, MILLIMETRE * (height + slope * (ends - u.mean())))
                )
            brush = pg.mkColor(colour)
            brush.setAlpha(70)
            self._add(pg.FillBetweenItem(*edges, brush=brush))

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


def _legend(section: Section | None) -> list[tuple[str, str]]:
    if section is None:
        return []
    two, one = section.asymmetric, section.symmetric
    return [
        (LEFT, tr("left {angle:.1f}°", angle=two.left.angle)),
        (RIGHT, tr("right {angle:.1f}°", angle=two.right.angle)),
        (BOTH, tr("symmetric {angle:.1f}°", angle=one.angle)),
    ]


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
    nearest = over[np.argmin(discs.radius[over])]
    size = 2 * MILLIMETRE * discs.radius[nearest]
    return tr(
        "particle {number}: {size:.3g} mm at {x:.3g}, {z:.3g} mm",
        number=nearest + 1,
        size=size,
        x=MILLIMETRE * u,
        z=MILLIMETRE * z,
    )


class HeapSections(QWidget):
    """One vertical section of the heap, chosen among all that were evaluated."""

    def __init__(self) -> None:
        super().__init__()
        self._sections: dict[float, HeapSection] = {}
        self.azimuth = choice("repose_azimuth", tr("Section"), ())
        self.plot = SectionPlot()
        self.course = CurvePlot(tr("Time [s]"), tr("Angle of the surface [°]"), "")
        self.course.hide()
        self._label = hint_label(tr("Section"))
        self._label.setWordWrap(False)
        row = hbox(self._label, self.azimuth, STRETCH, margins=(8, 6, 8, 0))
        vbox(row, (self.plot, 1), (self.course, 1), parent=self)
        self.azimuth.currentIndexChanged.connect(lambda *_: self._show_chosen())
        self.show_nothing()

    def show_heap(self, pile: ParticleState, measured: ReposeMeasurement | NotAPileError) -> None:
        """Show other sections, at the azimuth that is chosen."""
        self._sections = heap_sections(pile, measured)
        self.azimuth.offer({azimuth: _section_text(heap) for azimuth, heap in self._sections.items()})
        self._offer(True)
        self._show_chosen()

    def show_drum(self, measurement: Mapping[str, Any]) -> None:
        """Show how the surface of a drum rises and falls, if it has an angle."""
        if measurement["angle_deg"] is None:
            self.show_nothing()
            return
        times = tuple(measurement["times_s"])
        curves = [PlotCurve(tr("Surface"), self.course.theme.muted, times, tuple(measurement["angles_deg"]))]
        levels = {tr("Dynamic angle"): measurement["angle_deg"]}
        for name, label in (("upper", tr("Upper angle")), ("lower", tr("Lower angle"))):
            if measurement[name]:
                levels[label] = measurement[name]["mean_deg"]
        ends = (times[0], times[-1])
        for (label, level), colour in zip(levels.items(), (BOTH, RIGHT, LEFT), strict=False):
            curves.append(PlotCurve(label, colour, ends, (level, level)))
        self.course.set_curves(curves)
        self.plot.hide()
        self.course.show()

    def show_nothing(self) -> None:
        """Show what will be seen here; why it is not is on the card."""
        self._sections = {}
        self._offer(False)
        self.plot.show_nothing(tr("The section of a measured heap is shown here."))

    def _offer(self, visible: bool) -> None:
        self.course.hide()
        self.plot.show()
        self.azimuth.setVisible(visible)
        self._label.setVisible(visible)

    def _show_chosen(self) -> None:
        if heap := self._sections.get(self.azimuth.value()):
            self.plot.show_heap(heap)


def heap_sections(
    pile: ParticleState, measured: ReposeMeasurement | NotAPileError
) -> dict[float, HeapSection]:
    """What is known of each section, x-z and y-z first; of a heap without surface only its particles."""
    if isinstance(measured, ReposeMeasurement):
        half = (measured.interval[1] - measured.interval[0]) / 2
        return {
            each.azimuth: HeapSection(pile, each.azimuth, measured.base, each.profile, each, half)
            for each in measured.sections
        }
    azimuths = tuple(measured.profiles) or PAPER_AZIMUTHS
    return {
        azimuth: HeapSection(
            pile, azimuth, measured.base, measured.profiles.get(azimuth), measured.section_at(azimuth)
        )
        for azimuth in azimuths
    }


def _section_text(heap: HeapSection) -> str:
    plane = {0.0: "x-z", 90.0: "y-z"}.get(heap.azimuth, localized(f"{heap.azimuth:g}°"))
    if heap.section is None:
        return plane
    left, right = heap.section.flanks
    return f"{plane}:  {localized(f'{left:.1f}°')} | {localized(f'{right:.1f}°')}"


def heap_record(
    measured: ReposeMeasurement | NotAPileError, made_from: str, made_with: str, notes: Sequence[str] = ()
) -> ResultRecord:
    """The angle with its interval, or both angles of the flanks of a heap that has no single one.

    Parameters
    ----------
    notes
        On the run, shown with what is to be known of the angle.
    """
    if isinstance(measured, ReposeMeasurement):
        low, high = measured.interval
        interval = tr("{low:.1f}° to {high:.1f}°", low=low, high=high)
        values = (localized(f"{measured.angle:.1f}°"), interval)
        note = "\n".join((angle_text(measured), *notes))
        return ResultRecord(values, made_from, made_with, ResultState.CURRENT, note)
    values = ("–", "–")
    if measured.status in ("concave", "convex"):
        top, toe = np.mean([each.end_angles for each in measured.sections], axis=0)
        values = ("–", tr("{top:.0f}° | {toe:.0f}°", top=float(top), toe=float(toe)))
    note = tr("No angle of repose: {reason}", reason=translate(measured.sentence))
    return ResultRecord(values, made_from, made_with, ResultState.CURRENT, "\n".join((note, *notes)))


def drum_record(
    run: RunSummary, made_from: str, made_with: str, notes: Sequence[str], own: tuple[float, float] | None
) -> ResultRecord:
    """The dynamic angle with its interval, upper and lower angle, and the difference from one's own."""
    measured = run.document["measurement"]
    if measured["angle_deg"] is None:
        reason = translate(run.message(measured["reason"]))
        note = "\n".join((tr("No angle of repose: {reason}", reason=reason), *notes))
        return ResultRecord(("–", "–"), made_from, made_with, ResultState.CURRENT, note)
    low, high = measured["interval_deg"]
    sentences = []
    if own is not None:
        compared = compare_angles(measured["angle_deg"], (low, high), *own)
        sentences.append(
            tr(
                "Less the measured {angle:.1f}°: {difference:+.1f}° ({low:+.1f}° to {high:+.1f}°).",
                angle=own[0],
                difference=compared["difference_deg"],
                low=compared["interval_deg"][0],
                high=compared["interval_deg"][1],
            )
        )
    if measured["upper"]:
        for name, template in (
            ("upper", N_("{count} avalanches begin at {angle:.1f}° ({low:.1f}° to {high:.1f}°).")),
            ("lower", N_("They end at {angle:.1f}° ({low:.1f}° to {high:.1f}°).")),
        ):
            ends = measured[name]["interval_deg"]
            angle, count = measured[name]["mean_deg"], measured["n_avalanches"]
            sentences.append(tr(template, count=count, angle=angle, low=ends[0], high=ends[1]))
    sentences.append(tr("Froude number {froude:.2g}.", froude=measured["froude"]))
    sentences += [translate(run.message(each)) for each in measured["warnings"]]
    values = (localized(f"{measured['angle_deg']:.1f}°"), tr("{low:.1f}° to {high:.1f}°", low=low, high=high))
    note = "\n".join((" ".join(sentences), *notes))
    return ResultRecord(values, made_from, made_with, ResultState.CURRENT, note)


def interval_caption(measured: ReposeMeasurement | NotAPileError | None) -> str:
    if isinstance(measured, NotAPileError) and measured.status in ("concave", "convex"):
        return tr("Flanks: top | toe")
    share = measured.settings.confidence if isinstance(measured, ReposeMeasurement) else 0.95
    return tr("{share:.0%} interval", share=share)


def angle_text(measured: ReposeMeasurement) -> str:
    """What the angle of repose is the mean of, and what to know about it."""
    mean = tr(
        "Mean of {count} sections; x-z and y-z alone: {asymmetric:.1f}°, with one angle for both flanks "
        "{symmetric:.1f}°.",
        count=len(measured.sections),
        asymmetric=measured.paper_asymmetric.mean,
        symmetric=measured.paper_symmetric.mean,
    )
    return " ".join((mean, *map(translate, measured.warnings[:2])))


def run_origin(document: Mapping[str, Any]) -> tuple[str, str]:
    """Sample and method of a run, for its card."""
    case = document["case"]
    made_from = tr(
        "{count:,} particles of the dataset “{name}”",
        count=case["n_particles"],
        name=translate(str((document.get("dataset") or {}).get("name", ""))),
    )
    made_with = tr(
        "{engine}, static friction {friction:g}, seed {seed}",
        engine=document["engine"]["label"],
        friction=case["contact"]["static_friction"],
        seed=case["seed"],
    )
    if drum := case.get("drum"):
        made_with = ", ".join((tr("drum at {rpm:g} rpm", rpm=drum["rpm"]), made_with))
    return made_from, made_with


def run_notes(run: RunSummary) -> tuple[str, ...]:
    """What the engine and its certificate say of a run."""
    notes = (run.document.get("run") or {}).get("notes") or ()
    return tuple(translate(run.message(each)) for each in notes)


def scale_of_run(document: Mapping[str, Any]) -> CaseScale:
    """Numbers of a run that limit its answer."""
    particles = document.get("particles") or {}
    return CaseScale(
        document["case"]["n_particles"], particles.get("diameters_across"), particles.get("coarse_graining")
    )
