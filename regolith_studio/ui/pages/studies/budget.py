"""Tab "Uncertainty" of the studies: what each step from the grains to the angle of repose costs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QSpinBox, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.uncertainty import UncertaintyRequest, uncertainty_steps
from regolith_studio.jobs.uncertainty_chain import Chain
from regolith_studio.messages import N_
from regolith_studio.studies.uncertainty import (
    MAX_PAIRS,
    OUTPUTS,
    RESAMPLED,
    AngleBudget,
    UncertaintyBudget,
)
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.layout import STRETCH, hbox, named
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.studies.plots import study_card, study_panel
from regolith_studio.ui.result_card import ResultRecord, RunController
from regolith_studio.ui.translation import number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.fields import choice
from regolith_studio.ui.widgets.labels import grouped_number, hint_label
from regolith_studio.ui.widgets.text_table import TextTable

POINTS = (4, 8, 16, 32, 64)
MAX_HEAPS = 100
STAGES = {"grains": N_("{descriptor} of the grains"), "polyhedra": N_("{descriptor} of the polyhedra")}
ANGLE = len(OUTPUTS)
"""Number of the angle among the quantities."""
SHARES = (N_("Step"), N_("Levels"), N_("First-order share [%]"), N_("Total share [%]"))
CHANGES = (N_("Step"), N_("Level"), N_("Change [°]"), N_("Share of the variance [%]"))
HINT = N_(
    "Each step is set to other levels that are equally sound; the share of a step is what it adds to the "
    "variance. Tables and figure are written to a folder, which a later run goes on from. For the steps of a "
    "scan: regolith-studio uncertainty."
)

Row = tuple[str, ...]


class BudgetPanel(QWidget):
    """Size of the design, the card of the selected quantity, and its table with a row for each step."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("uncertainty")
        self._context, self._session = context, context.session
        self._budget: UncertaintyBudget | None = None
        self._made: tuple[object, ...] = ()
        self._folder = ""
        self.card = study_card("uncertainty", tr("Mean"), tr("95 % interval"))
        spoken = tr("Points of the design")
        self.points = choice("uncertainty_points", spoken, [(each, str(each)) for each in POINTS])
        self.heaps = named(QSpinBox(), "uncertainty_heaps", tr("Heaps of each step"))
        labels = [tr(STAGES[stage], descriptor=tr(CATALOGUE[key].label)) for stage, key in OUTPUTS]
        self.quantity = choice(
            "uncertainty_quantity", tr("Quantity"), list(enumerate([*labels, tr("Angle of repose")]))
        )
        self.table = TextTable("uncertainty_steps", tr("Shares of the steps"), list(map(tr, SHARES)))
        self._configure()
        self.run = RunController(context, self.card, "uncertainty", self.start)
        context.bindings.refresh("particles choices", self._mark_outdated, slow=True)

    def _configure(self) -> None:
        self.points.choose(UncertaintyRequest.base)
        self.heaps.setRange(0, MAX_HEAPS)
        self.heaps.setSpecialValueText(tr("none"))
        self.heaps.setToolTip(tr("Simulated heaps; without them the budget is of descriptors alone."))
        self.quantity.setCurrentIndex(OUTPUTS.index(("polyhedra", "aspect_ratio")))
        self.quantity.currentIndexChanged.connect(lambda _: self._show_quantity())
        asked = QWidget()
        sizes = QLabel(tr("Points")), self.points, QLabel(tr("Heaps")), self.heaps
        hbox(self.quantity, 12, *sizes, STRETCH, parent=asked)
        study_panel(self, self.card, asked, hint_label(tr(HINT)), self.table)

    def value(self) -> dict[str, Any]:
        """Plain JSON.

        Not the folder: a project that is opened must not name where files are written.
        """
        return {"points": self.points.value(), "heaps": self.heaps.value()}

    def setValue(self, value: Mapping[str, Any]) -> None:
        self.points.choose(value.get("points"))
        if isinstance(heaps := value.get("heaps"), int):
            self.heaps.setValue(min(max(heaps, 0), MAX_HEAPS))

    def start(self) -> None:
        """Ask for a folder and make the budget there."""
        before = self._folder or str(self._context.recall("folder", str(Path.home())))
        if folder := FolderDialog.ask(self, tr("Folder of the budget of uncertainty"), before):
            self._context.remember("folder", folder)
            self.start_in(folder)

    def start_in(self, folder: str) -> None:
        """Make the budget in a folder, or go on with it; heaps that are known are not run again."""
        choices, self._folder = self._session.choices, folder
        chain = Chain.of(
            self._session.open_particles, coarsening=choices.coarsening_request, seed=choices.seed
        )
        request = UncertaintyRequest(self.points.value(), self.heaps.value())
        self._budget, self._made = None, self._asked()
        job = Job(uncertainty_steps, (chain, request, Path(folder)), {"resume": True})
        self.run.start(tr("Budget of uncertainty"), job, self._show, note=folder)

    def forget(self) -> None:
        """Stop, and clear what was made from particles that are open no more."""
        self._budget = None
        self.run.forget()
        self._show_quantity()

    def _asked(self) -> tuple[object, ...]:
        ids = tuple(entry.id for entry in self._session.particles)
        return ids, self._session.choices.coarsening_request, self._session.choices.seed

    def _mark_outdated(self) -> None:
        self.run.set_outdated(self._asked() != self._made)

    def _show(self, budget: UncertaintyBudget) -> ResultRecord:
        self._budget = budget
        self._show_table()
        return self._record(budget)

    def _show_quantity(self) -> None:
        """Show another quantity of the same budget."""
        self._show_table()
        if self._budget is not None:
            now, state = self._record(self._budget), self.card.record.state
            self.card.show_record(ResultRecord(now.values, now.made_from, now.made_with, state, now.note))

    def _record(self, budget: UncertaintyBudget) -> ResultRecord:
        number, found, recipe = self.quantity.value(), budget.descriptors, budget.recipe
        value, ends, unit = float("nan"), (float("nan"),) * 2, " [°]"
        if number < ANGLE:
            value, ends = found.nominal[number], tuple(found.intervals[number])
            unit = CATALOGUE[OUTPUTS[number][1]].unit_suffix
        elif budget.angle is not None:
            half = budget.angle.half_width
            value, ends = budget.angle.value, (budget.angle.value - half, budget.angle.value + half)
        self.card.caption(0, tr("Mean") + unit)
        texts = [grouped_number(each, 3) if each == each else "–" for each in (value, *ends)]
        made_from = tr_count(N_("1 particle"), N_("{count} particles"), found.n_grains)
        known, rows = found.known.shape[1], found.results.shape[1]
        made_with = [
            tr("{known} of {rows} points", known=known, rows=rows),
            tr("n = {facets}", facets=recipe["coarsening"]["n_facets"]),
            tr("seed {seed}", seed=recipe["seed"]),
        ]
        if recipe["heaps"]:
            made_with.insert(1, tr("{count} heaps of each step", count=recipe["heaps"]))
        values = texts[0], f"{texts[1]} – {texts[2]}"
        return ResultRecord(values, made_from, ", ".join(made_with), note=self._folder)

    def _show_table(self) -> None:
        number, budget = self.quantity.value(), self._budget
        self.table.rows.setHorizontalHeaderLabels(list(map(tr, SHARES if number < ANGLE else CHANGES)))
        rows: list[Row] = []
        if budget is not None:
            rows = _share_rows(budget, number) if number < ANGLE else _angle_rows(budget.angle)
            missing = tr("not counted")
            rows += [
                (tr(step.label), ": ".join((missing, tr(step.missing))), "", "")
                for step in budget.not_counted
            ]
        self.table.set_rows(rows, [row[1] for row in rows])
        for row in range(len(rows)):
            self.table.rows.item(row, 1).setTextAlignment(Qt.AlignmentFlag.AlignLeft)


def _share_rows(budget: UncertaintyBudget, number: int) -> list[Row]:
    """A row for each step of the design, without numbers before they are known."""
    shares = budget.descriptors.shares
    rows: list[Row] = []
    for at, step in enumerate(budget.descriptors.steps):
        numbers = ("…", "…") if shares is None else tuple(_percent(*each[number, at]) for each in shares)
        levels = " | ".join(step.levels)
        if step.key == RESAMPLED:
            levels = tr("{count} bootstrap samples", count=len(step.levels))
        rows.append((tr(step.label), levels, *numbers))
    return rows


def _angle_rows(angle: AngleBudget | None) -> list[Row]:
    """A row for each change of a step; undecided ones have no share but the heaps that would decide them."""
    if angle is None:
        return []
    whole, variances = angle.variance, angle.step_variances()
    rows: list[Row] = []
    for each in angle.effects:
        numbers = (number_text(value, ".1f") for value in (each.change, each.low, each.high))
        change = "{} ({} – {})".format(*numbers)
        share = _needed(each.heaps_needed)
        if each.decided:
            share = number_text(100 * variances.get(each.step.key, 0.0) / whole, ".0f")
        rows.append((tr(each.step.label), translate(each.level), change, share))
    return rows


def _needed(pairs: int | None) -> str:
    if pairs is None:
        return tr("the same heaps")
    if pairs > MAX_PAIRS:
        return tr("more than {count} heaps would decide", count=grouped_number(MAX_PAIRS))
    return tr("{count} heaps would decide", count=grouped_number(pairs))


def _percent(value: float, low: float, high: float) -> str:
    texts = (number_text(100 * each, ".0f") for each in (value, low, high))
    return "{} ({} – {})".format(*texts)
