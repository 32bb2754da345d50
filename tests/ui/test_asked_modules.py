"""Modules that wait until they are asked."""

import importlib
import sys
from threading import Barrier, Thread

import pytest

from regolith_studio.ui.asked_modules import load_when_asked

SOURCE = """
import sys
sys.asked = getattr(sys, "asked", 0) + 1
from regolith_waiting.part import answer
"""


@pytest.fixture
def waiting(tmp_path, monkeypatch):
    """A package that counts how often it is run, and is run when something in it is asked for."""
    folder = tmp_path / "regolith_waiting"
    folder.mkdir()
    (folder / "__init__.py").write_text(SOURCE)
    (folder / "part.py").write_text("answer = 42")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys, "meta_path", [each for each in sys.meta_path if "asked" not in str(type(each))])
    monkeypatch.setattr(sys, "asked", 0, raising=False)
    load_when_asked(["regolith_waiting"])
    yield importlib.import_module("regolith_waiting")
    for name in [each for each in sys.modules if each.startswith("regolith_waiting")]:
        del sys.modules[name]


def test_that_looking_at_a_name_is_no_question_and_asking_runs_the_module_once(waiting):
    assert waiting.__name__ == "regolith_waiting"
    assert waiting.__file__.endswith("__init__.py")
    assert not hasattr(waiting, "__wrapped__")
    assert sys.asked == 0
    assert waiting.answer == 42
    assert importlib.import_module("regolith_waiting").answer == 42
    assert sys.asked == 1
    with pytest.raises(AttributeError):
        _ = waiting.nothing


def test_that_a_part_of_a_package_can_be_imported_first(waiting):
    assert importlib.import_module("regolith_waiting.part").answer == 42
    assert sys.asked == 0
    assert waiting.answer == 42


def test_that_two_threads_that_ask_at_once_both_get_their_answer(waiting):
    together, answers = Barrier(2), []

    def ask():
        together.wait()
        answers.append(waiting.answer)

    threads = [Thread(target=ask) for _ in range(2)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert answers == [42, 42]
    assert sys.asked == 1


def test_that_a_module_that_fails_says_so_each_time_and_not_that_something_is_missing(waiting, tmp_path):
    (tmp_path / "regolith_waiting" / "part.py").write_text("raise ValueError('broken')")
    for _ in range(2):
        with pytest.raises(ValueError, match="broken"):
            _ = waiting.answer
