"""Selects the backend that draws the views on this machine."""

import os
from typing import TYPE_CHECKING

from PySide6.QtGui import QGuiApplication, QOffscreenSurface, QOpenGLContext, QSurfaceFormat
from PySide6.QtWidgets import QWidget

from regolith_studio.scene.palette import LIGHT, ThemeColors

if TYPE_CHECKING:  # geometry and its compiler: the splash is shown before they are there
    from regolith_studio.ui.views.view import SceneView

VARIABLE = "REGOLITH_STUDIO_VIEWS"
"""Environment variable that asks for ``live`` or ``image``."""
_WITHOUT_OPENGL = ("offscreen", "minimal", "vnc", "linuxfb")


def make_view(kind: str, surroundings: ThemeColors = LIGHT, parent: QWidget | None = None) -> "SceneView":
    """A view of the kind ``live`` or ``image``."""
    if kind == "image":
        from regolith_studio.ui.views.image_view import ImageView

        return ImageView(surroundings, parent)
    from regolith_studio.ui.views.live_view import LiveView

    return LiveView(surroundings, parent)


def best_kind() -> str:
    """``live`` where a window can hold an OpenGL 3.2 context, else ``image``, unless the variable says."""
    asked = os.environ.get(VARIABLE, "")
    if asked in ("live", "image"):
        return asked
    if QGuiApplication.platformName() in _WITHOUT_OPENGL:
        return "image"
    return "live" if _has_opengl() else "image"


def surface_format() -> QSurfaceFormat:
    """Desktop OpenGL 3.2 core, as VTK needs it; edges are smoothed by VTK, not by the window."""
    wanted = QSurfaceFormat()
    wanted.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
    wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    wanted.setVersion(3, 2)
    wanted.setSwapBehavior(QSurfaceFormat.SwapBehavior.DoubleBuffer)
    wanted.setDepthBufferSize(8)
    wanted.setAlphaBufferSize(8)
    wanted.setStencilBufferSize(0)
    wanted.setSamples(0)
    return wanted


def _has_opengl() -> bool:
    surface = QOffscreenSurface()
    surface.setFormat(surface_format())
    surface.create()
    context = QOpenGLContext()
    context.setFormat(surface_format())
    works = context.create() and surface.isValid() and context.makeCurrent(surface)
    if works:
        works = context.format().version() >= (3, 2)
        context.doneCurrent()
    return bool(works)
