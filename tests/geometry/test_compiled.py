"""What is kept of compiled kernels on disk."""

import importlib
import sys
from pathlib import Path

import pytest

from regolith_studio.geometry import compiled

CALLEE = """
from regolith_studio.geometry.compiled import kernel

@kernel
def constant():
    return {}
"""
CALLER = """
from {package}.callee import constant
from regolith_studio.geometry.compiled import kernel

@kernel
def doubled():
    return 2 * constant()
"""


def doubled(name: str) -> int:
    """Import the package afresh, as a new process does, and call the kernel."""
    for module in [key for key in sys.modules if key.startswith(name)]:
        del sys.modules[module]
    importlib.invalidate_caches()
    compiled.kernel_sources.cache_clear()
    return int(importlib.import_module(f"{name}.caller").doubled())


def test_that_compiled_code_does_not_survive_an_edit_of_a_kernel_that_it_calls(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "studio" / "part"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "caller.py").write_text(CALLER.format(package="part"))
    (package / "callee.py").write_text(CALLEE.format(21))
    monkeypatch.syspath_prepend(str(tmp_path / "studio"))
    monkeypatch.setattr(compiled, "_PACKAGE", tmp_path / "studio")
    assert doubled("part") == 42
    (package / "callee.py").write_text(CALLEE.format(1000))
    assert doubled("part") == 2000


def test_that_only_files_with_kernels_count(tmp_path: Path) -> None:
    (tmp_path / "plain.py").write_text("x = 1")
    before = compiled.kernel_sources(tmp_path)
    compiled.kernel_sources.cache_clear()
    (tmp_path / "plain.py").write_text("x = 2")
    assert compiled.kernel_sources(tmp_path) == before
    compiled.kernel_sources.cache_clear()
    (tmp_path / "fast.py").write_text("@kernel")
    assert compiled.kernel_sources(tmp_path) != before
