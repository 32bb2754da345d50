"""Looking at a volume before it is segmented: its header, its voxels, its histogram, a preview."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import RegolithError
from regolith_studio.imaging.boxes import Box
from regolith_studio.imaging.sample_volumes import SampleVolume, sample_volume
from regolith_studio.imaging.segmentation.segment import Segmentation, SegmentationSettings, preview
from regolith_studio.imaging.segmentation.thresholding import Histogram, histogram, level_of
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.extracting import VolumeInput
from regolith_studio.readers.volumes import describe_volume, read_volume

_SAMPLED = 4_000_000
_CONTRAST = (0.002, 0.998)


@dataclass(frozen=True, eq=False)
class Scan:
    """A volume in memory with what is needed to show it.

    Parameters
    ----------
    volume
        Grey values or labels.
    seen
        Histogram of its values, of some of them where there are many; none of labels.
    contrast
        Values to be shown black and white.
    """

    volume: Volume
    seen: Histogram | None
    contrast: tuple[float, float]

    def level(self, settings: SegmentationSettings) -> float | None:
        """Where the threshold lies by the volume as it was scanned; none where there is no answer."""
        if self.seen is None:
            return None
        try:
            return level_of(self.seen, settings.threshold, self.volume.dtype)
        except RegolithError:
            return None


def scan_of(volume: Volume) -> Scan:
    """Histogram and contrast of a volume."""
    if volume.kind == "labels":
        return Scan(volume, None, (0.0, 1.0))
    some = _sampled(volume.array)
    seen = histogram(some)
    share = np.cumsum(seen.counts) / seen.counts.sum()
    low, high = (float(seen.centres[np.searchsorted(share, at)]) for at in _CONTRAST)
    return Scan(volume, seen, (low, high if high > low else low + 1.0))


def look_at_file(given: VolumeInput) -> Steps:
    """Read what a file says about itself; returns a ``VolumeHeader``."""
    yield Started(f"Looking at {given.path.name}")
    return describe_volume(given.path, dataset=given.dataset, raw=given.raw)


def read_scan(given: VolumeInput) -> Steps:
    """Read a volume into memory; returns a :class:`Scan`."""
    yield Started(f"Reading {given.path.name}")
    volume = read_volume(
        given.path,
        dataset=given.dataset,
        voxel_size=given.voxel_size,
        unit=given.unit,
        kind=given.kind,
        raw=given.raw,
    )
    yield Progress(1, 2, "Counting grey values")
    return scan_of(volume)


def read_sample_scan(kind: SampleVolume = "grey") -> Steps:
    """Read the shipped synthetic scan; returns a :class:`Scan`."""
    yield Started("Reading the sample scan")
    return scan_of(sample_volume(kind))


def preview_part(volume: Volume, box: Box, settings: SegmentationSettings, level: float | None) -> Steps:
    """Segment a small part; returns a ``Segmentation``, or ``None`` where no grain is in it."""
    yield Started("Preview")
    try:
        found: Segmentation = preview(volume, box, settings, level)
    except RegolithError:
        return None
    return found


def _sampled(array: NDArray[Any]) -> NDArray[Any]:
    """Every n-th voxel of each axis, so that not many more than `_SAMPLED` remain."""
    step = max(1, int(np.ceil((array.size / _SAMPLED) ** (1 / 3))))
    return array[::step, ::step, ::step]
