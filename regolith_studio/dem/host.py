"""Runs an engine in a process of its own, so that neither its crash nor its memory is ours."""

import contextlib
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Generator
from pathlib import Path
from typing import Any, BinaryIO

from regolith_studio.dem.case import Prepared
from regolith_studio.dem.engine import Ending, Moment
from regolith_studio.dem.engines import engine_named
from regolith_studio.errors import EnvironmentProblem, RegolithError

PATIENCE = 0.2
"""Seconds without news after which the caller gets a turn, so that it can be cancelled."""
_THREAD_LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


class EngineStopped(RegolithError):
    """An engine ended before its work was done; what it left behind is in the run's folder."""


def run_engine(
    key: str, prepared: Prepared, settings: Any, folder: Path
) -> Generator[Moment | None, None, Ending]:
    """Moments of a run as they come, ``None`` while one waits; closing the generator ends the process.

    Every moment is in the folder before it is told.

    Raises
    ------
    EnvironmentProblem
        If the engine is not there.
    EngineStopped
        If it crashed, diverged, or could not write.
    """
    engine = engine_named(key)
    if problem := engine.find().problem:
        raise EnvironmentProblem(problem)
    child = _started((key, prepared, settings, folder))
    news: queue.SimpleQueue[Any] = queue.SimpleQueue()
    reader = threading.Thread(target=_listen, args=(child.stdout, news), name=f"engine {key}", daemon=True)
    reader.start()
    last = "none"
    try:
        while True:
            try:
                word = news.get(timeout=PATIENCE)
            except queue.Empty:
                yield None
                continue
            match word:
                case Moment():
                    last = f"{word.pile.time:.2f} s"
                    yield word
                case Ending():
                    return word
                case str():
                    raise EngineStopped(word)
                case _:
                    raise EngineStopped(_death(engine.label, child.wait(), last))
    finally:
        _end(child)
        reader.join()
        if child.stdout is not None:
            child.stdout.close()


def _started(order: tuple[Any, ...]) -> subprocess.Popen[bytes]:
    """The worker with its order; it leads a group of its own, which can be ended together."""
    child = subprocess.Popen(
        [sys.executable, "-P", "-m", "regolith_studio.dem.worker"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | dict.fromkeys(_THREAD_LIMITS, "1") | {"PYTHONPATH": _path()},
        start_new_session=True,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )
    assert child.stdin is not None
    with contextlib.suppress(OSError):  # it died at once: the reader will notice
        pickle.dump(order, child.stdin, protocol=pickle.HIGHEST_PROTOCOL)
        child.stdin.flush()
    return child


def _path() -> str:
    """Where the child finds this program, also in a checkout that is not installed."""
    own = str(Path(__file__).resolve().parents[2])
    return os.pathsep.join(part for part in (own, os.environ.get("PYTHONPATH", "")) if part)


def _listen(source: BinaryIO, news: "queue.SimpleQueue[Any]") -> None:
    """Pass on what the child says; ``None`` when it says nothing more."""
    try:
        while True:
            news.put(pickle.load(source))
    except (EOFError, OSError, ValueError, pickle.UnpicklingError):
        news.put(None)


def _end(child: subprocess.Popen[bytes]) -> None:
    """End the child and what it started, and wait for it."""
    if child.poll() is None and hasattr(os, "killpg"):
        with contextlib.suppress(OSError):
            os.killpg(child.pid, signal.SIGKILL)
    if child.poll() is None:
        child.kill()
    child.wait()
    if child.stdin is not None:
        with contextlib.suppress(OSError):
            child.stdin.close()


def _death(label: str, code: int, last: str) -> str:
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    return f"The engine {label} {how}; the last snapshot ({last}) is kept."
