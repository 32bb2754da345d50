"""Run a command to its end or to a signal; exit code 0 done, 1 bad input, 2 usage error, 130 interrupted."""

import io
import os
import signal
import socket
import sys
import threading
import time
import traceback
from collections.abc import Sequence
from typing import Any

from regolith_studio.errors import JobCancelled, RegolithError, format_os_error, stop_requests
from regolith_studio.readers.error_messages import printable

STOP_SECONDS = 1.5
"""Seconds after a signal in which a command may tidy up; then the process ends wherever it is.

Its processes end with it: each waits in a thread for the end of its parent.
"""
STOPPED = "Stopped."
_saying, _said = threading.Lock(), threading.Event()
"""Of the last sentence, which the command prints, or the thread that ends it: one of them, and once."""
_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")


class StopSignals:
    """Lets Ctrl+C, SIGTERM (a queue's time is over) and SIGHUP (a closed terminal) stop this process.

    The first one raises :class:`KeyboardInterrupt` in the main thread, so that nothing half-written stays;
    later ones do not disturb that. A signal that is ignored, as nohup ignores SIGHUP, stays ignored.

    ``ended``: set by the caller once it has said how the command ended.
    """

    def __init__(self) -> None:
        self.ended, self._raised = False, False
        self._handled: set[int] = set()
        self._reading, self._writing = socket.socketpair()
        self._writing.setblocking(False)

    def install(self) -> None:
        """Take over the signals; only the main thread can."""
        for name in _SIGNALS:
            number = getattr(signal, name, None)  # Windows has no SIGHUP
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._stop)
                self._handled.add(number)
        sys.unraisablehook = self._repeat
        threading.Thread(target=self._end_in_time, name="stop signals", daemon=True).start()
        signal.set_wakeup_fd(self._writing.fileno(), warn_on_full_buffer=False)

    def _stop(self, number: int, _frame: Any) -> None:
        stop_requests.append(number)
        if not (self._raised or self.ended):
            self._raised = True
            raise KeyboardInterrupt

    def _repeat(self, ignored: Any) -> None:
        """Repeat a signal that arrived in a callback of a library (llvmlite's), which cannot raise."""
        if isinstance(ignored.exc_value, KeyboardInterrupt) and hasattr(signal, "pthread_kill"):
            self._raised = False
            main = threading.main_thread().ident
            threading.Timer(0.05, signal.pthread_kill, (main, [*stop_requests, signal.SIGINT][0])).start()
        else:
            sys.__unraisablehook__(ignored)

    def _end_in_time(self) -> None:
        """In a thread: the system writes the number of a signal to the socket even while Python is busy."""
        while (number := self._reading.recv(1)[0]) not in self._handled:
            pass
        time.sleep(STOP_SECONDS)
        remove_unfinished()
        _saying.acquire(timeout=STOP_SECONDS)  # never released: nothing is printed after this
        if not (self.ended or _said.is_set()):
            os.write(2, f"{STOPPED}\n".encode())
        if "multiprocessing" in sys.modules:
            for child in sys.modules["multiprocessing"].active_children():
                child.kill()  # last, since a pool replaces a process that has died
        os._exit(128 + number)


def remove_unfinished() -> None:
    """Remove hidden files and locks, also those that an interruption within the tidying up has left."""
    if "regolith_studio.io.atomic" in sys.modules:
        sys.modules["regolith_studio.io.atomic"].remove_unfinished()


DONE, BAD_INPUT, BAD_USE, INTERRUPTED = 0, 1, 2, 130


def run(arguments: Sequence[str]) -> int:
    """Run one command; everything that goes wrong is one sentence on stderr.

    ``REGOLITH_STUDIO_DEBUG=1`` adds the traceback.
    """
    from regolith_studio.cli.commands import app

    _said.clear()
    for stream in (sys.stdout, sys.stderr):  # names of files may hold what the terminal cannot show
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    try:
        app(list(arguments), prog_name="regolith-studio")
    except SystemExit as end:
        if end.code == INTERRUPTED:  # typer ends so at Ctrl+C
            return _report(STOPPED, INTERRUPTED)
        return end.code if isinstance(end.code, int) else DONE
    except (KeyboardInterrupt, JobCancelled):
        return _report(STOPPED, INTERRUPTED)
    except RegolithError as error:
        return _report(str(error), BAD_INPUT)
    except OSError as error:
        return _report(format_os_error(error), BAD_INPUT)
    except MemoryError:
        return _report("The work needs more memory than this machine has.", BAD_INPUT)
    except ImportError as error:
        from regolith_studio.cli.check import library_sentence

        return _report(library_sentence(error) or f"{error}; install the program anew.", BAD_INPUT)
    except Exception as error:  # noqa: BLE001  the last one who can turn it into a sentence
        first_line = (str(error).splitlines() or [""])[0]
        return _report(f"The program made a mistake ({type(error).__name__}: {first_line}).", BAD_INPUT)
    return DONE


def _report(sentence: str, code: int) -> int:
    """Print why a command ended; libraries make other errors (matplotlib's ValueError) of an interruption."""
    if stop_requests:
        sentence, code = STOPPED, INTERRUPTED
    if os.environ.get("REGOLITH_STUDIO_DEBUG"):
        traceback.print_exc()
    say_last(printable(sentence))
    return code


def say_last(sentence: str) -> None:
    """Print why a command ended, unless that was said."""
    with _saying:
        if not _said.is_set():
            print(sentence, file=sys.stderr)  # noqa: T201  the only output of a failed command
        _said.set()
