"""Every command of menus, tool bar and palette does something, or says in one sentence why it does not."""

import sys

import pytest
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QApplication, QDialog, QFileDialog, QInputDialog, QMessageBox

from regolith_studio.jobs.events import Started, Stopped
from regolith_studio.session.session import Session
from regolith_studio.ui.dialogs.help import Tour
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.startup import open_window

LEFT_OUT = ("quit", "recent")
"""The end of the window, and a menu."""
NOTHING_TO_SEE = (
    *("undo", "redo", "open_sample", "standard_layout", "explore.reset", "sample.clear_filter"),
    *("theme_system", "theme_light", "theme_dark", "explore.look_isometric"),
)
"""They may find everything as they would leave it."""
WITH_PARTICLES = (
    *("explore.look_front", "explore.look_back", "explore.look_left"),
    *("explore.look_right", "explore.look_top", "explore.look_bottom"),
    "explore.enlarge",
)
"""What they would show is not there without particles, fits and runs."""


class Held:
    """A job that has begun and goes no further until it is cancelled."""

    done = False

    def __init__(self, listener):
        self.listener = listener
        listener(Started("held", 10))

    def cancel(self):
        if not self.done:
            self.done = True
            self.listener(Stopped())


class HoldingRunner:
    """Begins every job and ends none."""

    def submit(self, _job, listener, queue=""):  # noqa: ARG002
        return Held(listener)

    def close(self):
        """Nothing runs."""


class Witness:
    """Answers every question with a cancel, and knows what has happened."""

    def __init__(self, window, monkeypatch):
        self.window, self.asked, self.wrong, self.started = window, [], [], []
        for owner, name, answer in (
            (QFileDialog, "getOpenFileName", ("", "")),
            (QFileDialog, "getOpenFileNames", ([], "")),
            (QFileDialog, "getSaveFileName", ("", "")),
            (QFileDialog, "getExistingDirectory", ""),
            (QInputDialog, "getText", ("", False)),
            (QInputDialog, "getItem", ("", False)),
            (QMessageBox, "question", QMessageBox.StandardButton.No),
            (QDialog, "exec", 0),
            (QMessageBox, "exec", 0),
        ):
            monkeypatch.setattr(owner, name, self._answering(name, answer))
        monkeypatch.setattr(sys, "excepthook", lambda *error: self.wrong.append(error))
        window.toast.shown.connect(self._hear)

    def _answering(self, name, answer):
        def reply(*_arguments, **_options):
            self.asked.append(name)
            return answer

        return reply

    def _hear(self, _kind, sentence, _details):
        assert sentence.strip().endswith((".", "!", "?")), f"no sentence: {sentence}"
        self.asked.append(sentence)

    def seen(self):
        """What a user could notice, but for the picture."""
        window, session = self.window, self.window.session
        self.started += [task.id for task in session.tasks if task.id not in self.started]
        return (
            *(
                len(self.asked),
                len(self.started),
                window.pages.current,
                session.choices,
            ),
            *(window.size(), window.isFullScreen(), window.activity.isVisible(), window.windowTitle()),
            QGuiApplication.clipboard().text(),
            tuple(action.isChecked() for action in window.menus.by_name.values()),
            tuple(each for each in QApplication.topLevelWidgets() if each.isVisible()),
            tuple(each.isVisible() for each in window.findChildren(QDialog)),
        )

    def picture(self):
        """What is on the screen."""
        QApplication.processEvents()
        return self.window.grab().toImage()

    def tidy(self):
        """Close what has opened and stop what has begun, as a user would."""
        for dialog in (*self.window.findChildren(QDialog), *QApplication.topLevelWidgets()):
            if isinstance(dialog, QDialog) and dialog.isVisible():
                dialog.reject()
        for tour in self.window.findChildren(Tour):
            tour.finish()
        for task in self.window.session.tasks:
            self.window.session.cancel(task.id)
        if self.window.isFullScreen():
            self.window.showNormal()
        self.window.toast.hide()
        QApplication.processEvents()


def silent_commands(window, monkeypatch, unseen=(*NOTHING_TO_SEE, *WITH_PARTICLES)):
    """Names of the commands after which everything is as it was and nothing was said."""
    witness, silent = Witness(window, monkeypatch), []
    for name, action in window.menus.by_name.items():
        page, _, command = name.partition(".")
        if name in LEFT_OUT:
            continue
        if command and page != "go":
            window.go(page)
        QApplication.processEvents()
        if not action.isEnabled():
            continue
        before, picture = witness.seen(), witness.picture()
        action.trigger()
        QApplication.processEvents()
        noticed = witness.seen() != before or witness.picture() != picture
        if not noticed and name not in unseen and not name.startswith("go."):
            silent.append(name)
        assert not witness.wrong, (name, witness.wrong)
        if action.isCheckable():
            action.trigger()
        witness.tidy()
        assert not witness.wrong, (name, witness.wrong)
    return silent


@pytest.mark.slow
def test_that_every_command_answers_where_nothing_is_open(shown, preferences, monkeypatch):
    window = shown(MainWindow(Session(HoldingRunner()), preferences, "image"))
    monkeypatch.setattr(window.session, "open_sample", lambda **_: None)
    assert silent_commands(window, monkeypatch) == []


@pytest.mark.slow
def test_that_every_command_answers_where_all_pages_are_full(shown, preferences, monkeypatch, wait, settled):
    window = open_window(views="image", preferences=preferences)
    shown(window)
    wait(lambda: window.session.results.coarsened is not None and not window.session.tasks)
    window.session.adopt([entry.particle for entry in window.session.particles[:4]])
    window.session.choose(method="quadric", n_facets=12, level=2, l_max=4)
    settled(window)
    window.go("studies")
    window.menus.by_name["studies.run_all"].trigger()
    wait(lambda: window.session.results.coarsening_study is not None and not window.session.tasks)
    model = window.go("model")
    window.menus.by_name["model.fit_model"].trigger()
    wait(lambda: model.drawing.draw.isEnabled() and not window.session.tasks)
    window.session.choose(n_facets=14)
    settled(window)
    window.go("explore")
    silent = silent_commands(window, monkeypatch, NOTHING_TO_SEE)
    settled(window)
    assert silent == []
