"""The lifting cylinder of section 2.6: contact parameters, cylinder, how many particles fill it. SI units."""

from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.errors import InputError

MICROMETRE = 1e-6


NOT_GIVEN = "not given in the paper"


def _number(default: float, label: str, minimum: float, maximum: float, decimals: int, source: str) -> Any:
    """A field that a form can edit; `source` says where the default comes from."""
    limits = {"minimum": minimum, "maximum": maximum, "decimals": decimals, "step": 10.0**-decimals}
    return field(default=default, metadata={"label": label, "tip": source, **limits})


@dataclass(frozen=True)
class ContactParameters:
    """Material and contact of particles and walls; Table 1 where the paper gives a number.

    Parameters
    ----------
    density
        kg/m3.
    young_modulus
        Pa.
    poisson_ratio, static_friction, dynamic_friction
        Dimensionless.
    surface_energy
        J/m2, for JKR.
    restitution
        Dimensionless; not given in the paper.
    wall_friction, plate_friction
        Of particles on the cylinder and on the plate below; not given in the paper.
    """

    density: float = _number(3075.0, "Density [kg/m³]", 100, 30000, 0, "Table 1")
    young_modulus: float = _number(30e9, "Young’s modulus [Pa]", 10000.0, 10000000000000.0, 0, "Table 1")
    poisson_ratio: float = _number(0.2, "Poisson’s ratio", 0, 0.49, 3, "Table 1")
    static_friction: float = _number(0.8, "Static friction", 0, 5, 3, "Table 1")
    dynamic_friction: float = _number(0.8, "Dynamic friction", 0, 5, 3, "Table 1")
    surface_energy: float = _number(0.010, "Surface energy [J/m²]", 0, 10, 4, "Table 1")
    restitution: float = _number(0.3, "Restitution", 0, 1, 3, NOT_GIVEN)
    wall_friction: float = _number(0.3, "Friction on the tube", 0, 5, 3, NOT_GIVEN)
    plate_friction: float = _number(0.8, "Friction on the plate", 0, 5, 3, NOT_GIVEN)

    def __post_init__(self) -> None:
        _check_positive(self, ("density", "young_modulus"))
        if not -1.0 < self.poisson_ratio < 0.5:
            raise InputError(f"Poisson's ratio must lie between -1 and 0.5, got {self.poisson_ratio}.")
        if not 0.0 <= self.restitution <= 1.0:
            raise InputError(f"The coefficient of restitution must lie in 0..1, got {self.restitution}.")
        for name in (
            "static_friction",
            "dynamic_friction",
            "surface_energy",
            "wall_friction",
            "plate_friction",
        ):
            if not getattr(self, name) >= 0.0:
                raise InputError(f"{name} must not be negative, got {getattr(self, name)}.")


@dataclass(frozen=True)
class LiftingCylinder:
    """The cylinder that is filled and lifted; Table 2 where the paper gives a number. Metres, kg, seconds.

    Parameters
    ----------
    diameter, height
        Of the cylinder.
    total_mass
        Of the particles; their number follows from it.
    lifting_speed, settling_time, resting_time
        m/s and s; not given in the paper.
    """

    diameter: float = _number(0.02, "Tube diameter [m]", 1e-05, 10, 5, "Table 2")
    height: float = _number(0.08, "Tube height [m]", 1e-05, 100, 5, "Table 2")
    total_mass: float = _number(0.015, "Mass of all particles [kg]", 1e-09, 1000000.0, 6, "Table 2")
    lifting_speed: float = _number(0.03, "Lifting speed [m/s]", 1e-05, 10, 5, NOT_GIVEN)
    settling_time: float = _number(1.0, "Settling time [s]", 0.0001, 10000.0, 4, NOT_GIVEN)
    resting_time: float = _number(1.0, "Resting time [s]", 0.0001, 10000.0, 4, NOT_GIVEN)

    def __post_init__(self) -> None:
        _check_positive(self, tuple(field.name for field in fields(self)))

    @property
    def duration(self) -> float:
        """Settle, lift the cylinder clear by its own height, come to rest: seconds."""
        return self.settling_time + self.height / self.lifting_speed + self.resting_time


FILL, PACKED = 1.375, 0.55
"""Fill height over diameter of the paper's cylinder (2.5 to 3 cm of 2 cm), and the solid share of it."""


def tube_for(cylinder: LiftingCylinder, solid_volume: float, narrowest: float) -> LiftingCylinder:
    """The cylinder made smaller for fewer particles: they fill it as high for its width as in the paper.

    Parameters
    ----------
    solid_volume
        Of all particles, in m3.
    narrowest
        Least diameter in metres: a few of the largest particles.
    """
    diameter = float((solid_volume / PACKED / (np.pi / 4 * FILL)) ** (1 / 3))
    diameter = min(cylinder.diameter, max(diameter, narrowest))
    share = diameter / cylinder.diameter
    return replace(cylinder, diameter=diameter, height=cylinder.height * share)


def mean_particle_mass(dataset: Dataset, density: float, coarse_graining_factor: float = 1.0) -> float:
    """Mean mass of a particle counted by number, in kg: density pi/6 f^3 <d^3>."""
    cubes = np.array([one.sizes.mean_cube() for one in dataset.representatives])
    mean_cube = float(dataset.class_weights("number") @ cubes)
    return density * np.pi / 6 * (coarse_graining_factor * MICROMETRE) ** 3 * mean_cube


def particle_count(
    dataset: Dataset, total_mass: float, density: float, coarse_graining_factor: float = 1.0
) -> float:
    """Particles in `total_mass` (kg); with the paper's sizes, density and factor 378,000 in 15 g."""
    return total_mass / mean_particle_mass(dataset, density, coarse_graining_factor)


def solid_fraction(mass: float, density: float, diameter: float, fill_height: float) -> float:
    """Share of a cylinder filled to `fill_height` that is solid."""
    return mass / density / (np.pi / 4 * diameter**2 * fill_height)


def _check_positive(settings: object, names: tuple[str, ...]) -> None:
    for name in names:
        value = getattr(settings, name)
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{name} must be positive, got {value}.")
