"""Settings from voxels to particles, as one value and as the JSON that ``extract`` writes."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any, TypeVar

from regolith_studio.errors import FileError, InputError
from regolith_studio.imaging.segmentation.classifier_document import (
    objects_document,
    objects_from,
    training_document,
    training_from,
)
from regolith_studio.imaging.segmentation.label_edits import edits_document, edits_from
from regolith_studio.imaging.segmentation.object_classifier import ObjectTraining
from regolith_studio.imaging.segmentation.pixel_classifier import TrainingSet
from regolith_studio.imaging.segmentation.segment import SegmentationSettings
from regolith_studio.imaging.settings import (
    CleaningSettings,
    DenoiseSettings,
    ExtractionSettings,
    SplittingSettings,
    ThresholdSettings,
    TileSettings,
)
from regolith_studio.imaging.volume import VolumeKind
from regolith_studio.readers.sandbox.parent import read_bytes
from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.readers.volumes.read import VolumeFile, open_slabs
from regolith_studio.readers.volumes.region import RegionSettings

S = TypeVar("S")
_LARGEST = 64 * 2**20
_PARTS: dict[str, type[Any]] = {
    "denoise": DenoiseSettings,
    "threshold": ThresholdSettings,
    "cleaning": CleaningSettings,
    "splitting": SplittingSettings,
    "tiles": TileSettings,
}


@dataclass(frozen=True)
class GrainSettings:
    """All settings from voxels to particles; the segmentation is not used where there are labels."""

    segmentation: SegmentationSettings = field(default_factory=SegmentationSettings)
    extraction: ExtractionSettings = field(default_factory=ExtractionSettings)
    region: RegionSettings = field(default_factory=RegionSettings)

    def as_document(self) -> dict[str, Any]:
        """Plain JSON."""
        how = self.segmentation
        segmentation = asdict(replace(how, classifier=None, objects=None, edits=()))
        segmentation["edits"] = edits_document(how.edits)
        if how.classifier is not None:
            segmentation["classifier"] = training_document(how.classifier)
        if how.objects is not None:
            segmentation["objects"] = objects_document(how.objects)
        return {
            "region": asdict(self.region),
            "segmentation": segmentation,
            "extraction": asdict(self.extraction),
        }

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> "GrainSettings":
        """The recipe in a JSON document; what is missing stays at its default, what is unknown is omitted."""
        segmentation = _section(document, "segmentation")
        parts = {name: _parse_settings(kind, _section(segmentation, name)) for name, kind in _PARTS.items()}
        return cls(
            SegmentationSettings(
                **parts,
                classifier=_document_of(segmentation, "classifier", training_from),
                objects=_document_of(segmentation, "objects", objects_from),
                edits=edits_from(segmentation.get("edits", ())),
            ),
            _parse_settings(ExtractionSettings, _section(document, "extraction")),
            _parse_settings(RegionSettings, _section(document, "region")),
        )


def _document_of(
    segmentation: Mapping[str, Any], name: str, read: Callable[[Mapping[str, Any], str], S]
) -> S | None:
    """What `read` makes of a group in the settings of a segmentation, if it is there."""
    document = segmentation.get(name)
    if document is None:
        return None
    if not isinstance(document, Mapping):
        raise InputError(f"“{name}” in a recipe is a trained classifier, got {document!r}.")
    return read(document, f"“{name}” in a recipe")


def read_classifier(path: Path) -> TrainingSet:
    """The training set of a classifier's file."""
    return training_from(_read_group(path, "classifier"), path.name)


def read_objects(path: Path) -> ObjectTraining:
    """The examples of an object classifier's file."""
    return objects_from(_read_group(path, "object classifier"), path.name)


def _read_group(path: Path, what: str) -> dict[str, Any]:
    try:
        document = json.loads(read_bytes(path, _LARGEST))
    except (ValueError, RecursionError):
        raise FileError(f"{path.name} is no {what}: it holds no JSON.") from None
    if not isinstance(document, dict):
        raise FileError(f"{path.name} is no {what}: it holds no group of settings.")
    return document


def read_grain_settings(path: Path) -> GrainSettings:
    """The recipe in an ``extraction.json``, or in a file saved by the window."""
    document = _read_group(path, "recipe")
    if not {"segmentation", "extraction"} & set(document):
        raise FileError(f"{path.name} is no recipe of a segmentation: it names neither of its settings.")
    return GrainSettings.from_document(document)


def _section(document: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    section = document.get(name, {})
    if not isinstance(section, Mapping):
        raise InputError(f"“{name}” in a recipe is a group of settings, got {section!r}.")
    return section


def _parse_settings(kind: type[S], values: Mapping[str, Any]) -> S:
    """Settings of a dataclass, each of the type of its default."""
    known: dict[str, Any] = {}
    for each in fields(kind):  # type: ignore[arg-type]
        if each.name not in values:
            continue
        value, default = values[each.name], each.default
        if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if type(value) is not type(default):
            raise InputError(f"“{each.name}” in a recipe is of the kind of {default!r}, got {value!r}.")
        known[each.name] = value
    return kind(**known)


@dataclass(frozen=True)
class VolumeInput:
    """A volume as a user names it.

    - ``path``: file, or folder of slices.
    - ``voxel_size``: one edge or three along x, y, z, in `unit`; by default what the file says.
    - ``unit``: of the voxel size.
    - ``kind``: ``labels`` or ``grey``; by default guessed.
    - ``dataset``: which volume of a file that holds several.
    - ``raw``: what a raw file does not say about itself.
    - ``axes``: of an NPY or HDF5 array, the slowest first: ``zyx`` by default.
    - ``group``: name of the group of its particles; by default that of the file.
    - ``allow_gaps``: whether slices that are absent from a folder become empty ones.
    """

    path: Path
    voxel_size: float | Sequence[float] | None = None
    unit: str | None = None
    kind: VolumeKind | None = None
    dataset: str | None = None
    raw: RawLayout | None = None
    axes: str | None = None
    group: str = ""
    allow_gaps: bool = False

    def opened(self) -> VolumeFile:
        """The volume, read slab by slab."""
        return open_slabs(
            self.path,
            dataset=self.dataset,
            axes=self.axes,
            voxel_size=self.voxel_size,
            unit=self.unit,
            kind=self.kind,
            raw=self.raw,
            allow_gaps=self.allow_gaps,
        )
