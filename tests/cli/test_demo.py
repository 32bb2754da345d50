"""``demo`` on a shortened sample here; the whole one is measured by hand and in the slow tests."""

import json
import struct
from html.parser import HTMLParser
from pathlib import Path

import pytest

from regolith_studio.cli import recipe
from regolith_studio.cli.entry import run
from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.readers.particles import sample_particles
from regolith_studio.session.batch import inputs
from regolith_studio.session.outputs import summary

EXPECTED = {
    "index.html",
    "demo.sha256",
    "particles/summary.html",
    "particles/three-views.png",
    "particles/meshes/coarsening.json",
    "scan/descriptors.csv",
    "scan/volumes/sample-grey.json",
    "scan/fit.json",
    "scan/dataset/dataset.json",
    "scan/exports/rocky/export.json",
    "population/particles.csv",
    "heap/repose.json",
    "heap/heap.png",
    "heap/sections.png",
}


class Pictures(HTMLParser):
    """The files that a page shows, and those that it links."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.files: list[str] = []
        self.links: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.files.append(str(dict(attrs)["src"]))
        if tag == "a":
            self.links.append(str(dict(attrs)["href"]))


def size_of_png(path: Path) -> tuple[int, int]:
    header = path.read_bytes()[:24]
    assert header[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", header[16:])
    return width, height


def check(folder: Path) -> str:
    """Check files, pictures and links; returns the text of the page."""
    files = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert files >= EXPECTED
    assert not any("journal" in name or "times" in name for name in files)
    text = (folder / "index.html").read_text()
    summary_text = (folder / "particles" / "summary.html").read_text()
    page, summary = Pictures(text), Pictures(summary_text)
    assert {"particles/three-views.png", "particles/studies/lmax_rmsre.png", "heap/heap.png"} <= {*page.files}
    assert {"studies/lmax_rmsre.png", "studies/coarsening_rmsre.png"} <= {*summary.files}
    for picture in (*page.files, *(f"particles/{name}" for name in summary.files)):
        assert min(size_of_png(folder / picture)) > 200
    assert len(page.links) > 8
    assert all((folder / link).exists() for link in page.links)
    assert "This is an illustration" in text
    assert "Nothing here was measured on a material" in text
    assert "synthetic particle, its spherical-harmonics fit" in summary_text
    assert "Goldberg" in text
    assert len(read_dataset(folder / "scan" / "dataset")) == 12
    assert json.loads((folder / "heap" / "repose.json").read_text())["checks"]["particles_out"] > 290
    return text


@pytest.mark.parametrize(
    ("jobs", "steps"),
    [
        (1, ["scan", "particles", "population", "heap begun", "heap done"]),
        (2, ["scan", "heap begun", "particles", "population", "heap done"]),
    ],
)
def test_that_the_heap_is_simulated_during_the_other_steps_if_there_are_processes_for_it(
    command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, jobs: int, steps: list[str]
) -> None:
    done: list[str] = []

    def heap(*_: object) -> Steps:
        yield Started("Angle of repose")
        done.append("heap begun")
        yield Progress(0, 1)
        done.append("heap done")

    for step in ("_shipped_scan", "_shipped_particles", "_draw_population"):
        monkeypatch.setattr(recipe, step, lambda *_, name=step: done.append(name.rpartition("_")[2]))
    monkeypatch.setattr(recipe, "_heap", heap)
    monkeypatch.setattr(summary, "demo_page", lambda *_: "")
    assert command("demo", "-o", tmp_path / "demo", "--jobs", jobs).code == 0
    assert done == steps


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_that_the_demo_shows_the_whole_chain(
    command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = [particle for particle in sample_particles() if particle.name in ("angular-1", "bead-2")]
    monkeypatch.setattr(inputs, "sample_particles", lambda: few)
    result = command("demo", "-o", tmp_path / "demo", "--jobs", 1)
    assert result.err == ""
    assert result.code == 0
    assert "bead-2" in check(tmp_path / "demo")
    assert len(read_dataset(tmp_path / "demo" / "particles" / "dataset")) == 2


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_that_the_whole_demo_leaves_everything_it_promises(tmp_path: Path) -> None:
    assert run(["demo", "-o", str(tmp_path / "demo")]) == 0
    check(tmp_path / "demo")
