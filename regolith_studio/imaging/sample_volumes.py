"""The shipped synthetic scan as TIFF: written by the sample generator, read back without questions.

Only the program's own files come through here; volumes of users go through ``readers``, which guards.
"""

import io
from pathlib import Path
from typing import Any, Literal

import numpy as np
import tifffile

from regolith_studio.imaging.volume import Volume
from regolith_studio.resources import resource

SampleVolume = Literal["labels", "grey"]

_imwrite: Any = tifffile.imwrite


def tiff_bytes(volume: Volume) -> bytes:
    """The volume as a zlib-compressed TIFF stack (slices first) with ImageJ's voxel size in micrometres.

    Raises
    ------
    ValueError
        If voxels are not as wide as high, for which ImageJ's two resolution tags would be needed.
    """
    width, height, depth = volume.voxel_size
    if width != height:
        raise ValueError(f"voxels must be as wide as high, got {volume.voxel_size}")
    buffer = io.BytesIO()
    _imwrite(
        buffer,
        np.ascontiguousarray(volume.array.T),
        imagej=True,
        compression="zlib",
        compressionargs={"level": 9},
        resolution=(1 / width, 1 / height),
        metadata={"axes": "ZYX", "spacing": float(depth), "unit": "um"},
        software="regolith-studio",
    )
    return buffer.getvalue()


def sample_file(kind: SampleVolume) -> Path:
    """Where the shipped scan is.

    Raises
    ------
    EnvironmentProblem
        If the installation lacks its samples.
    """
    return resource("samples", "ct", f"synthetic-{kind}.tif")


def sample_volume(kind: SampleVolume = "labels") -> Volume:
    """The shipped synthetic scan of about 60 grains: its label volume, or its grey values.

    Raises
    ------
    EnvironmentProblem
        If the installation lacks its samples.
    """
    with tifffile.TiffFile(sample_file(kind)) as file:
        slices: Any = file.asarray()
        metadata = file.imagej_metadata or {}
        pixels, length = file.pages.first.tags["XResolution"].value
    size = (length / pixels, length / pixels, float(metadata["spacing"]))
    return Volume(slices.T, np.array(size), kind, f"sample:ct/synthetic-{kind}")
