"""The process that an engine runs in: ``python -m regolith_studio.dem.worker``.

It takes one order on its standard input and tells moments on its standard output. When its input ends,
the program that waits for it is gone, and it ends itself with everything that it has started.
"""

import contextlib
import os
import pickle
import signal
import threading
from pathlib import Path
from typing import Any, BinaryIO

from regolith_studio.dem.case import Prepared
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.run_folder import save_snapshot
from regolith_studio.errors import RegolithError


def main() -> None:
    """Take the order, work, tell."""
    source, told = _private_pipes()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    key, prepared, settings, folder = pickle.load(source)
    threading.Thread(target=_end_with_parent, args=(source,), name="parent", daemon=True).start()
    work(told, key, prepared, settings, folder)


def work(told: BinaryIO, key: str, prepared: Prepared, settings: Any, folder: Path) -> None:
    """Simulate; every moment is saved before it is told; the last word is an ending or a sentence."""
    try:
        steps = engine_named(key).simulate(prepared, settings)
        for number in range(10**9):
            try:
                moment = next(steps)
            except StopIteration as end:
                _tell(told, end.value)
                return
            save_snapshot(folder, number, moment.pile)
            _tell(told, moment)
    except RegolithError as error:
        _tell(told, str(error))
    except MemoryError:
        _tell(told, "The simulation needs more memory than this machine has; take fewer particles.")
    except OSError as error:
        _tell(told, f"The simulation could not go on: {error.strerror or error}. What was saved is kept.")
    except Exception as error:  # noqa: BLE001  the last who can tell the parent
        _tell(told, f"The engine made a mistake ({type(error).__name__}: {error}). What was saved is kept.")


def _tell(told: BinaryIO, news: Any) -> None:
    pickle.dump(news, told, protocol=pickle.HIGHEST_PROTOCOL)
    told.flush()


def _end_with_parent(source: BinaryIO) -> None:
    with contextlib.suppress(OSError):
        source.read(1)
    if hasattr(os, "killpg") and os.getpgrp() == os.getpid():
        os.killpg(os.getpid(), signal.SIGKILL)
    os._exit(1)


def _private_pipes() -> tuple[BinaryIO, BinaryIO]:
    """The pipes to the parent, out of reach of anything that an engine prints."""
    source, told = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):
        os.dup2(nothing, number)
    os.close(nothing)
    return os.fdopen(source, "rb"), os.fdopen(told, "wb")


if __name__ == "__main__":
    main()
