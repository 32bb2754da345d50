"""Runs jobs on a Dask cluster: one of this machine's own, or one at an address."""

import contextlib
import logging
import signal
import socket
import threading
import time
import uuid
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.jobs.events import Event, Failed, Job, JobResult, Listener, Stopped
from regolith_studio.jobs.runners import run_job
from regolith_studio.jobs.runners.process_pool import cores, memory_limit

CONNECT_SECONDS = 8.0
WORKER_SECONDS = 20.0
"""How long to wait for the scheduler, once it answers, and for its first worker."""
ANSWER_SECONDS = 4.0
"""Seconds in which a scheduler must answer."""
SCHEMES = ("tcp", "tls")
MAX_GREETING = 1 << 16
"""Bytes; a scheduler begins with the length of a message of some hundred."""
NEEDED = 'This needs Dask, which is an extra: pip install "regolith-studio[cluster]".'


def parsed_address(text: str) -> str:
    """The address of a scheduler in full, from ``tcp://host:port``, ``tls://host:port`` or ``host:port``."""
    given = text.strip()
    try:
        parts = urlsplit(given if "://" in given else f"tcp://{given}")
        valid = parts.scheme in SCHEMES and parts.hostname and parts.port
    except ValueError:  # a port that is no number up to 65535, or half a pair of brackets
        valid = False
    if not valid:
        raise InputError(
            f"The address {given!r} has not the form tcp://HOST:8786 or tls://HOST:8786, "
            "with a port from 1 to 65535."
        )
    return parts.geturl()


def check_scheduler(address: str) -> None:
    """Check that a Dask scheduler answers at an address in full, within seconds.

    Dask's own client tries for half a minute, and takes the answer of a web server for a message length.
    """
    place, deadline = urlsplit(address), time.monotonic() + ANSWER_SECONDS
    with _connection(address, place.hostname or "", place.port or 0, deadline) as connection:
        if place.scheme != "tcp":
            return
        connection.settimeout(max(0.1, deadline - time.monotonic()))
        # A scheduler sends first: eight bytes of message length, little-endian.
        try:
            greeting = connection.recv(8, getattr(socket, "MSG_WAITALL", 0))
        except OSError:
            greeting = b""
    if len(greeting) < 8 or not 0 < int.from_bytes(greeting, "little") < MAX_GREETING:
        raise MissingRequirement(
            f"What answers at {address} is no Dask scheduler; take the scheduler's port (usually 8786), "
            "not of its dashboard (8787) or of a worker, and tls:// where it is encrypted."
        )


def _connection(address: str, host: str, port: int, deadline: float) -> socket.socket:
    while True:
        try:
            return socket.create_connection((host, port), max(0.1, deadline - time.monotonic()))
        except OSError as error:
            if not isinstance(error, ConnectionRefusedError) or time.monotonic() + 0.2 > deadline:
                reason = error.strerror or error
                raise MissingRequirement(f"No cluster answers at {address} ({reason}).") from error
            time.sleep(0.2)  # it may be about to start


@dataclass(frozen=True)
class TlsFiles:
    """Files of an encrypted cluster (addresses that begin with ``tls://``).

    ``authority``: certificate of the authority that signed those of the cluster, PEM. ``certificate``,
    ``key``: of this program, PEM.
    """

    authority: Path
    certificate: Path
    key: Path

    def security(self) -> Any:
        """For Dask's client: everything encrypted, both ends authenticated."""
        for path in (self.authority, self.certificate, self.key):
            if not path.is_file():
                raise InputError(f"The TLS file {path} is not there.")
        return _distributed().Security(
            tls_ca_file=str(self.authority),
            tls_client_cert=str(self.certificate),
            tls_client_key=str(self.key),
            require_encryption=True,
        )


@dataclass(eq=False)
class _DaskHandle:
    listener: Listener
    future: Any = None
    cancelled: bool = False
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def done(self) -> bool:
        return self.ended.is_set()

    def cancel(self) -> None:
        self.cancelled = True
        if self.future is not None and not self.done:
            with contextlib.suppress(Exception):
                self.future.cancel()
        self.finish(Stopped())

    def finish(self, result: JobResult) -> None:
        """Pass the result on, once."""
        if not self.ended.is_set():
            self.ended.set()
            self.listener(result)


class DaskRunner:
    """Each job runs whole in a worker of the cluster; listeners are called in a thread of the client.

    A worker that dies is replaced by the cluster, and its jobs are done again by others; a job that has
    ended several workers has failed. A job that was cancelled, or whose client has gone, stops between two of
    its steps.

    - ``address``: of a scheduler, ``tcp://host:8786`` or ``tls://host:8786``; empty to start a cluster here.
    - ``workers``: processes of a cluster started here; 0 for one a core.
    - ``tls``: files for an encrypted cluster.
    """

    def __init__(self, address: str = "", workers: int = 0, tls: TlsFiles | None = None) -> None:
        if address.startswith("tls://") and tls is None:
            raise InputError(f"The address {address} is encrypted: give certificate, key and authority.")
        _distributed()
        if tls:
            tls.security()
        self.address = parsed_address(address) if address else ""
        if self.address:
            check_scheduler(self.address)
        self._open: set[_DaskHandle] = set()
        self._lock = threading.Lock()
        self._cluster = None if self.address else _local_cluster(workers or cores())
        try:
            self._client = _connect(self._cluster if self._cluster is not None else self.address, tls)
        except BaseException:
            self._close_cluster()
            raise
        try:
            if self._cluster is not None:
                self._client.run(_leave_interrupts)
            self._check_versions()
        except BaseException:
            self.close()
            raise

    @property
    def workers(self) -> int:
        """Jobs that the cluster can work on at the same time."""
        return max(1, int(sum(self._client.nthreads().values())))

    @property
    def dashboard(self) -> str:
        """Address of the page on which the cluster shows its work; empty if it has none."""
        return str(self._client.dashboard_link or "")

    def submit(self, job: Job, listener: Listener, queue: str = "") -> _DaskHandle:  # noqa: ARG002
        if self._client.status != "running":
            raise MissingRequirement(self._lost_connection())
        handle = _DaskHandle(listener)
        with self._lock:
            self._open.add(handle)
        # Not pure: Dask would give two equal jobs one result, and cancel both with one.
        handle.future = self._client.submit(_run_whole, job, pure=False)
        handle.future.add_done_callback(lambda future: self._finish(handle, future))
        return handle

    def check_shared(self, path: Path, folder: Path | None) -> None:
        """Check that each worker finds a file or folder, and one for temporary files, under these paths."""
        probe, key = folder and folder / "probe", ""
        if probe is not None:
            probe.write_text(key := uuid.uuid4().hex)
        for worker, (size, seen) in self._client.run(_size_and_text, str(path), str(probe or "")).items():
            if size != _size_of(path):
                raise MissingRequirement(
                    f"The worker {worker} does not find {path}, or another file is there; workers read it "
                    "themselves, from a place that all share."
                )
            if folder is not None and seen != key:
                raise MissingRequirement(
                    f"The worker {worker} does not see the folder {folder.parent}, where temporary files are "
                    "written; write the output to a place that all workers share."
                )
        if probe is not None:
            probe.unlink()

    def close(self) -> None:
        """Cancel what runs and disconnect; a cluster that was started here ends."""
        for handle in list(self._open):
            handle.cancel()
        with contextlib.suppress(Exception):
            self._client.close(timeout=CONNECT_SECONDS)
        self._close_cluster()

    def _close_cluster(self) -> None:
        if self._cluster is not None:
            with contextlib.suppress(Exception):
                self._cluster.close(timeout=CONNECT_SECONDS)

    def _finish(self, handle: _DaskHandle, future: Any) -> None:
        with self._lock:
            self._open.discard(handle)
        handle.finish(self._result(handle, future))

    def _result(self, handle: _DaskHandle, future: Any) -> JobResult:
        if handle.cancelled:
            return Stopped()
        if future.status in ("cancelled", "lost"):
            return Stopped(self._lost_connection())
        try:
            result: JobResult = future.result()
        except _distributed().KilledWorker as error:
            return Failed("Workers died of it; they may have run out of memory.", str(error))
        except Exception as error:  # noqa: BLE001  whatever could not be sent, received or unpickled
            return Failed(f"A worker of the cluster could not answer ({error}).", repr(error))
        return result

    def _check_versions(self) -> None:
        from regolith_studio.dataset.build import software_versions

        try:
            self._client.wait_for_workers(1, timeout=WORKER_SECONDS)
        except TimeoutError as error:
            raise MissingRequirement(
                f"The scheduler at {self.address} has no worker; start one with: dask worker {self.address}"
            ) from error
        mine = software_versions()
        for worker, theirs in self._client.run(software_versions).items():
            for package, version in mine.items():
                if theirs.get(package) != version:
                    raise MissingRequirement(
                        f"The worker {worker} has {package} {theirs.get(package, 'not')} and this program "
                        f"{version}: the results would not be the same bytes."
                    )

    def _lost_connection(self) -> str:
        where = f"at {self.address} " if self.address else ""
        return (
            f"The cluster {where}does not answer any more; what it has done is kept. Give the same command "
            "again, with --resume where it has that option."
        )


def _size_of(path: Path) -> int | None:
    """Bytes of a file, 0 of a folder, and none where there is nothing."""
    if path.is_dir():
        return 0
    return path.stat().st_size if path.is_file() else None


def _size_and_text(path: str, probe: str) -> tuple[int | None, str]:
    """The size of a file, and what the file `probe` holds, as a worker sees them."""
    there = Path(probe)
    return _size_of(Path(path)), there.read_text() if there.is_file() else ""


def _run_whole(job: Job) -> JobResult:
    return run_job(job, _ignore, _is_cancelled)


def _is_cancelled() -> bool:
    """Whether the task of this thread of a worker has no client any more that waits for it."""
    worker = _distributed().get_worker()
    task = worker.state.tasks.get(worker.get_current_task())
    return task is None or task.state == "cancelled"


def _ignore(_event: Event) -> None:
    """Steps are not sent over the network: what counts in a batch is each job's result."""


def _leave_interrupts() -> None:
    """Let the client alone act on Ctrl+C, which a terminal sends to the workers on its machine too."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _local_cluster(workers: int) -> Any:
    return _distributed().LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        processes=True,
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
        memory_limit=memory_limit(workers),
        silence_logs=logging.CRITICAL,  # what goes wrong is an event of the run
    )


def _connect(place: Any, tls: TlsFiles | None) -> Any:
    distributed = _distributed()
    security = tls.security() if tls else None
    try:
        return distributed.Client(place, security=security, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, TimeoutError, ValueError, TypeError, MemoryError) as error:
        raise MissingRequirement(f"No cluster answers at {place} ({error}).") from error


def _distributed() -> Any:
    try:
        return import_module("distributed")
    except ImportError as error:
        raise MissingRequirement(NEEDED) from error
