"""Files that belong to a header file: beside it, never elsewhere."""

from pathlib import Path

from regolith_studio.errors import FileError
from regolith_studio.readers.sentences import printable


def beside(path: Path, name: str) -> Path:
    """The file of that name in the folder of `path`.

    Raises
    ------
    FileError
        If the name leads elsewhere, or there is no such regular file.
    """
    shown = printable(name)[:60]
    if not name or "\0" in name or Path(name).name != name or "\\" in name or name in (".", ".."):
        raise FileError(f"points to voxels in “{shown}”; only a file in the same folder is read.")
    target = path.parent / name
    if target.is_symlink() and target.resolve().parent != path.parent.resolve():
        raise FileError(f"points to voxels in “{shown}”, which is a link to another folder.")
    if not target.is_file():
        raise FileError(f"needs the file “{shown}” beside it, which is not there.")
    if target.samefile(path):
        raise FileError("points to itself for its voxels.")
    return target
