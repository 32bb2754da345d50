"""Unions of convex polyhedra: particles that are not convex, as DEM codes take them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.topology import Connectivity, merged_vertices

# Above the 2e-8 by which parts that touch overlap, and above what single precision (STL) tells apart.
DEGENERATE_EDGE = 1e-7
"""Edges of the union shorter than this share of its size are collapsed: parts that touch overlap by less."""


@dataclass(frozen=True, eq=False)
class ConvexCompound(LockedRecord):
    """The union of convex polyhedra that overlap or touch; volume, area and moments are those of the union.

    Facets are numbered through: those of the first part first.

    ``parts``: each about its own place. ``places``: origins of the parts' half-spaces, shape (k, 3).

    Raises ValueError if there is no part, or not one place for each.
    """

    parts: tuple[ConvexPolyhedron, ...]
    places: FloatArray

    def __post_init__(self) -> None:
        if not self.parts:
            raise ValueError("a compound needs at least one part")
        places = locked_floats(self.places, (len(self.parts), 3), "places")
        object.__setattr__(self, "places", places)

    @property
    def n_parts(self) -> int:
        """Number of convex parts."""
        return len(self.parts)

    @property
    def n_facets(self) -> int:
        """Facets of all parts."""
        return sum(part.n_facets for part in self.parts)

    @property
    def n_vertices(self) -> int:
        """Vertices of all parts."""
        return sum(part.n_vertices for part in self.parts)

    @property
    def n_triangles(self) -> int:
        """Triangles of all parts."""
        return sum(part.n_triangles for part in self.parts)

    @property
    def vertices(self) -> FloatArray:
        """Vertices of all parts in the frame of the compound, shape (n_vertices, 3)."""
        return np.concatenate([mesh.vertices for mesh in self.part_meshes])

    @property
    def facet_normals(self) -> FloatArray:
        """Outward unit normal of each facet, shape (n_facets, 3)."""
        return np.concatenate([part.half_spaces.normals for part in self.parts])

    @cached_property
    def part_planes(self) -> tuple[tuple[FloatArray, FloatArray], ...]:
        """Normals (n, 3) and offsets (n,) of the planes of each part, about the origin of the compound.

        All x of a part have <normal, x> <= offset; an offset is negative where the origin lies outside.
        """
        return tuple(
            (part.half_spaces.normals, part.half_spaces.offsets + part.half_spaces.normals @ place)
            for part, place in zip(self.parts, self.places, strict=True)
        )

    @cached_property
    def part_meshes(self) -> tuple[Mesh, ...]:
        """Surface of each part in the frame of the compound."""
        return tuple(
            part.mesh.moved(shift=place) for part, place in zip(self.parts, self.places, strict=True)
        )

    @cached_property
    def _union(self) -> tuple[Mesh, IntArray]:
        """Surface of the union, and the facet of each of its triangles."""
        first = np.cumsum([0, *(part.n_facets for part in self.parts)])
        facets = [part.triangle_facets + start for part, start in zip(self.parts, first, strict=False)]
        return _united(self.part_meshes, facets)

    @property
    def mesh(self) -> Mesh:
        """Surface of the union: a closed mesh of what is exposed of the facets (manifold3d).

        Raises GeometryError if the union cannot be made.
        """
        return self._union[0]

    @property
    def triangle_facets(self) -> IntArray:
        """Facet of each triangle of `mesh`."""
        return self._union[1]

    @cached_property
    def exposed_areas(self) -> FloatArray:
        """Area of the exposed part of each facet, shape (n_facets,)."""
        areas = np.bincount(self.triangle_facets, weights=self.mesh.face_areas, minlength=self.n_facets)
        return areas.astype(np.float64)

    @cached_property
    def facet_parts(self) -> IntArray:
        """Part of each facet, shape (n_facets,)."""
        return np.repeat(np.arange(self.n_parts), [part.n_facets for part in self.parts])

    @property
    def volume(self) -> float:
        """Volume of the union."""
        return self.mesh.volume

    @property
    def surface_area(self) -> float:
        """Area of what is exposed of the facets."""
        return self.mesh.surface_area

    @property
    def centroid(self) -> FloatArray:
        """Centre of mass of the union, shape (3,)."""
        return self.mesh.centroid

    @property
    def inertia(self) -> FloatArray:
        """Tensor of inertia of the union about its centroid at density 1, shape (3, 3)."""
        return self.mesh.inertia

    def moved(
        self, *, shift: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None, scale: float = 1.0
    ) -> "ConvexCompound":
        """The compound with every point x at ``scale * rotation @ (x + shift)``."""
        turn = np.eye(3) if rotation is None else np.asarray(rotation, dtype=np.float64)
        places = ((self.places + np.asarray(shift, dtype=np.float64)) * scale) @ turn.T
        return ConvexCompound(tuple(part.moved(rotation=turn, scale=scale) for part in self.parts), places)


def union_of_meshes(meshes: Sequence[Mesh]) -> Mesh:
    """Surface of the union of closed meshes that overlap or touch (manifold3d).

    Raises GeometryError if the union cannot be made.
    """
    first = np.cumsum([0, *(len(mesh.faces) for mesh in meshes)])
    return _united(meshes, [np.arange(low, high) for low, high in pairwise(first.tolist())])[0]


def _united(meshes: Sequence[Mesh], facets: Sequence[IntArray]) -> tuple[Mesh, IntArray]:
    """Surface of the union of meshes, and the facet of each of its triangles."""
    import manifold3d

    points = np.concatenate([mesh.vertices for mesh in meshes])
    low, high = points.min(axis=0), points.max(axis=0)
    # The tolerance of manifold3d grows with the largest coordinate: at size 1 about the origin it is least.
    middle, size = (low + high) / 2, float((high - low).max())
    solids = []
    for mesh, of_triangles in zip(meshes, facets, strict=True):
        corners = np.ascontiguousarray((mesh.vertices - middle) / size)
        faces = mesh.faces.astype(np.uint64)
        solids.append(
            manifold3d.Manifold(manifold3d.Mesh64(corners, faces, face_id=of_triangles.astype(np.uint64)))
        )
    union = manifold3d.Manifold.batch_boolean(solids, manifold3d.OpType.Add)
    if union.status() != manifold3d.Error.NoError or union.is_empty():
        raise GeometryError("The union of the convex parts cannot be made.")
    solid = union.to_mesh64()
    vertices, triangles, exposed = _without_degenerate_edges(
        np.asarray(solid.vert_properties)[:, :3],
        np.asarray(solid.tri_verts).astype(np.int64),
        np.asarray(solid.face_id).astype(np.int64),
    )
    return Mesh(vertices * size + middle, triangles), exposed


def _without_degenerate_edges(
    vertices: FloatArray, triangles: IntArray, facets: IntArray
) -> tuple[FloatArray, IntArray, IntArray]:
    """The same surface, with a size of 1, without edges that single precision cannot hold.

    Where parts touch, one stands out of the other by less than :data:`DEGENERATE_EDGE`; programs that merge
    corners while they read a mesh would find it open there.
    """
    merged, corners = merged_vertices(vertices, triangles, DEGENERATE_EDGE)
    proper = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    # Merging may also join sheets of the surface that only come close, which would leave edges of four faces.
    if proper.all() or not Connectivity.of(corners[proper], len(merged)).closed:
        return vertices, triangles, facets
    return merged, corners[proper], facets[proper]


Polyhedron = ConvexPolyhedron | ConvexCompound
"""What a particle is coarsened to."""
