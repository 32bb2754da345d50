"""Heaps of known angle, cut out of packings of balls that are made here; lengths in mean diameters."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

SOLID_FRACTION = 0.58
N_TILE = 3000


@dataclass(frozen=True)
class HeapKind:
    """How a heap departs from a clean cone of equal balls.

    Parameters
    ----------
    size_spread
        Standard deviation of the log of the diameters.
    roughness
        Standard deviation of the surface about the cone, ball by ball.
    loose
        Share of balls that lie on the plate around the toe, beside those of the heap.
    tip
        Radius within which a paraboloid that meets the cone without a kink replaces the tip, as a share of
        the radius of the base.
    blunt
        a of the surface tan(angle) (R - sqrt(r^2 + a^2)), as a share of the radius of the base.
    """

    size_spread: float = 0.0
    roughness: float = 0.0
    loose: float = 0.0
    tip: float = 0.0
    blunt: float = 0.0


KINDS = {
    "equal, clean": HeapKind(),
    "equal, noisy": HeapKind(roughness=0.3),
    "equal, noise and loose grains": HeapKind(roughness=0.3, loose=0.05),
    "sizes, sigma .3": HeapKind(size_spread=0.3),
    "sizes, noise and loose grains": HeapKind(size_spread=0.3, roughness=0.3, loose=0.05),
    "tip rounded within .2 R": HeapKind(tip=0.2),
    "hyperbolic tip, a = .08 R": HeapKind(blunt=0.08),
}


@cache
def tile(size_spread: float, seed: int) -> tuple[Array, Array, float]:
    """Centres (n, 3) and diameters (n,) of balls in a periodic cube, pushed apart, and its side."""
    generator = np.random.default_rng(seed)
    diameters = np.exp(size_spread * generator.standard_normal(N_TILE))
    diameters /= diameters.mean()
    side = float((np.pi / 6 * (diameters**3).sum() / SOLID_FRACTION) ** (1 / 3))
    centres = generator.uniform(0.0, side, (N_TILE, 3))
    for _ in range(400):
        pairs = cKDTree(centres, boxsize=side).query_pairs(float(diameters.max()), output_type="ndarray")
        apart = centres[pairs[:, 0]] - centres[pairs[:, 1]]
        apart -= side * np.round(apart / side)
        distance = np.linalg.norm(apart, axis=1)
        wanted = (diameters[pairs[:, 0]] + diameters[pairs[:, 1]]) / 2
        near = distance < wanted
        if not near.any() or (distance[near] / wanted[near]).min() > 0.95:
            break
        push = 0.5 * ((wanted - distance) / distance)[near, None] * apart[near]
        step = np.zeros_like(centres)
        np.add.at(step, pairs[near, 0], push)
        np.add.at(step, pairs[near, 1], -push)
        centres = (centres + 0.6 * step) % side
    return centres, diameters, side


def heap(angle: float, n: int, seed: int, kind: HeapKind) -> tuple[Array, Array]:
    """Centres and diameters of the `n` balls wholly below the smallest surface that holds so many."""
    generator = np.random.default_rng((seed, 40))
    slope = float(np.tan(np.radians(angle)))
    radius = 1.3 * (n / (2 * SOLID_FRACTION * slope)) ** (1 / 3) * (1 + 4 * kind.size_spread**2) + 3.0
    centres, diameters = packing(radius, radius * slope, kind.size_spread, generator)
    standing = centres[:, 2] > diameters / 2
    centres, diameters = centres[standing], diameters[standing]
    needed = _radius_needed(centres, diameters, slope, kind)
    needed += kind.roughness * generator.standard_normal(len(needed)) * np.hypot(1.0, slope) / slope
    chosen = np.argsort(needed)[:n]
    points, sizes = centres[chosen], diameters[chosen]
    n_loose = round(kind.loose * n)
    if not n_loose:
        return points, sizes
    around, away = generator.uniform(0, 2 * np.pi, n_loose), needed[chosen].max()
    away *= generator.uniform(1.0, 1.4, n_loose)
    sizes_of_loose = generator.choice(sizes, n_loose)
    loose = np.column_stack([away * np.cos(around), away * np.sin(around), sizes_of_loose / 2])
    return np.concatenate([points, loose]), np.concatenate([sizes, sizes_of_loose])


def surface_of_revolution(n: int, seed: int, height: float, radius: float, curve: str) -> tuple[Array, Array]:
    """Balls below a ``dome`` (a spherical cap) or an ``exponential`` heap of that height and radius."""
    scale = 1.0
    for _ in range(30):
        centres, diameters = packing(
            radius * scale + 1, height * scale, 0.0, np.random.default_rng((seed, 41))
        )
        away = np.hypot(centres[:, 0], centres[:, 1]) / scale
        if curve == "dome":
            ball = (radius**2 + height**2) / (2 * height)
            top = np.sqrt(np.maximum(ball**2 - away**2, 0.0)) - (ball - height)
        else:
            top = height * np.exp(-3.0 * away / radius)
        below = (centres[:, 2] > 0.5) & (centres[:, 2] + 0.5 < scale * top)
        if abs(below.sum() - n) < 0.02 * n:
            break
        scale *= (n / max(below.sum(), 10)) ** (1 / 3)
    return centres[below], diameters[below]


def packing(
    half_width: float, height: float, size_spread: float, generator: np.random.Generator
) -> tuple[Array, Array]:
    """Balls around the z axis, from a randomly shifted and turned tiling."""
    tiled, diameters, side = tile(size_spread, 7)
    reach = float(np.hypot(half_width, height))
    steps = np.arange(-int(np.ceil(reach / side)) - 1, int(np.ceil(reach / side)) + 1)
    corners = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3) * side
    shifted = tiled + generator.uniform(0.0, side, 3)
    centres = (corners[:, None, :] + shifted[None, :, :]).reshape(-1, 3)
    sizes = np.tile(diameters, len(corners))
    near = np.linalg.norm(centres, axis=1) < reach + 1.0
    turned = Rotation.random(random_state=int(generator.integers(2**31))).apply(centres[near])
    inside = (
        (np.hypot(turned[:, 0], turned[:, 1]) < half_width) & (turned[:, 2] > 0) & (turned[:, 2] < height)
    )
    return turned[inside], sizes[near][inside]


def _radius_needed(centres: Array, diameters: Array, slope: float, kind: HeapKind) -> Array:
    """Radius of the base of the smallest surface of the family that holds each ball."""
    away = np.hypot(centres[:, 0], centres[:, 1])
    high = centres[:, 2] / slope + diameters / 2 * np.hypot(1.0, slope) / slope
    if kind.tip == 0.0 and kind.blunt == 0.0:
        return away + high
    low, top = np.zeros(len(away)), np.full(len(away), 1e3)
    for _ in range(40):
        radius = (low + top) / 2
        edge = kind.tip * radius
        run = np.where(away < edge, (away**2 / np.maximum(edge, 1e-9) + edge) / 2, away)
        run = np.hypot(run, kind.blunt * radius)
        holds = radius - run >= high
        low, top = np.where(holds, low, radius), np.where(holds, radius, top)
    return top
