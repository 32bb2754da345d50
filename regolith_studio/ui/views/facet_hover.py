"""Highlights the facet of a polyhedron below the mouse."""

from collections.abc import Callable

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_
from regolith_studio.scene import facets
from regolith_studio.scene.cameras import Projection
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.scene.shapes import SceneShape
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.protocol import SceneView


class FacetHover:
    """Outlines and numbers the facet, and reports its properties in one line.

    Parameters
    ----------
    view
        That shows the polyhedron.
    shape
        Reads what it shows.
    ink
        Reads the inks.
    is_visible
        Whether a point of the body, shape (3,), at a share of the picture's width is seen.
    report
        Receives the line, or nothing when the mouse is elsewhere.
    """

    def __init__(
        self,
        view: SceneView,
        shape: Callable[[], SceneShape | None],
        ink: Callable[[], ThemeColors],
        is_visible: Callable[[FloatArray, float], bool],
        report: Callable[[str], None],
    ) -> None:
        self._view, self._shape, self._ink, self._report = view, shape, ink, report
        self._is_visible = is_visible
        self._shown: tuple[SceneShape, int] | None = None
        view.mouse.pointed.append(self._point)
        view.mouse.left.append(self.clear)

    def clear(self) -> None:
        """Highlight no facet."""
        if self._shown is not None:
            self._shown = None
            self._view.draw(lambda plotter: facets.show_facet(plotter, None))
            self._report("")

    def _point(self, sight: Projection, x: float, y: float) -> None:
        shape = self._shape()
        if shape is None or shape.polyhedron is None:
            return
        start, direction = sight.ray(x, y)
        outside = start - shape.origin - 1e3 * float(np.linalg.norm(start - shape.origin)) * direction
        hit = facets.facet_met(shape.polyhedron, outside, direction)
        met, reach = hit if hit is not None else (-1, 0.0)
        if hit is None or not self._is_visible(outside + reach * direction + shape.origin, x / sight.width):
            self.clear()
        elif self._shown is None or self._shown[0] is not shape or self._shown[1] != met:
            self._shown = (shape, met)
            facet, ink = facets.facet_of(shape.polyhedron, met), self._ink()
            self._view.draw(lambda plotter: facets.show_facet(plotter, facet, shape.origin, ink))
            self._report(words_of(facet))


def words_of(facet: facets.Facet) -> str:
    """One line; lengths in micrometres, facets and parts counted from 1."""
    numbers = {
        "number": facet.index + 1,
        "count": facet.count,
        "area": facet.area,
        "share": facet.share,
        "x": facet.normal[0],
        "y": facet.normal[1],
        "z": facet.normal[2],
        "offset": facet.offset,
    }
    if facet.part is None:
        text = N_(
            "facet {number} of {count}: {area:,.4g} µm² ({share:.1%}), normal ({x:.2f}, {y:.2f}, {z:.2f}),"
            " {offset:.4g} µm from the centre, {corners} corners"
        )
        return tr(text, corners=len(facet.outline), **numbers)
    text = N_(
        "part {part}, facet {number} of {count}: {area:,.4g} µm² exposed ({share:.1%}), normal"
        " ({x:.2f}, {y:.2f}, {z:.2f}), {offset:.4g} µm from the centre"
    )
    return tr(text, part=facet.part + 1, **numbers)
