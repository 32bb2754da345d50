"""Texts in a picture: the scale bar in micrometres, the title."""

import math
import weakref
from collections.abc import Callable
from typing import Any, Protocol

import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkCoordinate, vtkPolyDataMapper2D, vtkTextActor

from regolith_studio.scene import palette
from regolith_studio.scene.palette import ThemeColors

TITLE = "title"
_STEPS = (1.0, 2.0, 5.0)
_WIDEST_SHARE = 0.28
"""Of the picture's width that the scale bar takes at most."""


LABEL_SIZE = 11
"""Font size of the numbers of a colour scale."""


def bar_length(picture_width: float) -> float:
    """The longest of 1, 2, 5, 10, ... that fits into its share of the picture, in the unit of the scene.

    ``picture_width``: width of the picture in the unit of the scene.
    """
    widest = picture_width * _WIDEST_SHARE
    if not widest > 0.0:
        return 0.0
    power = 10.0 ** math.floor(math.log10(widest) + 1e-12)
    return max(step * power for step in _STEPS if step * power <= widest * (1 + 1e-9))


def length_text(micrometres: float) -> str:
    """A length with the unit that suits it: nm, µm, mm or m."""
    for factor, unit in ((1e-3, "nm"), (1.0, "µm"), (1e3, "mm"), (1e6, "m")):
        if micrometres < factor * 1e3 or unit == "m":
            return f"{micrometres / factor:.4g} {unit}"
    raise AssertionError("the last unit takes every length")


def distance_text(micrometres: float) -> str:
    """A signed distance at the scale of a colour map."""
    return f"{micrometres:.2g} µm"


class ScaleBar:
    """A bar at the lower left that keeps its meaning while the camera zooms and the picture is resized.

    It is there while anything is shown that could be measured with it, and exact because the cameras use
    parallel projection. It must be ``suspended`` for pictures that are put together from tiles, which have
    the size and the camera of a part.

    - ``plotter``: any pyvista plotter; the bar belongs to its active renderer.
    - ``surroundings``: whose ink it is drawn with.
    - ``factor``: size of text and line, and of the numbers of colour scales; pictures of several times the
      usual size want larger ones.
    """

    def __init__(
        self,
        plotter: Any,
        surroundings: ThemeColors = palette.LIGHT,
        *,
        factor: float = 1.0,
    ) -> None:
        self._renderer, self._colour_scales = plotter.renderer, plotter.scalar_bars
        self._line = pv.PolyData()
        self.suspended = False
        self._bar = flat_actor(self._line)
        self._label = vtkTextActor()
        self._shown: tuple[float, ...] = ()
        self.set_factor(factor)
        self._label.GetTextProperty().SetFontFamilyToArial()
        self._label.GetTextProperty().SetJustificationToCentered()
        self.set_ink(surroundings)
        self._renderer.AddViewProp(self._bar)
        self._renderer.AddViewProp(self._label)
        self._tag = before_each_picture(self._renderer, self)

    def set_factor(self, factor: float) -> None:
        """Change the size of text and line."""
        self._factor, self._shown = factor, ()
        self._bar.GetProperty().SetLineWidth(2.0 * factor)
        self._label.GetTextProperty().SetFontSize(round(12 * factor))

    def set_ink(self, surroundings: ThemeColors) -> None:
        """Draw with another ink."""
        red, green, blue = pv.Color(surroundings.ink).float_rgb
        self._bar.GetProperty().SetColor(red, green, blue)
        self._label.GetTextProperty().SetColor(red, green, blue)

    @property
    def text(self) -> str:
        """What the bar says."""
        return str(self._label.GetInput() or "")

    def update(self) -> None:
        """Fit the bar to the camera; called by itself before every picture."""
        for scale in self._colour_scales.values():
            scale.GetAnnotationTextProperty().SetFontSize(round(LABEL_SIZE * self._factor))
        width, height = self._renderer.GetSize()
        low, high = self._renderer.ComputeVisiblePropBounds()[:2]
        measurable = low <= high and not self.suspended  # the other way round, there is no surface
        self._bar.SetVisibility(measurable)
        self._label.SetVisibility(measurable)
        if not (width and height and measurable):
            return
        per_pixel = 2.0 * self._renderer.GetActiveCamera().GetParallelScale() / height
        now = (width, height, per_pixel)
        if now != self._shown:
            self._shown = now
            self._draw(16.0 * self._factor, 14.0 * self._factor, bar_length(width * per_pixel), per_pixel)

    def remove(self) -> None:
        """Take it out of the picture and stop listening to the renderer."""
        self._renderer.RemoveObserver(self._tag)
        self._renderer.RemoveViewProp(self._bar)
        self._renderer.RemoveViewProp(self._label)

    def _draw(self, x: float, y: float, length: float, per_pixel: float) -> None:
        end = x + length / per_pixel
        high = y + 5 * self._factor
        points = [(x, high, 0), (x, y, 0), (end, y, 0), (end, high, 0)]
        self._line.copy_from(pv.PolyData(points, lines=[4, 0, 1, 2, 3]))
        self._label.SetInput(length_text(length))
        self._label.SetPosition((x + end) / 2, y + 7 * self._factor)


class _Updated(Protocol):
    def update(self) -> None: ...


def before_each_picture(renderer: Any, part: _Updated) -> int:
    """Call ``part.update()`` before every picture, without keeping it alive; returns the observer's tag."""
    known = weakref.ref(part)

    def update(*_: Any) -> None:
        alive = known()
        if alive is not None:
            alive.update()

    return int(renderer.AddObserver("StartEvent", update))


def flat_actor(data: pv.PolyData, line_width: float = 2.0) -> vtkActor2D:
    """Lines and polygons in pixels of the view, from the lower left."""
    actor, mapper, coordinate = vtkActor2D(), vtkPolyDataMapper2D(), vtkCoordinate()
    mapper.SetInputData(data)
    coordinate.SetCoordinateSystemToViewport()
    mapper.SetTransformCoordinate(coordinate)
    actor.SetMapper(mapper)
    actor.GetProperty().SetLineWidth(line_width)
    return actor


def show_title(plotter: Any, title: str, size: int = 11) -> None:
    """One line at the upper edge of the picture, or none for an empty text."""
    text = plotter.add_text(
        title,
        position=(0.5, 0.985),
        viewport=True,
        font_size=size,
        color=palette.PAPER.ink,
        name=TITLE,
        render=False,
    )
    text.prop.justification_horizontal = "center"
    text.prop.justification_vertical = "top"


def show_colour_scale(
    plotter: Any, mapper: Any, surroundings: ThemeColors, write: Callable[[float], str] = distance_text
) -> None:
    """The scale of a colour map at the right, with numbers at its ends and its centre.

    They stand to the left of it, where they have room in a narrow view too. They are annotations, since the
    labels of VTK have a decimal point in every language.

    ``write``: the text of a number.
    """
    bar = plotter.add_scalar_bar(
        title=" ",
        mapper=mapper,
        color=surroundings.ink,
        vertical=True,
        width=0.045,
        height=0.26,
        position_x=0.92,
        position_y=0.04,
        title_font_size=11,
        unconstrained_font_size=True,
        render=False,
    )
    low, high = mapper.scalar_range
    for value in (low, (low + high) / 2, high):
        bar.GetLookupTable().SetAnnotation(value, write(value))
    numbers = bar.GetAnnotationTextProperty()
    numbers.SetFontSize(LABEL_SIZE)
    numbers.SetColor(*pv.Color(surroundings.ink).float_rgb)
    bar.SetDrawTickLabels(False)
    bar.SetDrawAnnotations(True)
    bar.SetTextPositionToSucceedScalarBar()  # annotations are at the other side


def hide_colour_scale(plotter: Any) -> None:
    """Take the scale away, if there is one."""
    for title in tuple(plotter.scalar_bars.keys()):
        plotter.remove_scalar_bar(title, render=False)
