"""Studies and calibrations of the page "Angle of repose"."""

import json
import time

import numpy as np
import pytest

from regolith_studio.jobs.events import Progress
from regolith_studio.studies.calibration import CalibrationParameter
from regolith_studio.studies.repose import runs_from
from regolith_studio.studies.repose_calibration import CalibrationRun, ReposeCalibration, angle_target
from regolith_studio.ui.result_card import ResultRecord, ResultState
from tests.ui.repose.conftest import small


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_that_a_study_grows_is_stopped_and_goes_on(page, dataset, wait, workers):
    small(page, dataset)
    panel = page.study
    panel.workers.setMaximum(2)  # also on a machine of one core
    panel.setValue({"key": "static_friction", "values": "0.2, 0.8", "repeats": 1, "workers": workers})
    page.studies.start()
    wait(lambda: panel.table.rows.rowCount() == 2)
    wait(lambda: panel.card.record.state is ResultState.CURRENT)
    assert [panel.table.rows.item(row, 0).text() for row in (0, 1)] == ["0.2", "0.8"]
    folder = page._folder / "studies" / f"static_friction-{dataset.name}"
    assert (folder / "repose_study.csv").exists()
    assert not page.busy()
    before = {path: path.stat().st_mtime_ns for path in folder.glob("*/repose.json")}
    assert len(before) == 2
    page.studies.start()
    wait(lambda: panel.card.record.state is ResultState.CURRENT)
    assert {path: path.stat().st_mtime_ns for path in before} == before
    panel.table.selectRow(1)
    wait(lambda: page.player.slider.maximum() >= 4)
    assert "No angle" in page.angle.sentence.text()
    assert page.state()["study"]["values"] == "0.2, 0.8"
    assert page.state()["study"]["workers"] == workers


def test_that_a_study_of_names_and_piles_is_drawn(page):
    document = {"state": "finished", "case": {"seed": 0}, "problem": None}
    runs = [
        ("cohesion", name, name, document | {"measurement": {"angle_deg": angle, "interval_deg": [20, 30]}})
        for name, angle in (("none", 22.0), ("scaled", 30.0))
    ]
    page.study.show_study(runs_from(runs))
    mean, dots, bars = page.study.plot.curves
    assert bars.y[:2] == (20, 30)
    assert (dots.x, dots.y) == ((1.0, 2.0), (22.0, 30.0))
    assert mean.y == dots.y
    assert not mean.line


def test_that_a_study_says_what_it_lacks(page, dataset):
    page.studies.start()
    assert "no dataset yet" in page._context.toast.sentence.text()
    page.study.key.setCurrentIndex(page.study.key.findData("n_facets"))
    assert page.study.values.text() == "8, 20, 60"
    page.studies.start()
    assert "open particles" in page._context.toast.sentence.text()
    small(page, dataset)
    page.study.setValue({"key": "gravity", "values": "moon", "repeats": 2})
    page.studies.start()
    assert "numbers with commas" in page._context.toast.sentence.text()


def test_that_a_calibration_shows_runs_density_and_the_next_run(page):
    """Heaps on the line 10 + 20 x; the wanted angle is that of a friction of 0.6."""
    calibration = ReposeCalibration.begin(
        [CalibrationParameter("static_friction", 0.05, 1.2)], [angle_target(22.0, 0.5)]
    )
    page.calibration.show_calibration(calibration)
    assert page.calibration.prediction.curves == ()
    for number, friction in enumerate((0.2, 0.6, 1.0, 0.5), 1):
        measured = {"status": "pile", "angle_deg": 10 + 20 * friction, "interval_deg": None}
        document = {"state": "finished", "measurement": measured}
        calibration = calibration.with_run(CalibrationRun(f"run_{number:02d}", (friction,), document))
    record = page.calibration.show_calibration(calibration)
    *_, wanted, runs = page.calibration.prediction.curves
    assert set(wanted.y) == {22.0}
    assert (runs.x, runs.y) == ((0.2, 0.6, 1.0, 0.5), (14.0, 22.0, 30.0, 20.0))
    last, half = page.calibration.posterior.curves
    assert (last.label, half.label) == ("runs: 4", "runs: 2")
    assert last.x[int(np.argmax(last.y))] == pytest.approx(0.6, abs=0.1)
    assert float(record.values[0]) == pytest.approx(0.6, abs=0.1)
    assert record.made_from.startswith("4 runs; next run at")
    assert record.made_from.endswith("22.0° ± 0.5° wanted")


def test_that_a_calibration_without_a_usable_run_shows_no_value(page):
    """Without a result the posterior is the prior, whose middle is no measurement of the friction."""
    calibration = ReposeCalibration.begin(
        [CalibrationParameter("static_friction", 0.3, 0.9)], [angle_target(30.0, 1.0)]
    )
    for friction in (0.6, 0.4):
        document = {"state": "finished", "measurement": {"status": "no flanks"}}
        calibration = calibration.with_run(CalibrationRun("run", (friction,), document))
    record = page.calibration.show_calibration(calibration)
    text = record.sentences()
    assert "2 of 2 runs formed a heap without a measurable angle" in text
    assert record.values == ()
    assert page.calibration.posterior.curves == ()


def test_that_usable_runs_are_shown_also_where_they_give_no_value(page):
    calibration = ReposeCalibration.begin(
        [CalibrationParameter("static_friction", 0.3, 0.9)], [angle_target(30.0, 1.0)]
    )
    measured = {"status": "pile", "angle_deg": 30.0, "interval_deg": [5.0, 55.0]}
    measured["settings"] = {"confidence": 0.95}
    document = {"state": "finished", "measurement": measured}
    calibration = calibration.with_run(CalibrationRun("run", (0.6,), document))
    assert not calibration.is_informed(0)
    record = page.calibration.show_calibration(calibration)
    wanted, runs = page.calibration.prediction.curves
    assert (set(wanted.y), runs.x, runs.y) == ({30.0}, (0.6,), (30.0,))
    assert page.calibration.posterior.curves == ()
    assert record.values == ()


def test_that_the_form_of_a_series_scrolls_before_its_fields_are_cut(page, app):
    for place, panel in ((3, page.study), (4, page.calibration)):
        page.tabs.setCurrentIndex(place)
        page.resize(900, 420)
        app.processEvents()
        for field in panel._fields.values():
            assert field.height() >= field.minimumSizeHint().height()


@pytest.mark.parametrize(
    ("name", "job"), [("study", "run_repose_study"), ("calibration", "calibration_steps")]
)
@pytest.mark.usefixtures("threads")
def test_that_its_button_stops_a_study_and_frees_the_form(page, dataset, wait, monkeypatch, name, job):
    def endless(*_):
        while True:
            time.sleep(0.01)
            yield Progress(1, 2)

    monkeypatch.setattr(f"regolith_studio.ui.pages.repose.calibration.{job}", endless)
    small(page, dataset)
    panel = getattr(page, name)
    page.commands()[f"start_{name}"]()
    assert page.busy()
    wait(lambda: panel.card.sentence.text().startswith("Running, 1 of 2"), 5.0)
    panel.card.button.click()
    wait(lambda: not page.busy(), 5.0)
    assert panel.card.button.text() == "Resume"
    assert panel.card.sentence.text().startswith("Stopped")


@pytest.mark.slow
def test_that_a_calibration_runs_and_goes_on_in_its_folder(page, dataset, wait):
    small(page, dataset)
    page.calibration.setValue({"angle": 25.0, "runs": 2})
    page.calibrations.start()
    wait(lambda: "2 runs;" in page.calibration.card.sentence.text() and not page.busy())
    (folder,) = (page._folder / "studies").iterdir()
    before = (folder / "run_01" / "repose.json").stat().st_mtime_ns
    page.calibration.setValue(page.state()["calibration"] | {"angle": 27.0})
    page.calibrations.start()
    wait(lambda: "2 runs;" in page.calibration.card.sentence.text() and not page.busy())
    assert (folder / "run_01" / "repose.json").stat().st_mtime_ns == before
    assert json.loads((folder / "calibration.json").read_text())["targets"][0]["value"] == 27.0
    kept = json.loads(json.dumps(page.state()))
    kept["calibration"]["runs"] = 3
    page.calibration.show_calibration(None)
    page.calibration.card.show_record(ResultRecord())
    page.restore(kept)
    wait(lambda: "2 of 3 runs;" in page.calibration.card.sentence.text())
    assert page.calibration.card.button.text() == "Resume"
    assert page.calibration.has_runs


def test_that_a_calibration_says_what_it_lacks(page, dataset):
    page.calibrations.start()
    assert "no dataset yet" in page._context.toast.sentence.text()
    small(page, dataset)
    for words, sentence in (
        ("0.2", "lowest and highest value"),
        ("1, 0.2", "from a lower to a higher value"),
    ):
        page.calibration.setValue({"key": "static_friction", "range": words})
        page.calibrations.start()
        assert sentence in page._context.toast.sentence.text()


@pytest.mark.slow
@pytest.mark.usefixtures("threads")
def test_that_runs_without_an_angle_end_a_calibration_without_a_value(page, dataset, wait, monkeypatch):
    def no_angle(dataset, place, request):  # noqa: ARG001
        yield Progress(1, 1)
        measured = {"status": "no flanks"}
        return {"state": "finished", "case": {"seed": request.case.seed}, "measurement": measured}

    monkeypatch.setattr("regolith_studio.jobs.repose_calibration.simulate_study_run", no_angle)
    small(page, dataset)
    page.calibration.setValue({"runs": 3})
    page.commands()["start_calibration"]()
    wait(lambda: not page.busy(), 20.0)
    card = page.calibration.card
    assert "3 of 3 runs formed a heap without a measurable angle." in card.sentence.text()
    assert "No run can be used, so that there is no value" in card.sentence.text()
    assert [figure.text() for figure in card.figures] == ["–", "–"]
    assert page.calibration.prediction.curves == page.calibration.posterior.curves == ()
