"""Polyhedra with further facets cut out of a result with fewer: so that more facets are never worse."""

from collections.abc import Iterator

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
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.half_spaces import HalfSpaces

SHALLOW_DEPTHS = (0.05, 0.02, 0.01)
"""Of cuts that cost next to no overlap."""


def solve_from_fewer(
    target: Target, full: Problem, rest: Problem, fewer: HalfSpaces, n_facets: int, steps: int
) -> Iterator[Candidate]:
    """Polyhedra with `n_facets` half-spaces, from one with fewer.

    Small cuts cost next to no overlap, larger ones lead farther; both are tried. Where that one misses a
    constraint, the further facets are first cut at the descriptors that it has.

    Parameters
    ----------
    full, rest
        The problem with and without the sphericity.
    fewer
        Half-spaces of the polyhedron at unit volume.
    steps
        Of the descent after each stage of cuts.
    """
    normals, offsets = np.array(fewer.normals), np.array(fewer.offsets)
    few = search_and_project(full, candidate_of(full, measure(full, normals, offsets)))
    if few.exact:
        for depths in (SHALLOW_DEPTHS, CUT_DEPTHS):
            yield from with_more_facets(target, full, few, n_facets, steps, depths)
        return
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
