"""Runs an engine in a child process, so that neither a crash nor its memory affects the program.

The child, ``python -m regolith_studio.dem.engine_process``, reads one pickled task from its standard input
and writes pickled snapshots to its standard output: at the end a result, or a message where it failed. When
its input is closed, the parent is gone, and the child ends itself with everything that it has started.
"""

import contextlib
import itertools
import os
import pickle
import queue
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import ENGINE_THREADS, Engine, ResumableEngine, SimulationResult
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.run_io import (
    ENGINE_FILES,
    STATE,
    remove_snapshots,
    run_key,
    save_engine_state,
    save_snapshot,
)
from regolith_studio.dem.snapshot import Snapshot, engine_state_bytes, read_engine_state
from regolith_studio.errors import MissingRequirement, RegolithError
from regolith_studio.io.child_process import end_with_parent, private_pipes, start_module

POLL_INTERVAL = 0.2
"""Seconds without a message after which ``None`` is yielded, so that the caller can cancel."""
STATE_INTERVAL = 60.0
"""Seconds between two states that are saved, and at least 20 times as long as saving one takes."""


class EngineError(RegolithError):
    """An engine ended before its work was done; its snapshots are in the run's folder.

    ``document``: of the failed run, once it is written.
    """

    document: dict[str, Any]


def run_engine(
    key: str, prepared: PreparedCase, settings: Any, folder: Path, threads: int = 1
) -> Generator[Snapshot | None, None, SimulationResult]:
    """Snapshots of a run as they come, ``None`` while there is none; closing the generator ends the child.

    Every snapshot is saved in the folder before it is yielded, and from time to time the engine's state. A
    state of the same run that the folder holds already is where the engine goes on.

    Raises MissingRequirement if the engine is not installed. Raises EngineError if it crashed, diverged, or
    could not write.
    """
    engine = engine_named(key)
    if problem := engine.find().problem:
        raise MissingRequirement(problem)
    with tempfile.TemporaryDirectory(prefix=ENGINE_FILES, dir=folder) as scratch:  # the child may be killed
        child = _start((key, prepared, settings, folder), threads, scratch)
        return (yield from _followed(child, engine))


def _followed(
    child: subprocess.Popen[bytes], engine: Engine
) -> Generator[Snapshot | None, None, SimulationResult]:
    """The child's messages; at the end, however it comes, the child is ended."""
    messages: queue.SimpleQueue[Any] = queue.SimpleQueue()
    reader = threading.Thread(
        target=_listen, args=(child.stdout, messages), name=f"engine {engine.key}", daemon=True
    )
    reader.start()
    last = "none"
    try:
        while True:
            try:
                message = messages.get(timeout=POLL_INTERVAL)
            except queue.Empty:
                yield None
                continue
            match message:
                case Snapshot():
                    last = f"{message.particles.time:.2f} s"
                    yield message
                case SimulationResult():
                    return message
                case str():
                    raise EngineError(message)
                case _:
                    raise EngineError(_exit_message(engine.label, child.wait(), last))
    finally:
        _end(child)
        # In this order: the thread reads until the child's output ends.
        reader.join()
        if child.stdout is not None:
            child.stdout.close()


def _start(task: tuple[Any, ...], threads: int, scratch: str) -> subprocess.Popen[bytes]:
    """The child with its task and a folder for its temporary files.

    It leads a process group, so that everything in it can be ended together.
    """
    places = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), scratch)
    child = start_module(
        "regolith_studio.dem.engine_process",
        environment={ENGINE_THREADS: str(threads), **places},
        start_new_session=True,
    )
    assert child.stdin is not None
    with contextlib.suppress(OSError):  # it died at once: the reader thread reports it
        pickle.dump(task, child.stdin, protocol=pickle.HIGHEST_PROTOCOL)
        child.stdin.flush()
    return child


def _listen(source: BinaryIO, messages: "queue.SimpleQueue[Any]") -> None:
    """Put the child's messages into the queue; ``None`` when its output ends."""
    try:
        while True:
            messages.put(pickle.load(source))
    except (EOFError, OSError, ValueError, pickle.UnpicklingError):
        messages.put(None)


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


def _exit_message(label: str, code: int, last: str) -> str:
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    return f"The engine {label} {how}; the last snapshot ({last}) is kept."


def main() -> None:
    """Read the task and run it."""
    source, target = private_pipes()
    # Where there are no sessions, on Windows, Ctrl+C reaches the child too, which its parent ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    key, prepared, settings, folder = pickle.load(source)
    end_with_parent(source)
    run_task(target, key, prepared, settings, folder)


def run_task(target: BinaryIO, key: str, prepared: PreparedCase, settings: Any, folder: Path) -> None:
    """Simulate; every snapshot is saved before it is sent; the last message is a result or a sentence."""
    try:
        steps, first, run = _begin(key, prepared, settings, folder)
        saved, interval = time.monotonic(), STATE_INTERVAL
        for number in itertools.count(first):
            try:
                snapshot = next(steps)
            except StopIteration as end:
                _send(target, end.value)
                return
            save_snapshot(folder, number, snapshot.particles)
            if snapshot.state is not None and time.monotonic() - saved > interval:
                began = time.monotonic()
                save_engine_state(folder, engine_state_bytes(snapshot.state(), run, number + 1))
                saved = time.monotonic()
                interval = max(STATE_INTERVAL, 20.0 * (saved - began))
            # A state is a function of this process, which pickle cannot send.
            _send(target, replace(snapshot, state=None))
    except RegolithError as error:
        _send(target, str(error))
    except MemoryError:
        _send(target, "The simulation needs more memory than this machine has; take fewer particles.")
    except OSError as error:
        _send(target, f"The simulation could not go on: {error.strerror or error}. What was saved is kept.")
    except Exception as error:  # noqa: BLE001 (the parent reports it)
        _send(target, f"The engine failed ({type(error).__name__}: {error}). What was saved is kept.")


def _begin(
    key: str, prepared: PreparedCase, settings: Any, folder: Path
) -> tuple[Generator[Snapshot, None, SimulationResult], int, str]:
    """The engine from its beginning or a saved state on, the number of its first snapshot, the run's key."""
    engine = engine_named(key)
    run = run_key(prepared, engine, settings)
    state = read_engine_state(folder / STATE, run) if isinstance(engine, ResumableEngine) else None
    remove_snapshots(folder, state[1] if state else 0)
    if isinstance(engine, ResumableEngine) and state:
        return engine.resume(prepared, settings, state[0]), state[1], run
    return engine.simulate(prepared, settings), 0, run


def _send(target: BinaryIO, message: Any) -> None:
    pickle.dump(message, target, protocol=pickle.HIGHEST_PROTOCOL)
    target.flush()


if __name__ == "__main__":
    main()
