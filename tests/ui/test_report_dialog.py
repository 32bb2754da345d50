"""The report from the window: what its dialog asks, and that it writes what the command writes."""

import threading
from pathlib import Path

import pytest

from regolith_studio.errors import InputError
from regolith_studio.jobs.events import Progress
from regolith_studio.messages import N_
from regolith_studio.session.choices import Choices
from regolith_studio.session.report import write
from regolith_studio.session.report.sections import ReportSection
from regolith_studio.session.report.settings import ReportSettings
from regolith_studio.ui.batch_runs import ReportRuns
from regolith_studio.ui.dialogs.batch import ReportDialog
from regolith_studio.ui.widgets.plots.base import plain_text

HELD = threading.Event()


def counts(draft, title):
    yield Progress(1, 1)
    return ReportSection(title, (f"{len(draft.particles)} particles, seed {draft.settings.seed}",))


def waits(_draft, title):
    while not HELD.is_set():
        yield Progress(0, 1)
    return ReportSection(title)


def fails(_draft, _title):
    yield Progress(0, 1)
    raise InputError("Nothing can be drawn.")


@pytest.fixture
def sections(monkeypatch):
    """Lets a report have these sections only."""
    HELD.clear()
    return lambda **parts: monkeypatch.setattr(write, "PARTS", parts)


@pytest.fixture
def reports(dialog_runs, wait, tmp_path, monkeypatch):
    """Reports on the sample."""
    monkeypatch.setenv("HOME", str(tmp_path))
    made = dialog_runs(ReportRuns, Choices(method="quadric", seed=7))
    made._session.open_sample()
    wait(lambda: made._session.particles and not made._session.tasks)
    yield made
    HELD.set()


def asked(reports):
    reports.ask()
    dialog = reports._dialog
    dialog.workers.setValue(1)
    assert dialog.go.isEnabled(), dialog.state.text()
    return dialog


def files(folder: Path):
    return {path.name: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_that_the_report_begins_with_the_choices_of_the_window(shown, tmp_path):
    choices = Choices(l_max=8, n_facets=33, method="annealing", seed=5, preset="hull")
    dialog = shown(ReportDialog(2, choices, tmp_path / "out"))
    expected = ReportSettings(l_max=8, facets=33, method="annealing", seed=5, preset="hull")
    assert dialog.value().settings == expected
    assert dialog.value().folder == tmp_path / "out"
    dialog.restore_fields({"heap": 0, "drawn": 5, "splits": "many", "unknown": 3})
    assert dialog.value().settings.heap == 0
    assert dialog.value().settings.drawn == 5
    again = shown(ReportDialog(2, Choices(), tmp_path))
    again.restore_fields(dialog.field_values())
    assert again.value().settings == ReportSettings(heap=0, drawn=5)


def test_that_what_a_report_lacks_is_said_before_it_is_made(shown, tmp_path):
    dialog = shown(ReportDialog(0, Choices(), tmp_path / "out"))
    assert "open one first" in dialog.state.text()
    assert not dialog.go.isEnabled()
    dialog = shown(ReportDialog(1, Choices(), tmp_path / "out"))
    dialog.restore_fields({"heap": 3})
    assert "too few for a heap" in dialog.state.text()
    dialog.restore_fields({"heap": 0})
    assert dialog.go.isEnabled()
    dialog.folder.setValue(None)
    assert "folder" in dialog.state.text()


def test_that_the_window_writes_the_report_of_the_command_and_opens_it(
    reports, sections, tmp_path, wait, monkeypatch
):
    sections(**{"The sample": counts, "Fig. 2": fails})
    opened = []
    monkeypatch.setattr(
        "regolith_studio.ui.dialogs.batch.QDesktopServices.openUrl", lambda url: opened.append(url)
    )
    dialog = asked(reports)
    dialog.go.click()
    assert dialog.halt.isVisible()
    assert not dialog.form.isEnabled()
    wait(lambda: dialog.state.text().startswith("Done"))
    assert "Fig. 2: Nothing can be drawn." in plain_text(dialog.state.text())
    assert not dialog.halt.isVisible()
    dialog.results_button.click()
    assert [url.toLocalFile() for url in opened] == [str(tmp_path / "regolith-report" / "report.html")]
    particles = [entry.particle for entry in reports._session.particles]
    settings = dialog.value().settings
    for _ in write.write_report(particles, tmp_path / "alone", settings):
        pass
    assert files(tmp_path / "regolith-report") == files(tmp_path / "alone")
    assert b"12 particles, seed 7" in files(tmp_path / "alone")["report.html"]


def test_that_a_stopped_report_leaves_nothing_and_can_be_made_again(reports, sections, tmp_path, wait):
    sections(**{N_("The sample"): counts, "Fig. 2": waits})
    dialog = asked(reports)
    dialog.go.click()
    wait(lambda: dialog.section.text() == "Section 2 of 2: Fig. 2")
    dialog.close()
    reports.ask()
    assert reports._dialog is dialog
    dialog.halt.click()
    wait(lambda: dialog.state.text().startswith("Stopped"))
    assert not (tmp_path / "regolith-report").exists()
    assert not dialog.section.isVisible()
    HELD.set()
    dialog.go.click()
    wait(lambda: dialog.state.text().startswith("Done"))
    assert (tmp_path / "regolith-report" / "report.html").is_file()
