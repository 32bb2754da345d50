"""Chapters of the user guide, whose tables of results are filled in from the result files of the benchmarks.

A block of a chapter names a file of ``benchmarks/results`` and holds Markdown with fields in braces::

    ```{results} dataset
    | shapes | AR | S |
    | ---: | ---: | ---: |
    | 10 | {N>rows>10>0:.2f} | {N>rows>10>1:.2f} |
    ```

A line with ``>*`` stands for one line for each key there, which ``*`` is replaced by.

A field is a path of keys. A step such as ``engine=mujoco;seed=1`` selects the records of a list, keys of a
list of records such as ``low,high`` are the list of their values, ``:5`` its first five, ``1:4`` its second
to fourth. A list becomes one cell each, with ``mean`` its mean and half the width of Student's interval of
95 %, with ``range`` its ends, with ``pairs`` one cell for each two numbers, joined by ±.
"""

import json
import re
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
from scipy.special import stdtrit

from regolith_studio.resources import guide_folder, results_folder

_BLOCK = re.compile(r"^```\{results\} (\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_FIELD = re.compile(r"\{([^{}]+)\}")
_EVERY = re.compile(r"\{([^{}]+)>\*")


def chapter(name: str) -> str:
    """Markdown of a chapter by the name of its file, with its tables."""
    return with_results((guide_folder() / f"{name}.md").read_text(encoding="utf-8"))


def with_results(text: str) -> str:
    """Markdown whose blocks of results are filled in.

    Raises KeyError if a field is not in the file of results.
    """
    return _BLOCK.sub(
        lambda block: _FIELD.sub(
            lambda field: _cell(block[1], field[1]), "".join(_expanded(block[1], block[2]))
        ),
        text,
    )


def _expanded(name: str, block: str) -> Iterator[str]:
    """Lines of a block, those of tables with all rows as often as there are rows."""
    for line in block.splitlines(keepends=True):
        table = _EVERY.search(line)
        yield from (line.replace("*", key) for key in _value(name, table[1])) if table else (line,)


@cache
def _results(name: str) -> Any:
    return json.loads((results_folder() / f"{name}.json").read_text(encoding="utf-8"))


def _cell(name: str, field: str) -> str:
    path, colon, form = field.rpartition(":")
    path, form = (path, form) if colon else (form, "")
    value = _value(name, path)
    summary, _, digits = form.rpartition(" ")
    value = [each for each in value if each is not None] if isinstance(value, list) else value
    if summary == "mean":
        half_width = stdtrit(len(value) - 1, 0.975) * np.std(value, ddof=1) / np.sqrt(len(value))
        return f"{np.mean(value):{digits}} ± {half_width:{digits}}"
    if summary == "range":
        return f"{min(value):{digits}} to {max(value):{digits}}"
    if summary == "pairs":
        pairs = zip(value[::2], value[1::2], strict=True)
        return " | ".join(f"{one:{digits}} ± {two:{digits}}" for one, two in pairs)
    return " | ".join(f"{each:{digits}}" for each in (value if isinstance(value, list) else [value]))


def _value(name: str, path: str) -> Any:
    value = _results(name)
    for step in path.split(">"):
        value = _below(value, step)
    return value


def _below(value: Any, step: str) -> Any:
    """What lies one step below a value of a result file."""
    if not isinstance(value, list):
        return value[step]
    if step.isdigit():
        return value[int(step)]
    if ":" in step:
        return value[slice(*(int(end) if end else None for end in step.split(":")))]
    if "=" in step:
        target = dict(each.split("=") for each in step.split(";"))
        found = [row for row in value if all(str(row[key]) == text for key, text in target.items())]
    else:
        found = [row[key] for row in value for key in step.split(",")]
    if not found:
        raise KeyError(step)
    return found
