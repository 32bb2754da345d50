"""Who shall work on a batch, as the command line and the window ask for it."""

from dataclasses import dataclass
from pathlib import Path

from regolith_studio.errors import InputError
from regolith_studio.jobs.crew import Crew
from regolith_studio.jobs.runners.dask_cluster import TlsFiles

RUNNERS = {"processes": "processes of this machine", "dask": "a Dask cluster"}
"""By key, in words."""
TLS_NAMES = ("ca.pem", "cert.pem", "key.pem")


@dataclass(frozen=True)
class Hiring:
    """A crew that is to be hired; picklable.

    Parameters
    ----------
    runner
        Key of :data:`RUNNERS`.
    workers
        Processes of this machine, also of a cluster that is started on it; 0 for one a core.
    address
        Of the cluster's scheduler; without it a cluster is started on this machine.
    tls
        Folder with :data:`TLS_NAMES` for a ``tls://`` address.

    Raises
    ------
    InputError
        If these do not go together.
    """

    runner: str = "processes"
    workers: int = 1
    address: str = ""
    tls: Path | None = None

    def __post_init__(self) -> None:
        if self.runner not in RUNNERS:
            raise InputError(f"There is no runner {self.runner!r}; there are {' and '.join(RUNNERS)}.")
        if self.workers < 0:
            raise InputError(f"The number of workers must not be negative, got {self.workers}.")
        if self.runner == "processes" and (self.address or self.tls):
            raise InputError("An address and TLS files go with the runner dask.")

    def crew(self) -> Crew:
        """The crew, to be closed by the caller.

        Raises
        ------
        InputError, EnvironmentProblem
            As :class:`~regolith_studio.jobs.runners.dask_cluster.DaskRunner`.
        """
        if self.runner == "processes":
            return Crew(self.workers)
        files = TlsFiles(*[self.tls / name for name in TLS_NAMES]) if self.tls else None
        return Crew.on_cluster(self.address, self.workers, files)
