"""``python -m regolith_studio`` and the installed command ``regolith-studio``."""

import signal
import sys
import threading
from typing import Any


def main() -> None:
    """Run the command line with the arguments of this process, and end it with its exit code.

    SIGTERM, as a queue sends it when the time is over, and SIGHUP, as a closed terminal sends it, end a
    command as Ctrl+C does: nothing half-written stays. The window is left to Qt.
    """
    asked: list[int] = []

    def stop(number: int, _frame: Any) -> None:
        asked.append(number)
        raise KeyboardInterrupt

    def stop_again(ignored: Any) -> None:
        """Repeat a signal that arrived in a callback of a library (llvmlite's), which cannot raise."""
        if isinstance(ignored.exc_value, KeyboardInterrupt):
            number = asked[-1] if asked else signal.SIGINT
            threading.Timer(0.05, signal.pthread_kill, (threading.main_thread().ident, number)).start()
        else:
            sys.__unraisablehook__(ignored)

    if sys.argv[1:2] not in ([], ["open"]):
        if hasattr(signal, "pthread_kill"):  # not on Windows
            sys.unraisablehook = stop_again
        for name in ("SIGTERM", "SIGHUP"):
            number = getattr(signal, name, None)  # Windows has no SIGHUP, and nohup ignores it
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, stop)
    try:
        from regolith_studio.cli.entry import run

        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # while modules were loaded
        print("Stopped.", file=sys.stderr)  # noqa: T201
        code = 130
    sys.exit(128 + asked[0] if asked else code)


if __name__ == "__main__":
    main()
