"""Asks for a folder to write into: one that is there, or a new one by its name."""

from pathlib import Path

from PySide6.QtWidgets import QDialog, QDialogButtonBox, QFileDialog, QLineEdit, QWidget

from regolith_studio.ui.translation import tr


class FolderDialog(QFileDialog):
    """A choice of folders that makes the one that is named, where Qt's would refuse it.

    - ``parent``: the dialog is in front of.
    - ``title``: what the folder is for.
    - ``start``: the folder that is shown first; that of the program if there is none.
    """

    def __init__(self, parent: QWidget | None, title: str, start: str = "") -> None:
        super().__init__(parent, title, start)
        self.setObjectName("folder_dialog")
        self.setFileMode(QFileDialog.FileMode.Directory)
        self.setOption(QFileDialog.Option.ShowDirsOnly)
        self.setLabelText(QFileDialog.DialogLabel.FileName, tr("Folder (created if missing):"))
        if (line := self._line()) is not None:
            line.textChanged.connect(self._allow)  # after Qt, which greys the button out for a new one

    @staticmethod
    def ask(parent: QWidget | None, title: str, start: str = "") -> str:
        """The path of the folder, which is there now; empty where nobody wants any."""
        dialog = FolderDialog(parent, title, start)
        try:
            agreed = dialog.exec() == QDialog.DialogCode.Accepted
            return dialog.selectedFiles()[0] if agreed and dialog.selectedFiles() else ""
        finally:
            dialog.deleteLater()

    def accept(self) -> None:
        """Make what was typed, if there is no such folder; where it cannot be, Qt says that there is none."""
        line = self._line()
        if line is not None and line.text().strip():
            self._make(self.directory().absolutePath(), line.text().strip())
        super().accept()

    def _line(self) -> QLineEdit | None:
        """Where a name is typed; not there where the desktop has its own dialog."""
        return self.findChild(QLineEdit, "fileNameEdit")

    def _allow(self, typed: str) -> None:
        for box in self.findChildren(QDialogButtonBox):
            for button in box.buttons():
                if typed.strip() and box.buttonRole(button) == QDialogButtonBox.ButtonRole.AcceptRole:
                    button.setEnabled(True)

    @staticmethod
    def _make(shown: str, typed: str) -> None:
        folder = Path(shown) / Path(typed).expanduser()
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError):
            return
