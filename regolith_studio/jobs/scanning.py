"""Looking at a volume before it is segmented: its header, its voxels, its histogram, a preview."""

import os
import tempfile
from collections.abc import Generator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import RegolithError
from regolith_studio.imaging.boxes import Box
from regolith_studio.imaging.sample_volumes import SampleVolume, sample_volume
from regolith_studio.imaging.sections import Sections, coarse_copy
from regolith_studio.imaging.segmentation.segment import Segmentation, SegmentationSettings, preview
from regolith_studio.imaging.segmentation.thresholding import Histogram, histogram, level_of
from regolith_studio.imaging.slabs import Scratch, slab_ranges
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.events import Progress, Started, Step, Steps
from regolith_studio.jobs.extracting import VolumeInput, segment_volume
from regolith_studio.readers.volumes.read import SlabSource as FileSource
from regolith_studio.readers.volumes.read import describe_volume, read_volume

IN_MEMORY = 2**30
"""Bytes of a volume, or of what is computed from it, beyond which it stays on the disk."""
_LABEL_BYTES = 4
_SAMPLED = 4_000_000
_CONTRAST = (0.002, 0.998)


@dataclass(frozen=True, eq=False)
class Scan:
    """A volume with what is needed to show it; a large one is mapped from a file, not in memory.

    Parameters
    ----------
    volume
        Grey values or labels.
    seen
        Histogram of its values, of some of them where there are many; none of labels.
    contrast
        Values to be shown black and white.
    sections
        Pictures of its slices.
    scratch
        Holds the temporary files that it is mapped from, if there are any.
    """

    volume: Volume
    seen: Histogram | None
    contrast: tuple[float, float]
    sections: Sections
    scratch: Scratch = field(default_factory=Scratch)

    def level(self, settings: SegmentationSettings) -> float | None:
        """Where the threshold lies by the volume as it was scanned; none where there is no answer."""
        if self.seen is None:
            return None
        try:
            return level_of(self.seen, settings.threshold, self.volume.dtype)
        except RegolithError:
            return None


@dataclass(frozen=True, eq=False)
class FoundGrains:
    """The grains of a whole volume: what the segmentation says, pictures of the labels, and their files."""

    segmentation: Segmentation
    sections: Sections
    scratch: Scratch


def scan_of(volume: Volume, sections: Sections | None = None, scratch: Scratch | None = None) -> Scan:
    """Histogram and contrast of a volume."""
    sections, scratch = sections or Sections(volume.array), scratch or Scratch()
    if volume.kind == "labels":
        return Scan(volume, None, (0.0, 1.0), sections, scratch)
    seen = histogram(_sampled(sections.sample))
    share = np.cumsum(seen.counts) / seen.counts.sum()
    low, high = (float(seen.centres[np.searchsorted(share, at)]) for at in _CONTRAST)
    return Scan(volume, seen, (low, high if high > low else low + 1.0), sections, scratch)


def look_at_file(given: VolumeInput) -> Steps:
    """Read what a file says about itself; returns a ``VolumeHeader``."""
    yield Started(f"Looking at {given.path.name}")
    return describe_volume(given.path, dataset=given.dataset, axes=given.axes, raw=given.raw)


def read_scan(given: VolumeInput) -> Steps:
    """Read a volume into memory, or map it beyond :data:`IN_MEMORY`; returns a :class:`Scan`.

    What lies in the file as it is, is mapped there; packed voxels are unpacked into a temporary file.
    """
    yield Started(f"Reading {given.path.name}")
    source = given.opened()
    if _bytes_of(source) > IN_MEMORY:
        return (yield from _mapped(source))
    volume = read_volume(
        given.path,
        dataset=given.dataset,
        axes=given.axes,
        voxel_size=given.voxel_size,
        unit=given.unit,
        kind=given.kind,
        raw=given.raw,
    )
    yield Progress(1, 2, "Counting grey values")
    return scan_of(volume)


def find_grains(scan: Scan, settings: SegmentationSettings) -> Steps:
    """Segment a whole volume, by way of temporary files where it is large; returns :class:`FoundGrains`."""
    large = scan.volume.array.size * (_LABEL_BYTES + scan.volume.dtype.itemsize) > IN_MEMORY
    scratch = Scratch(roomy_folder() if large else None)
    try:
        found: Segmentation = yield from segment_volume(scan.volume, settings, scratch)
        if not large:
            return FoundGrains(found, Sections(found.labels.array), scratch)
        yield Started("Preparing the view")
        return FoundGrains(found, (yield from _sections(found.labels)), scratch)
    except BaseException:
        scratch.close()
        raise


def roomy_folder() -> Path:
    """Where temporary files of many gigabytes go: on a disk, where the system tells disks from memory."""
    there = Path("/var/tmp")
    return there if there.is_dir() and os.access(there, os.W_OK) else Path(tempfile.gettempdir())


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


def _mapped(source: FileSource) -> Generator[Step, None, Scan]:
    array, scratch = source.mapped(), Scratch()
    try:
        if array is None:
            scratch = Scratch(roomy_folder())
            array = scratch.zeros(source.shape, source.dtype)
            ranges = slab_ranges(source.shape)
            for done, (first, stop) in enumerate(ranges, start=1):
                array[:, :, first:stop] = source.read(first, stop)
                yield Progress(done, len(ranges), "Unpacking into a temporary file")
        volume = Volume(array, np.array(source.voxel_size), source.kind, source.name)
        return scan_of(volume, (yield from _sections(volume)), scratch)
    except BaseException:
        scratch.close()
        raise


def _sections(volume: Volume) -> Generator[Step, None, Sections]:
    steps = coarse_copy(volume)
    while True:
        try:
            done, total = next(steps)
        except StopIteration as end:
            return Sections(volume.array, *end.value)
        if done % 16 == 0:
            yield Progress(done, total, "Looking through the slices")


def _bytes_of(source: FileSource) -> int:
    return int(np.prod([int(edge) for edge in source.shape])) * source.dtype.itemsize


def _sampled(array: NDArray[Any]) -> NDArray[Any]:
    """Every n-th voxel of each axis, so that not many more than `_SAMPLED` remain."""
    step = max(1, int(np.ceil((array.size / _SAMPLED) ** (1 / 3))))
    return array[::step, ::step, ::step]
