"""Size and shape of particles apart: the logarithm of the radius divided by the equivalent radius."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.harmonics.sphere_grid import expanded_volumes, sphere_grid
from regolith_studio.shape_models.realizations import EXPONENTIAL_DEGREE, Scale
from regolith_studio.shape_models.sample import Sample


@dataclass(frozen=True, eq=False)
class LogShapes:
    """The particles of a sample, with size and shape apart.

    Parameters
    ----------
    coefficients
        Of ln(r / r_eq), shape (n, (l_max + 1)^2).
    equivalent_radii
        r_eq, shape (n,).
    left_out
        Particles of the sample whose radius is not positive everywhere.
    """

    coefficients: FloatArray
    equivalent_radii: FloatArray
    left_out: int

    @property
    def powers(self) -> FloatArray:
        """P_l = sum over m of the squared coefficients, shape (n, l_max + 1); P_0 is set to zero."""
        length = self.coefficients.shape[1]
        starts = np.arange(round(length**0.5)) ** 2
        found = np.add.reduceat(self.coefficients**2, starts, axis=1)
        found[:, 0] = 0.0
        return np.asarray(found)


def log_shapes(sample: Sample) -> LogShapes:
    """Size and shape of the particles with a positive radius.

    Raises
    ------
    InputError
        If fewer than two particles have one.
    """
    usable = sample.star_shaped()
    l_max = usable.l_max
    grid = sphere_grid(EXPONENTIAL_DEGREE * l_max + 1, l_max)
    rows = np.empty_like(usable.coefficients)
    for block, radii in grid.blocks(usable.coefficients):
        sizes = usable.equivalent_radii[block, None]
        # The radius is positive where it was tested; on this finer grid it may still dip below zero.
        rows[block] = grid.expanded(np.log(np.maximum(radii, 1e-3 * sizes) / sizes))
    return LogShapes(rows, usable.equivalent_radii, len(sample) - len(usable))


def sized(shapes: FloatArray, equivalent_radii: FloatArray, scale: Scale = "log_radius") -> FloatArray:
    """The shapes (coefficients of r or of ln r, any size) so scaled that they have these radii exactly."""
    l_max = round(shapes.shape[1] ** 0.5) - 1
    if scale == "radius":
        grid = sphere_grid(3 * l_max // 2 + 1, l_max)
        present = np.cbrt(3 * expanded_volumes(shapes, grid) / (4 * np.pi))
        return np.asarray(shapes * (equivalent_radii / present)[:, None])
    grid = sphere_grid(EXPONENTIAL_DEGREE * l_max + 1, l_max)
    rows = shapes.copy()
    rows[:, 0] = 0.0
    present = np.log(3 * expanded_volumes(rows, grid, exponential=True) / (4 * np.pi)) / 3
    rows[:, 0] = np.sqrt(4 * np.pi) * (np.log(equivalent_radii) - present)
    return rows


def directed(powers: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Random coefficients with given power at each degree (n, l_max + 1), isotropic within a degree."""
    n, length = len(powers), powers.shape[1] ** 2
    rows = rng.standard_normal((n, length))
    starts = np.arange(powers.shape[1]) ** 2
    found = np.add.reduceat(rows**2, starts, axis=1)
    return np.asarray(rows * np.sqrt(powers / found)[:, degrees(length)])
