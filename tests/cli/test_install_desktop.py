"""The entry of the menu is put into the data folder of the user, as desktops read it, and can be removed."""

import configparser
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from regolith_studio.resources import resource
from tests.cli.conftest import Said

pytestmark = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="no desktop of freedesktop.org")
ENTRY = "applications/regolith-studio.desktop"
ICON = "icons/hicolor/scalable/apps/regolith-studio.svg"
QUESTION = """
import sys
from PySide6.QtCore import QMimeDatabase
kinds = QMimeDatabase()
for name in sys.argv[1:]:
    kind = kinds.mimeTypeForFile(name, QMimeDatabase.MatchMode.MatchExtension)
    print(kind.name(), kind.inherits("application/json"))
"""


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    return tmp_path / "data"


def entry(data: Path) -> configparser.SectionProxy:
    parser = configparser.RawConfigParser(delimiters="=")
    parser.optionxform = str  # type: ignore[assignment, method-assign]
    parser.read(data / ENTRY, encoding="utf-8")
    return parser["Desktop Entry"]


def test_that_entry_icon_and_types_are_installed_and_removed(
    command: Callable[..., Said], data: Path
) -> None:
    installed = command("install-desktop", "--json").json["installed"]
    assert all(Path(path).is_file() and Path(path).is_relative_to(data) for path in installed)
    assert entry(data)["Icon"] == Path(ICON).stem
    assert (data / ICON).read_bytes() == resource("icons", "app.svg").read_bytes()
    assert command("install-desktop", "--remove", "--json").json == {"removed": installed}
    assert not [path for path in data.rglob("regolith-studio*") if path.is_file()]
    assert command("install-desktop", "--remove").out == "There is nothing to remove.\n"


@pytest.mark.parametrize("python", [sys.executable, '/a b/100 % "$HOME`\\/python'])
def test_that_the_entry_starts_this_python_whatever_its_path_holds(
    python: str, command: Callable[..., Said], data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "executable", python)
    assert command("install-desktop").code == 0
    line = entry(data)["Exec"].replace(r"\\", "\\")  # as a string; its quotes are those of a shell
    printed = subprocess.run(
        ["sh", "-c", f"printf '%s\\n' {line}"], capture_output=True, text=True, check=True
    )
    words = [word.replace("%%", "%") for word in printed.stdout.splitlines()]
    assert words == [python, "-P", "-m", "regolith_studio", "open", "%F"]


def test_that_qt_finds_the_types_of_projects_and_recipes(command: Callable[..., Said], data: Path) -> None:
    assert command("install-desktop").code == 0
    names = ("moon.regolith", "moon.recipe.json", "recipe.json", "other.json")
    asked = [sys.executable, "-c", QUESTION, *names]
    environment = os.environ | {"XDG_DATA_HOME": str(data)}
    done = subprocess.run(asked, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [
        "application/x-regolith-studio-project True",
        "application/x-regolith-studio-recipe True",
        "application/x-regolith-studio-recipe True",
        "application/json True",
    ]
    offered = entry(data)["MimeType"].split(";")
    assert {line.split()[0] for line in done.stdout.splitlines()[:3]} <= set(offered)


def test_that_without_the_variable_the_folder_is_that_of_the_specification(
    command: Callable[..., Said], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_DATA_HOME", "not/absolute")
    assert command("install-desktop").code == 0
    assert (tmp_path / ".local" / "share" / ENTRY).is_file()
