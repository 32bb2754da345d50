"""Probability maps of large scans that go on where an earlier, interrupted run has ended."""

import hashlib
import math
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

from regolith_studio.dataset.build import software_versions
from regolith_studio.errors import FileError
from regolith_studio.imaging.segmentation.classifier_document import training_document
from regolith_studio.imaging.segmentation.pixel_classifier import TrainingSet, train
from regolith_studio.imaging.volume_slabs import SliceSource
from regolith_studio.io.checkpoint import Checkpoint
from regolith_studio.io.json_text import canonical_json
from regolith_studio.jobs.extraction_settings import VolumeInput
from regolith_studio.readers.volumes.region import RegionSettings

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

    Parameters
    ----------
    path
        As :func:`unfinished_file` gives it; none where nothing is kept.
    source
        The region of the scan, and the SHA-256 of the scan.
    training
        Of the classifier, if there is one.

    Raises
    ------
    FileError
        If the file cannot be written, or another process has it open.
    MissingRequirement
        If scikit-learn is not installed.
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
