"""Files that belong to a header file: beside it, never elsewhere."""

import os
from pathlib import Path

from regolith_studio.errors import FileError
from regolith_studio.readers.sentences import printable

LONGEST_NAME = 255
"""Bytes of a file's name that file systems allow."""


def beside(path: Path, name: str) -> Path:
    """The file of that name in the folder of `path`.

    Raises
    ------
    FileError
        If the name leads elsewhere, or there is no such regular file.
    """
    shown = printable(name)[:60]
    if not _is_bare(name):
        raise FileError(f"points to voxels in “{shown}”; only a file in the same folder is read.")
    target = path.parent / name
    if target.is_symlink() and Path(os.path.realpath(target)).parent != Path(os.path.realpath(path.parent)):
        raise FileError(f"points to voxels in “{shown}”, which is a link to another folder.")
    if not target.is_file():
        raise FileError(f"needs the file “{shown}” beside it, which is not there.")
    if target.samefile(path):
        raise FileError("points to itself for its voxels.")
    return target


def _is_bare(name: str) -> bool:
    """Whether this can be the name of a file in any folder, and of nothing else."""
    if not name or name in (".", "..") or "\0" in name or "\\" in name:
        return False
    return len(name.encode("utf-8", "replace")) <= LONGEST_NAME and Path(name).name == name
