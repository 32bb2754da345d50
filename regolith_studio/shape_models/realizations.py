"""Virtual particles: coefficients drawn from a model, their closed surfaces, and tests of positive radii."""

from dataclasses import dataclass, replace
from math import isqrt
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import (
    BoolArray,
    FloatArray,
    IntArray,
    LockedRecord,
    locked_floats,
    locked_integers,
)
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.sphere_grid import expanded_volumes, harmonics, sphere_grid
from regolith_studio.harmonics.synthesis import (
    DEFAULT_LEVEL,
    icosphere_edges,
    radii_along,
    radii_between,
    radii_on_icosphere,
    reconstruct,
)

Scale = Literal["radius", "log_radius"]
EXPONENTIAL_DEGREE = 3
"""Grids for the exponential of an expansion have this many times its degree."""
SAFE_SHARE = 0.15
"""Lowest radius on the coarse grid, as a share of the mean, above which the fine grid is not tested."""
CLOSE_LEVEL = 5
CLOSE_BLOCK = 1024
"""Vertices of which the harmonics are held at once."""
_PATCH = np.stack(np.meshgrid(*[np.linspace(-1, 1, 9)] * 3), axis=-1).reshape(-1, 3)
"""A cube of points: added to a unit vector they spread about its direction."""


@dataclass(frozen=True, eq=False)
class Realizations(LockedRecord):
    """Particles drawn from a fitted model.

    - ``coefficients``: shape (n, (l_max + 1)^2); of the radius or of its natural logarithm, as `scale` says.
    - ``scale``: ``radius`` or ``log_radius``.
    - ``model``: key of the model.
    - ``seed``: seed of the drawing; the same seed gives the same particles.
    - ``unit``: length unit of the radii.
    - ``rejected``: number of draws that were rejected because of a radius that is not positive or a size out
      of range.
    - ``parents``: index of the measured particle that each draw is based on, shape (n,); -1 for none.
    - ``components``: index of the mixture's component, shape (n,); 0 where there is only one.
    """

    coefficients: FloatArray
    scale: Scale
    model: str
    seed: int
    unit: str = "um"
    rejected: int = 0
    parents: IntArray | None = None
    components: IntArray | None = None

    def __post_init__(self) -> None:
        rows = locked_floats(self.coefficients, (None, None), "coefficients")
        object.__setattr__(self, "coefficients", rows)
        for name, filler in (("parents", -1), ("components", 0)):
            given = getattr(self, name)
            values = np.full(len(rows), filler) if given is None else given
            object.__setattr__(self, name, locked_integers(values, (len(rows),), name))

    def __len__(self) -> int:
        return len(self.coefficients)

    @property
    def l_max(self) -> int:
        """Degree of the expansions."""
        return isqrt(self.coefficients.shape[1]) - 1

    @property
    def acceptance(self) -> float:
        """Share of all draws that were accepted."""
        return len(self) / (len(self) + self.rejected) if len(self) else 1.0

    def equivalent_radii(self) -> FloatArray:
        """Radius of the sphere with each particle's volume, shape (n,)."""
        # r^3 has degree 3 l_max, which a grid of half of that integrates exactly; exp(3 ln r) has no highest
        # degree.
        factor = 1.5 if self.scale == "radius" else EXPONENTIAL_DEGREE
        grid = sphere_grid(int(factor * self.l_max) + 1, self.l_max)
        volumes = expanded_volumes(self.coefficients, grid, exponential=self.scale == "log_radius")
        return np.asarray(np.cbrt(3 * volumes / (4 * np.pi)))

    def chosen(self, indices: ArrayLike) -> "Realizations":
        """Some of the particles, by index."""
        picks = np.asarray(indices, dtype=np.int64)
        parents, components = np.asarray(self.parents)[picks], np.asarray(self.components)[picks]
        return replace(self, coefficients=self.coefficients[picks], parents=parents, components=components)

    def particle(self, index: int, l_max: int | None = None) -> ShCoefficients:
        """Coefficients of the radius of one particle, up to `l_max` (by default that of the draws).

        Where the draws are of the logarithm this cuts the expansion of its exponential, which may swing
        below zero where the logarithm itself cannot: :func:`virtual_mesh` is the safe way to a surface.
        """
        degree = self.l_max if l_max is None else l_max
        values = ShCoefficients(self.coefficients[index])
        if self.scale == "radius":
            return values.truncated(degree) if degree <= self.l_max else values.padded(degree)
        fine = EXPONENTIAL_DEGREE * max(degree, self.l_max) + 1
        inner, outer = sphere_grid(fine, self.l_max), sphere_grid(fine, degree)
        return ShCoefficients(outer.expanded(np.exp(inner.values(values.values[None])))[0])


def virtual_mesh(draws: Realizations, index: int, level: int = DEFAULT_LEVEL) -> Mesh:
    """Closed mesh of one drawn particle on ``icosphere(level)``, with the volume of its smooth surface.

    The vertices stand out a little, as in :func:`regolith_studio.harmonics.synthesis.reconstruct`.

    Raises GeometryError if the expansion has a negative radius, which no model of this package draws.
    """
    drawn = ShCoefficients(draws.coefficients[index])
    if draws.scale == "radius":
        return reconstruct(drawn, level=level)
    sphere = icosphere(level)
    radius, between = np.exp(radii_on_icosphere(drawn, level)), np.exp(radii_between(drawn, level))
    if not np.isfinite(radius).all():
        raise GeometryError("The logarithm of a radius is too large to be a size.")
    # In narrow pits vertices would pass through the origin, as in `reconstruct`.
    lifted = np.maximum(radius + icosphere_edges(level).chord_errors(radius, between), radius / 2)
    flat = Mesh(sphere.vertices * lifted[:, None], sphere.faces)
    grid = sphere_grid(EXPONENTIAL_DEGREE * draws.l_max + 1, draws.l_max)
    volume = expanded_volumes(drawn.values[None], grid, exponential=True)[0]
    return Mesh(flat.vertices * np.cbrt(volume / flat.volume), sphere.faces)


def positive_rows(coefficients: FloatArray) -> BoolArray:
    """Whether each radius function, rows of shape (n, (l_max + 1)^2), is positive, shape (n,).

    First tested on a Gauss-Legendre grid of twice the degree; those that come near zero are tested again on
    ``icosphere(5)`` (10,242 directions), and about the lowest of these on directions half a degree
    apart, which is as fine as any mesh that is written.
    """
    l_max = isqrt(coefficients.shape[1]) - 1
    grid = sphere_grid(2 * l_max + 1, l_max)
    lowest = grid.lowest(coefficients)
    positive: BoolArray = (lowest > 0) & (coefficients[:, 0] > 0)
    close = np.flatnonzero(positive & (lowest < SAFE_SHARE * coefficients[:, 0] / np.sqrt(4 * np.pi)))
    if len(close):
        values, vertices = _lowest_on_icosphere(coefficients[close])
        for row, value, vertex in zip(close, values, vertices, strict=True):
            positive[row] = value > 0 and _lowest_about(coefficients[row], int(vertex)) > 0
    return positive


def _lowest_on_icosphere(coefficients: FloatArray) -> tuple[FloatArray, IntArray]:
    """Lowest radius on the fine icosphere and its vertex, for each row; a block of vertices at a time."""
    vertices, l_max = icosphere(CLOSE_LEVEL).vertices, isqrt(coefficients.shape[1]) - 1
    lowest, vertex = np.full(len(coefficients), np.inf), np.zeros(len(coefficients), dtype=np.int64)
    for first in range(0, len(vertices), CLOSE_BLOCK):
        values = coefficients @ harmonics(vertices[first : first + CLOSE_BLOCK], l_max)
        places = values.argmin(axis=1)
        block = values[np.arange(len(values)), places]
        vertex[block < lowest] = first + places[block < lowest]
        lowest = np.minimum(lowest, block)
    return lowest, vertex


def _lowest_about(coefficients: FloatArray, vertex: int) -> float:
    """Lowest radius within two degrees of a vertex of the fine icosphere."""
    axis = icosphere(CLOSE_LEVEL).vertices[vertex]
    around = axis + np.deg2rad(2.0) * _PATCH
    directions = around / np.linalg.norm(around, axis=1, keepdims=True)
    return float(radii_along(ShCoefficients(coefficients), directions).min())


def acceptable(bounds: tuple[float, float] | None, coefficients: FloatArray) -> BoolArray:
    """Whether each radius function is positive, and its equivalent radius inside `bounds`, shape (n,)."""
    good = positive_rows(coefficients)
    if bounds is not None:
        l_max = isqrt(coefficients.shape[1]) - 1
        grid = sphere_grid(3 * l_max // 2 + 1, l_max)
        sizes = np.cbrt(3 * expanded_volumes(coefficients, grid) / (4 * np.pi))
        good &= (sizes >= bounds[0]) & (sizes <= bounds[1])
    return good
