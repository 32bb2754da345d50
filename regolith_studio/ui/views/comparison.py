"""Two surfaces in one view: overlaid, or side by side along a line that can be dragged (wipe)."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_
from regolith_studio.scene.clipping import show_frame
from regolith_studio.scene.comparison import Divider, arrange, show_cuts, show_other
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.scene.shapes import FIT, NAMES, PARTICLE, POLYHEDRON, SceneShape
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.views.drag_handles import DividerGrip, PlaneGrip
from regolith_studio.ui.views.sections import Sections
from regolith_studio.ui.views.view_frame import ViewFrame

PARTNERS = {PARTICLE: "", FIT: PARTICLE, POLYHEDRON: PARTICLE}
"""What each body is compared with at first."""
WITH = {PARTICLE: N_("+ particle"), FIT: N_("+ fit"), POLYHEDRON: N_("+ polyhedron")}
COMPARE = {
    PARTICLE: N_("Compare the particle with"),
    FIT: N_("Compare the fit with"),
    POLYHEDRON: N_("Compare the polyhedron with"),
}


def partners_of(name: str) -> dict[str, str]:
    """What a body can be compared with."""
    return {"": N_("alone")} | {other: WITH[other] for other in NAMES if other != name}


class Comparison:
    """Overlay, wipe and section of all views.

    Parameters
    ----------
    frames
        By the name of the body that each shows.
    sections
        The plane that is common to all.
    """

    def __init__(self, frames: Mapping[str, ViewFrame], sections: Sections) -> None:
        self._frames, self._sections = frames, sections
        self.partners = dict(PARTNERS)
        self.overlay = self.wipe = False
        self._shapes: Mapping[str, SceneShape] = {}
        self._theme: Theme | None = None
        self.dividers: dict[str, Divider] = {}
        grip = PlaneGrip(lambda: sections.framed, sections.move_to)
        for name, frame in frames.items():
            frame.view.draw(partial(self._add_divider, name))
            frame.view.mouse.grips += [DividerGrip(self.dividers[name], self.set_share), grip]
            frame.partner.setValue(self.partners[name])
            frame.partnerChanged.connect(partial(self.set_partner, name))
        sections.changed.connect(partial(self.apply_style, *NAMES))

    def set_shapes(self, shapes: Mapping[str, SceneShape], *changed: str) -> None:
        """Other bodies; those that are named have changed."""
        self._shapes = shapes
        self._sections.set_shapes(shapes)
        if not self._sections.shown:
            comparing = self.overlay or self.wipe
            concerned = [name for name in NAMES if comparing and self.partners[name] in changed]
            self.apply_style(*{*concerned, *(changed if comparing else ())})

    def set_mode(self, *, overlay: bool | None = None, wipe: bool | None = None) -> None:
        """Lay the partner over each body, or show it to the right of the line; both: a veil to the right."""
        self.overlay = self.overlay if overlay is None else overlay
        self.wipe = self.wipe if wipe is None else wipe
        for frame in self._frames.values():
            frame.set_comparing(self.overlay or self.wipe)
        self.apply_style(*NAMES)

    def set_partner(self, name: str, other: str) -> None:
        """Compare a body with another one, or with none."""
        self.partners[name] = other
        self._frames[name].partner.setValue(other)
        self.apply_style(name)

    def set_share(self, share: float) -> None:
        """Where the line stands in every view, as a share of its width."""
        for name, divider in self.dividers.items():
            divider.share = share
            self._frames[name].view.draw(lambda _plotter: None)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        for divider in self.dividers.values():
            divider.set_ink(theme.surroundings)
        self.apply_style(*NAMES)

    def apply_style(self, *names: str) -> None:
        """Draw partners, cuts and lines of these views anew."""
        if self._theme is not None:
            for name in names:
                self._frames[name].view.draw(partial(self._fill, name))

    def is_visible_at(self, name: str, place: FloatArray, x_share: float) -> bool:
        """Whether a point of a body is neither cut away nor covered by its partner beyond the line."""
        plane, divider = self._sections.plane, self.dividers[name]
        kept = plane is None or float(place @ np.asarray(plane.normal)) <= plane.offset
        return kept and (self.overlay or not divider.shown or x_share <= divider.share)

    @contextmanager
    def without_lines(self) -> Iterator[list[float | None]]:
        """No lines while it lasts, though everything ends where they stood: where, for each view."""
        shown = {name: divider for name, divider in self.dividers.items() if divider.shown}
        for divider in shown.values():
            divider.set_shown(False)
        try:
            yield [shown[name].share if name in shown else None for name in self._frames]
        finally:
            for divider in shown.values():
                divider.set_shown(True)

    def release(self) -> None:
        """Stop listening to the views."""
        for divider in self.dividers.values():
            divider.remove()
        self.dividers.clear()

    def _fill(self, name: str, plotter: Any) -> None:
        theme = self._theme
        if theme is None:
            return
        ink: ThemeColors = theme.surroundings
        own = self._shapes.get(name)
        partner = self.partners[name] if (self.overlay or self.wipe) and own is not None else ""
        other = self._shapes.get(partner)
        show_other(plotter, other, self.overlay, ink)
        framed = self._sections.framed
        colours = {each: str(getattr(theme, each)) for each in NAMES}
        drawn = "" if own is None else name
        beside = partner if other is not None else ""
        show_cuts(plotter, drawn, beside, self._sections.cuts(), colours, self.overlay)
        show_frame(plotter, framed[1] if framed else None, ink)
        wiped = self.wipe and other is not None
        arrange(plotter, self.dividers[name], wiped, self.overlay, framed[0] if framed else None)

    def _add_divider(self, name: str, plotter: Any) -> None:
        self.dividers[name] = Divider(plotter)
