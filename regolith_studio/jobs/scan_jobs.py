"""Jobs that show a scan before its particles are made: read it, look at slices, find and preview grains."""

import math
import os
import tempfile
from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.imaging.label_surface import label_surface
from regolith_studio.imaging.label_table import label_table
from regolith_studio.imaging.segmentation.scan_outside import (
    AUTO,
    ScanOutside,
    background_filled,
    find_outside,
)
from regolith_studio.imaging.segmentation.segment import (
    Segmentation,
    SegmentationProgress,
    SegmentationSettings,
    grains_over_heights,
    part_of,
    preview,
    segmentation_steps,
)
from regolith_studio.imaging.segmentation.thresholding import Histogram, histogram, level_of
from regolith_studio.imaging.settings import ThresholdSettings
from regolith_studio.imaging.volume import Box, SampleVolume, Volume, VolumeKind, sample_volume
from regolith_studio.imaging.volume_slabs import (
    ParallelMap,
    ScratchArrays,
    SliceImages,
    SliceSource,
    coarse_copy,
    slab_ranges,
    sparse_slices,
    unpacked,
)
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps, as_progress
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.messages import N_, Message
from regolith_studio.readers.volumes.read import VolumeFile, describe_volume
from regolith_studio.readers.volumes.region import RegionSettings
from regolith_studio.steps import as_events

IN_MEMORY = 2**30
"""Bytes of a volume, or of what is computed from it, beyond which it stays on the disk."""
LOOK_BYTES = 2**26
"""Bytes of a volume beyond which a few slices are shown before all are read."""
LOOK_VOXELS, LOOK_SECONDS = 2**24, 0.6
_LABEL_BYTES = 8
"""Of the body and the grain of a voxel."""
_SAMPLED = 4_000_000
_CONTRAST = (0.002, 0.998)
_Result = TypeVar("_Result")


@dataclass(frozen=True, eq=False)
class Scan:
    """A volume with what is needed to show it; a large one is mapped from a file, not in memory.

    - ``volume``: grey values or labels.
    - ``histogram``: histogram of its values, of some of them where there are many; none of labels.
    - ``contrast``: values to be shown black and white.
    - ``sections``: pictures of its slices.
    - ``scratch``: holds the temporary files that it is mapped from, if there are any.
    - ``outside``: what lies outside of the scanner's circle, which neither histogram nor contrast count.
    - ``filled``: the volume with background there, as classifiers see it.
    """

    volume: Volume
    histogram: Histogram | None
    contrast: tuple[float, float]
    sections: SliceImages
    scratch: ScratchArrays
    outside: ScanOutside | None
    filled: Volume

    def level(self, settings: SegmentationSettings) -> float | None:
        """Where the threshold lies by the volume as it was scanned; none where there is no answer."""
        if self.histogram is None:
            return None
        try:
            return level_of(self.histogram, settings.threshold, self.volume.dtype)
        except RegolithError:
            return None


@dataclass(frozen=True, eq=False)
class GrainSegmentation:
    """The grains of a whole volume: what the segmentation says, pictures of the labels, and their files."""

    segmentation: Segmentation
    sections: SliceImages
    scratch: ScratchArrays


def scan_of(
    volume: Volume,
    sections: SliceImages | None = None,
    scratch: ScratchArrays | None = None,
    outside: str = AUTO,
) -> Scan:
    """Histogram and contrast of a volume; `outside` as in :func:`find_outside`."""
    sections, scratch = sections or SliceImages(volume.array), scratch or ScratchArrays()
    if volume.kind == "labels":
        return Scan(volume, None, (0.0, 1.0), sections, scratch, None, volume)
    padding = find_outside(volume, outside)
    distribution = histogram(_values_inside(sections, padding))
    share = np.cumsum(distribution.counts) / distribution.counts.sum()
    low, high = (float(distribution.centres[np.searchsorted(share, at)]) for at in _CONTRAST)
    contrast = low, high if high > low else low + 1.0
    filled = volume
    if padding is not None:
        filled = background_filled(volume, padding, ThresholdSettings(), scratch)
    return Scan(volume, distribution, contrast, sections, scratch, padding, filled)


def _values_inside(sections: SliceImages, outside: ScanOutside | None) -> NDArray[Any]:
    """Some of the grey values of a scan, those outside of the scanner's circle left out."""
    sample = _subsample(sections.sample)
    if outside is None:
        return sample
    step = sections.step * _subsample_step(sections.sample)
    columns = outside.columns[::step, ::step][: sample.shape[0], : sample.shape[1]]
    return np.asarray(sample[~replace(outside, columns=columns).of(sample)])


def read_header(given: VolumeInput) -> Steps:
    """Read what a file says about itself; returns a ``VolumeHeader``."""
    yield Started(Message(N_("Inspecting {name}"), name=given.path.name))
    return describe_volume(
        given.path, dataset=given.dataset, axes=given.axes, raw=given.raw, allow_gaps=given.allow_gaps
    )


@dataclass(frozen=True, eq=False)
class FirstLook:
    """A coarse picture of a large volume, and what its file states, before it is read.

    ``scan``: a few slices, or a coarser level of the file, with a histogram of their values. ``shape``,
    ``voxel_size``, ``kind``, ``dtype``: of the whole volume; micrometres.
    """

    scan: Scan
    shape: tuple[int, int, int]
    voxel_size: FloatArray
    kind: VolumeKind
    dtype: np.dtype[Any]


def first_look(source: SliceSource) -> FirstLook:
    """A coarser level of a volume if its file has one, else the slices that are read in `LOOK_SECONDS`."""
    level = source.coarser(LOOK_VOXELS) if isinstance(source, VolumeFile) else None
    if level is not None:
        size = np.array(level.voxel_size)
        coarse = Volume(level.read(0, level.shape[2]), size, level.kind, source.name)
    else:
        coarse = sparse_slices(
            source, LOOK_SECONDS, in_order=isinstance(source, VolumeFile) and source.in_order
        )
    edges = np.asarray(source.voxel_size, dtype=np.float64)
    return FirstLook(scan_of(coarse), source.shape, edges, source.kind, source.dtype)


def read_scan(given: VolumeInput, region: RegionSettings | None = None) -> Steps:
    """Read a region of a volume into memory, or map it beyond :data:`IN_MEMORY`; returns a :class:`Scan`.

    What lies in the file as it is, is mapped there; packed voxels are unpacked into a temporary file. Of a
    volume beyond :data:`LOOK_BYTES` a :class:`FirstLook` comes first.
    """
    yield Started(Message(N_("Reading {name}"), name=given.path.name))
    region = region or RegionSettings()
    source, outside = region.of(given.opened()), region.outside
    if _n_bytes(source) > LOOK_BYTES:
        yield Partial(first_look(source))
    if _n_bytes(source) > IN_MEMORY:
        return (yield from _map_volume(source, outside))
    array = source.read(0, source.shape[2])
    yield Progress(1, 2, N_("Counting grey values"))
    return scan_of(_volume_of(source, array), outside=outside)


def read_all(
    source: SliceSource, scratch: ScratchArrays, run: ParallelMap = map
) -> Generator[Step, None, Volume]:
    """All voxels of a volume in `scratch`, where parts of them can be worked on."""
    return as_progress(unpacked(source, scratch, run))


def find_grains(scan: Scan, settings: SegmentationSettings) -> Steps:
    """Segment a volume, a large one in temporary files; returns :class:`GrainSegmentation`."""
    yield from compile_first("scan")
    scratch = scratch_arrays(scan.volume, scratch_folder())
    try:
        segmentation: Segmentation = yield from segment_volume(
            scan.volume, settings, scratch, outside=scan.outside
        )
        if scratch.folder is None:
            return GrainSegmentation(segmentation, SliceImages(segmentation.labels.array), scratch)
        yield Started(N_("Preparing the view"))
        return GrainSegmentation(segmentation, (yield from slice_images(segmentation.labels)), scratch)
    except BaseException:
        scratch.close()
        raise


def view_labels(labels: Volume) -> Steps:
    """Coarse surfaces of all labels for a picture, a ``LabelSurface``, and the voxels of each label."""
    yield Started(N_("Drawing grains"))
    surface = label_surface(labels.array, labels.voxel_size)
    return surface, label_table(labels).sizes() if len(surface.labels) else {}


def scratch_folder() -> Path:
    """Where temporary files of many gigabytes go: on a disk, where the system tells disks from memory."""
    there = Path("/var/tmp")
    return there if there.is_dir() and os.access(there, os.W_OK) else Path(tempfile.gettempdir())


def scratch_arrays(volume: SliceSource, folder: Path | None) -> ScratchArrays:
    """For what is computed from a volume: in memory, or in a folder beyond :data:`IN_MEMORY`."""
    size = volume.dtype.itemsize
    a_voxel = (_LABEL_BYTES + size if volume.kind == "grey" else 0) + (
        0 if isinstance(volume, Volume) else size
    )
    return ScratchArrays(folder if _n_voxels(volume) * a_voxel > IN_MEMORY else None)


def read_sample_scan(kind: SampleVolume = "grey", region: RegionSettings | None = None) -> Steps:
    """Read a region of the shipped synthetic scan; returns a :class:`Scan`."""
    yield Started(N_("Reading the sample scan"))
    region = region or RegionSettings()
    source = region.of(sample_volume(kind))
    return scan_of(_volume_of(source, source.read(0, source.shape[2])), outside=region.outside)


def preview_part(scan: Scan, box: Box, settings: SegmentationSettings) -> Steps:
    """Segment a small part; returns a ``Segmentation``, or ``None`` where no grain is in it."""
    yield from compile_first("scan")
    yield Started(N_("Preview"))
    volume, outside = _seen_by(scan, settings)
    try:
        segmentation: Segmentation = preview(volume, box, settings, scan.level(settings), outside)
    except RegolithError:
        return None
    return segmentation


def _seen_by(scan: Scan, settings: SegmentationSettings) -> tuple[Volume, ScanOutside | None]:
    """What a preview is made of, and what lies outside there: nothing for a classifier."""
    return (scan.volume, scan.outside) if settings.classifier is None else (scan.filled, None)


def preview_heights(
    scan: Scan, box: Box, settings: SegmentationSettings, level: float | None, heights: Sequence[float]
) -> Steps:
    """Grains of a small part with each h of `heights`; returns a tuple of ``GrainsAtHeight``.

    `level` takes the place of an automatic threshold.
    """
    yield from compile_first("scan")
    volume, outside = _seen_by(scan, settings)
    part, chosen = part_of(volume, box, settings, level)
    padding = None if outside is None else outside.within(box)
    return (yield from reported(grains_over_heights(part, heights, chosen, outside=padding)))


def count_over_heights(
    given: VolumeInput, settings: GrainSettings, heights: Sequence[float], scratch: Path | None = None
) -> Steps:
    """Grains of a file with each h of `heights`; returns a tuple of ``GrainsAtHeight``."""
    yield from compile_first("scan")
    yield Started(Message(N_("Reading {name}"), name=given.path.name))
    volume = settings.region.of(given.opened())
    if volume.kind != "grey":
        raise InputError(
            f"{given.path.name} holds labels, which are grains already; there is no h to choose."
        )
    with scratch_arrays(volume, scratch) as arrays:
        whole: Volume = yield from read_all(volume, arrays)
        outside = find_outside(whole, settings.region.outside)
        steps = grains_over_heights(whole, heights, settings.segmentation, arrays, outside)
        return (yield from reported(steps))


def _volume_of(source: SliceSource, array: NDArray[Any]) -> Volume:
    return Volume(array, np.array(source.voxel_size), source.kind, source.name, source.origin)


def _map_volume(source: SliceSource, outside: str) -> Generator[Step, None, Scan]:
    array, scratch = source.mapped() if isinstance(source, VolumeFile) else None, ScratchArrays()
    try:
        if array is None:
            scratch = ScratchArrays(scratch_folder())
            array = scratch.zeros(source.shape, source.dtype)
            ranges = slab_ranges(source.shape)
            for done, (first, stop) in enumerate(ranges, start=1):
                array[:, :, first:stop] = source.read(first, stop)
                yield Progress(done, len(ranges), N_("Unpacking into a temporary file"))
        volume = _volume_of(source, array)
        if scratch.folder is None:  # for a copy without what lies outside of the scanner's circle
            scratch = ScratchArrays(scratch_folder())
        return scan_of(volume, (yield from slice_images(volume)), scratch, outside)
    except BaseException:
        scratch.close()
        raise


def slice_images(volume: Volume) -> Generator[Step, None, SliceImages]:
    copy = yield from as_events(coarse_copy(volume), _reading_events)
    return SliceImages(volume.array, *copy)


def _reading_events(count: tuple[int, int]) -> Iterator[Step]:
    done, total = count
    if done % 16 == 0:
        yield Progress(done, total, N_("Reading the slices"))


def _n_bytes(source: SliceSource) -> int:
    return _n_voxels(source) * source.dtype.itemsize


def _n_voxels(source: SliceSource) -> int:
    return math.prod(int(edge) for edge in source.shape)


def _subsample(array: NDArray[Any]) -> NDArray[Any]:
    """Every n-th voxel of each axis, so that not many more than `_SAMPLED` remain."""
    step = _subsample_step(array)
    return array[::step, ::step, ::step]


def _subsample_step(array: NDArray[Any]) -> int:
    return max(1, int(np.ceil((array.size / _SAMPLED) ** (1 / 3))))


def segment_volume(
    source: SliceSource,
    settings: SegmentationSettings,
    scratch: ScratchArrays | None = None,
    run: ParallelMap = map,
    outside: ScanOutside | None = None,
) -> Steps:
    """Find the grains in grey values; returns a ``Segmentation``. As :func:`segmentation_steps`."""
    return (yield from reported(segmentation_steps(source, settings, scratch, run, outside)))


def reported(steps: Generator[SegmentationProgress, None, _Result]) -> Generator[Step, None, _Result]:
    """The steps as events."""
    stage = ""
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            result: _Result = end.value
            return result
        if step.stage != stage:
            stage = step.stage
            yield Started(stage, step.total)
        yield Progress(step.done, step.total)
