"""What several descriptors of one particle share, worked out once and only if asked."""

from collections.abc import Callable
from functools import cached_property

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mass_properties import ellipsoid_area, equal_ellipsoid, volume_and_area
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import OrientedBox, heuristic_box, minimum_volume_box
from regolith_studio.geometry.three_chords import length_width_thickness

FLAT = 1e-9
"""A mesh whose volume is below this share of its size cubed encloses nothing."""

BOX_METRICS: dict[str, Callable[[Mesh | ConvexPolyhedron], OrientedBox]] = {
    "exact": minimum_volume_box,
    "trimesh": heuristic_box,
}
"""Bounding boxes to take D_min and D_max from; ``trimesh`` only for comparison with the paper's program."""


class ShapeCache:
    """Lazily computed facts about one particle, read by the functions of the catalogue.

    Parameters
    ----------
    solid
        Closed and outward-oriented.
    box_metric
        A key of `BOX_METRICS`.

    Raises
    ------
    GeometryError
        If the solid has no faces, is flat or is inside out.
    """

    def __init__(self, solid: Mesh | ConvexPolyhedron, box_metric: str = "exact") -> None:
        if box_metric not in BOX_METRICS:
            raise ValueError(f"box_metric must be one of {sorted(BOX_METRICS)}, got {box_metric!r}")
        self._solid = solid
        self.box_metric = box_metric
        self.mesh = solid.mesh if isinstance(solid, ConvexPolyhedron) else solid
        self.volume, self.surface_area = volume_and_area(self.mesh.vertices, self.mesh.faces)
        _check_volume(self.mesh, self.volume)

    @cached_property
    def hull(self) -> Mesh:
        """Convex hull, triangulated."""
        return self.mesh if isinstance(self._solid, ConvexPolyhedron) else self.mesh.hull

    @cached_property
    def box(self) -> OrientedBox:
        """Oriented bounding box by `box_metric`."""
        return BOX_METRICS[self.box_metric](self._solid)

    @cached_property
    def three_chords(self) -> tuple[float, float, float]:
        """Length, width and thickness of the hull by chords."""
        return length_width_thickness(self.hull)

    @cached_property
    def principal_moments(self) -> FloatArray:
        """Principal moments of inertia at density 1, rising, shape (3,)."""
        moments = np.linalg.eigvalsh(self.mesh.normalised().inertia)
        return np.asarray(moments * self.volume ** (5 / 3))

    @cached_property
    def hull_ellipsoid_area(self) -> float:
        """Surface area of the ellipsoid with the volume and the ratios of second moments of the hull."""
        return ellipsoid_area(equal_ellipsoid(self.hull.normalised().inertia, self.hull.volume))


def _check_volume(mesh: Mesh, volume: float) -> None:
    if len(mesh.faces) < 4:
        raise GeometryError(f"The mesh has {len(mesh.faces)} faces; a solid needs at least 4.")
    low, high = mesh.bounds
    size = float((high - low).max())
    if not abs(volume) > FLAT * size**3:
        raise GeometryError(
            f"The mesh is flat: it encloses a volume of {abs(volume):.3g} at a size of {size:.3g}."
        )
    if volume < 0.0:
        raise GeometryError(f"The mesh is inside out: its signed volume is {volume:.3g}.")
