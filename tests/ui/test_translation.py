"""The window in German: nothing English is left where it is translated, and nothing is cut off.

What goes past the translation is found by a language of brackets: whatever stands outside of them on the
screen was never asked to be translated.
"""

import contextlib
import re
import string
from pathlib import Path

import pytest
from PySide6.QtCore import QLocale, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QLabel,
    QListWidget,
    QMenu,
    QMessageBox,
    QScrollArea,
    QTableWidget,
    QTabWidget,
    QWidget,
)

from regolith_studio.coarsening.bounds import greatest_sphericity, sphericity_reason
from regolith_studio.session.choices import Choices
from regolith_studio.ui.app import open_window
from regolith_studio.ui.dialogs.batch import BatchDialog
from regolith_studio.ui.dialogs.closing import may_close
from regolith_studio.ui.dialogs.command_palette import CommandPalette
from regolith_studio.ui.dialogs.export import ExportDialog
from regolith_studio.ui.dialogs.help import about_dialog
from regolith_studio.ui.dialogs.preferences import PreferencesDialog
from regolith_studio.ui.dialogs.shortcuts import ShortcutsDialog
from regolith_studio.ui.dialogs.unit import UnitDialog
from regolith_studio.ui.pages.explore.pictures import PictureDialog
from regolith_studio.ui.tour import start_tour, steps
from regolith_studio.ui.translation import CONTEXT, tr
from regolith_studio.ui.translation.extract import all_messages, messages_of, ts_text, update
from regolith_studio.ui.translation.language import (
    LANGUAGES,
    Translator,
    fall_silent,
    language_of,
    read_words,
    speak,
    translation_file,
)
from regolith_studio.ui.translation.sentences import retold
from regolith_studio.ui.views.view_frame import ViewFrame
from regolith_studio.ui.widgets.plot import Plot
from regolith_studio.ui.widgets.plot_files import plain_text

SECONDS = 120.0
GERMAN = read_words(translation_file("de"))
FORMATTER = string.Formatter()
SAME_EVERYWHERE = re.compile(
    "|".join(
        (
            r"Regolith Studio|Jaccard|English|Deutsch|KiB|CSF|lmax|Dmin|Dmax|Dint|Fmax|Fmin",
            r"PySide6-Essentials|pyqtgraph|pyvista|numba|numpy|vtk",
            r"(agglutinate|angular|bead|flat|elongated|subangular)-\d|req",
            r"Ctrl|Shift|Alt|PgUp|PgDown|Return|Space",
            r"µm[²³⁵]?|/[-\w./]*|(GIF|WebP) \(\*\.\w+\)",
        )
    )
)
"""Names, symbols, keys, libraries, paths."""
OF_OTHERS = re.compile(r"session/|jobs/|ui/pages/(?!explore)")
"""Modules whose newest words may stand there in English for a while."""
NEW_ELSEWHERE = 6
OF_PYQTGRAPH = ("Export...", "Export")
"""In menus that nobody can open."""
WORD = re.compile(r"[^\W\d_]{3,}")


class Brackets(dict):
    """Every message in brackets."""

    def get(self, source, _default=None):
        return f"⟦{source}⟧"


@pytest.fixture
def speaking(app):
    """Lets the window speak a language, or that of brackets, until the test is over."""
    installed = []

    def begin(language):
        if language == "brackets":
            translator = Translator(Brackets(any="thing"))
            app.installTranslator(translator)
            installed.append(translator)
        else:
            installed.extend(speak(app, language))

    yield begin
    fall_silent(app, installed)


@pytest.fixture
def opened(shown, preferences, settled):
    """Opens a window of 1280 x 800 that has drawn everything."""

    def run():
        made = shown(open_window(views="image", preferences=preferences))
        made.resize(1280, 800)
        settled(made, SECONDS)
        return made

    return run


def texts_of(root):
    """Everything that is read on a widget and on all within it, with the name of the widget."""
    for widget in (root, *root.findChildren(QWidget)):
        name = f"{type(widget).__name__} {widget.objectName()}"
        if widget.objectName().startswith("qt_"):
            continue  # Qt's own parts speak by Qt's own translation
        if widget.objectName().startswith("Scroll") or isinstance(widget.parent(), QDialogButtonBox):
            continue
        for kind in ("text", "title", "placeholderText", "label", "prefix", "suffix"):
            read = getattr(widget, kind, None)
            if callable(read) and not (kind == "text" and isinstance(widget, QAbstractSpinBox)):
                yield name, str(read())
        yield name, widget.windowTitle()
        yield name, widget.toolTip()
        yield name, widget.accessibleName()
        match widget:
            case QComboBox():
                yield from ((name, widget.itemText(row)) for row in range(widget.count()))
                tips = (widget.itemData(row, Qt.ItemDataRole.ToolTipRole) for row in range(widget.count()))
                yield from ((name, str(tip)) for tip in tips if tip)
            case QTabWidget():
                yield from ((name, widget.tabText(at)) for at in range(widget.count()))
            case QDialogButtonBox():
                made = [each for each in widget.buttons() if not widget.standardButton(each).value]
                yield from ((name, each.text()) for each in made)
            case QListWidget():
                yield from ((name, widget.item(row).text()) for row in range(widget.count()))
            case QTableWidget():
                yield from ((name, text) for text in _cells(widget))
            case Plot():
                yield from ((name, plain_text(text)) for text in (*widget._labels, widget.legend.text()))
                yield from ((name, each.text()) for each in _plot_menu(widget))
    for action in root.findChildren(QAction):
        if action.text() in OF_PYQTGRAPH:
            continue
        yield "QAction " + action.objectName(), action.text()
        yield "QAction " + action.objectName(), action.toolTip()


def _cells(table):
    heads = [(table.horizontalHeaderItem(at), at) for at in range(table.columnCount())]
    sides = [(table.verticalHeaderItem(at), at) for at in range(table.rowCount())]
    for item, _ in (*heads, *sides):
        if item is not None:
            yield item.text()
            yield item.toolTip()
    for row in range(table.rowCount()):
        item = table.item(row, 0)
        if item is not None and table.objectName() == "shortcuts_table":
            yield item.text()


def _plot_menu(plot):
    menu = plot.menu()
    found = menu.actions()
    yield from found
    menu.deleteLater()


def english_left(root):
    """Texts with words that were never given to the translation."""
    found = []
    for name, text in texts_of(root):
        rest = plain_text(text) if re.search(r"</?[a-z]|&nbsp;", text) else text
        rest = re.sub(r"⟦[^⟦⟧]*…$", " ", rest)
        while "⟦" in rest and (shorter := re.sub(r"⟦[^⟦⟧]*⟧", " ", rest)) != rest:
            rest = shorter
        rest = SAME_EVERYWHERE.sub(" ", rest)
        if WORD.search(rest):
            found.append((name, text))
    return found


def dialogs_of(window):
    """One of each dialog, filled."""
    folder = Path("/tmp")
    yield ExportDialog(7, Choices(), folder, window)
    yield PreferencesDialog({}, window)
    yield ShortcutsDialog(window.shortcuts, window.menus.places(), window)
    yield UnitDialog([folder, folder], "voxel:2", window)
    yield about_dialog(window, "image")
    yield PictureDialog(window)
    yield CommandPalette(window.menus.palette(window.pages.pages, window.pages.run), window)
    yield BatchDialog(7, 7, folder, window)


def test_that_everything_in_the_window_is_translated():
    missing = {text: places for text, places in all_messages().items() if text not in GERMAN}
    ours = [text for text, places in missing.items() if not all(map(OF_OTHERS.match, places))]
    advice = "run the module extract, then translate these in resources/translations/de.ts"
    assert not ours, advice
    assert len(missing) <= NEW_ELSEWHERE, advice


def test_that_the_file_of_translations_is_brought_up_to_date(tmp_path):
    path = tmp_path / "de.ts"
    path.write_text(ts_text("de", GERMAN | {"Gone": "Fort"}).replace("Bereit", ""), encoding="utf-8")
    assert "Ready" in update(path, "de")
    text = path.read_text(encoding="utf-8")
    assert 'type="unfinished"' in text
    assert "Gone" not in text
    words = read_words(path)
    assert "Ready" not in words
    assert words["Next seed"] == "Nächster Startwert"


def test_that_a_translation_fills_in_what_the_source_does():
    def fields(text):
        return sorted((name, form) for _, name, form, _ in FORMATTER.parse(text) if name is not None)

    for source, german in GERMAN.items():
        assert fields(german) == fields(source), source
        assert re.findall(r"</?\w+>", german) == re.findall(r"</?\w+>", source)
        assert german.count("&") == source.count("&"), source
        assert german.endswith("…") == source.endswith("…"), source
        assert german.strip() == german


def test_that_messages_are_found_in_calls_and_in_tables():
    code = """
tr("one", count=3); tr_count("two", "three", 2); words = mark("fo" "ur"); tr(words); tr("="); other("no")
ActionSpec("&Five", "six", "Se&ven", "eight", "Ctrl+N", "Nine", bar="words")
Page(key="ten", title="Eleven", tip="Twelve"); ActionSpec(MENU, BREAK, "")
"""
    found = {"one", "two", "three", "four", "&Five", "Se&ven", "Nine", "Eleven", "Twelve"}
    assert sorted(messages_of(code)) == sorted(found)


def test_that_sentences_of_the_layers_below_are_told_anew(speaking):
    speaking("de")
    reason = sphericity_reason(0.97, 10)
    assert retold(reason) == (
        f"Die Sphärizität 0.970 braucht mindestens {re.findall(r'[0-9]+', reason)[2]} Facetten;"
        f" mit 10 sind höchstens {greatest_sphericity(10):.3f} möglich."
    )
    off = "No polyhedron with 8 faces was found that meets all descriptors: convex hull volume is off by 3 %;"
    german = retold(f"{off} more faces or a weight of 0 would free it.")
    assert "8 Facetten" in german
    assert "Volumen der konvexen Hülle weicht um 3 % ab" in german
    assert retold("A closed mesh without faults.") == "Ein geschlossenes, fehlerfreies Netz."
    assert retold("Nobody has said this.") == "Nobody has said this."


def test_that_a_language_that_nobody_knows_is_english(app, speaking):
    assert set(LANGUAGES) == {"system", "en", "de"}
    assert language_of("tlh") in ("en", "de")
    assert language_of("de") == "de"
    speaking("en")
    assert tr("Ready") == "Ready"
    speaking("de")
    assert tr("Ready") == "Bereit"
    assert tr("of no file: {count}", count=3) == "of no file: 3"
    assert app.translate("elsewhere", "Ready") == "Ready"
    assert app.translate(CONTEXT, "Ready") == "Bereit"


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
    assert may_close(window, [tr("{name} has changes that are not saved.", name="a")]) is False
    assert asked == [[]]


def test_that_the_dialogs_of_qt_and_the_keys_speak_german(opened, speaking):
    speaking("de")
    window = opened()
    assert QKeySequence("Ctrl+S").toString(QKeySequence.SequenceFormat.NativeText) == "Strg+S"
    assert window.menus.by_name["open"].toolTip() == "Netzdateien öffnen (Strg+O)"
    window.shortcuts.change("open", "Ctrl+Shift+Y")
    assert window.menus.by_name["open"].toolTip() == "Netzdateien öffnen (Strg+Umschalt+Y)"
    assert window.shortcuts.keys("open") == "Ctrl+Shift+Y"
    buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
    assert buttons.buttons()[0].text() == "Abbrechen"
    buttons.deleteLater()
    assert window.page.fit.l_max.field.text() == "10"
    assert QLocale().decimalPoint() == "."
    assert window.page.loss.sliders["volume"].field.text() == "1.00"


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


def cut_off(root):
    """Visible texts that have less room than they need."""
    found = []
    for widget in root.findChildren(QWidget):
        if not widget.isVisible() or widget.visibleRegion().isEmpty():
            continue
        name, wanted = f"{type(widget).__name__} {widget.objectName()}", None
        match widget:
            case QLabel() if widget.text() and not isinstance(widget.parent(), ViewFrame):
                wanted, text = widget.sizeHint().width(), widget.text()
                if widget.wordWrap():
                    longest = max(plain_text(text).split() or [""], key=len)
                    wanted = widget.fontMetrics().horizontalAdvance(longest)
                    if widget.heightForWidth(widget.width()) > widget.height() + 1:
                        found.append((name, text, "too low"))
            case QAbstractButton() if widget.text():
                text = widget.text()
                letters = widget.fontMetrics().horizontalAdvance(text.replace("&", "")) + 12
                wanted = min(widget.minimumSizeHint().width(), letters + widget.iconSize().width())
                if widget.icon().isNull():
                    wanted = min(wanted, letters)
            case _:
                continue
        if wanted > widget.width() + 1:
            found.append((name, text, wanted, widget.width()))
    return found


@pytest.fixture
def assert_fits(wait):
    """Once layouts have come to rest, nothing is cut."""

    def check(root):
        with contextlib.suppress(AssertionError):
            wait(lambda: root.isVisible() and not cut_off(root), 5.0)
        assert cut_off(root) == [], root

    return check


@pytest.mark.parametrize("language", ["en", "de"])
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


def test_that_preferences_hold_at_once_or_at_the_next_start(opened, wait):
    window = opened()
    app, before = QApplication.instance(), QApplication.font().pointSizeF()
    window.menus.by_name["preferences"].trigger()
    dialog = window.findChild(PreferencesDialog)
    assert dialog.value() == {"language": "system", "theme": "system", "letters": 100}
    assert not dialog.note.isVisible()
    dialog.language.setCurrentIndex(dialog.language.findData("de"))
    dialog.language.activated.emit(dialog.language.currentIndex())
    dialog.theme.setCurrentIndex(dialog.theme.findData("dark"))
    dialog.theme.activated.emit(dialog.theme.currentIndex())
    dialog.letters.setValue(150)
    assert dialog.note.isVisible()
    assert app.font().pointSizeF() == pytest.approx(1.5 * before)
    kept = window.preferences.load().window
    assert (kept["language"], kept["theme"], kept["letters"]) == ("de", "dark", 150)
    dialog.letters.setValue(100)
    dialog.close()
    assert app.font().pointSizeF() == pytest.approx(before)
    window.looks.choose(theme="system")
    wait(lambda: window.findChild(QDialog, "preferences_dialog") is None)


def test_that_preferences_that_make_no_sense_are_the_usual_ones(shown):
    dialog = shown(PreferencesDialog({"language": "tlh", "theme": 4, "letters": "huge"}))
    assert dialog.value() == {"language": "system", "theme": "system", "letters": 100}
