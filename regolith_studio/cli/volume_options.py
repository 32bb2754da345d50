"""Options of volumes and of the grains in them, which several commands take."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.readers.volumes.region import RegionSettings

MAX_H = 1e6

if TYPE_CHECKING:
    from regolith_studio.imaging.segmentation.thresholding import ThresholdSettings
    from regolith_studio.imaging.volume import VolumeKind
    from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
    from regolith_studio.readers.volumes.header import RawLayout


@dataclass(frozen=True)
class VolumeOptions:
    """What a volume file does not say of itself."""

    kind: Annotated[
        str,
        typer.Option("--kind", help="Kind of volume: labels or grey; detected if omitted.", metavar="KIND"),
    ] = ""
    voxel_size: Annotated[
        str,
        typer.Option(
            "--voxel-size",
            help="Edge of a voxel, or X,Y,Z, in the unit of --unit; read from the file if omitted.",
            metavar="SIZE",
        ),
    ] = ""
    unit: Annotated[
        str, typer.Option("--unit", help="Unit of the voxel size: um, mm, m, nm or cm.", metavar="U")
    ] = ""
    dataset: Annotated[
        str,
        typer.Option(
            "--dataset",
            help="Dataset of an HDF5 file, level of an OME-Zarr, or series of a folder of slices or DICOM.",
            metavar="NAME",
        ),
    ] = ""
    axes: Annotated[
        str,
        typer.Option(
            "--axes",
            help="Order of the axes of NPY and HDF5 arrays; zyx (slices first) if omitted.",
            metavar="AXES",
        ),
    ] = ""
    allow_gaps: Annotated[
        bool,
        typer.Option("--allow-gaps", help="Read slices that are absent from a folder as empty ones."),
    ] = False
    shape: Annotated[
        str,
        typer.Option("--shape", help="Number of voxels of a raw file along x, y and z.", metavar="NX,NY,NZ"),
    ] = ""
    dtype: Annotated[
        str,
        typer.Option("--dtype", help="Data type of a raw file: uint8, uint16, float32, ...", metavar="TYPE"),
    ] = "uint8"
    byte_order: Annotated[
        str, typer.Option("--byte-order", help="Byte order of a raw file: little or big.", metavar="ORDER")
    ] = "little"
    offset: Annotated[
        int,
        typer.Option(
            "--offset",
            min=0,
            max=2**63 - 1,
            help="Number of bytes before the first voxel of a raw file.",
            metavar="N",
        ),
    ] = 0

    def of(self, volume: Path) -> "VolumeInput":
        """The volume with what the options say of it; a wrong one is bad use."""
        from regolith_studio.jobs.extraction_settings import VolumeInput
        from regolith_studio.readers.units import unit_factor

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
    denoise: Annotated[
        str,
        typer.Option(
            "--denoise",
            help="Denoising of grey volumes: none, gaussian, median or non-local-means.",
            metavar="METHOD",
        ),
    ] = "median"
    threshold: Annotated[
        str,
        typer.Option(
            "--threshold",
            help="Threshold of grey volumes: otsu, multi-otsu, multi-otsu:CLASSES:BOUNDARY, a grey value, or "
            "probability[:P[:LOW]] for a probability map, where voxels from LOW on count if they are "
            "connected to some from P on.",
            metavar="HOW",
        ),
    ] = "otsu"
    classifier: Annotated[
        Path | None,
        typer.Option(
            "--classifier",
            help="Classifier that makes a probability map of a grey volume, as `classify train` or the "
            "window writes it; the threshold is then probability:0.5 if omitted.",
            metavar="FILE",
        ),
    ] = None
    objects: Annotated[
        Path | None,
        typer.Option(
            "--objects",
            help="Object classifier that keeps, splits again or drops the grains that were found, as "
            "`classify objects` or the window writes it.",
            metavar="FILE",
        ),
    ] = None
    dark: Annotated[bool, typer.Option("--dark", help="Grains are darker than the matrix.")] = False
    opening: Annotated[
        int,
        typer.Option(
            "--opening",
            min=0,
            max=10,
            help="Radius in voxels of the opening, which removes specks and bridges.",
            metavar="N",
        ),
    ] = 0
    closing: Annotated[
        int,
        typer.Option(
            "--closing",
            min=0,
            max=10,
            help="Radius in voxels of the closing, which fills cracks.",
            metavar="N",
        ),
    ] = 0
    h_maxima: Annotated[
        float,
        typer.Option(
            "--h-maxima",
            min=0.0,
            max=MAX_H,
            help="Height in voxels of the maxima of the distance map that count as separate grains; "
            "larger values give fewer grains.",
            metavar="H",
        ),
    ] = 0.8
    split: Annotated[bool, typer.Option("--split/--no-split", help="Separate touching grains.")] = True
    min_voxels: Annotated[
        int,
        typer.Option(
            "--min-voxels", min=0, max=2**63 - 1, help="Minimum number of voxels of a grain.", metavar="N"
        ),
    ] = 268
    border: Annotated[
        str,
        typer.Option(
            "--border",
            help="Grains cut by the border: exclude (and weight the others) or keep.",
            metavar="HOW",
        ),
    ] = "exclude"
    surface: Annotated[
        str,
        typer.Option(
            "--surface",
            help="Source of the surfaces of grey volumes: grey (values) or mask.",
            metavar="FROM",
        ),
    ] = "grey"

    @property
    def recipe(self) -> "GrainSettings":
        """The settings that the options define; a wrong one is a usage error."""
        from regolith_studio.imaging.extraction import ExtractionSettings
        from regolith_studio.imaging.segmentation.denoising import DenoiseSettings
        from regolith_studio.imaging.segmentation.morphology import CleaningSettings
        from regolith_studio.imaging.segmentation.segment import SegmentationSettings
        from regolith_studio.imaging.segmentation.splitting import SplittingSettings
        from regolith_studio.jobs.extraction_settings import GrainSettings, read_classifier, read_objects

        if self.border not in ("exclude", "keep"):
            raise typer.BadParameter(f"Grains at the border are to exclude or to keep, not {self.border!r}.")
        least = min(self.min_voxels, CleaningSettings.min_voxels)
        trained = read_classifier(self.classifier) if self.classifier else None
        how = "probability" if trained and self.threshold == "otsu" else self.threshold
        return GrainSettings(
            SegmentationSettings(
                DenoiseSettings(self.denoise),  # type: ignore[arg-type]  # checked by the settings
                threshold_from(how, self.dark),
                CleaningSettings(self.opening, self.closing, min_voxels=least),
                SplittingSettings(self.split, self.h_maxima),
                classifier=trained,
                objects=read_objects(self.objects) if self.objects else None,
            ),
            ExtractionSettings(
                exclude_border=self.border == "exclude",
                min_voxels=self.min_voxels,
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


def threshold_from(text: str, dark: bool) -> "ThresholdSettings":
    """The threshold that ``otsu``, ``multi-otsu:4:2``, ``probability:0.6:0.3`` or ``87.5`` denotes."""
    from regolith_studio.imaging.segmentation.thresholding import ThresholdSettings

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
    from regolith_studio.readers.units import MAX_VOXEL, MIN_VOXEL

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
