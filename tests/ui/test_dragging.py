"""A slider that never rests: what has been made meanwhile is seen."""

from itertools import cycle

import pytest

from regolith_studio.ui.startup import open_window


@pytest.mark.parametrize("method", ["quadric", "exact"])
@pytest.mark.slow
def test_that_polyhedra_are_seen_while_a_slider_never_rests(shown, preferences, wait, method):
    window = shown(open_window(views="image", preferences=preferences))
    session, frame = window.session, window.page.three_views.frames["polyhedron"]
    wait(lambda: session.results.coarsened is not None and not session.tasks, 120.0)
    session.choose(method=method, level=2)
    seen, places = set(), cycle([*range(12, 40), *range(40, 12, -1)])

    def has_moved_on():
        session.choose("n_facets", n_facets=next(places))
        seen.add(frame.title)
        return len(seen) >= 5

    wait(has_moved_on)
    session.choose("n_facets", n_facets=24)
    wait(lambda: session.results.coarsened is not None and not session.tasks)
    wait(lambda: str(session.results.coarsened.n_facets) in frame.title)
