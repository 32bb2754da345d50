"""All crossings of rays from one origin with a triangular mesh, and none of them twice.

A ray u crosses the triangle (a, b, c), seen from the origin, if u . (a x b), u . (b x c) and u . (c x a)
have one sign. Two triangles that share an edge compute the same number for it but for the sign, and
where rounding could decide, the sign is worked out exactly; a ray through an edge or a vertex is moved
aside by infinitely little (Edelsbrunner and Muecke 1990), the same for all triangles. So the signs of
the crossings of every ray add up to the winding number of the mesh about the origin: 1 inside a closed
mesh, also where the ray runs exactly through a vertex. Rays are looked up in bins of the unit sphere: rows
are bands of equal height in z, and so of equal area; columns are equal steps of longitude.

Signs of small determinants without rounding error.

Products are split into sums of two floats (Dekker 1971) and added up as expansions whose parts do not
overlap (Shewchuk 1997), so that the sign is the true one for the numbers given. They must be free of
underflow: either zero or not far below 1e-60.

How well a convex polyhedron covers a particle: the Jaccard distance (Eq. 7).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats, locked_integers
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

N_RAYS = 16_000


def jaccard_distance(mesh: Mesh, polyhedron: ConvexPolyhedron | HalfSpaces, n_rays: int = N_RAYS) -> float:
    """1 - V(M n P) / V(M u P), the paper's IoU (Eq. 7): 0 where both are the same, 1 where disjoint.

    The closed mesh is in the frame of the polyhedron. Rays from the origin, which lies strictly inside the
    polyhedron, meet every crossing of the mesh, so that the mesh need not be star-shaped. All volumes are
    taken by the same quadrature; its error is about 0.0002 for 2,000 rays and 0.00002 for 16,000.

    Raises GeometryError if the mesh encloses no volume or the polyhedron is unbounded.
    """
    solid = (
        polyhedron
        if isinstance(polyhedron, ConvexPolyhedron)
        else ConvexPolyhedron.from_half_spaces(polyhedron)
    )
    directions = fibonacci_directions(n_rays)
    radius = solid.half_spaces.radii(directions)
    hits = radial_hits(mesh, np.zeros(3), directions)
    own = float(np.sum(hits.sign * hits.distance**3))
    if not own > 0.0:
        raise GeometryError("The mesh encloses no volume.")
    shared = float(np.sum(hits.sign * np.minimum(hits.distance, radius[hits.ray]) ** 3))
    return 1.0 - shared / (own + float(np.sum(radius**3)) - shared)


SPLITTER = 134217729.0
"""2**27 + 1: cuts a float in two halves of 26 bits."""


@kernel
def sign_of_triple_product(a: FloatArray, b: FloatArray, c: FloatArray) -> int:
    """Sign of a . (b x c): -1, 0 or +1."""
    parts = np.zeros(24)
    count = 0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        count = _add_product(parts, count, b[j], c[k], a[i])
        count = _add_product(parts, count, -b[k], c[j], a[i])
    return _sign(parts, count)


@kernel
def sign_of_cross_product(a: FloatArray, b: FloatArray, axis: int) -> int:
    """Sign of component `axis` of a x b: -1, 0 or +1."""
    parts = np.zeros(8)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    count = _add_product(parts, 0, a[j], b[k], 1.0)
    count = _add_product(parts, count, -a[k], b[j], 1.0)
    return _sign(parts, count)


@inner_kernel
def _add_product(parts: FloatArray, count: int, x: float, y: float, z: float) -> int:
    """Add x * y * z to an expansion of `count` parts; returns how many it has now."""
    high, low = _product(x, y)
    for part in (high, low):
        first, second = _product(part, z)
        count = _add(parts, count, second)
        count = _add(parts, count, first)
    return count


@inner_kernel
def _product(x: float, y: float) -> tuple[float, float]:
    """x * y as a rounded product and what the rounding lost."""
    product = x * y
    x_high = SPLITTER * x - (SPLITTER * x - x)
    y_high = SPLITTER * y - (SPLITTER * y - y)
    x_low, y_low = x - x_high, y - y_high
    lost = x_low * y_low - (((product - x_high * y_high) - x_low * y_high) - x_high * y_low)
    return product, lost


@inner_kernel
def _add(parts: FloatArray, count: int, value: float) -> int:
    """Grow an expansion by one float: its parts stay free of overlap and rise in magnitude."""
    carried = value
    for i in range(count):
        total = carried + parts[i]
        virtual = total - carried
        parts[i] = (carried - (total - virtual)) + (parts[i] - virtual)
        carried = total
    parts[count] = carried
    return count + 1


@inner_kernel
def _sign(parts: FloatArray, count: int) -> int:
    for i in range(count - 1, -1, -1):
        if parts[i] != 0.0:
            return 1 if parts[i] > 0.0 else -1
    return 0


ROUNDING = 16.0 * 2.0**-53
"""Error of a triple product of floats, as a share of the product of the three lengths."""

NEGLIGIBLE = 2.0**-200
"""Coordinates below this share of the size are zero; it keeps the exact arithmetic from underflow."""

RAYS_PER_BIN = 2
# Far above the rounding of a direction, and far below the width of a bin.
MARGIN = 1e-9
"""Added to the radius of every cap, in radians."""


class DirectionBins(NamedTuple):
    """Rays by bin.

    - ``rays``: indices of the rays, row by row and column by column, shape (n,).
    - ``first``: position in `rays` of the first ray of each bin, shape (rows * columns + 1,).
    - ``rows``, ``columns``: size of the grid.
    """

    rays: IntArray
    first: IntArray
    rows: int
    columns: int


def direction_bins(directions: FloatArray) -> DirectionBins:
    """Sort rays along unit `directions`, shape (n, 3)."""
    n = len(directions)
    rows = max(1, int(np.sqrt(n / (2.0 * RAYS_PER_BIN))))
    rays, first = np.empty(n, np.int64), np.zeros(2 * rows * rows + 1, np.int64)
    _fill_bins(directions, rows, 2 * rows, rays, first)
    return DirectionBins(rays, first, rows, 2 * rows)


@kernel
def _fill_bins(directions: FloatArray, rows: int, columns: int, rays: IntArray, first: IntArray) -> None:
    """Fill `rays` and `first`, which must be 0, of :class:`DirectionBins`."""
    n = len(directions)
    bins = np.empty(n, np.int64)
    for k in range(n):
        x, y, z = directions[k, 0], directions[k, 1], directions[k, 2]
        bins[k] = row_of(z, rows) * columns + column_of(np.arctan2(y, x), columns) % columns
        first[bins[k] + 1] += 1
    for i in range(rows * columns):
        first[i + 1] += first[i]
    filled = first.copy()
    for k in range(n):
        rays[filled[bins[k]]] = k
        filled[bins[k]] += 1


@inner_kernel
def row_of(z: float, rows: int) -> int:
    """Row of height `z`, which may lie outside -1..1."""
    return min(rows - 1, max(0, int((z + 1.0) * 0.5 * rows)))


@inner_kernel
def column_of(longitude: float, columns: int) -> int:
    """Column of a longitude between -pi and pi; outside them, columns count on."""
    return int(np.floor((longitude / (2.0 * np.pi) + 0.5) * columns))


@inner_kernel
def bins_around(
    a: FloatArray, b: FloatArray, c: FloatArray, rows: int, columns: int
) -> tuple[int, int, int, int]:
    """First and last row and column of the bins that a triangle, seen from the origin, may touch.

    Found from the cap around its three directions. The last column may be `columns` or more: count on
    from column 0.
    """
    everything = (0, rows - 1, 0, columns - 1)
    x = y = z = 0.0
    for p in (a, b, c):
        length = np.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
        if length == 0.0:
            return everything
        x, y, z = x + p[0] / length, y + p[1] / length, z + p[2] / length
    length = np.sqrt(x * x + y * y + z * z)
    # The directions are spread over nearly the whole sphere, and their mean says nothing of them.
    if length < 0.1:
        return everything
    x, y, z = x / length, y / length, z / length
    chord = 0.0
    for p in (a, b, c):
        length = np.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
        far = (p[0] / length - x) ** 2 + (p[1] / length - y) ** 2 + (p[2] / length - z) ** 2
        chord = max(chord, far)
    chord = np.sqrt(chord) + MARGIN
    if chord > 1.4:
        return everything
    cosine, sine = 1.0 - chord**2 / 2.0, chord * np.sqrt(1.0 - chord**2 / 4.0)
    across = np.sqrt(x * x + y * y)
    # A cap that holds a pole reaches to it, and over all longitudes.
    low = row_of(-1.0 if -z >= cosine else z * cosine - across * sine - MARGIN, rows)
    high = row_of(1.0 if z >= cosine else z * cosine + across * sine + MARGIN, rows)
    if abs(z) >= cosine or sine >= across:
        return low, high, 0, columns - 1
    half = np.arcsin(sine / across) + MARGIN
    middle = np.arctan2(y, x)
    left, right = column_of(middle - half, columns), column_of(middle + half, columns)
    if right - left >= columns:
        return low, high, 0, columns - 1
    return (low, high, left, right) if left >= 0 else (low, high, left + columns, right + columns)


@dataclass(frozen=True, eq=False)
class RadialHits:
    """Where rays from one origin cross a mesh, sorted by ray, then by distance.

    - ``ray``: index of the direction, shape (k,).
    - ``distance``: from the origin, shape (k,), in the unit of the mesh.
    - ``sign``: +1 where the ray leaves the solid, -1 where it enters, shape (k,).
    - ``face``: index of the triangle, shape (k,).
    """

    ray: IntArray
    distance: FloatArray
    sign: IntArray
    face: IntArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "ray", locked_integers(self.ray, (None,), "ray"))
        n_hits = len(self.ray)
        object.__setattr__(self, "distance", locked_floats(self.distance, (n_hits,), "distance"))
        object.__setattr__(self, "sign", locked_integers(self.sign, (n_hits,), "sign"))
        object.__setattr__(self, "face", locked_integers(self.face, (n_hits,), "face"))

    def __reduce__(self) -> tuple[Callable[..., "RadialHits"], tuple[Any, ...]]:
        return RadialHits, (self.ray, self.distance, self.sign, self.face)

    def __len__(self) -> int:
        return len(self.ray)


def radial_hits(mesh: Mesh, origin: ArrayLike, directions: ArrayLike) -> RadialHits:
    """Every crossing of the rays ``origin + t * directions[k]``, t > 0, with the mesh.

    The origin is not on the surface; distances do not depend on the lengths of the directions (n, 3).

    Raises ValueError if a direction vanishes.
    """
    centre = locked_floats(origin, (3,), "origin")
    rays = _scaled(locked_floats(directions, (None, 3), "directions"))
    lengths = np.linalg.norm(rays, axis=1)
    if not (lengths > 0.0).all():
        raise ValueError("directions must not vanish")
    points = mesh.vertices - centre
    # A power of two: dividing by it changes no bit of a coordinate, on which exact signs depend.
    size = 2.0 ** np.ceil(np.log2(max(float(np.abs(points).max(initial=0.0)), 1e-300)))
    bins = direction_bins(rays / lengths[:, None])
    corners, space = _scaled(points / size), 2 * len(rays) + 64
    crossings, distance = np.empty((space, 3), np.int64), np.empty(space)
    n = _cast(corners, mesh.faces, rays, lengths, bins, crossings, distance)
    if n > space:
        crossings, distance = np.empty((n, 3), np.int64), np.empty(n)
        _cast(corners, mesh.faces, rays, lengths, bins, crossings, distance)
    ray, sign, face = crossings[:n].T.copy()
    order = np.empty(n, np.int64)
    _sort(ray, distance[:n], face, len(rays), order)
    return RadialHits(ray[order], distance[order] * size, sign[order], face[order])


def _scaled(vectors: FloatArray) -> FloatArray:
    """The vectors with negligible coordinates set to zero."""
    return np.asarray(np.where(np.abs(vectors) < NEGLIGIBLE, 0.0, vectors))


@kernel
def _cast(
    points: FloatArray,
    faces: IntArray,
    directions: FloatArray,
    lengths: FloatArray,
    bins: DirectionBins,
    crossings: IntArray,
    distance: FloatArray,
) -> int:
    """Fill `crossings` (ray, sign, face) and `distance` in the order of the faces; how many there are.

    Those beyond the length of the arrays are counted only.
    """
    norms = np.empty(len(points))
    for v in range(len(points)):
        norms[v] = length(row(points, v))
    n = 0
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        a, b, c = points[i], points[j], points[k]
        errors = (
            ROUNDING * norms[i] * norms[j],
            ROUNDING * norms[j] * norms[k],
            ROUNDING * norms[k] * norms[i],
        )
        corners = row(points, i), row(points, j), row(points, k)
        planes = cross(corners[0], corners[1]), cross(corners[1], corners[2]), cross(corners[2], corners[0])
        six = dot(planes[0], corners[2])
        way = 1.0 if six > 0.0 else -1.0
        if abs(six) <= errors[0] * norms[k]:
            way = float(sign_of_triple_product(a, b, c))
            if way == 0.0:
                continue
        normal = mixed(mixed(planes[0], 1.0, planes[1], 1.0), 1.0, planes[2], 1.0)
        nearest = abs(six) / length(normal)
        farthest = max(norms[i], norms[j], norms[k])
        low, high, left, right = bins_around(a, b, c, bins.rows, bins.columns)
        for band in range(low, high + 1):
            for turn in range(1 if right < bins.columns else 2):
                start = band * bins.columns + (left if turn == 0 else 0)
                stop = band * bins.columns + (
                    min(right, bins.columns - 1) if turn == 0 else right - bins.columns
                )
                for m in range(bins.first[start], bins.first[stop + 1]):
                    ray = bins.rays[m]
                    least = _least(directions, ray, lengths[ray], way, planes, errors)
                    if least < 0.0 or (least == 0.0 and not _exactly_inside(directions[ray], a, b, c, way)):
                        continue
                    n += 1
                    if n > len(distance):
                        continue
                    slope = way * along(directions, ray, normal) / lengths[ray]
                    crossings[n - 1, 0], crossings[n - 1, 1], crossings[n - 1, 2] = ray, int(way), f
                    # Where the ray nearly lies in the plane of the triangle the quotient is rounding: the hit
                    # is between its nearest and its farthest point.
                    far = abs(six) / slope if slope > 0.0 else farthest
                    distance[n - 1] = max(nearest, min(farthest, far))
    return n


@inner_kernel
def _least(
    directions: FloatArray,
    ray: int,
    size: float,
    way: float,
    planes: tuple[Vector, Vector, Vector],
    errors: Vector,
) -> float:
    """-1 where a ray is surely outside one of the planes, 1 where inside all, 0 where rounding hides it."""
    one = way * along(directions, ray, planes[0])
    two = way * along(directions, ray, planes[1])
    three = way * along(directions, ray, planes[2])
    if one < -errors[0] * size or two < -errors[1] * size or three < -errors[2] * size:
        return -1.0
    sure = one > errors[0] * size and two > errors[1] * size and three > errors[2] * size
    return 1.0 if sure else 0.0


@kernel
def _exactly_inside(u: FloatArray, a: FloatArray, b: FloatArray, c: FloatArray, way: float) -> bool:
    """Whether `u` is on side `way` of all three planes through the origin and an edge, without rounding."""
    return bool(_side(u, a, b) == way and _side(u, b, c) == way and _side(u, c, a) == way)


@kernel
def _side(u: FloatArray, a: FloatArray, b: FloatArray) -> int:
    """Sign of u . (a x b), and if that is zero, of u moved by (e, e^2, e^3) with e infinitely small."""
    sign = sign_of_triple_product(u, a, b)
    for axis in range(3):
        # The coefficients of e, e^2 and e^3 are the components of a x b.
        if sign == 0:
            sign = sign_of_cross_product(a, b, axis)
    return sign


@kernel
def _sort(ray: IntArray, distance: FloatArray, face: IntArray, n_rays: int, order: IntArray) -> None:
    """Fill `order`, that of the crossings by ray, distance and face."""
    # Counted by ray, then sorted by insertion: a ray has few crossings.
    first = np.zeros(n_rays + 1, np.int64)
    for k in ray:
        first[k + 1] += 1
    for k in range(n_rays):
        first[k + 1] += first[k]
    count = np.zeros(n_rays, np.int64)
    for hit in range(len(ray)):
        k = ray[hit]
        i = first[k] + count[k]
        while i > first[k] and (
            distance[order[i - 1]] > distance[hit]
            or (distance[order[i - 1]] == distance[hit] and face[order[i - 1]] > face[hit])
        ):
            order[i] = order[i - 1]
            i -= 1
        order[i] = hit
        count[k] += 1
