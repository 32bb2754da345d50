"""Comparison of two shapes by a divider and by sections."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, Qt, Signal

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.cross_section import CrossSection, cross_section
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.messages import N_
from regolith_studio.scene.cameras import Projection
from regolith_studio.scene.clipping import SectionPlane, frame_corners, normals_of, reach_along, show_frame
from regolith_studio.scene.comparison import Divider, arrange, show_cuts, show_other
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.scene.shapes import FIT, NAMES, PARTICLE, POLYHEDRON, SceneShape
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.views.view import ViewFrame

REACH = 8.0
"""Pixels from what is drawn at which it is still held."""
EDGE = 0.02
"""Share of the picture that the line of a wipe keeps from its edges."""


class DividerHandle:
    """Moves the line of a wipe.

    ``moved``: told the new share of the picture's width.
    """

    cursor = Qt.CursorShape.SplitHCursor

    def __init__(self, divider: Divider, moved: Callable[[float], None]) -> None:
        self._divider, self._moved = divider, moved

    def is_under_cursor(self, sight: Projection, x: float, y: float) -> bool:  # noqa: ARG002
        return self._divider.shown and abs(x - self._divider.share * sight.width) <= REACH

    def pull(self, sight: Projection, right: float, down: float) -> None:  # noqa: ARG002
        share = self._divider.share + right / max(sight.width, 1.0)
        self._moved(min(max(share, EDGE), 1.0 - EDGE))


class PlaneGrip:
    """Moves the plane of a section along its normal, held at its frame.

    ``plane``: the plane and the corners of its frame, shape (4, 3), or ``None`` while there is no section.
    ``moved``: told the new offset.
    """

    cursor = Qt.CursorShape.SizeAllCursor

    def __init__(
        self,
        plane: Callable[[], tuple[SectionPlane, FloatArray] | None],
        moved: Callable[[float], None],
    ) -> None:
        self._plane, self._moved = plane, moved

    def is_under_cursor(self, sight: Projection, x: float, y: float) -> bool:
        known = self._plane()
        if known is None:
            return False
        corners = sight.seen(known[1])
        following = np.roll(corners, -1, axis=0)
        return _distance(np.array([x, y]), corners, following) <= REACH

    def pull(self, sight: Projection, right: float, down: float) -> None:
        known = self._plane()
        if known is not None:
            self._moved(known[0].offset + sight.along(known[0].normal, right, down))


def _distance(point: FloatArray, starts: FloatArray, ends: FloatArray) -> float:
    """Of a point from the nearest of some line segments in the plane."""
    along = ends - starts
    square = np.maximum(np.einsum("ij,ij->i", along, along), 1e-12)
    share = np.clip(np.einsum("ij,ij->i", point - starts, along) / square, 0.0, 1.0)
    return float(np.linalg.norm(point - starts - share[:, None] * along, axis=1).min())


EYE = "eye"


class Sections(QObject):
    """A plane by its direction and its position between the ends of the particle; ``changed`` reports both.

    Also told when the bodies change while the section is shown.
    """

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.shown = False
        self.direction = "y"
        self.flipped = True
        self._share = 0.5
        self._eye = np.array([0.0, -1.0, 0.0])
        self._shapes: Mapping[str, SceneShape] = {}
        self._cuts: dict[str, tuple[SceneShape, SectionPlane, CrossSection]] = {}
        self._normals: tuple[Mesh, dict[str, FloatArray]] | None = None

    def set_shown(self, shown: bool) -> None:
        """Cut the bodies, or show them whole."""
        self.shown = shown
        self.changed.emit()

    def set_shapes(self, shapes: Mapping[str, SceneShape]) -> None:
        self._shapes = dict(shapes)
        if self.shown:
            self.changed.emit()

    def set_direction(self, key: str, eye: FloatArray | None = None) -> None:
        """Cut across one of :data:`~regolith_studio.scene.clipping.DIRECTIONS`; `eye` points to the eye.

        What lies on the side of the eye is taken away.
        """
        self.direction = key
        if eye is not None:
            self._eye = np.array(eye)
            self.flipped = key != EYE and float(self._axis() @ self._eye) < 0.0
        self.changed.emit()

    def set_flipped(self, flipped: bool) -> None:
        self.flipped = flipped
        self.changed.emit()

    def set_position(self, micrometres: float) -> None:
        """Move the plane to a distance from the particle's middle, along the direction."""
        low, high = self._reach()
        position = micrometres + (low + high) / 2
        self._share = float(np.clip((position - low) / (high - low), 0.0, 1.0)) if high > low else 0.5
        self.changed.emit()

    def move_to(self, offset: float) -> None:
        """Move the plane to an offset along its own normal."""
        low, high = self._reach()
        self.set_position((-offset if self.flipped else offset) - (low + high) / 2)

    @property
    def position(self) -> float:
        """Distance of the plane from the particle's middle along the direction."""
        return (self._share - 0.5) * 2 * self.half_length

    @property
    def half_length(self) -> float:
        """Half the particle's length along the direction."""
        low, high = self._reach()
        return (high - low) / 2

    @property
    def plane(self) -> SectionPlane | None:
        """The plane, while a section is shown of a particle."""
        if not self.shown or PARTICLE not in self._shapes:
            return None
        low, high = self._reach()
        sign = -1.0 if self.flipped else 1.0
        x, y, z = (sign * float(each) for each in self._axis())
        return SectionPlane((x, y, z), sign * (low + self._share * (high - low)))

    @property
    def framed(self) -> tuple[SectionPlane, FloatArray] | None:
        """The plane and the corners of its frame, shape (4, 3)."""
        plane = self.plane
        return None if plane is None else (plane, frame_corners(self._shapes[PARTICLE].mesh, plane))

    def cuts(self) -> dict[str, CrossSection]:
        """What the plane cuts out of each body; nothing while no section is shown."""
        plane = self.plane
        if plane is None:
            return {}
        for name, shape in self._shapes.items():
            known = self._cuts.get(name)
            if known is None or known[0] is not shape or known[1] != plane:
                self._cuts[name] = (shape, plane, cross_section(shape.mesh, plane.normal, plane.offset))
        return {name: self._cuts[name][2] for name in self._shapes}

    def _reach(self) -> tuple[float, float]:
        particle = self._shapes.get(PARTICLE)
        return (-1.0, 1.0) if particle is None else reach_along(particle.mesh, self._axis())

    def _axis(self) -> FloatArray:
        axes = self._axes()
        return axes.get(self.direction, self._eye)

    def _axes(self) -> dict[str, FloatArray]:
        """The box of a particle is looked for once, and only if one of its directions is wanted."""
        particle = self._shapes.get(PARTICLE)
        if particle is None or self.direction in (*"xyz", EYE):
            return normals_of(None)
        if self._normals is None or self._normals[0] is not particle.mesh:
            self._normals = (particle.mesh, normals_of(minimum_volume_box(particle.mesh)))
        return self._normals[1]


PARTNERS = {PARTICLE: "", FIT: PARTICLE, POLYHEDRON: PARTICLE}
"""What each body is compared with at first."""
WITH = {PARTICLE: N_("+ particle"), FIT: N_("+ fit"), POLYHEDRON: N_("+ polyhedron")}
COMPARE = {
    PARTICLE: N_("Compare the particle with"),
    FIT: N_("Compare the fit with"),
    POLYHEDRON: N_("Compare the polyhedron with"),
}


def partners_of(name: str) -> dict[str, str]:
    return {"": N_("alone")} | {other: WITH[other] for other in NAMES if other != name}


class Comparison:
    """Overlay, wipe and section of all views.

    ``frames``: by the name of the body that each shows. ``sections``: the plane that is common to all.
    """

    def __init__(self, frames: Mapping[str, ViewFrame], sections: Sections) -> None:
        self._frames, self._sections = frames, sections
        self.partners = dict(PARTNERS)
        self.overlay = self.wipe = False
        self._shapes: Mapping[str, SceneShape] = {}
        self._theme: Theme | None = None
        self.dividers: dict[str, Divider] = {}
        handle = PlaneGrip(lambda: sections.framed, sections.move_to)
        for name, frame in frames.items():
            frame.view.draw(partial(self._add_divider, name))
            frame.view.mouse.handles += [DividerHandle(self.dividers[name], self.set_share), handle]
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
        """Lay the partner over each body, or show it to the right of the line; both: overlay to the right."""
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
