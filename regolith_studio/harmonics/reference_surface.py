"""Reference surfaces, by whose radius that of the particle is divided before it is expanded.

About a sphere, a flat or elongated particle needs high degrees for its overall form alone, and a short series
oscillates. Divided by the radius of the best-fit ellipsoid, the function is nearly constant and oscillates
less at the same l_max.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """An ellipsoid about the star point.

    Parameters
    ----------
    axes
        Unit axes as rows, shape (3, 3).
    semi_axes
        Half lengths along them, shape (3,), in the unit of the particle.
    """

    axes: FloatArray
    semi_axes: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "axes", locked_floats(self.axes, (3, 3), "axes"))
        object.__setattr__(self, "semi_axes", locked_floats(self.semi_axes, (3,), "semi_axes"))
        if not (self.semi_axes > 0).all():
            raise ValueError(f"semi_axes must be positive, got {self.semi_axes}")

    def __reduce__(self) -> tuple[Callable[..., "Ellipsoid"], tuple[ArrayLike, ArrayLike]]:
        return Ellipsoid, (self.axes, self.semi_axes)

    def radii(self, directions: FloatArray) -> FloatArray:
        """Radius along unit `directions` (n, 3), shape (n,)."""
        return np.asarray(np.linalg.norm(directions @ self.axes.T / self.semi_axes, axis=1) ** -1)


def best_fit_ellipsoid(mesh: Mesh) -> Ellipsoid:
    """The ellipsoid with the volume and the principal moments of inertia of a closed mesh."""
    moments, axes = np.linalg.eigh(mesh.inertia)
    second = moments.sum() / 2 - moments
    lengths = np.sqrt(np.maximum(second, 1e-12 * second.max()))
    volume = 4 / 3 * np.pi * lengths.prod()
    return Ellipsoid(axes.T, lengths * np.cbrt(mesh.volume / volume))


REFERENCES: dict[str, Callable[[Mesh], Ellipsoid | None]] = {
    "sphere": lambda _mesh: None,
    "ellipsoid": best_fit_ellipsoid,
}
"""Reference surface of a mesh, by key; ``None`` is the unit sphere: no division."""
