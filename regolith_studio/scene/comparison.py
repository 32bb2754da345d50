"""Overlay and wipe: a second shape over or beside the one that is shown, both clipped by a plane."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

from regolith_studio.geometry.cross_section import CrossSection
from regolith_studio.scene import clipping, overlays, palette
from regolith_studio.scene.annotations import before_each_picture, flat_actor
from regolith_studio.scene.cameras import Projection, pose_of
from regolith_studio.scene.clipping import SectionPlane
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.scene.shapes import MATERIALS, SceneShape, show_shape
from regolith_studio.scene.surfaces import OUTLINE, SURFACE

OTHER = "other_"
"""Layer of the body that is compared with."""
VEIL = 0.28
"""Opacity of a body over another."""


def show_other(
    plotter: Any, other: SceneShape | None, overlay: bool, surroundings: ThemeColors = palette.LIGHT
) -> None:
    """The body that is compared with, as a transparent overlay or solid; or none."""
    show_shape(plotter, other, surroundings, OTHER, VEIL if overlay else 1.0)


def show_cuts(
    plotter: Any,
    own: str,
    other: str,
    cuts: Mapping[str, CrossSection],
    colours: Mapping[str, str],
    overlay: bool = False,
) -> None:
    """Fill the cuts of the bodies that are shown, and draw the outlines of all.

    - ``own``, ``other``: names of the bodies, empty for none.
    - ``cuts``: by the name of the body.
    - ``colours``: of the outlines.
    - ``overlay``: whether the other body is a transparent overlay over the own one.
    """
    for name, layer, opacity in ((own, "", 1.0), (other, OTHER, VEIL if overlay else 1.0)):
        cut = cuts.get(name) if name else None
        clipping.show_cap(plotter, cut, MATERIALS[name].colour if name else "", layer, opacity)
    for name, colour in colours.items():
        clipping.show_cut(plotter, name, cuts.get(name), colour)


def arrange(
    plotter: Any, divider: "Divider", wipe: bool, overlay: bool, section: SectionPlane | None
) -> None:
    """Clip everything that is shown by the line of the wipe and by the plane of the section.

    With overlay and wipe together the overlay begins at the line.
    """
    cutting = [section.as_clip()] if section is not None else []
    own = [divider.left] if wipe and not overlay else []
    other = [divider.right] if wipe else []
    divider.set_shown(wipe)
    clip(plotter, (SURFACE, OUTLINE, overlays.HIDDEN), *cutting, *own)
    clip(plotter, (clipping.CAP,), *own)
    clip(plotter, (OTHER + SURFACE, OTHER + OUTLINE), *cutting, *other)
    clip(plotter, (OTHER + clipping.CAP,), *other)


HANDLE = 9.0
"""Half the height of the handle in pixels."""


class Divider:
    """Two planes that follow the camera, seen edge on: what they clip ends at a line in the picture.

    ``plotter``: any pyvista plotter; the line belongs to its active renderer. ``surroundings``: whose ink it
    is drawn with.
    """

    def __init__(self, plotter: Any, surroundings: ThemeColors = palette.LIGHT) -> None:
        self._plotter, self._renderer = plotter, plotter.renderer
        self.share = 0.5
        self.left, self.right = vtkPlane(), vtkPlane()
        self._line, self._knob = pv.PolyData(), pv.PolyData()
        self._actors = (flat_actor(self._line, 1.6), flat_actor(self._knob))
        for actor in self._actors:
            self._renderer.AddViewProp(actor)
        self.set_ink(surroundings)
        self.set_shown(False)
        self._tag = before_each_picture(self._renderer, self)

    def set_ink(self, surroundings: ThemeColors) -> None:
        """Draw with another ink."""
        for actor in self._actors:
            actor.GetProperty().SetColor(*pv.Color(surroundings.ink).float_rgb)

    def set_shown(self, shown: bool) -> None:
        """Draw the line, or not."""
        for actor in self._actors:
            actor.SetVisibility(shown)

    @property
    def shown(self) -> bool:
        """Whether the line is drawn."""
        return bool(self._actors[0].GetVisibility())

    def update(self) -> None:
        """Put planes and line where camera and share say; called by itself before every picture."""
        width, height = self._renderer.GetSize()
        if not (width and height and self.shown):
            return
        sight = Projection(pose_of(self._plotter), width, height)
        x = self.share * width
        place, _ = sight.ray(x, height / 2)
        right = sight.axes[0]
        for plane, normal in ((self.left, -right), (self.right, right)):
            plane.SetOrigin(*place)
            plane.SetNormal(*normal)
        self._line.copy_from(pv.PolyData([(x, 0, 0), (x, height, 0)], lines=[2, 0, 1]))
        middle, across = height / 2, 0.6 * HANDLE
        corners = [
            (x - 3 - across, middle),
            (x - 3, middle - HANDLE),
            (x - 3, middle + HANDLE),
            (x + 3 + across, middle),
            (x + 3, middle + HANDLE),
            (x + 3, middle - HANDLE),
        ]
        points = np.array([(a, b, 0.0) for a, b in corners])
        self._knob.copy_from(pv.PolyData(points, faces=[3, 0, 1, 2, 3, 3, 4, 5]))

    def remove(self) -> None:
        """Take it out of the picture and stop listening to the renderer."""
        self._renderer.RemoveObserver(self._tag)
        for actor in self._actors:
            self._renderer.RemoveViewProp(actor)


def clip(plotter: Any, names: tuple[str, ...], *planes: vtkPlane) -> None:
    """Show of these actors only what lies on the side of the normals of all `planes`."""
    for name in names:
        actor = plotter.actors.get(name)
        if actor is not None:
            actor.mapper.RemoveAllClippingPlanes()
            for plane in planes:
                actor.mapper.AddClippingPlane(plane)
