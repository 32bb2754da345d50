"""The answers of the exercises are what the program says."""

import doctest
from pathlib import Path

EXERCISES = Path(__file__).resolve().parents[2] / "docs" / "exercises.md"


def test_that_the_answers_of_the_exercises_are_right() -> None:
    result = doctest.testfile(str(EXERCISES), module_relative=False)
    assert result.attempted > 25
    assert result.failed == 0
