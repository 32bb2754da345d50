"""Where a mesh is wrong, or was before it was mended: triangles in a colour for each kind of fault."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyvista as pv

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.scene.overlays import bring_forward, hide_named, show_named

COLOURS = {
    "filled": "#0072b2",
    "open": "#d55e00",
    "crossing": "#cc79a7",
    "turned": "#e69f00",
    "small bodies": "#56b4e9",
    "non-manifold": "#009e73",
    "double": "#b5a900",
    "degenerate": "#7b3fa0",
    "hidden": "#7d8a99",
}
"""Colour of each kind of ``defect_triangles`` and of hidden faces; later ones are drawn on top."""

SMALL = ("open", "crossing", "turned", "non-manifold", "double", "degenerate")
"""Kinds whose triangles may be slivers, so that their edges are drawn too."""


def show_faults(plotter: Any, faults: Mapping[str, FloatArray]) -> None:
    """Draw triangles (k, 3, 3) of each kind; kinds that are not among `faults` vanish."""
    for kind, colour in COLOURS.items():
        triangles = faults.get(kind)
        if triangles is None or not len(triangles):
            hide_named(plotter, f"fault {kind}")
            continue
        cells = np.column_stack([np.full(len(triangles), 3), np.arange(3 * len(triangles)).reshape(-1, 3)])
        data = pv.PolyData(np.array(triangles).reshape(-1, 3), faces=cells.ravel())
        actor = show_named(plotter, f"fault {kind}", data, colour, 1.0, line_width=2.5)
        bring_forward(actor)
        actor.prop.show_edges, actor.prop.edge_color = kind in SMALL, colour
        actor.prop.ambient = 0.45 if kind in SMALL else 0.24
