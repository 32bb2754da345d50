"""Tables of the guide: filled in from the results of the benchmarks, in the web pages and in the window."""

import json
from pathlib import Path

import pytest

from regolith_studio import guide
from regolith_studio.resources import guide_folder

RESULTS = {
    "rows": {"10": [0.1, 0.25]},
    "heaps": [
        {"engine": "a", "seed": 1, "angle": 30.0},
        {"engine": "a", "seed": 2, "angle": 34.0},
        {"engine": "b", "seed": 1, "angle": 20.0},
        {"engine": "b", "seed": 2, "angle": None},
    ],
}


@pytest.fixture
def results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "heaps_of_two.json").write_text(json.dumps(RESULTS))
    monkeypatch.setattr(guide, "results_folder", lambda: tmp_path)


def block(text: str) -> str:
    return guide.with_results(f"```{{results}} heaps_of_two\n{text}\n```\n").rstrip("\n")


@pytest.mark.usefixtures("results")
@pytest.mark.parametrize(
    ("text", "cells"),
    [
        ("| 10 | {rows>10:.2f} |", "| 10 | 0.10 | 0.25 |"),
        ("{rows>10>1:.2f}", "0.25"),
        ("{rows>10>:1:.2f}", "0.10"),
        ("{rows>10:range .1f}", "0.1 to 0.2"),
        ("| rows | V |\n| * | {rows>*:pairs .1f} |", "| rows | V |\n| 10 | 0.1 ± 0.2 |"),
        ("{heaps>engine=a;seed=2>angle:.0f}", "34"),
        ("{heaps>engine=a>angle:mean .0f}", "32 ± 25"),
        ("{heaps>engine=b>angle:.0f}", "20"),
    ],
)
def test_that_a_field_of_a_table_is_the_number_of_the_results(text: str, cells: str) -> None:
    assert block(text) == cells


@pytest.mark.usefixtures("results")
@pytest.mark.parametrize("field", ["{rows>11}", "{heaps>engine=c>angle:.0f}"])
def test_that_a_number_that_was_not_measured_is_an_error(field: str) -> None:
    with pytest.raises(KeyError):
        block(field)


@pytest.mark.parametrize("name", sorted(path.stem for path in guide_folder().glob("*.md")))
def test_that_every_chapter_has_its_numbers(name: str) -> None:
    assert "{results}" not in guide.chapter(name)
