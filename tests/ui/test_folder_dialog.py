"""Asking for a folder to write into: a new one can be named, and nothing else gets the files."""

import errno
from pathlib import Path

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMessageBox, QPushButton

from regolith_studio.ui.dialogs.files import FolderDialog, ask_for_files


@pytest.fixture
def answered(app, tmp_path):  # noqa: ARG001  # the dialog needs one
    """What comes of typing a name into the dialog, and what is said against it."""

    def run(typed, by="key", proposed=""):
        said, begun = [], []

        def look():
            dialog = QApplication.activeModalWidget()
            if isinstance(dialog, QMessageBox):
                said.append(dialog.text())
                dialog.accept()
            elif isinstance(dialog, FolderDialog) and not begun:
                line = dialog.findChild(QLineEdit, "fileNameEdit")
                if not proposed:
                    line.setText(typed)
                begun.append(dialog)
                button = next(each for each in dialog.findChildren(QPushButton) if "hoose" in each.text())
                answers = {
                    "key": lambda: QTest.keyClick(line, Qt.Key.Key_Return),
                    "mouse": lambda: QTest.mouseClick(button, Qt.MouseButton.LeftButton),
                }
                QTimer.singleShot(0, line, answers[by])
            elif dialog is not None and said:
                dialog.reject()

        timer = QTimer(interval=20)
        timer.timeout.connect(look)
        timer.start()
        chosen = FolderDialog.ask(None, "Folder of figures", str(tmp_path), proposed)
        timer.stop()
        return chosen, said

    return run


@pytest.mark.parametrize("by", ["key", "mouse"])
@pytest.mark.parametrize("name", ["figures", "two/deep"])
def test_that_a_new_folder_is_made_by_its_name(answered, tmp_path, name, by):
    chosen, said = answered(str(tmp_path / name), by)
    assert (chosen, said) == (str(tmp_path / name), [])
    assert (tmp_path / name).is_dir()


def test_that_a_name_alone_is_a_folder_in_the_one_that_is_shown(answered, tmp_path):
    assert answered("figures") == (str(tmp_path / "figures"), [])
    assert (tmp_path / "figures").is_dir()


@pytest.mark.parametrize("by", ["key", "mouse"])
def test_that_a_proposed_folder_needs_one_key_or_click(answered, tmp_path, by):
    assert answered("", by, "grains-dem") == (str(tmp_path / "grains-dem"), [])
    assert (tmp_path / "grains-dem").is_dir()


def test_that_a_folder_that_is_there_is_taken_as_it_is(answered, tmp_path):
    (tmp_path / "old").mkdir()
    (tmp_path / "old" / "kept.txt").write_text("mine")
    assert answered(str(tmp_path / "old")) == (str(tmp_path / "old"), [])
    assert (tmp_path / "old" / "kept.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("file/below", "cannot be made (a part of its path is no folder)."),
        ("file", "is a file, not a folder."),
        ("x" * 300, "cannot be made (its name is too long)."),
    ],
)
def test_that_a_folder_that_cannot_be_made_is_refused_with_its_reason(answered, tmp_path, name, reason):
    (tmp_path / "file").write_text("not a folder")
    chosen, said = answered(str(tmp_path / name))
    assert chosen == ""
    assert len(said) == 1
    assert str(tmp_path / name) in said[0]
    assert said[0].endswith(reason)
    assert (tmp_path / "file").read_text() == "not a folder"


def test_that_the_reason_of_the_system_is_said(answered, tmp_path, monkeypatch):
    def refuse(folder, **_settings):
        raise OSError(errno.EROFS, "Read-only file system", str(folder))

    monkeypatch.setattr(Path, "mkdir", refuse)
    chosen, said = answered(str(tmp_path / "new"))
    assert chosen == ""
    assert said == [f"The folder {tmp_path / 'new'} cannot be made (the file system is read-only)."]


def test_that_a_click_beside_the_completions_of_a_typed_folder_acts(shown, wait, tmp_path):
    (tmp_path / "figures").mkdir()
    dialog = shown(FolderDialog(None, "Folder of figures", str(tmp_path)))
    line = dialog.findChild(QLineEdit, "fileNameEdit")
    popup = line.completer().popup()

    def offered():
        line.clear()
        QTest.keyClicks(line, "fi")
        return popup.isVisible()

    wait(offered)
    button = next(each for each in dialog.findChildren(QPushButton) if "ancel" in each.text())
    pressed = []
    button.pressed.connect(lambda: pressed.append(popup.isVisible()))
    QTest.mousePress(
        popup, Qt.MouseButton.LeftButton, pos=popup.mapFromGlobal(button.mapToGlobal(button.rect().center()))
    )
    assert pressed == [False]
    assert dialog.result() == 0
    assert not dialog.isVisible()


def test_that_completions_of_no_name_close_in_the_dialog_of_files(app, tmp_path):  # noqa: ARG001
    (tmp_path / "one.stl").write_bytes(b"")
    seen = []

    def look():
        line = QApplication.activeModalWidget().findChild(QLineEdit, "fileNameEdit")
        seen.append((line.text(), line.completer().popup().isVisible()))
        if len(seen) == 10:  # as Qt does when a folder has been entered by its name
            line.completer().complete()
        elif len(seen) == 20:
            line.setText("o")
            line.completer().complete()
        elif len(seen) == 30:
            line.setText("")
        elif len(seen) == 40:
            QApplication.activeModalWidget().reject()

    timer = QTimer(interval=20)
    timer.timeout.connect(look)
    timer.start()
    assert ask_for_files(None, "Open", str(tmp_path), "Meshes (*.stl)") == []
    timer.stop()
    assert seen[19] == ("", False)
    assert seen[29] == ("o", True)
    assert seen[39] == ("", False)
