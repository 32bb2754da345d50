"""Strokes on the page "Scan": a classifier of voxels, undo and the eraser."""

import numpy as np
import pytest
import tifffile
from PySide6.QtWidgets import QFileDialog

from regolith_studio.imaging.segmentation.strokes import painted_rows
from regolith_studio.jobs.extraction_settings import VolumeInput, read_classifier
from regolith_studio.readers.sandbox.parent import sha256_of
from tests.ui.scan.mouse import paint, press

SECONDS = 120.0


@pytest.fixture
def minerals(tmp_path):
    """A bright ball and a dark one in resin between them in brightness: no threshold finds both."""
    z, y, x = np.mgrid[:32, :32, :56]
    balls = np.zeros(x.shape, dtype=np.int64)
    balls[(x - 16) ** 2 + (y - 16) ** 2 + (z - 16) ** 2 <= 10**2] = 1
    balls[(x - 40) ** 2 + (y - 16) ** 2 + (z - 16) ** 2 <= 10**2] = 2
    values = np.array([100.0, 140.0, 60.0])[balls] + np.random.default_rng(1).normal(0, 8, x.shape)
    np.save(tmp_path / "minerals.npy", np.clip(np.rint(values), 0, 255).astype(np.uint8))
    return tmp_path / "minerals.npy"


def test_that_strokes_train_a_classifier_that_finds_the_grains(page, minerals, wait, tmp_path, monkeypatch):
    page.opening.read(VolumeInput(minerals, 2.0, kind="grey"))
    wait(lambda: page.scan is not None and page.brush.isEnabled(), SECONDS)
    page.slices.go_to((28, 16, 16))
    page.tabs.setCurrentWidget(page.brush)
    page.brush.paint.click()
    page.brush.kind.setCurrentIndex(0)
    (view, *_) = page.slices.views  # along z
    paint(view, [(2, 2), (53, 2), (53, 29), (28, 29), (28, 2)])
    wait(lambda: page.brush.state.text() != "", SECONDS)
    assert page.brush.state.text() == "No grain is painted; paint some voxels of grains, too."
    assert not page.brush.use.isEnabled()
    page.brush.kind.setCurrentIndex(1)
    paint(view, [(10, 16), (16, 10), (22, 16), (16, 22), (16, 16)])
    page.brush.kind.setCurrentIndex(2)
    paint(view, [(34, 16), (40, 10), (46, 16), (40, 22), (40, 16)])
    wait(lambda: page.painting.training is not None and len(page.slices._predicted) == 3, SECONDS)
    wait(lambda: page.slices._predicted[0].grain.shape == (32, 32), SECONDS)
    assert np.bincount(page.painting.training.labels, minlength=3)[:3].min() > 50
    press(page.brush.use)
    assert page.controls.value().segmentation.classifier is page.painting.training
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    assert sorted(page.grains.sizes) == pytest.approx([4169, 4169], rel=0.25)  # of two strokes
    saved = tmp_path / "strokes.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(saved), ""))
    press(page.brush.save)
    wait(saved.is_file, SECONDS)
    assert read_classifier(saved).scan == sha256_of(minerals)


def test_that_undo_takes_strokes_back_and_the_eraser_paint(page, minerals, wait):
    page.opening.read(VolumeInput(minerals, 2.0, kind="grey"))
    wait(lambda: page.scan is not None and page.brush.isEnabled(), SECONDS)
    page.slices.go_to((28, 16, 16))
    page.tabs.setCurrentWidget(page.brush)
    page.brush.paint.click()
    (view, *_) = page.slices.views
    paint(view, [(2, 2), (53, 2)])
    painted = len(painted_rows(page.painting.strokes)[0])
    page.brush.eraser.click()
    paint(view, [(20, 2), (35, 2)])
    left = len(painted_rows(page.painting.strokes)[0])
    assert 0 < left < painted - 40
    page.step("undo")()
    assert len(painted_rows(page.painting.strokes)[0]) == painted
    page.step("undo")()
    assert page.painting.strokes == ()
    assert not page.brush.undo.isEnabled()


def test_that_other_widths_train_the_same_strokes_again_and_wrong_ones_are_explained(page, minerals, wait):
    page.opening.read(VolumeInput(minerals, 2.0, kind="grey"))
    wait(lambda: page.scan is not None and page.brush.isEnabled(), SECONDS)
    page.slices.go_to((28, 16, 16))
    page.tabs.setCurrentWidget(page.brush)
    page.brush.paint.click()
    (view, *_) = page.slices.views
    page.brush.kind.setCurrentIndex(0)
    paint(view, [(2, 2), (53, 2)])
    page.brush.kind.setCurrentIndex(1)
    paint(view, [(10, 16), (22, 16)])
    wait(lambda: page.painting.training is not None, SECONDS)
    before = page.painting.training
    page.brush.sigmas.setValue("1, 3")
    page.brush.sigmas.editingFinished.emit()
    wait(lambda: page.painting.training.settings.features.sigmas == (1.0, 3.0), SECONDS)
    assert page.painting.training.positions.tolist() == before.positions.tolist()
    page.brush.planar.click()
    wait(lambda: page.painting.training.settings.features.planar, SECONDS)
    kept = page.painting.training
    for wrong, words in (("3, 1", "ascend"), ("one", "Widths are numbers of voxels")):
        page.brush.sigmas.setValue(wrong)
        page.brush.sigmas.editingFinished.emit()
        assert words in page.brush.state.text()
    assert page.painting.training is kept
    assert page.brush.features == kept.settings.features


def test_that_labels_of_another_program_become_strokes(page, minerals, wait, tmp_path, monkeypatch):
    """As napari saves its layer of labels; of a wrong size there is one sentence."""
    page.opening.read(VolumeInput(minerals, 2.0, kind="grey"))
    wait(lambda: page.scan is not None and page.brush.isEnabled(), SECONDS)
    painted = np.zeros((32, 32, 56), dtype=np.uint8)  # slices, rows, columns
    painted[16, 2:4, 2:54], painted[16, 10:22, 14:18], painted[16, 10:22, 38:42] = 1, 2, 3
    tifffile.imwrite(tmp_path / "labels.tif", painted)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "labels.tif"), ""))
    page.tabs.setCurrentWidget(page.brush)
    press(page.brush.labels)
    wait(lambda: page.painting.training is not None, SECONDS)
    positions, classes, _ = painted_rows(page.painting.strokes)
    there = np.zeros(painted.shape, dtype=np.uint8)
    there[tuple(positions[:, ::-1].T)] = classes + 1
    assert np.array_equal(there, painted)
    page.painting.undo()
    page.painting.undo()
    assert page.painting.strokes == ()
    tifffile.imwrite(tmp_path / "labels.tif", painted[:30])
    said = []
    monkeypatch.setattr(page._context.toast, "problem", said.append)
    press(page.brush.labels)
    wait(lambda: said, SECONDS)
    assert "has (56, 32, 30) voxels" in said[0]
