"""Files of results that the guide's tables are read from: ``benchmarks/results/*.json``."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

Rows = dict[str, list[float]]


def add_result(path: str, name: str, rows: Mapping[str, Sequence[float]], **made_with: Any) -> None:
    """Set the rows of one table in a file of results; nothing without a path.

    Parameters
    ----------
    name
        Of the table: the first cell of its header in the guide.
    rows
        Numbers by the first cell of each row, as the guide states them.
    made_with
        Seeds and numbers of particles.
    """
    if not path:
        return
    file = Path(path)
    known = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    known[name] = {**made_with, "rows": {row: list(numbers) for row, numbers in rows.items()}}
    text = json.dumps(dict(sorted(known.items())), indent=1, ensure_ascii=False)
    file.write_text(text + "\n", encoding="utf-8")


def show_row(rows: Rows, name: str, numbers: Sequence[float], digits: int = 2) -> None:
    """Round the numbers of a row, keep and print them."""
    rows[name] = [round(float(number), digits) + 0.0 for number in numbers]
    print("|", name, "|", " | ".join(f"{number:.{digits}f}" for number in rows[name]), "|", flush=True)
