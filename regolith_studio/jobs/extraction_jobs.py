"""Jobs that make particles of volumes (section 2.1): read, segment, contour, measure, write their labels."""

import hashlib
import math
import shutil
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from regolith_studio.dataset.build import software_versions
from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.particle import Source
from regolith_studio.imaging.extraction import (
    ExtractedParticle,
    Extraction,
    ExtractionProgress,
    LabelSelection,
    extraction_steps,
    select_labels,
)
from regolith_studio.imaging.label_files import write_label_file
from regolith_studio.imaging.segmentation.classifier_document import training_document
from regolith_studio.imaging.segmentation.pixel_classifier import TrainingSet, train
from regolith_studio.imaging.segmentation.scan_outside import find_outside
from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.imaging.segmentation.thresholding import hidden_class
from regolith_studio.imaging.settings import ExtractionSettings, ThresholdSettings
from regolith_studio.imaging.volume import Volume, VolumeKind
from regolith_studio.imaging.volume_slabs import ScratchArrays, SliceSource
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.checkpoint import Checkpoint
from regolith_studio.io.own_files import canonical_json
from regolith_studio.io.tables import Column, Table, csv_text
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.particle_jobs import MeasuredParticle, measure_particle
from regolith_studio.jobs.scan_jobs import read_all, scratch_arrays, scratch_folder, segment_volume
from regolith_studio.messages import N_, Message
from regolith_studio.readers.sandbox.parent import sha256_of
from regolith_studio.readers.volumes.files import member_folder, member_names
from regolith_studio.readers.volumes.region import RegionSettings
from regolith_studio.steps import as_events


def write_labels(labels: Volume, settings: ExtractionSettings, path: Path, segmented: bool) -> Steps:
    """Write a label volume, and the table of its labels beside it; returns the path of the table.

    ``settings``, ``segmented``: which labels become particles, as for ``select_labels``. ``path``: a name
    that ends in one of ``LABEL_SUFFIXES``; the table has the same name with ``.csv``.
    """
    yield Started(Message(N_("Writing labels to {name}"), name=path.name))
    chosen = select_labels(labels, settings, segmented)
    for done, total in write_label_file(path, labels, max(chosen.boxes)):
        yield Progress(done, total)
    table = label_names_file(path)
    write_bytes(table, csv_text(label_names(chosen)).encode("utf-8"))
    return table


def label_names_file(path: Path) -> Path:
    """The table that is written beside a file of labels."""
    return path.with_suffix(".csv")


def label_names(chosen: LabelSelection) -> Table:
    """The particle of each label, or why it became none, and its number of voxels."""
    left_out = dict.fromkeys(chosen.border, "border") | dict.fromkeys(chosen.small, "small")
    columns = (Column("label"), Column("particle"), Column("left_out"), Column("voxels"))
    rows = tuple(
        (label, None if label in left_out else chosen.name_of(label), left_out.get(label), count)
        for label, count in sorted(chosen.sizes.items())
    )
    return Table(N_("Particles of labels"), columns, rows)


_Made = TypeVar("_Made")


@dataclass(frozen=True)
class SegmentationSummary:
    """What is worth keeping of a segmentation once its labels are gone."""

    level: float
    n_bodies: int
    n_grains: int
    n_small: int
    n_not_finite: int


@dataclass(frozen=True)
class ExtractedFile:
    """What came out of a file.

    - ``extraction``: the particles, where they were collected.
    - ``facts``: of the segmentation, where there was one.
    - ``sha256``: of the file, or of its slices one after the other.
    - ``shape``, ``dtype``, ``voxel_size``, ``kind``: of the volume; micrometres.
    - ``notes``: sentences about the file and its segmentation that a user should read.
    """

    extraction: Extraction
    facts: SegmentationSummary | None
    sha256: str
    shape: tuple[int, int, int]
    dtype: str
    voxel_size: tuple[float, ...]
    kind: VolumeKind
    notes: tuple[str, ...] = ()


def extract_file(given: VolumeInput, recipe: GrainSettings, scratch: Path | None = None) -> Steps:
    """Read a volume, segment it if it is grey, and make its particles; returns :class:`ExtractedFile`.

    ``scratch``: folder for temporary files where the volume is too large for the memory.
    """
    return (yield from _extract(given, recipe, scratch, Executor()))


def extract_each(
    given: VolumeInput,
    recipe: GrainSettings,
    scratch: Path | None,
    make: Callable[[ExtractedParticle], _Made],
    sink: Callable[[_Made], None],
    workers: int | Executor = 1,
) -> Steps:
    """As :func:`extract_file`, but no particle is kept.

    - ``make``: applied to each particle where it is made, maybe in another process; picklable.
    - ``sink``: called in this process with what `make` returns, in the order of labels.
    - ``workers``: processes, or an executor. Other processes than this one read the volume and the temporary
      files themselves; a cluster's must find both under the same paths.
    """
    with open_executor(workers) as executor:
        return (yield from _extract(given, recipe, scratch, executor, make, sink))


def extract_measured(
    given: VolumeInput,
    recipe: GrainSettings,
    scratch: Path | None,
    make: Callable[[ExtractedParticle, MeasuredParticle], _Made],
    sink: Callable[[_Made], None],
    workers: int | Executor = 1,
    labels_file: Path | None = None,
    unfinished: Path | None = None,
) -> Steps:
    """As :func:`extract_each`, but each particle is measured where it is made.

    - ``make``: as in :func:`extract_each`, of a particle and what was measured of it.
    - ``labels_file``: where to write the label volume, if anywhere (:func:`write_labels`).
    - ``unfinished``: where to keep finished slabs of the map that a classifier makes of a large scan, if
      anywhere; the same call goes on from there after an interruption.
    """
    yield from compile_first("describe")
    measure = partial(_made_of_measured, make)
    with open_executor(workers) as executor:
        return (yield from _extract(given, recipe, scratch, executor, measure, sink, labels_file, unfinished))


def _made_of_measured(
    make: Callable[[ExtractedParticle, MeasuredParticle], _Made], extracted: ExtractedParticle
) -> _Made:
    return make(extracted, measure_particle(extracted.particle))


def extract_labels(
    labels: Volume, settings: ExtractionSettings, path: Path, grey: Volume | None = None
) -> Steps:
    """Particles of a label volume, in memory or not, that `path` has led to; returns an ``Extraction``.

    They are what :func:`extract_file` makes of the file, if it held the values `grey`.
    """
    yield from compile_first("scan")
    yield Started(N_("Extracting particles"))
    source = _source_of(path, labels)
    return (yield from _handed_over(extraction_steps(labels, settings, path.stem, source, grey=grey)))


def _source_of(path: Path, volume: SliceSource) -> Source:
    edges = "x".join(f"{float(edge):g}" for edge in np.ravel(np.asarray(volume.voxel_size)))
    return Source(str(path), volume_sha256(path), f"voxel:{edges}")


def volume_sha256(path: Path) -> str:
    """SHA-256 of a file, or of the files of a folder that are one volume one after the other."""
    names = member_names(path)
    if not names:
        return sha256_of(path)
    digest = hashlib.sha256()
    for name in names:
        digest.update(bytes.fromhex(sha256_of(member_folder(path) / name)))
    return digest.hexdigest()


def _extract(
    given: VolumeInput,
    recipe: GrainSettings,
    folder: Path | None,
    executor: Executor,
    make: Callable[[ExtractedParticle], Any] | None = None,
    sink: Callable[[Any], None] | None = None,
    labels_file: Path | None = None,
    unfinished: Path | None = None,
) -> Steps:
    yield from compile_first("scan")
    yield Started(Message(N_("Reading {name}"), name=given.path.name))
    file = given.opened()
    source, notes = recipe.region.of(file), list(file.notes)
    run = map if executor.in_this_thread else executor.map
    origin = _source_of(given.path, source)
    with ExitStack() as stack:
        scratch = stack.enter_context(_scratch(source, given.path, folder, executor))
        training = recipe.segmentation.classifier if source.kind == "grey" else None
        scratch.checkpoint = stack.enter_context(
            finished_slabs(unfinished, given, recipe.region, (source, origin.sha256), training)
        )
        volume: Volume = yield from read_all(source, scratch, run)
        facts: SegmentationSummary | None = None
        labels, grey = volume, None
        if volume.kind == "grey":
            outside = find_outside(volume, recipe.region.outside)
            segmentation: Segmentation = yield from segment_volume(
                volume, recipe.segmentation, scratch, run, outside
            )
            facts = _summary_of(segmentation)
            notes += _notes_of(segmentation, recipe.segmentation.threshold)
            labels, grey = segmentation.labels, volume
            del segmentation
        if labels_file is not None:
            yield from write_labels(labels, recipe.extraction, labels_file, grey is not None)
        yield Started(N_("Extracting particles"))
        group = given.group or given.path.stem
        steps = extraction_steps(labels, recipe.extraction, group, origin, make, grey, run)
        extraction = yield from _handed_over(steps, sink)
    if not extraction.n_found:
        raise InputError(_no_particle_message(given.path, extraction))
    sizes = tuple(volume.voxel_size.tolist())
    return ExtractedFile(
        extraction,
        facts,
        origin.sha256,
        volume.shape,
        str(volume.dtype),
        sizes,
        volume.kind,
        tuple(notes),
    )


def _scratch(source: SliceSource, path: Path, folder: Path | None, executor: Executor) -> ScratchArrays:
    """Arrays for what is computed from a volume, in files that all workers see if there are several."""
    if executor.in_this_thread:
        return scratch_arrays(source, folder)
    scratch = ScratchArrays(folder or scratch_folder())
    try:
        if scratch.folder is not None:
            executor.check_shared(path, scratch.folder)
    except BaseException:
        scratch.close()
        raise
    return scratch


def _handed_over(
    steps: Generator[ExtractionProgress, None, Extraction], sink: Callable[[Any], None] | None = None
) -> Generator[Step, None, Extraction]:
    """The steps as events; what was made is given to `sink` before."""

    def events_of(step: ExtractionProgress) -> Iterator[Step]:
        if sink is not None:
            sink(step.made)
        yield Progress(step.done, step.total, step.name)

    return as_events(steps, events_of)


def _summary_of(segmentation: Segmentation) -> SegmentationSummary:
    return SegmentationSummary(
        segmentation.level,
        segmentation.n_bodies,
        segmentation.n_grains,
        segmentation.n_small,
        segmentation.n_not_finite,
    )


def _notes_of(segmentation: Segmentation, threshold: ThresholdSettings) -> Iterator[str]:
    if segmentation.n_not_finite:
        count = segmentation.n_not_finite
        yield f"{count:,} voxels hold no finite number (NaN or infinity) and are in no grain."
    if segmentation.outside is not None:
        yield segmentation.outside.hint_label
    hidden = hidden_class(segmentation.seen, segmentation.level, threshold)
    if hidden is not None:
        first, second, gap = hidden
        yield (
            f"The voxels that are no grain at {segmentation.level:g} are of two kinds, about {first:g} and "
            f"{second:g}: if the latter are grains, take --threshold {gap:g} or multi-otsu."
        )


def _no_particle_message(path: Path, extraction: Extraction) -> str:
    counts = f"{len(extraction.border)} touch the border, {len(extraction.small)} are too small"
    return (
        f"None of the grains of {path.name} became a particle ({counts}); keep grains at the border, "
        "take smaller ones, or say whether the volume holds labels or grey values."
    )


RESUMABLE_VOXELS = 2**26
"""Voxels of a scan from which on finished slabs of its map are kept: half a minute of work."""


def unfinished_file(output: Path) -> Path:
    """Where finished slabs are kept until a file or folder is complete: in a folder beside it."""
    return output.with_name(f"{output.name}.unfinished") / "map.sqlite"


@contextmanager
def finished_slabs(
    path: Path | None,
    scan: VolumeInput,
    region: RegionSettings,
    source: tuple[SliceSource, str],
    training: TrainingSet | None,
) -> Iterator[Checkpoint | None]:
    """The finished slabs of a map, or none of a small scan or where nothing is kept or classified.

    The folder of the file is removed when the block ends without an exception. A file about another scan,
    region, classifier or version of the libraries is begun anew, and so is a damaged one.

    - ``path``: as :func:`unfinished_file` gives it; none where nothing is kept.
    - ``source``: the region of the scan, and the SHA-256 of the scan.
    - ``training``: of the classifier, if there is one.
    """
    volume, sha256 = source
    if path is None or training is None or math.prod(volume.shape) < RESUMABLE_VOXELS:
        yield None
        return
    train(training)
    subject = {
        "scan": sha256,
        "part of the scan": repr((scan.dataset, scan.axes, scan.raw, region, volume.shape)),
        "classifier": hashlib.sha256(canonical_json(training_document(training)).encode()).hexdigest(),
        "set of program versions": software_versions() | {"scikit-learn": version("scikit-learn")},
    }
    try:
        checkpoint = Checkpoint.resume(path, subject) if path.exists() else Checkpoint.create(path, subject)
    except FileError:
        checkpoint = Checkpoint.create(path, subject)
    with checkpoint:
        yield checkpoint
    shutil.rmtree(path.parent, ignore_errors=True)
