"""Polyhedra with rounded edges: facets moved inwards by a radius, then dilated by a ball of that radius."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces


@dataclass(frozen=True, eq=False)
class RoundedPolyhedron:
    """Minkowski sum of a core and a ball; its flat parts lie in the planes of the original facets.

    ``core``: convex polyhedron. ``radius``: of the ball.
    """

    core: ConvexPolyhedron
    radius: float

    @cached_property
    def edges(self) -> list[tuple[int, int]]:
        """Of the core, each once, as vertex indices."""
        return edges_of(self.core)

    @property
    def volume(self) -> float:
        """Steiner's formula: V + A r + sum(l theta) r^2 / 2 + 4 pi r^3 / 3."""
        r = self.radius
        bent = float(edge_bends(self.core).sum())
        return self.core.volume + self.core.surface_area * r + bent * r * r / 2 + 4 * np.pi / 3 * r**3


def rounded(shape: ConvexPolyhedron, rounding: float) -> RoundedPolyhedron:
    """Round the edges of `shape` with a radius of `rounding` times the smallest offset of a facet.

    The radius is halved until no facet is lost.
    """
    planes = shape.half_spaces
    radius = rounding * float(planes.offsets.min())
    while True:
        core = _eroded(shape, radius)
        # A small facet between large ones vanishes as all move inwards; radius 0 always keeps it.
        if core.n_facets == shape.n_facets or radius < 1e-9 * float(planes.offsets.min()):
            return RoundedPolyhedron(core, radius)
        radius /= 2


def rounded_parts(shape: Polyhedron, rounding: float) -> list[tuple[RoundedPolyhedron, FloatArray]]:
    """The convex parts of a shape, rounded with one radius, each with its place, shape (3,).

    The union of rounded parts is the rounded union. The radius is the smallest that `rounded` gives a part.
    """
    if isinstance(shape, ConvexPolyhedron):
        return [(rounded(shape, rounding), np.zeros(3))]
    radius = min(rounded(part, rounding).radius for part in shape.parts)
    return [
        (RoundedPolyhedron(_eroded(part, radius), radius), place)
        for part, place in zip(shape.parts, shape.places, strict=True)
    ]


def _eroded(shape: ConvexPolyhedron, radius: float) -> ConvexPolyhedron:
    planes = shape.half_spaces
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(planes.normals, planes.offsets - radius))


def edges_of(shape: ConvexPolyhedron) -> list[tuple[int, int]]:
    """The edges between facets, each once, as vertex indices."""
    return list(_edges(shape))


def edge_bends(shape: ConvexPolyhedron) -> FloatArray:
    """Length of each edge times the angle between its facets' normals, shape (n_edges,)."""
    normals, vertices = shape.half_spaces.normals, shape.vertices
    bends = []
    for (first, second), (one, other) in _edges(shape).items():
        # Not arccos of the product, which loses half of the digits of small angles.
        angle = np.arctan2(
            np.linalg.norm(np.cross(normals[one], normals[other])), normals[one] @ normals[other]
        )
        bends.append(np.linalg.norm(vertices[first] - vertices[second]) * angle)
    return np.array(bends)


def _edges(shape: ConvexPolyhedron) -> dict[tuple[int, int], tuple[int, int]]:
    """For each edge (lower vertex first) its two facets."""
    sides: dict[tuple[int, int], list[int]] = {}
    for facet, corners in enumerate(shape.facets):
        for first, second in zip(corners, (*corners[1:], corners[0]), strict=True):
            sides.setdefault((min(first, second), max(first, second)), []).append(facet)
    return {edge: (facets[0], facets[-1]) for edge, facets in sorted(sides.items())}
