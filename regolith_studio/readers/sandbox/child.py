"""The child process that parses untrusted files: ``python -m regolith_studio.readers.sandbox.child``.

It reads one request at a time from standard input and writes the answer to standard output until the input
ends. Timers end it when a request exceeds its limits, so that it cannot outlive its parent.
"""

import contextlib
import os
import signal
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from regolith_studio.errors import RegolithError, os_error_reason
from regolith_studio.io.child_process import private_pipes
from regolith_studio.readers.error_messages import message_about
from regolith_studio.readers.formats import MESH_FORMATS
from regolith_studio.readers.sandbox import SandboxMessage, receive, send, tasks

Task = Callable[[dict[str, Any]], SandboxMessage]


TASKS: dict[str, Task] = {
    "archive": tasks.list_archive,
    "mesh": tasks.read_mesh_file,
    "volume-prepare": tasks.prepare_volume,
    "volume-open": tasks.open_volume,
    "volume-slices": tasks.read_slices,
    "positions": tasks.read_positions_file,
    "numbers": tasks.read_number_rows,
    "named-columns": tasks.read_named_columns,
    "sleep": tasks.sleep,
    "spin": tasks.spin,
}
"""What the child can do, by the name in a request."""


def answer(request: dict[str, Any]) -> SandboxMessage:
    """The task's result, or a header with the reason why there is none."""
    path = Path(request["path"])
    try:
        message = TASKS[request["task"]](request)
    except RegolithError as error:
        return SandboxMessage({"status": "refused", "sentence": str(error)})
    except MemoryError:
        return SandboxMessage({"status": "memory"})
    except OSError as error:
        sentence = message_about(path, f"cannot be opened: {os_error_reason(error)}.")
        return SandboxMessage({"status": "refused", "sentence": sentence})
    except Exception as error:  # noqa: BLE001 (whatever a parser trips over is the file's fault)
        sentence = message_about(path, "is damaged; export it again.")
        return SandboxMessage({"status": "refused", "sentence": sentence, "details": repr(error)})
    return SandboxMessage({**message.header, "status": "read"}, message.arrays)


def main() -> None:
    """Answer requests until the parent closes the pipe."""
    source, sink = private_pipes(buffering=0)
    limit = int(sys.argv[1]) if len(sys.argv) > 1 else 0
    _limit_memory(limit)
    warnings.simplefilter("ignore")
    send(sink, SandboxMessage({"status": "ready", "pid": os.getpid()}))
    len(MESH_FORMATS)  # imports them while the parent is busy with what to request_within
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            request = receive(source).header
            _alarm(float(request.get("seconds", 60.0)), float(request.get("work", 60.0)))
            _allow_memory(int(request.get("memory", 0)), limit)
            send(sink, answer(request))
            _alarm(0.0, 0.0)


def _alarm(seconds: float, work: float) -> None:
    """Die after so many seconds, or of so much processor time, even inside compiled code; never for 0."""
    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, seconds)
        signal.setitimer(signal.ITIMER_PROF, work)


def _limit_memory(limit: int) -> None:
    """No more than `limit` bytes of addresses, no core files, no written files; where the system can."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        signal.signal(signal.SIGINT, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
        if limit:
            resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


def _allow_memory(more: int, limit: int) -> None:
    """For this request only `more` bytes of addresses than now, never above `limit`; for 0 up to it."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        if limit:
            pages = int(Path("/proc/self/statm").read_text().split()[0]) if more else 0
            now = pages * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (min(limit, now + more) if more else limit, limit))


if __name__ == "__main__":
    main()
