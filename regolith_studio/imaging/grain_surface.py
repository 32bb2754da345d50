"""Surface meshes of single grains, from their mask or from the grey values around them.

A contour of a mask is stepped, which overstates the area by 4 to 9 % however fine the voxels are, and a
filter that removes the steps removes edges as well. A mask does tell on which side of each voxel's centre the
surface lies. :func:`mask_mesh` therefore moves the contour to lie smoothly between the centres. Its volume is
that of the voxels, which is unbiased whatever the shape.

Grey values tell more. A voxel that the surface cuts is as bright as the share of it that is grain. With b and
g the grey values of the surroundings and of the grain, the sum of (v - b) / (g - b) over the grain and its
rim is the volume of the grain, whatever the blur of the scanner, which moves brightness but does not lose
any. What lies deeper in the grain than its rim does not count (:mod:`~regolith_studio.imaging.rim_levels`).
:func:`grey_mesh` takes the contour halfway between b and g, moves it until it looks through the same
blur as the grain does, and scales it to that volume.
"""

from dataclasses import dataclass
from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import ScanOfGrain
from regolith_studio.imaging.contours import body_contour, contour, depth, windowed_sinc, with_volume
from regolith_studio.imaging.grain_errors import follows_grey
from regolith_studio.imaging.label_table import GrainCrop
from regolith_studio.imaging.rim_levels import CONTACT, PRESMOOTHING, RIM, grain_shares
from regolith_studio.imaging.surface_refinement import (
    LIGHT_SMOOTHING,
    RefinementSettings,
    refined_to_mask,
    refined_to_scan,
    without_crossings,
)

MARGIN = 7
"""Voxels around the box of a grain that are used."""
_DEBRIS_DISTANCE, _DEBRIS_VOXELS = 2.5, 8
"""Bright voxels so far from the grain, and so many together, belong to something else."""
_MAX_VOLUME_RATIO = 2.0
"""Maximum ratio of the volumes by brightness and by voxel count."""
_STEPS = 8
"""Steps of the refinement to grey values."""
_BLURS, _BLUR_STEPS = (0.1, 2.0), 20
"""Limits of the blur in voxels, and steps towards that along each axis."""
_WIDENING, _POWER, _MAX_PASS_BAND = 0.65, 0.4, 0.3
"""Pass band of the smoothing after each step: widening * usual band / noise^power, limited to the maximum.
Chosen on balls, ellipsoids, polyhedra and rough grains at noise of 2, 5 and 10 % of the contrast."""
_TWICING, _TWICING_OF_UNEQUAL = 0.9, 0.6
"""Factor of the twicing at the end (see ``surface_refinement``), and in voxels with unequal edges: steps
along their long edge widen the smoothing, so that 0.9 makes areas 1 to 2 % too large at 1 : 1 : 3."""

Floats = NDArray[np.float32]

_without_small_components: Any = cc3d.dust
_MASK_MARGIN = 4
"""Voxels around the mask into which the surface may move."""
_MASK_STEPS = 8
"""Steps of the refinement to a mask."""
_MASK_WIDENING, _MASK_TWICING = 2.0, 1.4
"""Pass band of the smoothing after each step as a multiple of the usual one, and factor of the twicing:
chosen on balls, ellipsoids, polyhedra and rough grains of 24 to 48 voxels."""


@dataclass(frozen=True, eq=False)
class GreySurface:
    """A surface from grey values, in voxels.

    ``scan``: its size and noise; where it does not follow the grey values, only its volume is theirs.
    """

    mesh: Mesh
    scan: ScanOfGrain


def grey_mesh(
    crop: GrainCrop,
    body: BoolArray,
    iterations: int = 20,
    pass_band: float = 0.13,
    cubic_voxels: bool = True,
) -> GreySurface | str:
    """The grain's surface in voxels of the crop, or the reason why the grey values do not define it.

    Where other grains touch it, the surface is that of the mask; brightness between two grains
    belongs to the nearer one.

    - ``crop``: the grain with at least :data:`MARGIN` voxels about it, where the volume has as many.
    - ``body``: the grain's voxels that count: of one piece, without pores.
    - ``iterations``, ``pass_band``: of the smoothing; without any iteration the surface is the contour
      alone.
    - ``cubic_voxels``: whether voxels have equal edges; otherwise the blur is measured along each, and the
      twicing is less.
    """
    others, values = crop.others | (crop.own & ~body), crop.values.astype(np.float32)
    inside, outside = depth(body), depth(~body)
    shares = grain_shares(values, others, inside, outside, cubic_voxels)
    if isinstance(shares, str):
        return shares
    rim, reliable = _rim(shares.share, others, inside, outside)
    rim[shares.full] = 1.0
    volume = float(rim.sum(dtype=np.float64))
    if not 1.0 / _MAX_VOLUME_RATIO < volume / np.count_nonzero(body) < _MAX_VOLUME_RATIO:
        return "its brightness and its number of voxels tell different volumes"
    across = float(np.cbrt(6.0 * volume / np.pi))
    scan = ScanOfGrain(across, shares.noise, follows_grey(across, shares.noise))
    if not scan.follows_grey:
        of_mask = mask_mesh(body, iterations, pass_band)
        return GreySurface(with_volume(of_mask, volume), scan)
    rough = body_contour(ndimage.gaussian_filter(rim, PRESMOOTHING))
    mesh = windowed_sinc(rough, iterations, pass_band)
    if iterations:
        wider = min(_WIDENING * pass_band / max(shares.noise, 1e-6) ** _POWER, _MAX_PASS_BAND)
        twicing = _TWICING if cubic_voxels else _TWICING_OF_UNEQUAL
        how = RefinementSettings(_STEPS, iterations, wider, twicing)
        blur = _blur(rim, shares.noise, mesh, cubic_voxels)
        fit = refined_to_scan(mesh, rim, reliable, blur, how)
        mesh = without_crossings(fit, windowed_sinc(rough, iterations, min(LIGHT_SMOOTHING * pass_band, 2.0)))
    return GreySurface(with_volume(mesh, volume), scan)


def _rim(share: Floats, others: BoolArray, inside: Floats, outside: Floats) -> tuple[Floats, BoolArray]:
    """Share of the grain in each voxel: 1 deep inside, 0 far outside, in other grains and nearer to them.

    And where it tells the surface: not deep inside, not far outside, not where other grains touch.
    """
    rim, reliable = share.copy(), (inside <= RIM) & (outside <= RIM)
    rim[inside > RIM] = 1.0
    body = inside > 0.0
    strange = (share >= 0.5) & (outside > _DEBRIS_DISTANCE)
    others = others | np.asarray(_without_small_components(strange.view(np.uint8), _DEBRIS_VOXELS) > 0)
    if others.any():
        away = depth(~others)
        touched = body & (away <= CONTACT)
        # Half for each of two grains that are equally near, so that no brightness counts twice or not at all.
        rim[~body & (away == outside)] *= 0.5
        rim[~body & (away < outside)] = 0.0
        if touched.any():
            reliable &= depth(~touched) > RIM
    rim[outside > RIM] = 0.0
    return rim, reliable


def _blur(rim: Floats, noise: float, mesh: Mesh, cubic_voxels: bool) -> FloatArray:
    """Standard deviations of the blur along the axes, in voxels, from the sum of u (1 - u), shape (3,).

    Across a plane edge blurred by a Gaussian the integral of u (1 - u) is sigma / sqrt(pi). In cubic voxels
    sigma is the same along all axes. In others the sum is shared out by the squared components of the
    gradient, and sigma^2 of an edge with the unit normal n is that of each axis times n^2.
    """
    uncertain = (rim != 0.0) & (rim != 1.0)
    share = rim[uncertain].astype(np.float64)
    # Noise lowers the expected u (1 - u) by its variance.
    spread = np.sqrt(np.pi) * (share * (1.0 - share) + noise**2)
    blur = np.full(3, np.clip(spread.sum() / mesh.surface_area, *_BLURS))
    if cubic_voxels:
        return blur
    smooth = ndimage.gaussian_filter(rim, 1.0)
    slopes = np.stack([np.gradient(smooth, axis=axis)[uncertain] for axis in range(3)]) ** 2
    measured = (slopes / np.maximum(slopes.sum(axis=0), 1e-12)) @ spread
    corners = mesh.triangles
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1) / 2
    along = (normals / np.maximum(2 * area, 1e-12)[:, None]) ** 2
    # A fixed point: what is expected is of degree 1 in the blur.
    for _ in range(_BLUR_STEPS):
        expected = (area * np.sqrt(along @ blur**2)) @ along
        blur = np.clip(blur * measured / expected, *_BLURS)
    return blur


def clipped_share(values: NDArray[Any], body: BoolArray) -> tuple[float, int]:
    """Share of a grain's voxels at an end of the scanner's range, where values are cut off, and that end.

    The ends are those of the type and, with 16 bits and more, the highest numbers of 10, 12 and 14 bits.
    """
    if values.dtype.kind not in "ui":
        return 0.0, 0
    limits = np.iinfo(values.dtype)
    ends = {limits.min, limits.max} | ({1023, 4095, 16383} if limits.bits > 8 else set())
    own = values[body]
    shares = {end: float(np.mean(own == end)) for end in ends if end in (own.min(), own.max())}
    end = max(shares, key=shares.__getitem__, default=0)
    return shares.get(end, 0.0), int(end)


def mask_mesh(body: BoolArray, iterations: int = 20, pass_band: float = 0.13) -> Mesh:
    """The surface of a mask, with the volume of its voxels, in voxels of the mask.

    ``body``: the grain's voxels: of one piece. ``iterations``, ``pass_band``: of the smoothing; without any
    iteration the surface is the contour alone.
    """
    padded = np.pad(body, _MASK_MARGIN)
    rough = contour(padded.astype(np.float32), 0.5, (1.0, 1.0, 1.0))
    mesh = windowed_sinc(rough, iterations, pass_band)
    if iterations:
        wider = min(_MASK_WIDENING * pass_band, 2.0)
        fit = refined_to_mask(mesh, padded, RefinementSettings(_MASK_STEPS, iterations, wider, _MASK_TWICING))
        mesh = without_crossings(fit, windowed_sinc(rough, iterations, min(LIGHT_SMOOTHING * pass_band, 2.0)))
    return with_volume(mesh, float(np.count_nonzero(body))).moved(shift=np.full(3, -float(_MASK_MARGIN)))
