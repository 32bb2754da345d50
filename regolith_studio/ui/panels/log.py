"""Log of the messages since the window opened, with the details of errors."""

import time

from PySide6.QtWidgets import QApplication, QHBoxLayout, QPlainTextEdit, QPushButton, QVBoxLayout, QWidget

from regolith_studio.messages import N_
from regolith_studio.ui.translation import tr

LIMIT = 2000
"""Maximum number of lines."""
MOODS = {"note": N_("note"), "problem": N_("problem")}


class LogPanel(QWidget):
    """A line per message, with its details indented below."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("log")
        self.text = QPlainTextEdit()
        self.text.setReadOnly(True)
        self.text.setMaximumBlockCount(LIMIT)
        self.text.setAccessibleName(tr("Log"))
        self.copy = QPushButton(tr("Copy report"))
        self.copy.setObjectName("copy_log")
        self.copy.clicked.connect(lambda: QApplication.clipboard().setText(self.text.toPlainText()))
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(self.copy)
        layout = QVBoxLayout(self)
        layout.addWidget(self.text, 1)
        layout.addLayout(row)

    def add(self, mood: str, sentence: str, details: str = "") -> None:
        """Add a message of the kind ``note`` or ``problem``."""
        clock = time.strftime("%H:%M:%S")
        lines = [f"{clock}  {tr(MOODS[mood]):8s} {sentence}"]
        lines += [f"          {line}" for line in details.splitlines()]
        self.text.appendPlainText("\n".join(lines))
