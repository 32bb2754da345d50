"""The three views of Explore: particle, harmonic fit and polyhedron."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from PySide6.QtCore import QLineF, QObject, QPointF, QRectF, QSizeF, Qt, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF, QTextDocument
from PySide6.QtWidgets import QSplitter, QWidget

from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.star_point import hidden_faces
from regolith_studio.jobs.events import Job
from regolith_studio.messages import N_
from regolith_studio.scene import facets, overlays, surfaces
from regolith_studio.scene.annotations import bar_length, distance_text, length_text
from regolith_studio.scene.cameras import Projection
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.scene.shapes import FIT, NAMES, PARTICLE, POLYHEDRON, SceneShape
from regolith_studio.scene.surfaces import measure_distances
from regolith_studio.session.results import ParticleEntry, Results
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import Markup, localized, number_text, rich, tr, translate
from regolith_studio.ui.views.comparison import COMPARE, Comparison, Sections, partners_of
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink, Picture, SceneView, ViewFrame


class FacetHover:
    """Outlines and numbers the facet, and reports its properties in one line.

    - ``view``: that shows the polyhedron.
    - ``shape``: reads what it shows.
    - ``ink``: reads the inks.
    - ``is_visible``: whether a point of the body, shape (3,), at a share of the picture's width is seen.
    - ``report``: receives the line, or nothing when the mouse is elsewhere.
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


GAP = 8


def snapshot(
    frames: Sequence[ViewFrame],
    theme: Theme,
    scale: int = 1,
    transparent: bool = False,
    lines: Sequence[float | None] = (),
) -> QImage:
    """The frames that are not hidden side by side, `scale` times as large as on the screen.

    What they show is drawn anew at that size, not enlarged.

    ``lines``: for each frame the share of its width at which the line of a wipe stands, ``None`` for no
    line.
    """
    standing = dict(zip(frames, lines, strict=True)) if lines else {}
    seen = [frame for frame in frames if not frame.isHidden()]
    pictures = [frame.view.shot(scale, transparent) for frame in seen]
    headings = [
        _heading(frame, theme, picture.shape[1] / scale)
        for frame, picture in zip(seen, pictures, strict=True)
    ]
    top = max(heading.size().height() for heading in headings)
    width = sum(picture.shape[1] for picture in pictures) + GAP * scale * (len(pictures) - 1)
    height = max(picture.shape[0] for picture in pictures) + round(top * scale)
    image = QImage(width, height, QImage.Format.Format_ARGB32)
    image.fill(Qt.GlobalColor.transparent if transparent else theme.base)
    painter = QPainter(image)
    left = 0
    for frame, heading, picture in zip(seen, headings, pictures, strict=True):
        painter.save()
        painter.translate(left, 0)
        painter.scale(scale, scale)
        heading.drawContents(painter, QRectF(0, 0, picture.shape[1] / scale, top))
        painter.restore()
        painter.drawImage(left, round(top * scale), _image(picture))
        painter.save()
        painter.translate(left, round(top * scale))
        _draw_over(painter, frame, theme, picture, scale, standing.get(frame))
        painter.restore()
        left += picture.shape[1] + GAP * scale
    painter.end()
    return image


def _heading(frame: ViewFrame, theme: Theme, width: float) -> QTextDocument:
    made = QTextDocument()
    made.setDefaultFont(frame.font())
    made.setDocumentMargin(4)
    made.setHtml(
        f'<div style="color:{theme.text}"><b>{frame.title}</b></div>'
        f'<div style="color:{theme.muted}">{rich(frame.detail.text())}</div>'
    )
    made.setPageSize(QSizeF(width, -1))
    made.setTextWidth(width)
    return made


def _draw_over(
    painter: QPainter, frame: ViewFrame, theme: Theme, picture: Picture, scale: int, line: float | None
) -> None:
    """Scale bar, and the line of the wipe if there is one; the origin is the picture's upper left."""
    height, width = picture.shape[:2]
    sight = Projection(frame.view.pose, width, height)
    length = bar_length(width * sight.per_pixel)
    painter.setPen(QPen(QColor(theme.surroundings.ink), 2.0 * scale))
    if line is not None:
        painter.drawLine(QLineF(line * width, 0, line * width, height))
    if not length:
        return
    left, low, tick = 16.0 * scale, height - 14.0 * scale, 5.0 * scale
    right = left + length / sight.per_pixel
    points = [(left, low - tick), (left, low), (right, low), (right, low - tick)]
    painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in points]))
    font = painter.font()
    font.setPixelSize(12 * scale)
    painter.setFont(font)
    place = QRectF((left + right) / 2 - 100 * scale, low - 24 * scale, 200 * scale, 18 * scale)
    painter.drawText(place, Qt.AlignmentFlag.AlignCenter, length_text(length))


def _image(picture: Picture) -> QImage:
    pixels = np.ascontiguousarray(picture)
    height, width, channels = pixels.shape
    kind = QImage.Format.Format_RGBA8888 if channels == 4 else QImage.Format.Format_RGB888
    return QImage(pixels.data, width, height, channels * width, kind).copy()


Follow = Callable[[Job, Callable[[Any], None], Callable[[str], None]], None]
"""Submits a job with functions that show its result, or the sentence of its failure."""


class ThreeViews(QSplitter):
    """Three framed views under linked cameras; ``hovered`` reports what the mouse points at.

    ``kind``: ``live`` or ``image``. ``follow``: does in the background what must be measured before it is
    drawn.
    """

    hovered = Signal(str)

    def __init__(self, kind: str, follow: Follow, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setObjectName("three_views")
        self.setChildrenCollapsible(False)
        self._theme = current_theme()
        self.frames = {
            name: ViewFrame(make_view(kind), name, partners_of(name), COMPARE[name], name) for name in NAMES
        }
        self.views = {name: frame.view for name, frame in self.frames.items()}
        self.link = CameraLink(list(self.views.values()))
        for name, frame in self.frames.items():
            self.addWidget(frame)
            frame.setMinimumWidth(136)
            frame.enlargeRequested.connect(partial(self.enlarge, name))
        self.setSizes([1000, 1000, 1000])
        self._shapes: dict[str, SceneShape] = {}
        self._heat = False
        self._size_of_fit = ""
        self._extras: dict[str, bool] = {}
        self._star_point: FloatArray | None = None
        self._hidden: BoolArray | None = None
        self._distances = Distances(follow, self)
        self._distances.measured.connect(self._draw_fit)
        self._distances.refused.connect(self._show_status)
        self.sections = Sections(self)
        self.comparison = Comparison(self.frames, self.sections)
        self.pointer = FacetHover(
            self.views[POLYHEDRON],
            lambda: self._shapes.get(POLYHEDRON),
            lambda: self._theme.surroundings,
            partial(self.comparison.is_visible_at, POLYHEDRON),
            self._show_status,
        )
        self.set_theme(self._theme)
        self._empty_titles(waiting=False)

    def show_particle(self, entry: ParticleEntry | None) -> None:
        """Put a particle on screen; the other views wait for what belongs to it."""
        if entry is None or entry.particle.mesh is self._surface(PARTICLE):
            return
        mesh = entry.particle.mesh
        self._shapes = {PARTICLE: SceneShape(PARTICLE, mesh)}
        self._star_point = self._hidden = None
        self.pointer.clear()
        for name in NAMES[1:]:
            self.views[name].draw(surfaces.clear)
        self._draw_extras(*NAMES)
        self._empty_titles(waiting=True)
        self.views[PARTICLE].draw(lambda plotter: surfaces.show_particle(plotter, mesh))
        self.comparison.set_shapes(self._shapes, *NAMES)
        self.frames[PARTICLE].set_texts(
            rich(entry.id),
            _left_out_text(entry.particle)
            + tr("{size}, {count:,} triangles", size=_lengths(mesh.bounds), count=len(mesh.faces)),
        )
        self.link.frame(mesh.vertices)

    def show_fit(self, mesh: Mesh | None, l_max: int) -> None:
        if mesh is None or PARTICLE not in self._shapes:
            return
        self._shapes[FIT] = SceneShape(FIT, mesh)
        degree = Markup(f"l<sub>max</sub>&nbsp;=&nbsp;{l_max}")
        count = (l_max + 1) ** 2
        self._size_of_fit = tr(
            "{count:,} coefficients, {triangles:,} triangles", count=count, triangles=len(mesh.faces)
        )
        self.frames[FIT].set_texts(
            tr("Spherical-harmonics fit, {degree}", degree=degree),
            self._size_of_fit,
            tr("Harmonics fit, {degree}", degree=degree),
            tr("Fit, {degree}", degree=degree),
        )
        self._draw_fit()
        self.comparison.set_shapes(self._shapes, FIT)

    def show_polyhedron(self, results: Results) -> None:
        """Show the newest polyhedron, also while another one is being made: else a drag would show none."""
        best = results.best
        if best is None or best.polyhedron is None:
            if failure := results.failures.get("coarsening"):
                self.show_failure(POLYHEDRON, failure)
            return
        solid, centre = best.polyhedron, np.asarray(best.centre, dtype=np.float64)
        shown = self._shapes.get(POLYHEDRON)
        if shown is None or shown.surface is not solid:  # results also change while the polyhedron stays
            self._shapes[POLYHEDRON] = SceneShape(POLYHEDRON, solid, centre)
            self.pointer.clear()
            self._draw_polyhedron()
        parts = solid.n_parts if isinstance(solid, ConvexCompound) else 1
        facets = tr("{count} facets", count=solid.n_facets)
        if parts > 1:
            title = tr("Compound, {parts} parts, {count} facets", parts=parts, count=solid.n_facets)
            short = tr("{parts} parts, {count} facets", parts=parts, count=solid.n_facets)
        else:
            title, short = tr("Polyhedron, {count} facets", count=solid.n_facets), facets
        self.frames[POLYHEDRON].set_texts(
            title,
            tr("{count} vertices, {triangles} triangles", count=solid.n_vertices, triangles=solid.n_triangles)
            + _missing_facets_text(results),
            short,
            facets,
        )
        self.comparison.set_shapes(self._shapes, POLYHEDRON)

    def show_failure(self, name: str, sentence: str) -> None:
        """Say in a view why it stays empty, and show no earlier result there."""
        title = tr("Polyhedron") if name == POLYHEDRON else tr("Spherical-harmonics fit")
        self._shapes.pop(name, None)
        self.pointer.clear()
        self.views[name].draw(surfaces.clear)
        self._draw_extras(name)
        self.frames[name].set_texts(title, translate(sentence))
        self.comparison.set_shapes(self._shapes, name)

    def show_step(self, step: CoarseningProgress) -> None:
        """Say which step of a run the polyhedron belongs to."""
        words = tr("step {at} of {total}, loss {loss:.4g}", at=step.step, total=step.steps, loss=step.loss)
        self.frames[POLYHEDRON].set_detail(words)

    def set_heat(self, heat: bool) -> None:
        """Colour the fit by its distance from the particle, or in its own colour."""
        self._heat = heat
        self._draw_fit()

    def set_extra(self, name: str, shown: bool) -> None:
        """Show or hide ``box`` or ``star_point``."""
        self._extras[name] = shown
        self._draw_extras(*NAMES)

    def show_star_point(self, point: FloatArray | None) -> None:
        """Where the radius function begins; what it cannot see of the particle is shown with it."""
        self._star_point, self._hidden = point, None
        self._draw_extras(PARTICLE, FIT)

    def set_wireframe(self, wireframe: bool) -> None:
        for name in NAMES:
            self.views[name].draw(lambda plotter: surfaces.set_wireframe(plotter, wireframe))

    def reset_cameras(self) -> None:
        mesh = self._surface(PARTICLE)
        if mesh is not None:
            self.link.frame(mesh.vertices)

    def cut_across(self, direction: str) -> None:
        """Cut the bodies across a direction and take the half away that is nearer to the eye."""
        view = self.views[PARTICLE]
        towards = -Projection(view.pose, 1, 1).axes[2]
        self.sections.set_direction(direction, towards)

    def enlarge(self, name: str) -> None:
        """Give one view all the room, or all of them theirs again."""
        alone = all(frame.isHidden() for other, frame in self.frames.items() if other != name)
        for other, frame in self.frames.items():
            frame.setVisible(alone or other == name)

    def enlarge_next(self) -> None:
        """One view after the other, then all."""
        seen = [name for name in NAMES if not self.frames[name].isHidden()]
        if len(seen) == len(NAMES):
            self.enlarge(PARTICLE)
        elif seen[0] == NAMES[-1]:
            self.enlarge(seen[0])
        else:
            self.frames[seen[0]].hide()
            self.frames[NAMES[NAMES.index(seen[0]) + 1]].show()

    @property
    def shapes(self) -> tuple[SceneShape, ...]:
        """What is shown, from left to right."""
        return tuple(self._shapes[name] for name in NAMES if name in self._shapes)

    def snapshot(self, scale: int, transparent: bool) -> QImage:
        """The views as they are seen."""
        frames = list(self.frames.values())
        with self.comparison.without_lines() as lines:
            return snapshot(frames, self._theme, scale, transparent, lines)

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        if self._heat:
            self._draw_fit()
        self._draw_polyhedron()
        self._draw_extras(PARTICLE, FIT)
        self.comparison.set_theme(theme)

    def release(self) -> None:
        self.comparison.release()
        for view in self.views.values():
            view.release()

    def _show_status(self, words: str) -> None:
        self.frames[POLYHEDRON].show_status(words)
        self.hovered.emit(words)

    def _surface(self, name: str) -> Mesh | None:
        shape = self._shapes.get(name)
        return shape.mesh if shape is not None else None

    def _draw_fit(self) -> None:
        mesh, particle = self._surface(FIT), self._surface(PARTICLE)
        if mesh is None or particle is None:
            return
        ink = self._theme.surroundings
        distances = self._distances.between(mesh, particle) if self._heat else None
        if self._heat and distances is None:
            return  # what is shown stays until they are measured
        self.views[FIT].draw(
            lambda plotter: surfaces.show_fit(plotter, mesh, distances, None, ink, _distance_text)
        )
        if distances is None:
            self.frames[FIT].set_detail(self._size_of_fit)
        else:
            reach = float(np.abs(distances).max(initial=0.0))
            self.frames[FIT].set_detail(tr("at most {reach:.3g} µm from the particle", reach=reach))
        self._draw_extras(FIT)

    def _draw_polyhedron(self) -> None:
        solid = self._shapes.get(POLYHEDRON)
        if solid is None or isinstance(solid.surface, Mesh):
            return
        facets, centre, ink = solid.surface, solid.origin, self._theme.surroundings
        self.views[POLYHEDRON].draw(lambda plotter: surfaces.show_polyhedron(plotter, facets, centre, ink))
        self._draw_extras(POLYHEDRON)

    def _draw_extras(self, *names: str) -> None:
        for name in names:
            self.views[name].draw(partial(self._fill_extras, name))

    def _fill_extras(self, name: str, plotter: Any) -> None:
        """Box and star point of one view, or none of them."""
        ink, shape = self._theme.surroundings, self._shapes.get(name)
        boxed = shape is not None and bool(self._extras.get("box"))
        body = shape.body if shape is not None else None
        corners = minimum_volume_box(body).corners if boxed and body is not None else None
        if corners is not None and shape is not None:
            corners = corners + shape.origin
        overlays.show_box(plotter, corners, ink)
        seen = self._extras.get("star_point") and shape is not None and name != POLYHEDRON
        particle = self._surface(PARTICLE)
        size = float(np.ptp(particle.vertices, axis=0).max()) if particle is not None else 1.0
        overlays.show_star_point(plotter, self._star_point if seen else None, size, ink)
        if name == PARTICLE:
            overlays.show_hidden(plotter, particle, self._hidden_faces() if seen else None)

    def _hidden_faces(self) -> BoolArray | None:
        """Faces of the particle that the star point cannot see; looked for once a fit."""
        particle = self._surface(PARTICLE)
        if self._hidden is None and particle is not None and self._star_point is not None:
            self._hidden = hidden_faces(particle, self._star_point)
        return self._hidden

    def _empty_titles(self, *, waiting: bool) -> None:
        """Name the views; `waiting` says that fit and polyhedron of a particle are being computed."""
        soon = tr("being computed …") if waiting else ""
        late = tr("being computed; the first one takes longer …") if waiting else ""
        self.frames[PARTICLE].set_texts(tr("Particle"))
        self.frames[FIT].set_texts(tr("Spherical-harmonics fit"), soon, tr("Fit"))
        self.frames[POLYHEDRON].set_texts(tr("Polyhedron"), late)


def _distance_text(micrometres: float) -> str:
    return localized(distance_text(micrometres))


def _lengths(bounds: FloatArray) -> str:
    return " × ".join(number_text(edge, ".3g") for edge in bounds[1] - bounds[0]) + " µm"


def _left_out_text(particle: Particle) -> str:
    """A few words where bodies of a file were left out; they come first, as a narrow view cuts the end."""
    if particle.repair is None or not particle.repair.dropped_bodies:
        return ""
    return (
        tr("{share:.2g} % of the volume left out", share=100 * (1 - particle.repair.kept_volume_share)) + "; "
    )


def _missing_facets_text(results: Results) -> str:
    """A few words where a finished coarsening has fewer facets than were asked for."""
    done = results.coarsened
    if done is None or done.n_facets == done.n_facets_asked:
        return ""
    return tr("; {count} facets were requested", count=done.n_facets_asked)


class Distances(QObject):
    """Distances between fit and particle, kept while both are shown.

    ``measured`` is emitted for new ones, ``refused`` with the reason for none.

    ``follow``: does the work.
    """

    measured = Signal()
    refused = Signal(str)

    def __init__(self, follow: Follow, parent: QObject) -> None:
        super().__init__(parent)
        self._follow = follow
        self._known: tuple[Mesh, Mesh, FloatArray] | None = None
        self._wanted: tuple[Mesh, Mesh] | None = None

    def between(self, fit: Mesh, particle: Mesh) -> FloatArray | None:
        """Of each vertex of the fit, shape (n,), positive outside; nothing while they are being measured."""
        if self._known is not None and self._known[0] is fit and self._known[1] is particle:
            return self._known[2]
        if self._wanted is None or self._wanted[0] is not fit or self._wanted[1] is not particle:
            self._wanted = fit, particle
            job = Job(measure_distances, (fit, particle))
            self._follow(job, lambda distances: self._take(fit, particle, distances), self.refused.emit)
        return None

    def _take(self, fit: Mesh, particle: Mesh, distances: FloatArray) -> None:
        self._known = fit, particle, distances
        self.measured.emit()
