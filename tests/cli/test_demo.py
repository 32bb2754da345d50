"""``demo`` on a shortened sample here; the whole one is measured by hand and in the slow tests."""

import re
import struct
from html.parser import HTMLParser
from pathlib import Path

import pytest

from regolith_studio.cli.entry import run
from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.readers.particles import sample_particles
from regolith_studio.session.batch import inputs

EXPECTED = {
    "summary.html",
    "recipe.json",
    "three-views.png",
    "dataset/dataset.json",
    "descriptors.csv",
    "fit.json",
    "meshes/coarsening.json",
}


class Pictures(HTMLParser):
    """The files that a page shows."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.files: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.files.append(str(dict(attrs)["src"]))


def size_of_png(path: Path) -> tuple[int, int]:
    header = path.read_bytes()[:24]
    assert header[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", header[16:])
    return width, height


def check(folder: Path) -> None:
    files = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert files >= EXPECTED
    page = (folder / "summary.html").read_text()
    pictures = Pictures(page).files
    assert "three-views.png" in pictures
    assert {"studies/lmax_rmsre.png", "studies/coarsening_rmsre.png"} <= set(pictures)
    for picture in pictures:
        assert min(size_of_png(folder / picture)) > 200
    assert len(re.findall("<h2>", page)) >= 4


@pytest.mark.slow
def test_that_the_demo_shows_the_whole_chain(
    command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = [particle for particle in sample_particles() if particle.name in ("angular-1", "bead-2")]
    monkeypatch.setattr(inputs, "sample_particles", lambda: few)
    result = command("demo", "-o", tmp_path / "demo", "--jobs", 1)
    assert result.err == ""
    assert result.code == 0
    check(tmp_path / "demo")
    assert len(read_dataset(tmp_path / "demo" / "dataset")) == 2


@pytest.mark.slow
def test_that_the_whole_demo_leaves_everything_it_promises(tmp_path: Path) -> None:
    assert run(["demo", "-o", str(tmp_path / "demo")]) == 0
    check(tmp_path / "demo")
