"""Table of the DEM engines and their capabilities."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem

from regolith_studio.dem.engines import CAPABILITY_LABELS, engine_rows
from regolith_studio.ui.translation import tr


class EnginePanel(QTableWidget):
    """A column per engine, a row per property."""

    def __init__(self) -> None:
        rows = engine_rows()
        super().__init__(len(CAPABILITY_LABELS) + 1, len(rows))
        self.setObjectName("repose_engines")
        self.setAccessibleName(tr("Engines"))
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.setShowGrid(False)
        self.setHorizontalHeaderLabels([row["label"] for row in rows])
        self.setVerticalHeaderLabels([tr("Found"), *map(tr, CAPABILITY_LABELS.values())])
        for column, row in enumerate(rows):
            texts = [row["version"] or row["problem"], *(tr(row[key]) for key in CAPABILITY_LABELS)]
            for at, text in enumerate(texts):
                item = QTableWidgetItem(text)
                item.setTextAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
                item.setToolTip(text)
                self.setItem(at, column, item)
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.setWordWrap(True)
