"""What a choice of loss weights means for the descriptors of coarsened particles (section 3.2, Fig. 8)."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.settings import DEFAULT_METHOD
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import (
    N_RESAMPLES,
    band_of,
    describe,
    pooled_rmsre,
    relative_errors,
    resampled_counts,
)
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit_options import DEFAULT_FIT_OPTIONS, FitOptions
from regolith_studio.harmonics.synthesis import reconstruct
from regolith_studio.io.tables import Column, Table
from regolith_studio.studies import Mapper, StudyProgress
from regolith_studio.studies.loss_variants import LossVariant, paper_variants

COLUMNS = (*LOSS_KEYS, JACCARD)
"""Columns of the errors: the descriptors of Eq. 8 and the distance of Eq. 7."""
MIN_PLOTTED = 1e-3
"""Errors below this percentage are drawn as this."""


@dataclass(frozen=True)
class TargetChoice:
    """What is coarsened: the ``particle`` itself, or its ``fit`` cut at `l_max` (as in the paper)."""

    kind: str = "particle"
    l_max: int = 10
    level: int = 4
    fit_options: FitOptions = DEFAULT_FIT_OPTIONS

    def mesh_of(self, mesh: Mesh) -> Mesh:
        """The mesh to be coarsened."""
        if self.kind == "particle":
            return mesh
        return reconstruct(self.fit_options.fit(mesh, self.l_max), self.l_max, self.level)


@dataclass(frozen=True, eq=False)
class CoarseningStudy:
    """Relative errors of coarsened particles, by row.

    - ``rows``: how they were coarsened.
    - ``names``: of the particles that could be coarsened by every row.
    - ``errors``: absolute relative errors of Eq. 8 by particle, row and :data:`COLUMNS` (the last is the
      Jaccard distance), shape (particles, rows, 7).
    - ``failures``: name and sentence of each particle that could not be coarsened.
    - ``n_unmet``: by row, the number of particles whose request could not be met exactly, with a reason
      given.
    - ``box_metric``: of the bounding boxes: ``exact``, or ``trimesh`` to compare with the paper's program.
    - ``confidence``, ``seed``: of the bootstrap bands.
    """

    rows: tuple[LossVariant, ...]
    names: tuple[str, ...] = ()
    errors: FloatArray = field(default_factory=lambda: np.empty((0, 0, len(COLUMNS))))
    failures: tuple[tuple[str, str], ...] = ()
    n_unmet: tuple[int, ...] = ()
    box_metric: str = "exact"
    confidence: float = 0.95
    seed: int = 0

    @cached_property
    def rmsre(self) -> FloatArray:
        """RMSRE of Eq. 10 by row and column; the last column is the mean Jaccard distance."""
        pooled: FloatArray = _pooled(self.errors, np.ones((1, len(self.names))))[0]
        return pooled

    @cached_property
    def bands(self) -> FloatArray:
        """Ends of the bootstrap band over particles, shape (2, rows, columns)."""
        return self.band_of(self.resampled)

    @cached_property
    def resampled(self) -> FloatArray:
        """:attr:`rmsre` of resampled particles, the same ones in all rows: (resamples, rows, columns)."""
        return _pooled(self.errors, resampled_counts(len(self.names), self.seed))

    def band_of(self, resampled: FloatArray) -> FloatArray:
        """Ends of the band of anything made from :attr:`resampled`, along its first axis."""
        return band_of(resampled, self.confidence)


def _pooled(errors: FloatArray, counts: FloatArray) -> FloatArray:
    """RMSRE (last column: mean) with each particle counted `counts` times, shape (b, rows, columns)."""
    pooled = pooled_rmsre(errors, counts)
    # The Jaccard distance is an error already, not relative to a value of the particle: its mean says more.
    pooled[..., -1] = pooled_rmsre(np.sqrt(np.maximum(errors[..., -1:], 0.0)), counts)[..., 0] ** 2
    return pooled


def coarsening_errors(
    mesh: Mesh,
    rows: Sequence[LossVariant],
    seed: int = 0,
    target: TargetChoice | None = None,
    box_metric: str = "exact",
) -> tuple[FloatArray, tuple[bool, ...]] | str:
    """Errors of one particle by row and column, and which rows met their request; or why there are none.

    Pure and picklable: for process pools.
    """
    try:
        goal = Target.of((target or TargetChoice()).mesh_of(mesh))
        measured = describe(goal.mesh, LOSS_KEYS, box_metric)
        results = coarsened_rows(goal, rows, seed)
        table = [_row_errors(result, measured, box_metric) for result in results]
    except RegolithError as error:
        return str(error)
    return np.array(table), tuple(result.reason is None for result in results)


def coarsened_rows(target: Target, rows: Sequence[LossVariant], seed: int) -> list[CoarseningResult]:
    """The particle coarsened by each row.

    A row that differs from earlier ones by more facets alone has one more start, from the best of their
    results, so that the loss falls with the number of facets.
    """
    results: list[CoarseningResult] = []
    for row in rows:
        settings = dict(row.settings_run)
        alike = [
            result
            for earlier, result in zip(rows, results, strict=False)
            if earlier.n_facets < row.n_facets
            and row.relabelled(earlier.label, n_facets=earlier.n_facets) == earlier
        ]
        fewer = min(alike, key=lambda result: (result.reason is not None, result.loss), default=None)
        start = None if fewer is None else fewer.half_spaces
        results.append(coarsen(target, row.n_facets, row.method_run, row.weights, seed, settings, start))
    return results


def _row_errors(result: CoarseningResult, measured: Any, box_metric: str) -> list[float]:
    """Errors of the polyhedron that the method returned, which is also what a gallery shows."""
    if box_metric == "exact":
        errors = dict(result.errors)
    else:
        errors = relative_errors(measured, describe(_in_unit_frame(result), LOSS_KEYS, box_metric))
    return [*[errors[key] for key in LOSS_KEYS], result.jaccard_distance]


def _in_unit_frame(result: CoarseningResult) -> Polyhedron:
    return result.polyhedron.moved(scale=result.target["volume"] ** (-1 / 3))


def coarsening_study(
    particles: Sequence[Particle],
    rows: Sequence[LossVariant] | None = None,
    n_facets: int = 20,
    method: str = DEFAULT_METHOD,
    seed: int = 0,
    settings: Any = None,
    target: TargetChoice | None = None,
    box_metric: str = "exact",
    mapper: Mapper = map,
) -> Generator[StudyProgress, None, CoarseningStudy]:
    """Coarsen every particle by every row and compare descriptors (Fig. 8).

    Yields a :class:`StudyProgress` a particle, whose `partial` is the study so far, and returns the study.
    A particle that cannot be coarsened is listed in `failures` and stops nothing.

    ``rows``: the paper's rows with `method`, `n_facets` and `settings` where not given.

    Raises InputError if there is no particle or no row, or no particle can be coarsened.
    """
    chosen = paper_variants(method, n_facets, **dict(settings or {})) if rows is None else tuple(rows)
    if not particles or not chosen:
        raise InputError("A study of the coarsening needs at least one particle and one row of weights.")
    work = partial(coarsening_errors, rows=chosen, seed=seed, target=target, box_metric=box_metric)
    study = CoarseningStudy(
        chosen, errors=np.empty((0, len(chosen), len(COLUMNS))), box_metric=box_metric, seed=seed
    )
    outcomes = mapper(work, [particle.mesh for particle in particles])
    for done, (particle, outcome) in enumerate(zip(particles, outcomes, strict=True), start=1):
        study = _with_outcome(study, particle, outcome)
        yield StudyProgress(done, len(particles), particle.name, study if study.names else None)
    if not study.names:
        raise InputError(f"None of the {len(particles)} particles can be coarsened: {study.failures[0][1]}")
    return study


def _with_outcome(study: CoarseningStudy, particle: Particle, outcome: Any) -> CoarseningStudy:
    if isinstance(outcome, str):
        return replace(study, failures=(*study.failures, (particle.name, outcome)))
    errors, met = outcome
    before = study.n_unmet or (0,) * len(study.rows)
    return replace(
        study,
        names=(*study.names, particle.name),
        errors=np.concatenate([study.errors, errors[None]]),
        n_unmet=tuple(count + (not fine) for count, fine in zip(before, met, strict=True)),
    )


def study_notes(study: CoarseningStudy) -> tuple[str, ...]:
    """What a reader of any table of the study needs: particles, boxes, bands, weights, what was left out."""
    weights = [
        f"{row.label}: "
        + (", ".join(f"{key} {value:g}" for key, value in row.weights.items() if value) or "0")
        for row in study.rows
    ]
    return (
        f"{len(study.names)} particles; bounding boxes: {study.box_metric}.",
        f"Bands: {study.confidence:.0%}, {N_RESAMPLES} resamples of the particles, seed {study.seed}.",
        *weights,
        *(f"{name} was left out: {reason}" for name, reason in study.failures),
    )


def rmsre_table(study: CoarseningStudy) -> Table:
    """Fig. 8 as numbers: a row for each row of weights and each descriptor."""
    values, (low, high) = 100 * study.rmsre, 100 * study.bands
    lines = [
        (row.label, row.method_run, row.n_facets, key, values[r, k], low[r, k], high[r, k], study.n_unmet[r])
        for r, row in enumerate(study.rows)
        for k, key in enumerate(COLUMNS)
    ]
    percent = [Column(name, "%") for name in ("rmsre", "rmsre_low", "rmsre_high")]
    columns = (*map(Column, ("row", "method", "facets", "descriptor")), *percent, Column("n_unmet"))
    notes = (
        "Root mean square over particles of the relative errors of Eq. 8; jaccard_distance: mean (Eq. 7).",
        *study_notes(study),
    )
    return Table("RMSRE of coarsened particles by loss", columns, tuple(lines), notes)


def particle_table(study: CoarseningStudy) -> Table:
    """Relative error of every descriptor of every particle in every row."""
    lines = [
        (name, row.label, row.method_run, row.n_facets, *(100 * study.errors[i, r]))
        for i, name in enumerate(study.names)
        for r, row in enumerate(study.rows)
    ]
    columns = (*map(Column, ("name", "row", "method", "facets")), *(Column(key, "%") for key in COLUMNS))
    return Table("Relative errors of every coarsened particle", columns, tuple(lines))
