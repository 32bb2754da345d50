"""Runs of the page "Angle of repose": started, stopped, listed, compared, exported."""

import json

import numpy as np
import pytest

from regolith_studio.dataset.parameters import ContactParameters
from regolith_studio.dem.engine_process import EngineError
from regolith_studio.dem.run_io import FINAL, FORMAT, read_run, save_result
from regolith_studio.dem.snapshot import Snapshot, particle_state_bytes
from regolith_studio.errors import JobCancelled
from regolith_studio.jobs.events import Partial
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.result_card import ResultState
from tests.ui.repose.conftest import import_positions, pile_of, small, watch_moments

STOPPED = {
    "format": FORMAT,
    "state": "stopped",
    "engine": {"label": "MuJoCo"},
    "case": {
        "shapes": "spheres",
        "test": {},
        "n_particles": 700,
        "seed": 0,
        "contact": {"static_friction": 0.8},
    },
}


@pytest.fixture
def saved_run(tmp_path):
    """The folder of a run that was stopped when its heap lay."""
    run = tmp_path / "run"
    run.mkdir()
    save_result(run, STOPPED, pile_of(30.0), 1.0)
    np.savez(run / "shapes.npz", **{"shape_00000.part_00": np.eye(3)})
    return run


def test_that_a_test_is_run_listed_and_replayed(page, dataset, wait, monkeypatch, tmp_path):
    small(page, dataset)
    import_positions(page, monkeypatch, tmp_path, pile_of(30.0))
    wait(lambda: page._measured is not None)
    drawn = watch_moments(page, monkeypatch)
    page.run_test()
    wait(lambda: page.runs.table.rows.rowCount() == 1)
    running = [scene for title, *scene in drawn if title == "Running"]
    assert running
    assert all(
        scene == [False, 8] for scene in running
    )  # the boxes of the dataset, not the spheres of the file
    run = page.runs.current()
    assert run.document["state"] == "finished"
    assert run.document["case"]["n_particles"] == 40
    assert "No angle" in page.angle.sentence.text()
    assert page.player.slider.maximum() >= 4
    last = page.player.pile.points.copy()
    page.player.slider.setValue(0)
    assert page.player.pile.phase == "fill"
    page.player.toggle()
    wait(lambda: page.player.slider.value() >= 2)
    page.player.pause()
    page.player.slider.setValue(page.player.slider.maximum())
    np.testing.assert_array_equal(page.player.pile.points, last)
    assert not page.busy()


def test_that_a_stopped_run_marks_the_earlier_angle_and_changed_values_leave_none(
    page, dataset, wait, monkeypatch, tmp_path
):
    small(page, dataset)
    import_positions(page, monkeypatch, tmp_path, pile_of(30.0))
    wait(lambda: page._measured is not None)
    before = page.angle.figures[0].text()
    assert "°" in before

    def stopped(*_):
        yield Partial(Snapshot(pile_of(20.0, 40), 0.5, "lift"))
        raise JobCancelled("stopped")

    monkeypatch.setattr("regolith_studio.ui.pages.repose.page.repose_steps", stopped)
    page.run_test()
    wait(lambda: not page.busy())
    words = page.angle.sentence.text()
    assert words.startswith("Stopped: earlier result, ")
    assert "The run was stopped before it was measured." in words
    assert page.angle.figures[0].text() == before
    assert not page.angle.figures[0].isEnabled()
    assert page.sections.plot.is_empty()
    assert "Stopped" in page.player.frame.title
    assert page.angle.button.isEnabled()
    page.setup.particles.setValue(60)
    wait(lambda: len(page.player.pile) == 60)
    assert "°" not in page.angle.figures[0].text()
    assert "Not run yet" in page.angle.sentence.text()


def test_that_a_failed_run_leaves_the_earlier_angle_marked_as_such(
    page, dataset, wait, monkeypatch, tmp_path
):
    small(page, dataset)
    import_positions(page, monkeypatch, tmp_path, pile_of(30.0))
    wait(lambda: page._measured is not None)
    before = page.angle.figures[0].text()

    def dies(*_):
        yield Partial(Snapshot(pile_of(20.0, 40), 0.5, "lift"))
        raise EngineError("The engine was ended by signal 9.")

    monkeypatch.setattr("regolith_studio.ui.pages.repose.page.repose_steps", dies)
    for _ in range(2):
        page.run_test()
        assert "°" not in page.angle.figures[0].text() or not page.run.running
        wait(lambda: not page.busy())
        assert page.angle.figures[0].text() == before
        assert not page.angle.figures[0].isEnabled()
        words = page.angle.sentence.text()
        assert "Failed: earlier result, " in words
        assert words.count("earlier result") == 1
        assert "signal 9" in words


@pytest.mark.slow
def test_that_a_drum_runs_beside_a_measured_angle_and_its_filling_is_used_again(page, dataset, wait):
    setup = page.setup
    setup.set_dataset(dataset)
    setup.set_evaluation(min_particles=150)
    setup.particles.setValue(150)
    setup.apparatus.setCurrentIndex(1)
    setup.drum.setValue({"rpm": 40.0, "turns": 0.2, "moments": 40})
    page.run_test()
    wait(lambda: page.runs.table.rows.rowCount() == 1 and not page.busy())
    angle = page.runs.current().angle
    assert page.angle.figures[0].text() == f"{angle:.1f}°"
    assert page.angle.captions[0].text() == "Dynamic angle"
    assert "Froude number" in page.angle.sentence.text()
    assert page.sections.course.curves[1].y == (angle, angle)
    setup.measured.setValue(30.0)
    assert f"Less the measured 30.0°: {angle - 30.0:+.1f}°" in page.angle.sentence.text()
    setup.drum.setValue({"rpm": 20.0, "turns": 0.2, "moments": 40})
    setup.valueChanged.emit()
    again = f"The filled cylinder of {page.runs.current().folder.name} is used again."
    wait(lambda: again in setup.scaling_report.text())
    setup.contact.setValue(ContactParameters(static_friction=0.4))
    setup.valueChanged.emit()
    wait(lambda: page._prepared is not None)
    assert again not in setup.scaling_report.text()
    setup.filling.setCurrentIndex(2)
    wait(lambda: "filled with a friction of 0.8, not 0.4" in setup.scaling_report.text())


def test_that_the_shown_run_is_exported_for_other_programs(page, tmp_path, monkeypatch, wait, saved_run):
    out = tmp_path / "out"
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(out))
    page.export_heap()
    assert "no run to export" in page._context.toast.sentence.text()
    page._show_run(read_run(saved_run))
    page.export_heap()
    wait((out / "export.json").is_file)
    wait(lambda: str(out) in page._context.toast.sentence.text())
    assert {"particles.pvd", "heap.glb", "README.txt"} <= {path.name for path in out.iterdir()}


def test_that_the_final_state_of_another_run_is_refused(page, saved_run):
    page._show_run(read_run(saved_run))
    assert len(page.player.pile) == 700
    (saved_run / FINAL).write_bytes(particle_state_bytes(pile_of(20.0)))
    page._show_run(read_run(saved_run))
    assert "not the final state of the run" in page.player.clock.text()
    assert "not the final state of the run" in page._context.toast.sentence.text()


@pytest.mark.slow
def test_that_runs_are_compared(page, dataset, wait):
    small(page, dataset)
    page.run_test()
    wait(lambda: page.runs.table.rows.rowCount() == 1)
    run = read_run(page.runs.current().folder)
    for value, angle in ((0.2, 18.0), (0.8, 26.0)):
        document = json.loads(json.dumps(run.document))
        document["case"]["contact"]["static_friction"] = value
        document["measurement"] = {
            "status": "pile",
            "angle_deg": angle,
            "interval_deg": [angle - 1, angle + 1],
        }
        folder = run.folder.with_name(f"friction-{value}")
        folder.mkdir()
        (folder / "repose.json").write_text(json.dumps(document))
    page.set_runs_folder(run.folder.parent)
    curve, bars = page.runs.plot.curves
    assert (curve.x, curve.y) == ((0.2, 0.8), (18.0, 26.0))
    assert (bars.y[:2], bars.y[3:5]) == ((17.0, 19.0), (25.0, 27.0))


def test_that_a_run_that_is_shown_again_offers_longer_ones_and_stays(page, dataset, wait, saved_run):
    page.setup.set_dataset(dataset)
    wait(lambda: page._prepared is not None)
    page._show_run(read_run(saved_run))
    kept = json.loads(json.dumps(page.state()))
    page._show_nothing("")
    page._prepared = None
    page.restore(kept)
    wait(lambda: page._prepared is not None and page._measured is not None)
    assert not page.limits.buttons[1].isHidden()
    assert page._shown_run == saved_run


def test_that_a_project_shows_its_run_again_or_says_that_it_is_gone(page, tmp_path, wait, saved_run):
    page._show_run(read_run(saved_run))
    wait(lambda: page._measured is not None)
    kept = json.loads(json.dumps(page.state()))
    figures = [each.text() for each in page.angle.figures]
    page._show_nothing("")
    page.restore(kept)
    wait(lambda: page._measured is not None)
    assert [each.text() for each in page.angle.figures] == figures
    saved_run.rename(tmp_path / "moved")
    page.restore(kept)
    assert page.angle.record.state is ResultState.FAILED
    assert str(saved_run) in page.angle.sentence.text()
