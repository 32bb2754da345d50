"""The cross-section that all views share: its plane, and the outlines of each body."""

from collections.abc import Mapping

import numpy as np
from PySide6.QtCore import QObject, Signal

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.cross_section import CrossSection, cross_section
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.scene.clipping import SectionPlane, frame_corners, normals_of, reach_along
from regolith_studio.scene.shapes import PARTICLE, SceneShape

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
        """Cut other bodies from now on."""
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
        """Show the other half."""
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
