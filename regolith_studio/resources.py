"""Where the files that ship with the program are found: samples, presets, schemas, icons."""

from functools import cache
from pathlib import Path

from regolith_studio.errors import MissingRequirement

SAMPLE = "sample:all"
"""Stands among inputs for the particles that ship with the program."""
_PACKAGE = Path(__file__).resolve().parent


@cache
def resource_folder() -> Path:
    """The folder ``resources``: inside the installed package, or beside it in a checkout.

    Raises MissingRequirement if the installation holds no resources.
    """
    for folder in (_PACKAGE / "_resources", _PACKAGE.parent / "resources"):
        if folder.is_dir():
            return folder
    raise MissingRequirement(
        f"The installation in {_PACKAGE} lacks its folder of resources; install the program again."
    )


def guide_folder() -> Path:
    """The folder of the guide: among the resources of an installation, ``docs`` in a checkout."""
    shipped = resource_folder() / "guide"
    return shipped if shipped.is_dir() else _PACKAGE.parent / "docs"


def results_folder() -> Path:
    """The folder of the benchmarks' results, which the tables of the guide are made from."""
    shipped = resource_folder() / "results"
    return shipped if shipped.is_dir() else _PACKAGE.parent / "benchmarks" / "results"


def resource(*parts: str) -> Path:
    """Path of one shipped file, for example ``resource("presets", "all.json")``.

    Raises MissingRequirement if there is no such file or folder.
    """
    path = resource_folder().joinpath(*parts)
    if not path.exists():
        raise MissingRequirement(f"The shipped file {'/'.join(parts)} is missing; install the program again.")
    return path
