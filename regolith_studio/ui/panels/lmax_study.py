"""RMSRE of the descriptors against l_max over all open particles (Fig. 3 of the paper)."""

from typing import Any

import numpy as np
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.messages import N_
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.widgets.definitions import definition
from regolith_studio.ui.widgets.labels import rich_symbol
from regolith_studio.ui.widgets.number_fields import DecimalField
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.study_frame import StudyFrame

PLACEHOLDER = N_("Root mean squared relative error of each descriptor against l<sub>max</sub>.")


class LmaxStudyPanel(QWidget):
    """A curve per descriptor, a marker at the chosen l_max, and the smallest l_max within a tolerance."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("lmax_study")
        self.plot = CurvePlot(tr("Maximum degree l<sub>max</sub>"), "RMSRE [%]", tr(PLACEHOLDER))
        self.frame = StudyFrame("lmax_study", self.plot)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._asked())
        layout.addWidget(self.frame, 1)
        self._study: Any = None
        self._answer()

    def show_study(self, study: Any, outdated: bool) -> None:
        """Draw an ``LmaxStudy``, or nothing."""
        self._study = study
        if study is None:
            self.plot.set_curves([])
            self.frame.set_remark("")
            self._answer()
            return
        values = 100.0 * np.asarray(study.rmsre())
        degrees = tuple(float(degree) for degree in study.degrees)
        curves = [
            PlotCurve(
                rich_symbol(CATALOGUE[key].symbol),
                DESCRIPTOR_COLOURS[number % len(DESCRIPTOR_COLOURS)],
                degrees,
                tuple(values[:, number]),
                markers=True,
            )
            for number, key in enumerate(study.keys)
        ]
        self.plot.set_curves(curves)
        self.plot.legend.setToolTip("\n".join(map(definition, study.keys)))
        count = tr_count(N_("1 particle"), N_("{count} particles"), len(study.names))
        self.frame.set_remark(count + "; " + tr("computed with other choices") if outdated else count)
        self._answer()

    def show_l_max(self, l_max: int) -> None:
        """Mark the chosen degree."""
        self.plot.set_marker(float(l_max))

    def _asked(self) -> QWidget:
        """The row with the tolerance and the smallest sufficient l_max."""
        self.tolerance = DecimalField()
        self.tolerance.setObjectName("lmax_study_tolerance")
        self.tolerance.setAccessibleName(tr("Largest error in percent"))
        self.tolerance.setRange(0.1, 100.0)
        self.tolerance.setDecimals(1)
        self.tolerance.setValue(5.0)
        self.tolerance.setSuffix(" %")
        self.tolerance.valueChanged.connect(lambda _value: self._answer())
        self.answer = QLabel()
        self.answer.setObjectName("lmax_study_answer")
        self._question = QWidget()
        row = QHBoxLayout(self._question)
        row.setContentsMargins(8, 8, 8, 0)
        words = QLabel(tr("Smallest l<sub>max</sub> with every error below"))
        for label, share in ((words, 2), (self.answer, 1)):
            label.setWordWrap(True)  # on two lines where letters are large
            row.addWidget(label, share)
        row.insertWidget(1, self.tolerance)
        return self._question

    def _answer(self) -> None:
        self._question.setVisible(self._study is not None)
        if self._study is not None:
            found = self._study.smallest_l_max(self.tolerance.value() / 100)
            self.answer.setText(
                f'<b style="font-size:x-large">{found}</b>' if found is not None else tr("none of these")
            )
