"""Runs jobs on a Dask cluster: one of this machine's own, or one at an address."""

import contextlib
import threading
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

from regolith_studio.errors import EnvironmentProblem, InputError
from regolith_studio.jobs.events import Ending, Event, Failed, Job, Listener, Stopped
from regolith_studio.jobs.runners.drive import drive
from regolith_studio.jobs.runners.process_pool import cores, memory_limit
from regolith_studio.jobs.runners.scheduler_address import SchedulerAddress

CONNECT_SECONDS = 8.0
WORKER_SECONDS = 20.0
"""How long the scheduler, once it answers, and its first worker are waited for."""
NEEDED = 'This needs Dask, which is an extra: pip install "regolith-studio[cluster]".'


@dataclass(frozen=True)
class TlsFiles:
    """Files of an encrypted cluster (addresses that begin with ``tls://``).

    Parameters
    ----------
    authority
        Certificate of the authority that signed those of the cluster, PEM.
    certificate, key
        Of this program, PEM.
    """

    authority: Path
    certificate: Path
    key: Path

    def security(self) -> Any:
        """As Dask wants it: everything encrypted, both ends checked.

        Raises
        ------
        InputError
            If a file is missing.
        """
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
    asked_to_stop: bool = False
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def done(self) -> bool:
        return self.ended.is_set()

    def cancel(self) -> None:
        self.asked_to_stop = True
        if self.future is not None and not self.done:
            with contextlib.suppress(Exception):
                self.future.cancel()
        self.finish(Stopped())

    def finish(self, ending: Ending) -> None:
        """Tell the ending, once."""
        if not self.ended.is_set():
            self.ended.set()
            self.listener(ending)


class DaskRunner:
    """Each job runs whole in a worker of the cluster; listeners are called in a thread of the client.

    A worker that dies is replaced by the cluster, and its jobs are done again by others; a job that has
    ended several workers has failed. A job that was cancelled may run on to its end unheard.

    Parameters
    ----------
    address
        Of a scheduler, ``tcp://host:8786`` or ``tls://host:8786``; empty to start a cluster here.
    workers
        Processes of a cluster started here; 0 for one a core.
    tls
        Files for an encrypted cluster.

    Raises
    ------
    EnvironmentProblem
        If Dask is not installed, nobody answers, or the workers run other versions of what the numbers
        come from.
    InputError
        If an address asks for encryption and there are no files for it.
    """

    def __init__(self, address: str = "", workers: int = 0, tls: TlsFiles | None = None) -> None:
        if address.startswith("tls://") and tls is None:
            raise InputError(f"The address {address} is encrypted: give certificate, key and authority.")
        _distributed()
        self.address = _checked(address, tls) if address else ""
        self._open: set[_DaskHandle] = set()
        self._lock = threading.Lock()
        self._cluster = None if self.address else _local_cluster(workers or cores())
        try:
            self._client = _connected(self._cluster if self._cluster is not None else self.address, tls)
        except BaseException:
            self._close_cluster()
            raise
        try:
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

    def submit(self, job: Job, listener: Listener, lane: str = "") -> _DaskHandle:  # noqa: ARG002
        if self._client.status != "running":
            raise EnvironmentProblem(self._gone())
        handle = _DaskHandle(listener)
        with self._lock:
            self._open.add(handle)
        handle.future = self._client.submit(_run_whole, job, pure=False)
        handle.future.add_done_callback(lambda future: self._conclude(handle, future))
        return handle

    def close(self) -> None:
        """Cancel what runs, and let go of the cluster; one that was started here ends."""
        for handle in list(self._open):
            handle.cancel()
        with contextlib.suppress(Exception):
            self._client.close(timeout=CONNECT_SECONDS)
        self._close_cluster()

    def _close_cluster(self) -> None:
        if self._cluster is not None:
            with contextlib.suppress(Exception):
                self._cluster.close(timeout=CONNECT_SECONDS)

    def _conclude(self, handle: _DaskHandle, future: Any) -> None:
        with self._lock:
            self._open.discard(handle)
        handle.finish(self._ending(handle, future))

    def _ending(self, handle: _DaskHandle, future: Any) -> Ending:
        if handle.asked_to_stop:
            return Stopped()
        if future.status in ("cancelled", "lost"):
            return Stopped(self._gone())
        try:
            ending: Ending = future.result()
        except _distributed().KilledWorker as error:
            return Failed("Workers died of it; they may have run out of memory.", str(error))
        except Exception as error:  # noqa: BLE001  whatever could not be sent, received or unpickled
            return Failed(f"A worker of the cluster could not answer ({error}).", repr(error))
        return ending

    def _check_versions(self) -> None:
        from regolith_studio.dataset.build import software_versions

        try:
            self._client.wait_for_workers(1, timeout=WORKER_SECONDS)
        except TimeoutError as error:
            raise EnvironmentProblem(
                f"The scheduler at {self.address} has no worker; start one with: dask worker {self.address}"
            ) from error
        mine = software_versions()
        for worker, theirs in self._client.run(software_versions).items():
            for package, version in mine.items():
                if theirs.get(package) != version:
                    raise EnvironmentProblem(
                        f"The worker {worker} has {package} {theirs.get(package, 'not')} and this program "
                        f"{version}: the results would not be the same bytes."
                    )

    def _gone(self) -> str:
        where = f"at {self.address} " if self.address else ""
        return f"The cluster {where}does not answer any more; what it has done is kept, go on with --resume."


def _run_whole(job: Job) -> Ending:
    return drive(job, _silent, lambda: False)


def _silent(_event: Event) -> None:
    """Steps are not sent over the network: what counts in a batch is each job's ending."""


def _local_cluster(workers: int) -> Any:
    return _distributed().LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        processes=True,
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
        memory_limit=memory_limit(workers),
    )


def _checked(address: str, tls: TlsFiles | None) -> str:
    """The address in full, where a scheduler answers."""
    if tls:
        tls.security()
    place = SchedulerAddress.parsed(address)
    place.check()
    return str(place)


def _connected(place: Any, tls: TlsFiles | None) -> Any:
    distributed = _distributed()
    security = tls.security() if tls else None
    try:
        return distributed.Client(place, security=security, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, TimeoutError, ValueError, TypeError, MemoryError) as error:
        raise EnvironmentProblem(f"No cluster answers at {place} ({error}).") from error


def _distributed() -> Any:
    try:
        return import_module("distributed")
    except ImportError as error:
        raise EnvironmentProblem(NEEDED) from error
