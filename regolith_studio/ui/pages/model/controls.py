"""Controls: source, shape model with its settings, and number and sizes of the drawn particles."""

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSpinBox,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.errors import InputError
from regolith_studio.jobs.model_jobs import GenerationRequest
from regolith_studio.messages import N_
from regolith_studio.shape_models.materials import LOG_FIELD
from regolith_studio.shape_models.models import DEFAULT_MODEL, MODELS
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.forms import SettingsForm
from regolith_studio.ui.widgets.labels import FixedHeightText, heading, hint_label
from regolith_studio.ui.widgets.numbers import DecimalField, NumberSlider, NumberSpec

L_MAX = NumberSpec(
    "l<sub>max</sub>",
    N_("Degree of the particles"),
    1,
    30,
    tip=N_("Usually 10; at most the degree of the sample."),
)
MAX_DRAWN = 1_000_000


class SourceControls(QWidget):
    """Selects a sample or material, the model and its settings."""

    sourceChanged = Signal(str)  # noqa: N815
    openRequested = Signal()  # noqa: N815
    fitRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("model_source")
        self.source, self.model = QComboBox(), QComboBox()
        self.l_max = NumberSlider(L_MAX)
        self.half = QCheckBox(tr("Fit to a random half only"))
        self.open, self.fit = QPushButton(tr("Open …")), QPushButton(tr("Fit the model"))
        self.summary, self.findings = hint_label(), hint_label()
        self.forms = {key: SettingsForm(model.Settings, without=("l_max",)) for key, model in MODELS.items()}
        self._forms = QStackedWidget()
        self._configure()
        self._place()
        self.source.currentIndexChanged.connect(lambda _: self.sourceChanged.emit(self.source.currentData()))
        self.model.currentIndexChanged.connect(lambda _: self._show_model())
        self.open.clicked.connect(self.openRequested)
        self.fit.clicked.connect(self.fitRequested)
        self._show_model()

    def set_sources(self, sources: Mapping[str, str]) -> None:
        """Set the sources by key; the selection stays if possible."""
        chosen = self.source.currentData()
        with QSignalBlocker(self.source):
            self.source.clear()
            for key, label in sources.items():
                self.source.addItem(label, key)
            self.source.setCurrentIndex(max(0, self.source.findData(chosen)))
        if self.source.currentData() != chosen:
            self.sourceChanged.emit(self.source.currentData())

    def choose_source(self, key: str) -> None:
        """Select another source."""
        self.source.setCurrentIndex(max(0, self.source.findData(key)))

    def show_kind(self, brings_model: str, max_degree: int, words: str) -> None:
        """Describe the source.

        - ``brings_model``: key of the model that a card or file brings; empty for a sample, to which any
          can be fitted.
        - ``max_degree``: highest degree of the source.
        - ``words``: a sentence.
        """
        self.findings.setText(words)
        self.model.setEnabled(not brings_model)
        for widget in (self.half, self._forms):
            widget.setEnabled(not brings_model)
        if brings_model:
            self.model.setCurrentIndex(self.model.findData(brings_model))
        self.fit.setText(tr("Use the model") if brings_model else tr("Fit the model"))
        self.l_max.setEnabled(brings_model in ("", LOG_FIELD))
        self.l_max.slider.setMaximum(max_degree)
        self.l_max.field.setMaximum(max_degree)

    def value(self) -> dict[str, Any]:
        """Source, model, degree, half, and the modified settings of each model."""
        return {
            "source": self.source.currentData(),
            "model": self.model.currentData(),
            "l_max": int(self.l_max.value()),
            "half": self.half.isChecked(),
            "settings": {key: form.value() for key, form in self.forms.items() if form.value()},
        }

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices; unknown names are ignored."""
        if (at := self.source.findData(value.get("source"))) >= 0:
            self.source.setCurrentIndex(at)
        if (at := self.model.findData(value.get("model"))) >= 0:
            self.model.setCurrentIndex(at)
        self.l_max.setValue(int(value.get("l_max", default_degree(DEFAULT_MODEL))))
        self.half.setChecked(bool(value.get("half", False)))
        for key, form in self.forms.items():
            form.setValue(dict(value.get("settings", {})).get(key, {}))

    def _show_model(self) -> None:
        key = self.model.currentData()
        self.l_max.setValue(default_degree(key))
        self.summary.setText(tr(MODELS[key].summary))
        self._forms.setCurrentWidget(self.forms[key])
        for each, form in self.forms.items():
            form.setVisible(each == key)

    def _configure(self) -> None:
        for key, model in MODELS.items():
            self.model.addItem(tr(model.label), key)
            self._forms.addWidget(self.forms[key])
        self.model.setCurrentIndex(self.model.findData(DEFAULT_MODEL))
        self.l_max.setValue(default_degree(DEFAULT_MODEL))
        self.half.setToolTip(tr("The other half is then unknown to the model, as in its evaluation."))
        names = {
            "source": tr("Source of the model"),
            "model": tr("Kind of model"),
            "half": tr("Fit to a half"),
        }
        for name in ("source", "model", "half", "open", "fit"):
            widget = getattr(self, name)
            widget.setObjectName(f"model_{name}")
            widget.setAccessibleName(names.get(name, widget.text() if hasattr(widget, "text") else name))
        self.l_max.field.setObjectName("model_l_max")
        self.source.setMinimumContentsLength(12)
        self.source.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.model.setMinimumContentsLength(12)
        self.model.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)

    def _place(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        row = QHBoxLayout()
        row.addWidget(self.source, 1)
        row.addWidget(self.open)
        layout.addWidget(heading(tr("Sample or material")))
        layout.addLayout(row)
        layout.addWidget(FixedHeightText((self.findings,)))
        layout.addSpacing(8)
        layout.addWidget(heading(tr("Model")))
        summary = FixedHeightText((self.summary,))
        for widget in (self.model, summary, self.l_max, self._forms, self.half, self.fit):
            layout.addWidget(widget)


class DrawControls(QWidget):
    """Number, seed and sizes of the drawn particles."""

    drawRequested = Signal()  # noqa: N815
    adoptRequested = Signal()  # noqa: N815
    namesChanged = Signal(tuple)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("model_draw")
        self.number, self.seed = QSpinBox(), QSpinBox()
        self.limited = QCheckBox(tr("Limit the equivalent radius"))
        self.smallest, self.largest = DecimalField(), DecimalField()
        self.draw, self.adopt = QPushButton(tr("Draw")), QPushButton(tr("Use as population"))
        self.findings = hint_label()
        self.names = QLineEdit()
        self._names_label = QLabel(tr("Components"))
        self._configure()
        self._place()
        self.names.editingFinished.connect(self._rename)
        self.limited.toggled.connect(self._limit)
        self.draw.clicked.connect(self.drawRequested)
        self.adopt.clicked.connect(self.adoptRequested)
        self._limit(False)
        self.set_ready(source=False, drawn=False)
        self.show_names(())

    def show_names(self, names: tuple[str, ...]) -> None:
        """Set the names of the components of a mixture; none for other models."""
        self.names.setVisible(bool(names))
        self._names_label.setVisible(bool(names))
        self.names.setText(", ".join(names))

    def _rename(self) -> None:
        names = tuple(name.strip() for name in self.names.text().split(",") if name.strip())
        self.namesChanged.emit(names)

    def set_ready(self, *, source: bool, drawn: bool) -> None:
        """Set whether there is something to fit a model to, and whether particles have been drawn."""
        self.draw.setEnabled(source)
        self.adopt.setEnabled(drawn)

    def value(self) -> dict[str, Any]:
        """Number, seed and range of sizes."""
        bounds = [self.smallest.value(), self.largest.value()] if self.limited.isChecked() else None
        return {"n": self.number.value(), "seed": self.seed.value(), "size_range": bounds}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other values."""
        self.number.setValue(int(value.get("n", 100)))
        self.seed.setValue(int(value.get("seed", 0)))
        bounds = value.get("size_range")
        self.limited.setChecked(bounds is not None)
        if bounds is not None:
            self.smallest.setValue(float(bounds[0]))
            self.largest.setValue(float(bounds[1]))

    def suggest(self, smallest: float, largest: float) -> None:
        """Show the sizes of the sample while the fields are disabled."""
        if not self.limited.isChecked():
            self.smallest.setValue(smallest)
            self.largest.setValue(largest)

    def _limit(self, limited: bool) -> None:
        self.smallest.setEnabled(limited)
        self.largest.setEnabled(limited)

    def _configure(self) -> None:
        self.number.setRange(1, MAX_DRAWN)
        self.number.setValue(100)
        self.number.setGroupSeparatorShown(True)
        self.seed.setRange(0, 2**31 - 1)
        for field, value in ((self.smallest, 1.0), (self.largest, 100.0)):
            field.setDecimals(3)
            field.setRange(1e-3, 1e9)
            field.setValue(value)
            field.setSuffix(" µm")
            field.setMinimumWidth(80)
        names = {
            "number": tr("Number of particles"),
            "seed": tr("Seed of the draws"),
            "limited": tr("Limit the sizes"),
            "smallest": tr("Smallest equivalent radius"),
            "largest": tr("Largest equivalent radius"),
            "names": tr("Names of the components, the most numerous first"),
            "draw": tr("Draw particles"),
            "adopt": tr("Use the drawn particles as population"),
        }
        for name, words in names.items():
            getattr(self, name).setObjectName(f"model_{name}")
            getattr(self, name).setAccessibleName(words)
        self.names.setToolTip(tr("Names of the components, separated by commas, the most numerous first."))
        self.draw.setToolTip(tr("Fits the model first where that has not been done."))
        self.adopt.setToolTip(tr("Open the drawn particles: to be coarsened and made a dataset."))

    def _place(self) -> None:
        form = QFormLayout()
        form.addRow(tr("Particles"), self.number)
        form.addRow(tr("Seed"), self.seed)
        sizes = QHBoxLayout()
        sizes.addWidget(self.smallest, 1)
        sizes.addWidget(self.largest, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading(tr("Virtual particles")))
        layout.addLayout(form)
        layout.addWidget(self.limited)
        layout.addLayout(sizes)
        for widget in (self.draw, FixedHeightText((self.findings,)), self.adopt):
            layout.addWidget(widget)
        parts = QFormLayout()  # last, because only mixtures have them
        parts.addRow(self._names_label, self.names)
        layout.addLayout(parts)


def request_from(
    source: Mapping[str, Any], drawing: Mapping[str, Any], brings_model: str
) -> GenerationRequest:
    """The request with the values of the controls."""
    bounds = drawing["size_range"]
    if bounds is not None and not bounds[0] < bounds[1]:
        raise InputError(
            tr(
                "The smallest radius must be below the largest, got {low:g} and {high:g}.",
                low=bounds[0],
                high=bounds[1],
            )
        )
    key = "" if brings_model else str(source["model"])
    settings = tuple(source["settings"].get(key, {}).items()) if key else ()
    degree = None if brings_model not in ("", LOG_FIELD) else int(source["l_max"])
    return GenerationRequest(
        key, settings, degree, drawing["n"], drawing["seed"], None if bounds is None else tuple(bounds)
    )


def default_degree(model: str) -> int:
    """Degree of a model's draws where none is chosen; the slider ends at that of the source."""
    return int(MODELS[model].Settings().l_max)
