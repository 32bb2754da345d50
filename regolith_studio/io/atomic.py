"""Files and folders that appear as a whole: a reader finds the old content or the new, never a mix.

New content is written under a hidden name beside the target and takes its place at the end. A folder
that is replaced changes places with the new one in one system call. Where the system has none (neither
Linux nor macOS), the old folder is moved aside first, and :func:`recover_folder` puts it back if the
process dies in between.
"""

import contextlib
import ctypes
import hashlib
import os
import shutil
import sys
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import IO

from regolith_studio.errors import FileError, RegolithError, check_not_stopped, os_error_reason
from regolith_studio.io.file_names import path_inside
from regolith_studio.io.output_lock import LOCK, NEW, hidden_beside, output_lock, release_all, remove_hidden

JOURNAL = "journal"
"""Folder in an output that keeps what is needed to resume unfinished work; it is no part of the result."""

Content = bytes | Iterable[bytes]
"""Of a file: as a whole, or in pieces."""

_REMOVALS, _REMOVAL_SECONDS = 10, 0.05
"""How often the removal of a folder is tried, and what is waited in between."""

_unfinished: set[Path] = set()
"""Hidden files and folders of this process that have not taken their places."""

_RENAME_SWAP = 2  # RENAME_EXCHANGE of Linux's renameat2 and RENAME_SWAP of macOS's renamex_np
_AT_FDCWD = -100


@contextmanager
def staged_file(path: Path) -> Iterator[IO[bytes]]:
    """A stream to a hidden file beside `path`, which takes its name if no exception is raised.

    Raises FileError if it cannot be written, or its folder is not there.
    """
    try:
        with _hidden_path(path) as hidden:
            try:
                with hidden.open("xb") as stream:
                    yield stream
                check_not_stopped()
                hidden.replace(path)
            except BaseException:
                hidden.unlink(missing_ok=True)
                raise
    except OSError as error:
        raise FileError(f"The file {path} cannot be written ({os_error_reason(error)}).") from error


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file in one step.

    Raises FileError if it cannot be written.
    """
    with staged_file(path) as stream:
        stream.write(content)


def write_in_stage(stage: Path, name: str, content: bytes) -> None:
    """Write a file in a folder that is staged itself: what an interruption leaves of it goes with it.

    ``name``: relative to the folder, with slashes.

    Raises FileError if it cannot be written, or would not be in the folder.
    """
    path = path_inside(stage, name)
    try:
        path.write_bytes(content)
    except OSError as error:
        raise FileError(f"The file {path} cannot be written ({os_error_reason(error)}).") from error


def write_files(contents: Mapping[Path, bytes]) -> None:
    """Write files that belong together: all are complete before the first takes its place, in their order.

    Raises FileError if one cannot be written.
    """
    with contextlib.ExitStack() as stack:
        # contexts end in reverse order: the first file takes its place first
        for path, content in reversed(list(contents.items())):
            stream = stack.enter_context(staged_file(path))
            stream.write(content)
            stream.flush()


@contextmanager
def staged_folder(folder: Path, kind: str) -> Iterator[Path]:
    """A hidden folder beside `folder`, which takes its place if no exception is raised.

    The list of its files with their SHA-256, ``<kind>.sha256`` as sha256sum writes it, says what belongs
    together. A folder that holds only what an earlier list names, and perhaps a journal, which is kept, is
    replaced in one step. In a folder with other files, which are kept, the new files take the places of the
    earlier ones one by one.

    Raises FileError if it cannot be written, or another process is writing to it.
    """
    with _reported(folder), hidden_folder(folder) as stage:
        yield stage
        _replace_listed(stage, Path(os.path.realpath(folder)), _written_list(stage, kind))


@contextmanager
def staged_together(folder: Path, kind: str, file: Path) -> Iterator[tuple[Path, IO[bytes]]]:
    """:func:`staged_folder` and :func:`staged_file`, which take their places at the same moment.

    Both are complete by then, and nothing is done in between: only what ends the process within some
    microseconds leaves the new folder beside the earlier file. The file may be one of the folder.

    Raises FileError as these do.
    """
    place, path = Path(os.path.realpath(folder)), Path(os.path.realpath(file))
    if path.is_relative_to(place):
        with staged_folder(folder, kind) as stage:
            inside = stage / path.relative_to(place)
            inside.parent.mkdir(parents=True, exist_ok=True)
            with inside.open("wb") as stream:
                yield stage, stream
        return
    with _reported(folder), hidden_folder(folder) as stage, staged_file(file) as stream:
        with _reported(folder):
            yield stage, stream
            listed = _written_list(stage, kind)
        stream.flush()
        with _reported(folder):
            _replace_listed(stage, place, listed)


@contextmanager
def _reported(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be written ({os_error_reason(error)}).") from error


def listed_hashes(folder: Path) -> dict[str, str]:
    """SHA-256 of the files in a folder by their names, from the lists that :func:`staged_folder` wrote."""
    lines = [line for path in folder.glob("*.sha256") for line in os.fsdecode(path.read_bytes()).splitlines()]
    return {line[66:]: line[:64] for line in lines}


def check_listed(name: str, sha256: str, listed: Mapping[str, str]) -> None:
    """Check a file against the list of its folder.

    Raises FileError if the list has another SHA-256 for it.
    """
    if listed.get(name, sha256) != sha256:
        raise FileError(
            f"{name} is not the file that the list of its folder (.sha256) names: it was changed, or belongs "
            "to another run; remove the list if that is intended."
        )


def replace_folder(target: Path, files: Mapping[str, Content] | Iterable[tuple[str, Content]]) -> None:
    """Make `target` hold exactly `files` (relative POSIX paths), in one step.

    Files may be given as an iterable of pairs, so that they are never in memory together.

    Raises OSError if something cannot be written; `target` is then unchanged. Raises FileError if another
    process is writing to it.
    """
    with filled_folder(target, files) as stage:
        exchange(stage, target)


@contextmanager
def filled_folder(
    target: Path, files: Mapping[str, Content] | Iterable[tuple[str, Content]]
) -> Iterator[Path]:
    """A hidden folder beside `target` with these files, for :func:`exchange`.

    Raises OSError or FileError as :func:`replace_folder`.
    """
    with hidden_folder(target) as stage:
        for name, content in files.items() if isinstance(files, Mapping) else files:
            path = path_inside(stage, name)
            path.parent.mkdir(exist_ok=True)
            with path.open("xb") as stream:
                stream.writelines((content,) if isinstance(content, bytes) else content)
        yield stage


def recover_folder(target: Path) -> Path:
    """Put `target` back if a replacement was interrupted where folders cannot be exchanged; `target`."""
    aside = _aside(target)
    if not target.exists() and aside.is_dir():
        with contextlib.suppress(OSError):
            os.rename(aside, target)  # noqa: PTH104 - all steps on the disk go through os
    return target


def remove_quietly(folder: Path) -> None:
    """Remove a folder if it exists; errors are ignored.

    It is tried again where another process writes into it at the same moment.
    """
    for _ in range(_REMOVALS):
        with contextlib.suppress(OSError):  # rmtree does not ignore the errors of close
            shutil.rmtree(folder, ignore_errors=True)
        if not folder.is_dir():
            return
        time.sleep(_REMOVAL_SECONDS)


def swap_folders(first: Path, second: Path) -> bool:
    """Exchange two folders in one system call; False where system or file system cannot."""
    swap = _system_swap()
    return swap is not None and swap(os.fsencode(first), os.fsencode(second)) == 0


@contextmanager
def hidden_folder(target: Path) -> Iterator[Path]:
    """A new hidden folder beside `target`, removed at the end if it is still there."""
    with output_lock(target), _hidden_path(Path(os.path.realpath(target))) as stage:
        try:
            os.mkdir(stage)  # noqa: PTH102
            yield stage
        except RegolithError as error:
            error.args = tuple(str(each).replace(str(stage), str(target)) for each in error.args)
            raise
        finally:
            remove_quietly(stage)


def remove_unfinished() -> None:
    """Remove the hidden files and folders of this process, and its locks, because it ends at once."""
    for hidden in list(_unfinished):
        remove_hidden(hidden)
    release_all()


@contextmanager
def _hidden_path(target: Path) -> Iterator[Path]:
    hidden = hidden_beside(target, f".{uuid.uuid4().hex[:12]}{NEW}")
    _unfinished.add(hidden)
    try:
        yield hidden
    finally:
        remove_hidden(hidden)  # where an interruption came just before the caller's own removal
        _unfinished.discard(hidden)


def _written_list(folder: Path, kind: str) -> str:
    """Write the list of a folder; its name."""
    write_in_stage(folder, f"{kind}.sha256", _sha256_list(folder))
    return f"{kind}.sha256"


def _sha256_list(folder: Path) -> bytes:
    lines = []
    for name in sorted(_files_in(folder)):
        with (folder / name).open("rb") as stream:
            lines.append(f"{hashlib.file_digest(stream, 'sha256').hexdigest()}  {name}\n")
    return os.fsencode("".join(lines))


def _files_in(folder: Path) -> set[str]:
    """Paths of the files below a folder, relative to it, with slashes."""
    paths = (path for path in folder.rglob("*") if not path.is_dir() and path.suffix not in (NEW, LOCK))
    return {path.relative_to(folder).as_posix() for path in paths}


def _replace_listed(stage: Path, folder: Path, listed: str) -> None:
    """Let the files of `stage` take the place of those in `folder` that its list names."""
    check_not_stopped()
    there = {name for name in _files_in(folder) if not name.startswith(f"{JOURNAL}/")}
    names = [line[66:] for line in os.fsdecode(_read_if_there(folder / listed)).splitlines()]
    earlier = there & {*names, listed}
    # the folder of this process is not exchanged: it would then be the hidden one, which is removed
    if earlier == there and folder != Path.cwd():
        try:
            exchange(stage, folder)
        finally:
            if (stage / JOURNAL).is_dir():
                (stage / JOURNAL).rename(folder / JOURNAL)
        return
    # the list goes first: files that an interruption leaves of the earlier ones are then refused
    (stage / listed).replace(folder / listed)
    fresh = _files_in(stage)
    for name in earlier - fresh - {listed}:
        (folder / name).unlink()
    for name in sorted(fresh):
        path = path_inside(folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        (stage / name).replace(path)


def _read_if_there(path: Path) -> bytes:
    return path.read_bytes() if path.is_file() else b""


def exchange(fresh: Path, target: Path) -> None:
    """Move a folder to `target` in one step; afterwards `fresh` holds the old content, if there was any."""
    check_not_stopped()
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
    os.rename(aside, fresh)  # noqa: PTH104


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
