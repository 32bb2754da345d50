"""From a label volume to particles (section 2.1)."""

from pathlib import Path

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Source
from regolith_studio.imaging.extraction import Extraction, ExtractionSettings, extraction_steps
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.label_volume import read_label_volume
from regolith_studio.readers.hashing import sha256_of


def extract_file(path: Path, voxel_size: float | None, settings: ExtractionSettings) -> Steps:
    """Read a label volume and make a particle of each label; returns an ``Extraction``.

    Raises
    ------
    FileError
        If the file is no label volume.
    InputError
        If no label becomes a particle, or the voxel size is not known.
    """
    yield Started(f"Reading {path.name}")
    volume = read_label_volume(path, voxel_size)
    source = Source(str(path), sha256_of(path), f"voxel:{volume.voxel_size[0]:g}")
    yield Started("Extracting particles")
    steps = extraction_steps(volume, settings, group=path.stem, source=source)
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            if not end.value.particles:
                raise InputError(_nothing_found(path, end.value)) from None
            return end.value
        yield Progress(step.done, step.total, step.particle.name if step.particle else "")


def _nothing_found(path: Path, extraction: Extraction) -> str:
    counts = f"{len(extraction.border)} touch the border, {len(extraction.small)} are too small"
    return f"None of the labels of {path.name} became a particle ({counts}); is it a volume of grey values?"
