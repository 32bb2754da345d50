"""The page of the three views: sliders, method, descriptors; all work is done by the session."""

import asyncio
from typing import Any

from trame.ui.html import DivLayout
from trame.widgets import client, html, vtk

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.settings import FACETS_LIMITS
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.harmonics.fit_options import FIT_DEGREE
from regolith_studio.scene.figure import SideBySide, view_titles
from regolith_studio.scene.shapes import FIT, NAMES, PARTICLE, POLYHEDRON, SceneShape
from regolith_studio.session.assessment import assess_polyhedron
from regolith_studio.session.results import Failure
from regolith_studio.session.session import Session

STYLE = """
html, body, #app { height: 100%; margin: 0; }
body { font: 14px/1.4 system-ui, sans-serif; color: #2b2f36; background: #f4f6f8; }
.page { display: flex; height: 100vh; }
.views { flex: 1; display: flex; flex-direction: column; min-width: 0; }
.titles { display: flex; }
.titles > div { flex: 1; padding: 6px 8px; text-align: center; min-width: 0; }
.picture { flex: 1; min-height: 240px; position: relative; }
.controls { width: 372px; box-sizing: border-box; padding: 10px 14px; overflow-y: auto; background: #fff; }
.controls { border-left: 1px solid #d5dbe1; }
.control { display: block; margin-bottom: 10px; }
.control > span { display: block; margin-bottom: 2px; }
.control > input, .control > select { width: 100%; box-sizing: border-box; font: inherit; }
.status { color: #56606c; min-height: 1.4em; }
.assessment { margin: 6px 0 10px; }
table { border-collapse: collapse; width: 100%; font-size: 12.5px; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: 2px 4px; border-bottom: 1px solid #e4e8ec; }
td:first-child { text-align: left; white-space: nowrap; }
@media (max-width: 900px) {
  .page { flex-direction: column; height: auto; min-height: 100vh; }
  .picture { height: 46vh; flex: none; }
  .controls { width: auto; border-left: 0; }
}
"""

EVENTS = ("particles", "choices", "fit", "surface", "descriptors", "coarsening", "comparison", "tasks")
PICTURE_INTERVAL = 0.05
"""Seconds between two pictures that are sent while results arrive."""
CHOICES = ("selected", "l_max", "n_facets", "method")
"""Choices of the session that the page can change, each a variable of the page of the same name."""


class ThreeViewPage:
    """Shows a session on a page, and passes changes of the page on to it.

    Everybody who has the page open sees, and changes, the same session.

    ``server``: a trame server that has not been started. ``session``: with its particles; its events arrive
    in the thread of the server's event loop, where the page must be made, too.
    """

    def __init__(self, server: Any, session: Session) -> None:
        self._server, self._session = server, session
        self._scene = SideBySide()
        self._shown: dict[str, Any] = {}
        self._due: asyncio.TimerHandle | None = None
        self._problem = ""
        self._write_state()
        server.state.change(*CHOICES)(self._choose)
        for name in EVENTS:
            getattr(session.events, name).connect(self._refresh_soon)
        session.events.failed.connect(self._report)
        self._build()

    def close(self) -> None:
        """Free the views."""
        if self._due is not None:
            self._due.cancel()
        self._scene.close()

    def _build(self) -> None:
        with DivLayout(self._server, classes="page"):
            client.Style(STYLE)
            with html.Div(classes="views"):
                with html.Div(classes="titles"):
                    html.Div("{{ title }}", v_for="title in titles", key=("title",))
                with html.Div(classes="picture"):
                    self._view = vtk.VtkRemoteView(self._scene.render_window, interactive_ratio=1)
            with html.Div(classes="controls"):
                _selection("Particle", "selected", "particles")
                _slider("Maximum degree l_max", "l_max", 0, FIT_DEGREE)
                _slider("Facets", "n_facets", *FACETS_LIMITS)
                _selection("Coarsening method", "method", "methods")
                html.Div("{{ status }}", classes="status", id="status")
                html.Div("{{ assessment }}", classes="assessment", id="assessment")
                self._build_table()

    def _build_table(self) -> None:
        with html.Table(id="descriptors"):
            with html.Thead(), html.Tr():
                for head in ("", "Particle", "Fit", "Polyhedron"):
                    html.Th(head)
            with html.Tbody(), html.Tr(v_for="row in rows", key=("row[0]",)):
                html.Td("{{ cell }}", v_for="(cell, at) in row", key=("at",))

    def _choose(self, **state: Any) -> None:
        """Take over what has been changed on the page."""
        choices = self._session.choices
        changes = {name: state[name] for name in CHOICES if state[name] != getattr(choices, name)}
        self._problem = ""
        try:
            self._session.choose(**changes)
        except RegolithError as error:
            self._problem = str(error)
        self._refresh_soon()

    def _report(self, failure: Failure) -> None:
        self._problem = failure.sentence
        self._refresh_soon()

    def _refresh_soon(self) -> None:
        """Refresh the page once for all events of the next moment."""
        if self._due is None:
            self._due = asyncio.get_running_loop().call_later(PICTURE_INTERVAL, self._refresh)

    def _refresh(self) -> None:
        self._due = None
        with self._server.state:
            self._write_state()
        if self._draw():
            self._view.update()

    def _draw(self) -> bool:
        """Fill the views with what has changed; whether anything has."""
        entry, results = self._session.selected, self._session.results
        particle = entry.particle.mesh if entry else None
        wanted = {PARTICLE: particle, FIT: results.surface, POLYHEDRON: results.polyhedron}
        changed = [name for name in NAMES if wanted[name] is not self._shown.get(name)]
        if particle is not None and PARTICLE in changed:
            self._scene.frame(particle.vertices)
        for name in changed:
            surface = wanted[name]
            if surface is None:
                self._scene.clear(name)
            else:
                centre = results.best.centre if name == POLYHEDRON and results.best else None
                self._scene.show(SceneShape(name, surface, centre))
        self._shown = wanted
        return bool(changed)

    def _write_state(self) -> None:
        """Put choices and results into the variables of the page."""
        session, state = self._session, self._server.state
        for name in CHOICES:
            state[name] = getattr(session.choices, name)
        state.trame__title = "Regolith Studio"
        state.particles = [{"value": each.id, "label": each.id} for each in session.particles]
        state.methods = [{"value": key, "label": str(each.label)} for key, each in METHODS.items()]
        state.titles = self._titles()
        state.rows = self._rows()
        state.status = self._problem or "; ".join(_task_line(each) for each in session.tasks) or "Done."
        state.assessment = self._assessment()

    def _titles(self) -> list[str]:
        results, body = self._session.results, self._session.results.polyhedron
        degree = results.surface_l_max if results.surface else self._session.choices.l_max
        entry = self._session.selected
        title = entry.particle.name if entry else "Particle"
        if isinstance(body, ConvexPolyhedron):
            return list(map(str, view_titles(title, degree, body)))
        parts = f"Compound of {body.n_parts} convex parts" if body else "Polyhedron"
        return [title, f"Spherical-harmonics fit, l_max = {degree}", parts]

    def _rows(self) -> list[list[str]]:
        """Symbol with unit, then the value of particle, fit and polyhedron, of each descriptor."""
        results = self._session.results
        achieved = results.coarsened.achieved if results.coarsened else None
        bodies = (results.particle_descriptors, results.fit_descriptors, achieved)
        shown = {key: row for key, row in CATALOGUE.items() if not row.costly}
        return [
            [
                f"{row.symbol} {row.unit_symbol}".strip(),
                *(f"{body[key]:.4g}" if body and key in body else "–" for body in bodies),
            ]
            for key, row in shown.items()
        ]

    def _assessment(self) -> str:
        results = self._session.results
        if results.coarsened is None:
            return ""
        rating = assess_polyhedron(
            results.coarsened, self._session.choices.weights, results.against_particle, results.fewer_facets
        )
        return f"Loss {rating.loss:.4g}, Jaccard distance {rating.jaccard_distance:.3g}. {rating.sentence}"


def _slider(label: str, name: str, low: int, high: int) -> None:
    with html.Label(classes="control"):
        html.Span(f"{label} = {{{{ {name} }}}}")
        html.Input(type="range", min=low, max=high, raw_attrs=[f'v-model.number="{name}"'], id=name)


def _selection(label: str, name: str, options: str) -> None:
    with html.Label(classes="control"):
        html.Span(label)
        with html.Select(v_model=(name,), id=name):
            html.Option(
                "{{ option.label }}",
                v_for=f"option in {options}",
                key=("option.value",),
                value=("option.value",),
            )


def _task_line(task: Any) -> str:
    return f"{task.title}: {task.done} of {task.total}" if task.total else str(task.title)
