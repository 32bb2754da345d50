"""Initial state: a loose column of particles in the cylinder with random orientations."""

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray

HEADROOM = 1.02
"""Factor on the circumscribed spheres at the start."""
TRIALS = 24
"""Random candidate positions for a particle."""
NEIGHBOURS, LAYERS = 600, 5
"""Preceding particles that a new one is checked against: at least so many, and so many layers."""


def loose_column(prepared: PreparedCase) -> ParticleState:
    """Initial state of a simulation; equal cases give equal states."""
    places, _ = start_places(
        enclosing_radii(prepared), prepared.case.test.diameter / 2, _generator(prepared, 0)
    )
    turns = Rotation.random(len(prepared), random_state=_generator(prepared, 1)).as_quat(scalar_first=True)
    return ParticleState(places, prepared.diameters, turns, prepared.class_index, 0.0, 0.0, "fill")


def enclosing_radii(prepared: PreparedCase) -> FloatArray:
    """Radius of each particle's circumscribed sphere about its centre in metres, shape (n,)."""
    if prepared.case.shapes == "spheres":
        return np.asarray(prepared.diameters / 2)
    furthest = np.array([np.linalg.norm(shape, axis=1).max() for shape in prepared.shapes])
    return np.asarray(furthest[prepared.class_index] * prepared.scales)


def start_places(
    reach: FloatArray, radius: float, generator: np.random.Generator
) -> tuple[FloatArray, float]:
    """Centres with disjoint circumscribed spheres, and the maximum height of the spheres.

    Each sphere is dropped vertically until it touches another, at the lowest of a few random positions, so
    that the column is loose, but not much higher than necessary.

    Parameters
    ----------
    reach
        Radius of each particle's circumscribed sphere, shape (n,).
    radius
        Of the cylinder.
    """
    wide = HEADROOM * reach
    window = max(NEIGHBOURS, LAYERS * int((radius / np.median(wide)) ** 2))
    places = np.empty((len(reach), 3))
    for k in range(len(reach)):
        room = max(radius - wide[k], 0.0)
        away, angle = (
            room * np.sqrt(generator.random(TRIALS)),
            generator.uniform(0.0, 2 * np.pi, TRIALS),
        )
        positions = np.column_stack([away * np.cos(angle), away * np.sin(angle)])
        near = slice(max(0, k - window), k)
        heights = _resting_heights(positions, wide[k], places[near], wide[near])
        best = int(heights.argmin())
        places[k] = *positions[best], heights[best]
    return places, float((places[:, 2] + wide).max())


def _resting_heights(positions: FloatArray, size: float, others: FloatArray, sizes: FloatArray) -> FloatArray:
    """Minimum height of a sphere's centre at each position, on the plate or other spheres, shape (m,)."""
    reach = sizes + size
    aside = ((positions[:, None, :] - others[None, :, :2]) ** 2).sum(axis=2)
    lift = np.sqrt(np.maximum(reach**2 - aside, 0.0))
    touching = np.where(aside < reach**2, others[:, 2] + lift, size)
    return np.asarray(np.maximum(touching.max(axis=1, initial=size), size))


def _generator(prepared: PreparedCase, stream: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(prepared.case.seed, spawn_key=(2, stream)))
