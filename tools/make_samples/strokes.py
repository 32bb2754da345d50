"""Ten strokes of a brush on a scan whose grains are known, as somebody would draw them.

In each of four slices along z the largest grain that has not been drawn yet is traced twice: outside of its
outline, and inside of it and on through its middle. In a slice along x and in one along y a line runs through
the resin along z, far from all grains.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.graph import route_through_array
from skimage.measure import approximate_polygon, find_contours

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.imaging.segmentation.strokes import Stroke, draw_stroke, painted_rows
from regolith_studio.imaging.volume import Volume

N_STROKES = 10
BACKGROUND, GRAIN = 0, 1
_SLICES = (0.11, 0.36, 0.63, 0.88)
"""Places of the traced slices along z, and of those across it, as shares of the volume."""
_ACROSS = ((0, 0.31), (1, 0.70))
_FROM_OUTLINE = 1.7
"""Voxels between an outline and the strokes along it."""
_contours: Any = find_contours
_polygon: Any = approximate_polygon
_route: Any = route_through_array


def painted_volume(labels: Volume) -> Volume:
    """The voxels of the strokes: 1 in the resin, 2 in grains, 0 where nothing is painted."""
    positions, classes, _ = painted_rows(strokes_of(labels))
    painted = np.zeros(labels.shape, dtype=np.uint8)
    painted[tuple(positions.T)] = classes + 1
    return Volume(painted, labels.voxel_size, "labels", f"{labels.name}, strokes")


def strokes_of(labels: Volume) -> list[Stroke]:
    """The ten strokes."""
    strokes, drawn = [], {0}
    for share in _SLICES:
        number = round(share * labels.shape[2])
        here, counts = np.unique(labels.array[:, :, number], return_counts=True)
        label = next(k for k in here[np.argsort(-counts, kind="stable")].tolist() if k not in drawn)
        drawn.add(label)
        depth = _depth(labels.array[:, :, number] == label)
        for level, kind in ((_FROM_OUTLINE, GRAIN), (-_FROM_OUTLINE, BACKGROUND)):
            line = _polygon(max(_contours(depth, level), key=len), 0.5)
            if kind == GRAIN:
                line = np.concatenate([line, _through(depth, line)])
            strokes.append(draw_stroke(2, number, line + 0.5, 1.0, labels.shape, kind))
    for axis, share in _ACROSS:
        number = round(share * labels.shape[axis])
        line = _way_through(_depth(np.take(labels.array > 0, number, axis)))
        strokes.append(draw_stroke(axis, number, line + 0.5, 1.5, labels.shape, BACKGROUND))
    return strokes


def _depth(mask: NDArray[np.bool_]) -> FloatArray:
    """Distance of pixels in a mask from its outline, negative outside."""
    inside, outside = (ndimage.distance_transform_edt(each) for each in (mask, ~mask))
    return np.asarray(inside - outside, dtype=np.float64)


def _through(depth: FloatArray, outline: FloatArray) -> FloatArray:
    """On from the end of an outline through the deepest pixel to the corner opposite, shape (2, 2)."""
    middle = np.array(np.unravel_index(depth.argmax(), depth.shape), dtype=np.float64)
    beyond = outline[((outline - 2 * middle + outline[-1]) ** 2).sum(axis=1).argmin()]
    return np.stack([middle, beyond])


def _way_through(depth: FloatArray) -> FloatArray:
    """Corners of a line through the resin from one end of a slice to the other, shape (n, 2)."""
    across, along = depth.shape
    cost = np.where(depth < -1.5, 1.0 + 20.0 / np.maximum(-depth, 1.0), 1e4)
    way, _ = _route(cost, (across // 2, 1), (across // 2, along - 2))
    return np.asarray(_polygon(np.array(way, dtype=np.float64), 1.0))
