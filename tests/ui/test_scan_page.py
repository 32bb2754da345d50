"""The page "Scan" as a new user goes through it: open, look, move the threshold, find, make particles."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox

from regolith_studio.imaging.sample_volumes import sample_volume
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.ui.app import open_window
from regolith_studio.ui.pages.scan.volume_dialog import VolumeDialog

SECONDS = 120.0


@pytest.fixture
def window(shown, preferences, wait):
    made = open_window(views="image", preferences=preferences)
    made.resize(1300, 800)
    shown(made)
    wait(lambda: made.session.particles and not made.session.tasks, SECONDS)
    return made


@pytest.fixture
def page(window):
    return window.go("scan")


@pytest.fixture
def part(tmp_path):
    """A corner of the shipped scan as NPY: no voxel size is in it."""
    np.save(tmp_path / "part.npy", np.ascontiguousarray(sample_volume("grey").array[:90, :80, :70].T))
    return tmp_path / "part.npy"


def press(button):
    assert button.isEnabled()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def grains_seen(view):
    """How much of the picture of a slice is not grey."""
    image = view.canvas.grab().toImage()
    colours = [
        image.pixelColor(x, y) for x in range(0, image.width(), 9) for y in range(0, image.height(), 9)
    ]
    return np.mean([colour.hsvSaturation() > 60 for colour in colours])


def test_that_a_new_user_gets_from_the_sample_scan_to_particles(window, page, wait):
    assert not page.steps.search.isEnabled()
    assert not page.steps.convert.isEnabled()
    press(page.steps.sample)
    wait(lambda: page.preview is not None, SECONDS)
    assert "144 × 144 × 144 voxels of 2.3 µm" in page.steps.volume.text()
    assert "grains from" in page.steps.found.text()
    assert page.preview.n_grains > 15
    assert page.overview.histogram.line.value() == pytest.approx(103.0, abs=2.0)
    assert all(grains_seen(view) > 0.03 for view in page.overview.slices)
    press(page.steps.search)
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 60
    assert "60 grains" in page.steps.found.text()
    press(page.steps.convert)
    wait(lambda: len(window.session.particles) > 40, SECONDS)
    assert window.session.particles[0].particle.group == "synthetic-grey"
    wait(lambda: page.steps.show_them.isVisible(), SECONDS)
    press(page.steps.show_them)
    assert window.go("explore").isVisible()
    for task in window.session.tasks:
        window.session.cancel(task.id)
    wait(lambda: not window.session.tasks, SECONDS)


def test_that_a_dragged_threshold_is_a_manual_one_and_changes_the_preview(window, page, part, wait):
    page.open(part)
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    dialog = page.findChild(VolumeDialog)
    dialog.edges[0].setValue(1.5)
    assert [field.value() for field in dialog.edges] == [1.5, 1.5, 1.5]
    press(dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open))
    wait(lambda: page.preview is not None, SECONDS)
    assert page.scan.volume.voxel_size.tolist() == [1.5, 1.5, 1.5]
    before = np.count_nonzero(page.preview.labels.array)
    line = page.overview.histogram.line
    line.setValue(130.0)
    line.sigDragged.emit(line)
    assert page.controls.value().segmentation.threshold.method == "manual"
    assert page.controls.level.value() == 130.0
    wait(lambda: np.count_nonzero(page.preview.labels.array) < 0.95 * before, SECONDS)
    assert page.preview.level == 130.0
    page.controls.threshold.setCurrentIndex(0)
    wait(lambda: page.preview.level < 110.0, SECONDS)
    wait(lambda: not window.session.tasks, SECONDS)


def test_that_h_and_the_frame_change_the_preview_and_settings_undo_what_was_found(window, page, part, wait):
    page.read(page_input(part))
    wait(lambda: page.preview is not None, SECONDS)
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    expected = segment(page.scan.volume, page.controls.value().segmentation)
    assert page.grains.n_grains == expected.n_grains
    assert np.array_equal(page.grains.labels.array, expected.labels.array)
    assert page.steps.convert.isEnabled()
    page.controls.split.click()
    assert page.grains is None
    assert not page.steps.convert.isEnabled()
    wait(lambda: page.preview is not None and page.preview.n_grains == page.preview.n_bodies, SECONDS)
    wait(lambda: not window.session.tasks, SECONDS)


def page_input(path):
    from regolith_studio.jobs.extracting import VolumeInput

    return VolumeInput(path, 2.3, kind="grey")


def test_that_a_click_and_the_wheel_go_through_the_slices(window, page, part, wait):
    page.read(page_input(part))
    wait(lambda: page.preview is not None, SECONDS)
    assert page.overview.place == (45, 40, 35)
    top = page.overview.slices[0]
    centre = QPoint(top.canvas.width() // 4, top.canvas.height() // 4)
    QTest.mouseClick(top.canvas.viewport(), Qt.MouseButton.LeftButton, pos=centre)
    wait(lambda: page.overview.place != (45, 40, 35))
    assert page.overview.place[2] == 35
    top.turn(3)
    assert page.overview.place[2] == 38
    assert "z = 39 of 70" in top.title.text()
    wait(lambda: not window.session.tasks, SECONDS)


def test_that_labels_go_straight_to_particles(window, page, tmp_path, wait):
    np.save(tmp_path / "labels.npy", np.ascontiguousarray(sample_volume("labels").array[:80, :80, :80].T))
    page.open(tmp_path / "labels.npy")
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    page.findChild(VolumeDialog).accept()
    wait(lambda: page.scan is not None, SECONDS)
    assert "labels" in page.steps.volume.text()
    assert not page.steps.search.isEnabled()
    assert not page.controls.denoise.isEnabled()
    press(page.steps.convert)
    wait(lambda: page.steps.show_them.isVisible(), SECONDS)
    assert window.session.particles[0].particle.group == "labels"
    for task in window.session.tasks:
        window.session.cancel(task.id)
    wait(lambda: not window.session.tasks, SECONDS)


def test_that_a_file_that_is_no_volume_costs_one_sentence(window, page, tmp_path, wait):
    (tmp_path / "broken.tif").write_bytes(b"II*\0nothing")
    page.open(tmp_path / "broken.tif")
    wait(lambda: window.toast.isVisible(), SECONDS)
    assert page.scan is None
    wait(lambda: not window.session.tasks, SECONDS)
