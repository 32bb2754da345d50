"""Keys of the commands: changed in the dialog, refused where they are taken, there in the next window."""

import pytest
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from regolith_studio.errors import InputError
from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.keyboard import Shortcuts, ShortcutsDialog

pytestmark = pytest.mark.usefixtures("preferences")

KEYS = {"undo": "Ctrl+Z", "quit": "Ctrl+Q", "scan.find": "F5", "model.fit": "F5", "about": ""}
PAGES = ("scan", "model")


@pytest.fixture
def actions(shown):
    parent = shown(QWidget())
    made = {}
    for name, keys in KEYS.items():
        made[name] = QAction(f"&{name.title()} …", parent)
        made[name].setShortcut(QKeySequence(keys))
        made[name].setToolTip(f"Does it ({keys})" if keys else "Does it")
    made["parent"] = parent
    return made


@pytest.fixture
def shortcuts(actions, preferences):
    parent = actions.pop("parent")
    parent.made = Shortcuts(actions, PAGES, preferences)
    return parent.made


def test_that_new_keys_work_and_are_kept(shortcuts, actions):
    shortcuts.change("about", "Ctrl+Alt+A")
    assert actions["about"].shortcut() == QKeySequence("Ctrl+Alt+A")
    assert actions["about"].toolTip() == "Does it (Ctrl+Alt+A)"
    shortcuts.change("undo", "")
    assert actions["undo"].toolTip() == "Does it"
    kept = Preferences.load()
    assert kept.window["shortcuts"] == {"about": "Ctrl+Alt+A", "undo": ""}
    for name, keys in KEYS.items():
        actions[name].setShortcut(QKeySequence(keys))
    Shortcuts(actions, PAGES, kept)
    assert actions["about"].shortcut() == QKeySequence("Ctrl+Alt+A")
    shortcuts.reset()
    assert {name: each.shortcut().toString() for name, each in actions.items()} == KEYS
    assert Preferences.load().window["shortcuts"] == {}


@pytest.mark.parametrize(
    ("name", "keys", "words"),
    [
        ("about", "Ctrl+Z", "already assigned to “Undo”"),
        ("scan.find", "Ctrl+Q", "already assigned to “Quit”"),
        ("about", "F5", "already assigned to “Scan.Find”"),
        ("about", "A", "reserved for typing"),
        ("about", "Tab", "reserved for typing"),
        ("about", "nonsense+", "cannot be assigned"),
    ],
)
def test_that_keys_that_are_taken_are_refused_in_one_sentence(shortcuts, name, keys, words):
    with pytest.raises(InputError, match=words):
        shortcuts.change(name, keys)
    assert shortcuts.keys(name) == KEYS[name]


def test_that_two_pages_may_have_the_same_keys(shortcuts):
    shortcuts.change("scan.find", "F6")
    shortcuts.change("model.fit", "F6")
    assert shortcuts.keys("scan.find") == shortcuts.keys("model.fit") == "F6"


def test_that_kept_keys_that_collide_by_now_are_left_out(actions):
    actions.pop("parent")
    kept = Preferences(window={"shortcuts": {"about": "Ctrl+Z", "gone": "F9", "quit": 3}})
    made = Shortcuts(actions, PAGES, kept)
    assert (made.keys("about"), made.keys("quit")) == ("", "Ctrl+Q")


def test_that_the_dialog_is_no_higher_than_a_small_screen(shortcuts, shown, monkeypatch):
    monkeypatch.setattr("regolith_studio.ui.keyboard.room_on_screen", lambda _: QSize(952, 500))
    assert shown(ShortcutsDialog(shortcuts, {"scan.find": "Scan"})).height() <= 500


def test_that_the_dialog_finds_changes_and_resets_by_keys_alone(shortcuts, shown):
    dialog = shown(ShortcutsDialog(shortcuts, {"scan.find": "Scan"}))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    QTest.keyClicks(dialog.search, "scan")
    assert dialog.table.rows.rowCount() == 1
    dialog.choose("scan.find")
    QTest.keyClick(dialog.editor, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    dialog.change.click()
    assert "already assigned" in dialog.sentence.text()
    QTest.keyClick(dialog.editor, Qt.Key.Key_F7)
    dialog.change.click()
    assert shortcuts.keys("scan.find") == "F7"
    assert dialog.table.rows.item(0, 1).text() == "F7 *"
    dialog.default.click()
    assert shortcuts.keys("scan.find") == "F5"
    dialog.search.clear()
    assert dialog.table.rows.rowCount() == len(KEYS)
