"""The page Scan alone, with a session of its own."""

import numpy as np
import pytest
from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.imaging.sample_volumes import sample_volume
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan import PAGE
from regolith_studio.ui.startup import MainThreadInvoker
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
        "scan",
        session,
        bindings,
        preferences,
        toast,
        Commands(session, preferences, toast, frame),
        "image",
        visited.append,
    )
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
