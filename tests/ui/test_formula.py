"""Formulas: set one by one, and never while the thread of the window would have to wait."""

from threading import Event, Thread

from regolith_studio.studies.matplotlib_lock import MATPLOTLIB_LOCK
from regolith_studio.ui.widgets.formula import FormulaLabel


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
