"""The synthetic scans that ship with the program.

Only the program's own files are read here; volumes of users go through ``readers``.
"""

from pathlib import Path
from typing import Any, Literal

import numpy as np
import tifffile

from regolith_studio.imaging.volume import Volume
from regolith_studio.resources import resource

SampleVolume = Literal["labels", "grey"]
SampleScan = Literal["synthetic", "gradient"]
"""The plain scan, and one with a gradient of grey values, cupping and rings that no threshold segments."""


def sample_file(kind: SampleVolume | Literal["strokes"], scan: SampleScan = "synthetic") -> Path:
    """Path of a shipped scan; ``strokes`` are voxels that were painted on the scan ``gradient``.

    Raises MissingRequirement if the installation lacks its samples.
    """
    return resource("samples", "ct", f"{scan}-{kind}.tif")


def sample_volume(kind: SampleVolume = "labels", scan: SampleScan = "synthetic") -> Volume:
    """A shipped synthetic scan, of 60 grains or of 30: its label volume, or its grey values.

    Raises MissingRequirement if the installation lacks its samples.
    """
    with tifffile.TiffFile(sample_file(kind, scan)) as file:
        slices: Any = file.asarray()
        metadata = file.imagej_metadata or {}
        pixels, length = file.pages.first.tags["XResolution"].value
    size = (length / pixels, length / pixels, float(metadata["spacing"]))
    return Volume(slices.T, np.array(size), kind, f"sample:ct/{scan}-{kind}")
