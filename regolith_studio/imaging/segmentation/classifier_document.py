"""Training sets as JSON: the files of classifiers of voxels and of objects, trained again when loaded."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, InputError
from regolith_studio.imaging.segmentation.object_classifier import (
    OBJECT_CLASSES,
    OBJECT_FEATURES,
    ObjectTraining,
)
from regolith_studio.imaging.segmentation.pixel_classifier import (
    ClassifierSettings,
    PixelClass,
    TrainingSet,
)
from regolith_studio.imaging.segmentation.pixel_features import FeatureSettings

FORMAT = "regolith-studio pixel classifier"


def training_document(training: TrainingSet) -> dict[str, Any]:
    """Plain JSON of a training set; 32-bit features come back to the last bit."""
    return {
        "format": FORMAT,
        "settings": asdict(training.settings),
        "classes": [asdict(each) for each in training.classes],
        "voxel_size_um": training.voxel_size.tolist(),
        "scan_sha256": training.scan,
        "features": list(training.settings.features.names),
        "voxels": [
            [*position, int(label), *map(_shortest, vector)]
            for position, label, vector in zip(
                training.positions.tolist(), training.labels, training.vectors, strict=True
            )
        ],
    }


def training_from(document: Mapping[str, Any], name: str) -> TrainingSet:
    """The training set that :func:`training_document` has written.

    ``name``: of the file, for messages.

    Raises FileError if it holds no training set, or one with other features than its settings ask for.
    Raises InputError if a setting is out of its range, or a class is not painted.
    """
    if document.get("format") != FORMAT:
        raise FileError(f"{name} is no classifier: it does not say {FORMAT!r}.")
    try:
        given = dict(document["settings"])
        seen = given.pop("features")
        sigmas = tuple(float(each) for each in seen["sigmas"])
        features = FeatureSettings(sigmas, bool(seen["planar"]), bool(seen["hessian"]))
        settings = ClassifierSettings(features, **given)
        classes = tuple(PixelClass(str(c["name"]), bool(c["is_grain"])) for c in document["classes"])
        rows = np.array(document["voxels"], dtype=np.float64)
        sizes = np.array(document["voxel_size_um"], dtype=np.float64)
        names, scan = tuple(document["features"]), str(document["scan_sha256"])
    except (KeyError, TypeError, ValueError, AttributeError):
        raise FileError(f"{name} is a damaged classifier: a part is missing or of the wrong kind.") from None
    if names != features.names or rows.ndim != 2 or rows.shape[1] != 4 + len(names) or sizes.shape != (3,):
        raise FileError(
            f"{name} is a classifier for other features than this program computes; train it again."
        )
    whole: NDArray[np.int64] = rows[:, :4].astype(np.int64)
    vectors = rows[:, 4:].astype(np.float32)
    try:
        return TrainingSet(whole[:, :3], whole[:, 3], vectors, classes, sizes, scan, settings)
    except InputError as error:
        raise InputError(f"{name} is no classifier that can be used: {error}") from None


def _shortest(value: np.float32) -> float:
    """The number with the fewest digits that is the same in 32 bits."""
    return float(str(value))


OBJECT_FORMAT = "regolith-studio object classifier"


def objects_document(training: ObjectTraining) -> dict[str, Any]:
    """Plain JSON of the examples of an object classifier; descriptors come back to the last bit."""
    return {
        "format": OBJECT_FORMAT,
        "actions": dict(zip(OBJECT_CLASSES, training.actions, strict=True)),
        "voxel_size_um": training.voxel_size.tolist(),
        "scan_sha256": training.scan,
        "descriptors": list(OBJECT_FEATURES),
        "median": training.centre.tolist(),
        "spread": training.spread.tolist(),
        "examples": [
            {"voxel": position, "class": OBJECT_CLASSES[kind], "descriptors": vector}
            for position, kind, vector in zip(
                training.positions.tolist(), training.classes.tolist(), training.vectors.tolist(), strict=True
            )
        ],
    }


def objects_from(document: Mapping[str, Any], name: str) -> ObjectTraining:
    """The examples that :func:`objects_document` has written.

    ``name``: of the file, for messages.

    Raises FileError if it holds no examples, or such with other descriptors. Raises InputError if fewer than
    two classes have an example.
    """
    if document.get("format") != OBJECT_FORMAT:
        raise FileError(f"{name} is no object classifier: it does not say {OBJECT_FORMAT!r}.")
    if document.get("descriptors") != list(OBJECT_FEATURES):
        raise FileError(f"{name} is an object classifier for other descriptors than this program measures.")
    try:
        examples = list(document["examples"])
        positions = np.array([each["voxel"] for each in examples], dtype=np.int64)
        kinds = np.array([OBJECT_CLASSES.index(each["class"]) for each in examples], dtype=np.int64)
        vectors = np.array([each["descriptors"] for each in examples], dtype=np.float64)
        actions = tuple(document["actions"][kind] for kind in OBJECT_CLASSES)
        centre, spread, edges = (
            np.array(document[key], dtype=np.float64) for key in ("median", "spread", "voxel_size_um")
        )
        n = len(examples)
        return ObjectTraining(
            positions.reshape(n, 3),
            kinds,
            vectors.reshape(n, len(OBJECT_FEATURES)),
            centre,
            spread,
            edges,
            actions,
            str(document["scan_sha256"]),
        )
    except InputError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError):
        raise FileError(
            f"{name} is a damaged object classifier: a part is missing or of the wrong kind."
        ) from None
