"""Objects on the page "Scan": examples, corrections by hand with undo, and the grains in 3-D."""

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QFileDialog

from regolith_studio.imaging.label_table import voxel_inside
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.volume import box_between
from regolith_studio.jobs.extraction_settings import VolumeInput, read_grain_settings, read_objects
from regolith_studio.readers.sandbox.parent import sha256_of
from regolith_studio.readers.volumes.read import read_volume
from tests.ui.scan.mouse import click_voxel, paint, press

SECONDS = 120.0


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
    page.opening.read(VolumeInput(tmp_path / "objects.npy", 2.0, kind="grey"))
    wait(lambda: page.preview.found is not None, SECONDS)
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 6
    page.slices.go_to((48, 32, 16))
    return tmp_path / "objects.npy"


def undo(page):
    page.step("undo")()


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
        undo(page)
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
    edges = page.scan.volume.voxel_size
    view.hover(QPointF(*((np.array(CENTRES[2]) + 0.5) * edges[:2])))
    assert "grain " in page.slices.readout.text()
    use("delete", CENTRES[2])
    assert page.grains.n_grains == 6
    assert "x = 49, y = 17" in page.slices.readout.text()
    assert "grain " not in page.slices.readout.text(), "the mouse has not moved, the grain is gone"
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
        undo(page)
        wait(lambda: page.grains is not None, SECONDS)
        assert page.grains.n_grains == expected
    press(page.edits.redo)
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.n_grains == 7


def test_that_grains_are_painted_erased_and_filled_and_the_recipe_does_the_same(
    page, objects, wait, tmp_path, monkeypatch
):
    page.tabs.setCurrentWidget(page.edits)
    (view, *_) = page.slices.views
    before = page.grains.labels.array.copy()
    page.edits.diameter.setValue(6)

    def draw(tool, *corners):
        page.edits.tools[tool].click()
        paint(view, corners)
        wait(lambda: page.grains is not None, SECONDS)
        return page.grains.labels.array

    bridge = draw("paint", CENTRES[0], (16, 30), (16, 32))
    assert bridge[16, 32, 16] == bridge[16, 32, 18] == before[16, 16, 16]
    assert bridge[16, 32, 20] == 0  # a ball of six voxels reaches three beyond the slice
    new = draw("paint", (32, 32), (33, 32))
    assert new[32, 32, 16] > before.max()
    assert page.grains.n_grains == 7
    hole = draw("erase", (16, 16), (17, 16))
    assert hole[16, 16, 16] == 0
    page.edits.tools["fill"].click()
    click_voxel(view, 10, 16)
    wait(lambda: page.grains is not None, SECONDS)
    found = page.grains.labels.array
    assert found[16, 16, 16] == before[16, 16, 16]
    assert page.edits.list.count() == 4
    assert np.array_equal(labels_of_recipe(page, objects, tmp_path, monkeypatch), found)
    undo(page)
    wait(lambda: page.grains is not None, SECONDS)
    assert page.grains.labels.array[16, 16, 16] == 0


@pytest.mark.usefixtures("objects")
def test_that_the_grain_being_mended_stands_out_in_three_dimensions(page, wait):
    def coloured():
        picture = page.slices.grains.frame.view.picture().astype(int)
        return (np.ptp(picture, axis=2) > 60).mean()

    wait(lambda: page.slices._surface is not None, SECONDS)
    every = coloured()
    page.tabs.setCurrentWidget(page.edits)
    page.edits.tools["seeds"].click()
    (view, *_) = page.slices.views
    click_voxel(view, 9, 48)
    assert page.slices._highlighted == {int(page.grains.labels.array[9, 48, 16])}
    assert 0 < coloured() < 0.6 * every
    click_voxel(view, 23, 48)
    wait(lambda: page.grains is not None and len(page.slices._highlighted) == 2, SECONDS)
    wait(lambda: page.slices._surface[0] is page.grains.labels, SECONDS)
    assert 0 < coloured() < 0.6 * every
    undo(page)
    wait(lambda: page.grains is not None, SECONDS)
    wait(lambda: page.slices._surface[0] is page.grains.labels, SECONDS)
    assert page.slices._highlighted == set()
    assert coloured() == pytest.approx(every, rel=0.02)


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
    _, surface, sizes = page.slices._surface
    assert set(surface.labels) == set(sizes) == {1, 2, 3, 4, 5, 6}
    assert sum(sizes.values()) == np.count_nonzero(page.grains.labels.array > 0)
    assert "6 grains" in page.slices.grains.frame.title
    assert page.workflow.card.record.values[0] == "6"
    assert page.workflow.card.button.text() == "Find again"
    label = int(page.grains.labels.array.max())
    x, y, z = voxel_inside(page.grains.labels.array, label, box_between((0, 0, 0), page.grains.labels.shape))
    page.slices.go_to((x, y, z))
    size = page.scan.volume.voxel_size
    page.slices.views[0].hover(QPointF((x + 0.5) * size[0], (y + 0.5) * size[1]))
    told = page.slices.readout.text()
    assert told.startswith(f"x = {x + 1}, y = {y + 1}, z = {z + 1}")
    assert f"grain {label}: {sizes[label]:,} voxels" in told
    picture = page.slices.grains.frame.view.picture().astype(int)
    coloured = np.ptp(picture, axis=2) > 60
    assert 0.02 < coloured.mean() < 0.9
    page.controls.split.click()  # discards them
    wait(lambda: page.slices._surface is None, SECONDS)
    assert page.slices.grains.frame.title == "Volume"
