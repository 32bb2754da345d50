"""A training set as JSON: the file of a trained classifier, which is trained again when it is loaded."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
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

    Parameters
    ----------
    name
        Of the file, for messages.

    Raises
    ------
    FileError
        If it holds no training set, or one with other features than its settings ask for.
    InputError
        If a setting is out of its range, or a class is not painted.
    """
    if document.get("format") != FORMAT:
        raise FileError(f"{name} is no classifier: it does not say {FORMAT!r}.")
    try:
        given = dict(document["settings"])
        sigmas = tuple(float(each) for each in given["features"]["sigmas"])
        features = FeatureSettings(sigmas, bool(given.pop("features")["planar"]))
        settings = ClassifierSettings(features, **given)
        classes = tuple(PixelClass(str(c["name"]), bool(c["is_grain"])) for c in document["classes"])
        rows = np.array(document["voxels"], dtype=np.float64)
        sizes = np.array(document["voxel_size_um"], dtype=np.float64)
        names, scan = tuple(document["features"]), str(document["scan_sha256"])
    except (KeyError, TypeError, ValueError, AttributeError):
        raise FileError(f"{name} is a damaged classifier: a part is missing or of the wrong kind.") from None
    if names != features.names or rows.ndim != 2 or rows.shape[1] != 4 + len(names) or sizes.shape != (3,):
        raise FileError(f"{name} is a classifier for other features: {', '.join(map(str, names))}.")
    whole: NDArray[np.int64] = rows[:, :4].astype(np.int64)
    return TrainingSet(
        whole[:, :3], whole[:, 3], rows[:, 4:].astype(np.float32), classes, sizes, scan, settings
    )


def _shortest(value: np.float32) -> float:
    """The number with the fewest digits that is the same in 32 bits."""
    return float(str(value))
