"""A checkout that holds only what bootstrap.py reads: no test touches this machine's packages or .venv."""

import importlib.util
import shutil
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

SOURCE = Path(__file__).resolve().parents[2] / "bootstrap.py"


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout that holds nothing but what bootstrap.py reads."""
    shutil.copy(SOURCE, tmp_path)
    (tmp_path / "pyproject.toml").write_text("[project]\n")
    (tmp_path / "constraints.txt").write_text("numpy==2.4.6\n")
    return tmp_path.resolve()


@pytest.fixture
def bootstrap(checkout: Path) -> ModuleType:
    """bootstrap.py of that checkout, so that its .venv is not ours."""
    spec = importlib.util.spec_from_file_location("bootstrap", checkout / "bootstrap.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def complete_system(bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """bootstrap.py on a system that lacks nothing."""
    monkeypatch.setattr(bootstrap, "library_loads", lambda _soname: True)
    monkeypatch.setattr(bootstrap, "has_font", lambda: True)
    monkeypatch.setattr(bootstrap.importlib.util, "find_spec", lambda _name: object())
    monkeypatch.setattr(bootstrap.shutil, "which", lambda name: f"/usr/bin/{name}")
    return bootstrap


@pytest.fixture
def lacks_opengl(complete_system: ModuleType, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """bootstrap.py on a system that lacks one library."""
    monkeypatch.setattr(complete_system, "library_loads", lambda soname: soname != "libGL.so.1")
    return complete_system


@pytest.fixture
def finish_venv(bootstrap: ModuleType, checkout: Path) -> Callable[..., None]:
    """Make a finished .venv whose interpreter is a shell script."""

    def finish(script: str = "exit 0", extra: str = "") -> None:
        python = checkout / ".venv" / "bin" / "python"
        python.parent.mkdir(parents=True)
        python.write_text(f"#!/bin/sh\n{script}\n")
        python.chmod(0o755)
        bootstrap.STAMP.write_text(f"{bootstrap.fingerprint()} {extra}\n")

    return finish
