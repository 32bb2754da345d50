"""Searches the number of facets from which on nothing is gained, for the particle on screen."""

from dataclasses import replace

from PySide6.QtCore import QObject

from regolith_studio.jobs.events import Job
from regolith_studio.jobs.study_jobs import study_coarsening
from regolith_studio.session.choices import Choices
from regolith_studio.session.study_requests import varied_rows
from regolith_studio.studies.coarsening import CoarseningStudy
from regolith_studio.studies.sweeps import SWEEPS, sufficient_facets
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.panels.coarsening import CoarseningPanel
from regolith_studio.ui.translation import tr

LANE = "facets"


class FacetSearch(QObject):
    """Coarsens the particle at several numbers of facets, and offers the one that is enough.

    Parameters
    ----------
    context
        Of the page.
    panel
        Has the button; shows the answer.
    """

    def __init__(self, context: PageContext, panel: CoarseningPanel, parent: QObject) -> None:
        super().__init__(parent)
        self._context, self._session, self._panel = context, context.session, panel
        self._found: tuple[Choices, int, bool] | None = None
        panel.searchRequested.connect(self.start)
        context.bindings.refresh("choices particles coarsening tasks", self._show)

    def start(self) -> None:
        """Start the search with the present choices."""
        particle, choices = self._session.selected, self._session.choices
        if particle is None:
            self._context.toast.problem(tr("No particle is open; open a mesh first."))
            return
        sweep = SWEEPS["facets"]
        rows = varied_rows("facets", choices, ", ".join(f"{value:g}" for value in sweep.values))
        options = {"rows": rows, "box_metric": choices.box_metric}
        job = Job(study_coarsening, ((particle.particle,), choices.coarsening_request), options)
        self._context.start(
            tr("Searching for the sufficient number of facets"),
            job,
            lambda study: self._take(choices, study),
            lane=LANE,
        )

    def _take(self, choices: Choices, study: CoarseningStudy) -> None:
        if study.names:
            enough = sufficient_facets(study)
            self._found = choices, enough, enough < max(row.n_facets for row in study.rows)
        self._show()

    def _show(self) -> None:
        """Show the answer while it belongs to the present choices."""
        choices, results = self._session.choices, self._session.results
        running = any(task.lane == f"{self._context.key}:{LANE}" for task in self._session.tasks)
        if self._found is not None and not _differ_in_facets_only(self._found[0], choices):
            self._found = None
        if self._found is not None:
            _, enough, saturated = self._found
            self._panel.show_sufficient(enough, saturated=saturated, now=choices.facet_count)
        elif results.fewer_facets is not None:
            self._panel.show_sufficient(results.fewer_facets[0], saturated=True, now=choices.facet_count)
        else:
            self._panel.show_search(running=running)


def _differ_in_facets_only(one: Choices, other: Choices) -> bool:
    return replace(one, n_facets=other.n_facets) == other
