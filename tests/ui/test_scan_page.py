"""The page "Scan" as a new user goes through it: open, look, move the threshold, find, make particles."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox, QFileDialog, QVBoxLayout, QWidget

from regolith_studio.imaging import slice_images
from regolith_studio.imaging.sample_volumes import sample_volume
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.segmentation.strokes import painted_rows
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs import volume_jobs
from regolith_studio.jobs.extraction_settings import (
    GrainSettings,
    VolumeInput,
    read_classifier,
    read_grain_settings,
    read_objects,
)
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.readers.file_bytes import sha256_of
from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.readers.volumes.read import read_volume
from regolith_studio.session.session import Session
from regolith_studio.ui.app import MainThreadInvoker
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan import PAGE
from regolith_studio.ui.pages.scan.volume_dialog import VolumeDialog
from regolith_studio.ui.theme import current_theme
from regolith_studio.ui.widgets.toast import Toast

SECONDS = 120.0


@pytest.fixture
def page(shown, preferences, wait, monkeypatch):
    """The page alone, with a session of its own that keeps what it is handed and does no more with it."""
    poster = MainThreadInvoker()
    session = Session(ThreadRunner(poster.post))
    adopted = []
    monkeypatch.setattr(session, "adopt", lambda particles, **_origin: adopted.extend(particles))
    frame = shown(QWidget())
    toast = Toast(frame)
    bindings = Bindings(session, toast.problem, frame)
    visited = []
    context = PageContext(
        "scan", session, bindings, preferences, toast, Commands(session, preferences, toast, frame), "image",
        visited.append,
    )  # fmt: skip
    session.events.failed.connect(lambda failure: toast.problem(failure.sentence))
    made = PAGE.build(context)
    made.context, made.visited, made.adopted = context, visited, adopted
    QVBoxLayout(frame).addWidget(made)
    frame.resize(1200, 750)
    made.set_theme(current_theme())
    yield made
    wait(lambda: not session.tasks, SECONDS)
    made.on_close()
    bindings.disconnect_all()
    session.close()
    poster.deleteLater()


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


@pytest.mark.slow
def test_that_a_new_user_gets_from_the_sample_scan_to_particles(page, wait):
    assert not page.workflow.search.isEnabled()
    assert not page.workflow.convert.isEnabled()
    press(page.workflow.sample)
    wait(lambda: page.preview is not None, SECONDS)
    assert "144 × 144 × 144 voxels of 2.3 µm" in page.workflow.volume.text()
    assert "grains from" in page.workflow.found.text()
    assert page.preview.n_grains > 15
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
    page.open(part)
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    dialog = page.findChild(VolumeDialog)
    dialog.edges[0].setValue(1.5)
    assert [field.value() for field in dialog.edges] == [1.5, 1.5, 1.5]
    press(dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open))
    wait(lambda: page.preview is not None, SECONDS)
    assert page.scan.volume.voxel_size.tolist() == [1.5, 1.5, 1.5]
    before = np.count_nonzero(page.preview.labels.array)
    line = page.slices.histogram.line
    line.setValue(130.0)
    line.sigDragged.emit(line)
    assert page.controls.value().segmentation.threshold.method == "manual"
    assert page.controls.level.value() == 130.0
    wait(lambda: np.count_nonzero(page.preview.labels.array) < 0.95 * before, SECONDS)
    assert page.preview.level == 130.0
    page.controls.threshold.setCurrentIndex(0)
    wait(lambda: page.preview.level < 110.0, SECONDS)


def test_that_h_and_the_frame_change_the_preview_and_settings_undo_what_was_found(
    page, part, wait, monkeypatch
):
    page.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
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
    wait(lambda: page.preview is not None and page.preview.n_grains == page.preview.n_bodies, SECONDS)


def test_that_a_click_and_the_wheel_go_through_the_slices(page, part, wait):
    page.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
    assert page.slices.position == (45, 40, 35)
    top = page.slices.views[0]
    centre = QPoint(top.canvas.width() // 4, top.canvas.height() // 4)
    QTest.mouseClick(top.canvas.viewport(), Qt.MouseButton.LeftButton, pos=centre)
    wait(lambda: page.slices.position != (45, 40, 35))
    assert page.slices.position[2] == 35
    top.turn(3)
    assert page.slices.position[2] == 38
    assert "z = 39 of 70" in top.title.text()


def test_that_a_region_is_read_again_and_a_wrong_one_is_explained(page, part, wait, monkeypatch):
    page.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
    crop, edge = (page.controls.region.findChild(QWidget, f"setting_{name}") for name in ("crop", "bin"))
    crop.setText("10:70,:,92:161um")
    crop.editingFinished.emit()
    wait(lambda: page.scan.volume.shape == (60, 80, 30), SECONDS)
    edge.setValue(2)
    wait(lambda: page.scan.volume.shape == (30, 40, 15), SECONDS)
    assert page.scan.volume.origin == (5.25, 0.25, 20.25)
    assert page.scan.volume.voxel_size.tolist() == [4.6, 4.6, 4.6]
    assert page.state()["region"] == {"crop": "10:70,:,92:161um", "bin": 2}
    entries = []
    monkeypatch.setattr(page, "_adopt", lambda _made, entry: entries.append(entry))
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    with monkeypatch.context() as patch:
        patch.setattr(page, "read", lambda _volume: None)  # the other region has not been read yet
        edge.setValue(1)
        page.make_particles()
        wait(lambda: bool(entries), SECONDS)
    assert entries[0].region == {"crop": "10:70,:,92:161um", "bin": 2}
    edge.setValue(2)
    crop.setText("10-70")
    crop.editingFinished.emit()
    assert page.controls.region_error.isVisible()
    assert "X0:X1,Y0:Y1,Z0:Z1" in page.controls.region_error.text()
    assert page.state()["region"]["crop"] == "10:70,:,92:161um"
    wait(lambda: page.preview is not None, SECONDS)


def test_that_a_box_drawn_in_a_slice_is_the_region_and_another_one_in_it_a_smaller_one(page, part, wait):
    page.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
    along_z, along_y, _ = page.slices.views
    press(page.controls.draw_box)
    paint(along_z, [(20, 60), (40, 30), (69, 19)])
    wait(lambda: page.scan.volume.shape == (50, 42, 70), SECONDS)
    assert page.state()["region"]["crop"] == "20:70,19:61,:"
    assert not page.controls.draw_box.isChecked()
    wait(lambda: page.preview is not None, SECONDS)
    press(page.controls.draw_box)
    paint(along_y, [(10, 5), (29, 34)])
    wait(lambda: page.scan.volume.shape == (20, 42, 30), SECONDS)
    assert page.state()["region"]["crop"] == "30:50,19:61,5:35"
    wait(lambda: page.preview is not None, SECONDS)


def test_that_a_level_of_an_ome_zarr_is_chosen_before_it_is_read(page, tmp_path, wait):
    write = (
        "import sys, pathlib, tests.readers.test_ome_zarr as t; t.ome_zarr(pathlib.Path(sys.argv[1]), '0.5')"
    )
    root = Path(__file__).parents[2]  # a process of its own, since zarr leaves threads behind
    subprocess.run([sys.executable, "-c", write, str(tmp_path / "scan.zarr")], cwd=root, check=True)
    page.open(tmp_path / "scan.zarr")
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    dialog = page.findChild(VolumeDialog)
    assert [field.value() for field in dialog.edges] == [1.5, 2.0, 5.0]
    assert [dialog.dataset.itemData(row) for row in range(dialog.dataset.count())] == ["s0", "s1"]
    dialog.dataset.setCurrentIndex(1)
    assert [field.value() for field in dialog.edges] == [3.0, 4.0, 10.0]
    dialog.accept()
    wait(lambda: page.scan is not None, SECONDS)
    assert page.scan.volume.shape == (6, 5, 5)
    assert page.scan.volume.voxel_size.tolist() == [3.0, 4.0, 10.0]


def test_that_labels_go_straight_to_particles(page, tmp_path, wait):
    np.save(tmp_path / "labels.npy", np.ascontiguousarray(sample_volume("labels").array[:80, :80, :80].T))
    page.open(tmp_path / "labels.npy")
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    page.findChild(VolumeDialog).accept()
    wait(lambda: page.scan is not None, SECONDS)
    assert "labels" in page.workflow.volume.text()
    assert not page.workflow.search.isEnabled()
    assert not page.controls.denoise.isEnabled()
    press(page.workflow.convert)
    wait(lambda: page.workflow.show_them.isVisible(), SECONDS)
    assert {particle.group for particle in page.adopted} == {"labels"}


def test_that_a_file_that_is_no_volume_costs_one_sentence(page, tmp_path, wait):
    (tmp_path / "broken.tif").write_bytes(b"II*\0nothing")
    page.open(tmp_path / "broken.tif")
    wait(lambda: page.context.toast.isVisible(), SECONDS)
    assert page.scan is None


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
    page.ask_for_settings()
    assert page.controls.value() == kept
    page.restore({"extraction": "of another version"})
    assert page.controls.value() == kept


def test_that_a_raw_file_is_asked_for_its_layout(page, tmp_path, wait):
    array = np.ascontiguousarray(sample_volume("grey").array[:60, :50, :40].T)
    (tmp_path / "scan.raw").write_bytes(array.tobytes())
    page.open(tmp_path / "scan.raw")
    dialog = page.findChild(VolumeDialog)
    for field, edge in zip(dialog.shape, (60, 50, 40), strict=True):
        field.setValue(edge)
    dialog.kind.setCurrentIndex(1)
    dialog.accept()
    wait(lambda: page.scan is not None, SECONDS)
    assert np.array_equal(page.scan.volume.array, array.T)
    wait(lambda: page.preview is not None, SECONDS)


def test_that_raw_voxels_with_the_header_of_a_scanner_beside_them_are_read_without_a_question(
    page, tmp_path, wait
):
    array = np.ascontiguousarray(sample_volume("grey").array[:60, :50, :40].T, np.dtype("<f4"))
    (tmp_path / "scan.vol").write_bytes(array.tobytes())
    (tmp_path / "scan.vol.info").write_text(
        "NUM_X = 60\nNUM_Y = 50\nNUM_Z = 40\nvoxelSize = 2.5\nBYTEORDER = LOWBYTEFIRST\n"
    )
    page.open(tmp_path / "scan.vol")
    wait(lambda: page.scan is not None or page.findChild(VolumeDialog), SECONDS)
    assert page.findChild(VolumeDialog) is None
    assert np.array_equal(page.scan.volume.array, array.T)
    assert page.scan.volume.voxel_size == pytest.approx([2.5] * 3)
    wait(lambda: page.preview is not None, SECONDS)


def test_that_the_file_dialog_shows_every_format_of_volumes(page, monkeypatch):
    asked = []
    monkeypatch.setattr(
        "regolith_studio.ui.pages.scan.page.QFileDialog.getOpenFileName",
        lambda *given: asked.append(given[-1]) or ("", ""),
    )
    page.ask_for_file()
    assert all(f"*{suffix}" in asked[0] for suffix in (".tif", ".txm", ".vgi", ".am", ".nii.gz", ".raw"))


def test_that_the_name_of_a_raw_file_fills_the_form_in_and_its_size_is_checked(page, tmp_path):
    path = tmp_path / "scan_30x20x10_uint16_be.raw"
    path.write_bytes(bytes(30 * 20 * 10 * 2 + 64))
    page.open(path)
    dialog = page.findChild(VolumeDialog)
    opens = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open)
    assert dialog.value().raw == RawLayout((30, 20, 10), "uint16", "big", 64)
    assert "its size agrees" in dialog.facts.text()
    assert "all of the file" in dialog.verdict.text()
    dialog.shape[2].setValue(9)
    assert "1,200 bytes more" in dialog.verdict.text()
    assert opens.isEnabled()
    dialog.shape[2].setValue(11)
    assert "1,200 bytes too short" in dialog.verdict.text()
    assert not opens.isEnabled()
    dialog.reject()


def test_that_a_raw_file_that_is_gone_costs_one_sentence(page, tmp_path, wait):
    page.open(tmp_path / "gone.raw")
    wait(lambda: page.context.toast.isVisible(), SECONDS)
    assert page.findChild(VolumeDialog) is None


@pytest.mark.parametrize("suffix", ["npy", "tif"])
@pytest.mark.slow
def test_that_a_large_volume_stays_on_the_disk_and_gives_the_same_grains(
    suffix, page, tmp_path, monkeypatch, wait
):
    monkeypatch.setattr(volume_jobs, "IN_MEMORY", 100_000)
    monkeypatch.setattr(volume_jobs, "scratch_folder", lambda: tmp_path)
    monkeypatch.setattr(slice_images, "COARSE_BYTES", 100_000)
    array = sample_volume("grey").array[:90, :80, :70]
    if suffix == "npy":
        np.save(tmp_path / "big.npy", np.ascontiguousarray(array.T))
    else:
        tifffile.imwrite(tmp_path / "big.tif", array.T, compression="zlib")
    page.read(VolumeInput(tmp_path / f"big.{suffix}", 2.3, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
    assert isinstance(page.scan.volume.array.base, np.memmap)
    assert bool(list(tmp_path.glob("regolith-*"))) == (suffix == "tif")
    along_x = page.scan.sections.picture(0, 45)
    assert np.array_equal(along_x, array[44, ::2, ::2])
    assert np.array_equal(page.scan.sections.picture(2, 35), array[:, :, 35])
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    expected = segment(Volume(array, (2.3,) * 3, "grey", "big"), page.controls.value().segmentation)
    assert np.array_equal(page.grains.labels.array, expected.labels.array)
    assert grains_seen(page.slices.views[2]) > 0.03
    press(page.workflow.convert)
    wait(lambda: page.workflow.show_them.isVisible(), SECONDS)
    page.controls.split.click()
    page.open_sample()
    wait(lambda: page.scan.volume.name.startswith("sample"), SECONDS)
    assert not list(tmp_path.glob("regolith-*"))


def test_that_a_probability_map_is_thresholded_by_its_share(page, tmp_path, wait):
    truth = sample_volume("labels").array[:60, :60, :60] > 0
    np.save(tmp_path / "likely.npy", np.where(truth, 230, 20).astype(np.uint8).T)
    page.read(VolumeInput(tmp_path / "likely.npy", 1.0, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
    page.controls.threshold.setCurrentIndex(page.controls.threshold.findData("probability"))
    assert page.slices.histogram.line.value() == pytest.approx(127.5)
    page._on_level_dragged(0.8 * 255)
    assert page.controls.value().segmentation.threshold.value == pytest.approx(0.8)
    wait(lambda: page.preview.level == pytest.approx(0.8 * 255), SECONDS)
    sizes = np.bincount(page.preview.labels.array.ravel())[1:]
    assert sizes.sum() == pytest.approx(np.count_nonzero(truth), rel=0.01)


def test_that_dark_grains_are_suspected_where_one_body_fills_the_frame(page, tmp_path, wait):
    np.save(tmp_path / "dark.npy", 255 - np.ascontiguousarray(sample_volume("grey").array[:90, :80, :70].T))
    page.read(VolumeInput(tmp_path / "dark.npy", 2.3, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
    assert "if the grains are dark, tick that below" in page.workflow.found.text()
    page.controls.dark.click()
    wait(lambda: "dark" not in page.workflow.found.text(), SECONDS)
    assert page.preview.n_grains > 10


def test_that_the_voxel_size_of_one_volume_is_offered_for_the_next(page, part, wait):
    page.open(part)
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    dialog = page.findChild(VolumeDialog)
    assert (dialog.edges[0].value(), dialog.unit.currentData()) == (1.0, "um")
    dialog.edges[0].setValue(0.4)
    dialog.unit.setCurrentIndex(dialog.unit.findData("mm"))
    dialog.accept()
    wait(lambda: page.preview is not None, SECONDS)
    assert page.scan.volume.voxel_size.tolist() == [400.0, 400.0, 400.0]
    page.open(part)
    wait(lambda: any(each.isVisible() for each in page.findChildren(VolumeDialog)), SECONDS)
    dialog = next(each for each in page.findChildren(VolumeDialog) if each.isVisible())
    assert (dialog.edges[2].value(), dialog.unit.currentData()) == (0.4, "mm")
    dialog.reject()


def paint(view, corners):
    """Draw a line through voxels of the slice, (across, down), with the mouse."""
    edges = page_edges(view)

    def at(corner):
        scene = view.canvas.view.mapViewToScene(QPointF(*((np.array(corner) + 0.5) * edges)))
        return view.canvas.mapFromScene(scene)

    target = view.canvas.viewport()
    QTest.mousePress(target, Qt.MouseButton.LeftButton, pos=at(corners[0]))
    for corner in corners[1:]:
        QTest.mouseMove(target, at(corner))
    QTest.mouseRelease(target, Qt.MouseButton.LeftButton, pos=at(corners[-1]))


def page_edges(view):
    return view._volume.voxel_size[[view.across, view.down]]


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
    page.read(VolumeInput(minerals, 2.0, kind="grey"))
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


def test_that_ctrl_z_takes_strokes_back_and_the_eraser_paint(page, minerals, wait):
    page.read(VolumeInput(minerals, 2.0, kind="grey"))
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
    QTest.keyClick(view.canvas, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert len(painted_rows(page.painting.strokes)[0]) == painted
    QTest.keyClick(view.canvas, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert page.painting.strokes == ()
    assert not page.brush.undo.isEnabled()


CENTRES = ((16, 16), (16, 48), (48, 16), (48, 48), (80, 16), (80, 48))
KINDS = (0, 1, 2, 1, 0, 2)


@pytest.fixture
def objects(page, tmp_path, wait):
    """A scan of two balls, two pairs of them, and two bright plates, each found as one object."""
    z, y, x = np.mgrid[:32, :64, :96]
    values = np.full(x.shape, 60.0)
    for (cx, cy), kind in zip(CENTRES, KINDS, strict=True):
        dx, across = x - cx, (y - cy) ** 2 + (z - 16) ** 2
        ball, pair = dx**2 + across <= 81, np.minimum((dx - 7) ** 2, (dx + 7) ** 2) + across <= 64
        values[(ball, pair, (np.abs(dx) <= 2) & (across <= 81))[kind]] = 190 if kind == 2 else 140
    np.save(tmp_path / "objects.npy", values.astype(np.uint8))
    page.controls.h_maxima.field.setValue(20.0)
    page.read(VolumeInput(tmp_path / "objects.npy", 2.0, kind="grey"))
    wait(lambda: page.preview is not None, SECONDS)
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 6
    page.slices.go_to((48, 32, 16))
    return tmp_path / "objects.npy"


def click_voxel(view, across, down):
    scene = view.canvas.view.mapViewToScene(QPointF(*((np.array([across, down]) + 0.5) * page_edges(view))))
    target = view.canvas.viewport()
    QTest.mouseClick(target, Qt.MouseButton.LeftButton, pos=view.canvas.mapFromScene(scene))


def undo_by_key(page):
    page.setFocus()
    QTest.keyClick(page, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)


def labels_of_recipe(page, path, tmp_path, monkeypatch):
    """What ``extract`` finds with the settings that the page saves."""
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "r.json"), ""))
    page.save_settings()
    settings = read_grain_settings(tmp_path / "r.json").segmentation
    return segment(read_volume(path, voxel_size=2.0, kind="grey"), settings).labels.array


def test_that_marked_examples_classify_the_objects_which_are_split_and_dropped(
    page, objects, wait, tmp_path, monkeypatch
):
    page.tabs.setCurrentWidget(page.objects)
    page.objects.mark.click()
    (view, *_) = page.slices.views
    for number in (0, 1, 2):
        page.objects.kind.setCurrentIndex(KINDS[number])
        click_voxel(view, *CENTRES[number])
        if number == 0:
            wait(lambda: page.objects.state.text() != "", SECONDS)
            assert "examples of two classes" in page.objects.state.text()
            assert not page.objects.apply.isEnabled()
    wait(lambda: page.objects.counts[2].text() == "Artefacts: 2", SECONDS)
    assert [label.text() for label in page.objects.counts[:2]] == ["Grains: 2", "Several grains: 2"]
    assert page.grains.n_grains == 6
    wait(page.objects.apply.isEnabled, SECONDS)
    page.objects.apply.click()
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 2 + 2 * 2
    found = page.grains.labels.array
    assert np.array_equal(labels_of_recipe(page, objects, tmp_path, monkeypatch), found)
    file = tmp_path / "o.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(file), ""))
    press(page.objects.save)
    wait(file.is_file, SECONDS)
    assert read_objects(file).scan == sha256_of(objects)
    for _ in range(4):
        undo_by_key(page)
    assert page.corrections.state.examples == ()
    wait(lambda: page.grains is not None, SECONDS)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(file), ""))
    press(page.objects.browse)
    wait(lambda: page.grains is not None, SECONDS)
    assert np.array_equal(page.grains.labels.array, found)


def test_that_grains_are_merged_split_and_deleted_with_undo_and_the_recipe_does_the_same(
    page, objects, wait, tmp_path, monkeypatch
):
    page.tabs.setCurrentWidget(page.edits)
    (view, *_) = page.slices.views

    def use(tool, *places):
        page.edits.tools[tool].click()
        for place in places:
            click_voxel(view, *place)
        wait(lambda: page.grains is not None, SECONDS)

    use("seeds", (9, 48), (23, 48))
    assert page.grains.n_grains == 7
    use("delete", CENTRES[2])
    assert page.grains.n_grains == 6
    use("merge", CENTRES[0], CENTRES[4])
    assert page.grains.n_grains == 5
    page.edits.tools["cut"].click()
    paint(view, [(48, 38), (48, 58)])
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 6
    found = page.grains.labels.array
    assert page.edits.list.count() == 4
    assert len(set(found[[9, 23], 48, 16])) == 2
    assert len(set(found[[41, 55], 48, 16])) == 2
    assert found[16, 16, 16] == found[80, 16, 16] > 0
    assert np.array_equal(labels_of_recipe(page, objects, tmp_path, monkeypatch), found)
    for expected in (5, 6, 7, 6):
        undo_by_key(page)
        wait(lambda: page.grains is not None, SECONDS)
        assert page.grains.n_grains == expected
    press(page.edits.redo)
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 7


@pytest.mark.usefixtures("objects")
def test_that_a_line_which_divides_nothing_is_taken_back_with_a_sentence(page, wait):
    page.tabs.setCurrentWidget(page.edits)
    page.edits.tools["cut"].click()
    paint(page.slices.views[0], [(32, 2), (32, 28)])
    wait(lambda: page.context.toast.isVisible(), SECONDS)
    wait(lambda: page.grains is not None, SECONDS)
    assert page.corrections.state.edits == ()
    assert page.grains.n_grains == 6


@pytest.mark.usefixtures("objects")
def test_that_the_grains_stand_beside_the_slices_in_the_same_colours(page, wait):
    wait(lambda: page.slices._surface is not None, SECONDS)
    _, surface = page.slices._surface
    assert set(surface.labels) == {1, 2, 3, 4, 5, 6}
    assert "6 grains" in page.slices.grains.frame.title
    picture = page.slices.grains.frame.view.picture().astype(int)
    coloured = np.ptp(picture, axis=2) > 60
    assert 0.02 < coloured.mean() < 0.9
    page.controls.split.click()  # discards them
    wait(lambda: page.slices._surface is None, SECONDS)
    assert page.slices.grains.frame.title == "Volume"
