"""Runs an engine in a process of its own, so that neither its crash nor its memory is ours."""

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Generator, Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from regolith_studio.dem.case import Prepared
from regolith_studio.dem.engine import Ending, Moment
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.run_folder import save_snapshot
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
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(
        target=_work, args=(theirs, key, prepared, settings, folder), name=f"engine {key}", daemon=False
    )
    with _one_thread():
        child.start()
    theirs.close()
    last = "none"
    try:
        while True:
            if not ours.poll(PATIENCE):
                yield None
                continue
            try:
                news = ours.recv()
            except EOFError:
                child.join()
                raise EngineStopped(_death(engine.label, child.exitcode, last)) from None
            match news:
                case Moment():
                    last = f"{news.pile.time:.2f} s"
                    yield news
                case Ending():
                    return news
                case str():
                    raise EngineStopped(news)
    finally:
        _end(child)
        ours.close()


def _work(told: Connection, key: str, prepared: Prepared, settings: Any, folder: Path) -> None:
    """In the child: simulate, save, tell."""
    with contextlib.suppress(OSError, AttributeError):
        os.setsid()  # what the engine starts belongs to one group that can be ended together
    _die_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        steps = engine_named(key).simulate(prepared, settings)
        for number in range(10**9):
            try:
                moment = next(steps)
            except StopIteration as end:
                told.send(end.value)
                return
            save_snapshot(folder, number, moment.pile)
            told.send(moment)
    except RegolithError as error:
        told.send(str(error))
    except MemoryError:
        told.send("The simulation needs more memory than this machine has; take fewer particles.")
    except OSError as error:
        told.send(f"The simulation could not go on: {error.strerror or error}. What was saved is kept.")
    except Exception as error:  # noqa: BLE001  the last who can tell the parent
        told.send(f"The engine made a mistake ({type(error).__name__}: {error}). What was saved is kept.")
    finally:
        told.close()


def _die_with_parent() -> None:
    """Do not outlive the program that waits for us, even if that was killed."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def watch() -> None:
        parent.join()
        if hasattr(os, "killpg") and os.getpgrp() == os.getpid():
            os.killpg(os.getpid(), signal.SIGKILL)
        os._exit(1)

    threading.Thread(target=watch, name="parent", daemon=True).start()


def _end(child: Any) -> None:
    """End the child and what it started, and wait for it."""
    child.join(0.5)
    if child.is_alive() and hasattr(os, "killpg"):
        with contextlib.suppress(OSError):
            if os.getpgid(child.pid) == child.pid:
                os.killpg(child.pid, signal.SIGKILL)
    if child.is_alive():
        child.kill()
    child.join()
    child.close()


def _death(label: str, code: int | None, last: str) -> str:
    how = f"was ended by signal {-code}" if code is not None and code < 0 else f"ended with code {code}"
    return f"The engine {label} {how}; the last snapshot ({last}) is kept."


@contextlib.contextmanager
def _one_thread() -> Iterator[None]:
    """Lets a process that starts meanwhile keep to one thread for linear algebra."""
    before = {name: os.environ.get(name) for name in _THREAD_LIMITS}
    os.environ.update(dict.fromkeys(_THREAD_LIMITS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
