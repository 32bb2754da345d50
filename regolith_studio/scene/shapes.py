"""The content of a view: particle, fit or polyhedron, as a value."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from regolith_studio.coarsening.progress import placed
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.messages import N_
from regolith_studio.scene import palette, surfaces
from regolith_studio.scene.palette import Material, ThemeColors

PARTICLE, FIT, POLYHEDRON = "particle", "fit", "polyhedron"
NAMES = (PARTICLE, FIT, POLYHEDRON)
LABELS = {PARTICLE: N_("Particle"), FIT: "Fit", POLYHEDRON: N_("Polyhedron")}
MATERIALS: dict[str, Material] = {
    PARTICLE: palette.PARTICLE_MATERIAL,
    FIT: palette.FIT_MATERIAL,
    POLYHEDRON: palette.POLYHEDRON_MATERIAL,
}


@dataclass(frozen=True, eq=False)
class SceneShape:
    """A body in the particle's frame.

    ``name``: one of :data:`NAMES`. ``surface``: its triangles, or a polyhedron about `centre`.
    """

    name: str
    surface: Mesh | Polyhedron
    centre: FloatArray | None = None

    @property
    def polyhedron(self) -> Polyhedron | None:
        """The polyhedron or the union of several, if it is one."""
        return None if isinstance(self.surface, Mesh) else self.surface

    @property
    def origin(self) -> FloatArray:
        """Where the polyhedron's own origin lies, shape (3,)."""
        return np.zeros(3) if self.centre is None else np.asarray(self.centre, dtype=np.float64)

    @property
    def body(self) -> Mesh | ConvexPolyhedron:
        """The same surface about `origin`; of a union of convex parts its triangles."""
        return self.surface.mesh if isinstance(self.surface, ConvexCompound) else self.surface

    @cached_property
    def mesh(self) -> Mesh:
        """Triangles in the particle's frame."""
        return self.surface if isinstance(self.surface, Mesh) else placed(self.surface, self.origin)


def show_shape(
    plotter: Any,
    shape: SceneShape | None,
    surroundings: ThemeColors = palette.LIGHT,
    layer: str = "",
    opacity: float = 1.0,
) -> None:
    """Draw a body, or nothing.

    ``layer``: bodies of different layers stand in one plotter together.
    """
    if shape is None:
        surfaces.hide(plotter, layer)
        return
    if not isinstance(shape.surface, Mesh):
        surfaces.show_polyhedron(plotter, shape.surface, shape.origin, surroundings, layer)
    else:
        surfaces.hide(plotter, layer)
        surfaces.show_smooth(plotter, shape.mesh, MATERIALS[shape.name], layer)
    surfaces.set_opacity(plotter, opacity, layer)
