"""Page "Studies": Fig. 3, Fig. 8 with further sweeps of the coarsening, and Fig. 7."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSizePolicy, QTabWidget, QVBoxLayout, QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.study_jobs import coarsen_gallery, study_coarsening, study_of_cells
from regolith_studio.messages import N_
from regolith_studio.session.choices import STUDIES as KINDS
from regolith_studio.session.choices import Choices, Kind, depends
from regolith_studio.session.outputs.studies import write_studies
from regolith_studio.session.study_requests import COMPOUND, chosen_rows, varied_rows
from regolith_studio.studies.coarsening import CoarseningStudy
from regolith_studio.studies.sweeps import SWEEPS
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.layout import (
    padded,
    scrolled_column,
    side_by_side,
    stacked,
    tabs,
)
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.studies.gallery import MAX_PARTICLES, GalleryPanel
from regolith_studio.ui.pages.studies.plots import CoarseningStudyPanel, LmaxStudyPanel
from regolith_studio.ui.pages.studies.sweep import LossSelector, SweepPanel
from regolith_studio.ui.translation import tr, tr_count, translate
from regolith_studio.ui.widgets.labels import heading


class SweepController:
    """Runs sweeps, which can run at the same time and be stopped separately.

    Parameters
    ----------
    panels
        By key of :data:`~regolith_studio.studies.sweeps.SWEEPS`.
    bar
        Selects the bounding box of the diameters.
    """

    def __init__(self, context: PageContext, panels: Mapping[str, SweepPanel], bar: LossSelector) -> None:
        self._context, self._session, self._panels, self._bar = context, context.session, panels, bar
        self._results: dict[str, CoarseningStudy] = {}
        self._made: dict[str, Choices] = {}
        self._shown: dict[str, object] = {}
        self._ids: tuple[str, ...] = ()
        for key, panel in panels.items():
            panel.startRequested.connect(partial(self.start, key))
            panel.frame.cancelRequested.connect(self._session.cancel)
        context.bindings.refresh("particles", self._follow_particles)
        context.bindings.refresh("tasks choices", self._refresh, slow=True)

    @property
    def results(self) -> Mapping[str, CoarseningStudy]:
        """Results by key, which are partial while a sweep is running or after it was stopped."""
        return self._results

    def start(self, key: str, quietly: bool = False) -> None:
        """Start a sweep with the present choices.

        Parameters
        ----------
        quietly
            Whether to ignore a sweep that the choices do not allow, instead of reporting it.
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
            self._context.toast.problem(tr("No particle is open; open a mesh first."))
            return
        title = SWEEPS[key].title
        options = {"rows": rows, "box_metric": self._bar.box.value(), "title": title}
        job = Job(study_coarsening, (particles, choices.coarsening_request), options)
        self._made[key] = choices
        take = partial(self._take, key)
        self._context.start(title, job, partial(self._end, key), partial=take, queue=key)

    def _take(self, key: str, study: CoarseningStudy) -> None:
        """Keep a partial result, which is drawn at the next refresh."""
        self._results[key] = study

    def _end(self, key: str, study: CoarseningStudy) -> None:
        self._take(key, study)
        self._refresh()

    def _follow_particles(self) -> None:
        entries = self._session.particles
        for panel in self._panels.values():
            panel.frame.set_count(len(entries))
        ids = tuple(entry.id for entry in entries)
        if ids != self._ids:
            self._ids = ids
            for key in self._panels:
                self._context.stop(key)
            self._results.clear()
            self._refresh()

    def _refresh(self) -> None:
        self._bar.show_facets(self._session.choices)
        for key, panel in self._panels.items():
            queue = f"{self._context.key}:{key}"
            panel.frame.show_task(next((task for task in self._session.tasks if task.queue == queue), None))
            panel.show_method(self._session.choices.method)
            study = self._results.get(key)
            state = (study, study is not None and self._is_outdated(key))
            if state != self._shown.get(key):
                self._shown[key] = state
                panel.show_study(*state)

    def _is_outdated(self, key: str) -> bool:
        made, now = self._made[key], self._session.choices
        if key == "facets":
            made = made.replaced(stop_at="facets", n_facets=now.facet_count)
        return made.weights != now.weights or depends(Kind.COARSENING_STUDY, made, now)


LMAX_TITLE = N_("Error against l<sub>max</sub> (Fig. 3)")
BAR_WIDTH = 200
"""Initial width of the choices in pixels."""
COARSENING_TITLE = N_("Error of coarsened particles")
TABS = {"facets": N_("Facets"), "tradeoff": N_("Overlap or descriptors"), "sensitivity": N_("Weights")}
"""Object names and titles of the tabs after that of Fig. 8."""


class StudiesPage(PageWidget):
    """Studies of l_max and of the coarsening, and the gallery of polyhedra."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("studies")
        self._context, self._session = context, context.session
        self._drawn: tuple[list[str], list[str]] = [], []

    def build(self) -> None:
        bindings = self._context.bindings
        self.lmax_study = LmaxStudyPanel()
        self.coarsening_study = CoarseningStudyPanel()
        self.gallery, self.bar = GalleryPanel(), LossSelector()
        self.variations: dict[str, SweepPanel] = {}
        for key in SWEEPS:
            self.variations[key] = SweepPanel(key)
        self.variations["facets"].facetsChosen.connect(
            lambda count: self._session.choose(stop_at="facets", n_facets=count)
        )
        self.tabs = self._tabs()
        self._place()
        self.sweeps = SweepController(self._context, self.variations, self.bar)
        self._wire(Kind.LMAX_STUDY, self.lmax_study)
        self._wire(Kind.COARSENING_STUDY, self.coarsening_study)
        self.gallery.frame.startRequested.connect(self.draw_gallery)
        self.gallery.frame.cancelRequested.connect(self._session.cancel)
        bindings.refresh("tasks", self._show_gallery_task, slow=True)
        bindings.refresh("particles", self._name_gallery_button)
        bindings.refresh("choices", self._show_l_max, ("l_max",), slow=True)

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {"run_all": self.run_all, "save": self.save}

    def state(self) -> dict[str, Any]:
        return {
            "rows": list(self.bar.names()),
            "box": self.bar.box.value(),
            "values": {key: panel.values.value() for key, panel in self.variations.items()},
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        rows, values = state.get("rows"), state.get("values")
        if isinstance(rows, list):
            self.bar.set_names(rows)
        if self.bar.box.findData(state.get("box")) >= 0:
            self.bar.box.setValue(str(state["box"]))
        for key, text in values.items() if isinstance(values, dict) else ():
            if key in self.variations and isinstance(text, str):
                self.variations[key].values.setValue(text)

    def run_all(self) -> None:
        """Start all studies that the choices allow, and the gallery."""
        if not self._session.particles:
            self._context.toast.problem(tr("No particle is open; open a mesh first."))
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
            self._context.toast.problem(tr("No particle is open; open a mesh first."))
            return
        ids = [entry.id for entry in entries]
        first = ids.index(self._session.choices.selected) if self._session.choices.selected in ids else 0
        shown = [*entries[first:], *entries[:first]][:MAX_PARTICLES]
        rows = chosen_rows(self.bar.names(), self._session.choices)
        self._drawn = [row.label for row in rows], [entry.particle.name for entry in shown]
        self.gallery.begin([entry.id for entry in shown], [translate(row.label) for row in rows])
        job = Job(
            coarsen_gallery,
            (tuple(entry.particle for entry in shown), self._session.choices.coarsening_request, rows),
        )
        show = self.gallery.show_cells
        self._context.start(tr("Coarsening for the gallery"), job, show, partial=show, queue="gallery")

    def save(self) -> None:
        """Ask for a folder and write tables and figures of all results."""
        found = {kind.value: getattr(self._session.results, kind.value) for kind in KINDS}
        found |= {f"{key}_study": study for key, study in self.sweeps.results.items() if study.names}
        if cells := self.gallery.value():
            found["solids_study"] = study_of_cells(cells, *self._drawn)
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
        self._context.toast.note(
            tr("{count} files were written to {folder}.", count=len(paths), folder=paths[0].parent), listed
        )

    def _wire(self, kind: Kind, panel: LmaxStudyPanel | CoarseningStudyPanel) -> None:
        session, bindings = self._session, self._context.bindings

        def show() -> None:
            panel.show_study(getattr(session.results, kind.value), kind.value in session.results.outdated)

        def tasks() -> None:
            panel.frame.show_task(next((task for task in session.tasks if task.queue == kind), None))

        panel.frame.startRequested.connect(partial(self.start, kind))
        panel.frame.cancelRequested.connect(session.cancel)
        bindings.refresh(kind.value, show, slow=True)
        bindings.refresh("tasks", tasks, slow=True)
        bindings.refresh("particles", lambda: panel.frame.set_count(len(session.particles)))

    def _show_l_max(self) -> None:
        self.lmax_study.show_l_max(self._session.choices.l_max)

    def _show_gallery_task(self) -> None:
        mine = [task for task in self._session.tasks if task.queue == f"{self._context.key}:gallery"]
        self.gallery.frame.show_task(mine[0] if mine else None)

    def _name_gallery_button(self) -> None:
        count = len(self._session.particles)
        self.gallery.frame.set_count(count)
        self.gallery.frame.start.setText(
            tr_count(
                N_("Draw the polyhedra of this particle"),
                N_("Draw the polyhedra of {count} particles"),
                min(count, MAX_PARTICLES),
            )
        )

    def _tabs(self) -> QTabWidget:
        pages = [(self.variations[key], tr(title)) for key, title in TABS.items()]
        return tabs("studies_coarsening", [(self.coarsening_study, tr("Losses")), *pages])

    def _place(self) -> None:
        above = side_by_side(
            [_titled(tr(LMAX_TITLE), _framed(self.lmax_study)), _titled(tr(COARSENING_TITLE), self.tabs)],
            [320, 1020],
            stretch=1,
        )
        above.setObjectName("studies_figures")
        self.tabs.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)  # keeps its buttons
        below = _titled(tr("Polyhedra by loss function (Fig. 7)"), _framed(self.gallery))
        rows = stacked([above, below], [370, 500], stretch=1)
        rows.setObjectName("studies_rows")
        parts = [padded(rows, 10, 10, 2, 8), scrolled_column([self.bar], 0)]
        columns = side_by_side(parts, [1200, BAR_WIDTH], stretch=0)
        columns.setObjectName("studies_columns")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(columns)


def _titled(title: str, part: QWidget) -> QWidget:
    frame = QWidget()
    column = QVBoxLayout(frame)
    column.setContentsMargins(0, 0, 0, 0)
    column.addWidget(heading(title))
    column.addWidget(part, 1)
    return frame


def _framed(part: QWidget) -> QTabWidget:
    """A single widget with the border and background of tabs."""
    box = QTabWidget()
    box.tabBar().hide()
    for bare in (box, box.tabBar()):
        bare.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # a hidden bar would hold Tab back
    box.addTab(part, "")
    return box
