"""Parameter sweeps of a coarsening: number of facets, overlap against descriptors, one weight at a time."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regolith_studio.coarsening.reasons import EXACT
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_
from regolith_studio.studies.coarsening import COLUMNS, CoarseningStudy, rmsre_table, study_notes
from regolith_studio.studies.loss_variants import (
    CHANGE_FACTORS,
    CONDITION_METHODS,
    FACET_COUNTS,
    OVERLAP_FACTORS,
    LossVariant,
    facet_count_variants,
    sensitivity_variants,
    tradeoff_variants,
)

GAIN = 1e-3
"""A fall of an error of at most 0.1 percentage points is no gain."""


@dataclass(frozen=True)
class Sweep:
    """What is varied.

    - ``key``: in file names and commands.
    - ``title``: on screen.
    - ``asks``: what the values are.
    - ``values``: those that are proposed.
    - ``rows``: the rows of the study, from one row and the values.
    - ``table``: what was found.
    """

    key: str
    title: str
    asks: str
    values: tuple[float, ...]
    rows: Callable[[LossVariant, Sequence[float]], tuple[LossVariant, ...]]
    table: Callable[[CoarseningStudy], Table]

    def takes_values(self, method: str) -> bool:
        """Whether the values matter: conditions are kept or left, whatever their weights."""
        return self.key != "tradeoff" or method not in CONDITION_METHODS


def parse_values(text: str) -> tuple[float, ...]:
    """Numbers with commas between them.

    Raises InputError if a word is no number, or there is none.
    """
    try:
        values = tuple(float(word) for word in text.split(",") if word.strip())
    except ValueError:
        values = ()
    if not values or not np.isfinite(values).all():
        raise InputError(f"Write numbers with commas between them, such as 8, 20, 50; got {text!r}.")
    return values


def descriptor_error(rmsre: FloatArray) -> FloatArray:
    """Mean RMSRE of the six descriptors of the loss: all columns but the last (the overlap)."""
    return np.asarray(rmsre[..., :-1].mean(axis=-1))


def best_row(study: CoarseningStudy) -> int:
    """The row of the smallest :func:`descriptor_error`; of ties (:data:`EXACT`), that of the best overlap."""
    error = descriptor_error(study.rmsre)
    ties = np.flatnonzero(error <= error.min() + EXACT)
    return int(ties[study.rmsre[ties, -1].argmin()])


def pareto_front(study: CoarseningStudy) -> tuple[int, ...]:
    """Rows that no other row beats in both overlap and :func:`descriptor_error`, by their overlap."""
    distance, error = study.rmsre[:, -1], descriptor_error(study.rmsre)
    kept: list[int] = []
    for row in sorted(range(len(study.rows)), key=lambda r: (distance[r], error[r])):
        if not kept or error[row] < error[kept[-1]]:
            kept.append(row)
    return tuple(kept)


def differences(study: CoarseningStudy) -> tuple[FloatArray, FloatArray]:
    """RMSRE of the rows after the first minus that of the first, and the paired bootstrap band.

    Shapes (rows - 1, columns) and (2, rows - 1, columns); the last column is the Jaccard distance.
    """
    resampled = study.resampled[:, 1:] - study.resampled[:, :1]
    return study.rmsre[1:] - study.rmsre[:1], study.band_of(resampled)


def significant(study: CoarseningStudy) -> NDArray[np.bool_]:
    """Which :func:`differences` are larger than what :data:`EXACT` allows, with a band that leaves 0 out."""
    values, (low, high) = differences(study)
    return np.asarray((np.abs(values) > EXACT) & ((low > 0) | (high < 0)))


def sufficient_facets(study: CoarseningStudy) -> int:
    """The fewest facets from which on no error falls by more than :data:`GAIN` beyond chance.

    A fall is beyond chance where its paired bootstrap band leaves 0 out. Where the errors still fall, it is
    the largest number of the study.
    """
    facets = np.array([row.n_facets for row in study.rows])
    for row in np.argsort(facets):
        more = facets > facets[row]
        fall = study.rmsre[row] - study.rmsre[more]
        low, _ = study.band_of(study.resampled[:, [row]] - study.resampled[:, more])
        if not ((fall > GAIN) & (low > 0)).any():
            break
    return int(facets[row])


def format_difference(points: float) -> str:
    """A change in percentage points with its sign; 0 where it cannot be seen."""
    return "0" if abs(points) < 0.005 else f"{points:+.2f}"


def tradeoff_table(study: CoarseningStudy) -> Table:
    """Overlap and descriptors of every row, with bands; and whether another row is better in both."""
    values, (low, high) = 100 * study.rmsre, 100 * study.bands
    error = 100 * descriptor_error(study.rmsre)
    error_low, error_high = 100 * study.band_of(descriptor_error(study.resampled))
    best = pareto_front(study)
    lines = [
        (
            row.label,
            *(values[r, -1], low[r, -1], high[r, -1]),
            *(error[r], error_low[r], error_high[r]),
            *values[r, :-1],
            study.n_unmet[r],
            "yes" if r in best else "no",
        )
        for r, row in enumerate(study.rows)
    ]
    percent = [
        Column(f"{name}{end}", "%") for name in (JACCARD, "mean_rmsre") for end in ("", "_low", "_high")
    ]
    columns = (
        Column("row"),
        *percent,
        *(Column(key, "%") for key in LOSS_KEYS),
        Column("n_unmet"),
        Column("efficient"),
    )
    notes = (
        "jaccard_distance: mean over particles (Eq. 7); the others: RMSRE (Eq. 10), mean_rmsre over all six.",
        "efficient: no other row has both a smaller distance and a smaller mean_rmsre.",
        *study_notes(study),
    )
    return Table(N_("Overlap against descriptors"), columns, tuple(lines), notes)


def sensitivity_table(study: CoarseningStudy) -> Table:
    """What changing one weight changes: a row for each change and descriptor, in percentage points."""
    if len(study.rows) < 2:
        raise InputError("A sensitivity needs at least one changed weight.")
    values, (low, high) = (100 * each for each in differences(study))
    beyond = significant(study)
    lines = [
        (
            row.label,
            key,
            100 * study.rmsre[0, k],
            100 * study.rmsre[r + 1, k],
            *(values[r, k], low[r, k], high[r, k]),
            "yes" if beyond[r, k] else "no",
        )
        for r, row in enumerate(study.rows[1:])
        for k, key in enumerate(COLUMNS)
    ]
    columns = (
        *map(Column, ("change", N_("descriptor"))),
        *(Column(name, "%") for name in ("as_given", "changed")),
        *(Column(name, "pp") for name in ("difference", "difference_low", "difference_high")),
        Column("beyond_chance"),
    )
    notes = (
        "RMSRE (Eq. 10), jaccard_distance: mean (Eq. 7), with one weight changed, minus that as given.",
        "pp: percentage points.",
        "The same resamples of the particles on both sides; beyond_chance: the band leaves 0 out, and the "
        f"difference is larger than {100 * EXACT:g} pp.",
        *study_notes(study),
    )
    return Table("Sensitivity of coarsened particles to the weights", columns, tuple(lines), notes)


SWEEPS: Mapping[str, Sweep] = {
    each.key: each
    for each in (
        Sweep(
            "facets",
            N_("Error against the number of facets"),
            N_("Numbers of facets"),
            tuple(map(float, FACET_COUNTS)),
            facet_count_variants,
            rmsre_table,
        ),
        Sweep(
            "tradeoff",
            N_("Overlap against descriptors"),
            N_("Factors on the overlap weight"),
            OVERLAP_FACTORS,
            tradeoff_variants,
            tradeoff_table,
        ),
        Sweep(
            "sensitivity",
            N_("Sensitivity to the weights"),
            N_("Factors on one weight at a time"),
            CHANGE_FACTORS,
            sensitivity_variants,
            sensitivity_table,
        ),
    )
}
"""By key."""
