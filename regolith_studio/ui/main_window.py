"""The window: places panels, views and menus. Every other idea has a file of its own."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import cast

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QApplication,
    QMainWindow,
    QScrollArea,
    QSplitter,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.scene.cameras import DIRECTIONS
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui.actions import Actions
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.dialogs.help import about_dialog, shortcuts_dialog
from regolith_studio.ui.panels.coarsening import CoarseningPanel
from regolith_studio.ui.panels.descriptor_table import DescriptorTablePanel
from regolith_studio.ui.panels.error_bars import ErrorBarsPanel
from regolith_studio.ui.panels.fit import FitPanel
from regolith_studio.ui.panels.loss import LossPanel
from regolith_studio.ui.panels.loss_curve import LossCurvePanel
from regolith_studio.ui.panels.particle_list import ParticleListPanel
from regolith_studio.ui.panels.spectrum import SpectrumPanel
from regolith_studio.ui.panels.tasks import TasksPanel
from regolith_studio.ui.theme import apply_theme, current_theme
from regolith_studio.ui.views.triptych import Triptych
from regolith_studio.ui.widgets.toast import Toast
from regolith_studio.ui.wiring import Wiring


class MainWindow(QMainWindow):
    """Particles on the left, three views and plots in the middle, controls on the right.

    Parameters
    ----------
    session
        Shown and steered.
    preferences
        Recent files, units, and the layout of the window.
    views
        ``live`` or ``image``.
    """

    def __init__(self, session: Session, preferences: Preferences, views: str) -> None:
        super().__init__()
        self.setObjectName("main_window")
        self.setWindowTitle("Regolith Studio")
        self.setAcceptDrops(True)
        self.session, self.preferences = session, preferences
        self.particles, self.fit = ParticleListPanel(), FitPanel()
        self.coarsening, self.loss = CoarseningPanel(), LossPanel()
        self.triptych = Triptych(views)
        self.error_bars, self.table = ErrorBarsPanel(), DescriptorTablePanel()
        self.loss_curve, self.spectrum = LossCurvePanel(), SpectrumPanel()
        self.tasks = TasksPanel()
        self._panels = (
            *(self.particles, self.fit, self.coarsening, self.loss, self.tasks),
            *(self.error_bars, self.table, self.loss_curve, self.spectrum),
        )
        self._place()
        self.toast = Toast(self)
        self.commands = Commands(session, preferences, self.toast, self)
        self.menus = Actions(self, self._command_table(views))
        self.wiring = Wiring(session, self.toast.problem, self)
        self._wire()
        self._apply_theme()
        self.resize(1480, 900)

    def _place(self) -> None:
        controls = QWidget()
        column = QVBoxLayout(controls)
        column.setSpacing(18)
        column.setContentsMargins(4, 8, 10, 8)
        for panel in (self.fit, self.coarsening, self.loss):
            column.addWidget(panel)
        column.addStretch(1)
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(controls)
        scroll.setMinimumWidth(270)
        left = QWidget()
        inner = QVBoxLayout(left)
        inner.setContentsMargins(10, 8, 2, 8)
        inner.addWidget(self.particles)
        plots = _splitter(
            Qt.Orientation.Horizontal,
            [
                _tabs("plots_left", [(self.error_bars, "Errors"), (self.table, "Descriptors")]),
                _tabs("plots_right", [(self.loss_curve, "Loss"), (self.spectrum, "Spectrum")]),
            ],
            [1, 1],
        )
        middle = _splitter(Qt.Orientation.Vertical, [self.triptych, plots], [3, 2])
        middle.setContentsMargins(4, 8, 4, 8)
        self.setCentralWidget(_splitter(Qt.Orientation.Horizontal, [left, middle, scroll], [250, 900, 290]))
        self.statusBar().addWidget(self.tasks, 1)
        self.statusBar().setSizeGripEnabled(False)

    def _command_table(self, views: str) -> dict[str, Callable[..., object]]:
        ours = ("open", "open_folder", "open_sample", "export", "save_recipe", "undo", "redo")
        return {
            **{name: getattr(self.commands, name) for name in ours},
            **{f"look_{key}": partial(self.triptych.link.look_from, key) for key in DIRECTIONS},
            "quit": self.close,
            "link": self.triptych.link.set_linked,
            "reset": self.triptych.reset_cameras,
            "wireframe": self.triptych.set_wireframe,
            "heat": self.triptych.set_heat,
            "shortcuts": lambda: shortcuts_dialog(self, list(self.menus.by_name.values())).open(),
            "about": lambda: about_dialog(self, views).open(),
        }

    def _wire(self) -> None:
        session, wiring = self.session, self.wiring
        for panel in (self.particles, self.fit, self.coarsening, self.loss):
            wiring.edit(panel)
        wiring.refresh("particles", lambda: self.particles.set_entries(session.particles))
        wiring.refresh("particles choices", lambda: self.triptych.show_particle(session.selected))
        wiring.refresh("fit", lambda: self.fit.set_findings(session.results.fit))
        wiring.refresh(
            "surface", lambda: self.triptych.show_fit(session.results.surface, session.choices.l_max)
        )
        wiring.refresh("coarsening", self._show_coarsening)
        wiring.refresh(
            "descriptors coarsening choices",
            lambda: self.error_bars.show_results(session.results, session.choices),
        )
        wiring.refresh("descriptors coarsening", lambda: self.table.show_results(session.results))
        wiring.refresh("fit choices", lambda: self.spectrum.show_results(session.results, session.choices))
        wiring.refresh("tasks", lambda: self.tasks.setValue(session.tasks))
        wiring.refresh("tasks", self.commands.show_tasks)
        wiring.refresh("choices", self._show_undo)
        wiring.hear("failed", lambda failure: self.toast.problem(failure.sentence, failure.details))
        wiring.hear("problems", lambda problems: self.toast.note(problems[0], "\n".join(problems)))
        wiring.hear("exported", self.commands.tell_exported)
        self.tasks.cancelRequested.connect(self.commands.stop)
        self.menus.recent.aboutToShow.connect(self._list_recent)

    def _show_fit(self) -> None:
        self.triptych.show_fit(self.session.results.surface, self.session.choices.l_max)

    def _show_coarsening(self) -> None:
        results = self.session.results
        self.triptych.show_polyhedron(results)
        self.loss_curve.show_results(results)
        self.coarsening.set_outcome(results.coarsened.reason if results.coarsened else None)

    def _show_undo(self) -> None:
        self.menus.by_name["undo"].setEnabled(self.session.can_undo)
        self.menus.by_name["redo"].setEnabled(self.session.can_redo)

    def _list_recent(self) -> None:
        self.menus.recent.clear()
        for name in self.preferences.recent:
            self.menus.recent.addAction(name, partial(self.commands.open_paths, [Path(name)]))

    def _apply_theme(self) -> None:
        theme = current_theme()
        apply_theme(cast(QApplication, QApplication.instance()), theme)
        for part in (*self._panels, self.triptych, self.menus):
            if hasattr(part, "set_theme"):
                part.set_theme(theme)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        paths = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
        event.acceptProposedAction()
        QTimer.singleShot(0, self, lambda: self.commands.open_paths(paths))

    def closeEvent(self, event: QCloseEvent) -> None:
        self.hide()
        self.wiring.cut()
        self.session.close()
        self.triptych.release()
        event.accept()


def _tabs(name: str, pages: list[tuple[QWidget, str]]) -> QTabWidget:
    tabs = QTabWidget()
    tabs.setObjectName(name)
    tabs.setDocumentMode(False)
    for page, title in pages:
        tabs.addTab(page, title)
    return tabs


def _splitter(direction: Qt.Orientation, parts: list[QWidget], sizes: list[int]) -> QSplitter:
    splitter = QSplitter(direction)
    splitter.setChildrenCollapsible(False)
    splitter.setHandleWidth(6)
    for part in parts:
        splitter.addWidget(part)
    splitter.setSizes(sizes)
    return splitter
