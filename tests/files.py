"""Files that a test compares or reads."""

import csv
from pathlib import Path


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below a folder by its path from there, but for those of the journal."""
    files = {path.relative_to(folder): path for path in sorted(folder.rglob("*")) if path.is_file()}
    return {name.as_posix(): path.read_bytes() for name, path in files.items() if name.parts[0] != "journal"}


def csv_rows(path: Path) -> list[dict[str, str]]:
    """Rows of a table by the names of its columns."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
