"""The synthetic scan that ships with the program.

Only the program's own files are read here; volumes of users go through ``readers``.
"""

from pathlib import Path
from typing import Any, Literal

import numpy as np
import tifffile

from regolith_studio.imaging.volume import Volume
from regolith_studio.resources import resource

SampleVolume = Literal["labels", "grey"]


def sample_file(kind: SampleVolume) -> Path:
    """Path of the shipped scan.

    Raises
    ------
    MissingRequirement
        If the installation lacks its samples.
    """
    return resource("samples", "ct", f"synthetic-{kind}.tif")


def sample_volume(kind: SampleVolume = "labels") -> Volume:
    """The shipped synthetic scan of about 60 grains: its label volume, or its grey values.

    Raises
    ------
    MissingRequirement
        If the installation lacks its samples.
    """
    with tifffile.TiffFile(sample_file(kind)) as file:
        slices: Any = file.asarray()
        metadata = file.imagej_metadata or {}
        pixels, length = file.pages.first.tags["XResolution"].value
    size = (length / pixels, length / pixels, float(metadata["spacing"]))
    return Volume(slices.T, np.array(size), kind, f"sample:ct/synthetic-{kind}")
