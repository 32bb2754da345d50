"""The page "Scan" as a new user goes through it: look, move the threshold, find, make particles."""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox, QFileDialog

from regolith_studio.imaging.segmentation.label_edits import LabelEdit
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, preview, segment
from regolith_studio.imaging.volume import sample_volume
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput, read_grain_settings
from regolith_studio.readers.volumes.read import read_volume
from regolith_studio.ui.pages.scan.volume_dialog import VolumeDialog
from tests.ui.scan.mouse import grains_seen, press

SECONDS = 120.0


@pytest.mark.slow
def test_that_a_new_user_gets_from_the_sample_scan_to_particles(page, wait):
    assert not page.workflow.search.isEnabled()
    assert not page.workflow.convert.isEnabled()
    press(page.workflow.sample)
    wait(lambda: page.scan is not None, SECONDS)
    assert page.workflow.found.text() == "Searching …"  # not that there are none
    wait(lambda: page.preview.found is not None, SECONDS)
    assert "144 × 144 × 144 voxels of 2.3 µm" in page.workflow.volume.text()
    assert "grains from" in page.workflow.found.text()
    assert page.preview.found.n_grains > 15
    assert page.slices.histogram.line.value() == pytest.approx(103.0, abs=2.0)
    assert all(grains_seen(view) > 0.03 for view in page.slices.views)
    press(page.workflow.search)
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 60
    assert "60 grains" in page.workflow.found.text()
    press(page.workflow.convert)
    wait(lambda: page.workflow.show_them.isVisible(), SECONDS)
    assert len(page.adopted) == 46
    assert {particle.group for particle in page.adopted} == {"synthetic-grey"}
    assert min(particle.weight for particle in page.adopted) > 1.0
    press(page.workflow.show_them)
    assert page.visited == ["sample"]


@pytest.mark.slow
def test_that_a_dragged_threshold_is_a_manual_one_and_changes_the_preview(page, part, wait):
    page.opening.open(part)
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    dialog = page.findChild(VolumeDialog)
    dialog.edges[0].setValue(1.5)
    assert [field.value() for field in dialog.edges] == [1.5, 1.5, 1.5]
    press(dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open))
    wait(lambda: page.preview.found is not None, SECONDS)
    assert page.scan.volume.voxel_size.tolist() == [1.5, 1.5, 1.5]
    before = np.count_nonzero(page.preview.found.labels.array)
    line = page.slices.histogram.line
    line.setValue(130.0)
    line.sigDragged.emit(line)
    assert page.controls.value().segmentation.threshold.method == "manual"
    assert page.controls.level.value() == 130.0
    wait(lambda: np.count_nonzero(page.preview.found.labels.array) < 0.95 * before, SECONDS)
    assert page.preview.found.level == 130.0
    page.controls.threshold.setCurrentIndex(0)
    wait(lambda: page.preview.found.level < 110.0, SECONDS)


@pytest.mark.slow
def test_that_the_preview_says_how_many_grains_other_values_of_h_give(page, part, wait):
    page.controls.h_maxima.field.setValue(8.0)
    page.opening.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.controls.heights.isVisibleTo(page), SECONDS)
    settings = page.controls.value().segmentation
    level = page.scan.level(settings)
    counts = [
        preview(
            page.scan.volume,
            page.slices.box,
            replace(settings, splitting=replace(settings.splitting, h_maxima=h)),
            level,
        ).n_grains
        for h in (4.0, 8.0, 16.0, 32.0)
    ]
    assert counts[0] > counts[3]
    shown = page.controls.heights.text().replace("\N{NO-BREAK SPACE}", " ")
    assert shown == "Grains in the frame by h: 4 → {} · 8 → {} · 16 → {} · 32 → {}".format(*counts)
    page.controls.split.setChecked(False)
    wait(lambda: not page.controls.heights.isVisibleTo(page), SECONDS)


@pytest.mark.slow
def test_that_h_and_the_frame_change_the_preview_and_settings_undo_what_was_found(
    page, part, wait, monkeypatch
):
    page.opening.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    expected = segment(page.scan.volume, page.controls.value().segmentation)
    assert page.grains.n_grains == expected.n_grains
    assert np.array_equal(page.grains.labels.array, expected.labels.array)
    assert page.workflow.convert.isEnabled()
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(part.with_name("grains.h5")), ""))
    press(page.workflow.save)
    wait(lambda: part.with_name("grains.csv").is_file(), SECONDS)
    written = read_volume(part.with_name("grains.h5"), kind="labels")
    assert np.array_equal(written.array, expected.labels.array)
    assert written.voxel_size.tolist() == [2.3, 2.3, 2.3]
    page.controls.least.field.setValue(2000)
    assert page.grains is not None
    few = np.count_nonzero(expected.sizes < 2000)
    assert f"{few} of them have fewer than 2000 voxels" in page.workflow.found.text()
    page.controls.split.click()
    assert page.grains is None
    assert not page.workflow.convert.isEnabled()
    wait(
        lambda: page.preview.found is not None and page.preview.found.n_grains == page.preview.found.n_bodies,
        SECONDS,
    )


def test_that_a_click_and_the_wheel_go_through_the_slices(page, part, wait):
    page.opening.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    assert page.slices.position == (45, 40, 35)
    top = page.slices.views[0]
    centre = QPoint(top.canvas.width() // 4, top.canvas.height() // 4)
    QTest.mouseClick(top.canvas.viewport(), Qt.MouseButton.LeftButton, pos=centre)
    wait(lambda: page.slices.position != (45, 40, 35))
    assert page.slices.position[2] == 35
    top.turn(3)
    assert page.slices.position[2] == 38
    assert top.title.text() == "xy, z = 39 of 70"
    splitter, slider, title = top.parentWidget(), top.slider, top.title
    splitter.setSizes([1, 2000, 2000])
    wait(lambda: title.text() == "z = 39 of 70" and slider.y() >= title.height())
    assert slider.width() > top.width() // 2, "it has a row of its own"
    splitter.setSizes([2000, 1, 1])
    wait(lambda: title.text() == "xy, z = 39 of 70" and slider.x() >= title.width())


def test_that_labels_go_straight_to_particles(page, tmp_path, wait):
    np.save(tmp_path / "labels.npy", np.ascontiguousarray(sample_volume("labels").array[:80, :80, :80].T))
    page.opening.open(tmp_path / "labels.npy")
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    page.findChild(VolumeDialog).accept()
    wait(lambda: page.scan is not None, SECONDS)
    assert "labels" in page.workflow.volume.text()
    assert not page.workflow.search.isEnabled()
    assert not page.controls.denoise.isEnabled()
    press(page.workflow.convert)
    wait(lambda: page.workflow.show_them.isVisible(), SECONDS)
    assert {particle.group for particle in page.adopted} == {"labels"}


def test_that_settings_are_saved_and_come_back(page, tmp_path, monkeypatch):
    page.controls.dark.click()
    page.controls.h_maxima.field.setValue(2.5)
    kept = page.controls.value()
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "s.json"), ""))
    page.save_settings()
    assert read_grain_settings(tmp_path / "s.json") == kept
    page.restore({})
    assert page.controls.value() == GrainSettings()
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "s.json"), ""))
    page.files.open_settings()
    assert page.controls.value() == kept
    page.restore({"extraction": "of another version"})
    assert page.controls.value() == kept


def test_that_a_probability_map_is_thresholded_by_its_share(page, tmp_path, wait):
    truth = sample_volume("labels").array[:60, :60, :60] > 0
    np.save(tmp_path / "likely.npy", np.where(truth, 230, 20).astype(np.uint8).T)
    page.opening.read(VolumeInput(tmp_path / "likely.npy", 1.0, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    page.controls.threshold.setCurrentIndex(page.controls.threshold.findData("probability"))
    assert page.slices.histogram.line.value() == pytest.approx(127.5)
    page._on_level_dragged(0.8 * 255)
    assert page.controls.value().segmentation.threshold.value == pytest.approx(0.8)
    wait(lambda: page.preview.found.level == pytest.approx(0.8 * 255), SECONDS)
    sizes = np.bincount(page.preview.found.labels.array.ravel())[1:]
    assert sizes.sum() == pytest.approx(np.count_nonzero(truth), rel=0.01)


@pytest.mark.slow
def test_that_dark_grains_are_suspected_where_one_body_fills_the_frame(page, tmp_path, wait):
    np.save(tmp_path / "dark.npy", 255 - np.ascontiguousarray(sample_volume("grey").array[:90, :80, :70].T))
    page.opening.read(VolumeInput(tmp_path / "dark.npy", 2.3, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    assert "Tick “Grains are dark” if they are darker" in page.workflow.found.text()
    page.controls.dark.click()
    wait(lambda: "dark" not in page.workflow.found.text(), SECONDS)
    assert page.preview.found.n_grains > 10


def test_that_the_scan_of_a_project_is_opened_again_and_a_changed_one_is_not(page, wait):
    page.opening.open_sample()
    wait(lambda: page.scan is not None)
    state = page.state()
    assert state["scan"]["file"] == "sample:grey"
    page.opening.scan.scratch.close()
    page.opening.scan = None
    page.restore(state)
    wait(lambda: page.scan is not None)
    assert page.opening.restore(state["scan"] | {"fingerprint": "of another"}) is False


def test_that_a_project_keeps_the_corrections_of_a_scan_that_has_moved(page, tmp_path, wait):
    here, there = tmp_path / "scan.npy", tmp_path / "moved.npy"
    np.save(here, np.ascontiguousarray(sample_volume("grey").array[:60, :50, :40].T))
    page.opening.read(VolumeInput(here, 2.0, kind="grey"))
    wait(lambda: page.scan is not None)
    page.corrections.take_from(SegmentationSettings(edits=(LabelEdit("fill", ((4, 5, 6),)),)))
    state = page.state()
    page.opening.close()
    page.opening.scan = None
    here.rename(there)
    page.restore(state)
    assert "moved or changed" in page._context.toast.sentence.text()
    assert page.corrections.state.edits == ()
    assert page.state() == state
    page.opening.read(VolumeInput(there, 2.0, kind="grey"))
    wait(lambda: page.scan is not None)
    assert page.state() == state | {"scan": state["scan"] | {"file": str(there)}}
