"""A window that a program drives, for the measurements of :mod:`benchmarks.window`."""

import ctypes
import gc
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import psutil

PATIENCE = 120.0
"""Seconds after which something that should have happened is given up."""


@contextmanager
def opened(views: str, size: tuple[int, int] = (1920, 1080)) -> Iterator[Any]:
    """A window on the shipped sample with its first polyhedron, at rest; nobody's preferences are touched."""
    if views == "image" and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["REGOLITH_STUDIO_CONFIG"] = folder
        from regolith_studio.ui.startup import make_application

        make_application(["benchmark"])
        from regolith_studio.session.preferences import Preferences
        from regolith_studio.ui.app import open_window

        window = open_window(views=views, preferences=Preferences())
        window.resize(*size)
        window.show()
        until(lambda: window.session.results.coarsened is not None)
        settle(window)
        try:
            yield window
        finally:
            window.session.close()
            window.deleteLater()


def spin(seconds: float = 0.0) -> None:
    """Let the event loop run for a while, at least once."""
    from PySide6.QtWidgets import QApplication

    end = time.monotonic() + seconds
    QApplication.processEvents()
    while (left := end - time.monotonic()) > 0:
        time.sleep(min(left, 0.002))
        QApplication.processEvents()


def until(true: Callable[[], bool], seconds: float = PATIENCE) -> None:
    """Let the event loop run until something is true.

    Raises
    ------
    TimeoutError
        If it does not become true.
    """
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            raise TimeoutError("waited in vain")
        spin(0.001)


def settle(window: Any) -> None:
    """Wait until the window computes nothing and has shown all that it knows."""
    from regolith_studio.ui.bindings import Bindings

    def rests() -> bool:
        return not window.session.tasks and all(each.idle for each in window.findChildren(Bindings))

    until(rests)
    spin()
    until(rests)


def resident() -> float:
    """Megabytes (1e6 bytes) of this process, when what can be given back has been given back."""
    for _ in range(2):
        gc.collect()
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).malloc_trim(0)
    return float(psutil.Process().memory_info().rss) / 1e6
