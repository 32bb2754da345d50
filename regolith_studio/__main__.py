"""``python -m regolith_studio`` and the installed command ``regolith-studio``."""

import signal
import sys
from typing import Any

TERMINATED = 143


def main() -> None:
    """Run the command line with the arguments of this process, and end it with its exit code.

    SIGTERM, as a queue sends it when the time is over, ends a command as Ctrl+C does: nothing half-written
    stays. The window is left to Qt.
    """
    from regolith_studio.cli.entry import run

    asked: list[int] = []

    def stop(number: int, _frame: Any) -> None:
        asked.append(number)
        raise KeyboardInterrupt

    if sys.argv[1:2] not in ([], ["open"]):
        signal.signal(signal.SIGTERM, stop)
    code = run(sys.argv[1:])
    sys.exit(TERMINATED if asked else code)


if __name__ == "__main__":
    main()
