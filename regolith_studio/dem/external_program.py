"""Run a DEM program in a folder, and follow the files that it writes."""

import subprocess
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

OUTPUT = "output.txt"
"""File of the folder that gets what the program prints."""
POLL_INTERVAL = 0.1
"""Seconds between two checks for a new file."""


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
