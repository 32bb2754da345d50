"""Many facets from few: a polyhedron that meets all conditions gets further facets as small cuts.

A start with many half-spaces on a rough particle often ends where no step meets all conditions: facets are
lost on the way and with them their freedoms. Half as many facets are met as a rule, and a cut across a corner
changes the volume with the cube of its depth, so what the cuts take away is polished back by little.
"""

from collections.abc import Iterator

import numpy as np

from regolith_studio.coarsening.core.planes import tangents_of
from regolith_studio.coarsening.exact.course import NOWHERE, Attempt, attempt, course, mended, start_planes
from regolith_studio.coarsening.exact.polish import measured
from regolith_studio.coarsening.exact.problem import Problem
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.directions import fibonacci_directions

SAFE_FACES = 50
"""Up to so many facets a start is met as a rule, and nothing is grown."""
FEW_FACES = (20, 50)
"""Facets of polyhedra that are grown, start by start in turns."""
FACTOR = 2.5
"""Facets after and before each stage of cuts."""
BEYOND = 6.0
"""Where half-spaces wait for their cut, in units of the largest offset."""


def grown(
    target: Target,
    free: Problem,
    full: Problem,
    planes: tuple[FloatArray, FloatArray],
    few_faces: int,
    rng: np.random.Generator,
    free_steps: int,
    bound_steps: int,
) -> Iterator[Attempt]:
    """As many half-spaces as `planes`, cut out of a polyhedron with `few_faces` that meets all conditions.

    Where already the few miss a condition (round particles need more): the course from `planes`. Parameters
    as of :func:`regolith_studio.coarsening.exact.course.course`; `rng` chooses the start of the few.
    """
    start = start_planes(target, few_faces, rng)
    few: Attempt | None = None
    for found in course(target, free, full, start, free_steps, bound_steps):
        if found.better_than(few):
            few = found
    if few is not None and few.exact:
        yield from with_more_facets(target, full, few, len(planes[1]), bound_steps)
    else:
        yield from course(target, free, full, planes, free_steps, bound_steps)


def with_more_facets(
    target: Target, problem: Problem, few: Attempt, n_faces: int, steps: int
) -> Iterator[Attempt]:
    """Polyhedra with ever more cuts, each number of them polished and followed by a descent of `steps` steps.

    Only those of `n_faces` half-spaces come. Where cuts cannot be kept, the last exact polyhedron comes with
    its half-spaces that bound nothing.
    """
    for size in stages(len(few.offsets), n_faces):
        normals, offsets = with_waiting(few.normals, few.offsets, size)
        point = measured(problem, normals, offsets, tangents_of(normals), NOWHERE)
        more: Attempt | None = None
        for found in mended(target, problem, point, steps):
            if size == n_faces:
                yield found
            if found.better_than(more):
                more = found
        if more is None or not more.exact:
            break
        few = more
    else:
        return
    normals, offsets = with_waiting(few.normals, few.offsets, n_faces)
    yield attempt(problem, measured(problem, normals, offsets, tangents_of(normals), NOWHERE))


def stages(few_faces: int, n_faces: int) -> Iterator[int]:
    """Numbers of facets on the way, the last of them `n_faces`."""
    size = few_faces
    while size < n_faces:
        size = min(int(FACTOR * size), n_faces)
        yield size


def with_waiting(normals: FloatArray, offsets: FloatArray, n_faces: int) -> tuple[FloatArray, FloatArray]:
    """The half-spaces and, up to `n_faces`, others that lie far outside and bound nothing yet."""
    more = n_faces - len(offsets)
    far = np.full(more, BEYOND * float(offsets.max()))
    return np.vstack([normals, fibonacci_directions(more)]), np.concatenate([offsets, far])
