"""Where grains end: a level on the histogram of grey values.

Small faults of the mask (small components, thin bridges, cracks, pores) are removed by :func:`cleaned`.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage import filters

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats, locked_integers
from regolith_studio.imaging.settings import CleaningSettings, ThresholdSettings
from regolith_studio.messages import N_, Message, Number

N_BINS = 256
_PEAK_WIDTH, _GAP, _HIDDEN_SHARE = 2.0, 0.6, 0.005
"""Standard deviation in bins by which a histogram is smoothed before its peaks are looked for, depth of the
gap beside a peak over its height, and least share of the voxels in a peak."""

_otsu: Any = filters.threshold_otsu
_multi_otsu: Any = filters.threshold_multiotsu


@dataclass(frozen=True, eq=False)
class Histogram(LockedRecord):
    """How often grey values occur.

    ``counts``: shape (n,). ``edges``: of the bins, ascending, shape (n + 1,).
    """

    counts: IntArray
    edges: FloatArray

    def __post_init__(self) -> None:
        counts = locked_integers(self.counts, (None,), "counts")
        object.__setattr__(self, "counts", counts)
        object.__setattr__(self, "edges", locked_floats(self.edges, (len(counts) + 1,), "edges"))

    @property
    def centres(self) -> FloatArray:
        """Middle of each bin."""
        return (self.edges[1:] + self.edges[:-1]) / 2

    @property
    def shares(self) -> FloatArray:
        """Fraction of the values in each bin; zeros if there are none."""
        return np.asarray(self.counts / max(int(self.counts.sum()), 1))

    def bin_of(self, value: float) -> int | None:
        """Index of the bin that a grey value falls into; ``None`` outside all bins."""
        index = int(np.searchsorted(self.edges, value, side="right")) - 1
        return index if 0 <= index < len(self.counts) else None

    def __add__(self, other: "Histogram") -> "Histogram":
        if not np.array_equal(self.edges, other.edges):
            raise ValueError("only histograms of the same bins can be added")
        return Histogram(self.counts + other.counts, self.edges)


def bins_between(lowest: float, highest: float, dtype: np.dtype[Any]) -> FloatArray:
    """Edges of at most 256 bins; those of whole numbers end halfway between two of them."""
    if dtype.kind == "f":
        return np.linspace(lowest, highest if highest > lowest else lowest + 1.0, N_BINS + 1)
    first, last = int(lowest), int(highest)
    # A whole number of grey values in each bin: bins of 1.5 would hold one and two in turn, as false peaks.
    width = -(-(last - first + 1) // N_BINS)
    n_bins = -(-(last - first + 1) // width)
    return first - 0.5 + width * np.arange(n_bins + 1, dtype=np.float64)


def histogram(values: NDArray[Any], edges: FloatArray | None = None) -> Histogram:
    """How often the grey values occur; values that are no numbers are left out.

    ``edges``: of equally wide bins; by default :func:`bins_between` the lowest and the highest value.

    Raises InputError if there are no edges and no value is a finite number.
    """
    seen = finite(values)
    if edges is None:
        edges = bins_between(*span(seen), values.dtype)
    counts, _ = np.histogram(seen, bins=len(edges) - 1, range=(edges[0], edges[-1]))
    return Histogram(counts, edges)


def finite(values: NDArray[Any]) -> NDArray[Any]:
    """The values that are finite numbers, in a row."""
    flat = values.ravel(order="K")
    return flat[np.isfinite(flat)] if values.dtype.kind == "f" else flat


def span(values: NDArray[Any]) -> tuple[float, float]:
    """Lowest and highest value.

    Raises InputError if there is none.
    """
    if values.size == 0:
        raise InputError("The volume holds no finite grey value.")
    return float(values.min()), float(values.max())


def level_of(seen: Histogram, settings: ThresholdSettings, dtype: np.dtype[Any]) -> float:
    """The grey value at which grains begin.

    ``dtype``: of the volume: tells the range of a probability in whole numbers.

    Raises InputError if the volume is too uniform to be parted.
    """
    match settings.method:
        case "manual":
            return settings.value
        case "probability":
            return settings.value * (1.0 if dtype.kind in "fb" else float(np.iinfo(dtype).max))
        case "otsu":
            needed = 2
        case _:
            needed = settings.classes
    filled = int(np.count_nonzero(seen.counts))
    if filled < needed:
        raise InputError(f"The volume has only {filled} grey values, too few for an automatic threshold.")
    centres = seen.centres
    if settings.method == "otsu":
        level = float(_otsu(hist=(seen.counts, centres)))
    else:
        level = float(
            _multi_otsu(classes=settings.classes, hist=(seen.counts, centres))[settings.boundary - 1]
        )
    # The upper edge of the bin: a level in its middle would part voxels that the histogram counts together.
    return float(seen.edges[np.searchsorted(seen.edges, level, side="right")])


def hidden_class(
    seen: Histogram, level: float, settings: ThresholdSettings
) -> tuple[float, float, float] | None:
    """Grey values of the two peaks between which the voxels that are no grain part, and of the gap between.

    An automatic threshold that parts the brightest grains from all others leaves dim ones below it: then
    these voxels have two peaks in the histogram, of which the one towards the level is that of grains.
    """
    from scipy.signal import find_peaks  # .8 s, which each worker of a batch would wait for

    if not settings.is_automatic:
        return None
    centres, counts = seen.centres, ndimage.gaussian_filter1d(seen.counts.astype(np.float64), _PEAK_WIDTH)
    rest = centres >= level if settings.dark else centres < level
    centres, counts = centres[rest], counts[rest]
    # From here on grains lie at the end of the row.
    if settings.dark:
        centres, counts = centres[::-1], counts[::-1]
    # Padded, since a peak at the border of the range counts too.
    peaks, _ = find_peaks(np.concatenate([[0.0], counts, [0.0]]))
    for last in reversed(peaks - 1):
        first = int(counts[: last + 1].argmax())
        gap = first + int(counts[first : last + 1].argmin())
        is_peak = counts[gap] < _GAP * counts[last]
        if first < last and is_peak and counts[gap:].sum() > _HIDDEN_SHARE * seen.counts.sum():
            return float(centres[first]), float(centres[last]), float(centres[gap])
    return None


def weak_level(level: float, settings: ThresholdSettings) -> float:
    """The grey value from which on voxels may belong to a grain, where `level` is that of its core."""
    return level * settings.low / settings.value if settings.low else level


def grain_voxels(values: NDArray[Any], level: float, settings: ThresholdSettings) -> NDArray[np.bool_]:
    """Whether each voxel is grain: at or above the level, or below it where grains are dark.

    Values that are no finite numbers are none.
    """
    grain = np.asarray(values < level if settings.dark else values >= level)
    return grain & np.isfinite(values) if values.dtype.kind == "f" else grain


def threshold_words(level: float, probability: float | None) -> str:
    """The level with what it is of, for a sentence: a grey value, or a probability where there is one."""
    if probability is not None:
        return Message(N_("probability {level}"), level=Number(probability, "g"))
    return Message(N_("grey level {level}"), level=Number(level, "g"))


_CROSS: NDArray[np.bool_] = ndimage.generate_binary_structure(3, 1)


def cleaned(mask: NDArray[np.bool_], settings: CleaningSettings) -> NDArray[np.bool_]:
    """The mask closed, then opened, by steps of the six neighbours; the border counts as continued."""
    width = settings.margin
    if width == 0:
        return mask
    # Beyond the border the mask goes on as it is there: zeros would be eroded inwards.
    padded = np.pad(mask, width, mode="edge")
    if settings.closing:
        padded = ndimage.binary_closing(padded, _CROSS, settings.closing)
    if settings.opening:
        padded = ndimage.binary_opening(padded, _CROSS, settings.opening)
    inner = tuple(slice(width, -width) for _ in range(3))
    return np.asarray(padded[inner], dtype=np.bool_)
