"""Approximate a polyhedron, or a union of several, by overlapping spheres with its volume and inertia.

The spheres begin inside, each where it covers most of what is bare (the idea of Ferellec and McDowell 2010,
Granular Matter 12, 459). Then centres and radii together descend the volume that polyhedron and union do not
share, so that spheres may stand out a little, while volume, centroid and second moments of the union are kept
at those of the polyhedron. The error is Jaccard's distance, as in Buchele et al. 2026 (arXiv 2603.05877).
"""

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.distance import cdist
from scipy.special import expit
from scipy.stats import qmc

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.geometry.half_spaces import inscribed_ball
from regolith_studio.geometry.sphere_points import fibonacci_directions

PROBES = 4096
"""Points to be covered by the first spheres; a power of two for Sobol's sequence."""
CENTRES = 1500
"""Candidate centres of the first spheres."""
SAMPLES = 1 << 13
"""Points of the box around a shape at which the descent compares it with the spheres."""
MARGIN = 0.15
"""Width of the band around a shape that is compared, in edges of a cube of the same volume."""
WIDTHS = (0.06, 0.02)
"""Over which a sphere's surface is blurred, first and then, in edges of that cube."""
SMALLEST = 0.03
"""Radius of the smallest sphere of the descent, in edges of that cube."""
MOMENT_WEIGHT = 30.0
ROUNDS, ITERATIONS = 4, 40
NEWTON_STEPS, LARGEST_STEP = 12, 0.02
MATCHED = 3e-4
"""Largest scaled error of a moment at which the correction ends."""
FEWEST_FOR_INERTIA = 6
"""Fewer spheres, of flat shapes, cannot have its moments of inertia without leaving the shape."""
SURFACE_POINTS = 4096
"""Points on each sphere for integrals over the outer surface of the union."""
ERROR_SAMPLES = 1 << 17
COUNTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
"""Numbers of spheres that are tried for a stated error."""

_AXES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
_FIRST, _SECOND = (list(each) for each in zip(*_AXES, strict=True))
_DEGREES = np.array([0, 1, 1, 1, 2, 2, 2, 2, 2, 2])
_SCALING = np.array([1.0, 3.0, 3.0, 3.0] + [10.0] * 6)
"""Makes equal relative errors of volume and second moments about equally large."""


@dataclass(frozen=True)
class SphereFitErrors:
    """Errors of a union of spheres that approximates a polyhedron.

    - ``volume``, ``area``: ratio of union and polyhedron minus 1.
    - ``inertia``: largest relative difference of a principal moment about the polyhedron's centroid, at
      equal mass.
    - ``jaccard``: 1 minus the shared volume over the volume of both together.
    """

    volume: float
    area: float
    inertia: float
    jaccard: float


@dataclass(frozen=True, eq=False)
class UnionMoments:
    """Integrals over a union of spheres.

    - ``values``: of 1, x, y, z, xx, xy, xz, yy, yz, zz, shape (10,).
    - ``gradient``: their derivatives by x, y, z, r of every sphere, shape (10, n, 4).
    - ``area``: of the outer surface.
    """

    values: FloatArray
    gradient: FloatArray
    area: float


def fit_spheres(shape: Polyhedron, count: int) -> FloatArray:
    """At most `count` spheres whose union stands for `shape`, each row x, y, z, r.

    The union has the shape's volume and, from :data:`FEWEST_FOR_INERTIA` spheres on, its centroid and moments
    of inertia to 0.1 %, unless so few spheres of a flat shape cannot (:func:`sphere_fit_errors` tells). Fewer
    than `count` are returned if some are hidden in others.
    """
    size = shape.volume ** (1 / 3)
    spheres = inscribed_spheres(shape, count)
    spheres = np.column_stack([spheres[:, :3] - shape.centroid, spheres[:, 3]]) / size
    target = _moments_of(shape) / size ** (3 + _DEGREES)
    highest = 1 if len(spheres) < FEWEST_FOR_INERTIA else 2
    # With few spheres the second moments are left free; they would pull spheres out of flat shapes.
    scaling = np.where(highest >= _DEGREES, _SCALING, 0.0)
    mismatch = _Mismatch.of(shape)
    # A wide blur without moments first: hidden spheres would not find their way with a narrow one.
    spheres = mismatch.descended(spheres, WIDTHS[0], target, 0.0 * scaling)
    shifted = target.copy()
    for _ in range(ROUNDS):  # the method of multipliers, which takes out the error of the blur, too
        spheres = mismatch.descended(spheres, WIDTHS[1], shifted, scaling)
        shifted += target - union_moments(spheres).values
    spheres = _with_moments(spheres, target, scaling)
    return np.asarray(spheres * size + [*shape.centroid, 0.0])


def fit_spheres_within(shape: Polyhedron, max_error: float) -> FloatArray:
    """The fewest spheres of :data:`COUNTS` whose Jaccard distance is at most `max_error`.

    Raises InputError if the largest number does not reach it.
    """
    error = 1.0
    for count in COUNTS:
        spheres = fit_spheres(shape, count)
        error = sphere_fit_errors(shape, spheres).jaccard
        if error <= max_error:
            return spheres
    raise InputError(
        f"{COUNTS[-1]} spheres of a polyhedron have an error (Jaccard) of {error:.3f}, above the allowed "
        f"{max_error:g}; allow more."
    )


def fit_spheres_by(shape: Polyhedron, count: int, max_error: float) -> FloatArray:
    """`count` spheres; where `max_error` is positive, as :func:`fit_spheres_within` instead.

    What is found is kept as long as the shape is in use, since several formats take the same spheres; the
    array is read-only.
    """
    known = _fits.setdefault(shape, {})
    if (count, max_error) not in known:
        spheres = fit_spheres_within(shape, max_error) if max_error else fit_spheres(shape, count)
        spheres.flags.writeable = False
        known[count, max_error] = spheres
    return known[count, max_error]


_fits: WeakKeyDictionary[Polyhedron, dict[tuple[int, float], FloatArray]] = WeakKeyDictionary()


def inscribed_spheres(shape: Polyhedron, count: int) -> FloatArray:
    """At most `count` spheres inside `shape`, each row x, y, z, r; the first is the largest that fits.

    Each further sphere is the one that covers most of the uncovered points, among many candidate centres with
    the maximum radius that fits there. Fewer are returned if no candidate covers anything more.
    """
    probes = inner_points(shape, PROBES)
    centres = np.vstack([_incentre(shape), probes[:CENTRES]])
    radii = -_depth(shape, centres)
    inside = cdist(centres, probes) <= radii[:, None]
    uncovered, chosen = np.ones(len(probes), dtype=bool), [0]
    uncovered &= ~inside[0]
    while len(chosen) < count:
        gain = (inside & uncovered).sum(axis=1)
        best = int(gain.argmax())
        if gain[best] == 0:
            break
        chosen.append(best)
        uncovered &= ~inside[best]
    return np.column_stack([centres[chosen], radii[chosen]])


def union_moments(spheres: FloatArray) -> UnionMoments:
    """Volume, first and second moments and area of a union of spheres, to about 1e-4 of the volume.

    By the divergence theorem, f of degree d having the volume integral of f x.n / (3 + d) over the surface.
    """
    directions = fibonacci_directions(SURFACE_POINTS)
    values, gradient, area = np.zeros(10), np.zeros((10, len(spheres), 4)), 0.0
    for k, (*centre, radius) in enumerate(spheres):
        points = centre + radius * directions
        patches = 4 * np.pi * radius**2 / SURFACE_POINTS * _bare_shares(spheres, k, directions)
        area += float(patches.sum())
        weighted = patches[:, None] * _monomials(points)
        values += (weighted.T @ (points * directions).sum(axis=1)) / (3 + _DEGREES)
        gradient[:, k, :3], gradient[:, k, 3] = weighted.T @ directions, weighted.sum(axis=0)
    return UnionMoments(values, gradient, area)


def _bare_shares(spheres: FloatArray, k: int, directions: FloatArray) -> FloatArray:
    """Share of the patch around each point of sphere `k` that lies in no other sphere, shape (m,).

    By the angle between the point and the circle in which another sphere cuts this one, over the width of a
    patch.
    """
    # A patch cut by a sphere counts by its share, not all or nothing: sums stay smooth in centres and radii.
    others = np.delete(spheres, k, axis=0)
    radius, apart = spheres[k, 3], others[:, :3] - spheres[k, :3]
    # Two spheres about one centre have no direction between them; the cosine below is then beyond 1 or -1.
    distance = np.maximum(np.linalg.norm(apart, axis=1), 1e-12)
    cosine = (distance**2 + radius**2 - others[:, 3] ** 2) / (2 * distance * radius)
    others, apart, cosine = (
        others[cosine < 1.0],
        (apart / distance[:, None])[cosine < 1.0],
        cosine[cosine < 1.0],
    )
    if (cosine <= -1.0).any():
        return np.zeros(len(directions))
    beyond = np.arccos(np.clip(directions @ apart.T, -1.0, 1.0)) - np.arccos(cosine)
    width = np.sqrt(4 * np.pi / len(directions))
    return np.asarray(np.clip(0.5 + beyond.min(axis=1, initial=np.inf) / width, 0.0, 1.0))


def sphere_fit_errors(shape: Polyhedron, spheres: FloatArray) -> SphereFitErrors:
    """Errors of a union of spheres; of the Jaccard distance to about 0.001."""
    moved = spheres - [*shape.centroid, 0.0]
    union = union_moments(moved)
    solid = _moments_of(shape)
    low, high = _box(shape, spheres)
    # Without scrambling, so that the same dataset always states the same errors.
    points = low + np.asarray(qmc.Sobol(3, scramble=False).random(ERROR_SAMPLES)) * (high - low)
    inside, covered = _depth(shape, points) <= 0.0, _covered(points, spheres)
    ratio = _principal_moments(union.values) / _principal_moments(solid)
    return SphereFitErrors(
        volume=float(union.values[0] / shape.volume - 1.0),
        area=float(union.area / shape.surface_area - 1.0),
        inertia=float(np.abs(ratio - 1.0).max()),
        jaccard=float(1.0 - (inside & covered).sum() / (inside | covered).sum()),
    )


@dataclass(frozen=True, eq=False)
class _Mismatch:
    """The volume that a shape and a union of spheres do not share, smooth in centres and radii.

    The shape has volume 1 and its centroid at the origin. A point counts by the logistic function of its
    depth below the union's surface.

    - ``points``: of the shape and a band around it, shape (m, 3).
    - ``signs``: share of a point in the volume, negative inside the shape, shape (m,).
    - ``monomials``: at the points times their share, shape (m, 10).
    """

    points: FloatArray
    signs: FloatArray
    monomials: FloatArray

    @classmethod
    def of(cls, shape: Polyhedron) -> "_Mismatch":
        size = shape.volume ** (1 / 3)
        low, high = shape.vertices.min(axis=0) - MARGIN * size, shape.vertices.max(axis=0) + MARGIN * size
        points = low + np.asarray(qmc.Sobol(3, scramble=False).random(SAMPLES)) * (high - low)
        depth = _depth(shape, points)
        near, share = depth < MARGIN * size, float(np.prod(high - low)) / shape.volume / SAMPLES
        points = (points[near] - shape.centroid) / size
        return cls(points, np.where(depth[near] <= 0.0, -share, share), share * _monomials(points))

    def descended(
        self, spheres: FloatArray, width: float, target: FloatArray, scaling: FloatArray
    ) -> FloatArray:
        """The spheres at a minimum nearby, with the moments `target` as far as their weight goes."""

        def value(parameters: FloatArray) -> tuple[float, FloatArray]:
            total, gradient = self._value(parameters.reshape(-1, 4), width, target, scaling)
            return total, gradient.ravel()

        answer = minimize(
            value,
            spheres.ravel(),
            jac=True,
            method="L-BFGS-B",
            bounds=[(None, None), (None, None), (None, None), (SMALLEST, None)] * len(spheres),
            # Not converged: the multipliers change the problem in the next round anyway.
            options={"maxiter": ITERATIONS},
        )
        return np.asarray(answer.x).reshape(-1, 4)

    def _value(
        self, spheres: FloatArray, width: float, target: FloatArray, scaling: FloatArray
    ) -> tuple[float, FloatArray]:
        """The volume plus the moments' squared errors, up to a constant; derivatives, shape (n, 4)."""
        depths = spheres[:, 3] - cdist(self.points, spheres[:, :3])
        nearest = depths.argmax(axis=1)
        depth = depths[np.arange(len(depths)), nearest]
        share = np.asarray(expit(depth / width))
        off = scaling * (self.monomials.T @ share - target)
        total = float(self.signs @ share) + MOMENT_WEIGHT * float(off @ off)
        weights = self.signs + 2 * MOMENT_WEIGHT * self.monomials @ (scaling * off)
        slope = weights * share * (1.0 - share) / width
        # The gradient by a centre has no direction at the centre itself.
        distance = np.maximum(spheres[nearest, 3] - depth, 1e-9)
        towards = (self.points - spheres[nearest, :3]) * (slope / distance)[:, None]
        columns = (*towards.T, slope)
        return total, np.column_stack([np.bincount(nearest, each, len(spheres)) for each in columns])


def _with_moments(spheres: FloatArray, target: FloatArray, scaling: FloatArray) -> FloatArray:
    """The least change by Newton's method that gives the union these moments as nearly as it goes.

    The volume is exact in any case, by scaling; spheres that lie within others are left out.
    """
    off, best = np.inf, spheres
    for _ in range(NEWTON_STEPS):
        union = union_moments(spheres)
        missing = scaling * (target - union.values)
        if np.abs(missing).max() < off:
            off, best = float(np.abs(missing).max()), spheres
        if off < MATCHED:
            break
        slopes = (scaling[:, None, None] * union.gradient).reshape(10, -1)
        # The least step, since 4 n unknowns are more than 10 equations; nearly dependent ones are left out.
        step = np.linalg.lstsq(slopes, missing, rcond=1e-4)[0].reshape(-1, 4)
        # The moments are linear in small steps only: a whole step may overlap what it has just parted.
        spheres = spheres + step * min(1.0, LARGEST_STEP / max(np.abs(step).max(), 1e-12))
    union = union_moments(best)
    visible = union.gradient[0, :, 3] > 0.0  # the bare area
    return np.asarray(best[visible] * (target[0] / union.values[0]) ** (1 / 3))


def _moments_of(shape: Polyhedron) -> FloatArray:
    """Integrals of the monomials over a shape about its centroid, shape (10,)."""
    inertia = shape.mesh.inertia
    second = np.trace(inertia) / 2 * np.eye(3) - inertia
    return np.array([shape.volume, 0.0, 0.0, 0.0, *second[_FIRST, _SECOND]])


def _principal_moments(moments: FloatArray) -> FloatArray:
    """Of inertia about the origin, at mass 1, ascending."""
    second = np.zeros((3, 3))
    second[_FIRST, _SECOND] = second[_SECOND, _FIRST] = moments[4:] / moments[0]
    return np.asarray(np.linalg.eigvalsh(np.trace(second) * np.eye(3) - second))


def _monomials(points: FloatArray) -> FloatArray:
    """1, x, y, z, xx, xy, xz, yy, yz, zz, shape (m, 10)."""
    return np.column_stack([np.ones(len(points)), points, points[:, _FIRST] * points[:, _SECOND]])


def _covered(points: FloatArray, spheres: FloatArray) -> BoolArray:
    """Which points lie in a sphere, shape (k,)."""
    covered = np.zeros(len(points), dtype=bool)
    for x, y, z, radius in spheres:
        covered |= ((points - (x, y, z)) ** 2).sum(axis=1) <= radius**2
    return covered


def _depth(shape: Polyhedron, points: FloatArray) -> FloatArray:
    """Largest distance from a plane of the part in which a point is deepest, negative inside, shape (k,)."""
    depths = [(points @ normals.T - offsets).max(axis=1) for normals, offsets in shape.part_planes]
    return np.asarray(np.min(depths, axis=0))


def _box(shape: Polyhedron, spheres: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lower and upper corner of a box about a shape and spheres."""
    centres, radii = spheres[:, :3], spheres[:, 3:]
    low = np.minimum(shape.vertices.min(axis=0), (centres - radii).min(axis=0))
    return low, np.maximum(shape.vertices.max(axis=0), (centres + radii).max(axis=0))


def inner_points(shape: Polyhedron, count: int) -> FloatArray:
    """About `count` points inside, evenly spread (Sobol, no chance in it), shape (k, 3)."""
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    share = shape.volume / float(np.prod(high - low))
    power = int(np.ceil(np.log2(count / share)))
    points = low + np.asarray(qmc.Sobol(3, scramble=False).random_base2(power)) * (high - low)
    return np.asarray(points[_depth(shape, points) <= 0.0])


def _incentre(shape: Polyhedron) -> FloatArray:
    """Centre of the largest sphere inside a convex part, by linear programming."""
    balls = [inscribed_ball(normals, offsets) for normals, offsets in shape.part_planes]
    return max(balls, key=lambda ball: ball[1])[0]
