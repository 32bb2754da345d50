"""Pictures and animations take the places of earlier ones when all of their files are complete."""

import errno
from pathlib import Path

import pytest

from regolith_studio.errors import FileError
from regolith_studio.scene.animation import write_drawn


def draw_frames(path: Path, count: int, fails: bool) -> None:
    for number in range(count):
        path.with_name(f"{path.stem}-{number:03d}.png").write_text("new")
    if fails:
        raise OSError(errno.ENOSPC, "No space left on device")


def contents(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir()}


def test_that_a_full_disk_is_one_sentence_and_leaves_the_earlier_frames(tmp_path: Path) -> None:
    path = tmp_path / "turn.png"
    earlier = {"turn-000.png": "old", "turn-001.png": "old"}
    for name, text in earlier.items():
        (tmp_path / name).write_text(text)
    with pytest.raises(FileError, match=r"turn.png cannot be written \(the disk is full\)."):
        list(write_drawn("Drawing", path, draw_frames, (2, True)))
    assert contents(tmp_path) == earlier
    list(write_drawn("Drawing", path, draw_frames, (2, False)))
    assert contents(tmp_path) == dict.fromkeys(earlier, "new")
