"""Fixtures that every folder of tests shares."""

import os
import signal
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from unittest.mock import patch

import pytest
import typer

REAL_DATA = Path(
    os.environ.get("REGOLITH_REAL_DATA", Path(__file__).resolve().parents[2] / "shared" / "data")
)
"""Scans that do not ship with the program; tests that need them are skipped where they are absent."""

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # started in the background of a shell
    signal.signal(signal.SIGINT, signal.default_int_handler)  # what the tests start would ignore Ctrl+C
if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:  # started by nohup
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


class Unfinished:
    """Lists at the end of an interrupted run what did not run; ``.ci/run`` interrupts the long studies."""

    def __init__(self) -> None:
        self.left: dict[str, None] = {}

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self.left = dict.fromkeys(item.nodeid for item in session.items)

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, ids: list[str]) -> None:
        self.left = dict.fromkeys(ids)

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        self.left.pop(nodeid, None)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter, exitstatus: int) -> None:
        if exitstatus == pytest.ExitCode.INTERRUPTED and self.left:
            terminalreporter.section(f"interrupted: {len(self.left)} tests not run")
            for nodeid in self.left:
                terminalreporter.line(nodeid)


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Unfinished())


@pytest.fixture(scope="session", autouse=True)
def kernels_are_compiled() -> Iterator[None]:
    """No job waits for kernels: its events are the same, whatever the cache on this machine holds."""
    from regolith_studio.jobs import compile_kernels

    with patch.object(compile_kernels, "_mark", return_value=None):
        yield


@pytest.fixture(scope="session", autouse=True)
def commands_are_built_once() -> Iterator[None]:
    """Keep the commands: Typer builds all of them at each call, which takes 24 ms."""
    with patch.object(typer.main, "get_command", cache(typer.main.get_command)):
        yield


@pytest.fixture(scope="session")
def real_data() -> Callable[[str], Path]:
    """Path of a file or folder below the real data, or a skipped test."""

    def find(name: str) -> Path:
        path = REAL_DATA / name
        if not path.exists():
            pytest.skip(f"the real data {name} is not here")
        return path

    return find
