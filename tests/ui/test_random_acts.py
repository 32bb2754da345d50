"""Random clicks, keys, drags and wheels on the window: nothing breaks, hangs or is left behind."""

import os

import pytest
from PySide6.QtGui import QGuiApplication

from regolith_studio.ui.startup import open_window

from .random_acts import RandomActs, dialogs_answered, errors_collected


@pytest.fixture
def views():
    """``REGOLITH_STUDIO_VIEWS=live`` uses live views."""
    return os.environ.get("REGOLITH_STUDIO_VIEWS", "image")


@pytest.fixture
def window(monkeypatch, shown, preferences, wait, views):
    monkeypatch.setattr("regolith_studio.ui.main_window.may_close", lambda *_: True)
    if views == "live" and QGuiApplication.platformName() == "offscreen":
        pytest.skip("live views need a display")
    made = open_window(views=views, preferences=preferences)
    made.resize(760, 520)
    shown(made)
    wait(lambda: made.session.results.coarsened is not None and not made.session.tasks, 120.0)
    made.session.choose(method="quadric", level=2)
    return made


def act(window, count, seed, pages=()):
    acts = RandomActs(window, seed, pages)
    with dialogs_answered(), errors_collected(window) as errors:
        for number in range(count):
            acts.act()
            assert not errors, f"act {number} of seed {seed}: {errors[0]}"
    for task in window.session.tasks:
        window.session.cancel(task.id)


@pytest.mark.slow
def test_that_random_acts_leave_a_window_that_answers(window, wait):
    act(window, 250, seed=1, pages=("explore", "sample", "studies"))
    window.go("explore")
    window.session.choose(selected=window.session.particles[0].id, l_max=7)
    wait(lambda: not window.session.tasks, 60.0)
    assert window.session.results.surface_l_max == 7 or window.session.results.surface is None


@pytest.mark.slow
@pytest.mark.window
@pytest.mark.parametrize("views", ["live"])
@pytest.mark.parametrize("seed", [3, 4, 5])
def test_that_live_views_bear_a_thousand_random_acts(window, settled, seed):
    act(window, 1_000, seed)
    settled(window, 110.0)
