"""What the page on the architecture says of additions, counted."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROW = re.compile(r"^\| an? ([\w ]+) \| (\d+) \| `(\w+)` \|", re.MULTILINE)
ROWS = ROW.findall((ROOT / "docs" / "architecture.md").read_text(encoding="utf-8"))


def test_that_the_page_has_a_number_for_every_kind_of_addition() -> None:
    kinds = {"descriptor", "exporter", "reader", "shape model", "engine", "page", "choice"}
    assert {kind for kind, *_ in ROWS} == kinds


@pytest.mark.parametrize(("most", "example"), [row[1:] for row in ROWS], ids=[row[0] for row in ROWS])
def test_that_an_addition_touches_no_more_modules_than_the_page_says(most: str, example: str) -> None:
    word = re.compile(rf"\b{example}\b")
    modules = sorted((ROOT / "regolith_studio").rglob("*.py"))
    found = [path.name for path in modules if word.search(path.read_text(encoding="utf-8"))]
    assert len(found) <= int(most), found
