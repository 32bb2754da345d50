"""The window: places panels, views and menus. Every other idea has a file of its own."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import cast

from PySide6.QtCore import QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QGuiApplication
from PySide6.QtWidgets import (
    QApplication,
    QMainWindow,
)

from regolith_studio.scene.cameras import DIRECTIONS
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui.actions import Actions
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.dialogs.help import about_dialog, shortcuts_dialog
from regolith_studio.ui.layout import CONTROLS_WIDTH, padded, scrolled_column, side_by_side, stacked
from regolith_studio.ui.panels.coarsening import CoarseningPanel
from regolith_studio.ui.panels.fit import FitPanel
from regolith_studio.ui.panels.loss import LossPanel
from regolith_studio.ui.panels.particle_list import ParticleListPanel
from regolith_studio.ui.panels.tasks import TasksPanel
from regolith_studio.ui.plot_area import PlotArea
from regolith_studio.ui.theme import THEMES, apply_theme, choose_theme, current_theme
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
        choose_theme(str(preferences.window.get("theme", "system")))
        self.particles, self.fit = ParticleListPanel(), FitPanel()
        self.coarsening, self.loss = CoarseningPanel(), LossPanel()
        self.triptych = Triptych(views)
        self.plots = PlotArea()
        self.tasks = TasksPanel()
        self._themed = (self.particles, self.coarsening, self.plots, self.tasks, self.triptych)
        self._place()
        self.toast = Toast(self)
        self.commands = Commands(session, preferences, self.toast, self)
        self.menus = Actions(self, self._command_table(views))
        self.wiring = Wiring(session, self.toast.problem, self)
        self._wire()
        self._apply_theme()
        self.resize(1480, 900)

    def _place(self) -> None:
        middle = stacked([self.triptych, self.plots], [520, 300], stretch=0)
        controls = scrolled_column([self.fit, self.coarsening, self.loss])
        parts = [padded(self.particles, 10, 10, 2, 8), padded(middle, 2, 10, 2, 8), controls]
        self.setCentralWidget(side_by_side(parts, [300, 900, CONTROLS_WIDTH], stretch=1))
        self.statusBar().addWidget(self.tasks, 1)
        self.statusBar().setSizeGripEnabled(False)

    def _command_table(self, views: str) -> dict[str, Callable[..., object]]:
        ours = ("open", "open_folder", "open_sample", "export", "save_recipe", "undo", "redo")
        return {
            **{name: getattr(self.commands, name) for name in ours},
            **{f"look_{key}": partial(self.triptych.link.look_from, key) for key in DIRECTIONS},
            **{f"theme_{name}": partial(self._choose_theme, name) for name in ("system", *THEMES)},
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
        wiring.refresh("fit", lambda: self.fit.set_findings(session.results.fit), slow=True)
        wiring.refresh("surface", self._show_fit)
        wiring.refresh("coarsening", self._show_coarsening)
        wiring.refresh("tasks", lambda: self.tasks.setValue(session.tasks), slow=True)
        wiring.refresh("tasks", self.commands.show_tasks, slow=True)
        wiring.hear("choices", self._show_undo)
        self._show_undo()
        wiring.hear("failed", lambda failure: self.toast.problem(failure.sentence, failure.details))
        wiring.hear("problems", lambda problems: self.toast.note(problems[0], "\n".join(problems)))
        wiring.hear("exported", self.commands.tell_exported)
        self.plots.wire(session, wiring, self.commands)
        self.tasks.cancelRequested.connect(self.commands.stop)
        QGuiApplication.styleHints().colorSchemeChanged.connect(self._apply_theme)
        self.menus.recent.aboutToShow.connect(self._list_recent)

    def _show_fit(self) -> None:
        self.triptych.show_fit(self.session.results.surface, self.session.choices.l_max)

    def _show_coarsening(self) -> None:
        results = self.session.results
        self.triptych.show_polyhedron(results)
        self.coarsening.set_outcome(results.coarsened.reason if results.coarsened else None)

    def _show_undo(self) -> None:
        self.menus.by_name["undo"].setEnabled(self.session.can_undo)
        self.menus.by_name["redo"].setEnabled(self.session.can_redo)

    def _list_recent(self) -> None:
        self.menus.recent.clear()
        for name in self.preferences.recent:
            self.menus.recent.addAction(name, partial(self.commands.open_paths, [Path(name)]))

    def _choose_theme(self, name: str) -> None:
        choose_theme(name)
        self.preferences.window = self.preferences.window | {"theme": name}
        self.preferences.save()
        self._apply_theme()

    def _apply_theme(self) -> None:
        theme = current_theme()
        apply_theme(cast(QApplication, QApplication.instance()), theme)
        self.menus.set_theme(theme)
        for part in self._themed:
            part.set_theme(theme)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        paths = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
        event.acceptProposedAction()
        QTimer.singleShot(0, self, lambda: self.commands.open_paths(paths))

    def closeEvent(self, event: QCloseEvent) -> None:
        QGuiApplication.styleHints().colorSchemeChanged.disconnect(self._apply_theme)
        self.hide()
        self.wiring.cut()
        self.session.close()
        self.triptych.release()
        event.accept()
