"""CT particle, fit and polyhedron side by side: the three views that are always there."""

import html
from functools import partial
from typing import Any

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSplitter, QWidget

from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.harmonics.visibility import hidden_faces
from regolith_studio.scene import extras, surfaces
from regolith_studio.scene.distance import signed_distances
from regolith_studio.session.results import ParticleEntry, Results
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.views.camera_link import CameraLink
from regolith_studio.ui.views.factory import make_view
from regolith_studio.ui.views.view_frame import ViewFrame

NAMES = ("particle", "fit", "polyhedron")


class Triptych(QSplitter):
    """Three framed views under linked cameras.

    Parameters
    ----------
    kind
        ``live`` or ``image``.
    """

    def __init__(self, kind: str, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setObjectName("triptych")
        self.setChildrenCollapsible(False)
        self._theme = current_theme()
        self.frames = {name: ViewFrame(make_view(kind, self._theme.surroundings), name) for name in NAMES}
        self.views = {name: frame.view for name, frame in self.frames.items()}
        self.link = CameraLink(list(self.views.values()))
        for frame in self.frames.values():
            self.addWidget(frame)
            frame.setMinimumWidth(150)
        self.setSizes([1000, 1000, 1000])
        self._shown: Mesh | None = None
        self._fit: Mesh | None = None
        self._heat = False
        self._extras: dict[str, bool] = {}
        self._star_point: FloatArray | None = None
        self._hidden: BoolArray | None = None
        self._solid: tuple[ConvexPolyhedron, FloatArray] | None = None
        self.set_theme(self._theme)
        self._empty_titles()

    def show_particle(self, entry: ParticleEntry | None) -> None:
        """Put a particle on screen; the other views wait for what belongs to it."""
        if entry is None or entry.particle.mesh is self._shown:
            return
        mesh = self._shown = entry.particle.mesh
        self._fit = self._solid = self._star_point = self._hidden = None
        for name in NAMES[1:]:
            self.views[name].draw(surfaces.clear)
        self._draw_extras(*NAMES)
        self._empty_titles()
        self.views["particle"].draw(lambda plotter: surfaces.show_particle(plotter, mesh))
        self.frames["particle"].set_texts(
            f"CT particle, {html.escape(entry.id)}", f"{_lengths(mesh.bounds)}, {len(mesh.faces):,} triangles"
        )
        self.link.frame(mesh.vertices)

    def show_fit(self, mesh: Mesh | None, l_max: int) -> None:
        """Show the surface of the fit."""
        if mesh is None or self._shown is None:
            return
        self._fit = mesh
        degree = f"l<sub>max</sub>&nbsp;=&nbsp;{l_max}"
        self.frames["fit"].set_texts(
            f"Spherical-harmonics fit, {degree}",
            f"{(l_max + 1) ** 2:,} coefficients, {len(mesh.faces):,} triangles",
            f"Harmonics fit, {degree}",
        )
        self._draw_fit()

    def show_polyhedron(self, results: Results) -> None:
        """Show the newest polyhedron of the coarsening."""
        found = results.coarsened or results.coarsening_progress
        if found is None or found.polyhedron is None:
            return
        solid, centre = found.polyhedron, found.centre
        self._solid = (solid, np.asarray(centre, dtype=np.float64))
        ink = self._theme.surroundings
        self.views["polyhedron"].draw(lambda plotter: surfaces.show_polyhedron(plotter, solid, centre, ink))
        self.frames["polyhedron"].set_texts(
            f"Polyhedron, {solid.n_faces} facets",
            f"{solid.n_vertices} vertices, {solid.n_triangles} triangles{_shortfall(results)}",
        )
        self._draw_extras("polyhedron")

    def set_heat(self, heat: bool) -> None:
        """Colour the fit by its distance from the particle, or in its own colour."""
        self._heat = heat
        self._draw_fit()

    def set_extra(self, name: str, shown: bool) -> None:
        """Show or hide ``box``, ``star_point`` or ``overlay`` (the particle over fit and polyhedron)."""
        self._extras[name] = shown
        self._draw_extras(*NAMES)

    def show_star_point(self, point: FloatArray | None) -> None:
        """Where the radius function begins; what it cannot see of the particle is shown with it."""
        self._star_point, self._hidden = point, None
        self._draw_extras("particle", "fit")

    def set_wireframe(self, wireframe: bool) -> None:
        """Draw particle and fit as triangle meshes."""
        for name in NAMES:
            self.views[name].draw(lambda plotter: surfaces.set_wireframe(plotter, wireframe))

    def reset_cameras(self) -> None:
        """Show the particle whole again."""
        if self._shown is not None:
            self.link.frame(self._shown.vertices)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        for name, frame in self.frames.items():
            frame.view.set_surroundings(theme.surroundings)
            frame.set_colour(getattr(theme, name))

    def release(self) -> None:
        """Give the graphics memory back."""
        for view in self.views.values():
            view.release()

    def _draw_fit(self) -> None:
        mesh, particle = self._fit, self._shown
        if mesh is None or particle is None:
            return
        ink = self._theme.surroundings
        distances: FloatArray | None = signed_distances(mesh.vertices, particle) if self._heat else None
        self.views["fit"].draw(lambda plotter: surfaces.show_fit(plotter, mesh, distances, None, ink))
        if distances is not None:
            reach = float(np.abs(distances).max(initial=0.0))
            self.frames["fit"].detail.setText(f"at most {reach:.3g} µm from the particle")
        self._draw_extras("fit")

    def _draw_extras(self, *names: str) -> None:
        for name in names:
            self.views[name].draw(partial(self._fill_extras, name))

    def _fill_extras(self, name: str, plotter: Any) -> None:
        """Box, star point and overlay of one view, or none of them."""
        ink = self._theme.surroundings
        solid = self._solid if name == "polyhedron" else None
        mesh = {"particle": self._shown, "fit": self._fit}.get(name)
        corners = _box_corners(mesh, solid) if self._extras.get("box") else None
        extras.show_box(plotter, corners, ink)
        seen = self._extras.get("star_point") and mesh is not None and name != "polyhedron"
        size = float(np.ptp(self._shown.vertices, axis=0).max()) if self._shown is not None else 1.0
        extras.show_star_point(plotter, self._star_point if seen else None, size, ink)
        if name == "particle":
            extras.show_hidden(plotter, mesh, self._hidden_faces() if seen else None)
        over = self._extras.get("overlay") and name != "particle" and (mesh is not None or solid is not None)
        extras.show_ghost(plotter, self._shown if over else None)

    def _hidden_faces(self) -> BoolArray | None:
        """Faces of the particle that the star point cannot see; looked for once a fit."""
        if self._hidden is None and self._shown is not None and self._star_point is not None:
            self._hidden = hidden_faces(self._shown, self._star_point)
        return self._hidden

    def _empty_titles(self) -> None:
        self.frames["particle"].set_texts("CT particle")
        self.frames["fit"].set_texts("Spherical-harmonics fit", "waiting for the coefficients …")
        self.frames["polyhedron"].set_texts("Polyhedron", "on its way; the very first one takes longer …")


def _box_corners(mesh: Mesh | None, solid: tuple[ConvexPolyhedron, FloatArray] | None) -> FloatArray | None:
    """Corners of the minimum-volume box of what one view shows."""
    if solid is not None:
        return minimum_volume_box(solid[0]).corners + solid[1]
    return minimum_volume_box(mesh).corners if mesh is not None else None


def _lengths(bounds: FloatArray) -> str:
    """Size of the box along the axes."""
    return " × ".join(f"{edge:.3g}" for edge in bounds[1] - bounds[0]) + " µm"


def _shortfall(results: Results) -> str:
    """A few words where a finished coarsening has fewer facets than were asked for."""
    done = results.coarsened
    if done is None or done.n_faces == done.n_faces_asked:
        return ""
    return f"; {done.n_faces_asked} facets were asked for"
