"""The three views side by side, for a file or a browser, and measured particles above drawn ones."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike, NDArray

from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.scene import annotations, cameras, instancing, palette, plotter_setup, surfaces
from regolith_studio.scene.cameras import CameraPose, Vector, framing_pose
from regolith_studio.scene.shapes import NAMES, PARTICLE, SceneShape
from regolith_studio.scene.surfaces import smooth_surface

Picture = NDArray[np.uint8]

VIEW_SIZE = (620, 560)
"""Width and height of one view in pixels."""


def three_views(
    particle: Mesh,
    fit: Mesh,
    polyhedron: ConvexPolyhedron | CoarseningResult,
    titles: tuple[str, str, str],
    path: Path | None = None,
    direction: str = "isometric",
    scale: int = 1,
    pose: CameraPose | None = None,
    transparent: bool = False,
) -> Picture:
    """Particle, fit and polyhedron side by side under one camera pose.

    - ``particle``, ``fit``, ``polyhedron``: in the particle's frame, in micrometres; a
      :class:`CoarseningResult` knows where its polyhedron lies.
    - ``titles``: one line over each view.
    - ``path``: PNG file to write; nothing is written if not given.
    - ``direction``: a key of :data:`regolith_studio.scene.cameras.DIRECTIONS`.
    - ``scale``: whole factor on the size in pixels, of letters and lines too.
    - ``pose``: where the cameras stand, instead of a standard direction.
    - ``transparent``: whether the background is left out; the picture then has four channels.

    Returns the picture, shape (height, width, 3 or 4), uint8.
    """
    plotter_setup.choose_off_screen_window()
    width, height = (scale * each for each in VIEW_SIZE)
    plotter = pv.Plotter(off_screen=True, shape=(1, 3), window_size=[3 * width, height], border=False)
    try:
        pose = pose or cameras.framing_pose(particle.vertices, direction, width / height)
        bars = []
        for column, title in enumerate(titles):
            plotter.subplot(0, column)
            plotter_setup.set_stage(plotter, palette.PAPER)
            plotter.renderer.SetGradientBackground(not transparent)
            _fill(plotter, column, particle, fit, polyhedron)
            surfaces.widen_lines(plotter, scale)
            annotations.show_title(plotter, title, size=11 * scale)
            bars.append(annotations.ScaleBar(plotter, palette.PAPER, factor=scale))
            cameras.apply_pose(plotter, pose)
        picture = plotter.screenshot(path, return_img=True, transparent_background=transparent)
        for bar in bars:
            bar.remove()
    finally:
        plotter.close()
    return np.array(picture, dtype=np.uint8)


def heap_picture(
    shapes: Sequence[Sequence[FloatArray]],
    pile: ParticleState,
    test: LiftingCylinderTest,
    title: str,
    path: Path,
) -> None:
    """Draw a heap on its plate into a PNG file.

    ``shapes``: vertices of the convex parts of each unit-volume shape, each of shape (k, 3). ``title``: one
    line over the picture.
    """
    plotter_setup.choose_off_screen_window()
    width, height = 2 * VIEW_SIZE[0], VIEW_SIZE[1]
    plotter = pv.Plotter(off_screen=True, window_size=[width, height])
    try:
        plotter_setup.set_stage(plotter, palette.PAPER)
        reach = 1.1 * float(np.hypot(pile.points[:, 0], pile.points[:, 1]).max())
        instancing.show_heap(plotter, shapes, pile)
        instancing.show_apparatus(plotter, pile, test.diameter, test.height, reach, palette.PAPER)
        annotations.show_title(plotter, title)
        corners = instancing.box_corners(reach / np.sqrt(2.0), float(pile.points[:, 2].max()))
        pose = cameras.framing_pose(corners, "isometric", width / height)
        cameras.apply_pose(plotter, cameras.filled(pose, corners, width / height))
        plotter.screenshot(path)
    finally:
        plotter.close()


def _fill(
    plotter: pv.Plotter,
    column: int,
    particle: Mesh,
    fit: Mesh,
    polyhedron: ConvexPolyhedron | CoarseningResult,
) -> None:
    if column == 0:
        surfaces.show_particle(plotter, particle)
    elif column == 1:
        surfaces.show_fit(plotter, fit)
    elif isinstance(polyhedron, CoarseningResult):
        surfaces.show_polyhedron(plotter, polyhedron.polyhedron, polyhedron.centre, palette.PAPER)
    else:
        surfaces.show_polyhedron(plotter, polyhedron, surroundings=palette.PAPER)


def view_titles(
    particle: str, l_max: int, polyhedron: ConvexPolyhedron | CoarseningResult
) -> tuple[str, str, str]:
    """The titles that the window and the figures share; facets are not triangles, so both are named."""
    return (
        particle,
        f"Spherical-harmonics fit, l_max = {l_max}",
        f"Polyhedron, {polyhedron.n_facets} facets "
        f"({polyhedron.n_vertices} vertices, {polyhedron.n_triangles} triangles)",
    )


class SideBySide:
    """Three renderers of one window under one camera; belongs to the thread that made it."""

    def __init__(self) -> None:
        plotter_setup.choose_off_screen_window()
        size = [1500, 500]  # until a browser changes it
        plotter = pv.Plotter(off_screen=True, shape=(1, 3), window_size=size, border=False)
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


ROWS = ("measured", "drawn")
_MATERIALS = (palette.PARTICLE_MATERIAL, palette.FIT_MATERIAL)
SPACING = 1.12
"""Distance of neighbours as a multiple of the largest diameter."""


def show_gallery(plotter: Any, measured: Sequence[Mesh], drawn: Sequence[Mesh]) -> None:
    """Put both rows on stage; what was there before goes. Rows lie in the plane of x and z."""
    for name in list(plotter.actors):
        if name in ROWS:
            plotter.remove_actor(name, render=False)
    pitch = _pitch([*measured, *drawn])
    for row, (name, material, meshes) in enumerate(zip(ROWS, _MATERIALS, (measured, drawn), strict=True)):
        if not meshes:
            continue
        actor = plotter.add_mesh(
            smooth_surface(_row(meshes, row, pitch)),
            name=name,
            color=material.colour,
            ambient=material.ambient,
            diffuse=material.diffuse,
            specular=material.specular,
            specular_power=material.specular_power,
            show_scalar_bar=False,
            reset_camera=False,
            render=False,
        )
        actor.prop.interpolation = "Phong"


def gallery_pose(
    measured: Sequence[Mesh], drawn: Sequence[Mesh], aspect: float, foot: float = 0.0
) -> CameraPose:
    """The pose from the front that fills a picture of this width over height with both rows.

    ``foot``: share of the height that stays free below them, for the scale bar.
    """
    pitch = _pitch([*measured, *drawn])
    columns = max(len(measured), len(drawn), 1)
    rows = [row for row, meshes in enumerate((measured, drawn)) if meshes] or [0]
    low = np.array([-0.5, -0.5, -max(rows) - 0.5]) * pitch
    high = np.array([columns - 0.5, 0.5, -min(rows) + 0.5]) * pitch
    width, _, height = high - low
    pose = framing_pose(np.array([low, high]), "front", aspect)
    scale = float(max(height / (1.0 - foot), width / max(aspect, 1e-3)) / 2)
    down = np.array([0.0, 0.0, max(0.0, 2.0 * scale * foot - (scale - height / 2))])
    return replace(
        pose,
        parallel_scale=scale,
        position=_lowered(pose.position, down),
        focal_point=_lowered(pose.focal_point, down),
    )


def _lowered(place: Vector, down: FloatArray) -> Vector:
    x, y, z = np.asarray(place) - down
    return float(x), float(y), float(z)


def _pitch(meshes: Sequence[Mesh]) -> float:
    return SPACING * max((float(np.ptp(mesh.bounds, axis=0).max()) for mesh in meshes), default=1.0)


def _row(meshes: Sequence[Mesh], row: int, pitch: float) -> Mesh:
    """All particles of a row as one mesh."""
    vertices, faces, count = [], [], 0
    for column, mesh in enumerate(meshes):
        vertices.append(mesh.vertices - mesh.bounds.mean(axis=0) + [column * pitch, 0.0, -row * pitch])
        faces.append(mesh.faces + count)
        count += len(mesh.vertices)
    return Mesh(np.concatenate(vertices), np.concatenate(faces))
