"""Which files of a folder belong to one volume: a DICOM series, a Zarr hierarchy."""

import os
from pathlib import Path

from regolith_studio.errors import FileError

ZARR_METADATA = ("zarr.json", ".zattrs", ".zgroup")
MAX_FILES = 1_000_000
DICOM_SUFFIXES = (".dcm", ".ima", ".dicom")
_PREAMBLE, _DICOM = 128, b"DICM"


def is_zarr(folder: Path) -> bool:
    """Whether a folder is a group or an array of Zarr."""
    return any((folder / name).is_file() for name in ZARR_METADATA)


def zarr_names(folder: Path) -> tuple[str, ...]:
    """All files below a folder of Zarr, relative to it, in the order of their names; links are not followed.

    Raises
    ------
    FileError
        If there are more than a million.
    """
    found: list[str] = []
    for place, _, names in os.walk(folder):
        found += (os.path.relpath(os.path.join(place, name), folder) for name in names)  # noqa: PTH118
        if len(found) > MAX_FILES:
            raise FileError(f"holds more than {MAX_FILES:,} files; save it with larger chunks.")
    return tuple(sorted(found))


def is_dicom(path: Path) -> bool:
    """Whether a file begins as DICOM does: 128 bytes and four letters. One that cannot be read does not."""
    try:
        with path.open("rb") as file:
            return file.read(_PREAMBLE + len(_DICOM)).endswith(_DICOM, _PREAMBLE)
    except OSError:
        return False


def dicom_names(folder: Path) -> tuple[str, ...]:
    """The DICOM files in a folder, in the order of their names.

    Where there are some, files with a suffix of DICOM are among them even if they are damaged.
    """
    with os.scandir(folder) as entries:
        likely = [
            entry.name
            for entry in entries
            if not entry.name.startswith(".") and entry.is_file() and _may_be_dicom(entry.name)
        ]
    found = {name for name in likely if is_dicom(folder / name)}
    named = {name for name in likely if name.lower().endswith(DICOM_SUFFIXES)} if found else set()
    return tuple(sorted(found | named))


def _may_be_dicom(name: str) -> bool:
    suffix = Path(name).suffix.lower()
    return suffix in ("", *DICOM_SUFFIXES) or suffix[1:].isdigit()
