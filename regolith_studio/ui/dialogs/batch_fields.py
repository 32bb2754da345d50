"""Fields of the batch dialog: a path, where the recipe comes from, and who works."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QComboBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.errors import InputError
from regolith_studio.jobs.executor import TLS_NAMES, ExecutorSettings
from regolith_studio.jobs.runners.dask_cluster import SchedulerAddress
from regolith_studio.jobs.runners.process_pool import cores
from regolith_studio.messages import N_
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import remark

PLACES = {
    "processes": N_("Processes of this machine"),
    "local": N_("A Dask cluster started on this machine"),
    "address": N_("A Dask cluster at an address"),
}


class PathField(QWidget):
    """A path with a button that asks for it."""

    changed = Signal()

    def __init__(self, name: str, title: str, *, folder: bool, filter: str = "") -> None:
        super().__init__()
        self._title, self._folder, self._filter = title, folder, filter
        self.text = QLineEdit()
        self.text.setObjectName(name)
        self.text.setAccessibleName(title)
        self.browse = QPushButton(tr("Browse …"))
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.text, 1)
        layout.addWidget(self.browse)
        self.browse.clicked.connect(self._ask)
        self.text.textChanged.connect(self.changed)

    def value(self) -> Path | None:
        """The path; ``None`` where there is none."""
        text = self.text.text().strip()
        return Path(text).expanduser() if text else None

    def setValue(self, path: Path | None) -> None:
        """Show another path."""
        self.text.setText("" if path is None else str(path))

    def _ask(self) -> None:
        if self._folder:
            name = FolderDialog.ask(self, self._title, self.text.text())
        else:
            name, _ = QFileDialog.getOpenFileName(self, self._title, self.text.text(), self._filter)
        if name:
            self.text.setText(name)


class SourceField(QWidget):
    """The open particles with the present choices, or a recipe file."""

    changed = Signal()

    def __init__(self, count: int, unsaved: int) -> None:
        super().__init__()
        self._count = count - unsaved
        self.kind = QComboBox()
        self.kind.setObjectName("batch_source")
        self.kind.setAccessibleName(tr("Recipe"))
        ours = tr("The files of the {count} open particles, as chosen now", count=self._count)
        self.kind.addItem(ours, "open")
        self.kind.addItem(tr("A recipe file"), "file")
        kinds = tr("Recipes (*.json)")
        self.file = PathField("batch_recipe", tr("Recipe"), folder=False, filter=kinds)
        left_out = tr(
            "{count} of the open particles come from no file and cannot be part of a batch.", count=unsaved
        )
        self.missing = remark(left_out, "warning")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for widget in (self.kind, self.file, self.missing):
            layout.addWidget(widget)
        self.kind.currentIndexChanged.connect(self._changed)
        self.file.changed.connect(self._changed)
        self.kind.setCurrentIndex(0 if self._count else 1)
        self._unsaved = unsaved
        self._changed()

    def value(self) -> Path | None:
        """The file; ``None`` for the open particles."""
        return (self.file.value() or Path()) if self.kind.currentData() == "file" else None

    def checked(self) -> Path | None:
        """As :meth:`value`.

        Raises
        ------
        InputError
            If there is no such file, or no particle.
        """
        path = self.value()
        if path is None and self._count < 1:
            raise InputError(tr("No open particle comes from a file: open some, or choose a recipe file."))
        if path is not None and not path.is_file():
            raise InputError(tr("Choose a recipe file."))
        return path

    def _changed(self) -> None:
        ours = self.kind.currentData() == "open"
        self.file.setVisible(not ours)
        self.missing.setVisible(ours and self._unsaved > 0)
        self.changed.emit()


class WorkersField(QWidget):
    """Edits :class:`ExecutorSettings`."""

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.executor = QComboBox()
        self.executor.setObjectName("batch_place")
        self.executor.setAccessibleName(tr("Run on"))
        for key, label in PLACES.items():
            self.executor.addItem(tr(label), key)
        self.count = QSpinBox()
        self.count.setObjectName("batch_workers")
        self.count.setAccessibleName(tr("Number of processes"))
        self.count.setRange(1, 1024)
        self.count.setValue(cores())
        self.address = QLineEdit()
        self.address.setObjectName("batch_address")
        self.address.setAccessibleName(tr("Address of the scheduler"))
        self.address.setPlaceholderText(tr("tcp://HOST:8786 or tls://HOST:8786"))
        names = ", ".join(TLS_NAMES)
        self.tls = PathField("batch_tls", tr("Folder with {names}", names=names), folder=True)
        self.tls.text.setPlaceholderText(tr("folder with {names}", names=names))
        self._form = QFormLayout(self)
        self._form.setContentsMargins(0, 0, 0, 0)
        self._form.addRow(self.executor)
        self._form.addRow(tr("Processes"), self.count)
        self._form.addRow(tr("Scheduler"), self.address)
        self._form.addRow(tr("Certificates"), self.tls)
        self.executor.currentIndexChanged.connect(self._changed)
        self.count.valueChanged.connect(self._changed)
        self.address.textChanged.connect(self._changed)
        self.tls.changed.connect(self._changed)
        self._changed()

    def value(self) -> ExecutorSettings:
        """Who shall work.

        Raises
        ------
        InputError
            If the address has not its form, or certificates are missing.
        """
        executor = self.executor.currentData()
        if executor == "processes":
            return ExecutorSettings("processes", self.count.value())
        if executor == "local":
            return ExecutorSettings("dask", self.count.value())
        address = SchedulerAddress.parse(self.address.text())
        tls = self.tls.value() if address.scheme == "tls" else None
        missing = [name for name in TLS_NAMES if tls and not (tls / name).is_file()]
        if address.scheme == "tls" and (tls is None or missing):
            names = ", ".join(TLS_NAMES)
            raise InputError(tr("An encrypted cluster needs a folder with {names}.", names=names))
        return ExecutorSettings("dask", 0, str(address), tls)

    def field_values(self) -> dict[str, str]:
        """For the next sitting."""
        tls = self.tls.text.text()
        return {"place": str(self.executor.currentData()), "address": self.address.text(), "tls": tls}

    def restore_fields(self, values: Mapping[str, Any]) -> None:
        """Suggest what was given before."""
        self.executor.setCurrentIndex(max(0, self.executor.findData(values.get("place"))))
        self.address.setText(str(values.get("address", "")))
        self.tls.text.setText(str(values.get("tls", "")))

    def _changed(self) -> None:
        remote = self.executor.currentData() == "address"
        encrypted = self.address.text().strip().startswith("tls://")
        self._form.setRowVisible(self.count, not remote)
        self._form.setRowVisible(self.address, remote)
        self._form.setRowVisible(self.tls, remote and encrypted)
        self.changed.emit()
