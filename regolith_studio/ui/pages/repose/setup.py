"""Set-up of a simulation: dataset, number of particles, Tables 1 and 2, engines, evaluation, limits."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QFormLayout,
    QFrame,
    QLabel,
    QPushButton,
    QWidget,
)

from regolith_studio.dataset.parameters import (
    DRUM,
    GRAVITIES,
    PAPER_COARSE_GRAINING,
    ContactParameters,
    DrumRotation,
    LiftingCylinderTest,
)
from regolith_studio.dem.angle_of_repose import RELIABLE_N
from regolith_studio.dem.case import ReposeCase
from regolith_studio.dem.engines import CAPABILITY_LABELS, ENGINES, engine_named, engine_rows
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.errors import InputError
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.jobs.runners.process_pool import cores
from regolith_studio.messages import N_
from regolith_studio.ui.layout import STRETCH, Collapsible, hbox, named, vbox
from regolith_studio.ui.pages.repose.runs import duration_text
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import Markup, number_text, rich, tr, translate
from regolith_studio.ui.widgets.fields import choice, decimal_field, whole_field
from regolith_studio.ui.widgets.forms import (
    LARGEST_NUMBER,
    SettingsForm,
    enter_values,
    field_values,
    on_change,
)
from regolith_studio.ui.widgets.labels import ElidedLabel, heading, hint_label
from regolith_studio.ui.widgets.presets import PresetForm
from regolith_studio.ui.widgets.text_table import TextTable

RELIABLE_ACROSS = 20.0
"""Particles across the cylinder from which walls and single particles do not matter."""
TOLERANCE = 2.0
"""Factor from the recommended value within which a value is doubtful, and beyond which it is bad."""
ROWS = (
    (N_("{value} across the diameter (≥ {limit})"), ".1f", RELIABLE_ACROSS, False),
    (N_("{value} particles (≥ {limit})"), ",", float(RELIABLE_N), False),
    (
        N_("{value} × particle size (paper: {limit})"),
        ".0f",
        PAPER_COARSE_GRAINING,
        True,
    ),
)
"""Text, format of the value, recommended value, and whether that is a maximum."""


@dataclass(frozen=True)
class CaseScale:
    """Numbers of a case that limit its answer; `None` where they are not known, as of imported positions."""

    n_particles: int
    across: float | None = None
    coarse_graining: float | None = None

    def values(self) -> tuple[float | None, ...]:
        """In the order of :data:`ROWS`."""
        return self.across, self.n_particles, self.coarse_graining

    def sufficient_number(self, place: int) -> int:
        """Number of particles of the same mass, with two digits, at which a value is as recommended."""
        value = self.values()[place]
        assert value is not None, "a value that is not known is not shown"
        ratio = value / ROWS[place][2] if ROWS[place][3] else ROWS[place][2] / value
        number = self.n_particles * (ratio if place == 1 else ratio**3)
        step = 10.0 ** (math.floor(math.log10(number)) - 1)
        return int(step * math.ceil(round(number / step, 6)))


class LimitsStrip(QWidget):
    """Three values with their state, and a button where a larger number of particles would mend it."""

    runRequested = Signal(int)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("repose_limits")
        self._scale: CaseScale | None = None
        self._theme = current_theme()
        row = hbox(parent=self, spacing=8)
        self.lights = tuple(QLabel("●") for _ in ROWS)
        self.texts = tuple(ElidedLabel() for _ in ROWS)
        self.buttons = tuple(QPushButton() for _ in ROWS)
        self._boxes: list[QBoxLayout] = []
        for place, (light, text, button) in enumerate(
            zip(self.lights, self.texts, self.buttons, strict=True)
        ):
            frame = named(QFrame(), role="card")
            box = QBoxLayout(QBoxLayout.Direction.LeftToRight, frame)
            box.setContentsMargins(8, 3, 6, 3)
            box.addLayout(hbox(light, (text, 1)), 1)
            box.addWidget(button)
            self._boxes.append(box)
            button.setObjectName(f"repose_limit_{place}")
            button.clicked.connect(lambda _=False, place=place: self._ask(place))
            row.addWidget(frame, 1)
        self.show_scale(None)

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self._colour()
        self._arrange()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if event.oldSize().width() != event.size().width():
            self._arrange()

    def _arrange(self) -> None:
        """Put the buttons beside the texts, or below where that leaves one of them too little room."""
        room = self.width() / len(ROWS) - 8
        needed = (
            text.fontMetrics().horizontalAdvance(text.text()) + button.sizeHint().width()
            for text, button in zip(self.texts, self.buttons, strict=True)
            if not button.isHidden()
        )
        below = max(needed, default=0) + 3 * self.lights[0].sizeHint().width() + 14 > room
        directions = QBoxLayout.Direction.LeftToRight, QBoxLayout.Direction.TopToBottom
        for box in self._boxes:
            box.setDirection(directions[below])

    def show_scale(self, scale: CaseScale | None, seconds: Callable[[int], float] | None = None) -> None:
        """Show the values of a case.

        ``seconds``: estimated time of a run with a number of particles; without it there are no buttons.
        """
        self._scale = scale
        values = (None,) * len(ROWS) if scale is None else scale.values()
        for place, (value, (text, form, limit, _)) in enumerate(zip(values, ROWS, strict=True)):
            limits = number_text(limit, ",.0f")
            number = "–" if value is None else number_text(value, form)
            self.texts[place].setText(tr(text, value=number, limit=limits))
            self._offer(place, seconds if value is not None and self._level(place) else None)
        self._colour()
        # back beside them only at another width: else the page would move with each case
        if self._boxes[0].direction() == QBoxLayout.Direction.LeftToRight:
            self._arrange()

    def _offer(self, place: int, seconds: Callable[[int], float] | None) -> None:
        button = self.buttons[place]
        button.setVisible(seconds is not None)
        if seconds is None or self._scale is None:
            return
        number = self._scale.sufficient_number(place)
        possible = number <= MAX_PARTICLES
        button.setEnabled(possible)
        count = number_text(number, ",")
        if possible:
            button.setText(tr("Run with {count}: {time}", count=count, time=duration_text(seconds(number))))
            button.setToolTip(
                tr("A run with {count} particles, with all other values as in the set-up", count=count)
            )
        else:
            button.setText(tr("{count} needed", count=count))
            button.setToolTip(
                tr("More than can be simulated here: take a smaller mass, or larger particles.")
            )

    def _level(self, place: int) -> int:
        """0 where a value is as recommended, 1 if it is doubtful, 2 if it is bad."""
        value = None if self._scale is None else self._scale.values()[place]
        if value is None:
            return 0
        _, _, limit, is_maximum = ROWS[place]
        ratio = value / limit if is_maximum else limit / value
        return int(ratio > 1.0) + int(ratio > TOLERANCE)

    def _colour(self) -> None:
        colours = (self._theme.good, self._theme.doubtful, self._theme.bad)
        names = (tr("as recommended"), tr("doubtful"), tr("far from what is recommended"))
        known = (None,) * len(ROWS) if self._scale is None else self._scale.values()
        for place, light in enumerate(self.lights):
            level = self._level(place)
            colour = self._theme.border if known[place] is None else colours[level]
            light.setText(f'<span style="color:{colour}">●</span>')
            light.setAccessibleName("" if known[place] is None else names[level])
            light.setToolTip(light.accessibleName())

    def _ask(self, place: int) -> None:
        if self._scale is not None:
            self.runRequested.emit(self._scale.sufficient_number(place))


MAX_PARTICLES = 400_000
COLUMN_GAP = 24
"""Pixels between both columns of the set-up."""
PRESETS = {N_("Teaching"): 300, N_("Standard"): 1000, N_("Fine"): 5000}
SHAPES = {"polyhedra": N_("The dataset's polyhedra"), "spheres": N_("Spheres of the same volumes")}
APPARATUS = {"cylinder": N_("Lifting cylinder"), "drum": N_("Rotating drum")}
OF_DRUM = {
    name: (value, getattr(LiftingCylinderTest(), name))
    for name, value in vars(DRUM).items()
    if value != getattr(LiftingCylinderTest(), name)
}
"""Values of the usual drum and of the lifting cylinder, where they differ."""
KEPT = "kept"
FILLINGS = {KEPT: N_("Kept if equal, else new"), "": N_("New")}
COHESION = {
    "none": N_("None"),
    "given": N_("As given (experimental)"),
    "scaled": N_("Scaled with the size (experimental)"),
}


class SetupPanel(QWidget):
    """Edits the request of a simulation."""

    valueChanged = Signal()  # noqa: N815
    evaluationChanged = Signal()  # noqa: N815
    measuredChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("repose_setup")
        self._dataset: Path | None = None
        self._by_hand = False
        self.dataset_label = ElidedLabel(tr("No dataset yet"), elide=Qt.TextElideMode.ElideMiddle)
        self.dataset_note = hint_label()
        self.open_button = _button(tr("Open …"), "repose_open", tr("Choose a dataset folder"))
        self.sample_button = _button(
            tr("From open particles"), "repose_sample", tr("Coarsen the open particles first")
        )
        spoken = tr("Number of particles")
        self.particles = whole_field("repose_particles", spoken, 0, MAX_PARTICLES, PRESETS["Teaching"])
        self.particles.setSingleStep(100)
        self.particles.setKeyboardTracking(False)
        self.seed = whole_field("repose_seed", tr("Seed"), 0, LARGEST_NUMBER)
        self.shapes = choice("repose_shapes", tr("Shapes"), SHAPES)
        self.cohesion = choice("repose_cohesion", tr("Cohesion"), COHESION)
        labels = {key: engine.label for key, engine in ENGINES.items()}
        self.engine = choice("repose_engine", tr("Engine"), labels)
        places = {g: f"{tr(name)} ({number_text(g, 'g')} m/s²)" for name, g in GRAVITIES.items()}
        self.gravity = choice("repose_gravity_of", tr("Gravity of"), places | {0.0: N_("Other")})
        self._runs: tuple[Path, ...] = ()
        self.filling = choice("repose_filling", tr("Filling"), FILLINGS)
        self.filling.setToolTip(
            tr(
                "A filling of an earlier run is used again where dataset, number, cylinder, seed, friction "
                "and engine are the same; one that is chosen here also where the friction is another."
            )
        )
        self.apparatus = choice("repose_apparatus", tr("Test"), APPARATUS)
        self._fields: dict[str, QWidget] = {
            "apparatus": self.apparatus,
            "particles": self.particles,
            "seed": self.seed,
            "shapes": self.shapes,
            "cohesion": self.cohesion,
            "engine": self.engine,
        }
        self.drum = SettingsForm(DrumRotation, prefix="drum_")
        self.measured = decimal_field("repose_measured", tr("Measured dynamic angle"), 0.0, 90.0, 0.0, "°", 1)
        self.measured.setSpecialValueText(tr("None"))
        self.measured_error = decimal_field(
            "repose_measured_error", tr("Standard error"), 0.0, 45.0, 1.0, "°", 1
        )
        self.test = PresetForm(LiftingCylinderTest, "test", tr("Published cylinder"))
        self.contact = PresetForm(ContactParameters, "contact", tr("Published contact parameters"))
        self.evaluation = SettingsForm(EvaluationSettings)
        self._numerics = {key: SettingsForm(engine.Settings) for key, engine in ENGINES.items()}
        self.scaling_report = hint_label()
        self.scaling_report.setObjectName("repose_consequences")
        self.problem = hint_label(role="warning")
        self.problem.hide()
        self.dataset_note.hide()
        self._place()
        self._connect()

    @property
    def numerics(self) -> SettingsForm:
        return self._numerics[self.engine.value()]

    @property
    def dataset(self) -> Path | None:
        return self._dataset

    @property
    def by_hand(self) -> bool:
        """Whether the user has chosen the dataset among all folders, so that no later one replaces it."""
        return self._by_hand and self._dataset is not None

    def set_dataset(self, folder: Path | None, by_hand: bool = False) -> None:
        self._dataset, self._by_hand = folder, by_hand
        self.dataset_label.setText(str(folder) if folder else tr("No dataset yet"))
        self.dataset_note.setText(
            tr("Chosen here; a dataset that is made later does not replace it.")
            if self.by_hand
            else tr("The dataset that was made or opened last")
        )
        self.dataset_note.setVisible(folder is not None)
        self.valueChanged.emit()

    def set_fillings(self, folders: Sequence[Path]) -> None:
        """Offer the fillings of other runs; the chosen one stays if it is among them."""
        self._runs = tuple(folders)
        self.filling.offer(FILLINGS | {str(each): tr("Of {run}", run=each.name) for each in folders})

    def request(self) -> ReposeRequest:
        engine = engine_named(self.engine.value())
        case = ReposeCase(
            test=self.test.value(),
            contact=self.contact.value(),
            n_particles=self.particles.value(),
            shapes=self.shapes.value(),
            cohesion=self.cohesion.value(),
            seed=self.seed.value(),
            drum=DrumRotation(**self.drum.value()) if self.in_drum else None,
        )
        chosen = self.filling.value()
        return ReposeRequest(
            case,
            engine.key,
            engine.Settings(**self.numerics.value()),
            self.evaluation_settings(),
            threads=cores(),
            filling=Path(chosen) if chosen not in (KEPT, "") else None,
            kept=self._runs if chosen == KEPT else (),
        )

    def request_of_series(self) -> ReposeRequest:
        """Of studies and calibrations: each of their runs lifts a filling of its own."""
        if self.in_drum:
            raise InputError(N_("Studies and calibrations lift a cylinder: choose it as the test."))
        return replace(self.request(), filling=None, kept=())

    @property
    def in_drum(self) -> bool:
        """Whether the cylinder turns on its side."""
        return bool(self.apparatus.value() == "drum")

    def measured_angle(self) -> tuple[float, float] | None:
        """The user's own dynamic angle and its standard error in degrees, if one was entered."""
        return (self.measured.value(), self.measured_error.value()) if self.measured.value() else None

    def evaluation_settings(self) -> EvaluationSettings:
        return EvaluationSettings(**self.evaluation.value())

    def set_evaluation(self, **changes: Any) -> None:
        self.evaluation.setValue(self.evaluation.value() | changes)
        self.evaluationChanged.emit()

    def show_consequences(self, sentences: list[str], problem: str = "") -> None:
        """Show the scaling report of the values, or why they are invalid."""
        self.scaling_report.setText(Markup("<br>".join(map(rich, sentences))))
        self.problem.setText(translate(problem))
        self.problem.setVisible(bool(problem))

    def problem_of_run(self) -> str:
        """Why no run can be started with these values; empty if one can."""
        if self._dataset is None:
            return tr("There is no dataset yet: open or build one first.")
        return "" if self.problem.isHidden() else self.problem.text()

    def value(self) -> dict[str, Any]:
        """The values as plain JSON."""
        return {
            **field_values(self._fields),
            "drum": self.drum.value(),
            "measured": [self.measured.value(), self.measured_error.value()],
            "test": self.test.changes(),
            "contact": self.contact.changes(),
            "evaluation": self.evaluation.value(),
            "numerics": {key: form.value() for key, form in self._numerics.items()},
            "dataset": str(self._dataset) if self._dataset else None,
            "dataset_by_hand": self._by_hand,
        }

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show what :meth:`value` returned; invalid values are ignored."""
        self.apparatus.choose(value.get("apparatus"))  # first: it changes values of the test
        try:
            self.test.restore(value.get("test", {}))
            self.drum.setValue(value.get("drum", {}))
            for field, number in zip(
                (self.measured, self.measured_error), value.get("measured", ()), strict=False
            ):
                field.setValue(float(number))
            self.contact.restore(value.get("contact", {}))
            self.evaluation.setValue(value.get("evaluation", {}))
            self._limit_particles()
            for key, form in self._numerics.items():
                form.setValue(value.get("numerics", {}).get(key, {}))
        except (InputError, TypeError, ValueError, AttributeError):
            return
        enter_values(self._fields, value)
        folder = value.get("dataset")
        if folder and Path(str(folder)).is_dir():
            self.set_dataset(Path(str(folder)), value.get("dataset_by_hand") is True)

    def _place(self) -> None:
        presets = [
            _button(tr(name), f"repose_preset_{count}", tr("{count:,} particles", count=count))
            for name, count in PRESETS.items()
        ]
        for button, count in zip(presets, PRESETS.values(), strict=True):
            button.clicked.connect(lambda _=False, count=count: self.particles.setValue(count))
        form = QFormLayout()
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        form.addRow(tr("Test"), self.apparatus)
        form.addRow(tr("Number"), self.particles)
        form.addRow(tr("Seed"), self.seed)
        form.addRow(tr("Shapes"), self.shapes)
        form.addRow(tr("Cohesion"), self.cohesion)
        form.addRow(tr("Engine"), self.engine)
        form.addRow(tr("Gravity of"), self.gravity)
        form.addRow(tr("Filling"), self.filling)
        case = vbox(
            heading(tr("Dataset")),
            self.dataset_label,
            self.dataset_note,
            hbox(self.open_button, self.sample_button, spacing=6),
            heading(tr("Particles")),
            hbox(*presets, spacing=6),
            form,
            self.problem,
            self.scaling_report,
            STRETCH,
            spacing=8,
        )
        self.drum.rows.addRow(tr("Measured dynamic angle"), self.measured)
        self.drum.rows.addRow(tr("Standard error"), self.measured_error)
        self._drum_box = Collapsible(tr("Rotating drum"), self.drum)
        values = vbox(
            self._drum_box,
            Collapsible(tr("Test"), self.test),
            Collapsible(tr("Contact"), self.contact),
            Collapsible(tr("Evaluation of the heap"), self.evaluation),
            Collapsible(tr("Numerics of the engine"), *self._numerics.values()),
            hint_label(tr("* not given in the paper: an assumption that can be changed")),
            STRETCH,
            spacing=8,
        )
        self._columns = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._columns.setSpacing(COLUMN_GAP)
        for column in (case, values):
            self._columns.addLayout(column, 1)

    def minimumSizeHint(self) -> QSize:
        """As narrow as the wider of both columns, which come below each other then."""
        margins = self._columns.contentsMargins()
        width = max(self._widths()) + margins.left() + margins.right()
        return QSize(width, super().minimumSizeHint().height())

    def _widths(self) -> list[int]:
        """Least width of each column."""
        items = (self._columns.itemAt(place) for place in range(self._columns.count()))
        return [item.minimumSize().width() for item in items if item is not None]

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        margins = self._columns.contentsMargins()
        needed = sum(self._widths()) + COLUMN_GAP + margins.left() + margins.right()
        direction = (
            QBoxLayout.Direction.TopToBottom if self.width() < needed else QBoxLayout.Direction.LeftToRight
        )
        if direction != self._columns.direction():
            self._columns.setDirection(direction)
            self.updateGeometry()

    def _connect(self) -> None:
        on_change((*self._fields.values(), self.filling), self.valueChanged.emit)
        for form in (self.test, self.drum, self.contact, *self._numerics.values()):
            form.valueChanged.connect(lambda _: self.valueChanged.emit())
        self.evaluation.valueChanged.connect(lambda *_: self.evaluationChanged.emit())
        self.evaluationChanged.connect(self._limit_particles)
        self._limit_particles()
        self.engine.currentIndexChanged.connect(lambda *_: self._show_numerics())
        self._show_numerics()
        self.apparatus.currentIndexChanged.connect(lambda *_: self._take_apparatus())
        self._drum_box.set_open(True)
        self._drum_box.setVisible(self.in_drum)
        for field in (self.measured, self.measured_error):
            field.valueChanged.connect(lambda *_: self.measuredChanged.emit())
        self.gravity.currentIndexChanged.connect(self._take_gravity)
        self.test.valueChanged.connect(self._show_gravity)

    def _limit_particles(self) -> None:
        """Begin at the fewest particles that the evaluation accepts: fewer would run for nothing."""
        usual = EvaluationSettings().min_particles
        self.particles.setMinimum(int(self.evaluation.value().get("min_particles", usual)))

    def _show_numerics(self) -> None:
        for key, form in self._numerics.items():
            form.setVisible(key == self.engine.value())

    def _take_apparatus(self) -> None:
        """Take the usual values of the apparatus for those of the other, and an engine that has it."""
        self._drum_box.setVisible(self.in_drum)
        values = vars(self.test.value())
        pairs = {name: pair if self.in_drum else pair[::-1] for name, pair in OF_DRUM.items()}
        self.test.restore(values | {name: new for name, (new, old) in pairs.items() if values[name] == old})
        if self.in_drum and not engine_named(self.engine.value()).capabilities.drum:
            able = next(key for key, engine in ENGINES.items() if engine.capabilities.drum)
            self.engine.choose(able)
        self.valueChanged.emit()

    def _take_gravity(self) -> None:
        if gravity := self.gravity.value():
            self.test.restore({**vars(self.test.value()), "gravity": gravity})
            self.valueChanged.emit()

    def _show_gravity(self) -> None:
        now = self.test.value().gravity
        self.gravity.setValue(now if now in GRAVITIES.values() else 0.0)


def _button(text: str, name: str, tip: str) -> QPushButton:
    return named(QPushButton(text), name, tip, tip=tip)


def engine_table() -> TextTable:
    """A row per property, a column per engine."""
    rows = engine_rows()
    headings = [tr("Property"), *(row["label"] for row in rows)]
    table = TextTable("repose_engines", tr("Engines"), headings, numbers=False)
    found = [row["version"] or translate(row["problem"]) for row in rows]
    texts = [[tr("Found"), *found]]
    texts += [[tr(label), *(tr(row[key]) for row in rows)] for key, label in CAPABILITY_LABELS.items()]
    table.set_rows(texts, ["\n".join(line[1:]) for line in texts])
    return table
