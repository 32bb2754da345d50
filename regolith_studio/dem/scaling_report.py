"""The scaling of a case: particle size, coarse graining, Bond numbers, time steps at full stiffness."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.dataset.parameters import PAPER_COARSE_GRAINING, PAPER_FILL_HEIGHT
from regolith_studio.dem.angle_of_repose import COARSE_PILE, RELIABLE_N
from regolith_studio.dem.case import PreparedCase
from regolith_studio.messages import N_, Message, Number


@dataclass(frozen=True)
class ScalingReport:
    """Dimensions and dimensionless numbers of a prepared case. SI units.

    Parameters
    ----------
    mean_diameter, coarse_graining
        Of the simulated particles, and the ratio of their size to the dataset's.
    diameters_across
        Diameter of the cylinder in mean diameters; should be 20 or more.
    fill_height
        Expected, from the mass and a solid fraction of 55 %.
    bond_number
        Pull-off force of Johnson, Kendall and Roberts over weight, for two mean particles: of the
        particles of the dataset, of the simulated particles with the given surface energy, and as simulated.
    full_stiffness_steps
        Steps a simulated second of a code that resolves the contacts at the given Young's modulus
        (a fifth of Rayleigh's time of the smallest particle).
    sentences
        Sentences for the user.
    """

    mean_diameter: float
    coarse_graining: float
    diameters_across: float
    fill_height: float
    bond_number: tuple[float, float, float]
    full_stiffness_steps: float
    sentences: tuple[str, ...]


def pull_off_force(surface_energy: float, diameter: float) -> float:
    """3/2 pi w R* for two equal spheres (R* = d/4), in N."""
    return 1.5 * np.pi * surface_energy * diameter / 4


def bond_number(surface_energy: float, diameter: float, density: float, gravity: float) -> float:
    """Ratio of the pull-off force of two equal spheres and the weight of one."""
    return pull_off_force(surface_energy, diameter) / (density * np.pi / 6 * diameter**3 * gravity)


def rayleigh_time(diameter: float, density: float, youngs_modulus: float, poissons_ratio: float) -> float:
    """Rayleigh time of a sphere, in s."""
    shear = youngs_modulus / (2 * (1 + poissons_ratio))
    return float(np.pi * diameter / 2 * np.sqrt(density / shear) / (0.1631 * poissons_ratio + 0.8766))


def scaling_report(prepared: PreparedCase) -> ScalingReport:
    """The report of a prepared case."""
    test, contact = prepared.case.test, prepared.case.contact
    mean, factor = prepared.mean_diameter, prepared.coarse_graining
    real = mean / factor

    def bond(energy: float, diameter: float) -> float:
        return bond_number(energy, diameter, contact.density, test.gravity)

    bonds = (
        bond(contact.surface_energy, real),
        bond(contact.surface_energy, mean),
        bond(prepared.surface_energy, mean),
    )
    smallest = float(prepared.diameters.min())
    rayleigh = rayleigh_time(smallest, contact.density, contact.youngs_modulus, contact.poissons_ratio)
    return ScalingReport(
        mean_diameter=mean,
        coarse_graining=factor,
        diameters_across=test.diameter / mean,
        fill_height=prepared.fill_height,
        bond_number=bonds,
        full_stiffness_steps=1.0 / (0.2 * rayleigh),
        sentences=tuple(_sentences(prepared, bonds)),
    )


def _sentences(prepared: PreparedCase, bonds: tuple[float, float, float]) -> list[str]:
    test, mean, factor = prepared.case.test, prepared.mean_diameter, prepared.coarse_graining
    scale = Message(
        N_(
            "{count} particles of {size} mm represent {mass} g: {factor} times the size of the dataset's "
            "(the paper: {paper})."
        ),
        count=Number(len(prepared), ","),
        size=Number(1e3 * mean, ".2g"),
        mass=Number(1e3 * test.mass, ".3g"),
        factor=Number(factor, ".0f"),
        paper=Number(PAPER_COARSE_GRAINING, ".0f"),
    )
    sentences: list[str] = [scale]
    across = test.diameter / mean
    if across < 20:
        narrow = N_("The cylinder is only {across} particles wide; walls and single grains matter.")
        sentences.append(Message(narrow, across=Number(across, ".1f")))
    if len(prepared) < RELIABLE_N:
        sentences.append(COARSE_PILE)
    low, high = PAPER_FILL_HEIGHT
    if not 0.9 * low <= prepared.fill_height <= 1.1 * high:
        filled = N_("The filling will be about {height} cm high (the paper: 2.5 to 3 cm).")
        sentences.append(Message(filled, height=Number(100 * prepared.fill_height, ".2g")))
    real, given, simulated = bonds
    if prepared.case.contact.surface_energy > 0.0:
        sentences.append(
            Message(
                N_(
                    "Cohesion over weight is {real} for the dataset's particles and {given} for the "
                    "simulated ones at the given surface energy; this run has {simulated}."
                ),
                real=_plain(real),
                given=_plain(given),
                simulated=_plain(simulated),
            )
        )
    if prepared.case.contact.static_friction != prepared.case.contact.dynamic_friction:
        one = N_("The constraint solver has one coefficient of friction; it takes the static one.")
        sentences.append(Message(one))
    return sentences


def _plain(number: float) -> Number:
    """Two significant digits without exponents below 1000."""
    return Number(number, ".2g" if number < 100 else ".0f")
