"""Recompute the results of the selected particle when choices change."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol

from regolith_studio.coarsening.settings import FACETS_LIMITS
from regolith_studio.descriptors.describe import relative_errors
from regolith_studio.jobs.coarsening_jobs import coarsen_one, compare_with_particle
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.particle_jobs import FitRequest, describe_meshes, draw_surface, fit_one
from regolith_studio.messages import N_
from regolith_studio.session.choices import (
    LIVE,
    PARTICLE_DESCRIPTORS,
    Choices,
    Kind,
    dependencies,
    inputs,
    needs,
    plan,
)
from regolith_studio.session.results import ParticleEntry, Results
from regolith_studio.session.tasks import Reactions, TaskBoard

if TYPE_CHECKING:
    from regolith_studio.coarsening.progress import CoarseningProgress
    from regolith_studio.coarsening.result import CoarseningResult
    from regolith_studio.descriptors.describe import Descriptors
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.harmonics.fit import HarmonicFit

TITLES = {
    Kind.FIT: N_("Fitting spherical harmonics"),
    Kind.SURFACE: N_("Drawing the fit"),
    Kind.DESCRIPTORS: N_("Measuring the fit"),
    Kind.COARSENING: N_("Coarsening"),
    Kind.COMPARISON: N_("Comparing with the particle"),
}
STOPPED = N_("Stopped; any change of the settings begins again.")
_EMPTY: Mapping[Kind, Mapping[str, Any]] = {
    Kind.FIT: {"fit": None},
    Kind.SURFACE: {"surface": None, "surface_l_max": 0},
    Kind.DESCRIPTORS: {"particle_descriptors": None, "fit_descriptors": None, "fit_errors": {}},
    Kind.COARSENING: {
        "best": None,
        "coarsening_progress": None,
        "coarsened": None,
        "loss_history": (),
        "fewer_facets": None,
    },
    Kind.COMPARISON: {"against_particle": None},
}
"""Fields of the results of each kind while there is none."""
MAX_CACHED_FITS = 256
"""Number of fits that are cached for particles selected again; 10 kB each."""


class SessionState(Protocol):
    """The part of :class:`~regolith_studio.session.session.Session` that live results use."""

    results: Results
    particles: tuple[ParticleEntry, ...]

    @property
    def choices(self) -> Choices: ...
    @property
    def selected(self) -> ParticleEntry | None: ...
    def update(self, *events: str, **changes: Any) -> None: ...
    def failure_reporter(self, title: str) -> Callable[[Failed], None]: ...


class LiveResults:
    """Starts the job of each kind of result when it is due and its inputs are there."""

    def __init__(self, session: SessionState, board: TaskBoard) -> None:
        self._session, self._board = session, board
        self._due: set[Kind] = set()
        # keyed by the values of all choices that the result depends on, so that none of them can be forgotten
        self._fits: dict[tuple[Any, ...], HarmonicFit] = {}
        self._particle_descriptors: dict[tuple[Any, ...], Descriptors] = {}
        self._losses: list[tuple[int, float]] = []
        self._last: tuple[CoarseningResult, Choices] | None = None
        self._trials: dict[tuple[Any, ...], dict[int, float]] = {}
        self._has_shown = False

    def clear_cache(self) -> None:
        """Drop cached results, because ids refer to other particles now."""
        self._last = None
        self._fits.clear()
        self._trials.clear()
        self._particle_descriptors.clear()

    def follow(self, before: Choices | None, after: Choices) -> None:
        """Start the jobs that a change of choices makes necessary."""
        requests = plan(before, after, _key(Kind.FIT, after) in self._fits)
        if before is None or before.selected != after.selected:
            self._clear(*LIVE)
        self._use_cached_fit(after)
        same = before is not None and before.selected == after.selected
        for request in requests:
            if not (same and self._may_finish(request.kind)):
                self._board.stop_queue(request.kind)
        self._due = {request.kind for request in requests} | (self._due if after.selected else set())
        results = self._session.results
        for kind, made in ((Kind.FIT, results.fit), (Kind.SURFACE, results.surface)):
            if made is None and not self._is_pending(kind):
                self._drop_dependents(kind)
        self._advance()

    def _use_cached_fit(self, choices: Choices) -> None:
        fit = self._fits.get(_key(Kind.FIT, choices))
        if fit is None:
            return
        self._board.stop_queue(Kind.FIT)
        self._due.discard(Kind.FIT)
        if fit is not self._session.results.fit:
            self._session.update("fit", fit=fit)

    def _may_finish(self, kind: Kind) -> bool:
        """Whether an outdated job may finish and be shown: else nothing would be seen during a drag."""
        return self._board.is_running(kind) and (
            kind is Kind.SURFACE or (kind is Kind.COARSENING and not self._has_shown)
        )

    def _clear(self, *kinds: Kind) -> None:
        for kind in kinds:
            self._board.stop_queue(kind)
            self._session.update(kind.value, failures=self._failures_without(kind), **_EMPTY[kind])

    def _failures_without(self, kind: Kind) -> Mapping[str, str]:
        return {each: why for each, why in self._session.results.failures.items() if each != kind.value}

    def _advance(self) -> None:
        for kind in LIVE:
            waits = self._board.is_running(kind) or any(
                map(self._is_pending, needs(kind, self._session.choices))
            )
            if kind in self._due and not waits:
                self._due.discard(kind)
                self._start(kind)

    def _is_pending(self, kind: Kind) -> bool:
        return kind in self._due or self._board.is_running(kind)

    def _start(self, kind: Kind) -> None:
        if kind.value in self._session.results.failures:
            self._session.update(kind.value, failures=self._failures_without(kind))
        job, keep, partial = getattr(self, f"_{kind.value}")()

        def finished(value: Any) -> None:
            keep(value)
            self._advance()

        def failed(failure: Failed) -> None:
            if kind in self._due:  # a newer request may succeed
                self._advance()
                return
            self._drop_dependents(kind)
            self._clear(kind)
            self._keep_failure(kind, failure.sentence)
            self._session.failure_reporter(TITLES[kind])(failure)

        def stopped() -> None:
            self._drop_dependents(kind)
            self._keep_failure(kind, STOPPED)

        reactions = Reactions(finished, partial, failed, stopped)
        self._board.start(kind, TITLES[kind], job, reactions, repeats=True)

    def _keep_failure(self, kind: Kind, sentence: str) -> None:
        """Keep why there is no result of this kind, nor of those that are computed from it."""
        failures = {**self._session.results.failures, kind.value: sentence}
        self._session.update(kind.value, failures=failures)
        for other in LIVE:
            if kind in needs(other, self._session.choices) and not self._is_pending(other):
                self._keep_failure(other, sentence)

    def _drop_dependents(self, kind: Kind) -> None:
        """Cancel the results that depend on `kind`, and clear them."""
        for other in LIVE:
            if kind in needs(other, self._session.choices) and other in self._due:
                self._due.discard(other)
                self._clear(other)
                self._drop_dependents(other)

    def _entry(self) -> ParticleEntry:
        entry = self._session.selected
        assert entry is not None, "nothing is planned without a selected particle"
        return entry

    def _fit(self) -> "_JobWithReactions":
        entry, choices = self._entry(), self._session.choices

        def keep(fit: "HarmonicFit") -> None:
            self._fits[_key(Kind.FIT, choices)] = fit
            if len(self._fits) > MAX_CACHED_FITS:
                del self._fits[next(iter(self._fits))]
            self._session.update("fit", fit=fit)

        return Job(fit_one, (entry.particle.mesh, FitRequest(fit_options=choices.fit_options))), keep, _ignore

    def _surface(self) -> "_JobWithReactions":
        choices = self._session.choices
        job = Job(draw_surface, (self._session.results.fit, choices.l_max, choices.level))

        def keep(mesh: "Mesh") -> None:
            self._session.update("surface", surface=mesh, surface_l_max=choices.l_max)

        return job, keep, _ignore

    def _descriptors(self) -> "_JobWithReactions":
        metric, key = self._session.choices.box_metric, inputs(self._session.choices, PARTICLE_DESCRIPTORS)
        meshes = {"fit": self._session.results.surface}
        if key not in self._particle_descriptors:
            meshes["particle"] = self._entry().particle.mesh

        def keep(described: "dict[str, Descriptors]") -> None:
            fit = described["fit"]
            particle = self._particle_descriptors.setdefault(key, described.get("particle", fit))
            errors = relative_errors(particle, fit)
            self._session.update(
                "descriptors", particle_descriptors=particle, fit_descriptors=fit, fit_errors=errors
            )

        return Job(describe_meshes, (meshes, metric)), keep, _ignore

    def _coarsening(self) -> "_JobWithReactions":
        choices, entry = self._session.choices, self._entry()
        target = self._session.results.surface if choices.target == "fit" else entry.particle.mesh
        self._has_shown = False
        self._losses = []
        self._session.update(
            "coarsening",
            coarsened=None,
            coarsening_progress=None,
            loss_history=(),
            fewer_facets=None,
            against_particle=None,
        )
        job = Job(coarsen_one, (target, choices.coarsening_request))
        return job, self._keep_coarsened, self._keep_progress

    def _keep_progress(self, step: "CoarseningProgress") -> None:
        before = self._session.results.coarsening_progress
        if before is not None and before.step == step.step:
            self._losses.pop()  # a better polyhedron of the same step
        if before is not None and before.step <= step.step:  # of the same run, whose later searches add steps
            step = dataclasses.replace(step, steps=max(before.steps, step.steps))
        self._losses.append((step.step, step.loss))
        best = self._better_of_last_result(step) if step.polyhedron else self._session.results.best
        history = tuple(self._losses)
        self._session.update("coarsening", coarsening_progress=step, best=best, loss_history=history)
        self._has_shown = self._has_shown or step.polyhedron is not None
        if self._has_shown and Kind.COARSENING in self._due:
            self._board.stop_queue(Kind.COARSENING)
            self._advance()

    def _better_of_last_result(self, step: "CoarseningProgress") -> "CoarseningProgress":
        """The step, or the last result where only weights have changed and its loss with them is smaller."""
        from regolith_studio.coarsening.loss import loss

        choices = self._session.choices
        if self._last is None or self._last[1].method != choices.method:
            return step  # another method may not know these weights
        last, made_with = self._last
        alike = made_with.replaced(weights=choices.weights)
        if _key(Kind.COARSENING, alike) != _key(Kind.COARSENING, choices):
            return step
        now = loss(choices.weights, last.errors, last.jaccard_distance)
        if now >= step.loss:
            return step
        return dataclasses.replace(
            step,
            loss=now,
            polyhedron=last.polyhedron,
            centre=last.centre,
            achieved=last.achieved,
            errors=last.errors,
            jaccard_distance=last.jaccard_distance,
        )

    def _keep_coarsened(self, done: "CoarseningResult") -> None:
        self._last = done, self._session.choices
        history = tuple(enumerate(done.loss_history))
        fewer = self._fewer_facets(done)
        self._session.update(
            "coarsening", coarsened=done, best=done, loss_history=history, fewer_facets=fewer
        )

    def _fewer_facets(self, done: "CoarseningResult") -> tuple[int, float] | None:
        """The fewest facets tried with these choices whose loss is no larger, with that loss."""
        choices = self._session.choices
        if choices.stop_at == "error" or self._board.is_running(Kind.SURFACE):
            return None
        others = dataclasses.replace(choices, stop_at="facets", n_facets=FACETS_LIMITS[0])
        trials = self._trials.setdefault(_key(Kind.COARSENING, others), {})
        trials[done.n_facets_asked] = done.loss
        return next(
            (
                each
                for each in sorted(trials.items())
                if each[0] < done.n_facets_asked and each[1] <= done.loss
            ),
            None,
        )

    def _comparison(self) -> "_JobWithReactions":
        results, metric = self._session.results, self._session.choices.box_metric
        particle = self._entry().particle.mesh
        job = Job(compare_with_particle, (particle, results.particle_descriptors, results.coarsened, metric))
        return (
            job,
            lambda comparison: self._session.update("comparison", against_particle=comparison),
            _ignore,
        )


def _key(kind: Kind, choices: Choices) -> tuple[Any, ...]:
    """What a result of `kind` for these choices is cached by."""
    return inputs(choices, dependencies(kind, choices))


_JobWithReactions = tuple[Job, Callable[[Any], None], Callable[[Any], None]]


def _ignore(_value: Any) -> None:
    """Listener of partial results of short jobs."""
