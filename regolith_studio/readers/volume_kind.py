"""Whether voxels are labels or grey values, judged by how they look."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.readers.volume_format import Kind

LEAST_EQUAL_NEIGHBOURS = 0.7
"""Share of neighbours with the same value, outside the background; noisy greys reach 0.2."""
MOST_PIECES = 3.0
"""Pieces that a label has in a slice, on average; a phase or a mask has one for each grain."""
MOST_CLASSES = 8
"""Classes of a segmentation that numbers all of them, as ilastik's simple one does."""


def kind_of(slices: NDArray[Any]) -> Kind:
    """``labels`` if each particle seems to have its own number, else ``grey``.

    Labels are whole numbers, not negative, constant over wide areas, and each of them is in few
    pieces: a mask or a map of phases has many pieces of one value and is grey (to be split). So is
    a map of few values with no 0, which has a number for what is between the grains, too.

    Parameters
    ----------
    slices
        A few slices of a volume, shape (k, ny, nx).
    """
    if slices.dtype.kind == "b" or (slices.dtype.kind == "f" and not _whole(slices)):
        return "grey"
    if (slices.dtype.kind in "if" and slices.min() < 0) or not slices.any():
        return "grey"
    if slices.all() and len(np.unique(slices)) <= MOST_CLASSES:
        return "grey"
    left, right = slices[:, :, :-1], slices[:, :, 1:]
    inside = (left != 0) & (right != 0)
    if not inside.any() or (left == right)[inside].mean() < LEAST_EQUAL_NEIGHBOURS:
        return "grey"
    return "labels" if _pieces_a_label(slices) <= MOST_PIECES else "grey"


def _whole(slices: NDArray[Any]) -> bool:
    return bool(np.isfinite(slices).all() and (slices == np.floor(slices)).all())


def _pieces_a_label(slices: NDArray[Any]) -> float:
    """How many pieces a value has in a slice, the mean over voxels."""
    from scipy import ndimage

    pieces = voxels = 0.0
    for each in slices:
        edges = np.zeros(each.shape, dtype=bool)
        edges[1:, 1:] = (each[1:, 1:] != each[:-1, 1:]) | (each[1:, 1:] != each[1:, :-1])
        parts, count = ndimage.label((each != 0) & ~edges)
        if not count:
            continue
        _, places, sizes = np.unique(parts, return_index=True, return_counts=True)
        inside = parts.ravel()[places] > 0
        _, whose = np.unique(each.ravel()[places[inside]], return_inverse=True)
        size_of_value = np.bincount(whose, sizes[inside])
        pieces += float((size_of_value * np.bincount(whose)).sum())
        voxels += float(size_of_value.sum())
    return pieces / voxels if voxels else 0.0
