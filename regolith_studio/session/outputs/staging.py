"""Files and folders that appear whole or not at all."""

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from regolith_studio.errors import FileError


@contextmanager
def staged_folder(folder: Path) -> Iterator[Path]:
    """A hidden folder beside `folder`; what is in it moves to `folder` if all went well.

    Files of the same names are replaced, other files in `folder` are left alone.

    Raises
    ------
    FileError
        If the place cannot be written.
    """
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        stage = Path(tempfile.mkdtemp(dir=folder.parent, prefix=f".{folder.name}-"))
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be written ({error.strerror}).") from error
    try:
        yield stage
        _move_into(stage, folder)
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be written ({error.strerror}).") from error
    finally:
        shutil.rmtree(stage, ignore_errors=True)


@contextmanager
def staged_file(path: Path) -> Iterator[IO[bytes]]:
    """A stream to a hidden file beside `path`, which gets its name if all went well.

    Raises
    ------
    FileError
        If the place cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}-")
        try:
            with os.fdopen(handle, "wb") as stream:
                yield stream
            Path(name).chmod(0o666 & ~_umask())
            Path(name).replace(path)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise FileError(f"The file {path} cannot be written ({error.strerror}).") from error


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file under another name and give it its own when it is whole.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    with staged_file(path) as stream:
        stream.write(content)


def json_bytes(document: Any) -> bytes:
    """Indented JSON, ending in a newline; refuses what is not finite."""
    text = json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)
    return text.encode("utf-8") + b"\n"


def _move_into(stage: Path, folder: Path) -> None:
    if not folder.exists():
        stage.chmod(0o777 & ~_umask())
        stage.replace(folder)
        return
    for path in sorted(stage.rglob("*")):
        target = folder / path.relative_to(stage)
        if path.is_dir():
            target.mkdir(exist_ok=True)
        else:
            path.replace(target)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
