"""Convex polyhedra bounded by half-spaces: the particles that DEM codes take (Eq. 5)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import ConvexHull, QhullError, cKDTree

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

MERGE_TOLERANCE = 1e-10
"""Vertices closer than this share of the largest coordinate are one vertex."""


@dataclass(frozen=True, eq=False)
class ConvexPolyhedron(LockedRecord):
    """A bounded intersection of half-spaces, with its vertices and polygonal facets.

    Parameters
    ----------
    half_spaces
        One half-space a facet, in the order of `facets`; redundant ones are not kept.
    vertices
        Shape (v, 3).
    facets
        For each half-space the indices of its vertices, counter-clockwise seen from outside.
    """

    half_spaces: HalfSpaces
    vertices: FloatArray
    facets: tuple[tuple[int, ...], ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", locked_floats(self.vertices, (None, 3), "vertices"))
        if len(self.facets) != len(self.half_spaces):
            raise ValueError(
                f"{len(self.half_spaces)} half-spaces need as many facets, got {len(self.facets)}"
            )

    @classmethod
    def from_half_spaces(cls, half_spaces: HalfSpaces) -> "ConvexPolyhedron":
        """Intersect half-spaces by the convex hull of the dual points n_i / h_i (Qhull).

        Raises GeometryError if the intersection is unbounded.
        """
        corners, triples = _dual_vertices(half_spaces)
        vertices, merged = _merged(corners)
        planes, around = _ordered(vertices, triples, merged, half_spaces.normals)
        counts = np.bincount(planes, minlength=len(half_spaces))
        # A plane with fewer touches the polyhedron in a corner or an edge only.
        kept, ends, places = counts >= 3, np.cumsum(counts), around.tolist()
        facets = tuple(
            tuple(places[end - count : end]) for end, count in zip(ends[kept], counts[kept], strict=True)
        )
        solid = HalfSpaces(half_spaces.normals[kept], half_spaces.offsets[kept])
        return cls(solid, vertices, facets)

    @property
    def n_facets(self) -> int:
        """Number of polygonal facets."""
        return len(self.facets)

    @property
    def n_vertices(self) -> int:
        """Number of vertices; 2 n - 4 for n facets in general position."""
        return len(self.vertices)

    @property
    def n_triangles(self) -> int:
        """Number of triangles of the facets' triangulation; 4 n - 12 in general position."""
        return sum(len(facet) - 2 for facet in self.facets)

    @cached_property
    def mesh(self) -> Mesh:
        """The facets cut into triangles, fan-wise from each facet's first vertex."""
        fans = [(f[0], f[i], f[i + 1]) for f in self.facets for i in range(1, len(f) - 1)]
        return Mesh(self.vertices, np.array(fans, dtype=np.int64))

    @cached_property
    def triangle_facets(self) -> IntArray:
        """Facet of each triangle of `mesh`, shape (n_triangles,)."""
        return np.repeat(np.arange(self.n_facets), [len(facet) - 2 for facet in self.facets])

    @cached_property
    def facet_areas(self) -> FloatArray:
        """Area of each facet, shape (n_facets,)."""
        areas = np.bincount(self.triangle_facets, weights=self.mesh.face_areas, minlength=self.n_facets)
        return areas.astype(np.float64)

    @property
    def facet_normals(self) -> FloatArray:
        """Outward unit normal of each facet, shape (n_facets, 3)."""
        return self.half_spaces.normals

    @property
    def part_meshes(self) -> tuple[Mesh, ...]:
        """The mesh alone: a convex polyhedron is its only part."""
        return (self.mesh,)

    @property
    def part_planes(self) -> tuple[tuple[FloatArray, FloatArray], ...]:
        """Normals (n, 3) and offsets (n,) of the planes, of the only part."""
        return ((self.half_spaces.normals, self.half_spaces.offsets),)

    @property
    def volume(self) -> float:
        """Enclosed volume."""
        return self.mesh.volume

    @property
    def surface_area(self) -> float:
        """Sum of the facets' areas."""
        return self.mesh.surface_area

    @property
    def centroid(self) -> FloatArray:
        """Centre of mass, shape (3,)."""
        return self.mesh.centroid

    def moved(
        self, *, shift: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None, scale: float = 1.0
    ) -> "ConvexPolyhedron":
        """The polyhedron with every point x at ``scale * rotation @ (x + shift)``.

        Raises GeometryError if the origin does not stay strictly inside.
        """
        step = np.asarray(shift, dtype=np.float64)
        turn = np.eye(3) if rotation is None else np.asarray(rotation, dtype=np.float64)
        old = self.half_spaces
        planes = HalfSpaces(old.normals @ turn.T, (old.offsets + old.normals @ step) * scale)
        return ConvexPolyhedron(planes, ((self.vertices + step) * scale) @ turn.T, self.facets)


def _dual_vertices(half_spaces: HalfSpaces) -> tuple[FloatArray, IntArray]:
    """Vertices (k, 3) and the three planes that meet in each (k, 3)."""
    # At this scale the dual points are at least 1 away from the origin, whatever the unit of length.
    size = float(half_spaces.offsets.max())
    try:
        dual = ConvexHull(half_spaces.normals * (size / half_spaces.offsets)[:, None])
    except (QhullError, ValueError) as error:
        raise GeometryError("The half-spaces bound no volume: their intersection is unbounded.") from error
    distance = -dual.equations[:, 3]
    # The intersection is bounded if and only if the dual hull holds the origin strictly inside.
    if not (distance > 1e-12).all():
        raise GeometryError("The half-spaces bound no volume: their intersection is unbounded.")
    return dual.equations[:, :3] / distance[:, None] * size, dual.simplices.astype(np.int64)


def _merged(corners: FloatArray) -> tuple[FloatArray, IntArray]:
    """Distinct corners, and for each corner the index of its distinct one."""
    tolerance = MERGE_TOLERANCE * float(np.abs(corners).max())
    pairs = cKDTree(corners).query_pairs(tolerance, output_type="ndarray")
    root = np.arange(len(corners))
    for first, second in pairs:
        root[root == root[second]] = root[first]
    distinct, inverse = np.unique(root, return_inverse=True)
    return corners[distinct], inverse.astype(np.int64)


def _tangents(normals: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors across each normal, (n, 3) each; with it they are right-handed."""
    first = np.cross(normals, np.eye(3)[np.abs(normals).argmin(axis=1)])
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(normals, first)


def _ordered(
    vertices: FloatArray, triples: IntArray, merged: IntArray, normals: FloatArray
) -> tuple[IntArray, IntArray]:
    """Planes, rising, and the vertices in them, counter-clockwise about each normal; shape (k,) both."""
    pairs = np.unique(triples * len(vertices) + merged[:, None])
    planes, around = pairs // len(vertices), pairs % len(vertices)
    corners, counts = vertices[around], np.bincount(planes, minlength=len(normals))
    middles = np.column_stack([np.bincount(planes, each, len(normals)) for each in corners.T])
    spokes = corners - (middles / np.maximum(counts, 1)[:, None])[planes]
    along, across = _tangents(normals)
    angle = np.arctan2((spokes * across[planes]).sum(axis=1), (spokes * along[planes]).sum(axis=1))
    return planes, around[np.lexsort((angle, planes))]
