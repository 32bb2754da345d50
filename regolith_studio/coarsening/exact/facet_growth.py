"""Many facets from few: a polyhedron that meets all constraints gets further facets as small cuts.

A particle has more surface than its convex hull as a rule. A convex polyhedron that is to have as much must
be edgy, which few facets are by themselves; started with many, facets are lost on the way to it and with
them the freedom to meet the constraints. So few facets are solved first. A cut across a corner changes the
volume with the cube of its depth, so that what cuts take away is corrected back by little.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from regolith_studio.coarsening.exact.constraints import Problem, measure
from regolith_studio.coarsening.exact.initial_planes import start_planes
from regolith_studio.coarsening.exact.single_start import (
    CUT_DEPTHS,
    Candidate,
    candidate_of,
    restore_lost_facets,
    single_start,
)
from regolith_studio.coarsening.lower_bounds import max_sphericity
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.sphere_points import fibonacci_directions

FEW_FACETS = (
    (0.15, (20, 12, 30, 50)),
    (0.085, (20, 30, 50, 12)),
    (0.055, (30, 20, 50, 12)),
    (-np.inf, (50, 30, 20, 12)),
)
"""Facets to grow from, best first, by how much more surface a particle has than its hull (in logarithms)."""
ALIKE = 1.25
"""Where fewer than this many times as many are asked for, all start at once."""
FACTOR = 2.5
"""Facets after and before each stage of cuts."""
BEYOND = 6.0
"""Where half-spaces wait for their cut, in units of the largest offset."""


def numbers_to_grow_from(target: Target, n_facets: int, keeps_sphericity: bool) -> tuple[int, ...]:
    """Facets of the polyhedra that are solved before there are `n_facets`, the most promising first.

    `n_facets` itself stands for a start with all of them; it is always among them. Numbers whose Goldberg
    bound is below the particle's sphericity are not.
    """
    surplus = more_surface_than_hull(target) if keeps_sphericity else -np.inf
    order = next(few for least, few in FEW_FACETS if surplus >= least)
    wanted = target.descriptors["sphericity"] if keeps_sphericity else 0.0
    numbers = [few if ALIKE * few < n_facets else n_facets for few in order if max_sphericity(few) > wanted]
    if not keeps_sphericity:
        numbers.insert(0, n_facets)
    return tuple(dict.fromkeys([*numbers, n_facets]))


def more_surface_than_hull(target: Target) -> float:
    """Logarithm of the particle's surface over that of its convex hull, at the same volume."""
    hull = target.mesh.hull
    of_hull = np.cbrt(36.0 * np.pi * hull.volume**2) / hull.surface_area
    return float(np.log(of_hull / target.descriptors["sphericity"]))


def grow_facets(
    target: Target,
    free: Problem,
    full: Problem,
    n_facets: int,
    few_facets: int,
    starts: int,
    rng: np.random.Generator,
    free_steps: int,
    bound_steps: int,
) -> Iterator[Candidate]:
    """`n_facets` half-spaces, cut out of the best of `starts` polyhedra with `few_facets`.

    Where none of them meets all constraints, the nearest comes, with half-spaces that bound nothing. `rng`
    chooses the starts; other parameters as of
    :func:`regolith_studio.coarsening.exact.single_start.single_start`.
    """
    few: Candidate | None = None
    for _ in range(starts):
        start = start_planes(target, few_facets, rng)
        for found in single_start(target, free, full, start, free_steps, bound_steps):
            if found.better_than(few):
                few = found
    if few is None:
        return
    if few.exact:
        yield from with_more_facets(target, full, few, n_facets, bound_steps)
    else:
        yield waiting(full, few, n_facets)


def with_more_facets(
    target: Target,
    problem: Problem,
    few: Candidate,
    n_facets: int,
    steps: int,
    depths: Sequence[float] = CUT_DEPTHS,
) -> Iterator[Candidate]:
    """Polyhedra with ever more cuts, each number of them projected and followed by a descent of `steps`.

    Only those of `n_facets` half-spaces come. Where so many cuts at once cannot be kept, half of them are
    tried; where not even one can, the last exact polyhedron comes with its half-spaces that bound nothing.
    """
    size, cuts = len(few.offsets), n_facets
    while size < n_facets:
        cuts = min(cuts, int((FACTOR - 1.0) * size), n_facets - size)
        normals, offsets = with_waiting(few.normals, few.offsets, size + cuts)
        point = measure(problem, normals, offsets)
        more: Candidate | None = None
        for found in restore_lost_facets(target, problem, point, steps, depths):
            if size + cuts == n_facets:
                yield found
            if found.better_than(more):
                more = found
        if more is not None and more.exact:
            few, size = more, size + cuts
        elif cuts == 1:
            yield waiting(problem, few, n_facets)
            return
        else:
            cuts //= 2


def waiting(problem: Problem, few: Candidate, n_facets: int) -> Candidate:
    """The same polyhedron with half-spaces that bound nothing, `n_facets` in all."""
    normals, offsets = with_waiting(few.normals, few.offsets, n_facets)
    return candidate_of(problem, measure(problem, normals, offsets))


def with_waiting(normals: FloatArray, offsets: FloatArray, n_facets: int) -> tuple[FloatArray, FloatArray]:
    """The half-spaces and, up to `n_facets`, others that lie far outside and bound nothing yet."""
    more = n_facets - len(offsets)
    far = np.full(more, BEYOND * float(offsets.max()))
    return np.vstack([normals, fibonacci_directions(more)]), np.concatenate([offsets, far])
