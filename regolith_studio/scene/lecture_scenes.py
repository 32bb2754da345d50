"""Scenes of the lecture: one move of the annealing; a random field on the sphere with its particle."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.scene import annotations, palette, surfaces
from regolith_studio.scene.overlays import hide_named, show_named
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.scene.surfaces import smooth_surface

FACET_OLD, FACET_NEW, FRAME_NEW = "moved_facet", "proposed_facet", "proposed_edges"
LIFT = 2e-3
"""Of a painted facet over the surface, as a share of the polyhedron's size."""


def show_move(
    plotter: Any,
    now: ConvexPolyhedron,
    facet: int | None,
    other: ConvexPolyhedron | None,
    other_facet: int | None,
    centre: ArrayLike,
    colour: str,
    surroundings: ThemeColors = palette.LIGHT,
) -> None:
    """Paint the facet that was moved, and draw the edges of the other polyhedron.

    - ``now``: after the step.
    - ``facet``: of `now`, in the plane that was moved; ``None`` if it bounds none.
    - ``other``, ``other_facet``: what it was, if the move was taken; what was proposed, if not.
    - ``centre``: where the origin of the polyhedra lies.
    - ``colour``: of what was moved.
    """
    middle = np.asarray(centre, dtype=np.float64)
    surfaces.show_polyhedron(plotter, now, middle, surroundings)
    _paint(plotter, FACET_OLD, now, facet, middle, colour, 1.0)
    _paint(plotter, FACET_NEW, other, other_facet, middle, colour, 0.35)
    if other is None:
        hide_named(plotter, FRAME_NEW)
        return
    edges = pv.PolyData(other.vertices + middle, lines=surfaces.facet_edges(other))
    show_named(plotter, FRAME_NEW, edges, colour, 0.8, line_width=1.4).prop.lighting = False


def _paint(
    plotter: Any,
    name: str,
    solid: ConvexPolyhedron | None,
    facet: int | None,
    centre: FloatArray,
    colour: str,
    opacity: float,
) -> None:
    if solid is None or facet is None:
        hide_named(plotter, name)
        return
    corners = solid.vertices[list(solid.facets[facet])] + centre
    lift = LIFT * float(np.ptp(solid.vertices, axis=0).max()) * solid.half_spaces.normals[facet]
    polygon = pv.PolyData(np.asarray(corners + lift), faces=np.array([len(corners), *range(len(corners))]))
    actor = show_named(plotter, name, polygon, colour, opacity)
    actor.prop.lighting = False


FIELD = "field"


def show_field(
    plotter: Any,
    mesh: Mesh,
    values: FloatArray,
    span: float,
    surroundings: ThemeColors = palette.LIGHT,
    write: Callable[[float], str] | None = None,
) -> None:
    """A surface coloured by the values at its vertices.

    - ``values``: shape (n,); blue below zero, red above.
    - ``span``: value at the ends of the colour map.
    - ``write``: the text of a number at the scale; there is no scale without.
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
    if write is not None:
        annotations.show_colour_scale(plotter, mapper, surroundings, write)
