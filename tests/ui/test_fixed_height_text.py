"""A control never moves under the mouse because a text beside it has changed."""

import pytest
from PySide6.QtCore import QPoint, QRect
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QScrollBar,
    QSlider,
)

from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.choices import Choices, Kind
from regolith_studio.session.session import Session
from regolith_studio.ui.main_window import MainWindow

KINDS = (QAbstractButton, QAbstractSpinBox, QComboBox, QLineEdit, QSlider)
SECONDS = 170.0


@pytest.fixture(params=[(1280, 800), pytest.param((1920, 1080), marks=pytest.mark.slow)], ids=str)
def window(request, shown, preferences, settled):
    session = Session(InlineRunner(), Choices(method="quadric"))  # which needs no kernels to be compiled
    made = MainWindow(session, preferences, "image")
    made.resize(*request.param)
    shown(made)
    session.open_sample()
    settled(made, SECONDS)
    return made


def places(page):
    """Where each control is that can be seen, by its object; parts of others are left out."""
    found = {}
    for kind in KINDS:
        for each in page.findChildren(kind):
            part = isinstance(each.parent(), QAbstractSpinBox | QComboBox | QScrollBar)
            if each.isVisible() and not part and not each.objectName().startswith("qt_"):
                found[each] = QRect(each.mapTo(page, QPoint()), each.size())
    return found


class Watched:
    """Compares the places of controls before and after something is done."""

    def __init__(self, window, settled):
        self._window, self._settled = window, settled

    def go(self, key):
        self._window.go(key)
        self._rest()
        return self._window.page

    def _rest(self):
        self._settled(self._window, SECONDS)
        for _ in range(5):  # what is laid out anew
            QApplication.processEvents()
        self._settled(self._window, SECONDS)

    def does(self, what, action, *arguments):
        """Nothing that was seen before and still is may have moved."""
        before = places(self._window.page)
        assert before
        action(*arguments)
        self._rest()
        after = places(self._window.page)
        moved = {
            f"{type(each).__name__} {each.objectName() or each.accessibleName()}": (old, after[each])
            for each, old in before.items()
            if each in after and after[each] != old
        }
        assert not moved, f"{what} moved {moved}"


@pytest.fixture
def watched(window, settled):
    return Watched(window, settled)


@pytest.mark.slow
def test_that_no_control_of_explore_moves_with_particle_degree_method_and_outcome(window, watched):
    page, session = watched.go("explore"), window.session
    for entry in session.particles[:4]:
        watched.does(entry.id, session.select, entry.id)
    for changes in ({"l_max": 2}, {"l_max": 15}, {"target": "particle"}, {"method": "exact"}):
        watched.does(str(changes), lambda changes=changes: session.choose(**changes))
    for at in range(page.loss.preset.count()):
        watched.does(page.loss.preset.itemText(at), page.loss.bar.chosen.emit, page.loss.preset.itemData(at))
    watched.does("a reason", page.outcome.set_sentence, "None has so few facets. " * 20)
    watched.does("no reason", page.outcome.set_sentence, None)
    watched.does("no fit", page.fit.set_findings, None)


def test_that_no_control_of_sample_moves_with_a_filter_that_is_wrong(watched):
    page = watched.go("sample")
    for text in ("flat", "S<", "nonsense>", ""):
        watched.does(text, page.filter.setText, text)


@pytest.mark.slow
def test_that_no_control_of_dataset_moves_while_one_is_made(window, watched, tmp_path):
    page = watched.go("dataset")
    watched.does("find", page.find_representatives)
    for at in [*range(page.sizes.kind.count()), 0]:
        watched.does(page.sizes.kind.itemText(at), page.sizes.kind.setCurrentIndex, at)
    watched.does("nonsense", page.sizes.set_text, "sieve:one,two")
    watched.does("as measured", page.sizes.set_text, "measured")
    watched.does("build", page.build_in, tmp_path / "a name that is long" / "dataset")
    for key, box in page.targets.boxes.items():
        watched.does(key, box.click)
    watched.does("other choices", lambda: window.session.choose(n_facets=35, stop_at="error", seed=123456))


@pytest.mark.slow
def test_that_no_control_of_scan_moves_from_volume_to_particles(watched):
    page = watched.go("scan")
    watched.does("sample scan", page.opening.open_sample)
    watched.does("another level", lambda: page.controls.level.setValue(60.0))
    watched.does("dark grains", page.controls.dark.click)
    watched.does("bright grains", page.controls.dark.click)
    watched.does("automatic", page.controls.threshold.setCurrentIndex, 0)
    watched.does("find", page.find_grains)
    watched.does("particles", page.make_particles)


@pytest.mark.slow
def test_that_no_control_of_the_shape_model_moves_with_source_fit_and_draws(watched):
    page = watched.go("model")
    for at in [*range(page.source.source.count()), 1]:
        watched.does(page.source.source.itemText(at), page.source.source.setCurrentIndex, at)
    watched.does("fit", page.fit_model)
    watched.does("draw", page.draw)
    for at in range(page.source.model.count()):
        watched.does(page.source.model.itemText(at), page.source.model.setCurrentIndex, at)


@pytest.mark.slow
def test_that_no_control_of_studies_moves_with_a_study(window, watched):
    window.session.keep([entry.id for entry in window.session.particles[:2]])
    page = watched.go("studies")
    watched.does("losses", page.start, Kind.COARSENING_STUDY)
    watched.does("other choices", lambda: window.session.choose(n_facets=12))


@pytest.mark.slow
def test_that_no_control_of_the_angle_of_repose_moves_with_consequences_and_problems(watched):
    page = watched.go("repose")
    watched.does("a dataset", page.make_dataset)
    sentences = [f"This follows, number {n}." for n in range(30)]
    watched.does("scaling_report", page.setup.show_consequences, sentences)
    watched.does("a problem", page.setup.show_consequences, [], "It cannot be. " * 30)
    watched.does("other shapes", page.setup.shapes.setCurrentIndex, 1)
    watched.does("more", page.setup.particles.setValue, 30_000)


@pytest.mark.slow
def test_that_no_control_of_the_lecture_moves_with_its_sentences(window, watched, wait, settled):
    page = watched.go("lecture")
    window.session.keep([window.session.particles[0].id])
    wait(lambda: page.annealing.playback.has_steps, SECONDS)
    for step in (1, 2, 5, 100):
        watched.does(f"step {step}", page.annealing.playback.go, step)
    page.tabs.setCurrentIndex(1)
    wait(lambda: page.degrees.playback.has_steps, SECONDS)
    settled(window, SECONDS)
    for step in (1, 2, 8):
        watched.does(f"degree {step}", page.degrees.playback.go, step)
