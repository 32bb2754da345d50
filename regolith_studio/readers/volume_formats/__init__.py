"""Volume formats; each module of this folder defines one as ``FORMAT``."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from regolith_studio.readers.voxels.header import OpenVolume
from regolith_studio.registry import Registry


@dataclass(frozen=True)
class VolumeFormat:
    """A volume format.

    - ``key``: short name, ``tiff``.
    - ``label``: as in a sentence, ``a TIFF stack``.
    - ``suffixes``: lower case, with the dot.
    - ``recognises``: whether the first 1,024 bytes can only be this format.
    - ``prepare``: import the libraries that `open` needs.
    - ``holds``: whether a folder is a volume of this format.
    - ``open``: path and options of the request to an opened volume. Raises ``FileError`` with the end of a
      sentence that begins with the file's name.
    """

    key: str
    label: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    open: Callable[[Path, Mapping[str, Any]], OpenVolume]
    prepare: Callable[[], None] = lambda: None
    holds: Callable[[Path], bool] = lambda _folder: False


VOLUME_FORMATS: Registry[VolumeFormat] = Registry(__name__, "FORMAT", "volume_readers")

WITH_AXES = ("npy", "hdf5")
"""Formats whose axes a user may state: they hold arrays without naming them."""


def volume_suffixes() -> frozenset[str]:
    """The suffixes of all volume formats, lower case, with the dot."""
    return frozenset(suffix for row in VOLUME_FORMATS.values() for suffix in row.suffixes)
