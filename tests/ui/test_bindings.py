"""When and in which order parts of a page are refreshed."""

from PySide6.QtCore import QObject

from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings


def test_that_a_page_that_was_hidden_shows_a_particle_before_what_was_made_of_it(app, wait):  # noqa: ARG001
    """Else the polyhedron is drawn first, and the new particle clears its view."""
    session, around, seen = Session(InlineRunner()), QObject(), []
    bindings = Bindings(session, seen.append, around)
    bindings.refresh("particles choices", lambda: seen.append("particle"))
    bindings.refresh("coarsening", lambda: seen.append("polyhedron"))
    seen.clear()
    bindings.pause()
    session.events.coarsening.emit()
    session.events.particles.emit()
    bindings.resume()
    wait(lambda: len(seen) == 2)
    assert seen == ["particle", "polyhedron"]
    bindings.disconnect_all()
    session.close()
