"""Opening volumes on the page "Scan": dialogs, regions, raw files, volumes larger than the memory."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PySide6.QtCore import QMimeData, QPoint, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent
from PySide6.QtWidgets import QDialogButtonBox, QWidget

from regolith_studio.imaging import volume_slabs
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.volume import Volume, sample_volume
from regolith_studio.jobs import scan_jobs
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.readers.sandbox.parent import Sandbox, volume_sandbox
from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.session.batch.preprocessing import entry_of
from regolith_studio.ui.pages.scan.volume_dialog import VolumeDialog
from tests.ui.scan.mouse import grains_seen, paint, press

SECONDS = 120.0


def test_that_the_process_that_reads_volumes_starts_with_the_page(request, monkeypatch):
    started = []
    monkeypatch.setattr(Sandbox, "start_in_background", lambda sandbox: started.append(sandbox))
    request.getfixturevalue("page")
    assert started == [volume_sandbox()]


def test_that_a_region_is_read_again_and_a_wrong_one_is_explained(page, part, wait, monkeypatch):
    page.opening.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    crop, edge = (page.controls.region.findChild(QWidget, f"setting_{name}") for name in ("crop", "bin"))
    crop.setText("10:70,:,92:161um")
    crop.editingFinished.emit()
    wait(lambda: page.scan.volume.shape == (60, 80, 30), SECONDS)
    edge.setValue(2)
    wait(lambda: page.scan.volume.shape == (30, 40, 15), SECONDS)
    assert page.scan.volume.origin == (5.25, 0.25, 20.25)
    assert page.scan.volume.voxel_size.tolist() == [4.6, 4.6, 4.6]
    assert page.state()["region"] == {"crop": "10:70,:,92:161um", "bin": 2, "outside": "auto"}
    entries = []
    monkeypatch.setattr(page.making, "_adopt", lambda _made, entry, _answer: entries.append(entry))
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    with monkeypatch.context() as patch:
        patch.setattr(page.opening, "read", lambda _volume: None)  # the other region has not been read yet
        edge.setValue(1)
        page.make_particles()
        wait(lambda: bool(entries), SECONDS)
    assert entries[0].region == {"crop": "10:70,:,92:161um", "bin": 2, "outside": "auto"}
    edge.setValue(2)
    crop.setText("10-70")
    crop.editingFinished.emit()
    assert page.controls.region_error.isVisible()
    assert "X0:X1,Y0:Y1,Z0:Z1" in page.controls.region_error.text()
    assert page.state()["region"]["crop"] == "10:70,:,92:161um"


def test_that_absent_slices_are_named_and_read_as_empty_ones_if_that_is_chosen(page, tmp_path, wait):
    for z in [*range(10), *range(12, 24)]:
        tifffile.imwrite(tmp_path / f"s{z:03d}.tif", np.full((20, 30), 10 + z, dtype=np.uint8))
    page.opening.open(tmp_path)
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    dialog = page.findChild(VolumeDialog)
    open_it = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open)
    assert not open_it.isEnabled()
    assert "numbers 10 to 11" in dialog.allow_gaps.text()
    dialog.allow_gaps.setChecked(True)
    assert open_it.isEnabled()
    dialog.accept()
    wait(lambda: page.scan is not None, SECONDS)
    assert page.scan.volume.shape == (30, 20, 24)
    assert page.scan.volume.array[0, 0, 9:13].tolist() == [19, 0, 0, 22]
    assert entry_of(page.opening.given, GrainSettings()).allow_gaps


def test_that_a_box_drawn_in_a_slice_is_the_region_and_another_one_in_it_a_smaller_one(page, part, wait):
    page.opening.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    along_z, along_y, _ = page.slices.views
    press(page.controls.draw_box)
    paint(along_z, [(20, 60), (40, 30), (69, 19)])
    wait(lambda: page.scan.volume.shape == (50, 42, 70), SECONDS)
    assert page.state()["region"]["crop"] == "20:70,19:61,:"
    assert not page.controls.draw_box.isChecked()
    wait(lambda: page.preview.found is not None, SECONDS)
    press(page.controls.draw_box)
    paint(along_y, [(10, 5), (29, 34)])
    wait(lambda: page.scan.volume.shape == (20, 42, 30), SECONDS)
    assert page.state()["region"]["crop"] == "30:50,19:61,5:35"
    wait(lambda: page.preview.found is not None, SECONDS)


@pytest.mark.slow
def test_that_a_level_of_an_ome_zarr_is_chosen_before_it_is_read(page, tmp_path, wait):
    write = (
        "import sys, pathlib, tests.readers.test_ome_zarr as t; t.ome_zarr(pathlib.Path(sys.argv[1]), '0.5')"
    )
    root = Path(__file__).parents[2]  # a process of its own, since zarr leaves threads behind
    subprocess.run([sys.executable, "-c", write, str(tmp_path / "scan.zarr")], cwd=root, check=True)
    page.opening.open(tmp_path / "scan.zarr")
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


def test_that_a_file_that_is_no_volume_costs_one_sentence(page, tmp_path, wait):
    (tmp_path / "broken.tif").write_bytes(b"II*\0nothing")
    page.opening.open(tmp_path / "broken.tif")
    wait(lambda: page.context.toast.isVisible(), SECONDS)
    assert page.scan is None


def test_that_a_raw_file_is_asked_for_its_layout(page, tmp_path, wait):
    array = np.ascontiguousarray(sample_volume("grey").array[:60, :50, :40].T)
    (tmp_path / "scan.raw").write_bytes(array.tobytes())
    page.opening.open(tmp_path / "scan.raw")
    dialog = page.findChild(VolumeDialog)
    for field, edge in zip(dialog.shape, (60, 50, 40), strict=True):
        field.setValue(edge)
    dialog.kind.setCurrentIndex(1)
    dialog.accept()
    wait(lambda: page.scan is not None, SECONDS)
    assert np.array_equal(page.scan.volume.array, array.T)
    wait(lambda: page.preview.found is not None, SECONDS)


def test_that_raw_voxels_with_the_header_of_a_scanner_beside_them_are_read_without_a_question(
    page, tmp_path, wait
):
    array = np.ascontiguousarray(sample_volume("grey").array[:60, :50, :40].T, np.dtype("<f4"))
    (tmp_path / "scan.vol").write_bytes(array.tobytes())
    (tmp_path / "scan.vol.info").write_text(
        "NUM_X = 60\nNUM_Y = 50\nNUM_Z = 40\nvoxelSize = 2.5\nBYTEORDER = LOWBYTEFIRST\n"
    )
    page.opening.open(tmp_path / "scan.vol")
    wait(lambda: page.scan is not None or page.findChild(VolumeDialog), SECONDS)
    assert page.findChild(VolumeDialog) is None
    assert np.array_equal(page.scan.volume.array, array.T)
    assert page.scan.volume.voxel_size == pytest.approx([2.5] * 3)
    wait(lambda: page.preview.found is not None, SECONDS)


def test_that_the_file_dialog_shows_every_format_of_volumes(page, monkeypatch):
    asked = []
    monkeypatch.setattr(
        "regolith_studio.ui.pages.scan.files.QFileDialog.getOpenFileName",
        lambda *given: asked.append(given[-1]) or ("", ""),
    )
    page.opening.ask_for_file()
    assert all(f"*{suffix}" in asked[0] for suffix in (".tif", ".txm", ".vgi", ".am", ".nii.gz", ".raw"))


def test_that_the_name_of_a_raw_file_fills_the_form_in_and_its_size_is_checked(page, tmp_path):
    path = tmp_path / "scan_30x20x10_uint16_be.raw"
    path.write_bytes(bytes(30 * 20 * 10 * 2 + 64))
    page.opening.open(path)
    dialog = page.findChild(VolumeDialog)
    opens = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open)
    assert dialog.value().raw == RawLayout((30, 20, 10), "uint16", "big", 64)
    assert "agrees with its size" in dialog.facts.text()
    assert "all of the file" in dialog.assessment.text()
    dialog.shape[2].setValue(9)
    assert "1,200 bytes more" in dialog.assessment.text()
    assert opens.isEnabled()
    dialog.shape[2].setValue(11)
    assert "1,200 bytes too short" in dialog.assessment.text()
    assert not opens.isEnabled()
    dialog.reject()


def test_that_a_raw_file_that_is_gone_costs_one_sentence(page, tmp_path, wait):
    page.opening.open(tmp_path / "gone.raw")
    wait(lambda: page.context.toast.isVisible(), SECONDS)
    assert page.findChild(VolumeDialog) is None


def test_that_a_large_volume_is_seen_coarsely_with_its_size_before_it_has_been_read(
    page, part, wait, monkeypatch
):
    page.opening.read(VolumeInput(part, 1.0, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    seen = []

    def look():
        shown = page.slices.views[0]._volume  # along z
        words = page.workflow.volume.text() + page.workflow.found.text()
        seen.append((page.scan, words, shown.shape[:2], shown.voxel_size * shown.shape))
        assert page.slices.grains.frame.detail.text() == "207 × 184 × 161 µm"
        assert page.slices.histogram.numbers()[1]
        assert not page.workflow.search.isEnabled()
        assert not page.brush.isEnabled()

    monkeypatch.setattr(scan_jobs, "LOOK_BYTES", 1000)
    page.opening.looked.connect(look)
    page.opening.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.scan is not None and page.scan.volume.voxel_size[0] == 2.3, SECONDS)
    ((scan, words, shape, extent),) = seen
    assert scan is None
    assert "90 × 80 × 70 voxels of 2.3 µm" in words
    assert "coarse" in words
    assert shape == (90, 80)
    assert extent == pytest.approx([207.0, 184.0, 161.0])
    assert "coarse" not in page.workflow.found.text()
    wait(lambda: page.preview.found is not None, SECONDS)
    assert page.brush.isEnabled()


@pytest.mark.parametrize("suffix", ["npy", "tif"])
@pytest.mark.slow
def test_that_a_large_volume_stays_on_the_disk_and_gives_the_same_grains(
    suffix, page, tmp_path, monkeypatch, wait
):
    monkeypatch.setattr(scan_jobs, "IN_MEMORY", 100_000)
    monkeypatch.setattr(scan_jobs, "scratch_folder", lambda: tmp_path)
    monkeypatch.setattr(volume_slabs, "COARSE_BYTES", 100_000)
    array = sample_volume("grey").array[:90, :80, :70]
    if suffix == "npy":
        np.save(tmp_path / "big.npy", np.ascontiguousarray(array.T))
    else:
        tifffile.imwrite(tmp_path / "big.tif", array.T, compression="zlib")
    page.opening.read(VolumeInput(tmp_path / f"big.{suffix}", 2.3, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    assert isinstance(page.scan.volume.array.base, np.memmap)
    assert bool(list(tmp_path.glob("regolith-*/*"))) == (suffix == "tif")
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
    page.opening.open_sample()
    wait(lambda: page.scan.volume.name.startswith("sample"), SECONDS)
    assert not list(tmp_path.glob("regolith-*"))


def test_that_the_voxel_size_of_one_volume_is_offered_for_the_next(page, part, wait):
    page.opening.open(part)
    wait(lambda: page.findChild(VolumeDialog) is not None, SECONDS)
    dialog = page.findChild(VolumeDialog)
    assert (dialog.edges[0].value(), dialog.unit.currentData()) == (1.0, "um")
    dialog.edges[0].setValue(0.4)
    dialog.unit.setCurrentIndex(dialog.unit.findData("mm"))
    dialog.accept()
    wait(lambda: page.preview.found is not None, SECONDS)
    assert page.scan.volume.voxel_size.tolist() == [400.0, 400.0, 400.0]
    page.opening.open(part)
    wait(lambda: any(each.isVisible() for each in page.findChildren(VolumeDialog)), SECONDS)
    dialog = next(each for each in page.findChildren(VolumeDialog) if each.isVisible())
    assert (dialog.edges[2].value(), dialog.unit.currentData()) == (0.4, "mm")
    dialog.reject()


def test_that_the_second_sample_scan_is_in_the_menu_and_recipes_know_it_by_name(page, wait):
    page.commands()["gradient_volume"]()
    wait(lambda: page.preview.found is not None or page.scan is not None, SECONDS)
    assert page.scan.volume.shape == (128, 128, 128)
    assert page.scan.volume.kind == "grey"
    assert entry_of(page.opening.given, GrainSettings()).file == "sample:gradient"


@pytest.mark.parametrize(("count", "taken"), [(1, True), (2, False)])
def test_that_several_dropped_files_are_left_to_the_window(page, tmp_path, count, taken):
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(tmp_path / f"{number}.tif")) for number in range(count)])
    copy, left, none = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    event = QDragEnterEvent(QPoint(5, 5), copy, data, left, none)
    page.dragEnterEvent(event)
    assert event.isAccepted() is taken


@pytest.mark.slow
def test_that_the_preview_comes_back_when_the_search_for_all_grains_is_stopped(page, part, wait):
    page.opening.read(VolumeInput(part, 2.3, kind="grey"))
    wait(lambda: page.scan is not None, SECONDS)
    page.find_grains()
    (task,) = (each for each in page.context.session.tasks if each.queue == "scan:grains")
    page.context.session.cancel(task.id)
    wait(lambda: page.workflow.found.text().startswith("In the frame"), SECONDS)
    assert page.grains is None
