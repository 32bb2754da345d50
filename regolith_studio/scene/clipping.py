"""A cross-section: the half towards the viewer is removed, the cut is filled, outlines are overlaid."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersGeneral import vtkContourTriangulator

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.cross_section import CrossSection, plane_axes
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import OrientedBox
from regolith_studio.messages import N_
from regolith_studio.scene import palette
from regolith_studio.scene.overlays import hide_named, show_named
from regolith_studio.scene.palette import ThemeColors

CAP = "section_cap"
CUT = "section_cut_"
FRAME = "section_frame"
DIRECTIONS = {
    "x": N_("along x"),
    "y": N_("along y"),
    "z": N_("along z"),
    "longest": N_("along Dₘₐₓ"),
    "intermediate": N_("along Dᵢₙₜ"),
    "shortest": N_("along Dₘᵢₙ"),
    "eye": N_("towards the viewer"),
}
"""Directions a section can be moved in; those of the box are its edges."""
SHADE = 0.84
"""Brightness of a cut against that of its surface."""
NEARER = (-1.0, -1.0)
"""Polygon offset of a cap over another in the same plane: half-way from VTK's usual one to that of lines."""
FRAME_SHARE = 1.08
"""Half the edge of the frame over the radius of the particle."""


@dataclass(frozen=True)
class SectionPlane:
    """The plane <n, x> = `offset`; points with a larger <n, x> are removed.

    ``normal``: unit vector, towards what is taken away.
    """

    normal: tuple[float, float, float]
    offset: float

    def as_clip(self) -> vtkPlane:
        """For :func:`regolith_studio.scene.comparison.clip`."""
        plane = vtkPlane()
        plane.SetNormal(*(-np.asarray(self.normal)))
        plane.SetOrigin(*(self.offset * np.asarray(self.normal)))
        return plane


def normals_of(box: OrientedBox | None) -> dict[str, FloatArray]:
    """Unit normals a section can have, by the keys of :data:`DIRECTIONS`; those of a box if there is one."""
    axes = dict(zip("xyz", np.eye(3), strict=True))
    if box is not None:
        axes |= dict(zip(("longest", "intermediate", "shortest"), np.asarray(box.axes), strict=True))
    return axes


def frame_corners(mesh: Mesh, plane: SectionPlane) -> FloatArray:
    """Corners of a square in the plane that is a little larger than the particle, shape (4, 3)."""
    normal = np.asarray(plane.normal)
    middle = mesh.bounds.mean(axis=0)
    reach = FRAME_SHARE * float(np.linalg.norm(mesh.vertices - middle, axis=1).max())
    centre = middle + (plane.offset - middle @ normal) * normal
    across, up = plane_axes(normal)
    return np.array([centre + reach * (a * across + b * up) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def reach_along(mesh: Mesh, normal: ArrayLike) -> tuple[float, float]:
    """Lowest and highest offset at which a plane meets the mesh."""
    heights = mesh.vertices @ np.asarray(normal, dtype=np.float64)
    return float(heights.min()), float(heights.max())


def show_cap(
    plotter: Any, cut: CrossSection | None, colour: str, layer: str = "", opacity: float = 1.0
) -> None:
    """The cut, filled; holes stay holes. A cap of another layer lies over that of the first one."""
    name = layer + CAP
    if cut is None or not len(cut.segments):
        hide_named(plotter, name)
        return
    filled = vtkContourTriangulator()
    filled.SetInputData(_lines(cut))
    filled.Update()
    actor = show_named(plotter, name, pv.wrap(filled.GetOutput()), _shaded(colour))
    actor.prop.lighting = False
    actor.prop.opacity = opacity
    actor.mapper.resolve = "polygon_offset"
    if layer:
        actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(*NEARER)


def show_cut(plotter: Any, shape: str, cut: CrossSection | None, colour: str) -> None:
    """The outline of one body in the plane of the section."""
    if cut is None or not len(cut.segments):
        hide_named(plotter, CUT + shape)
        return
    actor = show_named(plotter, CUT + shape, _lines(cut), colour, line_width=2.6)
    actor.prop.lighting = False


def show_frame(plotter: Any, corners: FloatArray | None, surroundings: ThemeColors = palette.LIGHT) -> None:
    """The square that stands for the plane, or none."""
    if corners is None:
        hide_named(plotter, FRAME)
        return
    data = pv.PolyData(np.array(corners), lines=np.array([5, 0, 1, 2, 3, 0]))
    actor = show_named(plotter, FRAME, data, surroundings.ink, line_width=1.4)
    actor.prop.lighting = False


def _lines(cut: CrossSection) -> pv.PolyData:
    pieces = np.column_stack([np.full(len(cut.segments), 2), cut.segments]).ravel()
    return pv.PolyData(np.array(cut.points), lines=pieces)


def _shaded(colour: str) -> str:
    shaded: str = pv.Color([SHADE * part for part in pv.Color(colour).float_rgb]).hex_rgb
    return shaded
