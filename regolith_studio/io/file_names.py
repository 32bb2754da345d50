"""Names of files that are made of names of things: particles, populations, scans.

The names of things are text and may hold anything. Each name that becomes a file's goes through
:func:`file_stem`, and each path within an output through :func:`path_inside`.
"""

import os
import re
import unicodedata
from pathlib import Path

from regolith_studio.errors import FileError

MAX_NAME_BYTES = 100
"""Of a name in UTF-8: file systems allow 255 bytes, endings follow, and some paths must be below 260."""

_SEPARATORS = frozenset('/\\:*?"<>|')
"""Separate folders, drives, streams or patterns on one of the systems."""
_DEVICES = {"con", "prn", "aux", "nul", "conin$", "conout$"} | {
    f"{device}{digit}" for device in ("com", "lpt") for digit in "0123456789¹²³"
}
"""Names of devices on Windows, whatever ending follows."""
_PART = re.compile(r"\.(part\d+)$", re.IGNORECASE)
"""Ends the names of the files of convex parts, which stand beside that of their union."""


def file_stem(name: str) -> str:
    """The name of a file without its ending for a thing of this name.

    It holds no separators, drive letters or unprintable characters, does not begin or end in a point, ends in
    no blank, is neither empty nor reserved by a system, and has at most MAX_NAME_BYTES bytes.
    """
    text = "".join("_" if sign in _SEPARATORS or not sign.isprintable() else sign for sign in name)
    text = _PART.sub(r"_\1", cut_name(text).rstrip(". "))
    if text.startswith("."):
        text = f"_{text[1:]}"
    if text.partition(".")[0].rstrip().casefold() in _DEVICES:
        text = f"{cut_name(text, MAX_NAME_BYTES - 1).rstrip('. ')}"
        device, point, rest = text.partition(".")
        text = f"{device.rstrip()}_{point}{rest}"
    return text or "_"


def unique_name(name: str, group: str, used: dict[str, int]) -> str:
    """The name; if another has its file name, the name with its group, then with a number.

    What cannot be printed becomes a line, and what is too long is cut.

    ``used``: the :func:`name_key` of each earlier name, and the last number that it was given with; the new
    name is added.
    """
    name = _printable(name)
    if name_key(name) in used and group:
        name = _printable(f"{group.replace('/', '_')}_{name}")
    base, number = name, used.get(name_key(name), 1)
    while name_key(name) in used:
        number += 1
        end = f"_{number}"
        name = f"{cut_name(base, MAX_NAME_BYTES - len(end))}{end}"
    used[name_key(base)] = number
    used.setdefault(name_key(name), 1)
    return name


def name_key(name: str) -> str:
    """Equal for names whose files would be one and the same on some file system."""
    return unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", file_stem(name)).casefold())


def path_inside(folder: Path, name: str) -> Path:
    """The path of a file in a folder by its relative name with slashes.

    Raises FileError if it is not in the folder, also where a link leads out of it.
    """
    path = folder / name
    parts = name.split("/")
    if any(part in ("", ".", "..") or "\\" in part or ":" in part or "\0" in part for part in parts) or (
        not Path(os.path.realpath(path.parent)).is_relative_to(os.path.realpath(folder))
    ):
        raise FileError(f"The file {name!r} would not be in the folder {folder}; nothing was written there.")
    return path


def cut_name(name: str, n_bytes: int = MAX_NAME_BYTES) -> str:
    """The beginning of a name that has at most so many bytes in UTF-8."""
    return name.encode("utf-8", "replace")[:n_bytes].decode("utf-8", "ignore")


def _printable(name: str) -> str:
    return cut_name("".join(sign if sign.isprintable() else "_" for sign in name)) or "_"


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Sort key by which ``slice10`` comes after ``slice9``."""
    parts = re.split(r"(\d+)", name)
    return [(1, int(part), "") if part.isdigit() and part.isascii() else (0, 0, part) for part in parts]
