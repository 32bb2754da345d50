"""Formulas: set one by one, and never while the thread of the window would have to wait."""

from threading import Event, Thread

from PySide6.QtTest import QTest

from regolith_studio.studies.figures import MATPLOTLIB_LOCK
from regolith_studio.ui.pages.lecture.lessons import PlaybackBar
from regolith_studio.ui.widgets.formula import FormulaLabel, prepare


def test_that_the_window_does_not_wait_for_a_figure_that_another_thread_draws(shown, wait, app):
    held, done = Event(), Event()

    def draw():
        with MATPLOTLIB_LOCK:
            held.set()
            done.wait(20.0)

    figure = Thread(target=draw)
    figure.start()
    held.wait(20.0)
    label = shown(FormulaLabel("A formula"))
    label.set_lines(r"$x_{\mathrm{never\,set\,before}}^{2}$")
    for _ in range(5):
        app.processEvents()  # would wait for the figure, that is until this test gives up
    assert label.sizeHint().width() <= 2
    done.set()
    figure.join()
    wait(lambda: label.sizeHint().width() > 20)


def test_that_no_step_is_described_by_the_formulas_of_another(shown, wait):
    """The old formulas are gone while new ones are being set, and what plays waits for them."""
    label = shown(FormulaLabel("A formula"))
    label.set_lines("$a_1$")
    wait(lambda: label.sizeHint().width() > 5)
    label.resize(200, 60)
    empty = FormulaLabel("Nothing")
    empty.resize(200, 60)
    playback = shown(PlaybackBar("test", "step", lambda step: prepare((rf"$\mathrm{{step}}_{{{step}}}$",))))
    playback.set_count(3)
    playback.speed.setValue(20)
    with MATPLOTLIB_LOCK:
        label.set_lines("$b_2$")
        assert label.grab().toImage() == empty.grab().toImage()
        playback.toggle()
        QTest.qWait(200)
        assert playback.playing
        assert playback.step == 0
    wait(lambda: playback.step == 2)
    assert label.grab().toImage() != empty.grab().toImage()
