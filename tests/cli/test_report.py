"""``report`` as a command; what stands in a report is tested in ``tests/session``."""

from pathlib import Path

import pytest

from regolith_studio.jobs.events import Progress
from regolith_studio.session.report import write
from regolith_studio.session.report.sections import ReportDraft, ReportSection, SectionSteps


def names(draft: ReportDraft, title: str) -> SectionSteps:
    yield Progress(1, 1)
    shown = [each.name for each in draft.particles]
    return ReportSection(title, tuple(shown), problem="" if draft.settings.heap else "There is no heap.")


@pytest.fixture(autouse=True)
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(write, "PARTS", {"Names": names})


def test_that_the_command_writes_page_and_document(command, grains: Path, tmp_path: Path) -> None:
    done = command("report", grains, "-o", tmp_path / "out", "--json", "--l-max", 6)
    assert (done.code, done.err) == (0, "")
    assert done.json["files"] == ["report.html", "report.json"]
    assert done.json["problems"] == []
    text = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert all(f"<p>{name}</p>" in text for name in ("grain-a", "grain-b", "grain-c"))


def test_that_what_is_missing_is_a_sentence_and_exit_code_1(command, grains: Path, tmp_path: Path) -> None:
    done = command("report", grains, "-o", tmp_path / "out", "--heap", 0)
    assert (done.code, done.err.strip()) == (1, "Names: There is no heap.")
    assert "begin with" in done.out
    assert "<strong>Missing:</strong> There is no heap." in (tmp_path / "out" / "report.html").read_text()


def test_that_a_recipe_gives_the_particles_of_its_inputs(command, grains: Path, tmp_path: Path) -> None:
    recipe = grains / "two.json"
    recipe.write_text('{"inputs": ["grain-a.stl", "grain-c.stl"]}')
    try:
        done = command("report", recipe, "-o", tmp_path / "out")
    finally:
        recipe.unlink()
    assert (done.code, done.err) == (0, "")
    text = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<p>grain-c</p>" in text
    assert "<p>grain-b</p>" not in text


def test_that_a_heap_of_too_few_particles_is_bad_use(command, grains: Path, tmp_path: Path) -> None:
    done = command("report", grains, "-o", tmp_path / "out", "--heap", 10)
    assert done.code == 2
    assert "too few for a heap" in done.err


def test_that_a_file_without_particles_is_one_sentence(command, tmp_path: Path) -> None:
    (tmp_path / "model.json").write_text('{"format": "regolith-studio model"}')
    done = command("report", tmp_path / "model.json", "-o", tmp_path / "out")
    assert done.code == 1
    assert done.err.strip() == "model.json (fit, model or material card) holds no particles to report on."
