"""Meshes, half-spaces and convex polyhedra: values that never change."""

from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

__all__ = ["ConvexPolyhedron", "HalfSpaces", "Mesh"]
