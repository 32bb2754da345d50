"""``python -m regolith_studio`` and the installed command ``regolith-studio``."""

import sys

from regolith_studio.cli.stop_signals import STOPPED, StopSignals, remove_unfinished


def main() -> None:
    """Run the command line with the arguments of this process, and end it with its exit code.

    A signal ends a command as :class:`StopSignals` says. The window is left to Qt.
    """
    signals = StopSignals()
    try:
        if sys.argv[1:2] not in ([], ["open"]):
            signals.install()
        from regolith_studio.cli.entry import run

        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # while modules were loaded
        print(STOPPED, file=sys.stderr)  # noqa: T201
        code = 130
    signals.ended = True
    if signals.received:
        remove_unfinished()
    sys.exit(128 + signals.received[0] if signals.received else code)


if __name__ == "__main__":
    main()
