"""All grains of a segmentation in the colours of their labels."""

from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from regolith_studio.imaging.label_surface import LabelSurface

GRAINS, BOX = "grains", "box"


def show_grains(
    plotter: Any, surface: LabelSurface | None, colours: NDArray[np.uint8], size: NDArray[np.float64]
) -> None:
    """Show the surfaces of labels in the box of their volume, or the box alone.

    Parameters
    ----------
    colours
        RGB of each face, shape (m, 3).
    size
        Edges of the volume in micrometres, shape (3,).
    """
    for name in (GRAINS, BOX):
        plotter.remove_actor(name, render=False)
    box = pv.Box((0.0, size[0], 0.0, size[1], 0.0, size[2]))
    plotter.add_mesh(
        box, name=BOX, style="wireframe", color="grey", lighting=False, reset_camera=False, render=False
    )
    if surface is None or not len(surface.faces):
        return
    faces: Any = surface.faces
    mesh = pv.PolyData.from_regular_faces(surface.vertices, faces)
    mesh.cell_data["colours"] = colours
    plotter.add_mesh(
        mesh,
        name=GRAINS,
        scalars="colours",
        rgb=True,
        show_scalar_bar=False,
        reset_camera=False,
        render=False,
    )
