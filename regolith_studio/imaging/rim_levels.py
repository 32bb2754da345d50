"""The grey value that a grain has just within its surface, place by place.

Where a surface lies follows from the grey values on either side of it, whatever the rest of the grain is
like: a pore, an inclusion or a core of another mineral must not move it. The level of each place is
therefore taken from a shell just inside of it, which begins where the blur of the edge ends and reaches as
deep as what is added agrees with what lies nearer to the surface.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import KDTree
from scipy.special import ndtr

from regolith_studio.geometry.arrays import BoolArray, IntArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.contours import MAX_DEPTH, body_at_half, body_contour, depth

Floats = NDArray[np.float32]

RIM = 3.0
"""Voxels on either side of a mask's edge that may be blurred; beyond are grain and surroundings."""
CONTACT = 1.5
"""Maximum distance in voxels of touching grains."""
PRESMOOTHING = 0.42
"""Standard deviation in voxels of the Gaussian before the first contour."""
_MIN_VOXELS = 30
"""Minimum number of voxels to estimate a grey value from."""
_MAX_NOISE = 0.35
"""Noise, as a share of the contrast, from which on the mask is used instead of the grey values."""
_MIN_CONTRAST = 0.3
"""Share of the contrast that every place must have."""
_FIRST_SHELL = (1.5, 3.5)
"""Depth in voxels within a mask at which the grey value of its grain is first looked for."""
_MIN_EDGE, _MAX_BEYOND, _MIN_RISE = 0.45, 0.3, 2.05
"""Of a mask that reaches beyond its grain: largest brightness of its outermost voxels over the level, largest
of those just outside over them, and least of the next ones within over them."""
_CHANGE, _ROUNDS, _ROUNDS_WITH_CORE = 0.04, 3, 9
"""Change of the level in the shell, as a share of it, from which on the surface is looked for again, and how
often at most, also where a core lies just below it: its brightness puts the first surface far off."""
_CORE_DEPTHS, _CORNER = np.arange(1.6, 4.5, 0.2, dtype=np.float32), 0.45
"""Depths in voxels at which a core is looked for, and the usual distance along a surface to the next corner
of its mesh."""
_HOLLOW, _HOLLOW_SMOOTHING, _HOLLOW_REACH = 0.6, 1.0, 2.0
"""Share of grain below which a place is hollow, standard deviation in voxels over which it is averaged, and
distance in voxels within which a pore is seen."""
_WALL, _MIN_SOLID = 1.0, 0.18
"""Depth in voxels from which on voxels tell the level, and the share of them that no pore must be near."""
_REACH = 4.0
"""Standard deviation in voxels over which grey values of grain and surroundings are averaged."""
_BLOCK = 2
"""Edge in voxels of the blocks in which they are averaged first."""
_BEGIN = (1.3, 2.1)
"""Where the shell begins at the earliest, and where by default, in standard deviations of the blur."""
_THICKNESS, _LAYERS = 1.0, 2
"""Thickness of the layers of the default shell in voxels, and their number."""
_FULL, _FULL_IF_THIN = 2.6, 1.7
"""Depth in standard deviations of the blur from which on a voxel counts as full."""
_DEVIATIONS, _TOLERANCE = 3.0, 0.02
"""Two layers agree within so many standard errors and this share of the contrast."""
_REJECTED, _REJECTIONS = (2.5, 0.12), 2
"""Voxels beyond so many standard deviations, and this share of the contrast, from the mean are left out, and
how often."""
_MIN_KEPT = 0.3
"""Share of the voxels of a place that must be left."""
_MIN_WEIGHT = 0.002
"""Share of the voxels about a place that a layer must hold."""
_BLURS, _USUAL_BLUR = (0.3, 1.4), 0.85
"""Limits of the blur, in voxels, and what is taken where other grains are near nearly everywhere."""
_MIN_WIDTH = 0.6
"""What counts at least as the blur where the shell begins: depths of voxels are no more exact than that."""
_MIN_FREE = 0.1
"""Share of the surface without other grains near it from which on the blur is measured."""


_DEEPEST = _BEGIN[1] * _BLURS[1] + _LAYERS * _THICKNESS


@dataclass(frozen=True, eq=False)
class GrainShares:
    """What the grey values about a grain say of each voxel.

    - ``share``: share of the grain, blurred and noisy; shape (nx, ny, nz).
    - ``full``: voxels within that are full whatever their grey value is, same shape.
    - ``noise``: standard deviation of the share.
    """

    share: Floats
    full: BoolArray
    noise: float


def grain_shares(
    values: Floats, others: BoolArray, inside: Floats, outside: Floats, cubic_voxels: bool = True
) -> GrainShares | str:
    """Shares of a grain, or why the grey values do not tell them.

    - ``values``: grey values, shape (nx, ny, nz).
    - ``others``: voxels of other grains.
    - ``inside``, ``outside``: depth in the grain's mask, and distance to it.
    - ``cubic_voxels``: whether the blur is the same along all axes; otherwise the shell begins where the
      widest one ends.
    """
    far = np.minimum(outside, depth(~others)) if others.any() else outside
    # Between packed grains hardly a voxel is farther than the rim from all of them.
    beyond = far > (RIM if np.count_nonzero(far > RIM) >= _MIN_VOXELS else CONTACT)
    if np.count_nonzero(beyond) < _MIN_VOXELS:
        return "too little background lies about it"
    background = values[beyond]
    # Plates and needles have no voxel at the usual depth: their deepest ones count.
    shell = _first_shell(inside)
    lift = float(np.median(values[shell]) - np.median(background))
    # 1.4826: standard deviation of a Gaussian in median absolute deviations, which debris hardly changes.
    noise = 1.4826 * float(np.median(np.abs(background - np.median(background))))
    if not noise < _MAX_NOISE * abs(lift):
        return "it is hardly brighter or darker than its surroundings"
    above = (values - _local_mean(values, beyond & _usual(values, background))) * np.float32(np.sign(lift))
    level = _local_mean(above, shell)
    if _reaches_beyond(above, level, inside, outside):
        # The shell of such a mask holds the blurred edge, which must not set the level.
        body = body_at_half(_smooth_share(above / level, others)) & (inside > 0.0)
        inside, outside = depth(body), depth(~body)
        shell = _first_shell(inside)
        level = _local_mean(above, shell)
    if (level[shell] < _MIN_CONTRAST * abs(lift)).any():
        return "it is in part hardly brighter or darker than its surroundings"
    # Only the shell was checked; elsewhere a level near 0 would make shares without limit.
    level = np.maximum(level, np.float32(_MIN_CONTRAST * abs(lift)))
    grain, full = _Grain(above, noise, others, inside, outside, cubic_voxels), inside > RIM
    core = np.zeros_like(level)
    for number in range(_ROUNDS_WITH_CORE):
        before = level
        levels = _level_and_full(grain, level)
        if levels is None:
            break
        if isinstance(levels, str):
            return levels
        level, full, core = levels
        rounds_left = number + 1 < (_ROUNDS_WITH_CORE if core.any() else _ROUNDS)
        if not rounds_left or (np.abs(level - before)[shell] <= _CHANGE * level[shell]).all():
            break
    return GrainShares(
        np.asarray((above - core) / level, np.float32), full, noise / float(np.median(level[shell]))
    )


@dataclass(frozen=True, eq=False)
class _Grain:
    """Grey values above the surroundings, their noise, and the arguments of :func:`grain_shares`."""

    above: Floats
    noise: float
    others: BoolArray
    inside: Floats
    outside: Floats
    cubic: bool


def _level_and_full(grain: _Grain, level: Floats) -> tuple[Floats, BoolArray, Floats] | str | None:
    """Contrast of full grain about each voxel from a first estimate of it, which voxels are full, and what a
    core adds in each; or why nothing of it is known beyond the estimate, if that is far off."""
    body, share = grain.inside > 0.0, np.asarray(grain.above / level, np.float32)
    smooth = _smooth_share(share, grain.others)
    surface = body_contour(smooth)
    depths = _depths(body, surface)
    hollow = body & ((depths == 0.0) | (depths > CONTACT)) & (grain.inside > 1.0)
    hollow &= ndimage.gaussian_filter(share, _HOLLOW_SMOOTHING) < _HOLLOW
    known = depths > 0.0
    from_pore = depth(~hollow) if hollow.any() else None
    if from_pore is not None:
        n_deep = np.count_nonzero(depths > _WALL)
        known &= from_pore > _HOLLOW_REACH
        # The blurred wall of a pore is nowhere as bright as solid grain: a level from it lies too low.
        if np.count_nonzero(known & (depths > _WALL)) < _MIN_SOLID * n_deep:
            return "pores lie within about 3 voxels of most of its surface: its volume may be off by a tenth"
    away = depth(~grain.others) if grain.others.any() else None
    if away is not None:
        # `away` is cut off at MAX_DEPTH, from where on it cannot be compared with depths.
        known &= (away > depths + CONTACT) | (away >= MAX_DEPTH)
    outer = (smooth < 0.5) & (grain.outside <= RIM) & (grain.inside <= RIM) & ~hollow
    noise = grain.noise / float(np.median(level[body]))
    blur = _blur_of(share, outer, away, noise, grain.outside, surface) if grain.cubic else _BLURS[1]
    rim_level = _rim_level(grain, np.where(known, depths, np.float32(0.0)), blur)
    if rim_level is None:
        return None
    level, begin, core = rim_level
    full = body & ((depths > begin) | (grain.inside > RIM))
    return level, full if from_pore is None else full | (body & (from_pore < depths)), core


def _first_shell(inside: Floats) -> BoolArray:
    return (inside > min(_FIRST_SHELL[0], float(inside.max()) - 0.5)) & (inside <= _FIRST_SHELL[1])


def _reaches_beyond(above: Floats, level: Floats, inside: Floats, outside: Floats) -> bool:
    """Whether a mask's edge lies outside of its grain's, as where its threshold is low for a bright grain.

    The edge over a bright core is as dim beside the core, but just outside of it the grain goes on.
    """
    edge = (inside > 0.0) & (inside <= 1.0)
    within, beyond = (inside > 1.0) & (inside <= 2.0), (outside > 0.0) & (outside <= 1.0)
    if not within.any():
        return False
    brightness = float(above[edge].mean())
    return bool(
        brightness < _MIN_EDGE * level[edge].mean()
        and above[beyond].mean() < _MAX_BEYOND * brightness
        and above[within].mean() > _MIN_RISE * brightness
    )


def _smooth_share(share: Floats, others: BoolArray) -> Floats:
    """Shares before a contour, without other grains."""
    return np.asarray(ndimage.gaussian_filter(np.where(others, np.float32(0.0), share), PRESMOOTHING))


def _depths(body: BoolArray, surface: Mesh) -> Floats:
    """Distance of each voxel of a body to the nearest corner of a surface; 0 where it is far."""
    candidates = np.flatnonzero(body)
    at = np.column_stack(np.unravel_index(candidates, body.shape))
    distances, _ = KDTree(surface.vertices).query(at, distance_upper_bound=_DEEPEST)
    depths = np.zeros(body.shape, dtype=np.float32)
    depths.ravel()[candidates] = np.where(np.isfinite(distances), distances, 0.0)
    return depths


def _rim_level(grain: _Grain, depths: Floats, blur: float) -> tuple[Floats, Floats, Floats] | None:
    """Contrast of full grain about each voxel, the depth from which on voxels are full, and what a core
    adds in each voxel; or nothing.

    ``depths``: distance to the surface of voxels that may tell the level, else 0. ``blur``: standard
    deviation of the edge, in voxels.
    """
    above, noise = grain.above, grain.noise
    # Without any blur the shell would begin in the voxels that the surface cuts: balls of 13 voxels were 6 %
    # too small.
    wide = max(blur, _MIN_WIDTH)
    early, usual = (wide * each for each in _BEGIN)
    steps = [early, usual, *(usual + _THICKNESS * (k + 1) for k in range(_LAYERS))]
    indices = np.flatnonzero((depths > early) & (depths <= steps[-1]))
    if not len(indices):
        return None
    deep = depths.ravel()[indices]
    # At this depth the blur has taken 1 - ndtr of the contrast of a plane edge.
    full = np.asarray(above.ravel()[indices] / (ndtr(deep / blur) if grain.cubic else 1.0), np.float32)
    typical = float(np.median(full))
    layers = []
    for low, high in itertools.pairwise(steps):
        chosen = (deep > low) & (deep <= high)
        layers.append(_local(above.shape, indices[chosen], full[chosen], noise, typical))
    level, thin, weight = _joined(layers, noise, _TOLERANCE * typical)
    added = np.zeros(above.shape, np.float32)
    # The blurred edge of a core just below the rim brightens the outer layer: balls of 20 voxels with a core
    # of twice the brightness lost 9.8 % of their volume before both edges were fitted together.
    if (differs := thin & (layers[1][1] > _MIN_WEIGHT)).any():
        rim, added, fitted = _rim_and_core(above, depths, blur, differs)
        level = np.where(fitted, rim, level)
    seen = weight > _MIN_WEIGHT
    if not seen.any():
        return None
    level = np.where(seen, level, np.float32(np.average(level, weights=weight)))
    begin = np.where(thin & seen, _FULL_IF_THIN * wide, _FULL * wide).astype(np.float32)
    return _spread(level, above.shape), _spread(begin, above.shape), added


def _rim_and_core(
    above: Floats, depths: Floats, blur: float, differs: BoolArray
) -> tuple[Floats, Floats, BoolArray]:
    """Contrast of the rim of each block over a core that begins within the shell, what that core adds in each
    voxel, and the blocks of which this is known.

    ``differs``: blocks whose shell is not of one grey value. The grey values are those of two blurred edges,
    of the grain and of the core; their heights follow from least squares for each depth of the core, of which
    the best is taken. What is darker than :data:`_MIN_CONTRAST` is a pore.
    """
    indices = np.flatnonzero((depths > blur) & (depths <= _DEEPEST))
    deep, values = _below_surface(depths.ravel()[indices]), above.ravel()[indices]
    blocks, block = _blocks(above.shape), _block_of(indices, above.shape)

    def mean(products: Floats) -> Floats:
        return _mean(blocks, block, np.asarray(products, np.float32))[0]

    # Normal equations of value = one * rim + other * core, block by block.
    rim = ndtr(deep / blur)
    rim2, rim_value, value2 = mean(rim * rim), mean(rim * values), mean(values * values)
    best = np.full(blocks, np.inf, np.float32)
    level, height, begin = (np.zeros(blocks, np.float32) for _ in range(3))
    for at in _CORE_DEPTHS:
        core = ndtr((deep - at) / blur)
        both, core2, core_value = mean(rim * core), mean(core * core), mean(core * values)
        determinant = np.maximum(rim2 * core2 - both * both, 1e-9)
        one = (core2 * rim_value - both * core_value) / determinant
        other = (rim2 * core_value - both * rim_value) / determinant
        error = value2 - one * rim_value - other * core_value
        better = (error < best) & (one > 0.0) & (one + other > _MIN_CONTRAST * one)
        for kept, new in ((best, error), (level, one), (height, other), (begin, at)):
            np.copyto(kept, new, where=better, casting="same_kind")
    known = differs & np.isfinite(best)
    added = _spread(np.where(known, height, np.float32(0.0)), above.shape)
    added *= ndtr((_below_surface(depths) - _spread(begin, above.shape)) / blur)
    return level, np.where(depths > 0.0, added, np.float32(0.0)), known


def _below_surface(depths: Floats) -> Floats:
    """Depths below the surface from those below its nearest corner."""
    return np.asarray(np.sqrt(np.maximum(depths**2 - _CORNER**2, 0.0)), np.float32)


def _joined(
    layers: list[tuple[Floats, Floats]], noise: float, tolerance: float
) -> tuple[Floats, BoolArray, Floats]:
    """Mean of the layers of each place, from the second one down to where they begin to disagree with it.

    Where already the second disagrees with the first, the first is taken, and the place is said to be thin.
    """
    (first, first_weight), (mean, weight), *deeper = layers
    mean, weight = mean.copy(), weight.copy()
    no_first, no_second = first_weight <= _MIN_WEIGHT, weight <= _MIN_WEIGHT
    agree = _agreement(first, first_weight, mean, weight, noise, tolerance)
    thin = (no_second | ~agree) & ~no_first
    open_ = ~thin
    for layer, layer_weight in deeper:
        agree = _agreement(mean, weight, layer, layer_weight, noise, tolerance)
        open_ &= (agree | (weight <= _MIN_WEIGHT)) & (layer_weight > 0.0)
        total = weight + layer_weight
        joined = (weight * mean + layer_weight * layer) / np.maximum(total, 1e-9)
        mean, weight = np.where(open_, joined, mean), np.where(open_, total, weight)
    return np.where(thin, first, mean), thin, np.where(thin, first_weight, weight)


def _agreement(
    one: Floats, one_weight: Floats, other: Floats, other_weight: Floats, noise: float, tolerance: float
) -> BoolArray:
    """Whether two means differ by no more than their standard errors and the tolerance allow.

    The weights of a Gaussian of standard deviation s sum up to 1, their squares to 1 / (4 pi s^2)^1.5; in a
    layer, which the narrower Gaussian of the squares sees as larger, to about 1.4 of that.
    """
    spread = 1.4 / (4.0 * np.pi * _REACH**2) ** 1.5
    error = noise * np.sqrt(spread / np.maximum(one_weight, 1e-6) + spread / np.maximum(other_weight, 1e-6))
    return np.asarray(np.abs(one - other) <= _DEVIATIONS * error + tolerance)


def _local(
    shape: tuple[int, ...], indices: IntArray, values: Floats, noise: float, typical: float
) -> tuple[Floats, Floats]:
    """Mean of the values of voxels about each block, without those far from it, and the voxels' share."""
    blocks, block = _blocks(shape), _block_of(indices, shape)
    mean, weight = _mean(blocks, block, values)
    for _ in range(_REJECTIONS):
        kept = np.abs(values - mean.ravel()[block]) <= max(_REJECTED[0] * noise, _REJECTED[1] * typical)
        if kept.all():
            break
        better, left = _mean(blocks, block[kept], values[kept])
        mean = np.where(left > _MIN_KEPT * weight, better, mean)
    return mean, weight


def _blocks(shape: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(-(-n // _BLOCK) for n in shape)


def _block_of(indices: IntArray, shape: tuple[int, ...]) -> IntArray:
    """Flat index of the block of each voxel."""
    at = [axis // _BLOCK for axis in np.unravel_index(indices, shape)]
    return np.asarray(np.ravel_multi_index(at, _blocks(shape)))


def _mean(blocks: tuple[int, ...], block: IntArray, values: Floats) -> tuple[Floats, Floats]:
    """Mean of the values of voxels about each block, weighted by a Gaussian, and the voxels' share of it."""
    size = int(np.prod(blocks))

    def blurred(weights: Floats | None) -> Floats:
        sums = np.bincount(block, weights, minlength=size).reshape(blocks).astype(np.float32) / _BLOCK**3
        # Normalised convolution: unknown voxels, also those beyond the array, have neither value nor weight.
        smoothed = ndimage.gaussian_filter(sums, _REACH / _BLOCK, mode="constant", truncate=2.0)
        return np.asarray(smoothed, np.float32)

    total, share = blurred(values), blurred(None)
    return np.divide(total, share, out=np.zeros_like(total), where=share > 1e-6), share


def _spread(blocks: Floats, shape: tuple[int, ...]) -> Floats:
    """Values of blocks, interpolated at voxels."""
    for axis, n in enumerate(shape):
        # The value of a block is that of its middle.
        at = np.clip((np.arange(n) - (_BLOCK - 1) / 2) / _BLOCK, 0, blocks.shape[axis] - 1)
        low = np.minimum(at.astype(np.int64), max(blocks.shape[axis] - 2, 0))
        high = np.minimum(low + 1, blocks.shape[axis] - 1)
        part = (at - low).astype(np.float32).reshape([-1 if k == axis else 1 for k in range(3)])
        blocks = blocks.take(low, axis) * (1 - part) + blocks.take(high, axis) * part
    return blocks


def _blur_of(
    share: Floats, outer: BoolArray, away: Floats | None, noise: float, outside: Floats, surface: Mesh
) -> float:
    """Standard deviation of an edge in voxels, from the shares u of grain in the voxels `outer` of its rim.

    Across a plane edge blurred by a Gaussian the integral of u (1 - u) over the outer side is
    sigma / (2 sqrt(pi)) = sigma / 3.54; of rounded grains it is more, and sigma / 3.2 of balls of 24 voxels.
    Where other grains are near (`away`, their distance), nothing is measured.
    """
    area = surface.surface_area
    if away is not None:
        alone, edge = away >= MAX_DEPTH, (outside > 0.0) & (outside <= 1.0)
        free = float(np.count_nonzero(edge & alone)) / max(int(np.count_nonzero(edge)), 1)
        if free < _MIN_FREE:
            return _USUAL_BLUR
        outer, area = outer & alone, free * area
    seen = share[outer]
    total = float((seen * (1.0 - seen) + noise**2).sum(dtype=np.float64))
    return float(np.clip(3.2 * total / max(area, 1.0), *_BLURS))


def _local_mean(values: Floats, known: BoolArray) -> Floats:
    """Mean of the known values about each voxel, weighted by a Gaussian; far from all of them, of all."""
    indices = np.flatnonzero(known)
    mean, weight = _mean(_blocks(values.shape), _block_of(indices, values.shape), values.ravel()[indices])
    mean[weight <= _MIN_WEIGHT] = values[known].mean(dtype=np.float64)
    return _spread(mean, values.shape)


def _usual(values: Floats, sample: Floats) -> BoolArray:
    """Values within the range of nearly all of the sample: no debris of other grains."""
    middle = np.median(sample)
    spread = 1.4826 * np.median(np.abs(sample - middle))
    return np.asarray(np.abs(values - middle) <= max(4.0 * float(spread), 1e-6 * abs(float(middle)), 1e-12))
