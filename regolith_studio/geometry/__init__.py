"""Meshes, half-spaces, convex polyhedra and their unions: values that never change."""

from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

__all__ = ["ConvexCompound", "ConvexPolyhedron", "HalfSpaces", "Mesh"]
