"""A synthetic micro-CT scan of separate angular grains: known truth behind realistic grey values.

Grains are placed by random sequential addition, the largest first. The scanner is modelled in image
space: partial volume, a Gaussian point-spread function, cupping by beam hardening, rings and noise.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.imaging.volume import Volume
from tools.make_samples.grains import Radius, StarRecipe, star_radius

Slices = tuple[slice, slice, slice]

_PLACE, _SCAN = 1_000_000, 1_000_001  # spawn keys beyond any grain's number


@dataclass(frozen=True)
class ScanRecipe:
    """What is scanned, and how badly; lengths in voxels, brightness from 0 to 255.

    Parameters
    ----------
    shape
        Voxels along x, y and z.
    voxel_size
        Edge of a voxel, in micrometres; 2.3 as in the paper's section 2.1.
    n_grains
        Number of grains to place.
    diameter
        Median, lowest and highest equivalent diameter; log-normal in between.
    spread
        Standard deviation of the logarithm of the diameter.
    anywhere
        Share of grains that may be cut by the border; the others lie within.
    attempts
        Places tried for one grain before giving up.
    resin
        Brightness of what is between the grains.
    minerals
        Brightness of the phases, drawn with equal chances: feldspar, pyroxene, ilmenite.
    blur
        Standard deviation of the point-spread function.
    cupping
        Share of brightness lost on the axis against the rim.
    rings
        Standard deviation of the rings' brightness.
    noise
        Standard deviation of the noise of one voxel.
    gradient
        Brightness that is taken away in the first slice along z and added in the last, linear in between.
    """

    shape: tuple[int, int, int] = (144, 144, 144)
    voxel_size: float = 2.3
    n_grains: int = 60
    diameter: tuple[float, float, float] = (24.0, 13.0, 44.0)
    spread: float = 0.3
    anywhere: float = 0.25
    attempts: int = 2000
    resin: float = 62.0
    minerals: tuple[float, ...] = (138.0, 152.0, 188.0)
    blur: float = 0.8
    cupping: float = 0.1
    rings: float = 1.2
    noise: float = 9.0
    gradient: float = 0.0


@dataclass(frozen=True)
class SyntheticScan:
    """The truth and the picture of it.

    Parameters
    ----------
    labels
        0 between grains, k in grain k = 1..n (voxels whose centre lies inside), uint16.
    grey
        What the scanner saw, uint8.
    """

    labels: Volume
    grey: Volume


def synthetic_scan(recipe: ScanRecipe, seed: int, name: str = "synthetic scan") -> SyntheticScan:
    """Draw grains, place them and scan them.

    Raises
    ------
    InputError
        If a grain finds no place.
    """
    labels, brightness = _place(recipe, seed)
    grey = _scan(brightness, recipe, np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(_SCAN,))))
    size = np.full(3, recipe.voxel_size)
    return SyntheticScan(
        Volume(labels, size, "labels", f"{name}, labels"), Volume(grey, size, "grey", f"{name}, grey values")
    )


def grain_recipe(generator: np.random.Generator) -> StarRecipe:
    """An angular grain of random habit: blocky to elongated or flat, and more or less rough."""
    return StarRecipe(
        diameter=1.0,
        n_planes=int(generator.integers(8, 19)),
        sharpness=float(generator.uniform(14, 30)),
        offset_spread=float(generator.uniform(0.1, 0.25)),
        stretch=(float(generator.uniform(1.0, 1.6)), 1.0, float(generator.uniform(0.6, 1.0))),
        roughness=float(generator.uniform(0.02, 0.06)),
        highest=14,
    )


def _diameters(recipe: ScanRecipe, generator: np.random.Generator) -> FloatArray:
    """Equivalent diameters in voxels, the largest first."""
    median, lowest, highest = recipe.diameter
    drawn = median * np.exp(recipe.spread * generator.standard_normal(recipe.n_grains))
    return np.sort(np.clip(drawn, lowest, highest))[::-1]


def _place(recipe: ScanRecipe, seed: int) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
    """Label of each voxel, and its brightness before the scanner: partial volumes of resin and grains."""
    places = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(_PLACE,)))
    labels = np.zeros(recipe.shape, dtype=np.uint16)
    brightness = np.full(recipe.shape, recipe.resin, dtype=np.float32)
    for index, diameter in enumerate(_diameters(recipe, places)):
        own = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index,)))
        coverage = grain_coverage(_tabulated(star_radius(grain_recipe(own), own)), diameter)
        mineral = recipe.minerals[own.integers(len(recipe.minerals))]
        volume, box = _find_place(labels, coverage, places, recipe)
        labels[volume][coverage[box] > 0.5] = index + 1
        brightness[volume] += coverage[box] * (mineral - recipe.resin)
    return labels, brightness


def _find_place(
    labels: NDArray[np.uint16],
    coverage: NDArray[np.float32],
    places: np.random.Generator,
    recipe: ScanRecipe,
) -> tuple[Slices, Slices]:
    """Where in the volume the grain meets no other, and which part of its box that is."""
    size = np.array(coverage.shape)
    beyond = size // 2 if places.random() < recipe.anywhere else np.zeros(3, dtype=np.int64)
    room = np.array(recipe.shape) - size + 2 * beyond
    for _ in range(recipe.attempts if (room >= 0).all() else 0):
        corner = places.integers(0, room, endpoint=True) - beyond
        low, high = np.maximum(corner, 0), np.minimum(corner + size, recipe.shape)
        volume, box = _slices(low, high), _slices(low - corner, high - corner)
        if not labels[volume][coverage[box] > 0.0].any():
            return volume, box
    raise InputError(
        f"No place was found for a grain of {size.max()} voxels after {recipe.attempts} attempts; "
        "take fewer grains, smaller ones or a larger volume."
    )


def _slices(low: IntArray, high: IntArray) -> Slices:
    x, y, z = (slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    return x, y, z


def grain_coverage(radius: Radius, diameter: float) -> NDArray[np.float32]:
    """Share of each voxel that a grain fills, in a cubic box about it with an odd number of voxels.

    The distance to the surface is taken to first order, F / |grad F| with F = |x| - r(x / |x|).

    Parameters
    ----------
    radius
        Radius function of the grain, in any unit.
    diameter
        Equivalent diameter that the grain is scaled to, in voxels.
    """
    reach = radius(_probe_directions())
    scale = diameter / 2 / np.mean(reach**3) ** (1 / 3)
    half = int(np.ceil(reach.max() * scale)) + 2
    axis = np.arange(-half, half + 1, dtype=np.float64)
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    distance = np.linalg.norm(points, axis=-1)
    unit = points / np.maximum(distance, 1e-9)[..., None]
    excess = distance - scale * radius(unit.reshape(-1, 3)).reshape(distance.shape)
    slope = np.sqrt(np.sum(np.square(np.gradient(excess)), axis=0))
    coverage = np.clip(0.5 - excess / np.maximum(slope, 0.5), 0.0, 1.0)
    return np.asarray(coverage, dtype=np.float32)


def _probe_directions(n_heights: int = 40) -> FloatArray:
    """Directions of equal area each: Lambert's cylinder."""
    height = (np.arange(n_heights) + 0.5) / n_heights * 2 - 1
    angle = np.arange(2 * n_heights) * np.pi / n_heights
    z, phi = (grid.ravel() for grid in np.meshgrid(height, angle, indexing="ij"))
    ring = np.sqrt(1 - z**2)
    return np.column_stack([ring * np.cos(phi), ring * np.sin(phi), z])


def _tabulated(radius: Radius, n_polar: int = 97) -> Radius:
    """The same radius function by bilinear look-up on a grid of angles: exact enough for voxels."""
    polar = np.linspace(0.0, np.pi, n_polar)
    azimuth = np.linspace(0.0, 2 * np.pi, 2 * n_polar - 1)
    theta, phi = (grid.ravel() for grid in np.meshgrid(polar, azimuth, indexing="ij"))
    nodes = np.column_stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
    table = radius(nodes).reshape(n_polar, -1)
    step = np.pi / (n_polar - 1)

    def looked_up(directions: FloatArray) -> FloatArray:
        x, y, z = directions.T
        rows = np.arccos(np.clip(z, -1.0, 1.0)) / step
        columns = (np.arctan2(y, x) % (2 * np.pi)) / step
        return np.asarray(
            ndimage.map_coordinates(table, [rows, columns], order=1, mode="nearest"), dtype=np.float64
        )

    return looked_up


def _scan(
    brightness: NDArray[np.float32], recipe: ScanRecipe, generator: np.random.Generator
) -> NDArray[np.uint8]:
    """What the scanner makes of the true brightness; the axis of rotation is z."""
    nx, ny, nz = recipe.shape
    slope = recipe.gradient * np.linspace(-1.0, 1.0, nz, dtype=np.float32)
    blurred = ndimage.gaussian_filter(brightness + slope, recipe.blur)
    x, y = np.arange(nx)[:, None] - (nx - 1) / 2, np.arange(ny)[None, :] - (ny - 1) / 2
    distance = np.hypot(x, y)
    cup = 1.0 - recipe.cupping * (1.0 - (distance / distance.max()) ** 2)
    rings = recipe.rings * generator.standard_normal(int(distance.max()) + 2)
    noise = recipe.noise * generator.standard_normal(recipe.shape)
    seen = blurred * cup[:, :, None] + rings[np.rint(distance).astype(int)][:, :, None] + noise
    return np.asarray(np.clip(np.rint(seen), 0, 255), dtype=np.uint8)
