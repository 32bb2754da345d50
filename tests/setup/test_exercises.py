"""The answers of the exercises are what the program says."""

import doctest
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.mark.slow
def test_that_the_answers_of_the_exercises_are_right() -> None:
    result = doctest.testfile(str(DOCS / "teaching.md"), module_relative=False)
    assert result.attempted > 40
    assert result.failed == 0
