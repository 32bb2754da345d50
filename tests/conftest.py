"""Fixtures that every folder of tests shares."""

import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

REAL_DATA = Path(
    os.environ.get("REGOLITH_REAL_DATA", Path(__file__).resolve().parents[2] / "shared" / "data")
)
"""Scans that do not ship with the program; tests that need them are skipped where they are absent."""

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # started in the background of a shell
    signal.signal(signal.SIGINT, signal.default_int_handler)  # what the tests start would ignore Ctrl+C


@pytest.fixture(scope="session")
def real_data() -> Callable[[str], Path]:
    """Path of a file or folder below the real data, or a skipped test."""

    def find(name: str) -> Path:
        path = REAL_DATA / name
        if not path.exists():
            pytest.skip(f"the real data {name} is not here")
        return path

    return find
