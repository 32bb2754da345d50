"""Controls: source, shape model with its settings, number and sizes; and the views of a model."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QGridLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QStackedWidget,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import Distribution, kolmogorov_smirnov_distance, wasserstein_1
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.jobs.model_jobs import GenerationRequest
from regolith_studio.messages import N_
from regolith_studio.scene import surfaces
from regolith_studio.scene.cameras import framing_pose
from regolith_studio.scene.figure import gallery_pose, show_gallery
from regolith_studio.shape_models.materials import LOG_FIELD
from regolith_studio.shape_models.models import DEFAULT_MODEL, MODELS
from regolith_studio.studies.population import KEYS
from regolith_studio.studies.population_distances import DistributionComparison
from regolith_studio.ui.layout import STRETCH, framed, hbox, named, side_by_side, vbox
from regolith_studio.ui.pages.model.evaluation import StudyTableView
from regolith_studio.ui.result_card import ResultView
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.views.view import SceneView, ViewFrame
from regolith_studio.ui.widgets.fields import (
    ChoiceBox,
    ElidedCheckBox,
    NumberSlider,
    NumberSpec,
    decimal_field,
    whole_field,
)
from regolith_studio.ui.widgets.forms import LARGEST_NUMBER, SettingsForm, on_change
from regolith_studio.ui.widgets.labels import (
    ElidedLabel,
    FixedHeightText,
    heading,
    hint_label,
    rich_symbol,
    short_number,
)
from regolith_studio.ui.widgets.plots.bars import SpectrumEditor
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

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
    requestChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("model_source")
        self.source = ChoiceBox("model_source", tr("Source of the model"), (), capital=False)
        labels = {key: model.label for key, model in MODELS.items()}
        self.model = ChoiceBox("model_model", tr("Kind of model"), labels, capital=False)
        self.l_max = NumberSlider(L_MAX)
        half, tip = (
            tr("Fit to a half"),
            tr("The other half is then unknown to the model, as in its evaluation."),
        )
        self.half = named(ElidedCheckBox(tr("Fit to a random half only")), "model_half", half, tip)
        self.open = named(QPushButton(tr("Open …")), "model_open", tr("Open …"))
        self.fit = named(QPushButton(tr("Fit the model")), "model_fit", tr("Fit the model"))
        self.summary, self.findings = hint_label(), hint_label()
        self.forms = {key: SettingsForm(model.Settings, without=("l_max",)) for key, model in MODELS.items()}
        self._forms = QStackedWidget()
        self._configure()
        self._place()
        self.source.currentIndexChanged.connect(lambda _: self.sourceChanged.emit(self.source.value()))
        self.model.currentIndexChanged.connect(lambda _: self._show_model())
        forms = (form.edited for form in self.forms.values())
        for changed in (self.half.toggled, self.l_max.valueChanged, *forms):
            changed.connect(lambda *_: self.requestChanged.emit())
        self._show_model()

    def set_sources(self, sources: Mapping[str, str]) -> None:
        """Set the sources by key; the selection stays if possible."""
        chosen = self.source.value()
        self.source.offer(sources)
        if self.source.value() != chosen:
            self.sourceChanged.emit(self.source.value())

    def choose_source(self, key: str) -> None:
        self.source.choose(key)

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
            self.model.choose(brings_model)
        self.fit.setText(tr("Use the model") if brings_model else tr("Fit the model"))
        self.l_max.setEnabled(brings_model in ("", LOG_FIELD))
        self.l_max.slider.setMaximum(max_degree)
        self.l_max.field.setMaximum(max_degree)

    def value(self) -> dict[str, Any]:
        """Source, model, degree, half, and the modified settings of each model."""
        return {
            "source": self.source.value(),
            "model": self.model.value(),
            "l_max": int(self.l_max.value()),
            "half": self.half.isChecked(),
            "settings": {key: form.value() for key, form in self.forms.items() if form.value()},
        }

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices; unknown names are ignored."""
        self.source.choose(value.get("source"))
        self.model.choose(value.get("model"))
        self.l_max.setValue(int(value.get("l_max", default_degree(DEFAULT_MODEL))))
        self.half.setChecked(bool(value.get("half", False)))
        for key, form in self.forms.items():
            form.setValue(dict(value.get("settings", {})).get(key, {}))

    def _show_model(self) -> None:
        key = self.model.value()
        self.l_max.setValue(default_degree(key))
        self.summary.setText(tr(MODELS[key].summary))
        self._forms.setCurrentWidget(self.forms[key])
        for each, form in self.forms.items():
            form.setVisible(each == key)
        self.requestChanged.emit()

    def _configure(self) -> None:
        for form in self.forms.values():
            self._forms.addWidget(form)
        self.model.choose(DEFAULT_MODEL)
        self.l_max.setValue(default_degree(DEFAULT_MODEL))
        self.l_max.field.setObjectName("model_l_max")

    def _place(self) -> None:
        vbox(
            heading(tr("Sample or material")),
            hbox((self.source, 1), self.open),
            FixedHeightText((self.findings,)),
            8,
            heading(tr("Model")),
            self.model,
            FixedHeightText((self.summary,)),
            *(self.l_max, self._forms, self.half, self.fit),
            parent=self,
        )


class DrawControls(QWidget):
    """Number, seed and sizes of the drawn particles."""

    requestChanged = Signal()  # noqa: N815
    namesChanged = Signal(tuple)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("model_draw")
        self.number = whole_field("model_number", tr("Number of particles"), 1, MAX_DRAWN, 100)
        self.seed = whole_field("model_seed", tr("Seed of the draws"), 0, LARGEST_NUMBER)
        limited = QCheckBox(tr("Limit the equivalent radius"))
        self.limited = named(limited, "model_limited", tr("Limit the sizes"))
        range_ = 1e-3, 1e9
        spoken = tr("Smallest equivalent radius"), tr("Largest equivalent radius")
        self.smallest = decimal_field("model_smallest", spoken[0], *range_, 1.0, " µm", 3)
        self.largest = decimal_field("model_largest", spoken[1], *range_, 100.0, " µm", 3)
        captions = tr("Particles"), tr("r_eq [µm]")
        self.card = ResultView("model_drawn", captions, tr("Draw"), tr("Draw again"))
        self.card.caption(1, rich_symbol(captions[1]), tr("Smallest and largest equivalent radius"))
        self.card.reserve(1, "0.00 – 00.0")
        self.draw = self.card.button
        self.adopt = named(
            QPushButton(tr("Use as population")),
            "model_adopt",
            tr("Use the drawn particles as population"),
            tr("Open the drawn particles: to be coarsened and made a dataset."),
        )
        self.names = named(
            QLineEdit(),
            "model_names",
            tr("Names of the components, the most numerous first"),
            tr("Names of the components, separated by commas, the most numerous first."),
        )
        self._names_label = QLabel(tr("Components"))
        self.number.setGroupSeparatorShown(True)
        for field in (self.smallest, self.largest):
            field.setMinimumWidth(80)
        self._place()
        self.names.editingFinished.connect(self._rename)
        self.limited.toggled.connect(self._limit)
        fields = (self.number, self.seed, self.limited, self.smallest, self.largest)
        on_change(fields, self.requestChanged.emit)
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
        missing = tr("No particle is open: open some, or choose a material.")
        self.card.set_startable("" if source else missing)
        self.adopt.setEnabled(drawn)

    def value(self) -> dict[str, Any]:
        """Number, seed and range of sizes."""
        bounds = [self.smallest.value(), self.largest.value()] if self.limited.isChecked() else None
        return {"n": self.number.value(), "seed": self.seed.value(), "size_range": bounds}

    def setValue(self, value: Mapping[str, Any]) -> None:
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

    def _place(self) -> None:
        form = QFormLayout()
        form.addRow(tr("Particles"), self.number)
        form.addRow(tr("Seed"), self.seed)
        parts = QFormLayout()
        parts.addRow(self._names_label, self.names)
        vbox(
            heading(tr("Virtual particles")),
            form,
            self.limited,
            hbox((self.smallest, 1), (self.largest, 1)),
            self.card,
            self.adopt,
            parts,  # last, because only mixtures have them
            parent=self,
        )


def request_from(
    source: Mapping[str, Any], drawing: Mapping[str, Any], brings_model: str
) -> GenerationRequest:
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


WEIGHTINGS = {
    "number": N_("Each particle counts equally"),
    "volume": N_("Particles count by their volume"),
}
WAITING = N_("Draw particles: their distributions appear here, over those of the measured ones.")
SHARE = N_("Share at or below [%]")


ALL = "all"
"""Key of the small plots of all descriptors."""


class DistributionsPanel(QWidget):
    """Cumulative distributions as step functions: of all descriptors beside each other, or of one."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("model_distributions")
        labels = {ALL: N_("All descriptors")} | {key: CATALOGUE[key].label for key in KEYS}
        self.key = ChoiceBox("model_distribution_of", tr("Descriptor"), labels)
        self.weighting = ChoiceBox(
            "model_distribution_weighting", tr("Weighting of the particles"), WEIGHTINGS
        )
        self.plot = CurvePlot("", tr(SHARE), tr(WAITING))
        self.small = {key: CurvePlot(_axis_label(key), tr(SHARE), "") for key in KEYS}
        self._together = QWidget()
        grid = QGridLayout(self._together)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(0)
        for place, plot in enumerate(self.small.values()):
            grid.addWidget(plot, place // 3, place % 3)
        self.words, self.assessment = ElidedLabel(role="hint"), ElidedLabel(role="hint")
        self.table = StudyTableView("model_draws_in_noise", tr("Distances of the draws"))
        self.weighting.setMinimumContentsLength(26)
        self._compared: DistributionComparison | None = None
        layout = vbox(hbox(self.key, self.weighting, STRETCH, margins=(8, 6, 8, 0), spacing=10), parent=self)
        for label in (self.words, self.assessment):
            below = hbox(label, margins=(8, 0, 8, 0))
            layout.addLayout(below)
        self._one = side_by_side([self.plot, self.table], [500, 400], stretch=0)
        self._one.setObjectName("model_distribution_parts")
        layout.addWidget(self._one, 1)
        layout.addWidget(self._together, 1)
        for box in (self.key, self.weighting):
            box.currentIndexChanged.connect(lambda _: self._show())
        self.show_compared(None)

    def show_waiting(self) -> None:
        """Say that the particles have been drawn and are being compared."""
        self._placeholder = tr("The particles are being measured: their distributions appear here.")
        self._compared = None
        self._show()

    def show_compared(self, compared: DistributionComparison | None) -> None:
        """Draw other distributions, or none."""
        self._placeholder = tr(WAITING)
        self._compared = compared = compared if compared is not None and len(compared.drawn) else None
        measured = compared is not None and len(compared.measured) > 0
        self.assessment.setText(translate(compared.assessment()) if compared is not None and measured else "")
        self.assessment.setVisible(measured)
        comparable = compared is not None and compared.comparable
        self.table.setVisible(comparable)
        if compared is not None and comparable:
            self.table.show_table(compared.table())
        self._show()

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        self._show()

    def _show(self) -> None:
        together = self.key.value() == ALL and self._compared is not None
        self._together.setVisible(together)
        self._one.setVisible(not together)
        self.words.setVisible(not together)
        if self._compared is None:
            self.plot.set_curves([])
            self.plot.set_empty(True, self._placeholder)
            self.words.setText("")
        elif together:
            for key, plot in self.small.items():
                plot.set_curves(self._curves(key)[0])
        else:
            row = CATALOGUE[self.key.value()]
            self.plot.set_labels(f"{tr(row.label)} {_axis_label(row.key)}", tr(SHARE))
            curves, measured, drawn = self._curves(row.key)
            self.plot.set_curves(curves)
            self.words.setText(distance_text(measured, drawn, row.unit_symbol))

    def _curves(self, key: str) -> tuple[list[PlotCurve], Distribution | None, Distribution]:
        """Curves and distributions of the measured particles, where there are any, and of the drawn ones."""
        assert self._compared is not None, "particles are drawn"
        measured, drawn = self._compared.distributions(key, self.weighting.value())
        theme = self.plot.theme
        curves = [_step_curve(tr("{count:,} drawn", count=len(drawn.values)), theme.fit, drawn)]
        if measured is not None:
            label = tr("{count:,} measured", count=len(measured.values))
            curves.insert(0, _step_curve(label, theme.particle, measured))
        return curves, measured, drawn


def _axis_label(key: str) -> str:
    row = CATALOGUE[key]
    return f"{rich_symbol(row.symbol)}{row.unit_suffix}"


def distance_text(measured: Distribution | None, drawn: Distribution, unit: str = "") -> str:
    """Distances and means of two distributions as text, with values in `unit`."""
    if measured is None:
        return tr("The source holds no measured particles.")
    apart = wasserstein_1(measured, drawn) / measured.mean
    return tr(
        "Wasserstein distance {apart:.1%} of the mean, Kolmogorov-Smirnov distance {gap:.2f}; "
        "means {measured} measured, {drawn} drawn",
        apart=apart,
        gap=kolmogorov_smirnov_distance(measured, drawn),
        measured=f"{short_number(measured.mean)} {unit}".rstrip(),
        drawn=f"{short_number(drawn.mean)} {unit}".rstrip(),
    )


def _step_curve(label: str, colour: str, spread: Distribution) -> PlotCurve:
    x = np.repeat(spread.values, 2)
    y = np.concatenate([[0.0], np.repeat(np.cumsum(spread.weights), 2)[:-1]])
    return PlotCurve(label, colour, tuple(x), tuple(100.0 * y))


NO_MODEL = N_("The spectrum appears when a model is fitted.")


class LiveShape(QWidget):
    """Spectrum editor and a view of one drawn particle."""

    def __init__(self, view: SceneView) -> None:
        super().__init__()
        self.spectrum = named(SpectrumEditor(tr(NO_MODEL)), "model_spectrum")
        self.frame = ViewFrame(view, "drawn", colour="fit")
        self.reset, self.another = QPushButton(tr("Reset the spectrum")), QPushButton(tr("Another particle"))
        self.reset.setObjectName("model_reset_spectrum")
        self.another.setObjectName("model_another")
        left = QWidget()
        vbox((self.spectrum, 1), hbox(self.reset, STRETCH, self.another), parent=left)
        hbox(
            (framed(left), 3),
            (self.frame, 2),
            parent=self,
        )
        self._framed = False
        self.show_mesh(None)

    def show_mesh(self, mesh: Mesh | None, detail: str = "", again: bool = False) -> None:
        """Show a drawn particle.

        ``detail``: second line of the view's title. ``again``: whether to fit the view, because it is
        another particle.
        """
        self.another.setEnabled(mesh is not None)
        self.reset.setEnabled(self.spectrum.is_changed())
        self.frame.set_texts(tr("A drawn particle"), detail)
        view = self.frame.view
        if mesh is None:
            view.draw(surfaces.clear)
            self._framed = False
            return
        view.draw(lambda plotter: surfaces.show_fit(plotter, mesh))
        if again or not self._framed:
            size = view.widget.size()
            view.set_pose(framing_pose(mesh.vertices, "isometric", size.width() / max(size.height(), 1)))
            self._framed = True


BAR_LINES = 3.4
"""Height of the scale bar with its text, from the lower edge of a view, in units of the font."""


class ShapeGallery(QWidget):
    """Measured particles above drawn ones."""

    def __init__(self, view: SceneView) -> None:
        super().__init__()
        self.frame = ViewFrame(view, "gallery", colour="particle")
        vbox(self.frame, parent=self)
        self._shown: tuple[tuple[Mesh, ...], tuple[Mesh, ...]] = ((), ())
        self.show_shapes((), ())

    def show_shapes(self, measured: tuple[Mesh, ...], drawn: tuple[Mesh, ...]) -> None:
        words = {
            (True, True): tr("measured above, drawn below"),
            (True, False): tr("measured; draw particles to compare"),
            (False, True): tr("drawn; the source holds no measured particles"),
            (False, False): tr("empty until a model is fitted"),
        }
        self.frame.set_texts(tr("Gallery"), words[bool(measured), bool(drawn)])
        self._shown = (measured, drawn)
        self.frame.view.draw(lambda plotter: show_gallery(plotter, measured, drawn))
        self._frame()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._frame()

    def _frame(self) -> None:
        view = self.frame.view
        width, height = view.widget.width(), view.widget.height()
        foot = min(BAR_LINES * self.fontInfo().pixelSize() / max(height, 1), 0.5)
        view.set_pose(gallery_pose(*self._shown, width / max(height, 1), foot))
