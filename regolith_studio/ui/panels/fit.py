"""Settings of the spherical-harmonics fit, and what the fit cannot represent."""

from collections.abc import Mapping
from dataclasses import fields
from functools import partial
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFormLayout, QVBoxLayout, QWidget

from regolith_studio.harmonics.fit_options import FitOptions
from regolith_studio.jobs.particle_jobs import FIT_DEGREE
from regolith_studio.messages import N_
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.collapsible import Collapsible
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.fixed_height_text import FixedHeightText
from regolith_studio.ui.widgets.labels import heading, remark, with_subscripts
from regolith_studio.ui.widgets.number_slider import NumberSlider, NumberSpec

L_MAX = NumberSpec(
    "l<sub>max</sub>",
    N_("Maximum degree"),
    0,
    FIT_DEGREE,
    tip=N_(
        "Degree at which the series is truncated: 0 is a sphere, 10 keeps the form, 30 nearly all details."
    ),
)


class FitPanel(QWidget):
    """Edits l_max and the options of the fit."""

    FIELDS = ("l_max", *(each.name for each in fields(FitOptions)))
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("fit")
        self.l_max = NumberSlider(L_MAX)
        self.l_max.slider.setObjectName("l_max_slider")
        self.l_max.field.setObjectName("l_max")
        self.ways = {
            each.name: ChoiceBox(each.name, tr(each.metadata["label"]), each.metadata["choices"])
            for each in fields(FitOptions)
        }
        self.more = Collapsible(tr("Radius function"), self._form())
        self.more.button.setObjectName("radius_settings")
        self.findings = remark()
        self.warnings = remark(role="warning")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading(tr("Spherical-harmonics fit")))
        for widget in (
            self.l_max,
            self.more,
            FixedHeightText((self.warnings, self.findings)),
        ):
            layout.addWidget(widget)
        self.set_findings(None)
        self.l_max.valueChanged.connect(lambda degree: self.valueChanged.emit({"l_max": int(degree)}))
        self.l_max.editingFinished.connect(self.editingFinished)

    def value(self) -> dict[str, Any]:
        """The edited choices."""
        return {"l_max": int(self.l_max.value()), **{name: box.value() for name, box in self.ways.items()}}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices."""
        self.l_max.setValue(value["l_max"])
        for name, box in self.ways.items():
            box.setValue(value[name])

    def set_findings(self, fit: Any | None) -> None:
        """Show what the radius function of a ``HarmonicFit`` cannot represent."""
        if fit is None:
            self.findings.setText(tr("Not fitted yet."))
            self.findings.show()
            self.warnings.hide()
            return
        self.findings.setVisible(not fit.warnings)
        if fit.star_shaped:
            self.findings.setText(tr("Star-shaped: no part of the surface is hidden from the star point."))
        else:
            self.findings.setText(
                tr(
                    "{surface:.2%} of the surface is hidden from the star point; "
                    "{volume:.2%} of the volume cannot be represented.",
                    surface=fit.hidden_surface_share,
                    volume=fit.unrepresentable_volume_share,
                )
            )
        self.warnings.setText(with_subscripts(" ".join(map(translate, fit.warnings))))
        self.warnings.setVisible(bool(fit.warnings))

    def _form(self) -> QWidget:
        form = QFormLayout(content := QWidget())
        form.setContentsMargins(14, 0, 0, 0)
        for each in fields(FitOptions):
            box = self.ways[each.name]
            box.setToolTip(tr(each.metadata["tip"]))
            box.activated.connect(partial(self._announce, each.name))
            form.addRow(tr(each.metadata["label"]), box)
        return content

    def _announce(self, name: str, _index: int) -> None:
        self.valueChanged.emit({name: self.ways[name].value()})
        self.editingFinished.emit()
