"""The parent of the sandbox process: starts it, limits it, and replaces it when it ends."""

import contextlib
import hashlib
import multiprocessing.util as process_end
import os
import signal
import stat
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

from regolith_studio.errors import FileError, MissingRequirement, RegolithError, os_error_reason
from regolith_studio.io.child_process import start_module
from regolith_studio.io.machine_memory import machine_memory
from regolith_studio.readers.error_messages import message_about
from regolith_studio.readers.sandbox import SandboxMessage, receive, send

CHILD = "regolith_studio.readers.sandbox.child"
MAX_FILE_BYTES = 2 * 1024**3
MAX_MEMORY = 6 * 1024**3
"""Address space of the child in bytes; enough for a binary file of 2 GiB and its arrays."""

MAX_MEMORY_SHARE = 0.75
"""Upper limit of the address space as a share of the machine's memory."""

BASE_SECONDS = 40.0
"""Wall time for a small file; on a machine with forty busy processes intact files took up to 10 s."""
WORK_SECONDS = 1.5
"""Processor time for a small file."""
SECONDS_PER_BYTE = 1.0 / 1e6
START_SECONDS = 60.0
MAX_WARM_RESULT_BYTES = 256 * 1024**2
"""After a larger result the child is replaced, so that its memory returns to the system."""


class Sandbox:
    """A child process that parses files; may be shared between threads, not between processes.

    It is kept from one request to the next, and replaced after a crash, a time-out or a very large result.

    - ``memory``: bytes of addresses that the child may use, where the system can limit them; by default 6
      GiB, or three quarters of the machine's memory where that is less.
    - ``seconds``: wall time for a small file, of which at most 1.5 s may be processor time; a larger file
      gets one second more of both per million bytes.
    """

    def __init__(self, memory: int | None = None, seconds: float = BASE_SECONDS) -> None:
        self._memory = memory or _memory_limit()
        self._seconds = seconds
        self._lock = threading.RLock()
        self._process: subprocess.Popen[bytes] | None = None
        self._ready = False
        self._ends_with_process = False

    def start(self) -> None:
        """Start the child now instead of at the first request."""
        with self._lock:
            self._running_process()

    def start_in_background(self) -> None:
        """Start the child while the caller goes on; why it does not start is raised by the first request."""

        def start() -> None:
            with contextlib.suppress(RegolithError, OSError):
                self.start()

        threading.Thread(target=start, name="start reader", daemon=True).start()

    def request(self, task: str, path: Path, **options: Any) -> SandboxMessage:
        """Let the child do `task` on the file at `path`.

        Raises FileError if the file is refused, or its reader crashes or exceeds its limits.
        """
        more = checked_size(path) * SECONDS_PER_BYTE
        work = min(self._seconds, WORK_SECONDS) + more
        return self.request_within(task, path, self._seconds + more, work, **options)

    def request_within(
        self, task: str, path: Path, seconds: float, work: float | None = None, **options: Any
    ) -> SandboxMessage:
        """As `request`, with explicit limits and without a check of the file's size.

        - ``seconds``: wall time that the task may take.
        - ``work``: processor time that it may take, where the system counts it; by default as much.
        - ``options``: further arguments of the task; ``memory`` limits the bytes that it may allocate.
        """
        work = min(work or seconds, seconds)
        limits = {"seconds": seconds + 2.0, "work": work}
        header = {"task": task, "path": str(path.absolute()), **limits, **options}
        with self._lock:
            message = self._answer(SandboxMessage(header), seconds)
        match message.header["status"]:
            case "read":
                return message
            case "refused":
                raise FileError(str(message.header["sentence"]))
            case "memory":
                limit = options.get("memory", self._memory) / 1024**3
                reason = f"needs more than the {limit:.3g} GiB of memory that a reader may use."
            case "busy":
                reason = (
                    f"was given up after {work:.2g} s of work: it is damaged, or far larger when unpacked."
                )
            case "late":
                reason = f"was given up after {seconds:.2g} s: it is damaged, or far larger when unpacked."
            case _:
                reason = "is damaged: it crashed the process that read it; export it again."
        raise FileError(message_about(path, reason))

    def close(self) -> None:
        """End the child, if there is one."""
        with self._lock:
            process, self._process = self._process, None
            if process is not None:
                _stop(process)

    def abandon(self) -> None:
        """Close the pipes of a child that belongs to the parent of a forked process."""
        self._lock = threading.RLock()
        self._ends_with_process = False
        process, self._process = self._process, None
        if process is not None:
            # Else Popen would try to collect the child of another process and warn that it runs.
            process.returncode = 0
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    pipe.close()

    def _answer(self, message: SandboxMessage, seconds: float) -> SandboxMessage:
        """The child's answer, or a message of status ``late``, ``busy`` or ``dead``."""
        answer = self._exchange(self._running_process(), message, seconds)
        # Only what no child has received is sent again: a file that has ended one child would end the next.
        if answer.header["status"] == "unheard":
            self.close()
            answer = self._exchange(self._running_process(), message, seconds)
        # At once, or the next file would wait 80 ms for its process.
        if _must_replace_child(answer):
            with contextlib.suppress(OSError):  # the next request raises it
                self._start_process()
        return answer

    def _exchange(
        self, process: subprocess.Popen[bytes], message: SandboxMessage | None, seconds: float
    ) -> SandboxMessage:
        """Send a message and wait for the answer, no longer than `seconds`."""
        late = threading.Event()

        def give_up() -> None:
            late.set()
            process.kill()

        watch = threading.Timer(seconds, give_up)
        watch.daemon = True
        try:
            if message is not None:
                send(process.stdin, message)  # type: ignore[arg-type]
        except OSError:
            return SandboxMessage({"status": "unheard"})
        watch.start()
        try:
            return receive(process.stdout)  # type: ignore[arg-type]
        except (EOFError, OSError, ValueError, KeyError):
            return SandboxMessage({"status": "late" if late.is_set() else _exit_reason(process)})
        # The answer that is still to come would be taken for that of the next request.
        except BaseException:
            self.close()
            raise
        finally:
            watch.cancel()
            watch.join()

    def _running_process(self) -> subprocess.Popen[bytes]:
        process = self._process
        if process is None or process.poll() is not None:
            process = self._start_process()
        if not self._ready:
            if self._exchange(process, None, START_SECONDS).header["status"] != "ready":
                self.close()
                raise MissingRequirement(
                    f"The program's reading process does not start with {sys.executable}."
                )
            self._ready = True
        return process

    def _start_process(self) -> subprocess.Popen[bytes]:
        """Start a child without waiting until it is ready."""
        self.close()
        writes_nothing = {"PYTHONDONTWRITEBYTECODE": "1"}
        process = self._process = start_module(
            CHILD, str(self._memory), environment=writes_nothing, bufsize=0
        )
        self._ready = False
        if not self._ends_with_process:
            process_end.Finalize(None, self.close, exitpriority=100)
            self._ends_with_process = True
        return process


def _exit_reason(process: subprocess.Popen[bytes]) -> str:
    """``busy`` if the child's own limit of work has ended it, else ``dead``."""
    with contextlib.suppress(subprocess.TimeoutExpired):
        if process.wait(timeout=1.0) == -getattr(signal, "SIGPROF", 0):
            return "busy"
    return "dead"


def _must_replace_child(answer: SandboxMessage) -> bool:
    """Whether the child has ended, or holds so much memory that it should be replaced."""
    size = sum(array.nbytes for array in answer.arrays)
    return answer.header["status"] not in ("read", "refused") or size > MAX_WARM_RESULT_BYTES


def checked_size(path: Path, largest: int | None = MAX_FILE_BYTES) -> int:
    """Size in bytes of a regular file that can be read whole, or in parts if `largest` is None.

    Raises FileError if there is no such file, it is not a regular file, or it is too large.
    """
    try:
        status = path.stat()
    except (OSError, ValueError) as error:
        reason = (
            os_error_reason(error) if isinstance(error, OSError) else "its name cannot be the name of a file"
        )
        raise FileError(message_about(path, f"cannot be opened: {reason}.")) from None
    if stat.S_ISDIR(status.st_mode):
        raise FileError(message_about(path, "is a folder, not a file."))
    if not stat.S_ISREG(status.st_mode):
        raise FileError(message_about(path, "is a device or a pipe, not a file."))
    if largest is not None and status.st_size > largest:
        raise FileError(
            message_about(path, f"has {status.st_size / 1024**3:.1f} GiB; at most 2 GiB are read.")
        )
    return status.st_size


def _memory_limit() -> int:
    return min(MAX_MEMORY, int(machine_memory() * MAX_MEMORY_SHARE))


def _stop(process: subprocess.Popen[bytes]) -> None:
    """Close the pipes and collect the child, by force if it does not go."""
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
    try:
        process.wait(timeout=0.2)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


_SHARED, _VOLUMES = Sandbox(), Sandbox()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_SHARED.abandon)
    os.register_at_fork(after_in_child=_VOLUMES.abandon)


def shared_sandbox() -> Sandbox:
    """The sandbox of this process for files that are read whole."""
    return _SHARED


def volume_sandbox() -> Sandbox:
    """The sandbox of this process for volumes, separate so that meshes need not wait for them."""
    return _VOLUMES


def read_bytes(path: Path, largest: int | None = None) -> bytes:
    """The bytes of a regular file.

    Raises FileError if there is no such file, it cannot be read, or it is larger than `largest` bytes.
    """
    size = checked_size(path)
    if largest is not None and size > largest:
        raise FileError(
            message_about(path, f"has {size / 1e6:.0f} MB; at most {largest / 1e6:.0f} are read.")
        )
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileError(message_about(path, f"cannot be read: {os_error_reason(error)}.")) from None


def sha256_of(path: Path) -> str:
    """SHA-256 of the file's bytes, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
