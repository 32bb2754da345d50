"""What runs and what was said: a dock below the pages, shown when it is asked for."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow

from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.layout import tabs
from regolith_studio.ui.panels.log import LogPanel
from regolith_studio.ui.panels.task_list import TaskListPanel
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.toast import Toast


class ActivityDock(QDockWidget):
    """Two tabs: tasks and log."""

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(tr("Activity"), window)
        self.setObjectName("activity")
        self.tasks, self.log = TaskListPanel(), LogPanel()
        self.tabs = tabs("activity_tabs", [(self.tasks, tr("Tasks")), (self.log, tr("Log"))])
        self.setWidget(self.tabs)
        self.setAllowedAreas(Qt.DockWidgetArea.BottomDockWidgetArea)
        window.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, self)
        self.hide()

    def wire(self, session: Session, bindings: Bindings, toast: Toast) -> None:
        """Follow the session and what the toast says, from now on."""
        bindings.refresh("tasks", lambda: self.tasks.show_tasks(session.tasks), slow=True)
        bindings.listen("exported", self._note_export)
        self.tasks.cancelRequested.connect(session.cancel)
        self.tasks.pauseRequested.connect(session.pause)
        toast.shown.connect(self.log.add)

    def _note_export(self, folder: object) -> None:
        self.log.add("note", tr("A dataset was written to {folder}.", folder=folder))

    def show_tab(self, name: str) -> None:
        """Show ``tasks`` or ``log``; hide the dock if that is seen already."""
        panel = self.tasks if name == "tasks" else self.log
        seen = self.isVisible() and self.tabs.currentWidget() is panel
        self.setVisible(not seen)
        self.tabs.setCurrentWidget(panel)
