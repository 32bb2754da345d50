"""A folder that is replaced as a whole: whoever looks sees the old content or the new, never a mix.

The new content is written into a hidden folder beside the target and brought to the disk (fsync);
then the two folders change places in one step of the operating system. Where a system cannot swap
(neither Linux nor macOS), the old folder is moved aside first; :func:`recovered` puts it back if the
program dies in between.
"""

import contextlib
import ctypes
import glob
import os
import shutil
import sys
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from pathlib import Path

_RENAME_SWAP = 2  # RENAME_EXCHANGE of Linux's renameat2 and RENAME_SWAP of macOS's renamex_np
_AT_FDCWD = -100

LEFTOVER_AGE = 3600.0
"""Seconds after which what an interrupted write has left is taken for dead and removed."""


SYNCED_AT_ONCE = 16
"""Files that are on their way to the disk at the same time."""

Content = bytes | Iterable[bytes]
"""Of a file: whole, or piece by piece."""


def replace_folder(target: Path, files: Mapping[str, Content] | Iterable[tuple[str, Content]]) -> None:
    """Make `target` hold exactly `files` (relative POSIX paths), in one step.

    Files may come one by one, as pairs, so that they are never in memory together.

    Raises
    ------
    OSError
        If something cannot be written; `target` is then as it was.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    fresh = target.with_name(f".{target.name}.{uuid.uuid4().hex[:12]}.regolith-new")
    try:
        _fill(fresh, files)
        _put_in_place(fresh, target)
    except BaseException:
        remove_quietly(fresh)
        raise
    remove_quietly(fresh)
    _clear_old_leftovers(target)
    with contextlib.suppress(OSError):
        sync_folder(target.parent)


def recovered(target: Path) -> Path:
    """`target`, put back first if a replacement was interrupted where folders cannot be swapped."""
    aside = _aside(target)
    if not target.exists() and aside.is_dir():
        with contextlib.suppress(OSError):
            os.rename(aside, target)  # noqa: PTH104 - all steps on the disk go through os
    return target


def leftovers(target: Path) -> list[Path]:
    """Hidden folders beside `target` that interrupted writes have left, or that others are writing."""
    return sorted(target.parent.glob(f".{glob.escape(target.name)}.????????????.regolith-new"))


def _clear_old_leftovers(target: Path) -> None:
    for folder in leftovers(target):
        with contextlib.suppress(OSError):
            if time.time() - folder.stat().st_mtime > LEFTOVER_AGE:
                remove_quietly(folder)


def remove_quietly(folder: Path) -> None:
    """Remove a folder of ours if it is there; what cannot be removed stays."""
    with contextlib.suppress(OSError):  # rmtree lets the errors of close pass
        shutil.rmtree(folder, ignore_errors=True)


def _written(path: Path, content: Content) -> int:
    """Handle of a new file that has its content, though perhaps not yet on the disk."""
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        for piece in (content,) if isinstance(content, bytes) else content:
            rest = memoryview(piece)
            while rest:
                rest = rest[os.write(handle, rest) :]
    except BaseException:
        os.close(handle)
        raise
    return handle


class Syncing:
    """Brings files to the disk, several at the same time: disks then wait once for many.

    A disk takes milliseconds to say that a file is safe, and as long for two files; one after the
    other, 10,000 files take more than a minute.
    """

    def __enter__(self) -> "Syncing":
        self._threads = ThreadPoolExecutor(SYNCED_AT_ONCE, thread_name_prefix="sync")
        self._open: deque[Future[None]] = deque()
        return self

    def close(self, handle: int) -> None:
        """Bring the file of a handle to the disk and close it, soon.

        Raises
        ------
        OSError
            If that has failed for a file before.
        """
        self._open.append(self._threads.submit(_synced, handle))
        while len(self._open) > 4 * SYNCED_AT_ONCE:
            self._open.popleft().result()

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        self._threads.shutdown()
        for each in self._open:
            if kind is None:
                each.result()


def _synced(handle: int) -> None:
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def sync_folder(folder: Path) -> None:
    """Bring a folder's list of names to the disk, where the system can."""
    if os.name == "nt":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _fill(folder: Path, files: Mapping[str, Content] | Iterable[tuple[str, Content]]) -> None:
    os.mkdir(folder)  # noqa: PTH102
    folders = {folder}
    with Syncing() as syncing:
        for name, content in files.items() if isinstance(files, Mapping) else files:
            path = folder.joinpath(*name.split("/"))
            if path.parent not in folders:
                os.mkdir(path.parent)  # noqa: PTH102
                folders.add(path.parent)
            syncing.close(_written(path, content))
    for inner in sorted(folders, key=lambda one: len(one.parts), reverse=True):
        sync_folder(inner)


def _put_in_place(fresh: Path, target: Path) -> None:
    """Move `fresh` to `target`; afterwards `fresh` holds the old content, if there was any."""
    if not target.exists():
        os.rename(fresh, target)  # noqa: PTH104
        return
    if swap_folders(fresh, target):
        return
    aside = _aside(target)
    remove_quietly(aside)
    os.rename(target, aside)  # noqa: PTH104
    try:
        os.rename(fresh, target)  # noqa: PTH104
    except OSError:
        os.rename(aside, target)  # noqa: PTH104
        raise
    remove_quietly(aside)


def swap_folders(first: Path, second: Path) -> bool:
    """Let two folders change places in one step; False where system or file system cannot."""
    swap = _system_swap()
    return swap is not None and swap(os.fsencode(first), os.fsencode(second)) == 0


@cache
def _system_swap() -> Callable[[bytes, bytes], int] | None:
    try:
        library = ctypes.CDLL(None, use_errno=True)
        if sys.platform == "darwin":
            apple = library.renamex_np
            return lambda first, second: int(apple(first, second, _RENAME_SWAP))
        linux = library.renameat2
    except (OSError, AttributeError, TypeError):
        return None
    return lambda first, second: int(linux(_AT_FDCWD, first, _AT_FDCWD, second, _RENAME_SWAP))


def _aside(target: Path) -> Path:
    return target.with_name(f".{target.name}.regolith-old")
