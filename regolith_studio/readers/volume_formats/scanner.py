"""Plain voxels that a text of VGStudio, ESRF or Nikon beside them describes."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.scanner_headers import READERS, open_described
from regolith_studio.readers.voxels.stored import PlainVoxels


def open_scanner(path: Path, _options: Mapping[str, Any]) -> PlainVoxels:
    """The voxels that the header describes."""
    return open_described(path)


FORMAT = VolumeFormat("scanner", "a scanner's header", tuple(READERS), lambda _head: False, open_scanner)
