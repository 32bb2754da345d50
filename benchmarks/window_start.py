"""How soon a window is there: each start is a process of its own, timed from before it is made."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from typing import Any

_BEGUN = "REGOLITH_STUDIO_BENCHMARK_BEGUN"
"""Environment variable with the time at which the process was started, of :func:`time.perf_counter`."""
PATIENCE = 120.0
"""Seconds for one start."""
SIZE = (1920, 1080)


def starts(count: int, views: str) -> Iterator[str]:
    """Start the window some times, with the sample, and say when the splash, frames and bodies were seen.

    The first start after others have run may read the program from the disk.
    """
    with tempfile.TemporaryDirectory() as folder:
        if views == "image" and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
            os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
        for _ in range(count):
            around = os.environ | {
                "REGOLITH_STUDIO_CONFIG": folder,
                "REGOLITH_STUDIO_VIEWS": views,
                _BEGUN: repr(time.perf_counter()),
            }
            asked = [sys.executable, "-m", "benchmarks.window_start"]
            done = subprocess.run(
                asked, env=around, capture_output=True, text=True, timeout=PATIENCE, check=True
            )
            seen = json.loads(done.stdout.splitlines()[-1])
            yield ", ".join(f"{name} after {seconds:.2f} s" for name, seconds in seen.items())


def main() -> None:
    """One start, in this process; prints what was seen when, and ends."""
    begun = float(os.environ[_BEGUN])
    seen: dict[str, float] = {}

    def now(name: str) -> None:
        seen.setdefault(name, round(time.perf_counter() - begun, 3))

    from regolith_studio.ui import startup

    made = startup.make_splash

    def splash() -> Any:
        from PySide6.QtCore import QTimer

        QTimer.singleShot(0, lambda: now("splash"))  # heard once the splash is drawn
        return made()

    startup.make_splash = splash
    _watch(now, seen)
    startup.run()


def _watch(now: Any, seen: dict[str, float]) -> None:
    """Follow the window once it is there."""
    from regolith_studio.ui import translation

    install = translation.install_translators

    def installed(*given: Any) -> Any:
        translators = install(*given)
        from regolith_studio.ui import startup

        opened, startup.show_recovery_and_tour = startup.open_window, lambda _window: None

        def watched(*paths: Any, **options: Any) -> Any:
            window = opened(*paths, **options)
            window.resize(*SIZE)
            _frames(window, now, seen)
            return window

        startup.open_window = watched
        return translators

    translation.install_translators = installed


def _frames(window: Any, now: Any, seen: dict[str, float]) -> None:
    from PySide6.QtCore import QTimer

    waiting = set(window.page.three_views.views)

    def painted(name: str) -> None:
        waiting.discard(name)
        if not waiting:
            now("three views")

    for name, view in window.page.three_views.views.items():
        if (swapped := getattr(view._plotter, "frameSwapped", None)) is not None:
            swapped.connect(lambda name=name: painted(name))
        else:
            render = view._render
            view._render = lambda render=render, name=name: (render(), painted(name))

    def look() -> None:
        if not waiting and window.session.results.coarsened is not None:
            now("three bodies")
            print(json.dumps(seen), flush=True)
            os._exit(0)

    timer = QTimer(window, interval=10)
    timer.timeout.connect(look)
    timer.start()


if __name__ == "__main__":
    main()
