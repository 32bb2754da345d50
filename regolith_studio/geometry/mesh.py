"""Closed triangular meshes: the shape of a particle as scanned, fitted or drawn, and its mass properties.

Cached properties that hold arrays, within a limit on the memory that all of them take.
"""

import hashlib
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from threading import Lock
from typing import Any, Generic, TypeVar, overload
from weakref import ReferenceType, ref

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull, QhullError, cKDTree
from scipy.special import elliprg

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import (
    FloatArray,
    IntArray,
    locked_floats,
    locked_integers,
)
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed, row
from regolith_studio.io.triangles import used_vertices


@kernel
def volume_moments(
    points: FloatArray, faces: IntArray, middle: FloatArray, first: FloatArray, second: FloatArray
) -> float:
    """Signed volume; fills its first moments (3,) and its second moments (3, 3), all about `middle`.

    Sums of the signed tetrahedra between `middle` and the triangles: with corners a, b, c and their sum s the
    moments of one are s / 24 and (s s' + a a' + b b' + c c') / 120 times six volumes (divergence theorem).
    `middle` (3,) lies near the closed mesh, so that little is lost to rounding.
    """
    volume = x = y = z = xx = yy = zz = xy = yz = zx = 0.0
    origin = middle[0], middle[1], middle[2]
    for f in range(len(faces)):
        a = mixed(row(points, faces[f, 0]), 1.0, origin, -1.0)
        b = mixed(row(points, faces[f, 1]), 1.0, origin, -1.0)
        c = mixed(row(points, faces[f, 2]), 1.0, origin, -1.0)
        s = mixed(mixed(a, 1.0, b, 1.0), 1.0, c, 1.0)
        six = dot(a, cross(b, c))
        volume += six
        x, y, z = x + six * s[0], y + six * s[1], z + six * s[2]
        xx += six * (s[0] * s[0] + a[0] * a[0] + b[0] * b[0] + c[0] * c[0])
        yy += six * (s[1] * s[1] + a[1] * a[1] + b[1] * b[1] + c[1] * c[1])
        zz += six * (s[2] * s[2] + a[2] * a[2] + b[2] * b[2] + c[2] * c[2])
        xy += six * (s[0] * s[1] + a[0] * a[1] + b[0] * b[1] + c[0] * c[1])
        yz += six * (s[1] * s[2] + a[1] * a[2] + b[1] * b[2] + c[1] * c[2])
        zx += six * (s[2] * s[0] + a[2] * a[0] + b[2] * b[0] + c[2] * c[0])
    first[0], first[1], first[2] = x / 24.0, y / 24.0, z / 24.0
    second[0, 0], second[1, 1], second[2, 2] = xx / 120.0, yy / 120.0, zz / 120.0
    second[0, 1] = second[1, 0] = xy / 120.0
    second[1, 2] = second[2, 1] = yz / 120.0
    second[2, 0] = second[0, 2] = zx / 120.0
    return volume / 6.0


def volume_and_area(vertices: FloatArray, faces: IntArray) -> tuple[float, float]:
    """Signed volume (divergence theorem, about the middle of the bounds) and surface area of triangles.

    Equal to ``Mesh.volume`` and ``Mesh.surface_area`` but for rounding, in one compiled pass.
    """
    return _measured(vertices, faces) if len(faces) else (0.0, 0.0)


@kernel
def _measured(points: FloatArray, faces: IntArray) -> tuple[float, float]:
    middle = _middle(points)
    volume = area = 0.0
    for f in range(len(faces)):
        a = mixed(row(points, faces[f, 0]), 1.0, middle, -1.0)
        b = mixed(row(points, faces[f, 1]), 1.0, middle, -1.0)
        c = mixed(row(points, faces[f, 2]), 1.0, middle, -1.0)
        normal = cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0))
        volume += dot(a, normal)
        area += length(normal)
    return volume / 6.0, area / 2.0


@kernel
def _middle(points: FloatArray) -> Vector:
    """Middle of the bounds."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for i in range(len(points)):
        for k in range(3):
            low[k], high[k] = min(low[k], points[i, k]), max(high[k], points[i, k])
    return (low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, (low[2] + high[2]) / 2.0


def equal_ellipsoid(inertia: FloatArray, volume: float) -> FloatArray:
    """Semi-axes, longest first, of the ellipsoid of this volume with the inertia (3, 3) of volume 1."""
    # The second moments, which for an ellipsoid go with the squares of its semi-axes.
    second = np.trace(inertia) / 2 * np.eye(3) - inertia
    shape = np.sqrt(np.linalg.eigvalsh(second)[::-1])
    radius = np.cbrt(3.0 * volume / (4.0 * np.pi))
    return np.asarray(shape * radius / np.cbrt(np.prod(shape)))


def ellipsoid_area(semi_axes: FloatArray) -> float:
    """Surface area of an ellipsoid, by Carlson's symmetric elliptic integral R_G."""
    a, b, c = np.asarray(semi_axes) / semi_axes[0]
    return float(4.0 * np.pi * elliprg((a * b) ** 2, (a * c) ** 2, (b * c) ** 2) * semi_axes[0] ** 2)


T = TypeVar("T")

ALWAYS_CACHED_BYTES = 16_384
"""Bytes up to which a value stays for as long as its owner does."""
MANY_VERTICES = 100_000
"""From which on vertices are sorted before the hull is built, so that near ones lie near in memory: a third
faster."""
MAX_CACHED_BYTES = 64_000_000
"""Bytes that all larger values together may take, apart from those of the last owner."""


class CachedArray(Generic[T]):
    """A property that is computed at its first access and then cached, like ``cached_property``.

    Large values are dropped again, oldest first, when all of them together take more than
    :data:`MAX_CACHED_BYTES`, and recomputed at the next access: hundreds of open particles do not each hold
    the arrays that they were measured by.

    ``compute``: a method without arguments whose value is an array, or has arrays as ``vertices`` and
    ``faces``.
    """

    def __init__(self, compute: Callable[[Any], T]) -> None:
        self._compute, self._name = compute, compute.__name__
        self.__doc__ = compute.__doc__

    @overload
    def __get__(self, owner: None, kind: type) -> "CachedArray[T]": ...
    @overload
    def __get__(self, owner: object, kind: type) -> T: ...
    def __get__(self, owner: object | None, kind: type) -> "CachedArray[T] | T":
        if owner is None:
            return self
        value = self._compute(owner)
        owner.__dict__[self._name] = value
        if (size := _bytes(value)) > ALWAYS_CACHED_BYTES:
            _ledger.add(owner, self._name, size)
        return value


class _CacheLedger:
    """The large cached values, oldest first."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._entries: deque[tuple[ReferenceType[object], str, int]] = deque()
        self._size = 0

    def add(self, owner: object, name: str, size: int) -> None:
        with self._lock:
            self._entries.append((ref(owner), name, size))
            self._size += size
            # Not those of the last owner, which is being measured and would compute them again and again.
            while self._size > MAX_CACHED_BYTES and self._entries[0][0]() is not owner:
                oldest, name, size = self._entries.popleft()
                self._size -= size
                if (gone := oldest()) is not None:
                    gone.__dict__.pop(name, None)


_ledger = _CacheLedger()


def _bytes(value: Any) -> int:
    parts = (value,) if hasattr(value, "nbytes") else (value.vertices, value.faces)
    return sum(int(part.nbytes) for part in parts)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangular mesh.

    Any triangles are accepted; volume, centroid and inertia mean what their names say only for
    closed surfaces whose triangles run counter-clockwise seen from outside
    (:mod:`regolith_studio.geometry.mesh_health` tells).

    Parameters
    ----------
    vertices
        Shape (n, 3); in micrometres for particles, dimensionless for unit-volume shapes. Those that no face
        uses are left out, so that box, hull and diameters are those of the triangles; a mesh without faces
        keeps its points.
    faces
        Vertex indices, shape (m, 3).

    Raises
    ------
    ValueError
        If a shape is wrong, a coordinate is not finite or an index points nowhere.
    """

    vertices: FloatArray
    faces: IntArray

    def __post_init__(self) -> None:
        vertices = locked_floats(self.vertices, (None, 3), "vertices")
        faces = locked_integers(self.faces, (None, 3), "faces")
        if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
            raise ValueError(f"faces must index {len(vertices)} vertices, got {faces.min()} to {faces.max()}")
        if len(faces):
            vertices, faces = used_vertices(vertices, faces)
            vertices.flags.writeable = faces.flags.writeable = False
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)

    def __reduce__(self) -> tuple[Callable[..., "Mesh"], tuple[ArrayLike, ArrayLike]]:
        return Mesh, (self.vertices, self.faces)

    @CachedArray
    def triangles(self) -> FloatArray:
        """Corner coordinates, shape (m, 3, 3): triangle, corner, axis."""
        return self.vertices[self.faces]

    @CachedArray
    def face_area_vectors(self) -> FloatArray:
        """Normal of each triangle times its area, shape (m, 3)."""
        a, b, c = np.moveaxis(self.triangles, 1, 0)
        return np.asarray(np.cross(b - a, c - a) / 2)

    @CachedArray
    def face_areas(self) -> FloatArray:
        """Area of each triangle, shape (m,)."""
        return np.asarray(np.linalg.norm(self.face_area_vectors, axis=1))

    @cached_property
    def surface_area(self) -> float:
        """Sum of the triangles' areas."""
        return float(self.face_areas.sum())

    @cached_property
    def bounds(self) -> FloatArray:
        """Lowest and highest corner of the axis-aligned box, shape (2, 3)."""
        if not len(self.vertices):
            raise ValueError("a mesh without vertices has no bounds")
        return bounds_of(self.vertices)

    @cached_property
    def _moments(self) -> tuple[float, FloatArray, FloatArray]:
        """Volume, centroid (3,) and central second moments (3, 3) of the enclosed volume."""
        if not len(self.vertices):
            return 0.0, np.zeros(3), np.zeros((3, 3))
        middle = self.bounds.mean(axis=0)
        first, second = np.empty(3), np.empty((3, 3))
        volume = volume_moments(self.vertices, self.faces, middle, first, second)
        if volume == 0.0:
            return 0.0, middle, np.zeros((3, 3))
        offset = first / volume
        return volume, middle + offset, second - volume * np.outer(offset, offset)

    @property
    def volume(self) -> float:
        """Signed volume by the divergence theorem; negative where the mesh is inside out."""
        return self._moments[0]

    @property
    def centroid(self) -> FloatArray:
        """Centre of mass of the enclosed volume, shape (3,)."""
        return self._moments[1]

    @cached_property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the centroid at density 1, shape (3, 3)."""
        second = self._moments[2]
        return np.asarray(np.trace(second) * np.eye(3) - second)

    @CachedArray
    def hull(self) -> "Mesh":
        """Convex hull (Qhull), triangulated, with outward normals.

        Raises GeometryError if the vertices lie in one plane.
        """
        low, high = self.bounds
        size = float((high - low).max())
        if size == 0.0:
            raise GeometryError("The mesh is a single point and has no convex hull.")
        # The precision of Qhull goes with the largest coordinate.
        unit = (self.vertices - (low + high) / 2) / size
        order = np.arange(len(unit), dtype=np.int32)
        if len(unit) > MANY_VERTICES:
            order = cKDTree(unit).indices.astype(np.int32)
        try:
            hull = ConvexHull(unit[order])
        except (QhullError, ValueError) as error:
            raise GeometryError("The mesh is flat: its vertices lie in one plane.") from error
        used, faces = np.empty(len(unit), np.int64), np.empty((len(hull.simplices), 3), np.int64)
        n_used = _turn_outwards(unit, order[hull.simplices], hull.equations, used, faces)
        return Mesh(self.vertices[used[:n_used]], faces)

    @cached_property
    def content_hash(self) -> str:
        """SHA-256 of vertices and faces, as hexadecimal digits."""
        digest = hashlib.sha256(self.vertices.astype("<f8").tobytes())
        digest.update(self.faces.astype("<i8").tobytes())
        return digest.hexdigest()

    def moved(
        self, *, shift: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None, scale: float = 1.0
    ) -> "Mesh":
        """The mesh with every vertex x at ``scale * rotation @ (x + shift)``."""
        vertices = (self.vertices + np.asarray(shift, dtype=np.float64)) * scale
        if rotation is not None:
            vertices = vertices @ np.asarray(rotation, dtype=np.float64).T
        return Mesh(vertices, self.faces)

    def normalised(self) -> "Mesh":
        """The mesh centred at its centroid and scaled to unit volume.

        Raises GeometryError if the volume is not positive.
        """
        if not self.volume > 0.0:
            raise GeometryError(f"The mesh encloses no volume (its signed volume is {self.volume:.3g}).")
        return self.moved(shift=-self.centroid, scale=self.volume ** (-1 / 3))


def bounds_of(points: FloatArray) -> FloatArray:
    """Least and greatest coordinates of at least one point, shape (2, 3)."""
    bounds = np.empty((2, 3))
    _fill_bounds(points, bounds)
    return bounds


@kernel
def _fill_bounds(points: FloatArray, bounds: FloatArray) -> None:
    for k in range(3):
        bounds[0, k] = bounds[1, k] = points[0, k]
    for i in range(len(points)):
        for k in range(3):
            bounds[0, k] = min(bounds[0, k], points[i, k])
            bounds[1, k] = max(bounds[1, k], points[i, k])


@kernel
def _turn_outwards(
    points: FloatArray,
    simplices: NDArray[np.int32],
    equations: FloatArray,
    used: IntArray,
    faces: IntArray,
) -> int:
    """Fill the points that a hull uses, in their order, and its triangles by these; number of the points."""
    number = np.full(len(points), -1)
    for f in range(len(simplices)):
        for k in range(3):
            number[simplices[f, k]] = 0
    n_used = 0
    for i in range(len(points)):
        if number[i] == 0:
            used[n_used], number[i] = i, n_used
            n_used += 1
    for f in range(len(simplices)):
        a = row(points, simplices[f, 0])
        b, c = row(points, simplices[f, 1]), row(points, simplices[f, 2])
        normal = cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0))
        inward = dot(normal, row(equations, f)) < 0.0
        for k in range(3):
            faces[f, k] = number[simplices[f, 2 - k if inward else k]]
    return n_used
