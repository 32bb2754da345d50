"""Jobs of classifiers: of voxels (train on labels or strokes, write maps), and of segmented objects."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import IntArray
from regolith_studio.imaging.label_files import write_label_file, write_probability_file
from regolith_studio.imaging.segmentation.classifier_document import objects_document, training_document
from regolith_studio.imaging.segmentation.object_classifier import (
    OBJECT_CLASSES,
    ObjectAction,
    ObjectTable,
    ObjectTraining,
    classify_objects,
    describe_objects,
    suspect_objects,
    train_on_examples,
)
from regolith_studio.imaging.segmentation.pixel_classifier import (
    ClassifierSettings,
    PaintedLabels,
    PixelClass,
    PixelClassifier,
    TrainingSet,
    paint_from_labels,
    painted_voxels,
    probability_map,
    train,
)
from regolith_studio.imaging.segmentation.pixel_features import FeatureSettings, features_at, features_in
from regolith_studio.imaging.segmentation.scan_outside import AUTO, background_filled, find_outside
from regolith_studio.imaging.segmentation.segment import (
    Segmentation,
    SegmentationSettings,
    correction_steps,
)
from regolith_studio.imaging.segmentation.strokes import ERASER, Stroke, painted_rows
from regolith_studio.imaging.settings import ThresholdSettings
from regolith_studio.imaging.volume import Volume, box_between
from regolith_studio.imaging.volume_slabs import ScratchArrays, SliceImages, SliceSource
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.own_files import canonical_json
from regolith_studio.jobs.events import Partial, Progress, Started, Steps, as_progress
from regolith_studio.jobs.extraction_jobs import finished_slabs, unfinished_file, volume_sha256
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
from regolith_studio.readers.volumes.region import RegionSettings

S = TypeVar("S", bound=SliceSource)


def train_on_labels(
    scan: VolumeInput,
    painted: VolumeInput,
    classes: tuple[PixelClass, ...],
    settings: ClassifierSettings,
    outside: str = AUTO,
) -> Steps:
    """Train a classifier on painted voxels; returns its :class:`TrainingSet`.

    ``painted``: a volume of labels: 0 where nothing is painted, 1 for the first of `classes`, and so on.
    ``outside``: grey value outside of the scanner's circle, as :func:`find_outside` takes it.
    """
    yield Started(Message(N_("Reading {name}"), name=scan.path.name), 2)
    source, labels = scan.opened(), painted.opened()
    if source.kind != "grey":
        raise InputError(f"{scan.path.name} holds labels; a classifier is trained on grey values.")
    yield Started(N_("Training the classifier"))
    with scratch_arrays(source, scratch_folder()) as arrays:
        inside = _background_outside(source, arrays, outside)
        training = paint_from_labels(inside, labels, classes, settings, volume_sha256(scan.path))
    train(training)
    return training


def _background_outside(source: S, arrays: ScratchArrays, choice: str) -> S | Volume:
    """A scan with background outside of the scanner's circle, if there is such."""
    outside = find_outside(source, choice)
    return source if outside is None else background_filled(source, outside, ThresholdSettings(), arrays)


def map_probabilities(
    scan: VolumeInput, training: TrainingSet, path: Path, scratch: Path, outside: str = AUTO
) -> Steps:
    """Write the probability of each voxel of a scan to be grain, 0 to 255; returns the path.

    The map of a large scan goes on where an earlier call for the same file was interrupted.

    - ``path``: TIFF, NRRD, HDF5 or OME-Zarr by its suffix.
    - ``scratch``: folder for temporary files where the volume is too large for the memory.
    - ``outside``: grey value outside of the scanner's circle, as :func:`find_outside` takes it.
    """
    yield Started(Message(N_("Reading {name}"), name=scan.path.name))
    source = scan.opened()
    with ExitStack() as stack:
        arrays = stack.enter_context(scratch_arrays(source, scratch))
        whole, place = (source, volume_sha256(scan.path)), unfinished_file(path)
        arrays.checkpoint = stack.enter_context(
            finished_slabs(place, scan, RegionSettings(outside=outside), whole, training)
        )
        volume: Volume = yield from read_all(source, arrays)
        steps = probability_map(train(training), _background_outside(volume, arrays, outside), arrays)
        yield Started(N_("Predicting grains"))
        shares = yield from as_progress(steps)
        yield Started(Message(N_("Writing {name}"), name=path.name))
        for done, total in write_probability_file(path, shares):
            yield Progress(done, total)
    return path


def write_painted(scan: VolumeInput, training: TrainingSet, path: Path) -> Steps:
    """Write the painted voxels of a classifier as a volume of labels; returns the path.

    ``path``: TIFF, NRRD, HDF5 or OME-Zarr by its suffix.
    """
    yield Started(Message(N_("Writing {name}"), name=path.name))
    for done, total in write_label_file(path, PaintedLabels(training, scan.opened()), len(training.classes)):
        yield Progress(done, total)
    return path


def read_strokes(labels: VolumeInput, volume: Volume, n_classes: int, region: RegionSettings) -> Steps:
    """Read painted labels, as ilastik and label editors keep them, as strokes: a tuple of one for each class.

    - ``labels``: 0 where nothing is painted, 1 for the first class, and so on.
    - ``volume``: the region of the scan that was painted on, or the whole.
    - ``region``: applied to labels of the whole scan.
    """
    yield Started(Message(N_("Reading {name}"), name=labels.path.name))
    painted: SliceSource = labels.opened()
    if painted.shape != volume.shape:
        painted = region.of(painted)
    positions, classes = painted_voxels(painted, volume, n_classes)
    if not len(classes):
        raise InputError(f"Nothing is painted in {labels.path.name}: all its labels are 0.")
    return tuple(Stroke(positions[classes == each], int(each)) for each in np.unique(classes))


COARSE = 4
"""Of every how many pixels the first picture of a slice is made."""
Vectors = Mapping[Stroke, NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class TrainedStrokes:
    """What was learned from strokes.

    - ``training``: ``None`` while there are only grains, or none.
    - ``vectors``: features of the voxels of each stroke.
    - ``missing``: what is to be painted first, if anything: one sentence.
    """

    training: TrainingSet | None
    vectors: Vectors
    missing: str = ""


@dataclass(frozen=True, eq=False)
class SlicePrediction:
    """The probabilities of one slice.

    - ``axis``, ``number``: the slice.
    - ``probabilities``: of each class, shape (n_across, n_down, n_classes), zeros for classes that are not
      painted; of every n-th voxel in a first picture.
    - ``grain``: their sum over the classes that are grains, shape (n_across, n_down).
    """

    axis: int
    number: int
    probabilities: NDArray[np.float32]
    grain: NDArray[np.float32]


def train_on_strokes(
    volume: Volume,
    strokes: Sequence[Stroke],
    known: Vectors,
    classes: tuple[PixelClass, ...],
    settings: ClassifierSettings,
) -> Steps:
    """Train a classifier on brush strokes; returns :class:`TrainedStrokes`.

    ``known``: features of strokes of an earlier call, which are not computed again.
    """
    yield Started(N_("Training the classifier"))
    vectors = {each: _vectors_of(volume, each, known, settings.features) for each in strokes}
    positions, labels, rows = painted_rows(strokes)
    none = np.zeros((0, len(settings.features.names)), dtype=np.float32)
    features = np.concatenate([none, *(vectors[each] for each in strokes)])[rows]
    try:
        training = TrainingSet(positions, labels, features, classes, volume.voxel_size, "", settings)
    except InputError as error:
        return TrainedStrokes(None, vectors, str(error))
    train(training)
    return TrainedStrokes(training, vectors)


def _vectors_of(
    volume: Volume, stroke: Stroke, known: Vectors, features: FeatureSettings
) -> NDArray[np.float32]:
    """Known features, or new ones; the eraser's are never used."""
    if stroke.label == ERASER:
        return np.zeros((len(stroke.positions), len(features.names)), dtype=np.float32)
    return known[stroke] if stroke in known else features_at(volume, stroke.positions, features)


def predict_slices(volume: Volume, position: tuple[int, int, int], training: TrainingSet) -> Steps:
    """Predict the three slices through a voxel, each first coarsely, then in full.

    Returns their :class:`SlicePrediction`, and gives those that are known as a ``Partial`` after each.
    """
    yield Started(N_("Predicting grains"))
    classifier = train(training)
    columns = [training.classes.index(each) for each in classifier.painted]
    predictions: dict[int, SlicePrediction] = {}
    for step in (COARSE, 1):
        for axis in (2, 1, 0):
            grain, own = _slice_probabilities(volume, classifier, axis, position[axis], step)
            every = np.zeros((*grain.shape, len(training.classes)), dtype=np.float32)
            every[..., columns] = own
            predictions[axis] = SlicePrediction(axis, position[axis], every, grain)
            yield Partial(tuple(predictions.values()))
    return tuple(predictions.values())


def _slice_probabilities(
    volume: Volume, classifier: PixelClassifier, axis: int, number: int, step: int
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Of grain and of each painted class in one slice."""
    low, high, pace = [0, 0, 0], list(volume.shape), [step, step, step]
    low[axis], high[axis], pace[axis] = number, number + 1, 1
    px, py, pz = pace
    vectors = features_in(volume, box_between(low, high), classifier.features, (px, py, pz))
    own = np.take(classifier.probabilities(vectors), 0, axis)
    return classifier.grain_probability(own), own


def save_training(path: Path, training: TrainingSet | ObjectTraining, scan: Path) -> Steps:
    """Write a classifier's file with the SHA-256 of the scan that its examples are of; returns the path."""
    yield Started(Message(N_("Writing {name}"), name=path.name))
    write_training(path, replace(training, scan=volume_sha256(scan)))
    return path


def write_training(path: Path, training: TrainingSet | ObjectTraining) -> None:
    """Write the file of a classifier of voxels or of objects."""
    document = (
        training_document(training) if isinstance(training, TrainingSet) else objects_document(training)
    )
    write_bytes(path, canonical_json(document).encode("ascii"))


Examples = Sequence[tuple[tuple[int, int, int], int]]


@dataclass(frozen=True, eq=False)
class ClassifiedObjects:
    """What examples say of all objects.

    - ``training``: ``None`` while fewer than two classes have an example.
    - ``kinds``: class of each object in the order of their labels, shape (n,); empty without a training set.
    - ``missing``: what is to be chosen first, if anything: one sentence.
    """

    training: ObjectTraining | None
    kinds: IntArray
    missing: str = ""

    def counts(self) -> dict[str, int]:
        """Number of objects of each class."""
        numbers = np.bincount(self.kinds, minlength=len(OBJECT_CLASSES)).tolist()
        return dict(zip(OBJECT_CLASSES, numbers, strict=True))


def train_on_objects(given: VolumeInput, settings: GrainSettings, examples: Examples, scratch: Path) -> Steps:
    """Segment a scan and classify its objects by examples; returns :class:`ClassifiedObjects`.

    - ``settings``: of the region and the segmentation; an object classifier or edits in it are left out.
    - ``examples``: voxels in objects, in the region, each with its class.
    - ``scratch``: folder for temporary files where the volume is too large for the memory.
    """
    yield Started(Message(N_("Reading {name}"), name=given.path.name))
    source = settings.region.of(given.opened())
    if source.kind != "grey":
        raise InputError(
            f"{given.path.name} holds labels; objects are classified where grains are segmented."
        )
    with scratch_arrays(source, scratch) as arrays:
        volume: Volume = yield from read_all(source, arrays)
        segmentation: Segmentation = yield from segment_volume(
            volume,
            settings.segmentation.uncorrected,
            arrays,
            outside=find_outside(volume, settings.region.outside),
        )
        table: ObjectTable = yield from describe_grains(volume, segmentation)
        training = train_on_examples(table, segmentation.labels, examples, scan=volume_sha256(given.path))
    return ClassifiedObjects(training, classify_objects(training, table.vectors))


def describe_grains(grey: Volume, segmentation: Segmentation) -> Steps:
    """Measure all objects of a segmentation; returns their :class:`ObjectTable`."""
    yield Started(N_("Describing objects"))
    return (yield from as_progress(describe_objects(segmentation.labels, grey)))


def find_suspects(grey: Volume, found: Segmentation) -> Steps:
    """Measure all grains; returns those unlike the others, ``SuspectObject`` each."""
    table: ObjectTable = yield from describe_grains(grey, found)
    return suspect_objects(table)


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
    segmentation: Segmentation,
    settings: SegmentationSettings,
    objects: ObjectTable | None = None,
) -> Steps:
    """Apply the objects and edits of `settings` to a segmentation; returns :class:`GrainSegmentation`."""
    scratch = scratch_arrays(grey, scratch_folder())
    try:
        made: Segmentation = yield from reported(
            correction_steps(segmentation, grey, settings, scratch, objects)
        )
        if scratch.folder is None:
            return GrainSegmentation(made, SliceImages(made.labels.array), scratch)
        return GrainSegmentation(made, (yield from slice_images(made.labels)), scratch)
    except BaseException:
        scratch.close()
        raise
