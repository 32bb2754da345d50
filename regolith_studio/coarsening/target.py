"""The particle that is coarsened: at unit volume, in its principal axes, with all its descriptors."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from regolith_studio.coarsening.core.overlap import RayTable, jaccard, shared_volume
from regolith_studio.descriptors.catalogue import CATALOGUE, DEFAULT_KEYS, ShapeCache
from regolith_studio.descriptors.describe import Descriptors
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.half_spaces import HalfSpaces, exits
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import OrientedBox
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.geometry.vectors import along, cross, length, mixed, row

MIN_SPAN = 1e-150
"""Below this size the volume of a mesh cannot be told from 0."""
COORDINATE_STEP = 2.0**-26
"""Coordinates of the normalised particle are multiples of this: far above the rounding of a moved and turned
mesh, so that it hardly ever decides which multiple is taken, and far below errors that count."""
MAX_WRONG_CROSSINGS = 0.05
"""Share of wrong crossings above which a mesh counts as intersecting itself."""


@dataclass(frozen=True, eq=False)
class Target:
    """A particle to be imitated, and what was measured of it.

    The mesh is closed, outward-oriented, of unit volume, with its centroid at the origin and its principal
    axes along x, y, z. Coordinates are rounded to 2^-26, vertices and triangles sorted by them, so that unit,
    place, orientation and the order in which a file lists them do not matter. Centroid (3,) and principal
    axes (3, 3), one a row, are those in the particle's own frame; `scale` is the length in its unit that one
    unit of the mesh stands for. Descriptors and least box are those of the mesh.
    """

    mesh: Mesh
    centre: FloatArray
    axes: FloatArray
    scale: float
    descriptors: Descriptors
    box: OrientedBox

    @classmethod
    def of(cls, mesh: Mesh) -> "Target":
        """Normalise and measure a particle; a mesh that is inside out is turned.

        Raises
        ------
        GeometryError
            If the mesh is not closed, encloses no volume or largely intersects itself.
        """
        unit, centre, scale = _normalised(mesh)
        axes = principal_axes(unit)
        rounded = np.round(unit.vertices @ axes.T / COORDINATE_STEP) * COORDINATE_STEP
        # After rounding: only then coordinates are the same in every orientation.
        aligned = _in_order(rounded, unit.faces)
        facts = ShapeCache(aligned)
        descriptors = Descriptors({key: CATALOGUE[key].compute(facts) for key in DEFAULT_KEYS})
        target = cls(aligned, centre, axes, scale, descriptors, facts.box)
        _check_simple(target.rays)
        return target

    @property
    def solidity(self) -> float:
        """Volume over the volume of the convex hull: 1 for convex particles."""
        return self.descriptors["volume"] / self.descriptors["convex_hull_volume"]

    @cached_property
    def rays(self) -> RayTable:
        """2,000 rays: error of the Jaccard distance about 0.0002."""
        return _crossings(self.mesh, 2000)

    def jaccard_distance(self, half_spaces: HalfSpaces) -> float:
        """Eq. 7 with 16,000 rays, all volumes by the same quadrature.

        It is taken where the particle's box is a cube, which changes no ratio of volumes: rays in even
        directions would miss most of a needle.
        """
        rays, stretch = self._dense_rays, self._stretch
        radius = np.empty(len(rays.directions))
        plane = np.empty(len(rays.directions), dtype=np.int64)
        normals, offsets = half_spaces.normals @ stretch, np.array(half_spaces.offsets)
        exits(normals, offsets, rays.directions, radius, plane)
        shared = shared_volume(rays.first, rays.distance, rays.sign, rays.weight, radius)
        return float(jaccard(shared, 1.0, rays.weight * float(np.sum(radius**3)) / 3.0))

    @cached_property
    def _dense_rays(self) -> RayTable:
        """Crossings in coordinates y where x = stretch y."""
        vertices = self.mesh.vertices @ np.linalg.inv(self._stretch).T
        return _crossings(Mesh(vertices, self.mesh.faces), 16_000)

    @cached_property
    def _stretch(self) -> FloatArray:
        """From a cube to the particle's box, shape (3, 3)."""
        return np.ascontiguousarray(self.box.axes.T * self.box.extents)

    def in_particle_frame(self, half_spaces: HalfSpaces) -> HalfSpaces:
        """Half-spaces about the particle's centroid, in the particle's unit and orientation."""
        return HalfSpaces(half_spaces.normals @ self.axes, half_spaces.offsets * self.scale)

    def in_unit_frame(self, half_spaces: HalfSpaces) -> HalfSpaces:
        """The inverse of :meth:`in_particle_frame`."""
        return HalfSpaces(half_spaces.normals @ self.axes.T, half_spaces.offsets / self.scale)


def _crossings(mesh: Mesh, n_rays: int) -> RayTable:
    """Those of `n_rays` Fibonacci directions with a mesh."""
    directions = np.ascontiguousarray(fibonacci_directions(n_rays))
    hits = radial_hits(mesh, np.zeros(3), directions)
    first = np.concatenate([[0], np.cumsum(np.bincount(hits.ray, minlength=n_rays))])
    # Copies: numba would compile kernels a second time for arrays that cannot be written.
    distance, sign = np.array(hits.distance), hits.sign.astype(np.float64)
    return RayTable(directions, first, distance, sign, 3.0 / float(np.sum(sign * distance**3)))


def principal_axes(mesh: Mesh) -> FloatArray:
    """Right-handed principal axes of inertia as rows, each towards the longer tail of the particle."""
    _, vectors = np.linalg.eigh(mesh.inertia)
    axes = np.ascontiguousarray(vectors.T)
    tails = np.zeros(3)
    _add_tails(mesh.vertices, mesh.faces, axes, tails)
    axes *= np.where(tails < 0.0, -1.0, 1.0)[:, None]
    # Not by its own tail, which would mirror some particles.
    axes[2] = np.cross(axes[0], axes[1])
    return np.asarray(axes, dtype=np.float64)


def _in_order(vertices: FloatArray, faces: IntArray) -> Mesh:
    """The mesh with sorted vertices; triangles begin with their first one and are sorted, too.

    Vertices at one place are one, so that triangles that share no corners are the same particle.
    """
    corners, faces = np.unique(faces, return_inverse=True)
    vertices = vertices[corners]
    order = np.lexsort(vertices.T[::-1])
    vertices = vertices[order]
    first = np.append(True, (vertices[1:] != vertices[:-1]).any(axis=1))
    place = np.empty(len(order), dtype=np.int64)
    place[order] = np.cumsum(first) - 1
    faces = place[faces.reshape(-1, 3)]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    turned = (faces.argmin(axis=1)[:, None] + np.arange(3)) % 3
    faces = np.take_along_axis(faces, turned, axis=1)
    return Mesh(vertices[first], faces[np.lexsort(faces.T[::-1])])


@kernel
def _add_tails(points: FloatArray, faces: IntArray, axes: FloatArray, total: FloatArray) -> None:
    """Third moment of the surface along each axis, by the middles of its triangles: added to `total`."""
    for f in range(len(faces)):
        a, b, c = row(points, faces[f, 0]), row(points, faces[f, 1]), row(points, faces[f, 2])
        area = length(cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0)))
        middle = mixed(mixed(a, 1.0, b, 1.0), 1.0, c, 1.0)
        for k in range(3):
            total[k] += area * along(axes, k, middle) ** 3


def _normalised(mesh: Mesh) -> tuple[Mesh, FloatArray, float]:
    """Mesh of unit volume about its centroid, the centroid, and the length of one unit."""
    if len(mesh.faces) < 4:
        raise GeometryError(f"A particle needs at least 4 triangles, got {len(mesh.faces)}.")
    low, high = mesh.bounds
    size = float((high - low).max())
    if not size > MIN_SPAN:
        raise GeometryError("The mesh is a single point and encloses no volume.")
    _check_closed(mesh)
    # At size 1 first: cubes of coordinates in small or large units would not be numbers.
    middle = (low + high) / 2
    rough = mesh.moved(shift=-middle, scale=1.0 / size)
    if rough.volume < 0.0:
        rough = Mesh(rough.vertices, rough.faces[:, ::-1])
    if rough.volume < 1e-9:
        raise GeometryError(
            f"The mesh is flat: it fills {max(rough.volume, 0.0):.2g} of the cube of its longest side."
        )
    centre = middle + size * rough.centroid
    return rough.normalised(), centre, size * rough.volume ** (1 / 3)


def _check_simple(rays: RayTable) -> None:
    """Along a ray, leaving and entering must alternate and end with leaving."""
    # Behind its last crossing a ray is outside, as before an entry.
    last = np.zeros(len(rays.sign), dtype=bool)
    last[rays.first[1:][np.diff(rays.first) > 0] - 1] = True
    following = np.where(last, -1.0, np.roll(rays.sign, -1))
    wrong = float(np.mean(following == rays.sign))
    if wrong > MAX_WRONG_CROSSINGS:
        raise GeometryError(
            f"The mesh intersects itself: {100 * wrong:.0f} % of its crossings with rays enter or leave twice"
            " in a row; repair it first."
        )


def _check_closed(mesh: Mesh) -> None:
    """Every directed edge must be met by its opposite, once the vertices at one place are one."""
    if _closes(mesh.faces, len(mesh.vertices)):
        return
    _, label = np.unique(mesh.vertices, axis=0, return_inverse=True)
    faces = label.reshape(-1)[mesh.faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    forward, backward = _edges(faces, int(label.max()) + 1)
    if not np.array_equal(forward, backward):
        open_edges = len(np.setxor1d(forward, backward)) // 2
        raise GeometryError(
            f"The mesh is not closed: {max(open_edges, 1)} edges have a triangle on one side only;"
            " repair it first."
        )


def _closes(faces: IntArray, n_vertices: int) -> bool:
    """Whether every directed edge is met by its opposite."""
    return np.array_equal(*_edges(faces, n_vertices))


def _edges(faces: IntArray, n_vertices: int) -> tuple[IntArray, IntArray]:
    """One number for each directed edge, and for its opposite, both sorted."""
    start, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    return np.sort(start * n_vertices + end), np.sort(end * n_vertices + start)
