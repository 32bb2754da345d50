"""Page "Studies": Fig. 8 with further sweeps of the coarsening, Fig. 3, Fig. 7, and the uncertainty."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.study_jobs import GalleryCell, coarsen_gallery, study_coarsening, study_of_cells
from regolith_studio.messages import N_
from regolith_studio.session.choices import STUDIES as KINDS
from regolith_studio.session.choices import Choices, Kind, depends
from regolith_studio.session.outputs.studies import write_studies
from regolith_studio.session.study_requests import COMPOUND, chosen_rows, varied_rows
from regolith_studio.studies.coarsening import CoarseningStudy
from regolith_studio.studies.loss_variants import LossVariant
from regolith_studio.studies.sweeps import SWEEPS
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.layout import tabs, vbox
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.studies.budget import BudgetPanel
from regolith_studio.ui.pages.studies.plots import CoarseningStudyPanel, LmaxStudyPanel
from regolith_studio.ui.pages.studies.sweep import MAX_PARTICLES, GalleryPanel, LossSelector, SweepPanel
from regolith_studio.ui.result_card import ResultRecord, ResultState, RunController
from regolith_studio.ui.translation import tr, translate

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
        self.bar.box.setValue(state.get("box"))
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
        with self._context.toast.reporting():
            self._session.start_study(kind, **options)

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
        job = Job(write_studies, (done, Path(name), self._origins()))
        self._context.start(tr("Writing figures"), job, self._report_written, queue="save")

    def _report_written(self, paths: tuple[Path, ...]) -> None:
        listed = "\n".join(str(path) for path in paths)
        sentence = tr("Tables and figures are in {folder}.", folder=paths[0].parent)
        if unfinished := self._titles_in(ResultState.RUNNING, ResultState.STOPPED):
            sentence += " " + tr("Unfinished: {names}.", names=", ".join(unfinished))
        if outdated := self._titles_in(ResultState.STALE):
            sentence += " " + tr("Outdated: {names}.", names=", ".join(outdated))
        self._context.toast.note(sentence, listed)

    def _titles_in(self, *states: ResultState) -> list[str]:
        """Titles of the studies with a result in one of these states."""
        return [
            self.tabs.tabText(self.tabs.indexOf(panel))
            for panel in self._panels
            if panel.card.record.state in states and panel.card.record.values
        ]

    def _origins(self) -> dict[str, str]:
        """By kind of study, its title with what its card says: state, origin and settings."""
        panels: dict[str, StudyPanel] = {
            Kind.LMAX_STUDY.value: self.lmax_study,
            Kind.COARSENING_STUDY.value: self.coarsening_study,
            "solids_study": self.gallery,
            **{f"{key}_study": panel for key, panel in self.variations.items()},
        }
        return {
            kind: f"{self.tabs.tabText(self.tabs.indexOf(panel))}\n{panel.card.record.sentences()}\n"
            for kind, panel in panels.items()
            if panel.card.record.values
        }

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
