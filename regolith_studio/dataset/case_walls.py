"""Walls of the lifting-cylinder case as triangles: a plate, and a tube that is open at both ends."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh


def tube_mesh(diameter: float, height: float, sides: int = 96, thickness: float = 0.05) -> Mesh:
    """An upright closed solid tube standing on z = 0; a regular polygon of the same inner area inside.

    Parameters
    ----------
    diameter
        Inner.
    thickness
        Of the wall, as a share of the diameter.
    """
    angles = 2 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    inner = diameter / 2 * np.sqrt(2 * np.pi / sides / np.sin(2 * np.pi / sides))
    rings = [(inner, 0.0), (inner + thickness * diameter, 0.0)]
    rings = [*rings, *((radius, height) for radius, _ in reversed(rings))]
    vertices = np.vstack([np.column_stack([circle * r, np.full(sides, z)]) for r, z in rings])
    here, there = np.arange(sides), (np.arange(sides) + 1) % sides
    faces = []
    for ring in range(4):
        a, b = ring * sides, (ring + 1) % 4 * sides
        faces += [np.column_stack([a + here, b + here, b + there])]
        faces += [np.column_stack([a + here, b + there, a + there])]
    mesh = Mesh(vertices, np.vstack(faces))
    return mesh if mesh.volume > 0.0 else Mesh(vertices, np.vstack(faces)[:, ::-1])


def box_mesh(corners: FloatArray) -> Mesh:
    """An upright box between two opposite corners, shape (2, 3)."""
    middle, half = corners.mean(axis=0), np.ptp(corners, axis=0) / 2
    planes = HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.concatenate([half, half]))
    return ConvexPolyhedron.from_half_spaces(planes).mesh.moved(shift=middle)
