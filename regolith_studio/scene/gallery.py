"""Gallery of measured particles above drawn ones, at one scale."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.scene import palette
from regolith_studio.scene.cameras import CameraPose, framing_pose
from regolith_studio.scene.surfaces import smooth_surface

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


def gallery_pose(measured: Sequence[Mesh], drawn: Sequence[Mesh], aspect: float) -> CameraPose:
    """The pose from the front that fills a picture of this width over height with both rows."""
    pitch = _pitch([*measured, *drawn])
    columns = max(len(measured), len(drawn), 1)
    rows = [row for row, meshes in enumerate((measured, drawn)) if meshes] or [0]
    low = np.array([-0.5, -0.5, -max(rows) - 0.5]) * pitch
    high = np.array([columns - 0.5, 0.5, -min(rows) + 0.5]) * pitch
    width, _, height = high - low
    pose = framing_pose(np.array([low, high]), "front", aspect)
    return replace(pose, parallel_scale=float(max(height, width / max(aspect, 1e-3)) / 2))


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
