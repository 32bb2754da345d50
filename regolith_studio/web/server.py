"""Serve the three views over HTTP: on this machine unless asked otherwise, and below a secret token only."""

import asyncio
import contextlib
import logging
import os
import secrets
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from regolith_studio.errors import InputError, MissingRequirement, os_error_reason
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.session.choices import Choices
from regolith_studio.session.session import Session

LOCAL = "127.0.0.1"
NEEDED = 'This needs trame, which is an extra: pip install "regolith-studio[notebook]".'
TOKEN_BYTES = 24


class ViewServer:
    """A server of the three views; its methods are called in the thread of one event loop.

    - ``particles``: what can be chosen on the page.
    - ``choices``: where sliders and method begin.
    - ``host``, ``port``: where it listens; port 0 takes a free one.

    ``session``: choices and results; read it from any thread, change it in the server's.
    """

    def __init__(
        self, particles: Sequence[Particle], choices: Choices, host: str = LOCAL, port: int = 0
    ) -> None:
        _check_installed()
        self._particles, self._choices = tuple(particles), choices
        self._host, self._port = host, port
        self._token = secrets.token_urlsafe(TOKEN_BYTES)
        self.session: Session | None = None

    @property
    def url(self) -> str:
        """Address of the page, with the token; the port is known once it listens."""
        host = f"[{self._host}]" if ":" in self._host else self._host
        return f"http://{host}:{self._port}/{self._token}/"

    async def run(self, ready: Callable[[], Any]) -> None:
        """Serve until cancelled.

        Parameters
        ----------
        ready
            Called when the page can be opened.

        Raises
        ------
        InputError
            If the address cannot be listened to.
        """
        from trame.app import get_server

        from regolith_studio.web.page import ThreeViewPage

        loop = asyncio.get_running_loop()
        runner = ThreadRunner(lambda call: _post(loop, call))
        self.session = session = Session(runner, self._choices)
        session.adopt(self._particles)
        server = get_server(self._token, client_type="vue3")
        page = ThreeViewPage(server, session)
        try:
            runner.submit(Job(compile_first), lambda _event: None, "compile")
            server.controller.on_server_bind.add(lambda web: _serve_below(web, self._token, server.serve))

            def report_ready(**_state: Any) -> None:
                self._port = server.port
                server.protocol.stopServer = _refuse_to_stop
                ready()

            server.controller.on_server_ready.add(report_ready)
            await _serve(server, self._host, self._port)
        except OSError as error:
            reason = os_error_reason(error)
            raise InputError(
                f"Cannot listen to {self._host}, port {self._port} ({reason}); name another."
            ) from error
        finally:
            session.close()
            page.close()


def _post(loop: asyncio.AbstractEventLoop, call: Callable[[], None]) -> None:
    loop.call_soon_threadsafe(call)


def _check_installed() -> None:
    try:
        import trame.widgets.vtk  # noqa: F401
    except ImportError:
        raise MissingRequirement(NEEDED) from None


async def _serve(server: Any, host: str, port: int) -> None:
    """Run trame's server, without its own command line, static files and messages, until cancelled."""
    os.environ["TRAME_ARGS"] = "--no-http"
    os.environ["WSLINK_READY_MSG"] = ""
    asyncio.get_running_loop().set_exception_handler(_ignore_closed_pages)
    for name in ("aiohttp.server", "wslink.protocol"):
        logging.getLogger(name).addFilter(_is_worth_logging)
    start = server.start(
        host=host,
        port=port,
        exec_mode="coroutine",
        backend="aiohttp",
        thread=True,
        timeout=0,
        open_browser=False,
        show_connection_info=False,
        disable_logging=True,
    )
    serving = asyncio.ensure_future(start)
    try:
        await asyncio.shield(serving)
    except asyncio.CancelledError:
        with contextlib.suppress(asyncio.InvalidStateError):  # what it ends with was cancelled, too
            await server.stop()
        await asyncio.gather(serving, return_exceptions=True)
        raise


def _is_worth_logging(record: logging.LogRecord) -> bool:
    """Whether a message is about anything but a page that was closed, or a request that is none."""
    from aiohttp.http_exceptions import HttpProcessingError

    return not (record.exc_info and isinstance(record.exc_info[1], ConnectionError | HttpProcessingError))


def _refuse_to_stop() -> None:
    """In place of what ``application.exit`` calls: no page may end the server for all the others."""


def _ignore_closed_pages(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    if not isinstance(context.get("exception"), ConnectionError):
        loop.default_exception_handler(context)


def _serve_below(web: Any, token: str, folders: dict[str, str]) -> None:
    """Move the web socket and the files of a wslink server below ``/token/``; elsewhere nothing is found."""
    from aiohttp import web as http
    from trame_client.module import vue3

    inner, outer = web.app, http.Application()
    index = Path(vue3.www) / "index.html"

    async def page(_request: http.Request) -> http.FileResponse:
        return http.FileResponse(index)

    inner.router.add_get("/", page)
    for name, folder in folders.items():  # the scripts of trame's modules
        inner.router.add_static(f"/{name}", folder)
    inner.router.add_static("/", vue3.www)
    outer.add_subapp(f"/{token}", inner)
    web.set_app(outer)
