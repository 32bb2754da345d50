"""The page "Angle of repose" over a session of its own, datasets, and heaps for it."""

import numpy as np
import pytest
from PySide6.QtWidgets import QFileDialog

from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.snapshot import ParticleState, particle_state_bytes
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.session.session import Session
from regolith_studio.ui.pages.repose import PAGE
from regolith_studio.ui.startup import MainThreadInvoker
from tests.dem.conftest import box_dataset
from tests.dem.packings import cone

QUICK = {"time_step": 0.04, "iterations": 15, "rest_energy": 4e-3, "rest_time": 1.0, "snapshots": 12}


@pytest.fixture
def threads(app):  # noqa: ARG001
    """A runner whose jobs run beside the window; pages that are made without it have one that waits."""
    poster = MainThreadInvoker()
    yield ThreadRunner(poster.post)
    poster.deleteLater()


@pytest.fixture
def page(page_of, tmp_path, request):
    threaded = "threads" in request.fixturenames
    session = Session(request.getfixturevalue("threads")) if threaded else None
    made = page_of(PAGE, 1200, 800, session)
    made.set_runs_folder(tmp_path / "runs")
    return made


@pytest.fixture
def dataset(tmp_path):
    return write_dataset(tmp_path / "boxes", box_dataset())


def small(page, dataset):
    page.setup.set_dataset(dataset)
    page.setup.test.setValue(LiftingCylinderTest(mass=0.003, lift_speed=0.15))
    page.setup.numerics.setValue(QUICK)
    page.setup.set_evaluation(min_particles=40)
    page.setup.particles.setValue(40)


def pile_of(angle, n=700):
    points = 2e-3 * cone(angle, n, 1)
    turns = np.tile([1.0, 0, 0, 0], (n, 1))
    return ParticleState(points, np.full(n, 2e-3), turns, np.zeros(n, dtype=int), 1.0, float("inf"), "rest")


def import_positions(page, monkeypatch, tmp_path, pile):
    path = tmp_path / "pile.npz"
    path.write_bytes(particle_state_bytes(pile))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    page.open_positions()


def watch_moments(page, monkeypatch):
    """Title of each picture, whether it shows spheres, and the corners of its first shape."""
    drawn, show = [], page.player.show_moment

    def watch(pile, title, detail=""):
        drawn.append((title, page.player._spheres, len(page.player._shapes[0][0])))
        show(pile, title, detail)

    monkeypatch.setattr(page.player, "show_moment", watch)
    return drawn
