"""What is asked about files: their unit, what becomes of open particles, a folder to write into."""

from pathlib import Path
from typing import cast

from PySide6.QtCore import QEvent, QObject, QPointF, Qt, QTimer, Signal
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QLabel,
    QLineEdit,
    QMessageBox,
    QWidget,
)

from regolith_studio.errors import os_error_reason
from regolith_studio.messages import N_
from regolith_studio.readers.coefficient_tables import TableConvention
from regolith_studio.readers.particles import has_tables
from regolith_studio.readers.settings import UNITS, unit_factor
from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.layout import GrowingDialog, dialog_buttons, named, vbox
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.widgets.fields import choice, decimal_field, show_whole
from regolith_studio.ui.widgets.labels import hint_label, short_number

SETTING = "on_opening"
"""In the preferences of the window: ``add`` or ``replace``, if it is not to be asked."""
ADD, REPLACE = "add", "replace"


def ask_add_or_replace(preferences: Preferences, count: int, parent: QWidget) -> str | None:
    """``add`` or ``replace``, as remembered or as answered now; ``None`` to open nothing.

    ``count``: of the particles that are open.
    """
    kept = preferences.window.get(SETTING)
    if kept in (ADD, REPLACE):
        return str(kept)
    box = named(QMessageBox(parent), "add_or_replace")
    box.setIcon(QMessageBox.Icon.Question)
    box.setWindowTitle(tr("Open particles"))
    box.setText(tr_count(N_("1 particle is open."), N_("{count} particles are open."), count))
    box.setInformativeText(tr("Add the new ones to them, or replace them? Undo restores replaced ones."))
    add = box.addButton(tr("Add"), QMessageBox.ButtonRole.AcceptRole)
    replace = box.addButton(tr("Replace"), QMessageBox.ButtonRole.DestructiveRole)
    cancel = box.addButton(QMessageBox.StandardButton.Cancel)
    for button, name in ((add, "opening_add"), (replace, "opening_replace"), (cancel, "opening_cancel")):
        button.setObjectName(name)
    box.setDefaultButton(add)
    remember = named(QCheckBox(tr("Do not ask again")), "opening_remember")
    box.setCheckBox(remember)
    box.exec()
    pressed = box.clickedButton()
    answer = ADD if pressed is add else REPLACE if pressed is replace else None
    if answer and remember.isChecked():
        preferences.window = preferences.window | {SETTING: answer}
    box.deleteLater()
    return answer


LABELS = {
    "um": N_("Micrometres (µm)"),
    "mm": N_("Millimetres (mm)"),
    "m": N_("Metres (m)"),
    "nm": N_("Nanometres (nm)"),
    "cm": N_("Centimetres (cm)"),
    "voxel": N_("Voxels of a CT volume"),
}


GRAIN_SIZES = (1.0, 5000.0)
"""Plausible longest sides of regolith particles in micrometres."""


CONVENTIONS = (
    ("auto", N_("Detect from the rows")),
    ("complex", N_("Complex, orthonormal, with the phase")),
    ("shtools-4pi", N_("Real, 4π normalisation (SHTOOLS)")),
    ("shtools-ortho", N_("Real, orthonormal (SHTOOLS)")),
)
"""Conventions of tables of coefficients; the real ones have no Condon-Shortley phase."""


class UnitDialog(GrowingDialog):
    """Edits one unit, as the readers take it: ``mm``, or ``voxel:2.3`` with the voxel's edge in µm.

    For tables of coefficients it edits their convention too.
    """

    conventionChanged = Signal(str)  # noqa: N815

    def __init__(self, paths: list[Path], suggestion: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._first: tuple[str, float] | None = None
        self._touched = False
        self.size_note = hint_label()
        self.size_note.setObjectName("unit_size")
        self.setWindowTitle(tr("Length unit"))
        self.setObjectName("unit_dialog")
        question = QLabel(
            tr_count(
                N_("Length unit of {name}"),
                N_("Length unit of these {count} files and folders"),
                len(paths),
                name=paths[0].name,
            )
        )
        question.setWordWrap(True)
        self.unit = choice("unit", tr("Length unit"), {key: LABELS.get(key, key) for key in UNITS})
        spoken = tr("Edge of a voxel in micrometres")
        self.voxel = decimal_field("voxel_size", spoken, 0.001, 10_000.0, 2.3, " µm", decimals=3)
        self._voxel_label = QLabel(tr("Edge of a voxel"))
        form = QFormLayout()
        form.addRow(tr("Unit"), self.unit)
        form.addRow(self._voxel_label, self.voxel)
        self.convention = choice("convention", tr("Convention of coefficients"), CONVENTIONS)
        self.convention.setParent(self)
        if has_tables(paths):
            form.addRow(tr("Coefficients"), self.convention)
        else:
            self.convention.hide()
        self.convention.activated.connect(lambda _: self.conventionChanged.emit(self.convention.value()))
        buttons = dialog_buttons(self, QDialogButtonBox.StandardButton.Open)
        self._open = buttons.button(QDialogButtonBox.StandardButton.Open)
        vbox(
            question,
            form,
            self.size_note,
            hint_label(tr("Only 3MF and glTF state their unit. The answer is kept for the folder.")),
            buttons,
            parent=self,
            margins=None,
        )
        show_whole(self)
        self.unit.currentIndexChanged.connect(self._show_voxel)
        self.unit.currentIndexChanged.connect(self._show_size)
        self.unit.activated.connect(self._take_unit)
        self.voxel.valueChanged.connect(self._show_size)
        self.setValue(suggestion)
        self.size_note.setText(tr("Reading particles"))
        self._open.setEnabled(False)  # else a unit could be taken before the size is known that corrects it
        self._open.setDefault(True)

    @property
    def can_open(self) -> bool:
        """Whether the size is known, or a unit was chosen."""
        return self._open.isEnabled()

    def _take_unit(self) -> None:
        self._touched = True
        self._open.setEnabled(True)

    def value(self) -> str:
        key: str = self.unit.value()
        return f"voxel:{self.voxel.value():g}" if key == "voxel" else key

    def table_convention(self) -> TableConvention:
        convention: TableConvention = self.convention.value()
        return convention

    def setValue(self, unit: str) -> None:
        key, _, size = unit.partition(":")
        self.unit.choose(key)
        if size:
            self.voxel.setValue(float(size))
        self._show_voxel()

    def set_first(self, first: tuple[str, float] | str | None) -> None:
        """Show how large a particle would be; suggest the unit that makes it a grain.

        ``first``: name of the first particle, and its longest side as the file gives it; or why there is
        none.
        """
        self._open.setEnabled(not isinstance(first, str))
        if isinstance(first, str):
            self.size_note.setText(first)
            return
        self._first = first
        self.size_note.clear()
        if first is not None and not self._touched and not _is_plausible(first[1], self.value()):
            plausible = [unit for unit in UNITS if unit != "voxel" and _is_plausible(first[1], unit)]
            if plausible:
                self.setValue(plausible[0])
        self._show_size()

    def _show_size(self) -> None:
        if self._first is None:
            return
        name, length = self._first
        size = f"{short_number(length * unit_factor(self.value()), 3)} µm"
        self.size_note.setText(tr("{name} would be {size} across.", name=name, size=size))

    def _show_voxel(self) -> None:
        asked = self.unit.value() == "voxel"
        self.voxel.setEnabled(asked)
        self._voxel_label.setEnabled(asked)


def _is_plausible(length: float, unit: str) -> bool:
    """Whether a particle of this longest side has the size of a grain."""
    low, high = GRAIN_SIZES
    return low <= length * unit_factor(unit) <= high


class _EmptyCompletions(QObject):
    """Closes the completions of a name that is empty: Qt leaves them open where a folder has been entered."""

    def __init__(self, line: QLineEdit, completions: QAbstractItemView) -> None:
        super().__init__()
        self._line, self._completions = line, completions
        completions.installEventFilter(self)
        line.textChanged.connect(self._close)

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Show:
            self._close()
        return False

    def _close(self) -> None:
        if not self._line.text():
            QTimer.singleShot(0, self._completions, self._completions.hide)


def ask_for_files(parent: QWidget | None, title: str, folder: str, kinds: str) -> list[Path]:
    """Files that the user chooses; none where the dialog is cancelled."""
    dialog = QFileDialog(parent, title, folder, kinds)
    dialog.setFileMode(QFileDialog.FileMode.ExistingFiles)
    line = dialog.findChild(QLineEdit, "fileNameEdit")  # not there where the desktop has its own dialog
    completions = line.completer().popup() if line is not None else None
    watch = _EmptyCompletions(line, completions) if line is not None and completions is not None else None
    try:
        agreed = dialog.exec() == QDialog.DialogCode.Accepted
        return [Path(name) for name in dialog.selectedFiles()] if agreed else []
    finally:
        del watch
        dialog.deleteLater()


class FolderDialog(QFileDialog):
    """A choice of folders that makes the one that is named, where Qt's would refuse it.

    - ``parent``: the dialog is in front of.
    - ``title``: what the folder is for.
    - ``start``: the folder that is shown first; that of the program if there is none.
    - ``proposed``: name of a folder in it that is chosen unless another one is.
    """

    def __init__(self, parent: QWidget | None, title: str, start: str = "", proposed: str = "") -> None:
        super().__init__(parent, title, start)
        self.setObjectName("folder_dialog")
        self.setFileMode(QFileDialog.FileMode.Directory)
        self.setOption(QFileDialog.Option.ShowDirsOnly)
        self.setLabelText(QFileDialog.DialogLabel.FileName, tr("Folder (created if missing):"))
        if (line := self._line()) is not None:
            line.textChanged.connect(self._allow)  # after Qt, which greys the button out for a new one
            if (completions := line.completer().popup()) is not None:
                completions.installEventFilter(self)
                completions.setAttribute(Qt.WidgetAttribute.WA_NoMouseReplay)  # by Qt on other platforms
        if proposed:
            self.selectFile(proposed)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Let a click beside the completions close them and act: Qt would take it for the closing alone."""
        if event.type() == QEvent.Type.MouseButtonPress and isinstance(watched, QAbstractItemView):
            press = cast(QMouseEvent, event)
            if not watched.rect().contains(press.position().toPoint()):
                watched.hide()
                if (below := QApplication.widgetAt(press.globalPosition().toPoint())) is not None:
                    place = QPointF(below.mapFromGlobal(press.globalPosition()))
                    # the release goes to the window of the completions, which is hidden by then
                    for kind in (press.type(), QEvent.Type.MouseButtonRelease):
                        held = press.buttons() if kind == press.type() else Qt.MouseButton.NoButton
                        again = QMouseEvent(
                            kind, place, press.globalPosition(), press.button(), held, press.modifiers()
                        )
                        QApplication.sendEvent(below, again)
                return True
        return super().eventFilter(watched, event)

    @staticmethod
    def ask(parent: QWidget | None, title: str, start: str = "", proposed: str = "") -> str:
        """The path of the folder, which is there now; empty where nobody wants any."""
        dialog = FolderDialog(parent, title, start, proposed)
        try:
            agreed = dialog.exec() == QDialog.DialogCode.Accepted
            return dialog.selectedFiles()[0] if agreed and dialog.selectedFiles() else ""
        finally:
            dialog.deleteLater()

    def accept(self) -> None:
        """Make what was typed, if there is no such folder; where it cannot be, say why and stay open."""
        line = self._line()
        typed = line.text().strip() if line is not None else ""
        if problem := self._make(self.directory().absolutePath(), typed) if typed else "":
            QMessageBox.warning(self, self.windowTitle(), problem)
            return
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
    def _make(shown: str, typed: str) -> str:
        """Make a folder with those above it; returns why it cannot be made, or nothing."""
        folder = Path(shown)
        try:
            folder /= Path(typed).expanduser()
            folder.mkdir(parents=True, exist_ok=True)
        except FileExistsError:
            return tr("{path} is a file, not a folder.", path=folder)
        except OSError as error:
            reason = os_error_reason(error)
        except (RuntimeError, ValueError) as error:  # no such user, a character that no path has
            reason = str(error)
        else:
            return ""
        return tr("The folder {path} cannot be made ({reason}).", path=folder, reason=reason)
