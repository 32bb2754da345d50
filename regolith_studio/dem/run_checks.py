"""Checks after a simulation, the same for all engines, and the height of the filling before the lift."""

from collections.abc import Sequence

import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray

MAX_OVERLAP = 0.02
"""Maximum accepted overlap at rest, in mean diameters."""
MAX_ENERGY_GAIN = 0.05
"""Maximum accepted rise of the energy between two samples, in m g d per particle: rounding of the solver."""


def check_run(
    heights: FloatArray,
    overlaps: FloatArray,
    *,
    energy_gain: float,
    kinetic_energy: float,
    at_rest: bool,
    filling: tuple[float, float],
    problems: Sequence[str] = (),
) -> RunChecks:
    """Results of the checks, with a sentence for each check that failed.

    Parameters
    ----------
    heights
        Of the particles' centres above the plate in mean diameters, shape (n,).
    overlaps
        Depths at rest in mean diameters, shape (m,).
    filling
        Height in metres and solid fraction before the lift.
    problems
        Sentences of the engine, which come first.
    """
    kept, said = int(np.count_nonzero(heights > -1.0)), list(problems)
    largest = float(overlaps.max(initial=0.0))
    if kept < len(heights):
        said.append(f"{len(heights) - kept} of {len(heights)} particles fell through the plate.")
    if largest > MAX_OVERLAP:
        said.append(f"Particles overlap by up to {100 * largest:.1f} % of the mean diameter.")
    if energy_gain > MAX_ENERGY_GAIN:
        said.append(f"The energy rose by {energy_gain:.2g} m g d a particle out of nothing.")
    if not at_rest:
        said.append("The heap was still moving at the end.")
    return RunChecks(
        particles_in=len(heights),
        particles_out=kept,
        mean_overlap=float(overlaps.mean()) if len(overlaps) else 0.0,
        max_overlap=largest,
        energy_gain=energy_gain,
        kinetic_energy=kinetic_energy,
        at_rest=at_rest,
        fill_height=filling[0],
        solid_fraction=filling[1],
        problems=tuple(said),
    )


def measure_filling(prepared: PreparedCase, particles: ParticleState) -> tuple[float, float]:
    """Height of a filling in metres, and its solid fraction."""
    height = float(np.quantile(particles.points[:, 2] + particles.diameters / 2, 0.98))
    volume = prepared.mass / prepared.case.contact.density
    return height, volume / (prepared.case.test.area * height)
