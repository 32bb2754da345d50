"""RMSRE of the descriptors for several loss functions over all open particles (Fig. 8 of the paper)."""

from typing import Any

from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.messages import N_
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr, tr_count, translate
from regolith_studio.ui.widgets.definitions import definition
from regolith_studio.ui.widgets.heat_table import HeatTable
from regolith_studio.ui.widgets.labels import plain_symbol
from regolith_studio.ui.widgets.study_frame import StudyFrame

PLACEHOLDER = N_("Root mean squared relative error of each descriptor, one row per loss function.")
HEADERS = (*(plain_symbol(CATALOGUE[key].symbol) for key in LOSS_KEYS), "Jaccard")
KEYS = (*LOSS_KEYS, JACCARD)


class CoarseningStudyPanel(QWidget):
    """A table with a row per loss function and a column per descriptor, in per cent."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("coarsening_study")
        self._study: Any = None
        self.table = HeatTable(tr(PLACEHOLDER))
        self.frame = StudyFrame("coarsening_study", self.table)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.frame)

    def show_study(self, study: Any, outdated: bool) -> None:
        """Show a ``CoarseningStudy``, or nothing."""
        if study is None or not study.names:
            self._study = None
            self.table.set_values([], HEADERS, [])
            self.frame.set_remark("")
            return
        self._study = study
        labels, ends = [translate(row.label) for row in study.rows], study.bands.tolist()
        tips = [definition(key) for key in KEYS]
        self.table.set_values(labels, HEADERS, study.rmsre, (ends[0], ends[1]), tips)
        self._set_tool_tips()
        count = tr_count(N_("RMSRE [%], 1 particle"), N_("RMSRE [%], {count} particles"), len(study.names))
        count += ", " + tr("{share:.0%} bootstrap intervals", share=study.confidence)
        if study.box_metric != "exact":
            count += ", " + tr("box of {name}", name=study.box_metric)
        self.frame.set_remark(count + "; " + tr("computed with other choices") if outdated else count)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.table.set_theme(theme)
        self._set_tool_tips()

    def _set_tool_tips(self) -> None:
        """Set the tool tips of the cells: values with bootstrap intervals."""
        study = self._study
        if study is None or len(self.table.values()) != len(study.rows):
            return
        low, high = 100 * study.bands
        for r, row in enumerate(study.rows):
            for k, header in enumerate(HEADERS):
                item = self.table.table.item(r, k)
                if item is not None:
                    item.setToolTip(
                        tr(
                            "{row}, {column}: {value:.3g} % ({low:.3g} to {high:.3g}; {share:.0%} bootstrap"
                            " interval)",
                            row=translate(row.label),
                            column=header,
                            value=100 * study.rmsre[r, k],
                            low=low[r, k],
                            high=high[r, k],
                            share=study.confidence,
                        )
                    )
