"""Polyhedra with further facets cut out of a result with fewer: so that more facets are never worse."""

from collections.abc import Iterator, Sequence

import numpy as np

from regolith_studio.coarsening.exact.constraints import Problem, measure
from regolith_studio.coarsening.exact.facet_growth import with_more_facets
from regolith_studio.coarsening.exact.relaxation import as_it_is, missing_by, relax
from regolith_studio.coarsening.exact.single_start import (
    CUT_DEPTHS,
    Candidate,
    candidate_of,
    search_and_project,
)
from regolith_studio.coarsening.exact.sliver_removal import SMALL
from regolith_studio.coarsening.polyhedra import facet_areas
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.half_spaces import HalfSpaces

DEPTHS = (CUT_DEPTHS, (0.05, 0.02, 0.01), (0.01, 0.005, 0.002))
"""Of cuts: large ones lead farther, small ones cost next to no overlap."""


def grown_from_fewer(
    target: Target,
    problem: Problem,
    fewer: HalfSpaces,
    n_facets: int,
    steps: int,
    depths: Sequence[float],
) -> Iterator[Candidate]:
    """Polyhedra with `n_facets` half-spaces, cut out of one with fewer that meets all constraints.

    They are cut without its slivers first, and with them where that leads to none with all facets.

    Parameters
    ----------
    fewer
        Half-spaces of the polyhedron at unit volume.
    steps
        Of the descent after each stage of cuts.
    depths
        Of the cuts, one of :data:`DEPTHS`.
    """
    areas = facet_areas(fewer)
    for kept in (areas >= SMALL * areas.mean(), areas >= 0.0):
        few = candidate_of(problem, measure(problem, fewer.normals[kept], fewer.offsets[kept]))
        few, whole = search_and_project(problem, few), False
        if few.exact:
            for found in with_more_facets(target, problem, few, n_facets, steps, depths):
                whole = whole or (found.exact and found.n_facets == n_facets)
                yield found
        if whole:
            return


def relaxed_from_fewer(
    target: Target, full: Problem, rest: Problem, fewer: HalfSpaces, n_facets: int, steps: int
) -> Iterator[Candidate]:
    """As :func:`grown_from_fewer` where that one misses a constraint.

    Further facets are first cut at the descriptors that it has, then the sphericity is sought.

    Parameters
    ----------
    full, rest
        The problem with and without the sphericity.
    """
    normals, offsets = np.array(fewer.normals), np.array(fewer.offsets)
    held, point = as_it_is(full, normals, offsets)
    if not np.isfinite(point.worst):
        return
    more: Candidate | None = None
    missed = measure(full, normals, offsets).worst
    for found in with_more_facets(target, held, candidate_of(held, point), n_facets, steps):
        more = found if found.better_than(more) else more
        yield missing_by(missed, found)
    if more is not None:
        yield from relax(target, full, rest, (more.normals, more.offsets), steps)
