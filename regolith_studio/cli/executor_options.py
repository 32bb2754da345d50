"""Options that say where jobs run: in processes of this machine, or on a Dask cluster."""

from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.options import usage_errors
from regolith_studio.cli.terminal import print_errors

if TYPE_CHECKING:
    from regolith_studio.jobs.executor import Executor

Runner = Annotated[
    str,
    typer.Option(
        "--runner", help="Executor: processes (of this machine) or dask (a cluster).", metavar="NAME"
    ),
]
Address = Annotated[
    str,
    typer.Option(
        "--address",
        help="Dask scheduler, tcp://HOST:8786 or tls://HOST:8786; a local one is started if omitted.",
        metavar="URL",
        show_default=False,
    ),
]
Tls = Annotated[
    Path | None,
    typer.Option(
        "--tls",
        help="Folder with ca.pem, cert.pem and key.pem for a tls:// address.",
        metavar="DIR",
        show_default=False,
    ),
]


@contextmanager
def chosen_executor(runner: str, jobs: int, address: str, tls: Path | None) -> "Iterator[Executor]":
    """The executor that the options ask for, closed at the end; names the status page of a cluster."""
    from regolith_studio.jobs.executor import ExecutorSettings

    with usage_errors():
        executor = ExecutorSettings(runner, jobs, address, tls).open()
    with closing(executor):
        if executor.dashboard:
            print_errors([f"{executor.workers} workers; dashboard {executor.dashboard}"])
        yield executor
