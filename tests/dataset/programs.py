"""YADE as the tests of exports run it."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

needs_yade = pytest.mark.skipif(shutil.which("yade") is None, reason="YADE is not installed")


def run_yade(folder: Path, *arguments: str) -> None:
    subprocess.run(
        ["yade", "-n", "-x", "-j1", str(folder / "yade_case.py"), *arguments],
        check=True, capture_output=True, timeout=250, cwd=folder,
        env={key: value for key, value in os.environ.items() if key not in ("LD_LIBRARY_PATH", "PYTHONPATH")},
    )  # fmt: skip
