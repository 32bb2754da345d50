"""Page "Studies": Fig. 8 with further sweeps of the coarsening, Fig. 3, Fig. 7, and the uncertainty."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QSpinBox, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.study_jobs import GalleryCell, coarsen_gallery, study_coarsening, study_of_cells
from regolith_studio.jobs.uncertainty import UncertaintyRequest, locked_uncertainty
from regolith_studio.jobs.uncertainty_chain import Chain
from regolith_studio.messages import N_
from regolith_studio.session.choices import STUDIES as KINDS
from regolith_studio.session.choices import Choices, Kind, depends
from regolith_studio.session.outputs.studies import write_studies
from regolith_studio.session.study_requests import COMPOUND, chosen_rows, varied_rows
from regolith_studio.studies.coarsening import CoarseningStudy
from regolith_studio.studies.loss_variants import LossVariant
from regolith_studio.studies.sweeps import SWEEPS
from regolith_studio.studies.uncertainty import OUTPUTS, RESAMPLED, AngleBudget, UncertaintyBudget
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.layout import STRETCH, hbox, named, tabs, vbox
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.studies.plots import (
    CoarseningStudyPanel,
    LmaxStudyPanel,
    study_card,
    study_panel,
)
from regolith_studio.ui.pages.studies.sweep import MAX_PARTICLES, GalleryPanel, LossSelector, SweepPanel
from regolith_studio.ui.result_card import ResultRecord, ResultState, RunController
from regolith_studio.ui.translation import number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.fields import choice
from regolith_studio.ui.widgets.labels import grouped_number, hint_label
from regolith_studio.ui.widgets.table import TextTable

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
        self.points.setCurrentIndex(self.points.findData(UncertaintyRequest.base))
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
        return {"points": self.points.currentData(), "heaps": self.heaps.value()}

    def setValue(self, value: Mapping[str, Any]) -> None:
        self.points.setCurrentIndex(max(0, self.points.findData(value.get("points"))))
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
        request = UncertaintyRequest(self.points.currentData(), self.heaps.value())
        self._budget, self._made = None, self._asked()
        job = Job(locked_uncertainty, (chain, request, Path(folder)), {"resume": True})
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
        number, found, recipe = int(self.quantity.currentData()), budget.descriptors, budget.recipe
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
        number, budget = int(self.quantity.currentData()), self._budget
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
    """A row for each change of a step; undecided ones have no share but the heaps that would decide."""
    if angle is None:
        return []
    whole, variances = angle.variance, angle.step_variances()
    rows: list[Row] = []
    for each in angle.effects:
        numbers = (number_text(value, ".1f") for value in (each.change, each.low, each.high))
        change = "{} ({} – {})".format(*numbers)
        share = tr("{count} heaps would decide", count=each.heaps_needed or "–")
        if each.decided:
            share = number_text(100 * variances.get(each.step.key, 0.0) / whole, ".0f")
        rows.append((tr(each.step.label), translate(each.level), change, share))
    return rows


def _percent(value: float, low: float, high: float) -> str:
    texts = (number_text(100 * each, ".0f") for each in (value, low, high))
    return "{} ({} – {})".format(*texts)


StudyPanel = LmaxStudyPanel | CoarseningStudyPanel | SweepPanel | GalleryPanel | BudgetPanel
NO_PARTICLE = N_("No particle is open; open a mesh first.")


class SweepController:
    """Runs sweeps, which can run at the same time and be stopped separately.

    ``panels``: by key of :data:`~regolith_studio.studies.sweeps.SWEEPS`. ``bar``: selects the bounding box
    of the diameters.
    """

    def __init__(self, context: PageContext, panels: Mapping[str, SweepPanel], bar: LossSelector) -> None:
        self._context, self._session, self._panels, self._bar = context, context.session, panels, bar
        self._results: dict[str, CoarseningStudy] = {}
        self._made: dict[str, Choices] = {}
        self.runs = {
            key: RunController(context, panel.card, key, partial(self.start, key))
            for key, panel in panels.items()
        }
        for key, panel in panels.items():
            panel.values.returnPressed.connect(partial(self.start, key))
        context.bindings.refresh("choices", self._mark_outdated, slow=True)

    @property
    def results(self) -> Mapping[str, CoarseningStudy]:
        """Results by key, which are partial while a sweep is running or after it was stopped."""
        return self._results

    def current(self) -> list[str]:
        """Keys of the sweeps whose results are of the present choices."""
        return [key for key, study in self._results.items() if study.names and not self._is_outdated(key)]

    def start(self, key: str, quietly: bool = False) -> None:
        """Start a sweep with the present choices.

        ``quietly``: whether to ignore a sweep that the choices do not allow, instead of reporting it.
        """
        choices, particles = self._session.choices, self._session.open_particles
        try:
            with_compound = COMPOUND in self._bar.names()
            rows = varied_rows(key, choices, self._panels[key].values.value(), with_compound)
        except RegolithError as error:
            if not quietly:
                self._context.toast.problem(str(error))
            return
        if not particles:
            self._context.toast.problem(tr(NO_PARTICLE))
            return
        title = SWEEPS[key].title
        options = {"rows": rows, "box_metric": self._bar.box.value(), "title": title}
        job = Job(study_coarsening, (particles, choices.coarsening_request), options)
        self._made[key] = choices
        self.runs[key].start(title, job, partial(self._show, key))

    def forget(self) -> None:
        """Stop all, and clear what was made from particles that are open no more."""
        self._results.clear()
        for key, run in self.runs.items():
            run.forget()
            self._panels[key].show_study(None)

    def _show(self, key: str, study: CoarseningStudy) -> ResultRecord | None:
        if not study.names:
            return None
        self._results[key] = study
        self._panels[key].show_study(study)
        return self._panels[key].record(study, self._made[key])

    def _mark_outdated(self) -> None:
        choices = self._session.choices
        self._bar.show_facets(choices)
        for key, panel in self._panels.items():
            panel.show_method(choices.method)
            if key in self._results:
                self.runs[key].set_outdated(self._is_outdated(key))

    def _is_outdated(self, key: str) -> bool:
        made, now = self._made[key], self._session.choices
        if key == "facets":
            made = made.replaced(stop_at="facets", n_facets=now.facet_count)
        return made.weights != now.weights or depends(Kind.COARSENING_STUDY, made, now)


TABS = (
    N_("Losses (Fig. 8)"),
    N_("Facets"),
    N_("Overlap or descriptors"),
    N_("Weights"),
    N_("Degree (Fig. 3)"),
    N_("Polyhedra (Fig. 7)"),
    N_("Uncertainty"),
)


class StudiesPage(PageWidget):
    """Studies of the coarsening and of l_max, and the gallery of polyhedra."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("studies")
        self._context, self._session = context, context.session
        self._ids: tuple[str, ...] = ()
        self._seen: dict[Kind, object] = {}
        self._drawn: tuple[Choices, tuple[LossVariant, ...], list[str]] | None = None

    def build(self) -> None:
        bindings = self._context.bindings
        self.lmax_study = LmaxStudyPanel()
        self.coarsening_study = CoarseningStudyPanel()
        self.gallery, self.bar = GalleryPanel(), LossSelector()
        self.budget = BudgetPanel(self._context)
        self.variations = {key: SweepPanel(key) for key in SWEEPS}
        self.variations["facets"].facetsChosen.connect(
            lambda count: self._session.choose(stop_at="facets", n_facets=count)
        )
        self._panels: tuple[StudyPanel, ...] = (
            self.coarsening_study,
            *self.variations.values(),
            self.lmax_study,
            self.gallery,
            self.budget,
        )
        self._place()
        self.sweeps = SweepController(self._context, self.variations, self.bar)
        self.drawing = RunController(self._context, self.gallery.card, "gallery", self.draw_gallery)
        self._wire(Kind.LMAX_STUDY, self.lmax_study)
        self._wire(Kind.COARSENING_STUDY, self.coarsening_study)
        self.lmax_study.tolerance.valueChanged.connect(lambda _value: self._show(Kind.LMAX_STUDY))
        bindings.refresh("particles", self._follow_particles)
        bindings.refresh(
            "choices", lambda: self.lmax_study.show_l_max(self._session.choices.l_max), ("l_max",), slow=True
        )
        bindings.refresh("choices", self._mark_gallery, slow=True)

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {"run_shown": self.run_shown, "run_all": self.run_all, "save": self.save}

    def settings(self) -> dict[str, Any]:
        return {
            "rows": list(self.bar.names()),
            "box": self.bar.box.value(),
            "budget": self.budget.value(),
            "values": {key: panel.values.value() for key, panel in self.variations.items()},
        }

    def state(self) -> dict[str, Any]:
        results = self._session.results
        made: list[str] = [k for k in KINDS if getattr(results, k.value) and k.value not in results.outdated]
        made += self.sweeps.current()
        return self.settings() | {"made": made + ["gallery"] * bool(self.gallery.value())}

    def resume(self, state: Mapping[str, Any]) -> None:
        """Compute again what was shown: each study follows from its choices and seed."""
        made = state.get("made") or []
        self._follow_particles()
        for kind in (each for each in KINDS if each in made):
            self.start(kind)
        for key in (each for each in SWEEPS if each in made):
            self.sweeps.start(key, quietly=True)
        if "gallery" in made:
            self.draw_gallery()

    def restore(self, state: Mapping[str, Any]) -> None:
        rows, values = state.get("rows"), state.get("values")
        if isinstance(rows, list):
            self.bar.set_names(rows)
        if isinstance(state.get("budget"), Mapping):
            self.budget.setValue(state["budget"])
        if self.bar.box.findData(state.get("box")) >= 0:
            self.bar.box.setValue(str(state["box"]))
        for key, text in values.items() if isinstance(values, dict) else ():
            if key in self.variations and isinstance(text, str):
                self.variations[key].values.setValue(text)

    def run_shown(self) -> None:
        """Start the study of the open tab, unless it is running."""
        card = self._panels[self.tabs.currentIndex()].card
        if not self._session.particles:
            self._context.toast.problem(tr(NO_PARTICLE))
        elif card.record.state is not ResultState.RUNNING:
            card.startRequested.emit()

    def run_all(self) -> None:
        """Start all studies that the choices allow, and the gallery."""
        if not self._session.particles:
            self._context.toast.problem(tr(NO_PARTICLE))
            return
        for kind in KINDS:
            self.start(kind)
        for key in SWEEPS:
            self.sweeps.start(key, quietly=True)
        self.draw_gallery()

    def start(self, kind: Kind) -> None:
        """Start a study; that of the losses with the selected rows and box."""
        options: dict[str, Any] = {}
        if kind is Kind.COARSENING_STUDY:
            rows = chosen_rows(self.bar.names(), self._session.choices)
            options = {"rows": rows, "box_metric": self.bar.box.value()}
        try:
            self._session.start_study(kind, **options)
        except RegolithError as error:
            self._context.toast.problem(str(error))

    def draw_gallery(self) -> None:
        """Coarsen the current particle and those after it with each loss function."""
        entries = self._session.particles
        if not entries:
            self._context.toast.problem(tr(NO_PARTICLE))
            return
        ids = [entry.id for entry in entries]
        first = ids.index(self._session.choices.selected) if self._session.choices.selected in ids else 0
        shown = [*entries[first:], *entries[:first]][:MAX_PARTICLES]
        choices = self._session.choices
        rows = chosen_rows(self.bar.names(), choices)
        self._drawn = choices, rows, [entry.particle.name for entry in shown]
        self.gallery.begin(shown, [translate(row.label) for row in rows])
        particles = tuple(entry.particle for entry in shown)
        job = Job(coarsen_gallery, (particles, choices.coarsening_request, rows))
        self.drawing.start(tr("Coarsening for the gallery"), job, self._show_cells)

    def _show_cells(self, cells: list[GalleryCell]) -> ResultRecord:
        assert self._drawn is not None
        self.gallery.show_cells(cells)
        return self.gallery.record(*self._drawn[:2])

    def save(self) -> None:
        """Ask for a folder and write tables and figures of all results."""
        found = {kind.value: getattr(self._session.results, kind.value) for kind in KINDS}
        found |= {f"{key}_study": study for key, study in self.sweeps.results.items() if study.names}
        cells = self.gallery.value()
        if self._drawn is not None and cells:
            _, rows, names = self._drawn
            found["solids_study"] = study_of_cells(cells, [row.label for row in rows], names)
        done = tuple((kind, study) for kind, study in found.items() if study is not None)
        if not done:
            self._context.toast.problem(tr("Compute a study first."))
            return
        start = str(self._context.recall("folder", str(Path.home())))
        name = FolderDialog.ask(self, tr("Folder of figures and tables"), start)
        if not name:
            return
        self._context.remember("folder", name)
        job = Job(write_studies, (done, Path(name)))
        self._context.start(tr("Writing figures"), job, self._report_written, queue="save")

    def _report_written(self, paths: tuple[Path, ...]) -> None:
        listed = "\n".join(str(path) for path in paths)
        sentence = tr("Tables and figures are in {folder}.", folder=paths[0].parent)
        if unfinished := self._unfinished():
            sentence += " " + tr("Unfinished: {names}.", names=", ".join(unfinished))
        self._context.toast.note(sentence, listed)

    def _unfinished(self) -> list[str]:
        partial_states = (ResultState.RUNNING, ResultState.STOPPED)
        return [
            self.tabs.tabText(self.tabs.indexOf(panel))
            for panel in self._panels
            if panel.card.record.state in partial_states and panel.card.record.values
        ]

    def _wire(self, kind: Kind, panel: LmaxStudyPanel | CoarseningStudyPanel) -> None:
        panel.card.startRequested.connect(partial(self.start, kind))
        panel.card.stopRequested.connect(partial(self._session.stop, kind))
        show = partial(self._show, kind)
        self._context.bindings.refresh(f"{kind.value} tasks", show, slow=True)

    def _show(self, kind: Kind) -> None:
        """Show a study of the session, and on its card whether it runs, is complete and fits the choices."""
        results = self._session.results
        study, made = getattr(results, kind.value), self._session.choices_of(kind)
        task = next((task for task in self._session.tasks if task.queue == kind), None)
        panel = self.lmax_study if kind is Kind.LMAX_STUDY else self.coarsening_study
        if study is not self._seen.get(kind):
            self._seen[kind] = study
            panel.show_study(study)
        known = study is not None and study.names
        record = panel.record(study, made) if known and made is not None else ResultRecord()
        state = ResultState.NONE
        if task is not None:
            state = ResultState.RUNNING
        elif kind.value in results.failures:
            record = replace(record, note=translate(results.failures[kind.value]))
            state = ResultState.FAILED
        elif known:
            complete = len(study.names) + len(study.failures) == len(self._session.particles)
            state = ResultState.CURRENT if complete else ResultState.STOPPED
            state = ResultState.STALE if kind.value in results.outdated else state
        panel.card.show_record(replace(record, state=state))
        panel.card.show_task(task)

    def _follow_particles(self) -> None:
        ids = tuple(entry.id for entry in self._session.particles)
        if ids == self._ids:
            return
        self._ids = ids
        self.sweeps.forget()
        self.drawing.forget()
        self.budget.forget()
        self.gallery.clear()
        self._drawn = None
        for panel in self._panels:
            panel.card.set_startable("" if ids else tr(NO_PARTICLE))

    def _mark_gallery(self) -> None:
        if self._drawn is not None:
            made, now = self._drawn[0], self._session.choices
            self.drawing.set_outdated(depends(Kind.COARSENING_STUDY, made, now))

    def _place(self) -> None:
        self.tabs = tabs("studies_tabs", list(zip(self._panels, map(tr, TABS), strict=True)))
        vbox(self.bar, (self.tabs, 1), parent=self, margins=(10, 10, 10, 8))
