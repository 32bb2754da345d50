"""The window in German: nothing English is left where it is translated, and nothing is cut off.

What goes past the translation is found by a language of brackets: whatever stands outside of them on the
screen was never asked to be translated.
"""

import contextlib
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QLocale
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QDialogButtonBox, QMenu, QMessageBox, QScrollArea

from regolith_studio.readers.volumes.header import DatasetEntry, VolumeHeader
from regolith_studio.session.choices import Choices
from regolith_studio.ui.actions import CommandPalette
from regolith_studio.ui.appearance import PreferencesDialog
from regolith_studio.ui.dialogs.batch import BatchDialog, ReportDialog
from regolith_studio.ui.dialogs.files import UnitDialog
from regolith_studio.ui.dialogs.help import about_dialog, start_tour, steps
from regolith_studio.ui.keyboard import ShortcutsDialog
from regolith_studio.ui.pages.explore.page import PictureDialog
from regolith_studio.ui.pages.scan.volume_dialog import VolumeDialog
from regolith_studio.ui.project_files import may_close
from regolith_studio.ui.startup import open_window
from regolith_studio.ui.theme import choose_font_size
from regolith_studio.ui.translation import tr
from tests.ui.reading import cut_off, english_left, points_left

SECONDS = 120.0
PAGES = ("sample", "model", "scan", "studies", "dataset", "repose", "lecture")
"""Pages besides Explore whose insides are translated."""
READ = ("sample", "model", "studies", "lecture")
"""Those that are read word by word; the others name many programs, units and files."""


@pytest.fixture
def opened(shown, preferences, settled):
    """Opens a window of 1280 x 800 that has drawn everything."""

    def run():
        made = shown(open_window(views="image", preferences=preferences))
        made.resize(1280, 800)
        settled(made, SECONDS)
        return made

    return run


def dialogs_of(window):
    """One of each dialog, filled."""
    folder = Path("/tmp")
    yield PreferencesDialog({}, window)
    yield ShortcutsDialog(window.shortcuts, window.menus.places(), window)
    yield UnitDialog([folder, folder], "voxel:2", window)
    yield about_dialog(window, "image")
    yield PictureDialog(window)
    yield CommandPalette(window.menus.palette(window.pages.pages, window.pages.run), window)
    yield BatchDialog(7, 7, folder, window)
    yield ReportDialog(7, Choices(), folder, window)


@pytest.mark.slow
def test_that_nothing_on_the_translated_part_of_the_window_goes_past_the_translation(
    opened, speaking, preferences, monkeypatch
):
    speaking("brackets")
    window = opened()
    window.menus.by_name["explore.section"].trigger()
    window.menus.by_name["explore.overlay"].trigger()
    assert english_left(window) == []
    for step in range(len(steps())):
        tour = start_tour(window, lambda _key: None, preferences)
        tour.go(step)
        assert english_left(tour._bubble) == []
        tour.finish()
    for dialog in dialogs_of(window):
        assert english_left(dialog) == [], type(dialog).__name__
        dialog.deleteLater()
    asked = []
    monkeypatch.setattr(QMessageBox, "exec", lambda box: asked.append(english_left(box)))
    assert may_close(window, [], [tr("{name} has changes that are not saved.", name="a")], bool) is False
    assert asked == [[]]


@pytest.mark.parametrize("key", [READ[0], *(pytest.param(each, marks=pytest.mark.slow) for each in READ[1:])])
def test_that_no_words_on_a_page_go_past_the_translation(key, opened, speaking, settled):
    speaking("brackets")
    window = opened()
    page = window.go(key)
    settled(window, SECONDS)
    assert english_left(page) == []


@pytest.fixture
def scanned(opened, wait):
    """Opens the page Scan with the sample scan and the preview of its grains."""

    def run():
        page = opened().go("scan")
        page.opening.open_sample()
        wait(lambda: page.preview.found is not None, SECONDS)
        return page

    return run


@pytest.mark.slow
def test_that_no_words_on_the_way_from_a_scan_to_particles_go_past_the_translation(
    scanned, speaking, wait, tmp_path
):
    speaking("brackets")
    page = scanned()
    assert english_left(page) == []
    box = page.slices.histogram.canvas.getViewBox()
    assert "⟦" in page.slices.histogram.value_at(box.mapViewToScene(box.viewRect().center()))
    page.find_grains()
    wait(lambda: page.grains is not None, SECONDS)
    page.make_particles()
    wait(lambda: page.workflow.show_them.isVisible(), SECONDS)
    assert english_left(page) == []
    (tmp_path / "a.h5").write_bytes(bytes(64))
    said = VolumeHeader(
        tmp_path / "a.h5", "hdf5", (4, 4, 4), np.dtype(np.uint8), None, None, "labels",
        (DatasetEntry("a", (4, 4, 4), "u1"), DatasetEntry("b", (4, 4, 4), "u1")), "a", 64,
        ("The file holds 2 volumes; a was read.",),
    )  # fmt: skip
    for header in (None, said):
        dialog = VolumeDialog(tmp_path / "a.h5", header)
        assert english_left(dialog) == []
        dialog.deleteLater()


def test_that_the_dialogs_of_qt_and_the_keys_speak_german(opened, speaking):
    speaking("de")
    window = opened()
    assert QKeySequence("Ctrl+S").toString(QKeySequence.SequenceFormat.NativeText) == "Strg+S"
    assert window.menus.by_name["open"].toolTip() == "Dateien jeder Art öffnen (Strg+O)"
    window.shortcuts.change("open", "Ctrl+Shift+Y")
    assert window.menus.by_name["open"].toolTip() == "Dateien jeder Art öffnen (Strg+Umschalt+Y)"
    assert window.shortcuts.keys("open") == "Ctrl+Shift+Y"
    buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
    assert buttons.buttons()[0].text() == "Abbrechen"
    buttons.deleteLater()
    assert window.page.fit.l_max.field.text() == "10"
    assert QLocale().decimalPoint() == ","
    assert window.page.loss.sliders["volume"].field.text() == "1,00"
    assert points_left(window) == []


@pytest.mark.slow
def test_that_the_scale_of_the_distances_has_a_decimal_comma(opened, speaking, monkeypatch):
    speaking("de")
    views = opened().page.three_views
    monkeypatch.setattr(
        views._distances, "between", lambda fit, _particle: np.linspace(-0.8, 0.8, len(fit.vertices))
    )
    views.set_heat(True)
    bars = views.views["fit"]._plotter.scalar_bars
    table = next(iter(bars.values())).GetLookupTable()
    texts = [table.GetAnnotation(at) for at in range(3)]
    assert texts == ["-0,8 µm", "0 µm", "0,8 µm"]


@pytest.mark.slow
@pytest.mark.parametrize("language", ["en", "de"])
def test_that_the_controls_of_a_dataset_do_not_scroll_on_a_large_screen(opened, speaking, language, wait):
    speaking(language)
    window = opened()
    window.resize(1912, 1040)
    page = window.go("dataset")
    page.targets.coarse_graining.setValue(1.0)
    wait(lambda: not page.targets.enlarge.isHidden())  # the foot is as high as it gets
    column = page.findChild(QScrollArea, "controls")
    wait(lambda: column.height() > 700 and column.verticalScrollBar().maximum() == 0, 10.0)


def test_that_no_two_commands_of_a_german_menu_have_the_same_letter(opened, speaking):
    speaking("de")
    window = opened()
    for page in window.pages.pages:
        window.menus.show_page(page)
        for menu in window.menuBar().findChildren(QMenu):
            letters = [
                text[text.index("&") + 1].lower()
                for action in menu.actions()
                if action.isVisible() and "&" in (text := action.text())
            ]
            assert len(letters) == len(set(letters)), (page, menu.title(), letters)


@pytest.fixture
def assert_fits(wait):
    """Once layouts have come to rest, nothing is cut."""

    def check(root):
        with contextlib.suppress(AssertionError):
            wait(lambda: root.isVisible() and not cut_off(root), 5.0)
        assert cut_off(root) == [], root

    return check


@pytest.mark.slow
@pytest.mark.parametrize("language", ["en", "de"])
def test_that_no_dialog_cuts_a_label_in_a_larger_font(opened, speaking, language, assert_fits):
    speaking(language)
    choose_font_size(150)
    try:
        for dialog in dialogs_of(opened()):
            dialog.show()
            assert_fits(dialog)
            dialog.close()
            dialog.deleteLater()
    finally:
        choose_font_size(None)


@pytest.mark.parametrize("language", [pytest.param("en", marks=pytest.mark.slow), "de"])
def test_that_no_label_is_cut_in_a_small_window(opened, speaking, language, assert_fits):
    speaking(language)
    window = opened()
    assert window.size().width() == 1280
    bar = window.menus.bar
    assert_fits(window.pages)
    assert all(bar.widgetForAction(each).isVisible() for each in bar.actions() if each.isVisible())
    for area in window.page.findChildren(QScrollArea):
        assert area.widget().width() <= area.viewport().width(), area.objectName()
    for dialog in dialogs_of(window):
        dialog.show()
        assert_fits(dialog)
        dialog.close()
        dialog.deleteLater()
    tour = start_tour(window, lambda _key: None, window.preferences)
    for step in range(len(steps())):
        tour.go(step)
        assert_fits(tour._bubble)
        assert window.rect().contains(tour._bubble.geometry())
    tour.finish()


@pytest.mark.parametrize("key", PAGES)
@pytest.mark.slow
def test_that_nothing_is_cut_on_a_page_in_a_small_german_window(key, opened, speaking, assert_fits):
    speaking("de")
    window = opened()
    assert_fits(window.go(key))
    assert points_left(window.go(key)) == []
