"""Piles of known angle: cones cut out of a dense random packing of hard balls."""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

Floats = NDArray[np.float64]

SOLID_FRACTION = 0.58
N_TILE = 3000
SIDE = (N_TILE * np.pi / 6 / SOLID_FRACTION) ** (1 / 3)


@cache
def packed_tile(seed: int = 0) -> Floats:
    """Centres of balls of diameter 1 in a periodic cube of side `SIDE`, pushed apart."""
    centres = np.random.default_rng(seed).uniform(0.0, SIDE, (N_TILE, 3))
    for _ in range(400):
        pairs = cKDTree(centres, boxsize=SIDE).query_pairs(1.0, output_type="ndarray")
        apart = centres[pairs[:, 0]] - centres[pairs[:, 1]]
        apart -= SIDE * np.round(apart / SIDE)
        distance = np.linalg.norm(apart, axis=1)
        if distance.min() > 0.95:
            break
        push = 0.5 * ((1.0 - distance) / distance)[:, None] * apart
        step = np.zeros_like(centres)
        np.add.at(step, pairs[:, 0], push)
        np.add.at(step, pairs[:, 1], -push)
        centres = (centres + 0.6 * step) % SIDE
    return centres


def packing(half_width: float, height: float, seed: int) -> Floats:
    """Balls around the z axis, from a randomly shifted and turned tiling."""
    generator = np.random.default_rng(seed)
    reach = np.hypot(np.sqrt(2) * half_width, height)
    n = int(np.ceil(reach / SIDE)) + 1
    tiles = np.stack(np.meshgrid(*[np.arange(-n, n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) * SIDE
    shifted = packed_tile() + generator.uniform(0.0, SIDE, 3)
    centres = (tiles[:, None, :] + shifted[None, :, :]).reshape(-1, 3)
    centres = centres[np.linalg.norm(centres, axis=1) < reach + 1.0]
    centres = Rotation.random(random_state=int(generator.integers(2**31))).apply(centres)
    inside = (
        (np.abs(centres[:, :2]) < half_width).all(axis=1) & (centres[:, 2] > 0.0) & (centres[:, 2] < height)
    )
    return centres[inside]


def cone(angle: float, n_particles: int, seed: int, lean: float = 0.0, plateau: float = 1.0) -> Floats:
    """The `n_particles` balls of diameter 1 that touch or lie below a cone of this angle (degrees) on z = 0.

    Parameters
    ----------
    lean
        Displacement of the apex along x in units of the base radius, below 1.
    plateau
        Height at which the cone is cut off, as a share of its full height.
    """
    slope = np.tan(np.radians(angle))
    share = 1.0 - (1.0 - plateau) ** 3
    radius = 1.25 * (n_particles / (2 * SOLID_FRACTION * slope * share)) ** (1 / 3) + 2.0
    centres = packing(radius * 1.05, radius * slope * plateau, seed)
    centres = centres[centres[:, 2] > 0.5]
    needed = _radius_needed(centres, slope, lean)
    if plateau < 1.0:
        top = np.maximum(needed, (centres[:, 2] + 0.5) / (slope * plateau))
        needed = top
    return centres[np.argsort(needed)[:n_particles]]


def _radius_needed(centres: Floats, slope: float, lean: float) -> Floats:
    """Base radius of the smallest cone of the family that holds each ball (bisection where it leans)."""
    if lean == 0.0:
        away = np.hypot(centres[:, 0], centres[:, 1])
        return away + (centres[:, 2] + 0.5 * np.hypot(1.0, slope)) / slope
    low, high = np.zeros(len(centres)), np.full(len(centres), 1e3)
    for _ in range(40):
        middle = (low + high) / 2
        holds = _clearance(centres, middle, slope, lean) >= 0.5
        low, high = np.where(holds, low, middle), np.where(holds, middle, high)
    return high


def _clearance(centres: Floats, radius: Floats, slope: float, lean: float) -> Floats:
    """Least distance from a centre to the tangent planes of the cone with this base radius."""
    nearest = np.full(len(centres), np.inf)
    for azimuth in np.linspace(0.0, 2 * np.pi, 72, endpoint=False):
        outward = np.array([np.cos(azimuth), np.sin(azimuth)])
        run = radius * (1.0 - lean * outward[0])
        rise = radius * slope
        plan = radius - centres[:, :2] @ outward
        nearest = np.minimum(nearest, (plan * rise - centres[:, 2] * run) / np.hypot(run, rise))
    return nearest
