"""``python -m regolith_studio`` and the installed command ``regolith-studio``."""

import sys


def main() -> None:
    """Run the command line with the arguments of this process, and end it with its exit code."""
    from regolith_studio.cli.entry import run

    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
