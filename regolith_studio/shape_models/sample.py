"""What a model is fitted to: the coefficients of the particles of one sample, and their size and shape apart.

The shape is the logarithm of the radius divided by the equivalent radius.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isqrt

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees
from regolith_studio.harmonics.sphere_grid import expanded_volumes, sphere_grid
from regolith_studio.messages import N_, Message
from regolith_studio.shape_models.realizations import EXPONENTIAL_DEGREE, Scale

MIN_PARTICLES = 2
IDENTICAL = 1e-9
"""Spread of the coefficients, as a share of the mean radius, below which particles count as identical."""


@dataclass(frozen=True, eq=False)
class Sample(LockedRecord):
    """Radius functions of the particles of one sample, all expanded to the same degree.

    Parameters
    ----------
    coefficients
        Shape (n, (l_max + 1)^2), convention of :mod:`regolith_studio.harmonics.coefficients`.
    names
        One for each particle, as in its mesh.
    unit
        Length unit of the radii.

    Raises
    ------
    InputError
        If there are fewer than two particles, a coefficient is not finite, a mean radius is not
        positive, or all particles are the same.
    ValueError
        If shapes and names do not go together.
    """

    coefficients: FloatArray
    names: tuple[str, ...] = ()
    unit: str = "um"

    def __post_init__(self) -> None:
        rows = np.asarray(self.coefficients, dtype=np.float64)
        if rows.ndim != 2 or isqrt(rows.shape[1]) ** 2 != rows.shape[1] or not rows.shape[1]:
            raise ValueError(f"coefficients must have shape (n, (l_max + 1)^2), got {rows.shape}")
        names = tuple(self.names) or tuple(f"particle-{i + 1}" for i in range(len(rows)))
        if len(names) != len(rows):
            raise ValueError(f"{len(rows)} particles cannot have {len(names)} names")
        _check(rows, names)
        object.__setattr__(self, "coefficients", locked_floats(rows, (None, None), "coefficients"))
        object.__setattr__(self, "names", names)

    @classmethod
    def of(cls, particles: Sequence[ShCoefficients], names: Sequence[str] = (), unit: str = "um") -> "Sample":
        """From the coefficients of each particle.

        Raises InputError if they differ in l_max (:meth:`cut` of each makes them alike), or as the class
        itself.
        """
        degrees = sorted({particle.l_max for particle in particles})
        if len(degrees) > 1:
            counts = ", ".join(
                f"{sum(each.l_max == degree for each in particles)} with l_max = {degree}"
                for degree in degrees
            )
            raise InputError(
                f"The particles were expanded to different degrees ({counts}); cut all of them to "
                f"l_max = {degrees[0]} or fit them again."
            )
        if not particles:
            raise InputError(_too_few(0))
        return cls(np.stack([each.values for each in particles]), tuple(names), unit)

    def __len__(self) -> int:
        return len(self.coefficients)

    @property
    def l_max(self) -> int:
        """Degree of all expansions."""
        return isqrt(self.coefficients.shape[1]) - 1

    @cached_property
    def equivalent_radii(self) -> FloatArray:
        """Radius of the sphere with each particle's volume, shape (n,); exact by quadrature."""
        # r^3 has degree 3 l_max, which Gauss-Legendre quadrature of half that degree integrates exactly.
        grid = sphere_grid(3 * self.l_max // 2 + 1, self.l_max)
        volumes = expanded_volumes(self.coefficients, grid)
        return np.asarray(np.cbrt(3 * volumes / (4 * np.pi)))

    @cached_property
    def min_radii(self) -> FloatArray:
        """Smallest radius of each particle on a grid of twice the degree, shape (n,)."""
        grid = sphere_grid(2 * self.l_max + 1, self.l_max)
        return grid.lowest(self.coefficients)

    def particle(self, index: int) -> ShCoefficients:
        """The coefficients of one particle."""
        return ShCoefficients(self.coefficients[index])

    def truncated(self, l_max: int) -> "Sample":
        """All expansions cut at `l_max` (Eq. 4).

        Raises InputError if the sample was not expanded so far.
        """
        if not 0 <= l_max <= self.l_max:
            sentence = N_("The sample is expanded to l_max = {top}, so it has no l_max = {l_max}.")
            raise InputError(Message(sentence, top=self.l_max, l_max=l_max))
        if l_max == self.l_max:
            return self
        return Sample(self.coefficients[:, : (l_max + 1) ** 2], self.names, self.unit)

    def chosen(self, indices: ArrayLike) -> "Sample":
        """Some of the particles, by index."""
        picks = np.asarray(indices, dtype=np.int64)
        return Sample(self.coefficients[picks], tuple(self.names[i] for i in picks), self.unit)

    def star_shaped(self) -> "Sample":
        """Only the particles whose radius is positive everywhere, for models of its logarithm.

        Raises InputError if fewer than two are left.
        """
        keep = np.flatnonzero(self.min_radii > 0)
        if len(keep) == len(self):
            return self
        if len(keep) < MIN_PARTICLES:
            sentence = N_(
                "Only {count} of {total} particles have a positive radius everywhere at l_max = {degree}, "
                "and a model needs {least}: choose a lower l_max or fit with an ellipsoid."
            )
            values = {"count": len(keep), "total": len(self), "degree": self.l_max, "least": MIN_PARTICLES}
            raise InputError(Message(sentence, **values))
        return self.chosen(keep)

    def halves(self, seed: int) -> tuple[IntArray, IntArray]:
        """Indices of two random halves: to fit on, to evaluate on; determined by `seed` and the length."""
        order = np.random.default_rng(np.random.SeedSequence(seed)).permutation(len(self))
        return np.sort(order[: len(self) // 2]), np.sort(order[len(self) // 2 :])


def _check(rows: FloatArray, names: tuple[str, ...]) -> None:
    if len(rows) < MIN_PARTICLES:
        raise InputError(_too_few(len(rows)))
    broken = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if len(broken):
        sentence = N_(
            "{count} of {total} particles have coefficients that are not finite numbers, the first is "
            "{name}: leave them out or fit them again."
        )
        raise InputError(Message(sentence, count=len(broken), total=len(rows), name=repr(names[broken[0]])))
    flat = np.flatnonzero(~(rows[:, 0] > 0))
    if len(flat):
        sentence = N_(
            "{count} of {total} particles have a mean radius that is not positive, the first is {name}: "
            "leave them out."
        )
        raise InputError(Message(sentence, count=len(flat), total=len(rows), name=repr(names[flat[0]])))
    if np.ptp(rows, axis=0).max() <= IDENTICAL * rows[:, 0].mean():
        sentence = N_("All {count} particles are the same; a model needs at least two different ones.")
        raise InputError(Message(sentence, count=len(rows)))


def _too_few(count: int) -> Message:
    sentence = N_("A model needs at least {least} different particles, got {count}.")
    return Message(sentence, least=MIN_PARTICLES, count=count)


@dataclass(frozen=True, eq=False)
class LogShapes:
    """The particles of a sample, with size and shape apart.

    - ``coefficients``: of ln(r / r_eq), shape (n, (l_max + 1)^2).
    - ``equivalent_radii``: r_eq, shape (n,).
    - ``left_out``: particles of the sample whose radius is not positive everywhere.
    """

    coefficients: FloatArray
    equivalent_radii: FloatArray
    left_out: int

    @property
    def powers(self) -> FloatArray:
        """P_l = sum over m of the squared coefficients, shape (n, l_max + 1); P_0 is set to zero."""
        length = self.coefficients.shape[1]
        starts = np.arange(round(length**0.5)) ** 2
        sums = np.add.reduceat(self.coefficients**2, starts, axis=1)
        sums[:, 0] = 0.0
        return np.asarray(sums)


def log_shapes(sample: Sample) -> LogShapes:
    """Size and shape of the particles with a positive radius.

    Raises InputError if fewer than two particles have one.
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
    # A factor f of the radius adds ln f to ln r, and so sqrt(4 pi) ln f to c_00 alone.
    rows[:, 0] = 0.0
    present = np.log(3 * expanded_volumes(rows, grid, exponential=True) / (4 * np.pi)) / 3
    rows[:, 0] = np.sqrt(4 * np.pi) * (np.log(equivalent_radii) - present)
    return rows


def directed(powers: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Random coefficients with given power at each degree (n, l_max + 1), isotropic within a degree."""
    n, length = len(powers), powers.shape[1] ** 2
    # Vectors of normal numbers have uniform directions, whatever they are scaled to.
    rows = rng.standard_normal((n, length))
    starts = np.arange(powers.shape[1]) ** 2
    directed_powers = np.add.reduceat(rows**2, starts, axis=1)
    return np.asarray(rows * np.sqrt(powers / directed_powers)[:, degrees(length)])
