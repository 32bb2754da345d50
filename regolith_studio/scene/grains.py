"""All grains of a segmentation in the colours of their labels."""

from collections.abc import Set
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from regolith_studio.imaging.label_surface import LabelSurface

GRAINS, OTHERS, BOX = "grains", "other grains", "box"
_FAINT = 0.12
"""Opacity of the grains that are not highlighted."""


def show_grains(
    plotter: Any,
    surface: LabelSurface | None,
    colours: NDArray[np.uint8],
    size: NDArray[np.float64],
    highlighted: Set[int] = frozenset(),
) -> None:
    """Show the surfaces of labels in the box of their volume, or the box alone.

    Parameters
    ----------
    colours
        RGB of each face, shape (m, 3).
    size
        Edges of the volume in micrometres, shape (3,).
    highlighted
        Labels that are seen through all others; with none, all are opaque.
    """
    for name in (GRAINS, OTHERS, BOX):
        plotter.remove_actor(name, render=False)
    box = pv.Box((0.0, size[0], 0.0, size[1], 0.0, size[2]))
    plotter.add_mesh(
        box, name=BOX, style="wireframe", color="grey", lighting=False, reset_camera=False, render=False
    )
    if surface is None:
        return
    chosen = np.isin(surface.labels, list(highlighted)) if highlighted else np.ones(len(surface.labels), bool)
    for name, faces, opacity in ((GRAINS, chosen, 1.0), (OTHERS, ~chosen, _FAINT)):
        if not faces.any():
            continue
        triangles: Any = surface.faces[faces]
        mesh = pv.PolyData.from_regular_faces(surface.vertices, triangles)
        mesh.cell_data["colours"] = colours[faces]
        plotter.add_mesh(
            mesh,
            name=name,
            scalars="colours",
            rgb=True,
            opacity=opacity,
            show_scalar_bar=False,
            reset_camera=False,
            render=False,
        )
