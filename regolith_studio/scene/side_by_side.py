"""Particle, fit and polyhedron side by side in one off-screen window, for a browser."""

from typing import Any, cast

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.scene import annotations, cameras, palette, plotter_setup, surfaces
from regolith_studio.scene.shapes import NAMES, PARTICLE, SceneShape


class SideBySide:
    """Three renderers of one window under one camera; belongs to the thread that made it.

    Parameters
    ----------
    size
        Width and height of the window in pixels; a browser changes it.
    """

    def __init__(self, size: tuple[int, int] = (1500, 500)) -> None:
        plotter_setup.choose_off_screen_window()
        plotter = pv.Plotter(off_screen=True, shape=(1, 3), window_size=list(size), border=False)
        self.plotter = cast(Any, plotter)  # pyvista's decorators hide the signatures of its methods
        self._bars = []
        for column in range(len(NAMES)):
            self.plotter.subplot(0, column)
            plotter_setup.set_stage(self.plotter, palette.LIGHT)
            self._bars.append(annotations.ScaleBar(self.plotter))
        self.plotter.link_views()
        plotter_setup.smooth_edges(self.plotter)
        self.plotter.enable_trackball_style()
        self._aspect = self._view_aspect()
        for renderer in self.plotter.renderers:
            annotations.before_each_picture(renderer, self)

    @property
    def render_window(self) -> Any:
        """The vtkRenderWindow."""
        return self.plotter.render_window

    def update(self) -> None:
        """Fit the camera to the size of the views and to all three bodies; called before each picture."""
        aspect = self._view_aspect()
        if aspect != self._aspect:
            pose = cameras.refitted(cameras.pose_of(self.plotter), self._aspect, aspect)
            self.plotter.camera.SetParallelScale(pose.parallel_scale)
            self._aspect = aspect
        bounds = np.array([each.ComputeVisiblePropBounds() for each in self.plotter.renderers])
        bounds = bounds[bounds[:, 0] <= bounds[:, 1]]  # the other way round, nothing is shown
        if len(bounds):
            low, high = bounds[:, ::2].min(axis=0), bounds[:, 1::2].max(axis=0)
            self.plotter.renderer.ResetCameraClippingRange(*np.column_stack([low, high]).ravel())

    def frame(self, points: ArrayLike) -> None:
        """Let points, in micrometres, fill each view however they are turned."""
        self._aspect = self._view_aspect()
        cameras.apply_pose(self.plotter, cameras.framing_pose(points, aspect=self._aspect, turning=True))

    def show(self, shape: SceneShape) -> None:
        """Show a body in its view."""
        self.plotter.subplot(0, NAMES.index(shape.name))
        if not isinstance(shape.surface, Mesh):
            surfaces.show_polyhedron(self.plotter, shape.surface, shape.origin)
        elif shape.name == PARTICLE:
            surfaces.show_particle(self.plotter, shape.surface)
        else:
            surfaces.show_fit(self.plotter, shape.surface)

    def clear(self, name: str) -> None:
        """Show nothing in the view called `name`."""
        self.plotter.subplot(0, NAMES.index(name))
        surfaces.clear(self.plotter)

    def _view_aspect(self) -> float:
        """Width of one view over its height."""
        width, height = self.render_window.GetSize()
        return float(width / len(NAMES) / max(height, 1))

    def close(self) -> None:
        """Free the window."""
        for bar in self._bars:
            bar.remove()
        self.plotter.close()
