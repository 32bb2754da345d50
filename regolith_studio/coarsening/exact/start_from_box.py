"""Polyhedra with six facets on the sides of the particle's box: for particles that nearly fill it.

The box of a body that nearly fills it has hardly any room to move: no constraint is smooth within a step of
it, and Gauss-Newton fails. With six half-spaces held at its sides the diameters are met by themselves, and
volume and sphericity are left to the other half-spaces.
"""

from collections.abc import Iterator

import numpy as np

from regolith_studio.coarsening.core.facet_insertion import MIN_FACET
from regolith_studio.coarsening.exact.constraints import SPHERICITY, Problem, measure
from regolith_studio.coarsening.exact.facet_growth import ALIKE, with_more_facets
from regolith_studio.coarsening.exact.initial_planes import MIN_OFFSET, grouped_planes
from regolith_studio.coarsening.exact.relaxation import relax
from regolith_studio.coarsening.exact.single_start import (
    Candidate,
    candidate_of,
    descend_further,
    single_start,
)
from regolith_studio.coarsening.polyhedra import facet_areas
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import HalfSpaces

SIDES = 6
FEW_FACETS = (0, 12, 20, 0)
"""Facets that are begun with, by the number of the start; 0 for all."""
FLUSH = 0.02
"""Triangles of the hull belong to a side of the box up to this sine, and this distance at unit volume."""
INWARD = 1e-3
"""The other half-spaces begin so much farther in than the hull, as a share: so that none is redundant."""


def solve_from_box(
    target: Target,
    problems: tuple[Problem, Problem, Problem],
    n_facets: int,
    start: int,
    rng: np.random.Generator,
    steps: tuple[int, int],
) -> Iterator[Candidate]:
    """Polyhedra with six facets on the sides of the box; once the request is met, all facets may move.

    Parameters
    ----------
    problems
        With the volume as only constraint, with all, and with all but the sphericity.
    start
        Number of the start; there are as many as :data:`FEW_FACETS`, and nothing comes after them.
    rng
        Chooses the other half-spaces.
    steps
        Of the free and of the bound descent.
    """
    if start >= len(FEW_FACETS):
        return
    few = FEW_FACETS[start] if 0 < ALIKE * FEW_FACETS[start] < n_facets else n_facets
    planes = planes_around_box(target, few, rng)
    if planes is None:
        return
    free, full, rest = (problem._replace(held=SIDES) for problem in problems)
    best: Candidate | None = None
    for found in _in_box(target, free, full, rest, planes, steps):
        best = found if found.better_than(best) else best
        if few == n_facets:
            yield found
    if best is None or not best.exact:
        return
    if best.n_facets < n_facets:
        begun = best
        for problem in (full, problems[1]):
            for found in _grown(target, problem, begun, n_facets, steps[1]):
                best = found if found.better_than(best) or len(best.offsets) < n_facets else best
                yield found
            if best.n_facets == n_facets:
                break
    if len(best.offsets) == n_facets:
        yield from descend_further(problems[1], best, steps[1])


def _in_box(
    target: Target,
    free: Problem,
    full: Problem,
    rest: Problem,
    planes: tuple[FloatArray, FloatArray],
    steps: tuple[int, int],
) -> Iterator[Candidate]:
    """All constraints at once, else the sphericity from below."""
    met = False
    for found in single_start(target, free, full, planes, *steps):
        met |= found.exact
        if found.exact:
            yield found
    if not met and full.asked[SPHERICITY]:
        yield from relax(target, full, rest, planes, steps[1], only_rounder=True)


def _grown(target: Target, full: Problem, begun: Candidate, n_facets: int, steps: int) -> Iterator[Candidate]:
    """The real facets and further ones, up to `n_facets`; nothing where a held facet is lost."""
    real = facet_areas(HalfSpaces(begun.normals, begun.offsets)) >= MIN_FACET
    if real[: full.held].all():
        normals, offsets = begun.normals[real], begun.offsets[real]
        begun = candidate_of(full, measure(full, normals, offsets))
        yield from with_more_facets(target, full, begun, n_facets, steps)


def planes_around_box(
    target: Target, n_facets: int, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray] | None:
    """The sides of the particle's box first, then groups of the hull's triangles that lie elsewhere.

    ``None`` where nothing lies elsewhere, or `n_facets` leaves no half-space for it.
    """
    if n_facets <= SIDES:
        return None
    box = target.box
    sides = np.vstack([box.axes, -box.axes])
    reach = sides @ box.centre + np.tile(box.extents, 2) / 2
    hull = target.mesh.hull
    areas = hull.face_areas
    normals = hull.face_area_vectors / np.maximum(areas, 1e-300)[:, None]
    centres = hull.triangles.mean(axis=1)
    cosine = normals @ sides.T
    near = np.abs(reach - centres @ sides.T) < FLUSH
    elsewhere = (areas > 0.0) & ~((cosine > np.sqrt(1.0 - FLUSH**2)) & near).any(axis=1)
    if not elsewhere.any():
        return None
    others, offsets = grouped_planes(
        normals[elsewhere], areas[elsewhere], centres[elsewhere], rng.random(n_facets - SIDES), 10
    )
    offsets = np.maximum(offsets, MIN_OFFSET) * (1.0 - INWARD * rng.random(len(offsets)))
    return np.vstack([sides, others]), np.concatenate([reach, offsets])
