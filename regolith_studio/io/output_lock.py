"""A lock beside an output, so that two processes do not write to one place.

The lock is a hidden file that the system locks, so that it ends with the process however that ends.
"""

import contextlib
import glob
import hashlib
import os
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.errors import FileError

NEW = ".regolith-new"
"""End of the hidden names under which new content is written."""

LOCK = ".regolith-lock"

_MAX_NAME_BYTES = 200
"""Of a name with which hidden names begin; file systems allow 255 bytes."""

_TWELVE = "[0-9a-f]" * 12

_guard = threading.Lock()


@dataclass
class _Held:
    handle: int
    file: Path
    made: list[Path]
    count: int = 0


_held: dict[Path, _Held] = {}


@contextmanager
def output_lock(output: Path) -> Iterator[None]:
    """Keep other processes from writing to a file or folder; this process may ask for it again.

    Its parent folders are made. What interrupted writes to it have left under hidden names is removed.

    Raises FileError if another process is writing to it. Raises OSError if its parent folder cannot be
    written.
    """
    place = Path(os.path.realpath(output))
    with _guard:
        if place not in _held:
            _acquire(place, output)
        _held[place].count += 1
    try:
        yield
    finally:
        with _guard:
            held = _held[place]
            held.count -= 1
            if not held.count:
                _release(held)
                del _held[place]


def release_all() -> None:
    """Give up all locks, because this process ends; also those that an interruption has left."""
    while _held:
        _release(_held.popitem()[1])


def hidden_beside(target: Path, end: str) -> Path:
    """A hidden path in the folder of `target`, whose name begins with the target's and has this end."""
    name = target.name
    if len(os.fsencode(name)) > _MAX_NAME_BYTES:
        name = hashlib.sha256(os.fsencode(name)).hexdigest()
    return target.with_name(f".{name}{end}")


def leftovers(target: Path) -> list[Path]:
    """Hidden files and folders beside `target`, and directly in it, of interrupted writes or of others."""
    name = glob.escape(hidden_beside(target, "").name)
    return sorted([*target.parent.glob(f"{name}.{_TWELVE}{NEW}"), *target.glob(f".*.{_TWELVE}{NEW}")])


def _acquire(place: Path, output: Path) -> None:
    """Lock, and tidy up; known to :func:`release_all` as soon as the file is there."""
    made = [folder for folder in place.parents if not folder.exists()]
    place.parent.mkdir(parents=True, exist_ok=True)
    file = hidden_beside(place, LOCK)
    try:
        # Known as soon as it is there: two of 300 signals came in between and left a lock behind.
        _held[place] = _Held(lock_file(file), file, made)
    except BlockingIOError:
        raise FileError(f"Another process is writing to {output}; wait for its end.") from None
    for path in leftovers(place):
        remove_hidden(path)


def lock_file(file: Path) -> int:
    """Handle of a file that only this process has locked, until it closes the handle or ends.

    Raises BlockingIOError if it is locked already. Raises OSError if it cannot be made.
    """
    while True:
        # Opened and locked, it must still be the file of that name: its last owner may have removed it in
        # between.
        handle = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            _lock(handle)
            if os.name == "nt" or os.path.samestat(os.stat(file), os.fstat(handle)):  # noqa: PTH116
                return handle
        except FileNotFoundError:  # removed by its last owner after it was opened here
            pass
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)


def _lock(handle: int) -> None:
    if os.name == "nt":
        import msvcrt

        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
        except OSError as error:
            raise BlockingIOError from error
        return
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError:  # a file system without locks
        return


def _release(held: _Held) -> None:
    with contextlib.suppress(OSError):
        # while it is still locked: after that it could be the lock of a next owner
        if os.name != "nt":  # there an open file cannot be removed
            held.file.unlink()
    with contextlib.suppress(OSError):
        os.close(held.handle)
        if os.name == "nt":
            held.file.unlink()
    for folder in held.made:
        with contextlib.suppress(OSError):  # not empty: the output is there
            folder.rmdir()


def remove_hidden(path: Path) -> None:
    """Remove a file or a folder if it is there; errors are ignored."""
    with contextlib.suppress(OSError):
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink()
