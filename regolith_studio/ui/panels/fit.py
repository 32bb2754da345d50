"""The degree at which the spherical-harmonics series is cut, and what the fit cannot show."""

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.session.choices import L_MAX_LIMIT
from regolith_studio.ui.widgets.labels import heading, remark
from regolith_studio.ui.widgets.number_slider import NumberSlider, NumberSpec

L_MAX = NumberSpec(
    "l<sub>max</sub>",
    "Maximum degree",
    0,
    L_MAX_LIMIT,
    tip="Degree at which the series of Eq. 4 is cut: 0 is a sphere; the paper uses 10.",
)


class FitPanel(QWidget):
    """Edits l_max."""

    FIELDS = ("l_max",)
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("fit")
        self.l_max = NumberSlider(L_MAX)
        self.l_max.slider.setObjectName("l_max_slider")
        self.l_max.field.setObjectName("l_max")
        self.findings = remark()
        self.warnings = remark(role="warning")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading("Spherical-harmonics fit"))
        for widget in (self.l_max, self.findings, self.warnings):
            layout.addWidget(widget)
        self.set_findings(None)
        self.l_max.valueChanged.connect(lambda _: self.valueChanged.emit(self.value()))
        self.l_max.editingFinished.connect(self.editingFinished)

    def value(self) -> dict[str, int]:
        """The degree."""
        return {"l_max": int(self.l_max.value())}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show another degree."""
        self.l_max.setValue(value["l_max"])

    def set_findings(self, fit: Any | None) -> None:
        """Say what the radius function of a ``HarmonicFit`` cannot represent."""
        if fit is None:
            self.findings.setText("Not fitted yet.")
            self.findings.show()
            self.warnings.hide()
            return
        self.findings.setVisible(not fit.warnings)
        if fit.star_shaped:
            self.findings.setText("Star-shaped: no part of the surface is hidden from the star point.")
        else:
            self.findings.setText(
                f"{fit.hidden_surface_share:.2%} of the surface is hidden from the star point; "
                f"{fit.unrepresentable_volume_share:.2%} of the volume cannot be represented."
            )
        self.warnings.setText(" ".join(fit.warnings))
        self.warnings.setVisible(bool(fit.warnings))
