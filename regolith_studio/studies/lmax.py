"""What a chosen l_max means for the descriptors of a sample (section 3.1, Eq. 10, Fig. 3)."""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np

from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.descriptors.describe import (
    N_RESAMPLES,
    band_of,
    describe,
    pooled_rmsre,
    resampled_counts,
)
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import DEFAULT_FIT_OPTIONS, FitOptions
from regolith_studio.harmonics.synthesis import LEVEL_BY_DEGREE, gallery
from regolith_studio.io.tables import Column, Table
from regolith_studio.studies import Mapper, StudyProgress

DEFAULT_DEGREES = tuple(range(1, 21))
BOX_NOTE = (
    "The diameters are edges of the box of minimum volume. Where boxes in several directions are nearly as "
    "small, that of a fit may lie in another one than the particle's: its diameters then step, although the "
    "surface comes closer."
)
"""Agglutinate-1 of the shipped particles: from l_max = 15 to 16 the fit's box turns by 20 degrees and D_min
goes from -4.6 to +0.8 %, up to +4 % from 18 on, while the extent along the particle's own shortest edge stays
within 3 % and ends at -0.1 %. The two agglutinates alone make D_min's RMSRE rise again between 16 and 20."""
EXTRAPOLATED = ("surface_area", "sphericity", "convex_hull_volume", "convexity")
"""Descriptors that near those of the smooth surface with the square of the edge length: their values on
meshes of two levels are extrapolated. Sides of boxes are not: they jump where two boxes are nearly tied."""


@dataclass(frozen=True, eq=False)
class LmaxStudy:
    """Relative errors of descriptors of fits cut at several degrees.

    - ``degrees``: values of l_max, ascending.
    - ``keys``: descriptors, of ``CATALOGUE``.
    - ``names``, ``groups``: of the particles that could be fitted.
    - ``errors``: (D(fit) - D(particle)) / D(particle), shape (particles, degrees, keys); NaN where the fit
      has a negative radius and bounds no solid.
    - ``failures``: name and sentence of each particle that could not be fitted.
    - ``confidence``, ``seed``: of the bootstrap bands.
    """

    degrees: tuple[int, ...]
    keys: tuple[str, ...]
    names: tuple[str, ...]
    groups: tuple[str, ...]
    errors: FloatArray
    failures: tuple[tuple[str, str], ...] = ()
    confidence: float = 0.95
    seed: int = 0

    def __post_init__(self) -> None:
        errors = np.array(self.errors, dtype=np.float64)
        errors = errors.reshape(len(self.names), len(self.degrees), len(self.keys))
        errors.flags.writeable = False
        object.__setattr__(self, "errors", errors)

    @cached_property
    def _bands(self) -> dict[str | None, FloatArray]:
        return {}

    @property
    def group_names(self) -> tuple[str, ...]:
        """The groups in the order in which they first appear."""
        return tuple(dict.fromkeys(self.groups))

    def of_group(self, group: str | None) -> FloatArray:
        """Errors of one group, or of all particles if ``None``, shape (members, degrees, keys)."""
        if group is None:
            return self.errors
        return np.asarray(self.errors[np.array([name == group for name in self.groups], dtype=np.bool_)])

    def rmsre(self, group: str | None = None) -> FloatArray:
        """RMSRE of Eq. 10, shape (degrees, keys); NaN where no particle has a value."""
        members = self.of_group(group)
        return np.asarray(pooled_rmsre(members, np.ones((1, len(members))))[0])

    def bands(self, group: str | None = None) -> FloatArray:
        """Ends of the bootstrap band over particles, shape (2, degrees, keys)."""
        if group not in self._bands:
            members = self.of_group(group)
            spread = pooled_rmsre(members, resampled_counts(len(members), self.seed))
            self._bands[group] = band_of(spread, self.confidence)
        return self._bands[group]

    def n_used(self, group: str | None = None) -> tuple[int, ...]:
        """Number of particles with a fit at each degree."""
        return tuple(int(n) for n in np.isfinite(self.of_group(group)).all(axis=2).sum(axis=0))

    def smallest_l_max(self, tolerance: float, group: str | None = None) -> int | None:
        """Smallest l_max at which the RMSRE of every descriptor is below `tolerance`, or ``None``."""
        for degree, row in zip(self.degrees, self.rmsre(group), strict=True):
            if (row < tolerance).all():
                return degree
        return None


def lmax_errors(
    mesh: Mesh,
    degrees: Sequence[int] = DEFAULT_DEGREES,
    keys: Sequence[str] = LOSS_KEYS,
    fit_options: FitOptions = DEFAULT_FIT_OPTIONS,
) -> FloatArray:
    """Relative errors of the descriptors of one particle's fit, shape (degrees, keys).

    One fit to the highest degree, cut at each; the surfaces are meshed on icospheres as fine as their degree
    asks for and measured by the same routines as the particle. NaN where a fit has a negative radius.

    Raises RegolithError if the particle cannot be measured or fitted.
    """
    measured = describe(mesh, keys)
    fit = fit_options.fit(mesh, max(degrees))
    errors = np.full((len(degrees), len(keys)), np.nan)
    for row, (coarse, fine) in enumerate(_surfaces(fit, degrees)):
        if coarse is not None and fine is not None:
            values = dict(describe(fine, keys))
            for key, value in describe(coarse, [key for key in keys if key in EXTRAPOLATED]).items():
                # half the edges leave a quarter of the error: a third of the step remains
                values[key] += (values[key] - value) / 3
            errors[row] = [values[key] / measured[key] - 1 for key in keys]
    return errors


def _surfaces(fit: HarmonicFit, degrees: Sequence[int]) -> Iterator[tuple[Mesh | None, Mesh | None]]:
    """The fit cut at each of `degrees`, on an icosphere that is fine enough and on the next coarser one."""
    levels = [next(enough for last, enough in LEVEL_BY_DEGREE if degree <= last) for degree in degrees]
    for level, members in groupby(zip(levels, degrees, strict=True), key=itemgetter(0)):
        cuts = [degree for _, degree in members]
        both = zip(gallery(fit, cuts, level - 1), gallery(fit, cuts, level), strict=True)
        yield from ((coarse, fine) for (_, coarse), (_, fine) in both)


def lmax_study(
    particles: Sequence[Particle],
    degrees: Sequence[int] = DEFAULT_DEGREES,
    keys: Sequence[str] = LOSS_KEYS,
    mapper: Mapper = map,
    seed: int = 0,
    fit_options: FitOptions = DEFAULT_FIT_OPTIONS,
) -> Generator[StudyProgress, None, LmaxStudy]:
    """Fit every particle and compare its descriptors with those of the fits cut at `degrees`.

    Yields a :class:`StudyProgress` a particle, whose `partial` is the :class:`LmaxStudy` so far, and
    returns the study. A particle that cannot be fitted is listed in `failures` and stops nothing.

    ``mapper``: ``map``, or the ordered lazy map of a process pool. ``fit_options``: how the fits are made.

    Raises InputError if there is no particle or no degree, or no particle can be fitted.
    """
    if not particles or not degrees:
        raise InputError("A study of l_max needs at least one particle and one degree.")
    chosen = tuple(sorted(set(degrees)))
    options = {"degrees": chosen, "keys": tuple(keys), "fit_options": fit_options}
    work: Callable[[Mesh], FloatArray | str] = partial(errors_or_reason, options=options)
    study = LmaxStudy(chosen, tuple(keys), (), (), np.empty((0, len(chosen), len(keys))), seed=seed)
    outcomes = mapper(work, (particle.mesh for particle in particles))
    for done, (particle, outcome) in enumerate(zip(particles, outcomes, strict=True), start=1):
        study = _with_outcome(study, particle, outcome)
        yield StudyProgress(done, len(particles), particle.name, study if study.names else None)
    if not study.names:
        raise InputError(f"None of the {len(particles)} particles can be fitted: {study.failures[0][1]}")
    return study


def errors_or_reason(mesh: Mesh, options: Mapping[str, Any]) -> FloatArray | str:
    """:func:`lmax_errors`, or the sentence that says why there are none; for process pools."""
    try:
        return lmax_errors(mesh, **options)
    except RegolithError as error:
        return str(error)


def _with_outcome(study: LmaxStudy, particle: Particle, outcome: FloatArray | str) -> LmaxStudy:
    if isinstance(outcome, str):
        return replace(study, failures=(*study.failures, (particle.name, outcome)))
    return replace(
        study,
        names=(*study.names, particle.name),
        groups=(*study.groups, particle.group),
        errors=np.concatenate([study.errors, outcome[None]]),
    )


def rmsre_table(study: LmaxStudy) -> Table:
    """Fig. 3 as numbers: a row for each group, l_max and descriptor."""
    rows = []
    for group in study.group_names:
        values, (low, high), used = study.rmsre(group), study.bands(group), study.n_used(group)
        for d, degree in enumerate(study.degrees):
            for k, key in enumerate(study.keys):
                numbers = (100 * values[d, k], 100 * low[d, k], 100 * high[d, k])
                rows.append((group, degree, key, CATALOGUE[key].symbol, *numbers, used[d]))
    percent = [Column(name, "%") for name in ("rmsre", "rmsre_low", "rmsre_high")]
    columns = (*map(Column, ("group", "l_max", "descriptor", "symbol")), *percent, Column("n_particles"))
    notes = (
        "Root mean square over particles of (D(particle) - D(fit)) / D(particle); exact bounding boxes;"
        " areas and hulls of fits extrapolated to infinitely fine meshes.",
        *((BOX_NOTE,) if "min_diameter" in study.keys else ()),
        f"Bands: {study.confidence:.0%}, {N_RESAMPLES} resamples of the particles, seed {study.seed}.",
        *(f"{name} was left out: {reason}" for name, reason in study.failures),
    )
    return Table("RMSRE of the descriptors against l_max", columns, tuple(rows), notes)


def enough_degrees(study: LmaxStudy, tolerance: float) -> str:
    """One sentence a group: the smallest l_max at which every descriptor's RMSRE is below `tolerance`."""
    sentences = []
    for group in study.group_names:
        degree = study.smallest_l_max(tolerance, group)
        whose = f" of {group}" if group else ""
        degrees = (
            f"l_max = {degree} is the smallest"
            if degree is not None
            else "No l_max that was studied is enough"
        )
        sentences.append(f"{degrees} with every RMSRE{whose} below {100 * tolerance:g} %.")
    return "\n".join(sentences)


def particle_table(study: LmaxStudy) -> Table:
    """Relative error of every descriptor of every particle at every l_max."""
    rows = [
        (name, group, degree, *study.errors[i, d])
        for i, (name, group) in enumerate(zip(study.names, study.groups, strict=True))
        for d, degree in enumerate(study.degrees)
    ]
    columns = (Column("name"), Column("group"), Column("l_max"), *map(Column, study.keys))
    note = "(D(fit) - D(particle)) / D(particle); empty where the fit has a negative radius."
    return Table("Relative errors of the descriptors of each fit", columns, tuple(rows), (note,))
