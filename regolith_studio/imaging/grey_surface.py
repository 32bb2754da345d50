"""Surface of one grain from the grey values about it, which know more than the mask does.

A voxel that the surface cuts is as bright as the share of it that is grain. With b and g the grey
values of the surroundings and of the grain, the sum of (v - b) / (g - b) over the grain and its rim
is therefore the grain's volume, whatever blur the scanner has added: blurring moves brightness and
loses none. A mask at any level has no such property; a blur of 0.8 voxels takes 2 to 4 % of the
volume of a grain of 24 voxels in diameter, a threshold nearer to one mineral than to another more.

The shape is the contour at half the way from b to g, moved until it looks through the same blur as
the grain does (:mod:`~regolith_studio.imaging.surface_fit`), the more smoothly the more noise there
is, and scaled to that volume.
"""

from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.bodies import largest_body, pores_filled
from regolith_studio.imaging.contour import contour
from regolith_studio.imaging.crossings import LIGHTLY, uncrossed
from regolith_studio.imaging.depth import depth
from regolith_studio.imaging.label_table import GrainCrop
from regolith_studio.imaging.smoothing import windowed_sinc, with_volume
from regolith_studio.imaging.surface_fit import FitSettings, fitted

MARGIN = 7
"""Voxels about a grain's box that are looked at."""
_RIM = 3.0
"""Voxels on either side of a mask's edge in which blur is looked for; beyond are grain and surroundings."""
_CONTACT = 1.5
"""Distance in voxels at which grains touch."""
_CRUMB, _SPECK = 2.5, 8
"""Bright voxels so far from the grain, and so many together, belong to something else."""
_REACH = 4.0
"""Standard deviation in voxels over which the grey values of grain and surroundings are averaged."""
_FEWEST = 30
"""Voxels that tell a grey value."""
_NOISIEST = 0.35
"""Share of the contrast at which noise leaves the grey values without a say."""
_STRANGEST = 2.0
"""Times that the volumes by brightness and by voxels may differ."""
_CALMING = 0.42
"""Standard deviation in voxels of the Gaussian before the first contour."""
_STEPS = 8
"""Moves of the surface towards the scan."""
_WIDENING, _POWER, _WIDEST = 0.65, 0.4, 0.3
"""The pass band that smooths it after each is so many times the usual over the noise (as a share of the
contrast) to this power, at most so wide: chosen on balls, ellipsoids, polyhedra and rough grains at noise of
2, 5 and 10 %."""
_TWICING = 0.9
"""How many times what one more smoothing takes is added at the end."""

Floats = NDArray[np.float32]

_without_specks: Any = cc3d.dust


def grey_mesh(crop: GrainCrop, body: BoolArray, iterations: int = 20, pass_band: float = 0.13) -> Mesh | str:
    """The grain's surface in voxels of the crop, or why the grey values do not tell it.

    Where other grains touch it, the surface is that of the mask; brightness between two grains
    belongs to the nearer one.

    Parameters
    ----------
    crop
        The grain with at least :data:`MARGIN` voxels about it, where the volume has as many.
    body
        The grain's voxels that count: of one piece, without pores.
    iterations, pass_band
        Of the smoothing; without any iteration the surface is the contour alone.
    """
    others, values = crop.others | (crop.own & ~body), crop.values.astype(np.float32)
    inside, outside = depth(body), depth(~body)
    levels = _levels(values, others, inside, outside)
    if isinstance(levels, str):
        return levels
    share, noise = levels
    rim, told = _rim(share, others, inside, outside)
    volume = float(rim.sum(dtype=np.float64))
    if not 1.0 / _STRANGEST < volume / np.count_nonzero(body) < _STRANGEST:
        return "its brightness and its number of voxels tell different volumes"
    rough = _contoured(ndimage.gaussian_filter(rim, _CALMING))
    mesh = windowed_sinc(rough, iterations, pass_band)
    if iterations:
        wider = min(_WIDENING * pass_band / max(noise, 1e-6) ** _POWER, _WIDEST)
        how = FitSettings(_STEPS, iterations, wider, _TWICING)
        blur = _blur(rim, noise, mesh.surface_area)
        fit = fitted(mesh, rim, told, blur, how)
        mesh = uncrossed(fit, windowed_sinc(rough, iterations, min(LIGHTLY * pass_band, 2.0)))
    return with_volume(mesh, volume)


def _levels(values: Floats, others: BoolArray, inside: Floats, outside: Floats) -> tuple[Floats, float] | str:
    """Share of grain in each voxel, and the noise of it; or why there is none."""
    within = inside > min(_RIM, float(inside.max()) - 0.5)
    far = np.minimum(outside, depth(~others)) if others.any() else outside
    beyond = far > (_RIM if np.count_nonzero(far > _RIM) >= _FEWEST else _CONTACT)
    if np.count_nonzero(beyond) < _FEWEST:
        return "too little background lies about it"
    grain, background = values[within], values[beyond]
    contrast = abs(float(np.median(grain)) - float(np.median(background)))
    noise = 1.4826 * float(np.median(np.abs(background - np.median(background))))
    if not noise < _NOISIEST * contrast:
        return "it is hardly brighter or darker than its surroundings"
    dark = _local_mean(values, beyond & _usual(values, background))
    bright = _local_mean(values, within)
    span = bright - dark
    if (span * np.sign(np.median(grain) - np.median(background)) < 0.3 * contrast).any():
        return "it is in part hardly brighter or darker than its surroundings"
    return np.asarray((values - dark) / span), noise / contrast


def _rim(share: Floats, others: BoolArray, inside: Floats, outside: Floats) -> tuple[Floats, BoolArray]:
    """Share of the grain in each voxel: 1 deep inside, 0 far outside, in other grains and nearer to them.

    And where it tells the surface: not deep inside, not far outside, not where other grains touch.
    """
    rim, told = share.copy(), (inside <= _RIM) & (outside <= _RIM)
    rim[inside > _RIM] = 1.0
    body = inside > 0.0
    strange = (share >= 0.5) & (outside > _CRUMB)
    others = others | np.asarray(_without_specks(strange.view(np.uint8), _SPECK) > 0)
    if others.any():
        away = depth(~others)
        touched = body & (away <= _CONTACT)
        rim[touched] = 1.0
        rim[~body & (away == outside)] *= 0.5
        rim[~body & (away < outside)] = 0.0
        if touched.any():
            told &= depth(~touched) > _RIM
    rim[outside > _RIM] = 0.0
    return rim, told


def _blur(rim: Floats, noise: float, area: float) -> float:
    """Standard deviation of the blur, in voxels, from the sum of u (1 - u).

    Across a plane edge blurred by a Gaussian the integral of u (1 - u) is sigma / sqrt(pi).
    """
    uncertain = rim[(rim != 0.0) & (rim != 1.0)].astype(np.float64)
    total = float((uncertain * (1.0 - uncertain) + noise**2).sum())
    return float(np.clip(np.sqrt(np.pi) * total / area, 0.1, 2.0))


def _contoured(share: Floats) -> Mesh:
    """Contour at one half of the largest body, without what it encloses."""
    body, _ = largest_body(np.ascontiguousarray(share >= 0.5))
    body = pores_filled(body)
    one = np.where(body, np.maximum(share, 0.501), np.minimum(share, 0.499))
    mesh = contour(np.pad(one, 1).astype(np.float32), 0.5, (1.0, 1.0, 1.0))
    return mesh.moved(shift=np.full(3, -1.0))


def _local_mean(values: Floats, known: BoolArray) -> Floats:
    """Mean of the known values about each voxel, weighted by a Gaussian; far from all of them, of all."""
    weight = ndimage.gaussian_filter(known.astype(np.float32), _REACH, mode="constant", truncate=2.0)
    total = ndimage.gaussian_filter(np.where(known, values, 0.0), _REACH, mode="constant", truncate=2.0)
    everywhere = np.full(values.shape, values[known].mean(dtype=np.float64), dtype=np.float32)
    return np.divide(total, weight, out=everywhere, where=weight > 0.01)


def _usual(values: Floats, sample: Floats) -> BoolArray:
    """Values within the range of nearly all of the sample: no crumbs of other grains."""
    middle = np.median(sample)
    spread = 1.4826 * np.median(np.abs(sample - middle))
    return np.asarray(np.abs(values - middle) <= max(4.0 * float(spread), 1e-6 * abs(float(middle)), 1e-12))
