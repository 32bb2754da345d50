"""Child processes: a module of this program in a new Python, and programs of others that write files."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

_ONE_THREAD = dict.fromkeys(
    ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)
OUTPUT = "output.txt"
"""File of the folder that gets what a program prints."""
POLL_INTERVAL = 0.1
"""Seconds between two checks for a new file."""


def start_module(
    module: str,
    *arguments: str,
    environment: Mapping[str, str] | None = None,
    stdout: int = subprocess.PIPE,
    bufsize: int = -1,
    start_new_session: bool = False,
) -> "subprocess.Popen[bytes]":
    """Start ``python -m module`` with pipes to its standard input and output, and one thread a library.

    ``environment``: variables besides those of this process. ``stdout``, ``bufsize``, ``start_new_session``:
    as for :class:`subprocess.Popen`.
    """
    # a checkout that is not installed is found by its path; -P keeps files of the current folder out
    search_path = [str(Path(__file__).resolve().parents[2]), os.environ.get("PYTHONPATH", "")]
    path = {"PYTHONPATH": os.pathsep.join(filter(None, search_path))}
    return subprocess.Popen(
        [sys.executable, "-P", "-m", module, *arguments],
        stdin=subprocess.PIPE,
        stdout=stdout,
        stderr=subprocess.DEVNULL,
        bufsize=bufsize,
        env={**os.environ, **_ONE_THREAD, **path, **(environment or {})},
        start_new_session=start_new_session,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )


def private_pipes(buffering: int = -1) -> tuple[Any, Any]:
    """In the child: the pipes to the parent, out of reach of anything that prints."""
    source, target = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDWR)
    # A library that prints, also one in C, would damage the messages.
    for number in (0, 1, 2):
        os.dup2(nothing, number)
    os.close(nothing)
    return os.fdopen(source, "rb", buffering), os.fdopen(target, "wb", buffering)


def end_with_parent(source: BinaryIO) -> None:
    """In the child: end, with all that this process has started, when the parent closes its end of `source`.

    A group is killed only where this process leads it: else it is the group of the parent.
    """
    threading.Thread(target=_end_after, args=(source,), name="parent", daemon=True).start()


def _end_after(source: BinaryIO) -> None:
    with contextlib.suppress(OSError):
        # not source.read: its lock would be held when this process ends by itself, and Python aborts then
        os.read(source.fileno(), 1)
    if hasattr(os, "killpg") and os.getpgrp() == os.getpid():
        os.killpg(os.getpid(), signal.SIGKILL)
    os._exit(1)


@contextmanager
def running_program(
    words: Sequence[str], environment: Mapping[str, str], folder: Path
) -> Iterator["subprocess.Popen[bytes]"]:
    """The program at work in `folder`; it is ended with the block."""
    with (folder / OUTPUT).open("wb") as output:
        child = subprocess.Popen(
            words,
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    try:
        yield child
    finally:
        child.kill()
        child.wait()


def written_files(
    child: "subprocess.Popen[bytes]", path_of: Callable[[int], Path], first: int = 0
) -> Iterator[tuple[int, Path]]:
    """Numbers from `first` on and their files, as the program writes them, until it has ended.

    A file is whole when the next one is there or the program has ended.
    """
    number = first
    while True:
        ended = child.poll() is not None
        while (path := path_of(number)).exists() and (ended or path_of(number + 1).exists()):
            yield number, path
            number += 1
        if ended:
            return
        time.sleep(POLL_INTERVAL)


def printed_lines(folder: Path) -> list[str]:
    """What the program has printed."""
    return (folder / OUTPUT).read_text(errors="replace").splitlines()
