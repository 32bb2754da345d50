"""Another body over the one that is shown, or beside it along a line, and both cut by a plane."""

from collections.abc import Mapping
from typing import Any

from regolith_studio.geometry.cross_section import CrossSection
from regolith_studio.scene import extras, palette, sectioning
from regolith_studio.scene.divider import Divider, clip
from regolith_studio.scene.palette import Surroundings
from regolith_studio.scene.sectioning import SectionPlane
from regolith_studio.scene.shapes import MATERIALS, SceneShape, show_shape
from regolith_studio.scene.surfaces import OUTLINE, SURFACE

OTHER = "other_"
"""Layer of the body that is compared with."""
VEIL = 0.28
"""Opacity of a body over another."""


def show_other(
    plotter: Any, other: SceneShape | None, overlay: bool, surroundings: Surroundings = palette.LIGHT
) -> None:
    """The body that is compared with, as a veil or solid; or none."""
    show_shape(plotter, other, surroundings, OTHER, VEIL if overlay else 1.0)


def show_cuts(
    plotter: Any,
    own: str,
    other: str,
    cuts: Mapping[str, CrossSection],
    colours: Mapping[str, str],
) -> None:
    """Fill the cuts of the bodies that are shown, and draw the outlines of all.

    Parameters
    ----------
    own, other
        Names of the bodies, empty for none.
    cuts
        By the name of the body.
    colours
        Of the outlines.
    """
    for name, layer in ((own, ""), (other, OTHER)):
        cut = cuts.get(name) if name else None
        sectioning.show_cap(plotter, cut, MATERIALS[name].colour if name else "", layer)
    for name, colour in colours.items():
        sectioning.show_cut(plotter, name, cuts.get(name), colour)


def arrange(plotter: Any, divider: Divider, wipe: bool, overlay: bool, section: SectionPlane | None) -> None:
    """Clip everything that is shown by the line of the wipe and by the plane of the section.

    With overlay and wipe together the veil begins at the line.
    """
    cutting = [section.as_clip()] if section is not None else []
    own = [divider.left] if wipe and not overlay else []
    other = [divider.right] if wipe else []
    divider.set_shown(wipe)
    clip(plotter, (SURFACE, OUTLINE, extras.HIDDEN), *cutting, *own)
    clip(plotter, (sectioning.CAP,), *own)
    clip(plotter, (OTHER + SURFACE, OTHER + OUTLINE), *cutting, *other)
    clip(plotter, (OTHER + sectioning.CAP,), *other)
