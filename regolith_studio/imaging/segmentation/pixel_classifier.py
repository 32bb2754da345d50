"""Supervised segmentation (section 2.1): a classifier of voxels, trained on those that somebody has painted.

The classifier is a small network or a logistic regression of scikit-learn on the features of
:mod:`~regolith_studio.imaging.segmentation.pixel_features`. A network of one small layer reaches the voxel
IoU of a hundred trees and predicts many times faster.
"""

import warnings
from collections.abc import Generator
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats, locked_integers
from regolith_studio.imaging.segmentation.pixel_features import (
    FeatureSettings,
    block_features,
    features_at,
    features_in,
)
from regolith_studio.imaging.volume import Box, Origin, Volume, VolumeKind, box_between
from regolith_studio.imaging.volume_slabs import (
    ParallelMap,
    ScratchArrays,
    SharedArray,
    SliceSource,
    ThickSlab,
    slab_ranges,
)
from regolith_studio.io.checkpoint import Checkpoint, CheckpointRecord
from regolith_studio.messages import N_

ClassifierKind = Literal["network", "logistic"]
CLASSIFIER_KINDS: tuple[ClassifierKind, ...] = get_args(ClassifierKind)
MAX_CLASSES = 8
MAX_PER_CLASS = 5_000
"""Painted voxels of a class that a classifier is trained on; of more, so many are drawn."""

_MAP = "probabilities"
_TILE = 128
_SLAB_VOXELS = 2**22
_ITERATIONS = 300
"""Of the optimisation; on strokes over a shipped slice 970 lower the loss by 0.4 % more."""


@dataclass(frozen=True)
class PixelClass:
    """What a voxel can be: its name, and whether it belongs to a grain."""

    name: str
    is_grain: bool


USUAL_CLASSES = (PixelClass("background", False), PixelClass("grain", True))


@dataclass(frozen=True)
class ClassifierSettings:
    """How a classifier of voxels is made.

    - ``features``: what it sees of a voxel.
    - ``kind``: ``network`` has one layer of `hidden` units and can tell apart classes of several
      brightnesses; ``logistic`` regression needs the fewest painted voxels and draws straight limits between
      classes.
    - ``hidden``: hidden units of the network.
    - ``regularisation``: weight of the penalty on the square of the coefficients.
    - ``seed``: of the first coefficients of the network, and of the choice among too many painted voxels.
    """

    features: FeatureSettings = field(default_factory=FeatureSettings)
    kind: ClassifierKind = "network"
    hidden: int = 32
    # Measured: with second derivatives and this, ten strokes on the second shipped scan have an IoU of .953,
    # before .941; the derivatives alone gain less.
    regularisation: float = 10.0
    seed: int = 0

    def __post_init__(self) -> None:
        if self.kind not in CLASSIFIER_KINDS:
            raise InputError(f"A classifier is one of {', '.join(CLASSIFIER_KINDS)}, not {self.kind!r}.")
        if self.hidden not in range(1, 257):
            raise InputError(f"The network has 1 to 256 hidden units, got {self.hidden}.")
        if not 0.0 < self.regularisation <= 1e6:
            raise InputError(f"The regularisation lies between 0 and 1e6, got {self.regularisation}.")
        if self.seed not in range(2**32):
            raise InputError(f"The seed is a whole number from 0 to 2^32 - 1, got {self.seed}.")


@dataclass(frozen=True, eq=False)
class TrainingSet(LockedRecord):
    """Painted voxels with their features: all that a classifier is trained from.

    - ``positions``: voxels along x, y, z, shape (n, 3).
    - ``labels``: class of each, from 0, shape (n,).
    - ``vectors``: their features, shape (n, n_features).
    - ``classes``: what the labels mean.
    - ``voxel_size``: edges of a voxel along x, y and z, in micrometres, shape (3,).
    - ``scan``: SHA-256 of the scan, or empty.
    - ``settings``: of the features and of the classifier.

    Raises InputError if fewer than two classes are painted, or none of those that are grains or of those
    that are not.
    """

    positions: IntArray
    labels: IntArray
    vectors: NDArray[np.float32]
    classes: tuple[PixelClass, ...]
    voxel_size: FloatArray
    scan: str = ""
    settings: ClassifierSettings = field(default_factory=ClassifierSettings)

    def __post_init__(self) -> None:
        positions = locked_integers(self.positions, (None, 3), "positions")
        labels = locked_integers(self.labels, (len(positions),), "labels")
        n_features = len(self.settings.features.names)
        vectors = np.array(self.vectors, dtype=np.float32)
        if vectors.shape != (len(positions), n_features) or not np.isfinite(vectors).all():
            raise InputError(
                f"{len(positions)} painted voxels need {n_features} finite features each, got an array of "
                f"shape {vectors.shape}."
            )
        if len(labels) and not 0 <= labels.min() <= labels.max() < len(self.classes):
            raise InputError(f"Painted voxels belong to classes 0 to {len(self.classes) - 1}.")
        _check_painted(labels, self.classes)
        vectors.flags.writeable = False
        sizes = locked_floats(self.voxel_size, (3,), "voxel_size")
        for name, value in (
            ("positions", positions), ("labels", labels), ("vectors", vectors), ("voxel_size", sizes)
        ):  # fmt: skip
            object.__setattr__(self, name, value)


def _check_painted(labels: IntArray, classes: tuple[PixelClass, ...]) -> None:
    painted = [classes[k] for k in np.unique(labels)]
    if not painted:
        raise InputError(
            N_("Nothing is painted yet: paint some voxels of grains and some of what is between them.")
        )
    if all(each.is_grain for each in painted):
        raise InputError(N_("Only grains are painted; paint some of what is between them, too."))
    if not any(each.is_grain for each in painted):
        raise InputError(N_("No grain is painted; paint some voxels of grains, too."))


def paint_from_labels(
    source: SliceSource,
    painted: SliceSource,
    classes: tuple[PixelClass, ...] = USUAL_CLASSES,
    settings: ClassifierSettings | None = None,
    scan: str = "",
) -> TrainingSet:
    """The training set of a volume of painted labels, as ilastik and label editors keep them.

    ``painted``: 0 where nothing is painted, 1 for the first of `classes`, and so on. ``scan``: SHA-256 of
    the scan.

    Raises InputError if the two volumes differ in size, or as :class:`TrainingSet`.
    """
    settings = settings or ClassifierSettings()
    positions, labels = painted_voxels(painted, source, len(classes), settings.seed)
    vectors = features_at(source, positions, settings.features)
    sizes = np.asarray(source.voxel_size, dtype=np.float64)
    return TrainingSet(positions, labels, vectors, classes, sizes, scan, settings)


def painted_voxels(
    painted: SliceSource, scan: SliceSource, n_classes: int, seed: int = 0
) -> tuple[IntArray, IntArray]:
    """Voxels of a volume of painted labels, shape (n, 3), and the class of each, from 0, shape (n,).

    At most :data:`MAX_PER_CLASS` of each class, drawn at random where there are more.

    Raises InputError if it differs from the scan in size, or holds more classes.
    """
    if tuple(painted.shape) != tuple(scan.shape):
        raise InputError(
            f"{painted.name} has {painted.shape} voxels, but {scan.name} has {scan.shape}; "
            "paint on this scan."
        )
    places: list[tuple[IntArray, IntArray]] = []
    for first, stop in slab_ranges(painted.shape):
        slab = painted.read(first, stop)
        where = np.stack(np.nonzero(slab), axis=-1)
        places.append((where + np.array([0, 0, first]), slab[tuple(where.T)].astype(np.int64) - 1))
    positions, labels = (np.concatenate([each[k] for each in places]) for k in (0, 1))
    if len(labels) and not 0 <= labels.min() <= labels.max() < n_classes:
        wrong = labels.max() if labels.max() >= n_classes else labels.min()
        raise InputError(f"{painted.name} holds label {wrong + 1}; classes are 1 to {n_classes}.")
    kept = _at_most(labels, seed)
    return positions[kept], labels[kept]


@dataclass(frozen=True, eq=False)
class PaintedLabels:
    """The painted voxels of a training set as a volume of labels, read slab by slab: 1 for the first class.

    ``training``: holds the painted voxels. ``scan``: the volume that they were painted on.

    Raises InputError if the volume has voxels of another size than those that were painted, or ends before
    them.
    """

    training: TrainingSet
    scan: SliceSource
    kind: VolumeKind = "labels"

    def __post_init__(self) -> None:
        check_voxel_size(self.training.voxel_size, self.scan)
        if not (self.training.positions < np.array(self.scan.shape)).all():
            raise InputError(f"Painted voxels lie outside of {self.scan.name} of {self.scan.shape} voxels.")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along x, y and z."""
        return self.scan.shape

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of a voxel."""
        return np.dtype(np.uint8)

    @property
    def voxel_size(self) -> FloatArray:
        """Edges of a voxel along x, y and z in micrometres."""
        return self.training.voxel_size

    @property
    def origin(self) -> Origin:
        """That of the scan."""
        return self.scan.origin

    @property
    def name(self) -> str:
        """That of the scan."""
        return self.scan.name

    def read(self, z0: int, z1: int, /) -> NDArray[np.uint8]:
        """The slices ``z0 <= z < z1``, shape (nx, ny, z1 - z0)."""
        slab = np.zeros((*self.shape[:2], z1 - z0), np.uint8, order="F")
        positions = self.training.positions
        here = (positions[:, 2] >= z0) & (positions[:, 2] < z1)
        slab[tuple((positions[here] - (0, 0, z0)).T)] = self.training.labels[here] + 1
        return slab

    def parts(self) -> list[tuple[int, int]]:
        """None: what is painted is in memory."""
        return []


def _at_most(labels: IntArray, seed: int) -> IntArray:
    """Rows of at most :data:`MAX_PER_CLASS` voxels of each class, in their order."""
    rng, rows = np.random.default_rng(seed), []
    for each in np.unique(labels):
        own = np.flatnonzero(labels == each)
        rows.append(own if len(own) <= MAX_PER_CLASS else rng.choice(own, MAX_PER_CLASS, replace=False))
    return np.sort(np.concatenate(rows)) if rows else np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class PixelClassifier:
    """A trained classifier.

    - ``pipeline``: of scikit-learn.
    - ``painted``: the classes that were painted, in the order of the pipeline's probabilities.
    - ``voxel_size``: that it was trained at, in micrometres, shape (3,).
    - ``features``: what it sees of a voxel.
    """

    pipeline: Any
    painted: tuple[PixelClass, ...]
    voxel_size: FloatArray
    features: FeatureSettings

    def probabilities(self, vectors: NDArray[np.float32]) -> NDArray[np.float32]:
        """Of each painted class, shape (..., n_classes), for features of shape (..., n_features)."""
        rows = vectors.reshape(-1, vectors.shape[-1])
        shares = self.pipeline.predict_proba(rows).astype(np.float32)
        return np.asarray(shares.reshape(*vectors.shape[:-1], len(self.painted)))

    def grain_probability(self, probabilities: NDArray[np.float32]) -> NDArray[np.float32]:
        """Sum over the classes that are grains, for probabilities of shape (..., n_classes)."""
        is_grain = np.array([each.is_grain for each in self.painted])
        return np.asarray(probabilities[..., is_grain].sum(axis=-1))


@lru_cache(maxsize=4)
def train(training: TrainingSet) -> PixelClassifier:
    """Train a classifier; the same training set gives the same one.

    Each class weighs the same, however much of it is painted.

    Raises MissingRequirement if scikit-learn is not installed.
    """
    painted, labels, counts = np.unique(training.labels, return_inverse=True, return_counts=True)
    weights = len(labels) / (len(painted) * counts[labels])
    pipeline = _pipeline(training.settings)
    name = pipeline.steps[-1][0]
    with warnings.catch_warnings():  # that the last iteration was reached is meant
        warnings.simplefilter("ignore")
        pipeline.fit(training.vectors.astype(np.float64), labels, **{f"{name}__sample_weight": weights})
    classes = tuple(training.classes[k] for k in painted)
    return PixelClassifier(pipeline, classes, training.voxel_size, training.settings.features)


def _pipeline(settings: ClassifierSettings) -> Any:
    try:
        from sklearn.linear_model import LogisticRegression
        from sklearn.neural_network import MLPClassifier
        from sklearn.pipeline import make_pipeline
        from sklearn.preprocessing import StandardScaler
    except ImportError:
        raise MissingRequirement(
            "Classifiers of voxels need scikit-learn, which is not installed: "
            "pip install regolith-studio[classifier]."
        ) from None
    if settings.kind == "logistic":
        model = LogisticRegression(C=1.0 / settings.regularisation, max_iter=_ITERATIONS)
    else:
        model = MLPClassifier(
            (settings.hidden,), solver="lbfgs", alpha=settings.regularisation, max_iter=_ITERATIONS,
            random_state=settings.seed,
        )  # fmt: skip
    return make_pipeline(StandardScaler(), model)


def check_voxel_size(own: FloatArray, source: SliceSource) -> None:
    """Raise an InputError unless a volume has voxels of the size that a classifier was trained at."""
    other = np.ravel(np.asarray(source.voxel_size, dtype=np.float64))
    if not np.allclose(own, other, rtol=0.02):
        raise InputError(
            f"The classifier was trained on voxels of {_edges(own)} µm, {source.name} has voxels of "
            f"{_edges(other)} µm; its features are measured in voxels."
        )


def _edges(sizes: FloatArray) -> str:
    return " x ".join(f"{each:g}" for each in sizes)


def probability_map(
    classifier: PixelClassifier, source: Volume, scratch: ScratchArrays, run: ParallelMap = map
) -> Generator[tuple[int, int], None, Volume]:
    """Probability of each voxel to be grain, 0 to 255; tells how many of how many slabs are done.

    ``scratch``: slabs that its checkpoint holds, if it has one, are taken from there; others are added to
    it. ``run``: applies the classifier to slabs.

    Raises InputError if the volume has voxels of another size than the classifier was trained at.
    """
    check_voxel_size(classifier.voxel_size, source)
    shares = SharedArray(scratch.zeros(source.shape, np.uint8))
    ranges = slab_ranges(source.shape, _SLAB_VOXELS)
    done = _restore_slabs(shares, ranges, scratch.checkpoint)
    waiting = [k for k in range(len(ranges)) if k not in done]
    predict = partial(_predict_slab, classifier, SharedArray(source.array), shares)
    for k, _ in zip(waiting, run(predict, [ranges[k] for k in waiting]), strict=True):
        if scratch.checkpoint is not None:
            scratch.checkpoint.add([CheckpointRecord(k, {}, {_MAP: shares.slices(*ranges[k]).tobytes("F")})])
        done.add(k)
        yield len(done), len(ranges)
    return probability_volume(shares.array, source)


def _restore_slabs(
    shares: SharedArray, ranges: list[tuple[int, int]], checkpoint: Checkpoint | None
) -> set[int]:
    """Write the slabs of a checkpoint; returns their numbers."""
    done: set[int] = set()
    for record in checkpoint.records() if checkpoint else ():
        first, stop = ranges[record.index]
        values = np.frombuffer(record.blobs[_MAP], np.uint8)
        shares.write(first, values.reshape((*shares.shape[:2], stop - first), order="F"))
        done.add(record.index)
    return done


def _predict_slab(
    classifier: PixelClassifier, given: SharedArray, shares: SharedArray, part: tuple[int, int]
) -> None:
    slab = given.thick(*part, classifier.features.margin)
    shares.write(slab.first, slab_probability(classifier, slab, given.shape))


def probability_volume(values: NDArray[np.uint8], source: SliceSource) -> Volume:
    """Probabilities from 0 to 255 as a volume of the source's voxel size."""
    edges = np.asarray(source.voxel_size, dtype=np.float64)
    return Volume(values, edges, "grey", source.name, source.origin)


def slab_probability(
    classifier: PixelClassifier, slab: ThickSlab, shape: tuple[int, int, int]
) -> NDArray[np.uint8]:
    """Probability of a slab's voxels to be grain, 0 to 255, shape (nx, ny, thickness).

    Voxels that hold no finite number have probability 0.

    ``slab``: with the margin of the classifier's features. ``shape``: of the volume.
    """
    nx, ny, _ = shape
    start = slab.first - slab.inner.start
    outer = box_between((0, 0, start), (nx, ny, start + slab.values.shape[2]))
    probability = np.empty((nx, ny, slab.stop - slab.first), dtype=np.uint8)
    for x in range(0, nx, _TILE):
        for y in range(0, ny, _TILE):
            high = (min(x + _TILE, nx), min(y + _TILE, ny), slab.stop)
            box = box_between((x, y, slab.first), high)
            vectors = block_features(slab.values, outer, box, shape, classifier.features)
            probability[box[:2]] = _in_bytes(classifier, vectors)
    if slab.values.dtype.kind == "f":
        probability[~np.isfinite(slab.values[:, :, slab.inner])] = 0
    return probability


def box_probability(classifier: PixelClassifier, volume: Volume, box: Box) -> NDArray[np.uint8]:
    """Probability of the voxels of a small part of a volume to be grain, 0 to 255, shape of the box."""
    return _in_bytes(classifier, features_in(volume, box, classifier.features))


def _in_bytes(classifier: PixelClassifier, vectors: NDArray[np.float32]) -> NDArray[np.uint8]:
    grain = classifier.grain_probability(classifier.probabilities(vectors))
    return np.asarray(np.rint(255.0 * grain), dtype=np.uint8)
