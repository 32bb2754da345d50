"""One facet of a polyhedron: the one at a point of the picture, its properties, its outline."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkRenderingCore import vtkTextActor

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.scene import palette
from regolith_studio.scene.overlays import hide_named, show_named
from regolith_studio.scene.palette import ThemeColors

FACET, NUMBER = "facet", "facet_number"
LIFT = 0.002
"""Distance of the outline from its facet, as a share of the facet's size."""


@dataclass(frozen=True, eq=False)
class Facet:
    """One facet in numbers.

    - ``index``: from 0, in the order of the half-spaces; those of a compound are numbered through.
    - ``count``: facets of the polyhedron, or of all parts.
    - ``area``, ``share``: in the unit of the polyhedron squared, and of its surface; of a compound what is
      exposed.
    - ``normal``: outward unit normal, shape (3,).
    - ``offset``: distance of the plane from the polyhedron's origin.
    - ``outline``: ends of the edges of what is exposed, shape (m, 2, 3), about the polyhedron's origin.
    - ``middle``: a point of what is exposed, shape (3,).
    - ``part``: of a compound, from 0.
    """

    index: int
    count: int
    area: float
    share: float
    normal: FloatArray
    offset: float
    outline: FloatArray
    middle: FloatArray
    part: int | None = None


def facet_of(polyhedron: Polyhedron, index: int) -> Facet:
    """The facet number `index` of a polyhedron."""
    if isinstance(polyhedron, ConvexCompound):
        return _exposed_facet(polyhedron, index)
    areas, corners = polyhedron.facet_areas, polyhedron.vertices[list(polyhedron.facets[index])]
    return Facet(
        index,
        polyhedron.n_facets,
        float(areas[index]),
        float(areas[index] / areas.sum()),
        np.asarray(polyhedron.half_spaces.normals[index]),
        float(polyhedron.half_spaces.offsets[index]),
        np.stack([corners, np.roll(corners, -1, axis=0)], axis=1),
        corners.mean(axis=0),
    )


def _exposed_facet(compound: ConvexCompound, index: int) -> Facet:
    """What the union shows of a facet; its edges are those of one of its triangles alone."""
    mesh, areas = compound.mesh, compound.exposed_areas
    faces = mesh.faces[compound.triangle_facets == index]
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    _, first, uses = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_counts=True)
    corners = mesh.vertices[faces]
    sizes = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    normals, offsets = (np.concatenate(each) for each in zip(*compound.part_planes, strict=True))
    return Facet(
        index,
        compound.n_facets,
        float(areas[index]),
        float(areas[index] / areas.sum()),
        normals[index],
        float(offsets[index]),
        mesh.vertices[ends[first[uses == 1]]],
        corners[sizes.argmax()].mean(axis=0),
        int(compound.facet_parts[index]),
    )


def facet_met(polyhedron: Polyhedron, start: ArrayLike, direction: ArrayLike) -> tuple[int, float] | None:
    """The facet through which a ray enters a polyhedron from outside, and how far away; about its own origin.

    A union of convex parts is entered where the first of them is.
    """
    if not isinstance(polyhedron, ConvexCompound):
        planes = polyhedron.half_spaces
        return _plane_met(planes.normals, planes.offsets, start, direction)
    hits, first = [], 0
    for normals, offsets in polyhedron.part_planes:
        hit = _plane_met(normals, offsets, start, direction)
        if hit is not None:
            hits.append((first + hit[0], hit[1]))
        first += len(offsets)
    return min(hits, key=lambda hit: hit[1], default=None)


def _plane_met(
    normals: FloatArray, offsets: FloatArray, start: ArrayLike, direction: ArrayLike
) -> tuple[int, float] | None:
    """The plane through which a ray enters a convex body, and how far away.

    The last plane that is passed on the way in, if that is before the first on the way out (Cyrus and
    Beck).
    """
    speed = normals @ np.asarray(direction, dtype=np.float64)
    room = offsets - normals @ np.asarray(start, dtype=np.float64)
    if (room[speed == 0.0] < 0.0).any():
        return None
    reach = np.divide(room, speed, out=np.zeros_like(room), where=speed != 0.0)
    inward = np.flatnonzero(speed < 0.0)
    entry = int(inward[reach[inward].argmax()])
    leaves = reach[speed > 0.0].min()
    return (entry, float(reach[entry])) if 0.0 <= reach[entry] <= leaves else None


def show_facet(
    plotter: Any,
    facet: Facet | None,
    centre: ArrayLike = (0.0, 0.0, 0.0),
    surroundings: ThemeColors = palette.LIGHT,
) -> None:
    """Outline one facet and write its number upon it, counted from 1; or no facet.

    ``centre``: where the polyhedron's origin lies.
    """
    if facet is None:
        hide_named(plotter, FACET)
        hide_named(plotter, NUMBER)
        return
    origin, ends = np.asarray(centre, dtype=np.float64), facet.outline.reshape(-1, 3)
    size = float(np.ptp(ends, axis=0).max())
    lines = np.insert(np.arange(len(ends)), np.arange(0, len(ends), 2), 2)
    outline = pv.PolyData(ends + origin + LIFT * size * facet.normal, lines=lines)
    show_named(plotter, FACET, outline, palette.HIDDEN_COLOUR, line_width=4.0).prop.lighting = False
    _show_number(plotter, str(facet.index + 1), facet.middle + origin, surroundings)


def _show_number(plotter: Any, text: str, place: FloatArray, surroundings: ThemeColors) -> None:
    """In front of everything: letters that face the eye would sink into a facet that does not."""
    label = plotter.actors.get(NUMBER)
    if label is None:
        label = vtkTextActor()
        label.GetPositionCoordinate().SetCoordinateSystemToWorld()
        prop = label.GetTextProperty()
        prop.SetFontSize(17)
        prop.SetBold(True)
        prop.SetFontFamilyToArial()
        prop.SetJustificationToCentered()
        prop.SetVerticalJustificationToCentered()
        plotter.add_actor(label, name=NUMBER, reset_camera=False, render=False)
    label.SetInput(text)
    label.GetPositionCoordinate().SetValue(*place)
    label.GetTextProperty().SetColor(*pv.Color(surroundings.outline).float_rgb)
    label.SetVisibility(True)
