"""Jobs of classifiers of voxels: train one on a volume of painted labels, write the map of probabilities."""

from pathlib import Path

from regolith_studio.errors import InputError
from regolith_studio.imaging.label_files import write_probability_file
from regolith_studio.imaging.segmentation.classifier_document import training_document
from regolith_studio.imaging.segmentation.pixel_classifier import (
    ClassifierSettings,
    PixelClass,
    TrainingSet,
    paint_from_labels,
    probability_map,
    train,
)
from regolith_studio.imaging.volume_slabs import ScratchArrays
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.json_text import canonical_json
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.extraction_settings import VolumeInput
from regolith_studio.jobs.volume_jobs import IN_MEMORY, volume_sha256
from regolith_studio.messages import N_, Message


def train_on_labels(
    scan: VolumeInput, painted: VolumeInput, classes: tuple[PixelClass, ...], settings: ClassifierSettings
) -> Steps:
    """Train a classifier on painted voxels; returns its :class:`TrainingSet`.

    Parameters
    ----------
    painted
        A volume of labels: 0 where nothing is painted, 1 for the first of `classes`, and so on.

    Raises
    ------
    FileError
        If a file is no volume.
    InputError
        If the volumes differ in size, or a class is not painted.
    MissingRequirement
        If scikit-learn is not installed.
    """
    yield Started(Message(N_("Reading {name}"), name=scan.path.name), 2)
    source, labels = scan.opened(), painted.opened()
    if source.kind != "grey":
        raise InputError(f"{scan.path.name} holds labels; a classifier is trained on grey values.")
    yield Started(N_("Training the classifier"))
    training = paint_from_labels(source, labels, classes, settings, volume_sha256(scan.path))
    train(training)
    return training


def map_probabilities(scan: VolumeInput, training: TrainingSet, path: Path, scratch: Path) -> Steps:
    """Write the probability of each voxel of a scan to be grain, 0 to 255; returns the path.

    Parameters
    ----------
    path
        TIFF, NRRD or HDF5 by its suffix.
    scratch
        Folder for temporary files where the volume is too large for the memory.

    Raises
    ------
    FileError
        If the scan is no volume, or the file cannot be written.
    InputError
        If the voxels have another size than those that the classifier was trained on.
    """
    yield Started(Message(N_("Reading {name}"), name=scan.path.name))
    source = scan.opened()
    nx, ny, nz = source.shape
    with ScratchArrays(scratch if nx * ny * nz > IN_MEMORY else None) as arrays:
        steps = probability_map(train(training), source, arrays)
        yield Started(N_("Predicting grains"))
        while True:
            try:
                yield Progress(*next(steps))
            except StopIteration as end:
                found = end.value
                break
        yield Started(Message(N_("Writing {name}"), name=path.name))
        for done, total in write_probability_file(path, found):
            yield Progress(done, total)
    return path


def write_classifier(path: Path, training: TrainingSet) -> None:
    """Write a classifier's file.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    write_bytes(path, canonical_json(training_document(training)).encode("ascii"))
