"""Starts the sweeps of the coarsening, keeps their results and shows them."""

from collections.abc import Mapping
from functools import partial

from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.study_jobs import study_coarsening
from regolith_studio.session.choices import Choices, Kind, depends
from regolith_studio.session.study_requests import COMPOUND, varied_rows
from regolith_studio.studies.coarsening import CoarseningStudy
from regolith_studio.studies.sweeps import SWEEPS
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.studies.loss_selector import LossSelector
from regolith_studio.ui.pages.studies.sweep_panel import SweepPanel
from regolith_studio.ui.translation import tr


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
        choices, particles = self._session.choices, tuple(e.particle for e in self._session.particles)
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
        self._context.start(title, job, partial(self._end, key), partial=take, lane=key)

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
            lane = f"{self._context.key}:{key}"
            panel.frame.show_task(next((task for task in self._session.tasks if task.lane == lane), None))
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
