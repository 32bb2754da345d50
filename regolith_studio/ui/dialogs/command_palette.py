"""The command palette: finds a command by some letters of its name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QDialog, QLineEdit, QListWidget, QVBoxLayout, QWidget

from regolith_studio.ui.translation import tr

SHOWN = 14


@dataclass(frozen=True)
class Command:
    """A command: its menu, name and shortcut."""

    place: str
    text: str
    keys: str
    run: Callable[[], object]

    @property
    def title(self) -> str:
        """As it is listed."""
        return f"{self.place}: {self.text}" if self.place else self.text


def matches(commands: Sequence[Command], typed: str) -> list[Command]:
    """Commands that have every typed word, those that begin with it first."""
    words = typed.lower().split()
    found = [each for each in commands if all(word in each.title.lower() for word in words)]
    first = words[0] if words else ""
    return sorted(found, key=lambda each: not each.text.lower().startswith(first))


class CommandPalette(QDialog):
    """A text field and the commands that match it; Enter runs the selected one."""

    def __init__(self, commands: Sequence[Command], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Commands"))
        self.setObjectName("command_palette")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(560, 420)
        self._commands = tuple(commands)
        self.line = QLineEdit()
        self.line.setObjectName("command_line")
        self.line.setAccessibleName(tr("Command"))
        self.line.setPlaceholderText(tr("Type a command"))
        self.list = QListWidget()
        self.list.setAccessibleName(tr("Commands that fit"))
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        layout = QVBoxLayout(self)
        layout.addWidget(self.line)
        layout.addWidget(self.list)
        self.line.textChanged.connect(self._fill)
        self.line.returnPressed.connect(self._run)
        self.list.itemActivated.connect(lambda _item: self._run())
        self.list.itemClicked.connect(lambda _item: self._run())
        self.line.installEventFilter(self)
        self._fill("")

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()), 0)
            if step and self.list.count():
                self.list.setCurrentRow((self.list.currentRow() + step) % self.list.count())
                return True
        return super().eventFilter(watched, event)

    def _fill(self, typed: str) -> None:
        self.list.clear()
        for command in matches(self._commands, typed):
            keys = f"   ({command.keys})" if command.keys else ""
            self.list.addItem(command.title + keys)
        self.list.setCurrentRow(0)

    def _run(self) -> None:
        found = matches(self._commands, self.line.text())
        if not found:
            return
        command = found[max(0, self.list.currentRow())]
        self.accept()
        QTimer.singleShot(0, self.parent() or self, command.run)  # when this dialog is gone
