"""Half-spaces to begin with: groups of the hull's triangles, an evenly tiled ellipsoid, or known planes."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.facet_insertion import insert_lost_facets
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.coarsening.lower_bounds import max_sphericity
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.half_spaces import HalfSpaces, exits
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.geometry.sphere_points import fibonacci_directions

TIE_BREAK = 1e-7
"""Relative change of the offsets: more than three planes that meet in a point are not in general position."""
MIN_OFFSET = 0.05
CUT_DEPTH = 0.3
"""Of cuts for half-spaces without a facet, as a share of the way to the next corner."""
SPHERE_POINTS = 2000
N_SIDES = 6
FLUSH = 0.02
"""Triangles of the hull belong to a side of the box up to this sine, and this distance at unit volume."""
INWARD = 1e-3
"""The other half-spaces of a start in the box begin so much farther in than the hull, as a share."""
GROUPING_ROUNDS, TILING_ROUNDS = 10, 20
"""Rounds of Lloyd's method."""
BEYOND = 6.0
"""Where half-spaces without a facet wait for their cut, in units of the largest offset."""
FLAT, COPLANAR = 1e-6, 1e-5
"""Concavity, and difference of the planes of one facet, that count as none; at unit volume."""
FEW, MIDDLE = 12, 30
"""Half-spaces to grow from: after a stage the second instead of the first."""
FIRST_STARTS = (
    (0.2, (("grouped", FEW), ("grouped", FEW), ("round", 0), ("grouped", 0))),
    (0.12, (("grouped", FEW), ("round", 0), ("grouped", 0))),
    (-np.inf, (("grouped", 0), ("round", 0))),
)
"""Kinds of starts and their half-spaces (0: as many as are asked for), by how much more surface a particle
has than its hull (logarithm). Measured on 52 particles: where much surface is to be kept, starts with few
half-spaces to grow from end near each other and others do not; elsewhere they are worse."""
STAGES = (20, 50, 100, 200)
"""Numbers of facets whose results larger numbers grow from, so that more facets are not worse."""
ALIKE = 1.25
"""Where less than so many times as many are asked for, all begin at once."""


class HullTriangles(NamedTuple):
    """Unit normals (m, 3), areas (m,) and middles (m, 3) of the triangles of a convex hull."""

    normals: FloatArray
    areas: FloatArray
    middles: FloatArray


def hull_triangles(target: Target) -> HullTriangles:
    """Of the particle, those with an area."""
    hull = target.mesh.hull
    areas = hull.face_areas
    sound = areas > 0.0
    normals = hull.face_area_vectors[sound] / areas[sound, None]
    return HullTriangles(normals, np.ascontiguousarray(areas[sound]), hull.triangles[sound].mean(axis=1))


def grouped_start(
    target: Target, triangles: HullTriangles, n_facets: int, rng: np.random.Generator
) -> HalfSpaces:
    """Half-spaces through groups of the hull's triangles, in general position, each with a facet.

    Groups of a smooth needle can all run from end to end, so that nothing bounds the ends; then half-spaces
    that touch it all around are taken.
    """
    normals, offsets = np.empty((n_facets, 3)), np.empty(n_facets)
    fill_groups(*triangles, rng.random(n_facets), GROUPING_ROUNDS, normals, offsets)
    offsets = np.maximum(offsets, MIN_OFFSET) * (1.0 + TIE_BREAK * rng.random(n_facets))
    if measure_polyhedron(normals, offsets).status != FINE:
        return round_start(target, n_facets, rng)
    return with_cuts(target, HalfSpaces(normals, offsets))


def round_start(target: Target, n_facets: int, rng: np.random.Generator) -> HalfSpaces:
    """Half-spaces of a polyhedron nearly as round as can be, stretched as the particle's box, that touch it.

    Their normals are the middles of a centroidal Voronoi partition of the sphere.
    """
    sphere, box = fibonacci_directions(SPHERE_POINTS), target.box
    even, _ = np.empty((n_facets, 3)), np.empty(n_facets)
    fill_groups(sphere, np.ones(SPHERE_POINTS), sphere, rng.random(n_facets), TILING_ROUNDS, even, _)
    points = products(target.mesh.hull.vertices, box.axes)
    normals = even / np.ptp(points, axis=0)
    normals /= np.sqrt((normals * normals).sum(axis=1))[:, None]
    offsets = products(points, normals).max(axis=0) * (1.0 + TIE_BREAK * rng.random(n_facets))
    return HalfSpaces(products(normals, np.ascontiguousarray(box.axes.T)), offsets)


def box_start(
    target: Target, triangles: HullTriangles, n_facets: int, rng: np.random.Generator
) -> HalfSpaces | None:
    """The sides of the particle's box first, then groups of the hull's triangles that lie elsewhere.

    ``None`` where nothing lies elsewhere, or `n_facets` leaves no half-space for it.
    """
    if n_facets <= N_SIDES:
        return None
    sides = np.vstack([target.box.axes, -target.box.axes])
    reach = products(target.mesh.hull.vertices, sides).max(axis=0)
    level = products(triangles.normals, sides) > np.sqrt(1.0 - FLUSH**2)
    near = np.abs(reach - products(triangles.middles, sides)) < FLUSH
    elsewhere = ~(level & near).any(axis=1)
    if not elsewhere.any():
        return None
    others = HullTriangles(*(each[elsewhere] for each in triangles))
    normals, offsets = np.empty((n_facets - N_SIDES, 3)), np.empty(n_facets - N_SIDES)
    fill_groups(*others, rng.random(len(offsets)), GROUPING_ROUNDS, normals, offsets)
    offsets = np.maximum(offsets, MIN_OFFSET) * (1.0 - INWARD * rng.random(len(offsets)))
    return HalfSpaces(np.vstack([sides, normals]), np.concatenate([reach, offsets]))


def with_waiting(few: HalfSpaces, n_facets: int) -> HalfSpaces:
    """The half-spaces and, up to `n_facets`, others that lie far outside and bound nothing yet."""
    missing = np.arange(n_facets - len(few.offsets)) % len(few.offsets)
    far = BEYOND * few.offsets.max() * (1.0 + np.arange(len(missing)) / n_facets)
    return HalfSpaces(np.vstack([few.normals, few.normals[missing]]), np.concatenate([few.offsets, far]))


def with_cuts(
    target: Target,
    planes: HalfSpaces,
    most: int | None = None,
    depth: float = CUT_DEPTH,
    axes: FloatArray | None = None,
    passed: int = 0,
) -> HalfSpaces:
    """Half-spaces without a facet, at most so many, become cuts across the corners that hang out farthest.

    The half-spaces as they are where a cut would pass behind the origin, which may lie close to a facet.
    """
    rays = target.rays
    cuts, normals, offsets = insert_lost_facets(
        planes.normals, planes.offsets, rays.directions, rays.first, rays.distance, depth, most, axes, passed
    )
    return HalfSpaces(normals, offsets) if cuts >= 0 and (offsets > 0.0).all() else planes


def own_planes(target: Target, most: int) -> HalfSpaces | None:
    """Half-spaces of a particle that is a convex polyhedron of at most `most` facets; else ``None``."""
    descriptors, hull = target.descriptors, target.mesh.hull
    if descriptors["volume"] < (1.0 - FLAT) * descriptors["convex_hull_volume"]:
        return None
    areas = hull.face_areas
    sound = areas > FLAT
    normals = hull.face_area_vectors[sound] / areas[sound, None]
    planes = np.column_stack([normals, (normals * hull.triangles[sound, 0]).sum(axis=1)])
    left = planes[np.argsort(-areas[sound], kind="stable")]
    own: list[FloatArray] = []
    while len(left) and len(own) <= most:
        own.append(left[0])
        left = left[np.abs(left - left[0]).max(axis=1) > COPLANAR]
    found = np.array(own)
    return HalfSpaces(found[:, :3], found[:, 3]) if len(own) <= most else None


def stage_below(target: Target, n_facets: int, keeps_sphericity: bool) -> int:
    """The largest of :data:`STAGES` that a search for `n_facets` begins with; 0 where none could be met."""
    wanted = target.descriptors["sphericity"] if keeps_sphericity else 0.0
    stages = [size for size in STAGES if ALIKE * size < n_facets and max_sphericity(size) > wanted]
    return max(stages, default=0)


def first_starts(
    target: Target, n_facets: int, keeps_sphericity: bool, stage: int
) -> tuple[tuple[str, int], ...]:
    """Kinds of starts and their half-spaces, one after the other, to be repeated.

    A particle has more surface than its convex hull as a rule. A convex polyhedron that is to have as much
    must be edgy, which few facets are by themselves; begun with many, facets are lost on the way to it.
    Numbers whose Goldberg bound is below the particle's sphericity are left out.
    """
    surplus = more_surface_than_hull(target) if keeps_sphericity else -np.inf
    wanted = target.descriptors["sphericity"] if keeps_sphericity else 0.0
    few = MIDDLE if stage else FEW
    usable = ALIKE * few < n_facets and max_sphericity(few) > wanted
    plan = next(plan for least, plan in FIRST_STARTS if surplus >= least)
    return tuple((kind, few if size and usable else n_facets) for kind, size in plan)


def more_surface_than_hull(target: Target) -> float:
    """Logarithm of the particle's surface over that of its convex hull, at the same volume."""
    hull = target.mesh.hull
    of_hull = np.cbrt(36.0 * np.pi * hull.volume**2) / hull.surface_area
    return float(np.log(of_hull / target.descriptors["sphericity"]))


@kernel
def _fill_products(rows: FloatArray, others: FloatArray, out: FloatArray) -> None:
    for i in range(len(rows)):
        for j in range(len(others)):
            out[i, j] = rows[i, 0] * others[j, 0] + rows[i, 1] * others[j, 1] + rows[i, 2] * others[j, 2]


def products(rows: FloatArray, others: FloatArray) -> FloatArray:
    """Scalar products of vectors (n, 3) with vectors (m, 3), shape (n, m): the same bits everywhere."""
    out = np.empty((len(rows), len(others)))
    _fill_products(np.ascontiguousarray(rows), np.ascontiguousarray(others), out)
    return out


@kernel
def fill_groups(
    normals: FloatArray,
    areas: FloatArray,
    middles: FloatArray,
    numbers: FloatArray,
    rounds: int,
    means: FloatArray,
    heights: FloatArray,
) -> None:
    """Spherical k-means of triangles, weighted by area, started as k-means++ (Arthur 2007).

    Normals (m, 3), areas (m,) and middles (m, 3) of the triangles; one random number in [0, 1) a group, (k,).
    Filled are the mean normal of each group (k, 3), and the area-weighted mean of <n, x> over it (k,).
    """
    k, m = len(numbers), len(areas)
    distance, group, unit = np.full(m, 2.0), np.empty(m, np.int64), np.ones(k)
    for j in range(k):
        total = 0.0
        for i in range(m):
            total += areas[i] * distance[i]
        at, passed, goal = 0, 0.0, numbers[j] * total
        while at < m - 1:
            passed += areas[at] * distance[at]
            if passed >= goal:
                break
            at += 1
        means[j] = normals[at]
        for i in range(m):
            here = normals[i, 0] * means[j, 0] + normals[i, 1] * means[j, 1] + normals[i, 2] * means[j, 2]
            distance[i] = min(distance[i], max(0.0, 1.0 - here))
    sums = np.empty((k, 4))
    for step in range(rounds + 1):
        exits(means, unit, normals, distance, group)  # the plane that is met first is the nearest mean
        sums[:] = 0.0
        for i in range(m):
            for c in range(3):
                sums[group[i], c] += areas[i] * normals[i, c]
        if step < rounds:
            for j in range(k):
                size = np.sqrt(sums[j, 0] ** 2 + sums[j, 1] ** 2 + sums[j, 2] ** 2)
                if size > 1e-9:
                    for c in range(3):
                        means[j, c] = sums[j, c] / size
    _fill_heights(areas, middles, group, means, sums, heights)


@inner_kernel
def _fill_heights(
    areas: FloatArray,
    middles: FloatArray,
    group: IntArray,
    means: FloatArray,
    sums: FloatArray,
    heights: FloatArray,
) -> None:
    """Mean height of each group along its normal; that of the farthest middle where a group is empty."""
    sums[:] = 0.0
    for i in range(len(areas)):
        j = group[i]
        here = middles[i, 0] * means[j, 0] + middles[i, 1] * means[j, 1] + middles[i, 2] * means[j, 2]
        sums[j, 0] += areas[i]
        sums[j, 1] += areas[i] * here
    for j in range(len(means)):
        if sums[j, 0] > 0.0:
            heights[j] = sums[j, 1] / sums[j, 0]
            continue
        heights[j] = -np.inf
        for i in range(len(areas)):
            here = middles[i, 0] * means[j, 0] + middles[i, 1] * means[j, 1] + middles[i, 2] * means[j, 2]
            heights[j] = max(heights[j], here)
