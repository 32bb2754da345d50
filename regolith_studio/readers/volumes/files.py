"""Find volumes: a file, a folder of slices, or each volume in a folder."""

import os
from pathlib import Path

from regolith_studio.errors import FileError
from regolith_studio.io.file_names import natural_key
from regolith_studio.readers.error_messages import about_file, display_name
from regolith_studio.readers.sandbox.parent import checked_size
from regolith_studio.readers.volume_formats import VOLUME_FORMATS, volume_suffixes
from regolith_studio.readers.voxels.slice_series import (
    dicom_names,
    is_dicom,
    is_zarr,
    number_ranges,
    slice_series,
    zarr_names,
)


def volume_files(path: str | Path) -> tuple[Path, ...]:
    """The volumes that a path stands for, in the order of their names.

    A file is a volume. A folder of Zarr, with DICOM files, or with three or more images whose names differ
    in a number only is one volume, given as the folder itself; any other folder stands for the volume files
    in it (raw ones apart, which must be described one by one) and the folders in it that are volumes.

    Raises FileError if there is nothing at the path, or nothing in the folder.
    """
    path = Path(path)
    if not path.is_dir():
        checked_size(path, largest=None)
        return (path,)
    if member_names(path):
        return (path,)
    suffixes = tuple(sorted(volume_suffixes() - set(VOLUME_FORMATS["raw"].suffixes)))
    files = [file for file in _visible_names(path) if file.lower().endswith(suffixes)]
    files += [folder for folder in _visible_folders(path) if member_names(path / folder)]
    if not files:
        raise FileError(
            f"The folder {display_name(path)} holds no volume; volumes end in {', '.join(suffixes)}."
        )
    return tuple(path / file for file in sorted(files, key=natural_key))


def member_names(path: Path) -> tuple[str, ...]:
    """Names, relative to :func:`member_folder`, of the files that are one volume; empty if it is one file.

    Raises FileError if there are too many.
    """
    if not path.is_dir():
        return dicom_names(path.parent) if path.is_file() and is_dicom(path) else ()
    with about_file(path):
        return zarr_names(path) if is_zarr(path) else dicom_names(path) or slice_names(path)


def member_folder(path: Path) -> Path:
    """The folder of the files that are one volume."""
    return path if path.is_dir() else path.parent


def slice_names(folder: Path) -> tuple[str, ...]:
    """Names of the slices in a folder, series by series in the order of their numbers; or none."""
    series, _ = slice_series(_visible_names(folder))
    return tuple(name for each in series for name in each.files)


def missing_slices(folder: Path) -> dict[str, str]:
    """Numbers that are absent from series of slices in a folder, as text, by the names of the series."""
    if not folder.is_dir() or is_zarr(folder) or dicom_names(folder):
        return {}
    series, _ = slice_series(_visible_names(folder))
    return {each.name: number_ranges(each.missing, each.step) for each in series if each.missing}


def members_stamp(folder: Path, names: tuple[str, ...]) -> tuple[int, list[int]]:
    """Bytes of the files of a volume in all, and a fingerprint of their sizes and times.

    Raises FileError if one of them is not a regular file.
    """
    total, newest = 0, 0
    for name in names:
        total += checked_size(folder / name)
        newest = max(newest, (folder / name).stat().st_mtime_ns)
    return total, [total, newest, len(names)]


def _visible_names(folder: Path) -> list[str]:
    return [entry.name for entry in os.scandir(folder) if not entry.name.startswith(".") and entry.is_file()]


def _visible_folders(folder: Path) -> list[str]:
    return [entry.name for entry in os.scandir(folder) if not entry.name.startswith(".") and entry.is_dir()]
