"""The virtual environment: when it is ready, half-made, or somebody else's."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

posix = pytest.mark.skipif(os.name == "nt", reason="the stand-in for Python is a shell script")


@pytest.mark.parametrize("name", ["pyproject.toml", "constraints.txt"])
def test_that_a_changed_pin_or_dependency_changes_the_fingerprint(
    bootstrap: ModuleType, checkout: Path, name: str
) -> None:
    before = bootstrap.fingerprint()
    assert bootstrap.fingerprint() == before
    (checkout / name).write_text("numpy==3.0\n")
    assert bootstrap.fingerprint() != before


@posix
@pytest.mark.parametrize(
    ("installed", "wanted", "ready"),
    [("", "", True), ("", "test", False), ("test", "", True), ("test", "test", True)],
)
def test_that_what_tests_need_is_enough_for_the_program_but_not_the_reverse(
    bootstrap: ModuleType, finish_venv: Callable[..., None], installed: str, wanted: str, ready: bool
) -> None:
    finish_venv(extra=installed)
    assert bootstrap.is_ready(wanted) is ready


@posix
@pytest.mark.parametrize("half_made", ["marked as unfinished", "no stamp", "no interpreter"])
def test_that_a_half_made_venv_is_not_ready(
    bootstrap: ModuleType, finish_venv: Callable[..., None], half_made: str
) -> None:
    finish_venv()
    if half_made == "marked as unfinished":
        bootstrap.UNFINISHED.touch()
    elif half_made == "no stamp":
        bootstrap.STAMP.unlink()
    else:
        bootstrap.venv_python().unlink()
    assert not bootstrap.is_ready("")


@posix
def test_that_a_venv_of_another_folder_or_python_is_not_used(
    bootstrap: ModuleType, finish_venv: Callable[..., None]
) -> None:
    finish_venv("echo 3.11 /somewhere/else")
    assert not bootstrap.usable_venv()


class Pip:
    """Stands in for subprocess.call: records what would be run, and answers or raises."""

    def __init__(self, answer: int | BaseException) -> None:
        self.answer = answer
        self.commands: list[list[str]] = []

    def __call__(self, command: list[str], **_options: Any) -> int:
        self.commands.append(command)
        if isinstance(self.answer, BaseException):
            raise self.answer
        return self.answer


def installing(bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, answer: int | BaseException) -> Pip:
    pip = Pip(answer)
    bootstrap.VENV.mkdir(exist_ok=True)
    monkeypatch.setattr(bootstrap, "usable_venv", lambda: True)
    monkeypatch.setattr(bootstrap.subprocess, "call", pip)
    return pip


def test_that_packages_are_installed_with_the_pins_and_the_program_editable(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    pip = installing(bootstrap, monkeypatch, 0)
    bootstrap.set_up("test")
    assert pip.commands[0][-4:] == ["-c", "constraints.txt", "-e", ".[test]"]
    assert bootstrap.STAMP.read_text() == f"{bootstrap.fingerprint()} test\n"
    assert not bootstrap.UNFINISHED.exists()


def test_that_an_interrupted_installation_leaves_a_mark_and_is_made_anew(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    usable = bootstrap.usable_venv
    installing(bootstrap, monkeypatch, KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        bootstrap.set_up("")
    assert bootstrap.UNFINISHED.exists()
    assert not usable()


def test_that_a_failing_pip_is_reported_and_tried_again_without_starting_over(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    installing(bootstrap, monkeypatch, 1)
    with pytest.raises(bootstrap.SetupStopped, match="pip could not install"):
        bootstrap.set_up("")
    assert not bootstrap.UNFINISHED.exists()
    assert not bootstrap.STAMP.exists()


def lacking(bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, *missing: str) -> None:
    """Let Python be without some modules and programs."""
    monkeypatch.setattr(
        bootstrap.importlib.util, "find_spec", lambda name: None if name in missing else object()
    )
    monkeypatch.setattr(
        bootstrap.shutil, "which", lambda name: None if name in missing else f"/usr/bin/{name}"
    )


@pytest.mark.parametrize(
    ("missing", "beginning"),
    [
        ([], ["VENV", "-m", "pip", "install"]),
        (["ensurepip"], [sys.executable, "-m", "pip", "--python", "VENV", "install"]),
        (["ensurepip", "pip"], ["uv", "pip", "install", "--quiet", "--python", "VENV"]),
    ],
)
def test_that_packages_are_installed_without_ensurepip(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, missing: list[str], beginning: list[str]
) -> None:
    pip = installing(bootstrap, monkeypatch, 0)
    lacking(bootstrap, monkeypatch, *missing)
    bootstrap.set_up("")
    expected = [str(bootstrap.venv_python()) if word == "VENV" else word for word in beginning]
    assert pip.commands[0][: len(expected)] == expected
    assert pip.commands[0][-4:] == ["-c", "constraints.txt", "-e", "."]


def test_that_python_without_any_installer_names_three_before_making_anything(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    lacking(bootstrap, monkeypatch, "ensurepip", "pip", "uv")
    with pytest.raises(bootstrap.SetupStopped, match="python3-venv, or python3-pip, or uv"):
        bootstrap.set_up("")
    assert not bootstrap.VENV.exists()


@pytest.mark.slow
def test_that_a_venv_without_pip_is_filled_by_the_pip_of_this_python(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pip")
    real = bootstrap.importlib.util.find_spec
    monkeypatch.setattr(
        bootstrap.importlib.util, "find_spec", lambda name: None if name == "ensurepip" else real(name)
    )
    bootstrap.make_venv()
    bootstrap.UNFINISHED.unlink()
    assert bootstrap.usable_venv()
    listed = [*bootstrap.installer()[:5], "list", "--format=freeze"]
    assert subprocess.run(listed, capture_output=True, text=True, check=True).stdout.strip() == ""


@pytest.mark.slow
def test_that_a_half_made_venv_is_made_anew(bootstrap: ModuleType, checkout: Path) -> None:
    (checkout / ".venv" / "bin").mkdir(parents=True)
    rubbish = checkout / ".venv" / "rubbish"
    rubbish.touch()
    assert not bootstrap.usable_venv()
    bootstrap.make_venv()
    assert not rubbish.exists()
    assert not bootstrap.usable_venv()  # still marked: the packages are not in it
    bootstrap.UNFINISHED.unlink()
    assert bootstrap.usable_venv()
