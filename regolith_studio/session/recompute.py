"""Recompute the results of the selected particle when choices change."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol

from regolith_studio.descriptors.comparison import relative_errors
from regolith_studio.jobs.coarsening_jobs import coarsen_one
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.particle_jobs import FitRequest, describe_meshes, draw_surface, fit_one
from regolith_studio.messages import N_
from regolith_studio.session.choices import LIVE, Choices, Kind, needs, plan
from regolith_studio.session.results import ParticleEntry, Results
from regolith_studio.session.tasks import Reactions, TaskBoard

if TYPE_CHECKING:
    from regolith_studio.coarsening.progress import CoarseningProgress
    from regolith_studio.coarsening.result import CoarseningResult
    from regolith_studio.descriptors.describe import Descriptors
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.harmonics.fit import HarmonicFit
    from regolith_studio.harmonics.fit_options import FitOptions

TITLES = {
    Kind.FIT: N_("Fitting spherical harmonics"),
    Kind.SURFACE: N_("Drawing the fit"),
    Kind.DESCRIPTORS: N_("Measuring the fit"),
    Kind.COARSENING: N_("Coarsening"),
}
_EMPTY: Mapping[Kind, Mapping[str, Any]] = {
    Kind.FIT: {"fit": None},
    Kind.SURFACE: {"surface": None, "surface_l_max": 0},
    Kind.DESCRIPTORS: {"particle_descriptors": None, "fit_descriptors": None, "fit_errors": {}},
    Kind.COARSENING: {"best": None, "coarsening_progress": None, "coarsened": None, "loss_history": ()},
}
"""What the results hold of each kind while there is nothing to show."""
FITS_KEPT = 256
"""Fits that are at hand when their particle is selected again; 10 kB each."""


class Owner(Protocol):
    """What the live results need of their session."""

    results: Results
    particles: tuple[ParticleEntry, ...]

    @property
    def choices(self) -> Choices: ...
    @property
    def selected(self) -> ParticleEntry | None: ...
    def update(self, *events: str, **changes: Any) -> None: ...
    def tell_failure(self, title: str) -> Callable[[Failed], None]: ...


class LiveResults:
    """Starts each kind of work when it is due and what it needs is there."""

    def __init__(self, owner: Owner, board: TaskBoard) -> None:
        self._owner, self._board = owner, board
        self._due: set[Kind] = set()
        self._fits: dict[tuple[str, FitOptions], HarmonicFit] = {}
        self._measured: dict[tuple[str, str], Descriptors] = {}
        self._losses: list[tuple[int, float]] = []
        self._has_shown = False

    def forget(self) -> None:
        """Drop what is kept of each particle, because ids have got another meaning."""
        self._fits.clear()
        self._measured.clear()

    def follow(self, before: Choices | None, after: Choices) -> None:
        """Start, or start anew, what the change makes necessary."""
        requests = plan(before, after, {id for id, way in self._fits if way == after.fit_options})
        if before is None or before.selected != after.selected:
            self._show_nothing(*LIVE)
        self._take_fit_at_hand(after)
        same = before is not None and before.selected == after.selected
        for request in requests:
            if not (same and self._may_finish(request.kind)):
                self._board.stop_lane(request.kind)
        self._due = {request.kind for request in requests} | (self._due if after.selected else set())
        results = self._owner.results
        for kind, made in ((Kind.FIT, results.fit), (Kind.SURFACE, results.surface)):
            if made is None and not self._is_open(kind):
                self._drop_dependents(kind)
        self._advance()

    def _take_fit_at_hand(self, choices: Choices) -> None:
        fit = self._fits.get((choices.selected, choices.fit_options))
        if fit is None:
            return
        self._board.stop_lane(Kind.FIT)
        self._due.discard(Kind.FIT)
        if fit is not self._owner.results.fit:
            self._owner.update("fit", fit=fit)

    def _may_finish(self, kind: Kind) -> bool:
        """Whether older work shall still be shown: else nothing would be seen while a slider is dragged."""
        return self._board.is_running(kind) and (
            kind is Kind.SURFACE or (kind is Kind.COARSENING and not self._has_shown)
        )

    def _show_nothing(self, *kinds: Kind) -> None:
        for kind in kinds:
            self._board.stop_lane(kind)
            self._owner.update(kind.value, **_EMPTY[kind])

    def _advance(self) -> None:
        for kind in LIVE:
            waits = self._board.is_running(kind) or any(map(self._is_open, needs(kind, self._owner.choices)))
            if kind in self._due and not waits:
                self._due.discard(kind)
                self._start(kind)

    def _is_open(self, kind: Kind) -> bool:
        return kind in self._due or self._board.is_running(kind)

    def _start(self, kind: Kind) -> None:
        job, keep, partial = getattr(self, f"_{kind.value}")()

        def finished(value: Any) -> None:
            keep(value)
            self._advance()

        def failed(failure: Failed) -> None:
            if kind in self._due:  # what was asked for meanwhile may well succeed
                self._advance()
                return
            self._drop_dependents(kind)
            self._show_nothing(kind)
            self._owner.tell_failure(TITLES[kind])(failure)

        reactions = Reactions(finished, partial, failed, lambda: self._drop_dependents(kind))
        self._board.start(kind, TITLES[kind], job, reactions)

    def _drop_dependents(self, kind: Kind) -> None:
        """Give up what is made from `kind`, and show nothing rather than something old."""
        for other in LIVE:
            if kind in needs(other, self._owner.choices) and other in self._due:
                self._due.discard(other)
                self._show_nothing(other)
                self._drop_dependents(other)

    def _entry(self) -> ParticleEntry:
        entry = self._owner.selected
        assert entry is not None, "nothing is planned without a selected particle"
        return entry

    def _fit(self) -> "_Work":
        entry, fit_options = self._entry(), self._owner.choices.fit_options

        def keep(fit: "HarmonicFit") -> None:
            self._fits[entry.id, fit_options] = fit
            if len(self._fits) > FITS_KEPT:
                del self._fits[next(iter(self._fits))]
            self._owner.update("fit", fit=fit)

        return Job(fit_one, (entry.particle.mesh, FitRequest(fit_options=fit_options))), keep, _ignore

    def _surface(self) -> "_Work":
        choices = self._owner.choices
        job = Job(draw_surface, (self._owner.results.fit, choices.l_max, choices.level))

        def keep(mesh: "Mesh") -> None:
            self._owner.update("surface", surface=mesh, surface_l_max=choices.l_max)

        return job, keep, _ignore

    def _descriptors(self) -> "_Work":
        entry, metric = self._entry(), self._owner.choices.box_metric
        meshes = {"fit": self._owner.results.surface}
        if (entry.id, metric) not in self._measured:
            meshes["particle"] = entry.particle.mesh

        def keep(described: "dict[str, Descriptors]") -> None:
            fit = described["fit"]
            particle = self._measured.setdefault((entry.id, metric), described.get("particle", fit))
            errors = relative_errors(particle, fit)
            self._owner.update(
                "descriptors", particle_descriptors=particle, fit_descriptors=fit, fit_errors=errors
            )

        return Job(describe_meshes, (meshes, metric)), keep, _ignore

    def _coarsening(self) -> "_Work":
        choices, entry = self._owner.choices, self._entry()
        target = self._owner.results.surface if choices.target == "fit" else entry.particle.mesh
        self._has_shown = False
        self._losses = []
        self._owner.update("coarsening", coarsened=None, coarsening_progress=None, loss_history=())
        job = Job(coarsen_one, (target, choices.order, self._owner.particles.index(entry)))
        return job, self._keep_coarsened, self._keep_progress

    def _keep_progress(self, step: "CoarseningProgress") -> None:
        self._losses.append((step.step, step.loss))
        best = step if step.polyhedron else self._owner.results.best
        history = tuple(self._losses)
        self._owner.update("coarsening", coarsening_progress=step, best=best, loss_history=history)
        self._has_shown = self._has_shown or step.polyhedron is not None
        if self._has_shown and Kind.COARSENING in self._due:
            self._board.stop_lane(Kind.COARSENING)
            self._advance()

    def _keep_coarsened(self, done: "CoarseningResult") -> None:
        history = tuple(enumerate(done.loss_history))
        self._owner.update("coarsening", coarsened=done, best=done, loss_history=history)


_Work = tuple[Job, Callable[[Any], None], Callable[[Any], None]]


def _ignore(_value: Any) -> None:
    """Partial results of work that is over in a moment."""
