"""Options of volumes and of the grains in them, which several commands take."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from regolith_studio.imaging.settings import (
    CleaningSettings,
    DenoiseSettings,
    ExtractionSettings,
    SplittingSettings,
    ThresholdSettings,
)
from regolith_studio.readers.volumes.region import RegionSettings
from regolith_studio.settings import setting, setting_of

MAX_H = 1e6

if TYPE_CHECKING:
    from regolith_studio.imaging.volume import VolumeKind
    from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
    from regolith_studio.readers.volumes.header import RawLayout


@dataclass(frozen=True)
class VolumeOptions:
    """What a volume file does not say of itself."""

    kind: str = setting("", "Kind", "Kind of volume: labels or grey; detected if omitted.", metavar="KIND")
    voxel_size: str = setting(
        "",
        "Voxel size",
        "Edge of a voxel, or X,Y,Z, in the unit of --unit; read from the file if omitted.",
        metavar="SIZE",
    )
    unit: str = setting("", "Unit", "Unit of the voxel size: um, mm, m, nm or cm.", metavar="U")
    dataset: str = setting(
        "",
        "Dataset",
        "Dataset of an HDF5 file, level of an OME-Zarr, or series of a folder of slices or DICOM.",
        metavar="NAME",
    )
    axes: str = setting(
        "", "Axes", "Order of the axes of NPY and HDF5 arrays; zyx (slices first) if omitted.", metavar="AXES"
    )
    allow_gaps: bool = setting(False, "Gaps", "Read slices that are absent from a folder as empty ones.")
    shape: str = setting("", "Shape", "Number of voxels of a raw file along x, y and z.", metavar="NX,NY,NZ")
    dtype: str = setting(
        "uint8", "Type", "Data type of a raw file: uint8, uint16, float32, ...", metavar="TYPE"
    )
    byte_order: str = setting(
        "little", "Byte order", "Byte order of a raw file: little or big.", metavar="ORDER"
    )
    offset: int = setting(
        0, "Offset", "Number of bytes before the first voxel of a raw file.", minimum=0, maximum=2**63 - 1
    )

    def of(self, volume: Path) -> "VolumeInput":
        """The volume with what the options say of it; a wrong one is bad use."""
        from regolith_studio.jobs.extraction_settings import VolumeInput
        from regolith_studio.readers.settings import unit_factor

        if self.unit:
            unit_factor(self.unit)
        return VolumeInput(
            volume,
            _edges(self.voxel_size),
            self.unit or None,
            volume_kind(self.kind),
            self.dataset or None,
            _raw_layout(self.shape, self.dtype, self.byte_order, self.offset),
            self.axes or None,
            allow_gaps=self.allow_gaps,
        )


@dataclass(frozen=True)
class GrainOptions:
    """Where grains are looked for, how they are found and their surfaces taken."""

    region: RegionSettings
    denoise: str = setting_of(DenoiseSettings, "method", metavar="METHOD")
    threshold: str = setting(
        "otsu",
        "Threshold",
        "Threshold of grey volumes: otsu, multi-otsu, multi-otsu:CLASSES:BOUNDARY, a grey value, or "
        "probability[:P[:LOW]] for a probability map, where voxels from LOW on count if they are "
        "connected to some from P on.",
        metavar="HOW",
    )
    classifier: Path | None = setting(
        None,
        "Classifier",
        "Classifier that makes a probability map of a grey volume, as `classify train` or the window writes "
        "it; the threshold is then probability:0.5 if omitted.",
        metavar="FILE",
    )
    objects: Path | None = setting(
        None,
        "Object classifier",
        "Object classifier that keeps, splits again or drops the grains that were found, as `classify "
        "objects` or the window writes it.",
        metavar="FILE",
    )
    dark: bool = setting_of(ThresholdSettings, "dark")
    opening: int = setting_of(CleaningSettings, "opening")
    closing: int = setting_of(CleaningSettings, "closing")
    fill_pores: bool = setting_of(CleaningSettings, "fill_pores")
    h_maxima: float = setting_of(SplittingSettings, "h_maxima")
    split: bool = setting_of(SplittingSettings, "enabled")
    min_voxels: int = setting_of(ExtractionSettings, "min_voxels")
    exclude_border: bool = setting_of(
        ExtractionSettings, "exclude_border", option="--exclude-border/--keep-border"
    )
    surface: str = setting_of(ExtractionSettings, "surface", metavar="FROM")

    @property
    def recipe(self) -> "GrainSettings":
        """The settings that the options define; a wrong one is a usage error."""
        from regolith_studio.imaging.segmentation.segment import SegmentationSettings
        from regolith_studio.jobs.extraction_settings import GrainSettings, read_classifier, read_objects

        least = min(self.min_voxels, CleaningSettings.min_voxels)
        trained = read_classifier(self.classifier) if self.classifier else None
        how = "probability" if trained and self.threshold == "otsu" else self.threshold
        return GrainSettings(
            SegmentationSettings(
                DenoiseSettings(self.denoise),  # type: ignore[arg-type]  # checked by the settings
                threshold_from(how, self.dark),
                CleaningSettings(self.opening, self.closing, self.fill_pores, least),
                SplittingSettings(self.split, self.h_maxima),
                classifier=trained,
                objects=read_objects(self.objects) if self.objects else None,
            ),
            ExtractionSettings(
                exclude_border=self.exclude_border,
                min_voxels=self.min_voxels,
                fill_pores=self.fill_pores,
                surface=self.surface,  # type: ignore[arg-type]  # checked by the settings
            ),
            self.region,
        )


def volume_kind(text: str) -> "VolumeKind | None":
    """``labels``, ``grey`` or nothing, for guessing."""
    match text:
        case "":
            return None
        case "labels" | "grey":
            return text
        case _:
            raise typer.BadParameter(f"A volume holds labels or grey values, not {text!r}.")


def threshold_from(text: str, dark: bool) -> ThresholdSettings:
    """The threshold that ``otsu``, ``multi-otsu:4:2``, ``probability:0.6:0.3`` or ``87.5`` denotes."""
    name, _, rest = text.partition(":")
    try:
        match name:
            case "otsu" if not rest:
                return ThresholdSettings("otsu", dark=dark)
            case "multi-otsu":
                classes, boundary = map(int, rest.split(":")) if rest else (3, 1)
                return ThresholdSettings("multi-otsu", classes=classes, boundary=boundary, dark=dark)
            case "probability":
                core, _, low = rest.partition(":")
                return ThresholdSettings("probability", float(core or 0.5), dark=dark, low=float(low or 0))
            case _:
                return ThresholdSettings("manual", float(text), dark=dark)
    except ValueError:
        raise typer.BadParameter(
            "A threshold is otsu, multi-otsu[:CLASSES:BOUNDARY], probability[:P[:LOW]] or a number, got "
            f"{text!r}."
        ) from None


def _edges(text: str) -> tuple[float, ...] | None:
    """One edge or three, written as ``2.3`` or ``2.3,2.3,5``."""
    from regolith_studio.readers.settings import MAX_VOXEL, MIN_VOXEL

    if not text:
        return None
    try:
        edges = tuple(float(part) for part in text.split(","))
    except ValueError:
        edges = ()
    if len(edges) not in (1, 3) or not all(MIN_VOXEL <= edge <= MAX_VOXEL for edge in edges):
        raise typer.BadParameter(
            f"A voxel size is a number from {MIN_VOXEL:g} to {MAX_VOXEL:g} or three as X,Y,Z, got {text!r}."
        )
    return edges * 3 if len(edges) == 1 else edges


def _raw_layout(shape: str, dtype: str, byte_order: str, offset: int) -> "RawLayout | None":
    from regolith_studio.readers.volumes.header import RawLayout

    if not shape:
        return None
    try:
        nx, ny, nz = (int(part) for part in shape.split(","))
    except ValueError:
        raise typer.BadParameter(f"Write the shape of a raw file as NX,NY,NZ, got {shape!r}.") from None
    return RawLayout((nx, ny, nz), dtype, byte_order, offset)
