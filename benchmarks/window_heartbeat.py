"""Whether the thread of the window answers: how long what comes from outside, as mouse and keys do, waits."""

import signal
import socket
import struct
import subprocess
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from types import FrameType
from typing import Any

INTERVAL = 0.005
"""Seconds between two beats."""
_STAMP = struct.Struct("<d")
_SENDER = """
import socket, struct, sys, time
with socket.create_connection(("127.0.0.1", int(sys.argv[1]))) as line:
    while True:
        line.sendall(struct.pack("<d", time.perf_counter()))
        time.sleep(float(sys.argv[2]))
"""
DRAWS = "ImageView._render"
"""Where views draw; live views draw inside VTK's own widget and are not told apart."""
LATE = 0.050
"""Seconds after which somebody looks what the thread is doing, and again after :data:`LOOK`."""
LOOK = 0.010


@dataclass
class Gap:
    """The time for which a beat has waited.

    Parameters
    ----------
    began, seconds
        When it was sent (of :func:`time.perf_counter`), and how long it waited.
    drawing
        How much of that views have drawn.
    places
        Functions of the program that the thread was seen in meanwhile, innermost first, and how often.
    """

    began: float
    seconds: float
    drawing: float = 0.0
    places: Counter[str] = field(default_factory=Counter)

    def __str__(self) -> str:
        where = next((place for place, _ in self.places.most_common() if DRAWS not in place), "")
        return f"{1e3 * self.apart:4.0f} ms (and {1e3 * self.drawing:.0f} ms of drawing)  {where}"

    @property
    def apart(self) -> float:
        """Seconds apart from drawing."""
        return self.seconds - self.drawing


class Heartbeat:
    """Beats that another process sends to the main thread, that of the window, while an alarm looks whether
    they are heard; a context.

    They come the way that mouse and keys come from the X server, and no thread of this process need hold the
    interpreter to send them. A timer of the window would wait longer than these: between two timers that are
    due others go first. The alarm is a signal: no other thread may hold frames, as a widget could lose its
    last reference there. Where there are no such signals the gaps have no places.
    """

    def __init__(self) -> None:
        self._seen: Counter[str] = Counter()
        self._drawing = self._since = 0.0
        self._gaps: list[Gap] = []

    def __enter__(self) -> "Heartbeat":
        from regolith_studio.ui.views.image_view import ImageView

        self._render: Any = ImageView._render

        def timed(view: ImageView) -> None:
            began = time.perf_counter()
            self._render(view)
            self._drawing += time.perf_counter() - began

        patched: Any = ImageView
        patched._render = timed
        if hasattr(signal, "setitimer"):
            signal.signal(signal.SIGALRM, self._look)
        self._begin()
        self.restart()
        return self

    def __exit__(self, *_error: object) -> None:
        from regolith_studio.ui.views.image_view import ImageView

        patched: Any = ImageView
        patched._render = self._render
        self._heard.setEnabled(False)
        self._sender.kill()
        self._sender.wait()
        self._line.close()
        if hasattr(signal, "setitimer"):
            _set_alarm(0.0)
            signal.signal(signal.SIGALRM, signal.SIG_DFL)

    def restart(self) -> None:
        """Forget all gaps, and beats that were sent before."""
        self._gaps, self._since, self._drawing = [], time.perf_counter(), 0.0
        self._seen.clear()

    def gaps(self, longer: float = 0.0) -> list[Gap]:
        """The gaps since the restart longer than so many seconds apart from drawing, longest first."""
        found = [gap for gap in self._gaps if gap.apart > longer]
        return sorted(found, key=lambda gap: -gap.apart)

    @property
    def longest(self) -> Gap:
        """The longest gap since the restart."""
        return max(self._gaps, key=lambda gap: gap.seconds, default=Gap(self._since, 0.0))

    def _begin(self) -> None:
        from PySide6.QtCore import QSocketNotifier

        with socket.create_server(("127.0.0.1", 0)) as server:
            asked = [sys.executable, "-c", _SENDER, str(server.getsockname()[1]), str(INTERVAL)]
            self._sender = subprocess.Popen(asked, stderr=subprocess.DEVNULL)
            self._line, _ = server.accept()
        self._line.setblocking(False)
        self._left = b""
        self._heard = QSocketNotifier(self._line.fileno(), QSocketNotifier.Type.Read)
        self._heard.activated.connect(self._beat)

    def _beat(self) -> None:
        now = time.perf_counter()
        sent = self._left + self._line.recv(1 << 16)
        whole = len(sent) - len(sent) % _STAMP.size
        self._left = sent[whole:]
        stamps = [each for (each,) in _STAMP.iter_unpack(sent[:whole]) if each >= self._since]
        if stamps:
            self._gaps.append(Gap(stamps[0], now - stamps[0], self._drawing, Counter(self._seen)))
        self._seen.clear()
        self._drawing = 0.0
        _set_alarm(LATE)

    def _look(self, _number: int, frame: FrameType | None) -> None:
        self._seen[_place(frame)] += 1


def _set_alarm(seconds: float) -> None:
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, seconds, LOOK)


def _place(frame: FrameType | None) -> str:
    """The innermost three functions of the package on a stack, innermost first."""
    names: list[str] = []
    while frame is not None and len(names) < 3:
        code: Any = frame.f_code
        _, inside, path = code.co_filename.rpartition("regolith_studio/")
        if inside:
            names.append(f"{path.removesuffix('.py')}:{code.co_qualname}")
        frame = frame.f_back
    return " < ".join(names)
