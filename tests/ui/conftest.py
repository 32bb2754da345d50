"""One application for all tests of the window, and a guard that lets nothing survive a test.

With a display the application runs on it, so that live views work too; without one it draws off-screen.
Where several processes share the tests, each has a display of its own: windows would take each other's focus.
"""

import gc
import os
import shutil
import sys
import threading
import time
from unittest.mock import patch

import pytest

if sys.platform.startswith("linux"):
    os.environ.setdefault("QT_QPA_PLATFORM", "xcb" if os.environ.get("DISPLAY") else "offscreen")

import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, QObject, Qt, QTimer, QTranslator
from PySide6.QtWidgets import QApplication, QWidget
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

from bootstrap import virtual_display
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.readers.sandbox.parent import shared_sandbox
from regolith_studio.session.choices import Choices
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui import main_window
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.startup import MainThreadInvoker, make_application, open_window
from regolith_studio.ui.translation import install_translators, remove_translators
from regolith_studio.ui.views.image_view import ImageView
from regolith_studio.ui.widgets.formula import all_outlines
from regolith_studio.ui.widgets.toast import Toast


@pytest.fixture(scope="session")
def display():
    """The display of this process of the tests."""
    alone = "PYTEST_XDIST_WORKER" not in os.environ
    if alone or not os.environ.get("DISPLAY") or not shutil.which("Xvfb"):
        yield
        return
    with virtual_display() as name, patch.dict(os.environ, DISPLAY=name):
        yield


@pytest.fixture(scope="session")
def app(display, tmp_path_factory):  # noqa: ARG001
    """The one application object; never the user's preferences, nor the runs in the user's folder."""
    os.environ["REGOLITH_STUDIO_CONFIG"] = str(tmp_path_factory.mktemp("config"))
    os.environ["XDG_DATA_HOME"] = str(tmp_path_factory.mktemp("data"))
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs)
    made = QApplication.instance() or make_application(["tests"])
    made.setQuitOnLastWindowClosed(False)
    # a question that nobody answers runs no Python, and the alarm of a test's timeout would never be heard
    heartbeat = QTimer(made, interval=500)
    heartbeat.timeout.connect(lambda: None)
    heartbeat.start()
    shared_sandbox().start()  # its threads stay, whichever test reads first
    return made


@pytest.fixture(autouse=True)
def nothing_left_behind(request):
    """Fail a test that leaves a widget, a running timer, a thread or a VTK object."""
    if "app" not in request.fixturenames:
        yield
        return
    request.getfixturevalue("app")
    gc.collect()
    gc.freeze()  # what was there before is left out of all that follows
    threads, windows = set(threading.enumerate()), set(QApplication.topLevelWidgets())
    yield
    request.node.funcargs.clear()  # pytest holds on to them longer than it needs
    for each in set(threading.enumerate()) - threads:
        each.join(20.0)  # a line of a formula, or the start of a reader, may be under way
    _settle()
    left = _newcomers() + [each.name for each in threading.enumerate() if each not in threads]
    left += [_name(each) for each in QApplication.topLevelWidgets() if each not in windows]
    assert not left, f"the test left behind: {left}"


@pytest.fixture
def wait(app):
    """Lets the event loop run until something is true; fails after a while."""

    def run(until, seconds=60.0):
        end = time.monotonic() + seconds
        while not until():
            assert time.monotonic() < end, "waited in vain"
            app.processEvents()
            time.sleep(0.002)

    return run


@pytest.fixture
def settled(wait):
    """Lets the event loop run until a window computes nothing and has shown all that it knows."""

    def run(window, seconds=60.0):
        def rests():
            refreshed = all(each.idle for each in window.findChildren(Bindings))
            return refreshed and not window.session.tasks and all_outlines()

        wait(rests, seconds)
        wait(rests, seconds)  # what the last refreshment has set off

    return run


@pytest.fixture
def shown(app):
    """Shows a widget, and deletes it after the test."""
    kept = []

    def show(widget):
        kept.append(widget)
        widget.show()
        app.processEvents()
        return widget

    yield show
    for widget in kept:
        with patch.object(main_window, "may_close", return_value=True):  # nobody is there to answer
            widget.close()
        widget.deleteLater()
    kept.clear()


class BracketTranslator(QTranslator):
    """Puts every text of the window in brackets."""

    def isEmpty(self):  # noqa: N802
        return False

    def translate(self, context, source, _disambiguation=None, _n=-1):
        return f"⟦{source}⟧" if context == "" else None


@pytest.fixture
def speaking(app):
    """Lets the window speak a language, or that of brackets, until the test is over."""
    installed = []

    def begin(language):
        if language == "brackets":
            translator = BracketTranslator()
            app.installTranslator(translator)
            installed.append(translator)
        else:
            installed.extend(install_translators(app, language))

    yield begin
    remove_translators(app, installed)


@pytest.fixture
def preferences(tmp_path, monkeypatch):
    """Preferences of nobody, kept nowhere else."""
    monkeypatch.setenv("REGOLITH_STUDIO_CONFIG", str(tmp_path / "config"))
    return Preferences()


@pytest.fixture
def pictures_on_request(monkeypatch):
    """Let 3-D views in images draw when a test asks for a picture only: each drawing takes 70 ms."""
    monkeypatch.setattr(ImageView, "paintEvent", lambda _view, _event: None)


@pytest.fixture
def sample_window(shown, preferences, settled, pictures_on_request):  # noqa: ARG001
    """Opens a window on the sample; its first polyhedron, by a fast method, is there when it is returned."""

    def run(width=1100, height=720, method="quadric"):
        made = open_window(views="image", preferences=preferences)
        made.session.choose(method=method)
        made.resize(width, height)
        settled(shown(made), 170.0)
        assert made.session.results.coarsened is not None
        return made

    return run


@pytest.fixture
def window(sample_window):
    """A window on the sample, with its first polyhedron."""
    return sample_window()


@pytest.fixture
def page_of(shown, preferences, pictures_on_request):  # noqa: ARG001
    """Builds a page alone, over a session of its own whose jobs run at once where it is given none.

    Its particles are coarsened by the fastest method, and the surfaces of its fits are coarse: the box of a
    smooth one of 5,120 triangles takes 0.1 s.
    """
    ends = []

    def build(page, width, height, session=None, go=lambda _key: None):
        session, frame = (
            session or Session(InlineRunner(), Choices(method="quadric", level=2)),
            shown(QWidget()),
        )
        toast = Toast(frame)
        bindings = Bindings(session, toast.problem, frame)
        toast.follow(session, bindings)
        commands = Commands(session, preferences, toast, frame)
        context = PageContext(page.key, session, bindings, preferences, toast, commands, "image", go)
        made = shown(page.build(context))
        made.resize(width, height)
        made.session, made.toast, made.context = session, toast, context
        ends.extend((session.close, made.on_close, bindings.disconnect_all))
        return made

    yield build
    while ends:
        ends.pop()()


@pytest.fixture
def dialog_runs(shown, preferences):
    """Makes the runs of a dialog over a session with threads, in a bare window."""
    ends = []

    def make(kind, choices=None):
        window, poster = shown(QWidget()), MainThreadInvoker()
        session = Session(ThreadRunner(poster.post), choices or Choices())
        toast = Toast(window)
        bindings = Bindings(session, toast.problem, window)
        made = kind(session, preferences, toast, window)
        bindings.refresh("tasks", made.show_tasks)
        ends.extend((bindings.disconnect_all, session.close, poster.close))
        return made

    yield make
    for end in ends:
        end()


def _settle():
    for _ in range(3):
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        QApplication.processEvents()
        gc.collect()


def _newcomers():
    """Widgets, running timers and VTK objects that have been made since the last freeze."""
    found = []
    for each in gc.get_objects():
        if issubclass(type(each), vtkRenderer | vtkRenderWindow):  # not the proxies of what is gone
            found.append(_name(each))
            continue
        if not issubclass(type(each), QWidget | QTimer) or not shiboken6.isValid(each):
            continue
        if isinstance(each, QWidget):
            found.append(_name(each))
        elif each.isActive():
            found.append(f"running {_name(each)}")
    return found


def _name(each):
    label = each.objectName() if isinstance(each, QObject) else ""
    return f"{type(each).__name__} {label}".strip()
