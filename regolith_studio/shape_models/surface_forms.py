"""Measured surfaces apart from their forms, on coarse meshes: quick to turn, to stretch and to compare.

Each surface is mapped linearly to its sphere of inertia. Turned there and stretched to the form of another
particle it is a new body, whose sphericity follows from the area of the stretched mesh. The form along a
principal axis is the geometric mean of the extent and of the axis of the ellipsoid of inertia: of real grains
the aspect ratio of the minimum-volume box lies half-way between those of the two.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.legendre import harmonics
from regolith_studio.harmonics.sphere_grid import enclosed_volumes, sphere_grid
from regolith_studio.shape_models.convex_hull import hull_grid
from regolith_studio.shape_models.inertia_ellipsoid import PrincipalAxes
from regolith_studio.shape_models.shape_features import log_share

Floats = NDArray[np.float32]

COARSE, FINE = 3, 4
"""Levels of the icospheres: of surfaces that are tried, and of those whose sphericity is measured."""
MIN_HULL_DEGREE = 13
_MIN_RADIUS = 1e-3
_BATCH = 250


@dataclass(frozen=True, eq=False)
class SurfaceForms:
    """Surfaces of n particles on their spheres of inertia, and the forms that they had.

    Parameters
    ----------
    vertices
        On the sphere of inertia, in the frame of the principal axes, shape (n, 642, 3).
    to_sphere
        Linear maps of the particles there, shape (n, 3, 3).
    from_frame
        Principal axes as columns, shape (n, 3, 3): maps back from the frame of the axes.
    forms
        Along the principal axes, with a product of one, shape (n, 3).
    shares
        ln(s / (1 - s)) of the sphericity and of the share of the hull, shape (n, 2).
    area_factors
        Sphericity times the area of a mesh of unit volume, shape (n,): what the coarse mesh does not see of
        the surface stays the same when it is stretched.
    """

    vertices: Floats
    to_sphere: FloatArray
    from_frame: FloatArray
    forms: FloatArray
    shares: FloatArray
    area_factors: FloatArray

    @classmethod
    def of(cls, rows: FloatArray, found: PrincipalAxes) -> "SurfaceForms":
        """Of radius functions (n, (l_max + 1)^2) with these principal axes."""
        lengths = np.exp(found.log_ratios)
        radii = rows @ harmonics(icosphere(COARSE).vertices, round(rows.shape[1] ** 0.5) - 1)
        points = (radii[:, :, None] * icosphere(COARSE).vertices) @ found.axes
        shares = sphericity_and_convexity(rows)
        return cls(
            (points / lengths[:, None, :]).astype(np.float32),
            np.swapaxes(found.axes, 1, 2) / lengths[:, :, None],
            found.axes,
            _unit_product(np.sqrt(extents(points) * lengths)),
            shares,
            areas(points) / (1 + np.exp(-shares[:, 0])),
        )

    def stretched(
        self, picks: IntArray, turns: FloatArray, targets: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Surfaces turned on the sphere of inertia and stretched along the axes to the forms of others.

        Parameters
        ----------
        picks, targets
            Whose surfaces and whose forms, shapes (k,).
        turns
            Rotations, shape (k, 3, 3).

        Returns
        -------
        Linear maps of determinant one (k, 3, 3), and ln(s / (1 - s)) of the sphericities (k,).
        """
        turned = self.vertices[picks] @ np.swapaxes(turns, 1, 2).astype(np.float32)
        factors = _unit_product(self.forms[targets] / np.sqrt(extents(turned)))
        turned *= factors[:, None, :].astype(np.float32)
        return factors[:, :, None] * turns, log_share(self.area_factors[picks] / areas(turned))


def areas(vertices: FloatArray | Floats) -> FloatArray:
    """Areas (n,) of meshes with these vertices (n, v, 3) and the triangles of the icosphere with so many."""
    level = {len(icosphere(each).vertices): each for each in (COARSE, FINE)}[vertices.shape[1]]
    found = np.empty(len(vertices))
    _fill_areas(np.ascontiguousarray(vertices, dtype=np.float32), icosphere(level).faces, found)
    return found


@kernel
def _fill_areas(vertices: Floats, faces: IntArray, found: FloatArray) -> None:
    """Fill `found`, shape (n,), with the areas of the triangles `faces` (f, 3) of each row of `vertices`."""
    for n in range(len(vertices)):
        points, total = vertices[n], 0.0
        for f in range(len(faces)):
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
            vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
            x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            total += np.sqrt(x * x + y * y + z * z)
        found[n] = 0.5 * total


def extents(vertices: FloatArray | Floats) -> FloatArray:
    """Extents along the axes of meshes with these vertices (n, v, 3), shape (n, 3)."""
    found = np.empty((len(vertices), 3))
    _fill_extents(np.ascontiguousarray(vertices, dtype=np.float32), found)
    return found


@kernel
def _fill_extents(vertices: Floats, found: FloatArray) -> None:
    """Fill `found`, shape (n, 3), with the extents of each row of `vertices`, shape (n, v, 3)."""
    for n in range(len(vertices)):
        for k in range(3):
            low = high = vertices[n, 0, k]
            for v in range(vertices.shape[1]):
                value = vertices[n, v, k]
                low, high = min(low, value), max(high, value)
            found[n, k] = high - low


def sphericity_and_convexity(rows: FloatArray) -> FloatArray:
    """ln(s / (1 - s)) of the sphericity and of the share of the hull that is filled, of radius functions
    (n, (l_max + 1)^2), shape (n, 2)."""
    return np.concatenate([_of_batch(rows[i : i + _BATCH]) for i in range(0, len(rows), _BATCH)])


def _unit_product(values: FloatArray) -> FloatArray:
    """Rows (n, 3) divided by the cube root of their product."""
    return np.asarray(values / np.cbrt(values.prod(axis=1, keepdims=True)))


def _of_batch(rows: FloatArray) -> FloatArray:
    l_max = round(rows.shape[1] ** 0.5) - 1
    scaled = rows / (rows[:, :1] / np.sqrt(4 * np.pi))
    grid = sphere_grid(3 * l_max // 2 + 1, l_max)
    volumes = enclosed_volumes(grid.values(scaled), grid)
    sphere = icosphere(FINE)
    surface = (scaled @ harmonics(sphere.vertices, l_max))[:, :, None] * sphere.vertices
    sphericities = np.pi ** (1 / 3) * (6 * volumes) ** (2 / 3) / areas(surface)
    hulls = hull_grid(max(MIN_HULL_DEGREE, l_max), l_max)
    convexities = hulls.convexities(np.maximum(hulls.grid.values(scaled), _MIN_RADIUS))
    return np.column_stack([log_share(sphericities), log_share(convexities)])
