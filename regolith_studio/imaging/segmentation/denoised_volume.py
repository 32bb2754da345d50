"""Grey values without noise and their histogram, slab by slab."""

from collections.abc import Generator
from dataclasses import replace
from functools import partial

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.imaging.segmentation.denoising import denoised, noise_of
from regolith_studio.imaging.segmentation.scan_outside import Padding
from regolith_studio.imaging.segmentation.thresholding import (
    Histogram,
    bins_between,
    finite,
    histogram,
    span,
)
from regolith_studio.imaging.settings import DenoiseSettings
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import ParallelMap, ScratchArrays, SharedArray, slab_ranges


def denoised_volume(
    source: Volume,
    how: DenoiseSettings,
    are_probabilities: bool,
    scratch: ScratchArrays,
    run: ParallelMap,
    padding: Padding | None,
) -> Generator[tuple[int, int], None, tuple[Volume, Histogram, int]]:
    """Grey values without noise (probabilities as they are), their histogram, and how many are not finite.

    Parameters
    ----------
    padding
        What the histogram does not count.
    """
    given = SharedArray(source.array)
    ranges = slab_ranges(source.shape)
    edges, n_not_finite = _bins(given, run)
    middle = source.shape[2] // 2
    noise = noise_of(given.slices(middle, middle + 1)) if how.method == "non-local-means" else 0.0
    values = None
    if how.method != "none" and not are_probabilities:
        values = SharedArray(scratch.zeros(source.shape, source.dtype))
    smooth = partial(_smooth_slab, given, values, how, noise, edges, padding)
    seen = Histogram(np.zeros(len(edges) - 1, dtype=np.int64), edges)
    for done, counts in enumerate(run(smooth, ranges), start=1):
        seen = seen + counts
        yield done, len(ranges)
    found = source if values is None else replace(source, array=values.array)
    return found, seen, n_not_finite


def _smooth_slab(
    given: SharedArray,
    values: SharedArray | None,
    how: DenoiseSettings,
    noise: float,
    edges: FloatArray,
    padding: Padding | None,
    part: tuple[int, int],
) -> Histogram:
    """Write a slab without noise into `values`, if there are any; returns its histogram."""
    if values is None:
        smooth = given.slices(*part)
    else:
        slab = given.thick(*part, how.margin)
        smooth = denoised(slab.values, how, noise)[:, :, slab.inner]
        values.write(slab.first, smooth)
    return histogram(smooth if padding is None else smooth[~padding.of(part)], edges)


def _bins(given: SharedArray, run: ParallelMap) -> tuple[FloatArray, int]:
    """Edges of the histogram's bins, and the number of voxels that are not finite."""
    spans, n_not_finite = [], 0
    for known, count in run(partial(_span_of_slab, given), slab_ranges(given.shape)):
        spans += known
        n_not_finite += count
    lowest, highest = span(np.array(spans))
    return bins_between(lowest, highest, given.array.dtype), n_not_finite


def _span_of_slab(given: SharedArray, part: tuple[int, int]) -> tuple[list[tuple[float, float]], int]:
    """Lowest and highest finite value of a slab, if there is one, and how many are not finite."""
    slab = given.slices(*part)
    known = finite(slab)
    return [span(known)] if known.size else [], slab.size - known.size
