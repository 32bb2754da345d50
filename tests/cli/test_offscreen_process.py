"""Pictures that a process of their own draws."""

import pytest

from regolith_studio.cli.offscreen_process import draw_in_process
from regolith_studio.errors import MissingRequirement


def test_that_what_was_drawn_takes_the_place_of_the_picture(tmp_path):
    (tmp_path / "drawn").write_bytes(b"new")
    (tmp_path / "picture.png").write_bytes(b"old")
    draw_in_process("shutil:copyfile", (tmp_path / "drawn",), tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes() == b"new"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drawn", "picture.png"]


def test_that_a_file_system_that_refuses_a_picture_is_named_and_not_the_graphics(tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(NotADirectoryError):
        draw_in_process("shutil:copyfile", (tmp_path / "file" / "below",), tmp_path / "picture.png")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_that_a_process_that_draws_nothing_is_a_machine_that_cannot_draw(tmp_path):
    with pytest.raises(MissingRequirement, match="cannot draw"):
        draw_in_process("operator:eq", (1,), tmp_path / "picture.png")
