"""Fig. 2: a particle and its expansion cut at several degrees, drawn without OpenGL."""

from collections.abc import Mapping
from math import ceil
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.studies.figures.files import write_figure
from regolith_studio.studies.figures.polyhedron_gallery import LIGHT, VIEW

N_COLUMNS = 4
CELL = 1.9
"""Inches."""
COLOUR = np.array([0.62, 0.66, 0.71])


def degree_figure(surfaces: Mapping[str, Mesh | None]) -> Figure:
    """Each surface under its title, all at one scale; an empty place says that the radius is negative."""
    columns = min(N_COLUMNS, len(surfaces))
    rows = ceil(len(surfaces) / columns)
    figure = Figure(figsize=(CELL * columns, (CELL + 0.2) * rows), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False).flat)
    flat = [mesh.vertices @ VIEW[:2].T for mesh in surfaces.values() if mesh is not None]
    low = np.min([each.min(axis=0) for each in flat], axis=0)
    high = np.max([each.max(axis=0) for each in flat], axis=0)
    middle, reach = (low + high) / 2, 0.53 * float((high - low).max())
    for axis, (title, mesh) in zip(axes, surfaces.items(), strict=False):
        axis.set_title(title, fontsize=8)
        if mesh is None:
            axis.text(0.5, 0.5, "the radius is negative", ha="center", fontsize=7, transform=axis.transAxes)
        else:
            draw_shaded(axis, mesh)
        axis.set_xlim(middle[0] - reach, middle[0] + reach)
        axis.set_ylim(middle[1] - reach, middle[1] + reach)
    for axis in axes:
        axis.set_aspect("equal")
        axis.set_axis_off()
    return figure


def draw_shaded(axis: Axes, mesh: Mesh) -> None:
    """The triangles that are turned to the eye, the farthest first, lit by one lamp."""
    normals = mesh.face_area_vectors @ VIEW.T
    lengths = np.linalg.norm(normals, axis=1)
    seen = np.flatnonzero(normals[:, 2] > 1e-9 * lengths)
    corners = mesh.triangles[seen] @ VIEW.T
    order = np.argsort(corners[:, :, 2].mean(axis=1), kind="stable")
    light = (normals[seen] / lengths[seen, None]) @ (LIGHT / np.linalg.norm(LIGHT))
    brightness = 0.35 + 0.65 * np.clip(light, 0.0, 1.0)
    colours = np.clip(brightness[order, None] * COLOUR, 0.0, 1.0)
    outlines = corners[order, :, :2]
    axis.add_collection(
        PolyCollection(
            list(outlines), facecolors=colours, edgecolors=colours, linewidths=0.3, rasterized=True
        )
    )


def write_degrees(surfaces: Mapping[str, Mesh | None], folder: Path) -> tuple[Path, Path]:
    """``degrees.png`` and ``degrees.svg``."""
    return write_figure(degree_figure(surfaces), folder, "degrees")
