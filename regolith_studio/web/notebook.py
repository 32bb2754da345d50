"""``show``: the three views in a notebook, served from a thread of the notebook's own process."""

import asyncio
import atexit
import html
import threading
from collections.abc import Sequence
from concurrent.futures import Future
from functools import cache

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import Results
from regolith_studio.web.server import ViewServer

STOP_SECONDS = 30.0
"""Longest time that closing the views waits for what they compute to end."""


class NotebookViews:
    """The three views of one call of :func:`show`; displayed by the notebook.

    Parameters
    ----------
    server
        That serves the page.
    height
        Of the frame in the notebook, in pixels.
    """

    def __init__(self, server: ViewServer, height: int) -> None:
        self._server, self._height = server, height
        self._ready: Future[None] = Future()
        self._ended = threading.Event()
        self._running = asyncio.run_coroutine_threadsafe(self._serve(), _loop())
        self._ready.result()
        atexit.register(self.close)

    @property
    def url(self) -> str:
        """Address of the page, with the token without which nothing is served."""
        return self._server.url

    @property
    def results(self) -> Results:
        """Fit, descriptors and polyhedron as the sliders stand; ``None`` where they are not computed yet."""
        session = self._server.session
        assert session is not None, "the server has started"
        return session.results

    def close(self) -> None:
        """Stop serving; the frame in the notebook stays empty from then on."""
        atexit.unregister(self.close)
        self._running.cancel()
        self._ended.wait(STOP_SECONDS)

    async def _serve(self) -> None:
        try:
            await self._server.run(lambda: self._ready.set_result(None))
        except RegolithError as error:
            self._ready.set_exception(error)
        finally:
            self._ended.set()

    def _repr_html_(self) -> str:
        address = html.escape(self.url)
        return f'<iframe src="{address}" width="100%" height="{self._height}" style="border: 0"></iframe>'


def show(
    particle: Particle | Mesh | Sequence[Particle],
    l_max: int = 10,
    n_facets: int = 20,
    method: str = "exact",
    height: int = 560,
) -> NotebookViews:
    """Particle, spherical-harmonics fit and polyhedron with sliders, as the last expression of a cell.

    The polyhedron imitates the fit at `l_max`, as in section 3.2 of the paper.

    Parameters
    ----------
    particle
        One particle or mesh, in micrometres, or several particles to choose from.
    l_max, n_facets, method
        Where sliders and method begin.
    height
        Of the frame in pixels.

    Raises
    ------
    InputError
        If there is no particle or a value is out of its range.
    MissingRequirement
        If trame is not installed.
    """
    if isinstance(particle, Mesh):
        particle = Particle("particle", particle)
    particles = [particle] if isinstance(particle, Particle) else list(particle)
    if not particles:
        raise InputError("There is no particle to show.")
    choices = Choices(target="fit").replaced(l_max=l_max, n_facets=n_facets, method=method)
    return NotebookViews(ViewServer(particles, choices), height)


@cache
def _loop() -> asyncio.AbstractEventLoop:
    """An event loop in a thread of its own, which draws all views of this process."""
    loop = asyncio.new_event_loop()

    def work() -> None:
        asyncio.set_event_loop(loop)
        loop.run_forever()

    threading.Thread(target=work, name="three views", daemon=True).start()
    return loop
