"""What was open and is closed again leaves nothing behind."""

import gc
import weakref

import pytest

DRAWN = 20


@pytest.fixture
def window(sample_window):
    made = sample_window(900, 640)
    made.session.choose(method="quadric", level=2)
    return made


@pytest.mark.slow
def test_that_drawn_particles_are_gone_when_others_are_opened(window, wait, settled):
    page, session = window.go("model"), window.session
    page.fit_model()
    wait(lambda: page._fitted is not None)
    page.drawing.setValue(page.drawing.value() | {"n": DRAWN})
    page.draw()
    wait(lambda: page._drawn is not None)
    page.adopt()
    wait(lambda: len(session.particles) == DRAWN)
    window.go("sample")  # its table keeps what it shows
    settled(window)
    session.select(session.particles[7].id)
    settled(window)
    known = [weakref.ref(entry.particle) for entry in session.particles]
    window.go("explore")
    session.open_sample()
    wait(lambda: len(session.particles) != DRAWN)
    settled(window)
    window.pages.refresh_hidden()

    def gone():
        gc.collect()
        return not any(each() for each in known)

    wait(gone)
