"""Rigid clumps of spheres with the mass and inertia of the polyhedra."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.multisphere import (
    SphereFitErrors,
    fit_spheres,
    fit_spheres_within,
    sphere_fit_errors,
)
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces

BALL = (3 / (4 * np.pi)) ** (1 / 3)
"""Radius of a ball of unit volume."""
COMPANION = 0.1
"""Radius of the second sphere of a body that has only one, and its place along each axis, in radii of the
first."""


@dataclass(frozen=True, eq=False)
class ClumpShape:
    """One unit-volume shape as spheres.

    Parameters
    ----------
    spheres
        Rows x, y, z, r about the centroid, shape (k, 4).
    inertia
        Of the shape at density 1 about its centroid, shape (3, 3).
    errors
        Of the union of the spheres; mass, centre and inertia are the shape's all the same.
    """

    spheres: FloatArray
    inertia: FloatArray
    errors: SphereFitErrors


@dataclass(frozen=True, eq=False)
class Clumps:
    """All particles where a simulation begins; lengths in mean diameters, density 1.

    Parameters
    ----------
    shapes
        One a class.
    centres, turns
        Of the particles: shape (n, 3), and rotations.
    scales
        Factor from the unit-volume shape to each particle, shape (n,).
    class_index
        Shape (n,).
    """

    shapes: tuple[ClumpShape, ...]
    centres: FloatArray
    turns: Rotation
    scales: FloatArray
    class_index: IntArray

    def atoms(self, centres: FloatArray, turns: Rotation) -> tuple[IntArray, FloatArray, FloatArray]:
        """Body (m,), centre (m, 3) and radius (m,) of every sphere of particles placed like this."""
        counts = np.array([len(shape.spheres) for shape in self.shapes])[self.class_index]
        body = np.repeat(np.arange(len(counts)), counts)
        local = np.concatenate([self.shapes[kind].spheres for kind in self.class_index])
        scale = self.scales[body]
        places = centres[body] + turns[body].apply(local[:, :3] * scale[:, None])
        return body, places, local[:, 3] * scale

    def atoms_of_bodies(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """As :meth:`atoms`, where the simulation begins, with at least two spheres a body.

        LAMMPS knows no rigid body of one: a second one within, so small that nothing can touch it, keeps it
        company. Mass and inertia are given for the whole body and do not change.
        """
        body, places, radius = self.atoms(self.centres, self.turns)
        alone = np.bincount(body)[body] == 1
        return (
            np.concatenate([body, body[alone]]),
            np.concatenate([places, places[alone] + COMPANION * np.outer(radius[alone], [1.0, 1.0, 1.0])]),
            np.concatenate([radius, COMPANION * radius[alone]]),
        )

    def inertias(self) -> FloatArray:
        """Of every particle about its centre, along the axes of space, shape (n, 3, 3)."""
        own = np.array([shape.inertia for shape in self.shapes])[self.class_index]
        matrix = self.turns.as_matrix()
        return np.asarray(matrix @ own @ matrix.transpose(0, 2, 1) * (self.scales**5)[:, None, None])


def clumps_of(prepared: PreparedCase, count: int, max_error: float = 0.0) -> Clumps:
    """The particles of a case as clumps of at most `count` spheres, or as many as `max_error` needs."""
    length = prepared.mean_diameter
    column = loose_column(prepared)
    ball = prepared.case.shapes == "spheres"
    shapes = tuple(
        _ball() if ball else clump_shape(parts, count, max_error) for parts in prepared.part_vertices
    )
    return Clumps(
        shapes,
        column.points / length,
        Rotation.from_quat(column.orientations, scalar_first=True),
        prepared.scales / length,
        prepared.class_index,
    )


def clump_shape(parts: Sequence[FloatArray], count: int, max_error: float = 0.0) -> ClumpShape:
    """A unit-volume shape as spheres: `count`, or as many as a Jaccard distance above 0 needs.

    Parameters
    ----------
    parts
        Vertices of its convex parts, each of shape (k, 3); spheres fill their union.
    """
    places = np.array([part.mean(axis=0) if len(parts) > 1 else np.zeros(3) for part in parts])
    solids = tuple(_solid(part - place) for part, place in zip(parts, places, strict=True))
    solid: Polyhedron = ConvexCompound(solids, places) if len(parts) > 1 else solids[0]
    spheres = fit_spheres_within(solid, max_error) if max_error else fit_spheres(solid, count)
    return ClumpShape(spheres, np.asarray(solid.mesh.inertia), sphere_fit_errors(solid, spheres))


def _solid(vertices: FloatArray) -> ConvexPolyhedron:
    planes = np.unique(np.round(ConvexHull(vertices).equations, 10), axis=0)
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(planes[:, :3], -planes[:, 3]))


def _ball() -> ClumpShape:
    return ClumpShape(
        np.array([[0.0, 0.0, 0.0, BALL]]), np.eye(3) * 0.4 * BALL**2, SphereFitErrors(0.0, 0.0, 0.0, 0.0)
    )
