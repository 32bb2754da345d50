"""The folder of a run: snapshots while it goes, ``repose.json`` and ``final.npz`` at its end."""

import io
import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.case import Prepared
from regolith_studio.dem.pile import Pile, pile_bytes
from regolith_studio.errors import FileError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.json_text import canonical_json, parse_strict_json

FORMAT = "regolith-studio-repose"
SCHEMA_VERSION = 1
DOCUMENT, FINAL, SHAPES, SNAPSHOTS = "repose.json", "final.npz", "shapes.npz", "snapshots"
OWN = {DOCUMENT, FINAL, SHAPES, SNAPSHOTS, "sections.png", "sections.svg"}


@dataclass(frozen=True)
class RunSummary:
    """One line of the table of runs."""

    folder: Path
    document: dict[str, Any]

    @property
    def angle(self) -> float | None:
        """Degrees, or ``None`` where there is no pile."""
        angle = (self.document.get("measurement") or {}).get("angle_deg")
        return None if angle is None else float(angle)


def claim_folder(folder: Path, overwrite: bool) -> None:
    """Make the folder, empty but for nothing; an earlier run in it is removed if that is allowed.

    Raises
    ------
    FileError
        If it holds something else, or may not be replaced, or cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        inside = {path.name for path in folder.iterdir()}
        if inside and not inside <= OWN:
            raise FileError(f"{folder} holds other files ({min(inside - OWN)}); choose an empty folder.")
        if inside and not overwrite:
            raise FileError(
                f"{folder} holds a run already; choose another folder or allow it to be overwritten."
            )
        for name in inside:
            path = folder / name
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        (folder / SNAPSHOTS).mkdir()
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be written ({error.strerror}).") from error


def save_snapshot(folder: Path, number: int, pile: Pile) -> Path:
    """Write one snapshot, whole or not at all."""
    return _write(folder / SNAPSHOTS / f"{number:06d}.npz", pile_bytes(pile))


def save_shapes(folder: Path, prepared: Prepared) -> Path:
    """The unit-volume shapes of a run, so that it can be replayed without its dataset."""
    buffer = io.BytesIO()
    shapes: dict[str, Any] = {f"shape_{k:05d}": shape for k, shape in enumerate(prepared.shapes)}
    np.savez_compressed(buffer, **shapes)
    return _write(folder / SHAPES, buffer.getvalue())


def save_ending(folder: Path, document: dict[str, Any], final: Pile | None) -> None:
    """Write the result; the document comes last, so that it never names what is not there.

    Raises
    ------
    FileError
        If the disk is full or the folder is gone.
    """
    try:
        if final is not None:
            _write(folder / FINAL, pile_bytes(final))
        _write(folder / DOCUMENT, canonical_json(document).encode("utf-8"))
    except OSError as error:
        raise FileError(f"The result could not be written to {folder} ({error.strerror}).") from error


def snapshot_files(folder: Path) -> list[Path]:
    """Snapshots of a run in the order of time."""
    return sorted((folder / SNAPSHOTS).glob("[0-9]*.npz"))


def read_shapes(folder: Path) -> tuple[FloatArray, ...]:
    """Vertices of the shapes of a run.

    Raises
    ------
    FileError
        If the file is missing or broken.
    """
    try:
        with np.load(folder / SHAPES, allow_pickle=False) as content:
            return tuple(np.asarray(content[name], dtype=np.float64) for name in sorted(content.files))
    except (OSError, ValueError, EOFError) as error:
        raise FileError(f"{folder / SHAPES} holds no shapes of a run.") from error


def read_run(folder: Path) -> RunSummary:
    """The result of a run.

    Raises
    ------
    FileError
        If the folder holds none.
    """
    path = folder / DOCUMENT
    try:
        document = parse_strict_json(path.read_text("utf-8"), str(path))
    except (OSError, UnicodeDecodeError, FileError) as error:
        raise FileError(f"{folder} holds no result of a run.") from error
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise FileError(f"{path} is no result of a run of this program.")
    return RunSummary(folder, document)


def find_runs(folder: Path) -> list[RunSummary]:
    """Runs in a folder and directly below it, by name; what is broken is left out."""
    found = []
    for place in (folder, *sorted(path for path in folder.iterdir() if path.is_dir())):
        try:
            found.append(read_run(place))
        except FileError:
            continue
    return found


def _write(path: Path, content: bytes) -> Path:
    fresh = path.with_name(f".{path.name}.new")
    try:
        fresh.write_bytes(content)
        os.replace(fresh, path)  # noqa: PTH105
    except OSError:
        fresh.unlink(missing_ok=True)
        raise
    return path
