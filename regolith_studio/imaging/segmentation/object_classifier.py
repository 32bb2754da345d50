"""Object step (section 2.1): segmented objects classified after a few examples, then kept, split or dropped.

An object is what the segmentation takes for one grain. Its descriptors (:data:`OBJECT_FEATURES`) are
standardised by the median and spread of all objects of the scan that the examples were chosen in, and a
logistic regression of scikit-learn gives the class of each: linear limits are what a handful of examples can
support.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull
from skimage.measure import marching_cubes

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.geometry.arrays import (
    BoolArray,
    FloatArray,
    IntArray,
    LockedRecord,
    locked_floats,
    locked_integers,
)
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.label_table import GrainCrop, LabelTable, grain_crop, label_table
from regolith_studio.imaging.segmentation.splitting import in_mean_edges, split
from regolith_studio.imaging.settings import SplittingSettings
from regolith_studio.imaging.volume import Box, Volume, box_between, grown
from regolith_studio.imaging.volume_slabs import SharedArray
from regolith_studio.messages import N_

ObjectAction = Literal["keep", "split", "drop"]
OBJECT_ACTIONS: tuple[ObjectAction, ...] = get_args(ObjectAction)
OBJECT_CLASSES = ("grain", "several grains", "artefact")
OBJECT_FEATURES = (
    "log of the equivalent diameter",
    "sphericity",
    "mean grey value",
    "standard deviation of the grey values",
    "volume of the contour over that of its convex hull",
    "intermediate over long axis",
    "short over intermediate axis",
    "inscribed over equivalent radius",
    "share of the surface in contact",
)
_HALVINGS = 6
_marching_cubes: Any = marching_cubes
_distance: Any = ndimage.distance_transform_edt


@dataclass(frozen=True, eq=False)
class ObjectTable:
    """The objects of a segmentation with their descriptors.

    ``table``: labels, voxels and boxes, n of them. ``vectors``: of :data:`OBJECT_FEATURES`, shape (n, 9).
    """

    table: LabelTable
    vectors: FloatArray

    def rows_of(self, labels: Sequence[int]) -> IntArray:
        """Rows of labels that are there."""
        return np.searchsorted(self.table.labels, labels).astype(np.int64)


@dataclass(frozen=True, eq=False)
class ObjectTraining(LockedRecord):
    """Examples with their descriptors: all that an object classifier is trained from.

    - ``positions``: a voxel in each example, along x, y, z, shape (n, 3).
    - ``classes``: index into :data:`OBJECT_CLASSES`, shape (n,).
    - ``vectors``: descriptors of each example, shape (n, 9).
    - ``centre``, ``spread``: median of each descriptor over all objects of the scan, and half the range of
      its middle 68 %, shape (9,).
    - ``voxel_size``: edges of a voxel along x, y and z, in micrometres, shape (3,).
    - ``actions``: what is done with the objects of each class.
    - ``scan``: SHA-256 of the scan, or empty.

    Raises InputError if fewer than two classes have an example, or an action is another.
    """

    positions: IntArray
    classes: IntArray
    vectors: FloatArray
    centre: FloatArray
    spread: FloatArray
    voxel_size: FloatArray
    actions: tuple[ObjectAction, ...] = OBJECT_ACTIONS
    scan: str = ""

    def __post_init__(self) -> None:
        n, n_features = len(self.classes), len(OBJECT_FEATURES)
        checked = {
            "positions": locked_integers(self.positions, (n, 3), "positions"),
            "classes": locked_integers(self.classes, (n,), "classes"),
            "vectors": locked_floats(self.vectors, (n, n_features), "vectors"),
            "centre": locked_floats(self.centre, (n_features,), "centre"),
            "spread": locked_floats(self.spread, (n_features,), "spread"),
            "voxel_size": locked_floats(self.voxel_size, (3,), "voxel_size"),
        }
        if len(self.actions) != len(OBJECT_CLASSES) or not set(self.actions) <= set(OBJECT_ACTIONS):
            raise InputError(
                f"What is done with {', '.join(OBJECT_CLASSES)} is one of {', '.join(OBJECT_ACTIONS)} each, "
                f"got {list(self.actions)}."
            )
        if n and not 0 <= checked["classes"].min() <= checked["classes"].max() < len(OBJECT_CLASSES):
            raise InputError(f"Examples belong to classes 0 to {len(OBJECT_CLASSES) - 1}.")
        if len(np.unique(checked["classes"])) < 2:
            raise InputError(N_("Choose examples of two classes at least: click into some objects of each."))
        if not (checked["spread"] > 0).all():
            raise InputError("The spreads of the descriptors must be positive.")
        for name, value in checked.items():
            object.__setattr__(self, name, value)


def describe_objects(labels: Volume, grey: Volume) -> Generator[tuple[int, int], None, ObjectTable]:
    """Measure each object; tells how many are done, of how many, and returns the table.

    Raises InputError if there is no label.
    """
    table = label_table(labels)
    whole = box_between((0, 0, 0), labels.shape)
    shared, values = SharedArray(labels.array), SharedArray(grey.array)
    vectors = np.empty((len(table.labels), len(OBJECT_FEATURES)))
    for row, (label, box) in enumerate(table.boxes().items()):
        crop = grain_crop(shared, values, label, grown(box, 1, whole))
        vectors[row] = object_features(crop, labels.voxel_size)
        yield row + 1, len(vectors)
    return ObjectTable(table, vectors)


def object_features(crop: GrainCrop, edges: FloatArray) -> FloatArray:
    """Descriptors of one object, shape (9,).

    Area and solidity are those of its contour by marching cubes, whose area is up to 9 % too large, so that
    the sphericity of a sphere is below 1. The voxels are more than it holds: five of them 2.3 times its hull.

    ``crop``: what lies about it, with a margin of a voxel inside of the volume. ``edges``: of a voxel along
    x, y and z, in micrometres, shape (3,).
    """
    own = np.pad(crop.own, 1)
    volume = float(np.count_nonzero(own)) * float(np.prod(edges))
    radius = float(np.cbrt(0.75 * volume / np.pi))
    vertices, faces, _, _ = _marching_cubes(own.astype(np.float32), 0.5, spacing=tuple(edges))
    contour = Mesh(vertices.astype(np.float64), faces[:, ::-1].astype(np.int64))
    grey = crop.values[crop.own].astype(np.float64)
    grey = grey[np.isfinite(grey)] if np.isfinite(grey).any() else np.zeros(1)
    places = np.stack(np.nonzero(own), axis=-1) * edges
    moments = np.cov(places.T, bias=True) if len(places) > 1 else np.zeros((3, 3))
    # A voxel's own second moment keeps flat objects of one voxel from a thickness of 0.
    short, middle, long = np.sqrt(np.linalg.eigvalsh(moments + np.diag(edges**2) / 12))
    return np.array(
        [
            np.log(2 * radius),
            4 * np.pi * radius**2 / contour.surface_area,
            grey.mean(),
            grey.std(),
            contour.volume / float(ConvexHull(vertices).volume),
            middle / long,
            short / middle,
            float(_distance(own, sampling=edges).max()) / radius,
            _contact_share(crop, edges),
        ]
    )


def _contact_share(crop: GrainCrop, edges: FloatArray) -> float:
    """Share of an object's voxel faces that other objects touch."""
    own, others = np.pad(crop.own, 1), np.pad(crop.others, 1)
    touched = free = 0.0
    for axis in range(3):
        face = float(np.prod(edges) / edges[axis])
        for step in (-1, 1):
            # np.roll wraps around, into the padding only.
            beyond = own & ~np.roll(own, step, axis)
            meeting = float(np.count_nonzero(beyond & np.roll(others, step, axis)))
            touched += face * meeting
            free += face * (float(np.count_nonzero(beyond)) - meeting)
    return touched / (touched + free)


def train_on_examples(
    table: ObjectTable,
    labels: Volume,
    examples: Sequence[tuple[tuple[int, int, int], int]],
    actions: tuple[ObjectAction, ...] = OBJECT_ACTIONS,
    scan: str = "",
) -> ObjectTraining:
    """The training set of examples: a voxel in each, and its class. The last example of an object counts.

    Raises InputError if a voxel lies in no object, or as :class:`ObjectTraining`.
    """
    chosen: dict[int, tuple[tuple[int, int, int], int]] = {}
    for position, kind in examples:
        inside = all(0 <= at < n for at, n in zip(position, labels.shape, strict=True))
        label = int(labels.array[position]) if inside else 0
        if label <= 0:
            raise InputError(f"There is no object at voxel {position}; choose voxels of segmented objects.")
        chosen[label] = (position, kind)
    centre, spread = _centre_and_spread(table.vectors)
    return ObjectTraining(
        np.array([position for position, _ in chosen.values()], dtype=np.int64).reshape(-1, 3),
        np.array([kind for _, kind in chosen.values()], dtype=np.int64),
        table.vectors[table.rows_of(list(chosen))] if chosen else np.zeros((0, len(OBJECT_FEATURES))),
        centre,
        spread,
        labels.voxel_size,
        actions,
        scan,
    )


MIDDLE = (0.16, 0.84)
"""Quantiles that bound the middle 68 % of the objects."""


def _centre_and_spread(vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Median and half the range of the middle 68 % of each descriptor; 1 where all objects are alike."""
    # One standard deviation on either side, of a Gaussian; artefacts among the objects hardly change it.
    low, high = np.quantile(vectors, MIDDLE, axis=0)
    centre, spread = np.median(vectors, axis=0), (high - low) / 2
    spread[spread <= 1e-9 * np.maximum(np.abs(centre), 1.0)] = 1.0
    return centre, spread


SUSPICIOUS = 2.0
"""Distance from the median in spreads beyond which an object may be several grains, or a part of one."""
SOLIDITY_SPREAD = 0.01
"""Least spread of solidities: the steps of voxels change that of a grain by so much, and boxes have none."""


@dataclass(frozen=True)
class SuspectObject:
    """An object unlike the others.

    - ``solidity``: volume of its contour over that of the convex hull.
    - ``deviation``: distance from the median in spreads: of its solidity below it, or of its size on either
      side.
    - ``by_size``: whether its size is what is unusual.
    """

    label: int
    box: Box
    n_voxels: int
    solidity: float
    deviation: float
    by_size: bool


def suspect_objects(objects: ObjectTable) -> list[SuspectObject]:
    """Objects that are unusually concave, large or small, the most unusual one first."""
    size, solidity = 0, 4  # of OBJECT_FEATURES
    centre, spread = _centre_and_spread(objects.vectors)
    low, high = np.quantile(objects.vectors[:, solidity], MIDDLE)
    spread[solidity] = max((high - low) / 2, SOLIDITY_SPREAD)
    away = (objects.vectors - centre) / spread
    parts = np.stack([-away[:, solidity], np.abs(away[:, size])])
    deviation, by_size = parts.max(axis=0), parts.argmax(axis=0) == 1
    order = np.argsort(-deviation, kind="stable")
    rows = order[deviation[order] > SUSPICIOUS].tolist()
    table = objects.table
    return [
        SuspectObject(
            int(table.labels[row]),
            box_between(table.low[row].tolist(), table.high[row].tolist()),
            int(table.counts[row]),
            float(objects.vectors[row, solidity]),
            float(deviation[row]),
            bool(by_size[row]),
        )
        for row in rows
    ]


@lru_cache(maxsize=4)
def _trained(training: ObjectTraining) -> Any:
    """A logistic regression; the same examples give the same one."""
    try:
        from sklearn.linear_model import LogisticRegression
    except ImportError:
        raise MissingRequirement(
            "Classifiers of objects need scikit-learn, which is not installed: "
            "pip install regolith-studio[classifier]."
        ) from None
    model = LogisticRegression(class_weight="balanced", max_iter=1000)
    return model.fit(_standardised(training, training.vectors), training.classes)


def _standardised(training: ObjectTraining, vectors: FloatArray) -> FloatArray:
    """Differences from the median in spreads; beyond eight spreads it makes no difference how far."""
    return np.asarray(np.clip((vectors - training.centre) / training.spread, -8.0, 8.0))


def classify_objects(training: ObjectTraining, vectors: FloatArray) -> IntArray:
    """Class of each object, index into :data:`OBJECT_CLASSES`, for descriptors of shape (n, 9).

    Raises MissingRequirement if scikit-learn is not installed.
    """
    return np.asarray(_trained(training).predict(_standardised(training, vectors)), dtype=np.int64)


def sort_objects(
    numbers: NDArray[np.int32],
    objects: ObjectTable,
    edges: FloatArray,
    training: ObjectTraining,
    splitting: SplittingSettings,
    min_voxels: int,
) -> Generator[tuple[int, int], None, None]:
    """Keep, split again or drop objects by their class, in place; tells how many are done, of how many.

    The first part of an object that is split keeps its label, further ones get new labels above the highest.

    - ``numbers``: labels, 0 between objects, shape (nx, ny, nz).
    - ``objects``: of these labels.
    - ``edges``: of a voxel along x, y and z, in micrometres, shape (3,).
    - ``splitting``: of the segmentation, whose h is halved until an object falls apart
      (:func:`split_again`).
    - ``min_voxels``: smallest part.

    Raises InputError if the voxels have another size than those of the examples.
    """
    if not np.allclose(edges, training.voxel_size, rtol=0.02):
        own, other = (" x ".join(f"{each:g}" for each in sizes) for sizes in (training.voxel_size, edges))
        raise InputError(
            f"The object classifier was trained on voxels of {own} µm, and the scan has voxels of "
            f"{other} µm; choose examples in a scan with the same voxels."
        )
    labels, boxes = objects.table.labels.tolist(), objects.table.boxes()
    kinds, highest = classify_objects(training, objects.vectors), int(objects.table.labels[-1])
    for done, (label, kind) in enumerate(zip(labels, kinds, strict=True), start=1):
        region, action = numbers[boxes[label]], training.actions[kind]
        if action == "drop":
            region[region == label] = 0
        elif action == "split":
            parts = split_again(region == label, boxes[label], numbers.shape, edges, splitting, min_voxels)
            for part in range(2, int(parts.max()) + 1):
                highest += 1
                region[parts == part] = highest
        yield done, len(labels)


def split_again(
    mask: BoolArray,
    box: Box,
    shape: tuple[int, ...],
    edges: FloatArray,
    settings: SplittingSettings,
    min_voxels: int,
) -> IntArray:
    """Parts of an object, 1 to n, 0 outside: by the first of h/2, h/4, ... that gives two of `min_voxels`.

    Smaller parts join the nearest of these. Where no h does, the object stays whole.

    ``mask``, ``box``: the object in its box, and the box in a volume of `shape`. ``settings``: with which it
    was found.
    """
    x, y, z = ((side.start == 0, side.stop == n) for side, n in zip(box, shape, strict=True))
    own, h, relative = np.ascontiguousarray(mask), settings.h_maxima, settings.relative
    for _ in range(_HALVINGS):
        h, relative = h / 2, relative / 2
        parts, _sites = split(own, edges, SplittingSettings(True, h, relative), (x, y, z))
        sizes = np.bincount(parts.ravel())
        large = np.flatnonzero(sizes[1:] >= max(min_voxels, 1)) + 1
        if len(large) > 1:
            return _only(parts, large, edges)
    return own.astype(np.int64)


def _only(parts: IntArray, kept: IntArray, edges: FloatArray) -> IntArray:
    """The parts `kept`, numbered from 1; voxels of the others go to the nearest of them."""
    number = np.zeros(int(parts.max()) + 1, dtype=np.int64)
    number[kept] = np.arange(1, len(kept) + 1)
    new = number[parts]
    if len(kept) < len(number) - 1:
        nearest = _distance(
            new == 0, sampling=in_mean_edges(edges), return_distances=False, return_indices=True
        )
        new = np.where(parts > 0, new[tuple(nearest)], 0)
    return np.asarray(new)
