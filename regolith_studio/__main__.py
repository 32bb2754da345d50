"""``python -m regolith_studio`` and the installed command ``regolith-studio``."""

import atexit
import os
import signal
import sys

from regolith_studio.cli.entry import STOPPED, StopSignals, remove_unfinished, run, say_last
from regolith_studio.errors import stop_requests


def main() -> None:
    """Run the command line with the arguments of this process, and end it with its exit code.

    A signal ends a command as :class:`StopSignals` says. Until the window can be closed, Ctrl+C ends the
    process as the system does: nothing is written yet, and an exception might be raised in a slot of Qt,
    which drops it. Linear algebra takes one thread, which several would only wait for on a busy machine, and
    which gives the bytes that workers of a pool give; a variable of the environment that is set stands.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy is imported
    signals = StopSignals()
    try:
        if sys.argv[1:2] not in ([], ["open"]):
            signals.install()
        elif signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # while modules were loaded, or a signal was repeated
        say_last(STOPPED)
        code = 130
    signals.ended = True
    if stop_requests:
        remove_unfinished()
        atexit._run_exitfuncs()
        sys.stdout.flush()
        os._exit(128 + stop_requests[0])  # Python would take VTK apart for a second, which nothing ends
    sys.exit(code)


if __name__ == "__main__":
    main()
