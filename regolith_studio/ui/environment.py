"""Looks whether this machine can show a window, before Qt is asked and aborts the process."""

import os
import sys
from collections.abc import Mapping

from regolith_studio.errors import EnvironmentProblem

_NEEDS_NO_DISPLAY = ("offscreen", "minimal", "vnc", "linuxfb", "eglfs")


def check_display(environment: Mapping[str, str] | None = None, platform: str = sys.platform) -> None:
    """Make sure that a window can be opened.

    Raises
    ------
    EnvironmentProblem
        If there is no display.
    """
    given = os.environ if environment is None else environment
    if not platform.startswith("linux"):
        return
    if given.get("QT_QPA_PLATFORM", "").split(":")[0] in _NEEDS_NO_DISPLAY:
        return
    if not (given.get("DISPLAY") or given.get("WAYLAND_DISPLAY")):
        raise EnvironmentProblem(
            "There is no display to open a window on (DISPLAY and WAYLAND_DISPLAY are not set); "
            "the commands work without one, for example: regolith-studio demo -o DIR"
        )
