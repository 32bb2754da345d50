"""Names and sentences stay printable and short, whatever a file or its name holds."""

from pathlib import Path

import pytest

from regolith_studio.readers.error_messages import display_name, message_about


@pytest.mark.parametrize("name", ["a\nb.stl", "\udcff.stl", "x" * 240 + ".stl", "\x1b[31mred.stl"])
def test_that_a_name_is_one_short_printable_line(name):
    shown = display_name(Path(name))
    assert shown.isprintable()
    assert len(shown) <= 80
    assert shown.endswith(".stl")


def test_that_a_long_sentence_loses_its_end_but_not_its_full_stop():
    sentence = message_about(Path("a.stl"), "is " + "very " * 100 + "bad.")
    assert sentence.startswith("a.stl is very very")
    assert sentence.endswith("….")
    assert len(sentence) <= 240


def test_that_an_ordinary_sentence_is_left_as_it_is():
    assert message_about(Path("dir/a.stl"), "is empty.") == "a.stl is empty."
