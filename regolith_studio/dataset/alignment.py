"""Normalise a polyhedron: unit volume, centroid at the origin, principal axes along x, y, z."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Frame:
    """Pose of a unit-volume shape in its particle: x_shape = rotation @ (x_particle - centroid) / scale.

    Parameters
    ----------
    rotation
        Proper rotation, shape (3, 3); its rows are the shape's axes in the particle's frame.
    centroid
        Centre of mass of the polyhedron in the particle's frame, in micrometres, shape (3,).
    scale
        Cube root of the polyhedron's volume, in micrometres.
    """

    rotation: FloatArray
    centroid: FloatArray
    scale: float

    def __post_init__(self) -> None:
        rotation = locked_floats(self.rotation, (3, 3), "rotation")
        proper = np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-9) and np.linalg.det(rotation) > 0
        if not proper or not self.scale > 0.0:
            raise ValueError("a frame needs a proper rotation and a positive scale")
        object.__setattr__(self, "rotation", rotation)
        object.__setattr__(self, "centroid", locked_floats(self.centroid, (3,), "centroid"))

    def to_particle(self, points: FloatArray) -> FloatArray:
        """Points of the shape, (n, 3), in the particle's frame and micrometres."""
        return np.asarray(points @ self.rotation * self.scale + self.centroid)


def aligned(polyhedron: Polyhedron, centre: FloatArray | None = None) -> tuple[Polyhedron, Frame]:
    """The polyhedron at unit volume about its centroid, longest axis along x, shortest along z; and its pose.

    Parameters
    ----------
    polyhedron
        About an origin in its interior, in micrometres; of a compound the union is aligned.
    centre
        Position of that origin in the particle's frame; (0, 0, 0) if not given.

    Raises
    ------
    GeometryError
        If the polyhedron encloses no volume.
    """
    if not polyhedron.volume > 0.0:
        raise GeometryError("The polyhedron encloses no volume.")
    scale = polyhedron.volume ** (1 / 3)
    rotation = principal_axes(polyhedron.mesh)
    moved = polyhedron.moved(shift=-polyhedron.centroid, rotation=rotation, scale=1.0 / scale)
    origin = np.zeros(3) if centre is None else np.asarray(centre, dtype=np.float64)
    frame = Frame(rotation, origin + polyhedron.centroid, scale)
    if isinstance(moved, ConvexPolyhedron):
        return rebuilt(moved.half_spaces), frame
    return ConvexCompound(tuple(rebuilt(part.half_spaces) for part in moved.parts), moved.places), frame


def rebuilt(half_spaces: HalfSpaces) -> ConvexPolyhedron:
    """The polyhedron of half-spaces, with numbers that a second reconstruction does not change.

    Normals are normalised until they no longer change, and redundant half-spaces are removed, so that a
    shape read from a file is bit for bit the one that was written.
    """
    solid = ConvexPolyhedron.from_half_spaces(half_spaces)
    # Normalising a unit vector may change its last bit; two or three times and it does not any more.
    for _ in range(10):
        again = ConvexPolyhedron.from_half_spaces(
            HalfSpaces(solid.half_spaces.normals, solid.half_spaces.offsets)
        )
        if np.array_equal(again.half_spaces.normals, solid.half_spaces.normals):
            return again
        solid = again
    return solid


def principal_axes(mesh: Mesh) -> FloatArray:
    """Rows: axes of minimum, intermediate and maximum moment of inertia, right-handed, shape (3, 3).

    Sign: the third moment of the mass along the first two axes is positive; for a symmetric shape their
    largest component is.
    """
    _, columns = np.linalg.eigh(mesh.inertia)
    axes = columns.T
    for axis in axes[:2]:
        skew = _third_moment(mesh, axis)
        # Of a symmetric shape the moment is rounding, whose sign differs from one processor to the next.
        lean = skew if abs(skew) > 1e-9 * abs(mesh.volume) ** 2 else axis[np.abs(axis).argmax()]
        axis *= np.sign(lean)
    axes[2] = np.cross(axes[0], axes[1])
    return np.asarray(axes)


def _third_moment(mesh: Mesh, axis: FloatArray) -> float:
    """Integral of <x - centroid, axis>^3 over the solid: signed tetrahedra about the centroid."""
    corners = mesh.triangles - mesh.centroid
    six_volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    a, b, c = (corners @ axis).T
    homogeneous = (a + b + c) * (a * a + b * b + c * c) + a * b * c
    return float(six_volumes @ homogeneous / 120)
