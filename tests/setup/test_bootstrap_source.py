"""bootstrap.py as a file: what it needs, and what it says before it does anything."""

import ast
import sys
from pathlib import Path
from types import ModuleType

import pytest

SOURCE = Path(__file__).resolve().parents[2] / "bootstrap.py"


def test_that_it_parses_on_old_pythons_so_that_they_can_say_that_they_are_old() -> None:
    ast.parse(SOURCE.read_text(encoding="utf-8"), feature_version=(3, 6))


def test_that_it_needs_nothing_but_the_standard_library() -> None:
    for node in ast.walk(ast.parse(SOURCE.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            assert {alias.name.split(".")[0] for alias in node.names} <= sys.stdlib_module_names
        elif isinstance(node, ast.ImportFrom):
            assert (node.module or "").split(".")[0] in sys.stdlib_module_names


def test_that_an_old_python_gets_one_sentence(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bootstrap.sys, "version_info", (3, 9, 2, "final", 0))
    assert bootstrap.main(["test"]) == 1
    assert capsys.readouterr().err == "Regolith Studio needs Python 3.11 or newer; this is Python 3.9.2.\n"


def test_that_help_sets_nothing_up(
    bootstrap: ModuleType, checkout: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert bootstrap.main(["--help"]) == 0
    assert "bootstrap.py demo -o DIR" in capsys.readouterr().out
    assert not (checkout / ".venv").exists()
