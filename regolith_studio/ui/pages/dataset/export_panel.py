"""Export to DEM programs: formats and settings, what formats lose, and the list of written exports."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices, QGuiApplication
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QCheckBox,
    QFormLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import PARTS, RECORD, ExportOptions, ExportResult, load_command
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.lifting_cylinder import MANY_PARTICLES, CylinderFilling, cylinder_filling
from regolith_studio.dataset.parameters import (
    NOT_GIVEN,
    ContactParameters,
    ExportSettings,
    LiftingCylinderTest,
    ScriptTimes,
)
from regolith_studio.dataset.size_distributions import ShapeClass
from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.session.project import fingerprint
from regolith_studio.session.recipe import Exports
from regolith_studio.settings import settings_in
from regolith_studio.ui.layout import STRETCH, Collapsible, hbox, named, vbox
from regolith_studio.ui.result_card import ResultRecord, ResultState, ResultView
from regolith_studio.ui.translation import Markup, inert, number_text, rich, tr
from regolith_studio.ui.widgets.fields import ElidedCheckBox, NumberSlider, NumberSpec
from regolith_studio.ui.widgets.forms import ParameterForm
from regolith_studio.ui.widgets.labels import ElidedLabel, WrappedLabel, heading, hint_label
from regolith_studio.ui.widgets.presets import PresetForm

FIRST = ("rocky", "yade")
GROUPS = (N_("Exact polyhedra"), N_("Clumps and rounded shapes"), N_("For viewers and own programs"))
NARROW = 84
COARSE_GRAINING = NumberSpec(
    "",
    N_("Coarse-graining factor"),
    1,
    20,
    0.01,
    limit=1000,
    tip=N_("1 keeps the size of the particles; 10 makes them ten times larger."),
)
PARTICLES = NumberSpec(
    "", N_("Particles drawn"), 1, 5000, limit=1_000_000, tip=N_("For formats that list single bodies.")
)


class ExportPanel(QWidget):
    """Check boxes of the formats, and the settings that they share."""

    exportRequested = Signal()  # noqa: N815
    chosenChanged = Signal()  # noqa: N815
    optionsChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self._reason, self._compounds = "", False
        self._fill: Callable[[ExportOptions], CylinderFilling] | None = None
        self.setObjectName("dataset_targets")
        self.boxes = {key: self._box(key) for key in EXPORTERS}
        self.coarse_graining, self.particles = NumberSlider(COARSE_GRAINING), NumberSlider(PARTICLES)
        self.coarse_graining.field.setObjectName("dataset_coarse_graining")
        self.coarse_graining.step_by(1)
        self.particles.field.setObjectName("dataset_particles")
        self.contact = PresetForm(ContactParameters, "export_contact", tr("Published contact parameters"))
        self.test = PresetForm(LiftingCylinderTest, "export_test", tr("Published cylinder"))
        self.times = ParameterForm(ScriptTimes, "export")
        self.lossy = named(QCheckBox(tr("Change shapes where needed")), "dataset_lossy")
        self.export = named(QPushButton(tr("Export …")), "dataset_export")
        form = QFormLayout()
        form.addRow(tr("Coarse graining"), self.coarse_graining)
        form.addRow(tr("Particles drawn"), self.particles)
        parts = (self.contact, self.test, self.times, hint_label(f"* {tr(NOT_GIVEN)}"))
        for field in (field for part in parts for field in part.findChildren(QAbstractSpinBox)):
            field.setMinimumWidth(NARROW)  # its own would have room for the largest number
        formats = [
            part
            for title, keys in groups().items()
            for part in (hint_label(tr(title)), *(self.boxes[key] for key in keys))
        ]
        self.first = self.boxes[next(iter(groups().values()))[0]]
        more = Collapsible(tr("Material and cylinder"), *parts)
        vbox(heading(tr("4  Export to")), *formats, form, more, parent=self, spacing=4)
        self.foot = QWidget()
        """Belongs below the scrolled column: the button stays in sight however many formats there are."""
        self.preview = named(WrappedLabel(), "dataset_preview", role="hint")
        self.enlarge = named(QPushButton(), "dataset_enlarge")
        self.enlarge.hide()
        vbox(self.preview, self.enlarge, self.lossy, self.export, parent=self.foot, margins=(4, 6, 12, 10))
        self.coarse_graining.setValue(1)
        self.particles.setValue(200)
        for slider in (self.coarse_graining, self.particles):
            slider.valueChanged.connect(lambda _: self.optionsChanged.emit())
        for part in PARTS:
            getattr(self, part).valueChanged.connect(self.optionsChanged)
        self.lossy.toggled.connect(lambda _: self._show())
        self.export.clicked.connect(self.exportRequested)
        self.enlarge.clicked.connect(self._take_sufficient_factor)
        self.optionsChanged.connect(self._show_preview)
        self.setValue({"targets": FIRST})

    def show_filling(self, fill: Callable[[ExportOptions], CylinderFilling] | None) -> None:
        """State how many particles a script will simulate, by a function of the options."""
        self._fill = fill
        self._show_preview()

    def _show_preview(self) -> None:
        filling = [key for key in self.chosen() if EXPORTERS[key].fills_mass]
        lines, too_many = [], False
        if filling and self._fill is not None:
            found = self._fill(self.options())
            too_many = found.n_particles > MANY_PARTICLES
            lines.append(_filling_text(tr(EXPORTERS[filling[0]].label), found))
            factor = number_text(found.sufficient_factor, "g")
            self.enlarge.setText(tr("Export with coarse graining {factor} …", factor=factor))
            self._sufficient = found.sufficient_factor
        if len(filling) < len(self.chosen()) and self._fill is not None:
            count = number_text(int(self.particles.value()), ",")
            lines.append(tr("Other formats: {count} particles drawn.", count=count))
        self.preview.setText("\n".join(lines))
        self.preview.setVisible(bool(lines))
        self.enlarge.setVisible(too_many)

    def _take_sufficient_factor(self) -> None:
        self.coarse_graining.setValue(self._sufficient)
        self.optionsChanged.emit()
        self.exportRequested.emit()

    def chosen(self) -> tuple[str, ...]:
        return tuple(key for key, box in self.boxes.items() if box.isChecked())

    def options(self) -> ExportOptions:
        return ExportOptions(
            coarse_graining_factor=float(self.coarse_graining.value()),
            n_particles=int(self.particles.value()),
            contact=self.contact.value(),
            test=self.test.value(),
            times=self.times.value(),
        )

    def consent(self) -> bool:
        """Whether the user allows formats that change shapes."""
        return self.lossy.isChecked()

    def set_ready(self, reason: str, compounds: bool = False) -> None:
        """Set why nothing can be exported, or nothing, and whether the dataset holds compounds."""
        self._reason, self._compounds = reason, compounds
        self._show()

    def value(self) -> dict[str, Any]:
        """Plain JSON."""
        return {
            "targets": list(self.chosen()),
            "coarse_graining": float(self.coarse_graining.value()),
            "particles": int(self.particles.value()),
            "lossy": self.consent(),
            **{part: getattr(self, part).changes() for part in PARTS},
        }

    def recipe_part(self) -> Exports | None:
        """The fields of a recipe; ``None`` if the export is not possible."""
        if not self.chosen() or not self._allowed() or self.refusing():
            return None
        options = self.options()
        return Exports(
            **settings_in(ExportSettings, options),
            targets=list(self.chosen()),
            seed=options.seed,
            settings={name: x for part in PARTS for name, x in getattr(self, part).changes().items()},
            lossy=self.consent(),
        )

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Tick these; unknown names are ignored."""
        wanted = set(value.get("targets", FIRST))
        for key, box in self.boxes.items():
            box.setChecked(key in wanted)
        self.coarse_graining.setValue(float(value.get("coarse_graining", 1.0)))
        self.particles.setValue(int(value.get("particles", 200)))
        self.lossy.setChecked(bool(value.get("lossy", False)))
        changes: dict[str, Any] = {}
        for part in PARTS:
            changes |= value.get(part, {})
        for part in PARTS:
            with suppress(InputError):
                getattr(self, part).restore(changes)
        self._show()

    def show_recipe(self, recipe: Exports) -> None:
        every = tuple(EXPORTERS) if "all" in recipe.targets else recipe.targets
        chosen = {
            "targets": every,
            "coarse_graining": recipe.coarse_graining_factor,
            "particles": recipe.n_particles,
        }
        self.setValue(chosen | {"lossy": recipe.lossy, PARTS[0]: recipe.settings})

    def _box(self, key: str) -> QCheckBox:
        exporter = EXPORTERS[key]
        box = named(ElidedCheckBox(tr(exporter.label)), f"dataset_to_{key}")
        lines = [
            tr(exporter.label),
            tr("Contains: {what}", what="; ".join(map(tr, exporter.carries))),
            tr("Does not contain: {what}", what="; ".join(map(tr, exporter.loses))),
        ]
        lines += [tr("Shapes are changed: {how}", how=tr(exporter.alters))] if exporter.alters else []
        if exporter.convex_only:
            lines.append(tr("Not for compounds: {why}", why=tr(exporter.convex_only)))
        box.setToolTip("\n".join([*lines, tr("Units: {units}", units=tr(exporter.units))]))
        box.toggled.connect(lambda _: self._show())
        return box

    def _allowed(self) -> bool:
        """Whether no selected format changes shapes, or the user allows it."""
        return self.consent() or not any(EXPORTERS[key].alters for key in self.chosen())

    def _show(self) -> None:
        altering = [key for key in self.chosen() if EXPORTERS[key].alters]
        self.lossy.setEnabled(bool(altering))
        problem = self._reason
        if not problem and (refusing := self.refusing()):
            problem = tr(
                "{label} cannot hold the compounds of this dataset: {why}",
                label=tr(EXPORTERS[refusing[0]].label),
                why=tr(EXPORTERS[refusing[0]].convex_only),
            )
        elif not problem and not self._allowed():
            problem = f"{tr(EXPORTERS[altering[0]].label)}: {tr(EXPORTERS[altering[0]].alters)}"
        for button in (self.export, self.enlarge):
            button.setEnabled(not problem)
            button.setToolTip(inert(problem))
        self._show_preview()
        self.chosenChanged.emit()

    def refusing(self) -> list[str]:
        """Keys of the selected formats that cannot hold the dataset's compounds."""
        return [key for key in self.chosen() if self._compounds and EXPORTERS[key].convex_only]


def groups() -> dict[str, list[str]]:
    """Keys of the formats below the title of their group."""
    found: dict[str, list[str]] = {title: [] for title in GROUPS}
    exact, approximate, general = found.values()
    for key, each in EXPORTERS.items():
        (general if each.general else approximate if each.alters else exact).append(key)
    return found


def _filling_text(label: str, found: CylinderFilling) -> str:
    """Number, mass and size of the particles that a script simulates, and what to do about too many."""
    text = tr(
        "{label}: {count} particles, {mass} g, d50 {size} µm.",
        label=label,
        count=number_text(round(found.n_particles), ","),
        mass=number_text(1e3 * found.mass, ".3g"),
        size=number_text(found.median_diameter, ".3g"),
    )
    if found.n_particles <= MANY_PARTICLES:
        return text
    return text + " " + tr("More than {limit} are too many.", limit=number_text(MANY_PARTICLES, ","))


class LossesLabel(QScrollArea):
    """Describes what the selected formats lose."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_losses")
        self.setAccessibleName(tr("Limits of the formats"))
        self.setWidgetResizable(True)
        self.setProperty("role", "texts")
        self.label = hint_label()
        self.label.setTextFormat(Qt.TextFormat.RichText)
        self.label.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.label.setContentsMargins(8, 6, 8, 6)
        self.setWidget(self.label)
        for ground in (self.viewport(), self.label):
            ground.setAutoFillBackground(False)  # that of the tab is seen

    def show_formats(self, keys: Sequence[str], refusing: Sequence[str] = ()) -> None:
        """Describe other formats; those `refusing` cannot hold the dataset."""
        lines = []
        for key in keys:
            each = EXPORTERS[key]
            changed = (
                "<br>" + tr("<b>Shapes are changed:</b> {how}", how=tr(each.alters)) if each.alters else ""
            )
            if key in refusing:
                changed += "<br>" + tr("<b>Not for compounds:</b> {why}", why=tr(each.convex_only))
            lost = "; ".join(map(tr, each.loses))
            lines.append(
                "<p>"
                + tr("<b>{label}</b> does not contain: {lost}.", label=tr(each.label), lost=lost)
                + changed
                + "<br>"
                + rich(tr("Units: {units}", units=tr(each.units)))
                + ".</p>"
            )
        self.label.setText(
            Markup("".join(lines)) or tr("Select a format to see what its files do not contain.")
        )


class DatasetCard(ResultView):
    """What has been written; it says that something is being written, whatever record it is given then."""

    def __init__(self) -> None:
        captions, export = (tr("Representatives"), tr("Formats written")), tr("Export …")
        super().__init__("dataset_result", captions, export, done=tr("Open the folder"))
        self._target = ""

    def begin(self, target: Path) -> None:
        """Show that something is being written there, until `end`."""
        self._target = str(target)
        self.show_task(None)
        self.show_record(self.record)

    def end(self) -> None:
        self._target = ""

    def show_record(self, record: ResultRecord) -> None:
        if self._target:
            record = replace(record, state=ResultState.RUNNING, note=self._target)
        super().show_record(record)


def filling_of(
    dataset: Dataset | None, classes: Sequence[ShapeClass], options: ExportOptions, *, by_volume: bool
) -> CylinderFilling:
    """The particles that fill a cylinder: of a dataset, else of classes that one is to have.

    `by_volume`: the weights of the classes are shares of the volume, not of the number.
    """
    if dataset is not None:
        sizes = [one.sizes for one in dataset.representatives]
        return cylinder_filling(dataset.class_weights("number").tolist(), sizes, options)
    weights = np.array([one.weight for one in classes])
    if by_volume:
        weights /= [one.sizes.mean_cube() for one in classes]
    return cylinder_filling(weights.tolist(), [one.sizes for one in classes], options)


def entry_of(export: ExportResult) -> dict[str, str]:
    """What a project keeps of an export."""
    record = fingerprint(export.folder / RECORD)
    return {"key": export.key, "folder": str(export.folder), "fingerprint": record}


def export_of(entry: Mapping[str, str], dataset: Dataset) -> ExportResult | None:
    """The export that an entry of a project names, if it is as it was."""
    key, folder = entry["key"], Path(entry["folder"])
    if key not in EXPORTERS or not fingerprint(folder / RECORD) == entry["fingerprint"] != "":
        return None
    return ExportResult(key, folder, (), load_command(EXPORTERS[key], folder, dataset))


class ExportsList(QWidget):
    """One row for each export that was written: where it is and how to load it."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_exports")
        self._rows = QVBoxLayout()
        self._empty = hint_label(tr("What has been exported is listed here, with the command that loads it."))
        vbox(self._empty, self._rows, STRETCH, parent=self, margins=(8, 6, 8, 6))
        self._exports: tuple[ExportResult, ...] = ()

    @property
    def exports(self) -> tuple[ExportResult, ...]:
        return self._exports

    def show_exports(self, exports: Sequence[ExportResult]) -> None:
        self._exports = tuple(exports)
        while (item := self._rows.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.deleteLater()
        self._empty.setVisible(not exports)
        for one in exports:
            self._rows.addWidget(self._row(one))

    def _row(self, one: ExportResult) -> QWidget:
        row = QWidget()
        name = QLabel(tr(EXPORTERS[one.key].label) if one.key in EXPORTERS else one.key)
        name.setMinimumWidth(190)
        look, copy = QPushButton(tr("Open folder")), QPushButton(tr("Copy load command"))
        look.setObjectName(f"dataset_open_{one.key}")
        copy.setObjectName(f"dataset_copy_{one.key}")
        look.clicked.connect(lambda: QDesktopServices.openUrl(QUrl.fromLocalFile(str(one.folder))))
        copy.clicked.connect(lambda: QGuiApplication.clipboard().setText(one.load_command))
        hbox(name, (ElidedLabel(one.load_command, role="hint"), 1), copy, look, parent=row)
        return row
