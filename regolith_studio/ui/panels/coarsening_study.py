"""RMSRE of the descriptors for several loss functions over all open particles (Fig. 8 of the paper)."""

from typing import Any

from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.widgets.heat_table import HeatTable
from regolith_studio.ui.widgets.labels import plain_symbol
from regolith_studio.ui.widgets.study_frame import StudyFrame

WAITING = (
    "Root mean squared relative error of each descriptor, one row a loss function, as in Fig. 8 of the paper."
)
HEADERS = (*(plain_symbol(CATALOGUE[key].symbol) for key in LOSS_KEYS), "Jaccard")
KEYS = (*LOSS_KEYS, JACCARD)


class CoarseningStudyPanel(QWidget):
    """A row a loss function, a column a descriptor, percentages in the cells."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("coarsening_study")
        self.table = HeatTable(WAITING)
        self.frame = StudyFrame("coarsening_study", self.table)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.frame)

    def show_study(self, study: Any, outdated: bool) -> None:
        """Show a ``CoarseningStudy``, or nothing."""
        if study is None or not study.names:
            self.table.set_values([], HEADERS, [])
            self.frame.set_remark("")
            return
        self.table.set_values([row.label for row in study.rows], HEADERS, study.rmsre)
        count = f"RMSRE [%], {len(study.names)} particles"
        self.frame.set_remark(f"{count}; computed with other choices" if outdated else count)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.table.set_theme(theme)
