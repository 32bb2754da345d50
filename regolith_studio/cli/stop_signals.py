"""Ends a command when a signal asks for it: by itself if that is quick, else at once."""

import os
import signal
import socket
import sys
import threading
import time
from typing import Any

from regolith_studio.errors import stop_requests

STOP_SECONDS = 1.5
"""Seconds after a signal in which a command may tidy up; then the process ends wherever it is.

Its processes end with it: each waits in a thread for the end of its parent.
"""
STOPPED = "Stopped."
_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")


class StopSignals:
    """Lets Ctrl+C, SIGTERM (a queue's time is over) and SIGHUP (a closed terminal) stop this process.

    The first one raises :class:`KeyboardInterrupt` in the main thread, so that nothing half-written stays;
    later ones do not disturb that. A signal that is ignored, as nohup ignores SIGHUP, stays ignored.

    Attributes
    ----------
    ended
        Set by the caller once it has said how the command ended.
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
        if not self.ended:
            os.write(2, f"{STOPPED}\n".encode())
        if "multiprocessing" in sys.modules:
            for child in sys.modules["multiprocessing"].active_children():
                child.kill()  # last, since a pool replaces a process that has died
        os._exit(128 + number)


def remove_unfinished() -> None:
    """Remove hidden files and locks, also those that an interruption within the tidying up has left."""
    if "regolith_studio.io.atomic" in sys.modules:
        sys.modules["regolith_studio.io.atomic"].remove_unfinished()
