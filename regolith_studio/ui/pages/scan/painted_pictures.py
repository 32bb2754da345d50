"""Colours of strokes and predictions over a slice."""

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor

from regolith_studio.geometry.arrays import IntArray
from regolith_studio.jobs.classifier_jobs import SlicePrediction
from regolith_studio.ui.pages.scan.brush_panel import CLASS_COLOURS

_OPACITY, _PAINT_OPACITY = 110, 220
_COLOURS = np.array([QColor(each).getRgb() for each in CLASS_COLOURS], dtype=np.uint8)


def overlay_picture(found: SlicePrediction, overlay: str) -> NDArray[np.uint8] | None:
    """RGBA of a prediction, shape (n_across, n_down, 4), or ``None`` for none.

    Parameters
    ----------
    overlay
        ``probability`` of grain (the likelier, the more opaque), the likeliest ``class``, ``uncertainty``
        (opaque where the two likeliest classes are equally likely), or ``none``.
    """
    if overlay == "none":
        return None
    picture = np.empty((*found.grain.shape, 4), dtype=np.uint8)
    if overlay == "class":
        picture[...] = _COLOURS[found.probabilities.argmax(axis=-1)]
        picture[..., 3] = _OPACITY
        return picture
    if overlay == "uncertainty":
        second, first = np.moveaxis(np.sort(found.probabilities, axis=-1)[..., -2:], -1, 0)
        picture[...] = (255, 255, 0, 0)
        picture[..., 3] = np.rint(200 * (1 - (first - second)))
        return picture
    picture[...] = _COLOURS[1]
    picture[..., 3] = np.rint(2 * _OPACITY * np.clip(found.grain, 0, 1) * 0.7)
    return picture


def paint_picture(places: IntArray, labels: IntArray, size: tuple[int, int]) -> NDArray[np.uint8]:
    """RGBA of painted voxels, shape (n_across, n_down, 4), transparent elsewhere.

    Parameters
    ----------
    places, labels
        Voxels across and down, shape (n, 2), and their classes, shape (n,).
    size
        Voxels of the slice across and down.
    """
    picture = np.zeros((*size, 4), dtype=np.uint8)
    picture[tuple(places.T)] = _COLOURS[labels]
    picture[..., 3] = np.where(picture[..., 3] > 0, _PAINT_OPACITY, 0)
    return picture
