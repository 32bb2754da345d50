"""The particles before they fall: a loose column in the cylinder, every particle turned at random."""

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray

HEADROOM = 1.02
"""The particles' enclosing balls are so much larger at the start."""
TRIES = 24
"""Random seats that a particle chooses from."""
SIGHT = 600
"""Particles placed before that a new one can touch."""


def loose_column(prepared: PreparedCase) -> ParticleState:
    """Where a simulation begins; the same for the same case."""
    places, _ = start_places(
        enclosing_radii(prepared), prepared.case.test.diameter / 2, _generator(prepared, 0)
    )
    turns = Rotation.random(len(prepared), random_state=_generator(prepared, 1)).as_quat(scalar_first=True)
    return ParticleState(places, prepared.diameters, turns, prepared.class_index, 0.0, 0.0, "fill")


def enclosing_radii(prepared: PreparedCase) -> FloatArray:
    """Radius of each particle's enclosing ball about its centre in metres, shape (n,)."""
    if prepared.case.shapes == "spheres":
        return np.asarray(prepared.diameters / 2)
    furthest = np.array([np.linalg.norm(shape, axis=1).max() for shape in prepared.shapes])
    return np.asarray(furthest[prepared.class_index] * prepared.scales)


def start_places(
    reach: FloatArray, radius: float, generator: np.random.Generator
) -> tuple[FloatArray, float]:
    """Centres that keep the particles' enclosing balls apart; and the height of the highest ball's top.

    Each ball sinks straight down in the cylinder at the best of a few random places until it would touch
    another; so the column is loose, but not much taller than it need be.

    Parameters
    ----------
    reach
        Radius of each particle's enclosing ball, shape (n,).
    radius
        Of the cylinder.
    """
    wide = HEADROOM * reach
    places = np.empty((len(reach), 3))
    for k in range(len(reach)):
        room = max(radius - wide[k], 0.0)
        away, angle = room * np.sqrt(generator.random(TRIES)), generator.uniform(0.0, 2 * np.pi, TRIES)
        seats = np.column_stack([away * np.cos(angle), away * np.sin(angle)])
        near = slice(max(0, k - SIGHT), k)
        heights = _resting_heights(seats, wide[k], places[near], wide[near])
        best = int(heights.argmin())
        places[k] = *seats[best], heights[best]
    return places, float((places[:, 2] + wide).max())


def _resting_heights(seats: FloatArray, size: float, others: FloatArray, sizes: FloatArray) -> FloatArray:
    """Lowest height of a ball's centre at each seat, above the plate and on the other balls, shape (m,)."""
    reach = sizes + size
    aside = ((seats[:, None, :] - others[None, :, :2]) ** 2).sum(axis=2)
    lift = np.sqrt(np.maximum(reach**2 - aside, 0.0))
    touching = np.where(aside < reach**2, others[:, 2] + lift, size)
    return np.asarray(np.maximum(touching.max(axis=1, initial=size), size))


def _generator(prepared: PreparedCase, stream: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(prepared.case.seed, spawn_key=(2, stream)))
