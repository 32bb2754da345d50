"""The page Scan alone, with a session of its own."""

import numpy as np
import pytest

from regolith_studio.imaging.volume import sample_volume
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.session.session import Session
from regolith_studio.ui.pages.scan import PAGE
from regolith_studio.ui.startup import MainThreadInvoker

SECONDS = 120.0


@pytest.fixture
def page(page_of, wait, monkeypatch):
    """The page alone, with a session of its own that keeps what it is handed and does no more with it."""
    poster = MainThreadInvoker()
    session, adopted, visited = Session(ThreadRunner(poster.post)), [], []
    monkeypatch.setattr(session, "adopt", lambda particles, **_origin: adopted.extend(particles))
    made = page_of(PAGE, 1200, 750, session, visited.append)
    session.events.failed.connect(lambda failure: made.toast.problem(failure.sentence))
    made.visited, made.adopted = visited, adopted
    yield made
    wait(lambda: not session.tasks, SECONDS)
    poster.setParent(made)


@pytest.fixture
def part(tmp_path):
    """A corner of the shipped scan as NPY: no voxel size is in it."""
    np.save(tmp_path / "part.npy", np.ascontiguousarray(sample_volume("grey").array[:90, :80, :70].T))
    return tmp_path / "part.npy"
