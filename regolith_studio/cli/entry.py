"""Run a command and return its exit code: 0 done, 1 bad input, 2 usage error, 130 interrupted."""

import io
import os
import sys
import traceback
from collections.abc import Sequence

from regolith_studio.cli.stop_signals import STOPPED
from regolith_studio.errors import JobCancelled, RegolithError, format_os_error, stop_requests
from regolith_studio.readers.error_messages import printable

DONE, BAD_INPUT, BAD_USE, INTERRUPTED = 0, 1, 2, 130


def run(arguments: Sequence[str]) -> int:
    """Run one command; everything that goes wrong is one sentence on stderr.

    ``REGOLITH_STUDIO_DEBUG=1`` adds the traceback.
    """
    from regolith_studio.cli.commands import app

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
    print(printable(sentence), file=sys.stderr)  # noqa: T201  the only output of a failed command
    return code
