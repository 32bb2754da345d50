"""Checks after a simulation, the same for all engines: overlaps, energy, rest; height of the filling."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_, Message, Number

DEEP_OVERLAP, MAX_DEEP_CONTACTS = 0.02, 0.01
"""Overlap in mean diameters above which a contact is deep, and maximum accepted share of these at rest.
The share does not depend on the number of particles; docs/repose.md says why these limits."""
MAX_OVERLAP = 0.1
"""Maximum accepted overlap of any two particles at rest, in mean diameters: half the radius of the inscribed
ball of a flat particle. What is deeper has begun to pass through another."""
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
    lowest: FloatArray,
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
    lowest
        Height of each particle's lowest point above the plate in mean diameters, shape (n,).
    problems
        Sentences of the engine, which come first.
    """
    kept, sentences = int(np.count_nonzero(heights > -1.0)), list(problems)
    if kept < len(heights):
        template = N_("{lost} of {count} particles fell through the plate.")
        sentences.append(Message(template, lost=len(heights) - kept, count=len(heights)))
    largest, deep = float(overlaps.max(initial=0.0)), _deep_share(overlaps)
    sentences += _overlap_problems(largest, deep)
    if energy_gain > MAX_ENERGY_GAIN:
        template = N_("The energy rose by {gain} m g d per particle without external work.")
        sentences.append(Message(template, gain=Number(energy_gain, ".2g")))
    if not at_rest:
        sentences.append(Message(N_("The heap was still moving at the end.")))
    return RunChecks(
        particles_in=len(heights),
        particles_out=kept,
        mean_overlap=float(overlaps.mean()) if len(overlaps) else 0.0,
        max_overlap=largest,
        deep_contacts=deep,
        energy_gain=energy_gain,
        kinetic_energy=kinetic_energy,
        at_rest=at_rest,
        fill_height=filling[0],
        solid_fraction=filling[1],
        plate_depth=float(np.max(-lowest[heights > -1.0], initial=0.0)),
        problems=tuple(sentences),
    )


def _deep_share(overlaps: FloatArray) -> float:
    """Share of the contacts that overlap which are deeper than :data:`DEEP_OVERLAP`."""
    touching = np.count_nonzero(overlaps > 0.0)
    return float(np.count_nonzero(overlaps > DEEP_OVERLAP) / touching) if touching else 0.0


def _overlap_problems(largest: float, deep: float) -> list[str]:
    """Sentences on overlaps that are too many or too deep."""
    sentences: list[str] = []
    if deep > MAX_DEEP_CONTACTS:
        template = N_("{share} % of the contacts are deeper than {depth} % of the mean diameter.")
        depth = Number(100 * DEEP_OVERLAP, "g")
        sentences.append(Message(template, share=Number(100 * deep, ".1f"), depth=depth))
    if largest > MAX_OVERLAP:
        template = N_("Particles overlap by up to {overlap} % of the mean diameter.")
        sentences.append(Message(template, overlap=Number(100 * largest, ".1f")))
    return sentences


def measure_filling(prepared: PreparedCase, particles: ParticleState) -> tuple[float, float]:
    """Height of a filling in metres, and its solid fraction."""
    height = float(np.quantile(particles.points[:, 2] + particles.diameters / 2, 0.98))
    volume = prepared.mass / prepared.case.contact.density
    return height, volume / (prepared.case.test.area * height)


def lowest_corners(prepared: PreparedCase, particles: ParticleState) -> FloatArray:
    """Height of the lowest corner of every particle above the plate, in metres, shape (n,)."""
    downwards = Rotation.from_quat(particles.orientations, scalar_first=True).as_matrix()[:, 2]
    lowest = [
        (prepared.shapes[kind] @ way).min() for kind, way in zip(prepared.class_index, downwards, strict=True)
    ]
    return np.asarray(particles.points[:, 2] + prepared.scales * np.array(lowest))
