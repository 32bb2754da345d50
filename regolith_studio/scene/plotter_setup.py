"""Set up an empty plotter: background, lights, parallel projection, anti-aliasing."""

import os
import sys
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from regolith_studio.scene import palette
from regolith_studio.scene.palette import ThemeColors

Picture = NDArray[np.uint8]

SAMPLES = 4
"""Of a pixel where edges are smoothed by multi-sampling."""
_SOFTWARE_NAMES = ("llvmpipe", "softpipe", "swrast", "software", "swiftshader")


def choose_off_screen_window() -> None:
    """Let VTK draw through EGL where there is no X server, without asking for one first."""
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")


def set_stage(plotter: Any, surroundings: ThemeColors = palette.LIGHT) -> None:
    """Background, light and projection of one plotter's active renderer; no surface yet."""
    set_background(plotter, surroundings)
    plotter.enable_parallel_projection()
    plotter.remove_all_lights()
    for light in _lights():
        plotter.add_light(light)


def set_background(plotter: Any, surroundings: ThemeColors) -> None:
    """A gradient from the lower to the upper colour."""
    plotter.set_background(surroundings.background_low, top=surroundings.background_high, all_renderers=False)


def smooth_edges(plotter: Any) -> None:
    """FXAA on software OpenGL, where multi-sampling costs more than the surface; else 4 samples."""
    if is_software(plotter.render_window.ReportCapabilities() or ""):
        plotter.enable_anti_aliasing("fxaa")
    else:
        plotter.enable_anti_aliasing("msaa", multi_samples=SAMPLES)


def sample_pixels(plotter: Any, once: bool) -> None:
    """One sample a pixel in an off-screen picture, or several again; one takes less than half the time."""
    if plotter.render_window.GetOffScreenRendering():
        plotter.render_window.SetMultiSamples(0 if once else SAMPLES)


def thumbnail(plotter: Any, scale: int = 1, transparent: bool = False) -> Picture:
    """What a plotter with one renderer shows, at a multiple of its size.

    Shape (height, width, 3), or 4 with transparency, which is computed from pictures on black and on white:
    the frame buffers of windows keep none. It is put together from tiles: nothing may be shown that is laid
    out in pixels.
    """
    plotter.render_window.Render()
    if not transparent:
        return np.array(plotter.screenshot(return_img=True, scale=scale)[..., :3], dtype=np.uint8)
    renderer = plotter.renderer
    gradient, before = renderer.GetGradientBackground(), renderer.GetBackground()
    renderer.SetGradientBackground(False)
    try:
        seen = []
        for grey in (0.0, 1.0):
            renderer.SetBackground(grey, grey, grey)
            plotter.render_window.Render()
            seen.append(plotter.screenshot(return_img=True, scale=scale)[..., :3].astype(np.float64))
    finally:
        renderer.SetBackground(*before)
        renderer.SetGradientBackground(gradient)
    on_black, on_white = seen
    alpha = np.clip(1.0 - (on_white - on_black).mean(axis=2, keepdims=True) / 255.0, 0.0, 1.0)
    colour = np.clip(on_black / np.maximum(alpha, 1e-3), 0.0, 255.0)
    return np.concatenate([colour, 255.0 * alpha], axis=2).round().astype(np.uint8)


def is_software(capabilities: str) -> bool:
    """Whether an OpenGL description names a renderer that runs on the processor."""
    return any(name in capabilities.lower() for name in _SOFTWARE_NAMES)


def _lights() -> list[pv.Light]:
    """A key light over the left shoulder, a weak one from below right, a weak one from the eye."""

    key = pv.Light(light_type="camera light", intensity=0.80)
    key.position = (-0.55, 0.75, 1.0)
    fill = pv.Light(light_type="camera light", intensity=0.34)
    fill.position = (0.9, -0.5, 0.6)
    eye = pv.Light(light_type="headlight", intensity=0.22)
    return [key, fill, eye]
