"""The licence is the BSD 3-Clause License, and what the guide says of other licences is what is installed."""

import re
import tomllib
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution, files
from pathlib import Path

from packaging.requirements import Requirement

from regolith_studio.ui.dialogs.help import COPYLEFT, LICENCE, licence_of

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
DIRECT = {Requirement(line).name for line in PROJECT["dependencies"]}
PERMISSIVE = re.compile(r"BSD|MIT|ISC|Apache|PSF|Python Software Foundation|LicenseRef-MPICH")
PAGE = (
    (ROOT / "docs" / "installing.md")
    .read_text(encoding="utf-8")
    .partition("## Licences")[2]
    .partition("\n## ")[0]
)


def closure(names: set[str]) -> set[str]:
    """These packages and what they bring along, as far as it is installed here."""
    found: set[str] = set()
    todo = sorted(names)
    while todo:
        name = todo.pop().lower().replace("_", "-")
        if name in found:
            continue
        try:
            lines = distribution(name).requires or []
        except PackageNotFoundError:  # wanted on other systems only
            continue
        found.add(name)
        asked = [Requirement(line) for line in lines]
        todo += [each.name for each in asked if each.marker is None or each.marker.evaluate({"extra": ""})]
    return found


def table() -> Iterator[tuple[str, str]]:
    """Package and licence of every row of the guide."""
    for line in PAGE.splitlines():
        if line.startswith("| ") and "---" not in line and "| packages |" not in line:
            licence, packages = (cell.strip() for cell in line.strip("| ").split(" | "))
            yield from ((name, licence) for name in packages.split(", "))


def words(licence: str) -> list[str]:
    return licence[licence.index("Redistribution and use") :].split()


def test_that_the_licence_is_the_bsd_licence_of_three_clauses() -> None:
    (path,) = [each for each in files("dask") or [] if each.name == "LICENSE.txt"]
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert words(text) == words(path.read_text())
    assert "Copyright (c) 2026, the Regolith Studio developers\n" in text
    assert PROJECT["license"] == LICENCE == "BSD-3-Clause"


def test_that_the_guide_states_the_licence_of_every_dependency_as_its_metadata_do() -> None:
    assert dict(table()) == {name: licence_of(name) for name in DIRECT}


def test_that_the_guide_names_everything_that_is_brought_along_without_a_permissive_licence() -> None:
    licences = {name: licence_of(name) for name in closure(DIRECT)}
    strict = {name for name, licence in licences.items() if re.search("GPL|MPL|EPL|CDDL", licence)}
    assert strict == {name.lower() for name in COPYLEFT} | {"shiboken6", "certifi", "tqdm"}
    assert licences["shiboken6"] == licence_of("PySide6-Essentials")
    assert f"certifi is under {licences['certifi']}" in PAGE
    assert licences["tqdm"] in PAGE
    assert all(PERMISSIVE.search(licences[name]) for name in licences.keys() - strict)


def test_that_the_wheel_of_pyshtools_and_no_other_holds_fftw() -> None:
    holders = {
        name for name in closure(DIRECT) if any("fftw3" in each.name.lower() for each in files(name) or [])
    }
    assert holders == {"pyshtools"}
