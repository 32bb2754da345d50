"""The heap of the page: the record of its angle for the card, and its sections."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QVBoxLayout, QWidget

from regolith_studio.dem.angle_of_repose import PAPER_AZIMUTHS, ReposeMeasurement
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.run_io import RunSummary
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.ui.pages.repose.limits import CaseScale
from regolith_studio.ui.pages.repose.section_plot import HeapSection, SectionPlot
from regolith_studio.ui.translation import localized, tr, translate
from regolith_studio.ui.widgets.labels import hint_label
from regolith_studio.ui.widgets.result_view import ResultRecord, ResultState


class HeapSections(QWidget):
    """One vertical section of the heap, chosen among all that were evaluated."""

    def __init__(self) -> None:
        super().__init__()
        self._sections: dict[float, HeapSection] = {}
        self.azimuth = QComboBox()
        self.azimuth.setObjectName("repose_azimuth")
        self.azimuth.setAccessibleName(tr("Section"))
        self.plot = SectionPlot()
        row = QHBoxLayout()
        row.setContentsMargins(8, 6, 8, 0)
        self._label = hint_label(tr("Section"))
        self._label.setWordWrap(False)
        row.addWidget(self._label)
        row.addWidget(self.azimuth)
        row.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addLayout(row)
        column.addWidget(self.plot, 1)
        self.azimuth.currentIndexChanged.connect(lambda *_: self._show_chosen())
        self.show_nothing(tr("Run a test or open positions to see its section."))

    def show_heap(self, pile: ParticleState, measured: ReposeMeasurement | NotAPileError) -> None:
        """Show other sections, at the azimuth that is chosen."""
        self._sections = heap_sections(pile, measured)
        chosen = self.azimuth.currentData()
        with QSignalBlocker(self.azimuth):
            self.azimuth.clear()
            for azimuth, heap in self._sections.items():
                self.azimuth.addItem(_section_text(heap), azimuth)
            self.azimuth.setCurrentIndex(max(0, self.azimuth.findData(chosen)))
        self._offer(True)
        self._show_chosen()

    def show_nothing(self, sentence: str) -> None:
        """Show why there is no section."""
        self._sections = {}
        self._offer(False)
        self.plot.show_nothing(sentence)

    def _offer(self, visible: bool) -> None:
        self.azimuth.setVisible(visible)
        self._label.setVisible(visible)

    def _show_chosen(self) -> None:
        if heap := self._sections.get(self.azimuth.currentData()):
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


def interval_caption(measured: ReposeMeasurement | NotAPileError | None) -> str:
    """Caption of the second figure of the card."""
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
