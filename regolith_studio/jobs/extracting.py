"""From a volume of grey values or labels to particles (section 2.1)."""

import hashlib
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Source
from regolith_studio.imaging.extraction import (
    Extracted,
    Extraction,
    ExtractionProgress,
    ExtractionSettings,
    extraction_steps,
)
from regolith_studio.imaging.segmentation.segment import (
    Segmentation,
    SegmentationSettings,
    segmentation_steps,
)
from regolith_studio.imaging.slabs import Scratch, SlabSource
from regolith_studio.imaging.volume import VolumeKind
from regolith_studio.jobs.events import Job, Progress, Started, Step, Steps
from regolith_studio.jobs.examining import Examined, examine_one
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.jobs.grain_recipe import GrainRecipe
from regolith_studio.readers.file_bytes import sha256_of
from regolith_studio.readers.volumes.files import slice_names
from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.readers.volumes.read import SlabSource as FileSource
from regolith_studio.readers.volumes.read import open_slabs

IN_MEMORY = 2**30
"""Bytes of working arrays beyond which they lie in temporary files."""
_WORKING_BYTES = 4

Sink = Callable[[Extracted, Examined], None]


@dataclass(frozen=True)
class VolumeInput:
    """A volume as a user names it.

    Parameters
    ----------
    path
        File, or folder of slices.
    voxel_size
        One edge or three along x, y, z, in `unit`; by default what the file says.
    unit
        Of the voxel size.
    kind
        ``labels`` or ``grey``; by default guessed.
    dataset
        Which volume of a file that holds several.
    raw
        What a raw file does not say about itself.
    axes
        Of an NPY or HDF5 array, the slowest first: ``zyx`` by default.
    """

    path: Path
    voxel_size: float | Sequence[float] | None = None
    unit: str | None = None
    kind: VolumeKind | None = None
    dataset: str | None = None
    raw: RawLayout | None = None
    axes: str | None = None

    def opened(self) -> FileSource:
        """The volume, read slab by slab.

        Raises
        ------
        FileError
            If it cannot be read.
        InputError
            If nobody says how large a voxel is.
        """
        return open_slabs(
            self.path,
            dataset=self.dataset,
            axes=self.axes,
            voxel_size=self.voxel_size,
            unit=self.unit,
            kind=self.kind,
            raw=self.raw,
        )


@dataclass(frozen=True)
class SegmentationFacts:
    """What is worth keeping of a segmentation once its labels are gone."""

    level: float
    n_bodies: int
    n_grains: int
    n_small: int


@dataclass(frozen=True)
class ExtractedFile:
    """What came out of a file.

    Parameters
    ----------
    extraction
        The particles, where they were collected.
    facts
        Of the segmentation, where there was one.
    sha256
        Of the file, or of its slices one after the other.
    shape, dtype, voxel_size, kind
        Of the volume; micrometres.
    """

    extraction: Extraction
    facts: SegmentationFacts | None
    sha256: str
    shape: tuple[int, int, int]
    dtype: str
    voxel_size: tuple[float, ...]
    kind: VolumeKind


def extract_file(given: VolumeInput, recipe: GrainRecipe, scratch: Path | None = None) -> Steps:
    """Read a volume, segment it if it is grey, and make its particles; returns :class:`ExtractedFile`.

    Parameters
    ----------
    scratch
        Folder for temporary files where the volume is too large for the memory.

    Raises
    ------
    FileError
        If the file is no volume.
    InputError
        If there is no particle in it, or the voxel size is not known.
    """
    return (yield from _extracted(given, recipe, scratch, _collected, collect=True))


def extract_each(
    given: VolumeInput, recipe: GrainRecipe, scratch: Path | None, sink: Callable[[Extracted], None]
) -> Steps:
    """As :func:`extract_file`, but each particle is handed to `sink` and forgotten, in the order of slabs."""
    return (yield from _extracted(given, recipe, scratch, partial(_handed, sink=sink)))


def extract_measured(
    given: VolumeInput, recipe: GrainRecipe, scratch: Path | None, sink: Sink, workers: int | Executor = 1
) -> Steps:
    """As :func:`extract_file`, but each particle is measured, handed to `sink` and forgotten.

    Parameters
    ----------
    sink
        Called in this process with each particle in the order of slabs.
    workers
        Processes that measure.
    """
    return (yield from _extracted(given, recipe, scratch, partial(_measured, sink=sink, workers=workers)))


def segment_volume(
    source: SlabSource, settings: SegmentationSettings, scratch: Scratch | None = None
) -> Steps:
    """Find the grains in grey values; returns a ``Segmentation``."""
    steps = segmentation_steps(source, settings, scratch)
    stage = ""
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            return end.value
        if step.stage != stage:
            stage = step.stage
            yield Started(stage, step.total)
        yield Progress(step.done, step.total)


def extract_labels(
    labels: SlabSource, settings: ExtractionSettings, path: Path, grey: SlabSource | None = None
) -> Steps:
    """Particles of a label volume, in memory or not, that `path` has led to; returns an ``Extraction``.

    They are what :func:`extract_file` makes of the file, if it held the values `grey`.
    """
    yield Started("Extracting particles")
    source = _source(path, labels)
    return (yield from _collected(extraction_steps(labels, settings, path.stem, source, grey=grey)))


def _source(path: Path, volume: SlabSource) -> Source:
    edges = "x".join(f"{float(edge):g}" for edge in np.ravel(np.asarray(volume.voxel_size)))
    return Source(str(path), fingerprint(path), f"voxel:{edges}")


def fingerprint(path: Path) -> str:
    """SHA-256 of a file, or of the slices of a folder one after the other."""
    names = slice_names(path) if path.is_dir() else ()
    if not names:
        return sha256_of(path)
    digest = hashlib.sha256()
    for name in names:
        digest.update(bytes.fromhex(sha256_of(path / name)))
    return digest.hexdigest()


_Extracting = Generator[ExtractionProgress, None, Extraction]
_Consumer = Callable[[_Extracting], Generator[Step, None, Extraction]]


def _extracted(
    given: VolumeInput, recipe: GrainRecipe, folder: Path | None, consume: _Consumer, *, collect: bool = False
) -> Steps:
    yield Started(f"Reading {given.path.name}")
    volume = given.opened()
    sizes = tuple(float(edge) for edge in np.ravel(np.asarray(volume.voxel_size)))
    source = _source(given.path, volume)
    with Scratch(folder if _working_bytes(volume) > IN_MEMORY else None) as scratch:
        facts: SegmentationFacts | None = None
        labels: SlabSource = volume
        if volume.kind == "grey":
            segmentation: Segmentation = yield from segment_volume(volume, recipe.segmentation, scratch)
            facts, labels = _facts(segmentation), segmentation.labels
            del segmentation
        yield Started("Extracting particles")
        grey = volume if volume.kind == "grey" else None
        steps = extraction_steps(labels, recipe.extraction, given.path.stem, source, collect, grey)
        extraction = yield from consume(steps)
    if not extraction.n_found:
        raise InputError(_nothing_found(given.path, extraction))
    return ExtractedFile(
        extraction, facts, source.sha256, volume.shape, str(volume.dtype), sizes, volume.kind
    )


def _handed(steps: _Extracting, sink: Callable[[Extracted], None]) -> Generator[Step, None, Extraction]:
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            found: Extraction = end.value
            return found
        sink(step.extracted)
        yield Progress(step.done, step.total, step.extracted.particle.name)


def _collected(steps: _Extracting) -> Generator[Step, None, Extraction]:
    return (yield from _handed(steps, lambda _particle: None))


def _measured(steps: _Extracting, sink: Sink, workers: int | Executor) -> Generator[Step, None, Extraction]:
    """Measure particles by other processes while the next ones are extracted."""
    waiting: deque[ExtractionProgress] = deque()
    ended: list[Extraction] = []

    def jobs() -> Iterator[Job]:
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                ended.append(end.value)
                return
            waiting.append(step)
            yield Job(examine_one, (step.extracted.particle,))

    with open_executor(workers) as executor:
        for result in executor.results(jobs()):
            if result is None:
                continue
            step = waiting.popleft()
            sink(step.extracted, value_of(result))
            yield Progress(step.done, step.total, step.extracted.particle.name)
    return ended[0]


def _working_bytes(volume: SlabSource) -> int:
    voxels = int(np.prod([int(edge) for edge in volume.shape]))
    return voxels * (_WORKING_BYTES + volume.dtype.itemsize) if volume.kind == "grey" else 0


def _facts(segmentation: Segmentation) -> SegmentationFacts:
    return SegmentationFacts(
        segmentation.level, segmentation.n_bodies, segmentation.n_grains, segmentation.n_small
    )


def _nothing_found(path: Path, extraction: Extraction) -> str:
    counts = f"{len(extraction.border)} touch the border, {len(extraction.small)} are too small"
    return (
        f"None of the grains of {path.name} became a particle ({counts}); keep grains at the border, "
        "take smaller ones, or say whether the volume holds labels or grey values."
    )
