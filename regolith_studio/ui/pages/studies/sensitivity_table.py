"""Sensitivity of errors to weights in percentage points, red for an increase, blue for a decrease."""

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QResizeEvent
from PySide6.QtWidgets import QStackedLayout, QTableWidgetItem, QWidget

from regolith_studio.studies.coarsening import COLUMNS, CoarseningStudy
from regolith_studio.studies.sweeps import differences, format_difference, significant
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.translation.numbers import localized
from regolith_studio.ui.widgets.definitions import definition
from regolith_studio.ui.widgets.heat_table import centred_remark, keep_legible, numbers_table, set_head_tips
from regolith_studio.ui.widgets.table import FontRowHeight


class SensitivityTable(QWidget):
    """A table with a row per change and a column per descriptor, or a placeholder."""

    def __init__(self, placeholder: str, headers: tuple[str, ...]) -> None:
        super().__init__()
        self._theme, self._headers = current_theme(), headers
        self._study: CoarseningStudy | None = None
        self.table = numbers_table(tr("Changes of errors in percentage points"))
        self.table.setTextElideMode(Qt.TextElideMode.ElideNone)
        self.table.setWordWrap(False)
        self._rows = FontRowHeight(self.table, 10)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(centred_remark(placeholder))
        self._stack.addWidget(self.table)

    def show_study(self, study: CoarseningStudy | None) -> None:
        """Show the differences of a sensitivity study, or the placeholder."""
        self._study = study if study is not None and len(study.rows) > 1 else None
        self._stack.setCurrentIndex(1 if self._study else 0)
        self._fill()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        self._fill()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        keep_legible(self.table, self.width(), self._rows, 1)

    def _fill(self) -> None:
        study = self._study
        if study is None:
            self.table.setRowCount(0)
            return
        labels = [translate(row.label) for row in study.rows[1:]]
        values, (low, high) = (100 * each for each in differences(study))
        sure, given = significant(study), 100 * study.rmsre
        top = float(np.abs(values).max(initial=0.0)) or 1.0
        self.table.setRowCount(len(labels))
        self.table.setColumnCount(len(self._headers))
        self.table.setVerticalHeaderLabels(labels)
        self.table.setHorizontalHeaderLabels(list(self._headers))
        set_head_tips(self.table, [definition(key) for key in COLUMNS])
        for r, label in enumerate(labels):
            for k, header in enumerate(self._headers):
                value = float(values[r, k])
                text = localized(format_difference(value))
                item = QTableWidgetItem(text if sure[r, k] or text == "0" else f"({text})")
                item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
                item.setBackground(self._ground(value / top))
                item.setToolTip(
                    tr(
                        "{row}, {column}: {before:.3g} % becomes {after:.3g} %",
                        row=label,
                        column=header,
                        before=given[0, k],
                        after=given[r + 1, k],
                    )
                    + "\n"
                    + tr(
                        "{value:+.3g} percentage points ({low:+.3g} to {high:+.3g})",
                        value=value,
                        low=low[r, k],
                        high=high[r, k],
                    )
                    + ("" if sure[r, k] else "\n" + tr("Not significant."))
                )
                self.table.setItem(r, k, item)
        keep_legible(self.table, self.width(), self._rows, 1)

    def _ground(self, share: float) -> QColor:
        colour = QColor(self._theme.bad if share > 0 else self._theme.fit)
        colour.setAlphaF(0.65 * min(1.0, abs(share)) ** 0.5 if abs(share) > 1e-3 else 0.0)
        return colour
