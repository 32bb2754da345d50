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

Refinement of a grain's surface until it reproduces the scan, without self-intersections.

A contour of blurred grey values has lost its edges, and one of a mask shows steps. The mesh is therefore
voxelized and blurred as the scanner does. Where the scan is brighter than the result the surface moves
outward, where it is darker inward, and after each step it is smoothed according to the noise. Since a mesh
has no partly covered inside, this amplifies noise far less than sharpening the image would. Of a mask, only
voxels whose centre is on the wrong side of the surface move it.

What the smoothing takes from edges is given back by twicing (Tukey, Exploratory Data Analysis, 1977): the
surface is smoothed once more, and the difference is added.

The mesh is voxelized by the share of each voxel that lies inside: what a perfect scanner would see of it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import ScanOfGrain
from regolith_studio.geometry.self_intersection import crossing_pairs
from regolith_studio.imaging.contours import LowPass, body_contour, contour, depth, windowed_sinc, with_volume
from regolith_studio.imaging.grain_errors import follows_grey
from regolith_studio.imaging.label_table import GrainCrop
from regolith_studio.imaging.rim_levels import CONTACT, PRESMOOTHING, RIM, grain_shares

Floats = NDArray[np.float32]

_BOX = 1.0 / 12.0
"""Variance that a voxel's own width adds to the blur of an edge."""
_REACH, _REACH_OF_MASKS = 0.8, 0.5
"""Standard deviation in voxels over which differences are averaged, so that single voxels move nothing."""
_MAX_STEP = 0.3
"""Maximum move of a vertex in a step, in voxels."""
_RELAXATION = 1.6
"""Share of the distance to the position of a flat surface that is moved in a step."""
_COLUMNS, _COLUMNS_OF_MASKS = 3, 2
"""Columns along the edge of a voxel by which its coverage is measured."""

_TWICING_PASS_BAND = 0.38
"""Pass band of the smoothing of the twicing, as a share of that of the refinement."""
LIGHT_SMOOTHING = 4.0
"""Multiple of the usual pass band: a contour smoothed so lightly does not intersect itself."""
_RINGS_TESTED, _RINGS_RESTORED, _ATTEMPTS = 2, 3, 4
"""Rings of faces around suspicious ones that are tested, rings of vertices around crossing faces that are
restored, and maximum number of attempts."""
_MIN_COSINE = 0.2
"""Cosine of the angle to a vertex normal below which a face counts as turned over."""


@dataclass(frozen=True)
class RefinementSettings:
    """Number of steps of the refinement, and its smoothing.

    - ``steps``: number of moves.
    - ``iterations``, ``pass_band``: of the smoothing after each step
      (:class:`~regolith_studio.imaging.contours.LowPass`).
    - ``twicing``: factor of the difference by one more and stronger smoothing, which is added at the end.
    """

    steps: int
    iterations: int
    pass_band: float
    twicing: float = 0.0


def refined_to_scan(
    mesh: Mesh, share: Floats, rim: BoolArray, blur: FloatArray, how: RefinementSettings
) -> Mesh:
    """The mesh, in voxels, moved to where it reproduces the shares best.

    - ``share``: share of the grain in each voxel, blurred and noisy.
    - ``rim``: voxels that count.
    - ``blur``: standard deviations along the axes of the blur as an edge shows it, in voxels, the voxel's
      own width in it, shape (3,).
    """
    # The coverage of voxels blurs by their width already.
    point_spread = np.sqrt(np.maximum(blur**2 - _BOX, 0.0))

    def missing(mesh: Mesh) -> Floats:
        seen = ndimage.gaussian_filter(coverage(mesh, _shape(share), _COLUMNS), point_spread)
        return np.asarray(np.where(rim, share - seen, np.float32(0.0)))

    return _moved(mesh, missing, float(blur.mean()), _REACH, how)


def refined_to_mask(mesh: Mesh, mask: BoolArray, how: RefinementSettings) -> Mesh:
    """The mesh, in voxels, moved so that the centres of a mask's voxels lie within it and no others."""
    side = np.where(mask, np.float32(0.5), np.float32(-0.5))

    def missing(mesh: Mesh) -> Floats:
        """Voxels more than half covered are inside; only those on the wrong side miss something."""
        beyond = 0.5 - coverage(mesh, _shape(mask), _COLUMNS_OF_MASKS)
        return np.asarray(np.where(beyond * side > 0.0, beyond, np.float32(0.0)))

    return _moved(mesh, missing, _BOX**0.5, _REACH_OF_MASKS, how)


def _moved(
    mesh: Mesh, missing: Callable[[Mesh], Floats], blur: float, reach: float, how: RefinementSettings
) -> Mesh:
    """The mesh after all steps and the twicing; `blur` and `reach` set the length of the steps."""
    # A plane edge blurred by a Gaussian of sigma has the slope 1 / (sqrt(2 pi) sigma) at the surface: a
    # difference in brightness times sqrt(2 pi) sigma is the distance by which the surface is off.
    pace = _RELAXATION * float(np.sqrt(2.0 * np.pi * (blur**2 + reach**2)))
    smooth = LowPass(mesh.faces, len(mesh.vertices), how.iterations)
    for _ in range(how.steps):
        lacking = ndimage.gaussian_filter(missing(mesh), reach)
        there = ndimage.map_coordinates(lacking, mesh.vertices.T, order=1)
        away = np.clip(pace * there.astype(np.float64), -_MAX_STEP, _MAX_STEP)
        outward = corner_normals(mesh.vertices, mesh.faces)
        mesh = Mesh(smooth(mesh.vertices + away[:, None] * outward, how.pass_band), mesh.faces)
    taken = mesh.vertices - smooth(mesh.vertices, _TWICING_PASS_BAND * how.pass_band)
    return Mesh(mesh.vertices + how.twicing * taken, mesh.faces)


def _shape(array: Floats | BoolArray) -> tuple[int, int, int]:
    nx, ny, nz = array.shape
    return nx, ny, nz


def without_crossings(mesh: Mesh, safe: Mesh) -> Mesh:
    """The mesh with the vertices of `safe`, of the same faces, where its faces intersect each other.

    Smoothing does not know how near the other side of a plate or of a tunnel is. Only faces near vertices
    with another side within two voxels, and faces that are turned over, are tested. Both meshes are in
    voxels; `safe` is returned if intersections remain or are too many to test.
    """
    low, high = np.floor(safe.bounds[0]) - 1.0, np.ceil(safe.bounds[1]) + 1.0
    nx, ny, nz = (int(n) for n in high - low + 1.0)
    inside = coverage(safe.moved(shift=-low), (nx, ny, nz), 1) > 0.5
    for _ in range(_ATTEMPTS):
        normals = corner_normals(mesh.vertices, mesh.faces)
        doubtful = np.zeros(len(mesh.faces), dtype=np.bool_)
        _mark_doubtful(mesh.vertices - low, mesh.faces, normals, inside, doubtful)
        looked_at = _about(mesh.faces, np.flatnonzero(doubtful), len(normals), _RINGS_TESTED)
        faces = np.ascontiguousarray(mesh.faces[looked_at[mesh.faces].any(axis=1)])
        crossings = crossing_pairs(mesh.vertices, faces)
        if crossings is None:
            break
        if crossings[0] == 0:
            return mesh
        near = _about(faces, np.flatnonzero(crossings[1]), len(normals), _RINGS_RESTORED)
        mesh = Mesh(np.where(near[:, None], safe.vertices, mesh.vertices), mesh.faces)
    return safe


def _about(faces: IntArray, chosen: IntArray, n_vertices: int, rings: int) -> BoolArray:
    """Corners of the chosen faces, and of the faces about these; shape (n_vertices,)."""
    near = np.zeros(n_vertices, dtype=np.bool_)
    near[faces[chosen]] = True
    for _ in range(rings - 1):
        near[faces[near[faces].any(axis=1)]] = True
    return near


def corner_normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Unit normals of the corners: sums of those of the faces about them, weighted by area."""
    total = np.zeros(vertices.shape)
    _add_corner_normals(vertices, faces, total)
    return total


@kernel
def _add_corner_normals(vertices: FloatArray, faces: IntArray, total: FloatArray) -> None:
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for corner in range(3):
            total[faces[face, corner], 0] += x
            total[faces[face, corner], 1] += y
            total[faces[face, corner], 2] += z
    for corner in range(len(vertices)):
        x, y, z = total[corner]
        length = max(np.sqrt(x * x + y * y + z * z), 1e-300)
        total[corner, 0], total[corner, 1], total[corner, 2] = x / length, y / length, z / length


@kernel
def _mark_doubtful(
    vertices: FloatArray, faces: IntArray, normals: FloatArray, inside: BoolArray, doubtful: BoolArray
) -> None:
    """Mark faces with another side of the surface within two voxels of a corner, or turned over, (m,)."""
    nx, ny, nz = inside.shape
    thin = np.zeros(len(vertices), dtype=np.bool_)
    for corner in range(len(vertices)):
        for away in (-2.0, -1.0, 1.0, 2.0):
            i = int(np.rint(vertices[corner, 0] + away * normals[corner, 0]))
            j = int(np.rint(vertices[corner, 1] + away * normals[corner, 1]))
            k = int(np.rint(vertices[corner, 2] + away * normals[corner, 2]))
            deep = 0 <= i < nx and 0 <= j < ny and 0 <= k < nz and inside[i, j, k]
            thin[corner] = thin[corner] or deep != (away < 0.0)
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        least = _MIN_COSINE * np.sqrt(x * x + y * y + z * z)
        for side in range(3):
            corner = faces[face, side]
            along = x * normals[corner, 0] + y * normals[corner, 1] + z * normals[corner, 2]
            doubtful[face] = doubtful[face] or thin[corner] or along < least


_ASIDE = np.array([1.23e-7, 2.17e-7, 0.0])
"""Keeps columns off edges that run along the grid."""


def coverage(mesh: Mesh, shape: tuple[int, int, int], fine: int = 3) -> NDArray[np.float32]:
    """Share of each voxel inside the mesh, whose corners are given in voxels; shape `shape`.

    Each voxel is cut into `fine` x `fine` columns along z, and along their middles the share is exact. What
    lies outside the grid is cut off.
    """
    share = np.empty(shape, dtype=np.float32)
    _fill_coverage(mesh.vertices + _ASIDE, mesh.faces, fine, share)
    return share


@kernel
def _fill_coverage(vertices: FloatArray, faces: IntArray, fine: int, share: NDArray[np.float32]) -> None:
    """Sum of what each crossing adds to its own voxel and to those above it, column by column."""
    nx, ny, nz = share.shape
    added = np.zeros((nx, ny, nz + 1))
    weight = 1.0 / (fine * fine)
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        ax, ay = (a[0] + 0.5) * fine - 0.5, (a[1] + 0.5) * fine - 0.5
        bx, by = (b[0] + 0.5) * fine - 0.5, (b[1] + 0.5) * fine - 0.5
        cx, cy = (c[0] + 0.5) * fine - 0.5, (c[1] + 0.5) * fine - 0.5
        twice = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if twice == 0.0:
            continue
        sign = -weight if twice > 0.0 else weight
        first, last = int(np.ceil(min(ax, bx, cx))), int(np.floor(max(ax, bx, cx)))
        front, back = int(np.ceil(min(ay, by, cy))), int(np.floor(max(ay, by, cy)))
        for i in range(max(first, 0), min(last, nx * fine - 1) + 1):
            for j in range(max(front, 0), min(back, ny * fine - 1) + 1):
                u = ((i - ax) * (cy - ay) - (cx - ax) * (j - ay)) / twice
                v = ((bx - ax) * (j - ay) - (i - ax) * (by - ay)) / twice
                if u < 0.0 or v < 0.0 or u + v > 1.0:
                    continue
                height = max(a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]) + 0.5, 0.0)
                k = int(np.floor(height))
                if k < nz:
                    above = 1.0 - (height - k)
                    added[i // fine, j // fine, k] += sign * above
                    added[i // fine, j // fine, k + 1] += sign * (1.0 - above)
    for i in range(nx):
        for j in range(ny):
            total = 0.0
            for k in range(nz):
                total += added[i, j, k]
                share[i, j, k] = total


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
