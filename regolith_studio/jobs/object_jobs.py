"""Jobs of the object step: describe segmented objects, classify them by examples, and correct labels."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import IntArray
from regolith_studio.imaging.segmentation.classifier_document import objects_document
from regolith_studio.imaging.segmentation.object_classifier import (
    OBJECT_CLASSES,
    ObjectAction,
    ObjectTable,
    ObjectTraining,
    classify_objects,
    describe_objects,
    train_on_examples,
)
from regolith_studio.imaging.segmentation.scan_outside import find_outside
from regolith_studio.imaging.segmentation.segment import (
    Segmentation,
    SegmentationSettings,
    correction_steps,
)
from regolith_studio.imaging.slice_images import SliceImages
from regolith_studio.imaging.volume import Volume
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.json_text import canonical_json
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.extraction_jobs import volume_sha256
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.scan_jobs import (
    GrainSegmentation,
    read_all,
    reported,
    scratch_arrays,
    scratch_folder,
    segment_volume,
    slice_images,
)
from regolith_studio.messages import N_, Message

Examples = Sequence[tuple[tuple[int, int, int], int]]


@dataclass(frozen=True, eq=False)
class ClassifiedObjects:
    """What examples say of all objects.

    Parameters
    ----------
    training
        ``None`` while fewer than two classes have an example.
    kinds
        Class of each object in the order of their labels, shape (n,); empty without a training set.
    missing
        What is to be chosen first, if anything: one sentence.
    """

    training: ObjectTraining | None
    kinds: IntArray
    missing: str = ""

    def counts(self) -> dict[str, int]:
        """Number of objects of each class."""
        found = np.bincount(self.kinds, minlength=len(OBJECT_CLASSES)).tolist()
        return dict(zip(OBJECT_CLASSES, found, strict=True))


def train_on_objects(given: VolumeInput, settings: GrainSettings, examples: Examples, scratch: Path) -> Steps:
    """Segment a scan and classify its objects by examples; returns :class:`ClassifiedObjects`.

    Parameters
    ----------
    settings
        Of the region and the segmentation; an object classifier or edits in it are left out.
    examples
        Voxels in objects, in the region, each with its class.
    scratch
        Folder for temporary files where the volume is too large for the memory.

    Raises
    ------
    FileError
        If the scan is no volume.
    InputError
        If it holds labels, a voxel lies in no object, or fewer than two classes have an example.
    """
    yield Started(Message(N_("Reading {name}"), name=given.path.name))
    source = settings.region.of(given.opened())
    if source.kind != "grey":
        raise InputError(
            f"{given.path.name} holds labels; objects are classified where grains are segmented."
        )
    with scratch_arrays(source, scratch) as arrays:
        volume: Volume = yield from read_all(source, arrays)
        found: Segmentation = yield from segment_volume(
            volume,
            settings.segmentation.uncorrected,
            arrays,
            outside=find_outside(volume, settings.region.outside),
        )
        table: ObjectTable = yield from describe_grains(volume, found)
        training = train_on_examples(table, found.labels, examples, scan=volume_sha256(given.path))
    return ClassifiedObjects(training, classify_objects(training, table.vectors))


def describe_grains(grey: Volume, found: Segmentation) -> Steps:
    """Measure all objects of a segmentation; returns their :class:`ObjectTable`."""
    yield Started(N_("Describing objects"))
    steps = describe_objects(found.labels, grey)
    while True:
        try:
            yield Progress(*next(steps))
        except StopIteration as end:
            return end.value


def classify_grains(
    table: ObjectTable, labels: Volume, examples: Examples, actions: tuple[ObjectAction, ...]
) -> Steps:
    """Classify all objects by examples; returns :class:`ClassifiedObjects`."""
    yield Started(N_("Classifying objects"))
    try:
        training = train_on_examples(table, labels, examples, actions)
    except InputError as error:
        return ClassifiedObjects(None, np.zeros(0, dtype=np.int64), str(error))
    return ClassifiedObjects(training, classify_objects(training, table.vectors))


def correct_grains(
    grey: Volume,
    found: Segmentation,
    settings: SegmentationSettings,
    objects: ObjectTable | None = None,
) -> Steps:
    """Apply the objects and edits of `settings` to a segmentation; returns :class:`GrainSegmentation`.

    Raises
    ------
    InputError
        If an edit does not find its grains, or no grain is left.
    """
    scratch = scratch_arrays(grey, scratch_folder())
    try:
        made: Segmentation = yield from reported(correction_steps(found, grey, settings, scratch, objects))
        if scratch.folder is None:
            return GrainSegmentation(made, SliceImages(made.labels.array), scratch)
        return GrainSegmentation(made, (yield from slice_images(made.labels)), scratch)
    except BaseException:
        scratch.close()
        raise


def save_objects(path: Path, training: ObjectTraining, scan: Path) -> Steps:
    """Write the file of an object classifier with the SHA-256 of the scan of its examples; returns the path.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    yield Started(Message(N_("Writing {name}"), name=path.name))
    write_objects(path, replace(training, scan=volume_sha256(scan)))
    return path


def write_objects(path: Path, training: ObjectTraining) -> None:
    """Write the file of an object classifier.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    write_bytes(path, canonical_json(objects_document(training)).encode("ascii"))
