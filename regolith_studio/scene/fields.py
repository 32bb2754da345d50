"""A field on the sphere, and the particle whose radii it makes, in the same colours."""

from typing import Any

import numpy as np
import pyvista as pv

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.scene import annotations, palette
from regolith_studio.scene.extras import show_named
from regolith_studio.scene.palette import Surroundings
from regolith_studio.scene.surfaces import smooth_surface

FIELD = "field"


def show_field(
    plotter: Any,
    mesh: Mesh,
    values: FloatArray,
    span: float,
    surroundings: Surroundings = palette.LIGHT,
    scale: str = "",
) -> None:
    """A surface coloured by the values at its vertices.

    Parameters
    ----------
    values
        Shape (n,); blue below zero, red above.
    span
        Value at the ends of the colour map.
    scale
        Format of the numbers at the scale, such as ``%.2g``; no scale if empty.
    """
    surface = smooth_surface(mesh)
    surface.point_data["field"] = np.asarray(values, dtype=np.float32)
    actor = show_named(plotter, FIELD, surface, "#ffffff")
    actor.prop.interpolation = "Phong"
    mapper = actor.mapper
    reach = span if span > 0.0 else 1.0
    mapper.lookup_table = pv.LookupTable(palette.ERROR_MAP, scalar_range=(-reach, reach))
    mapper.scalar_range = (-reach, reach)
    mapper.scalar_visibility = True
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("field")
    annotations.hide_colour_scale(plotter)
    if scale:
        annotations.show_colour_scale(plotter, mapper, surroundings, scale)
