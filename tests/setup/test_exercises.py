"""The answers of the exercises are what the program says."""

import doctest
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.mark.parametrize(
    ("page", "least"), [("exercises", 25), pytest.param("teaching", 20, marks=pytest.mark.slow)]
)
def test_that_the_answers_of_the_exercises_are_right(page: str, least: int) -> None:
    result = doctest.testfile(str(DOCS / f"{page}.md"), module_relative=False)
    assert result.attempted > least
    assert result.failed == 0
