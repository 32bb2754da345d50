"""Lesson one: simulated annealing step by step, compared with the exact method."""

from functools import partial
from typing import Any

import numpy as np
from PySide6.QtWidgets import QLabel, QWidget

from regolith_studio.coarsening.progress import placed
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.lecture_jobs import AnnealingLesson, AnnealingStep
from regolith_studio.messages import N_
from regolith_studio.scene import surfaces
from regolith_studio.scene.comparison import OTHER, show_other
from regolith_studio.scene.lecture_scenes import show_move
from regolith_studio.scene.shapes import FIT, SceneShape
from regolith_studio.ui.layout import named, vbox
from regolith_studio.ui.pages.lecture import texts
from regolith_studio.ui.pages.lecture.lessons import PlaybackBar, lesson_columns
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink, ViewFrame
from regolith_studio.ui.widgets.formula import FormulaLabel, prepare
from regolith_studio.ui.widgets.labels import WrappedLabel
from regolith_studio.ui.widgets.plots.bars import BarPlot, BarSeries
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.table import definition

TRANSLUCENT = 0.6
"""Opacity of a polyhedron that is shown with the edges of another one."""
WAIT = N_("Simulated annealing is running …")


class AnnealingView(QWidget):
    """Two polyhedra, text and formulas of a step, and three plots.

    ``kind``: ``live`` or ``image``, of the views.
    """

    def __init__(self, kind: str) -> None:
        super().__init__()
        self.setObjectName("lesson_annealing")
        self._theme = current_theme()
        self._lesson: AnnealingLesson | None = None
        self._kind = kind

    def build(self) -> None:
        """Make the parts, right after construction."""
        self.frames: dict[str, ViewFrame] = {}
        for name in ("annealing", "exact"):
            self.frames[name] = ViewFrame(make_view(self._kind), f"lecture_{name}", colour="polyhedron")
        self.link = CameraLink([frame.view for frame in self.frames.values()])
        self.sentence = named(WrappedLabel(tr(WAIT)), "annealing_sentence")
        self.loss_formula = FormulaLabel(tr("The loss with its numbers"))
        self.rule = FormulaLabel(tr("The proposal, T(k) and the decision with their numbers"))
        self.exact_formula = FormulaLabel(tr("The loss of the exact method"))
        self.loss = CurvePlot(tr("Step k"), tr("Loss L"), tr(WAIT))
        self.chance = CurvePlot(tr("Step k"), tr("Probability"), tr(WAIT))
        self.terms = BarPlot(tr("Term of the loss"), "α ε", tr(WAIT), unit="")
        for plot, name in ((self.loss, "loss"), (self.chance, "chance"), (self.terms, "terms")):
            plot.fit_to_font()
            plot.setObjectName(f"annealing_{name}")
        self.frames["annealing"].set_texts(tr("Annealing"))
        self.frames["exact"].set_texts(tr("Exact method"))
        self.playback = PlaybackBar("annealing", N_("step"), self._is_ready)
        self.playback.stepChanged.connect(self._show_step)
        self._arrange()

    def show_lesson(self, lesson: AnnealingLesson) -> None:
        """Show a lesson; if it is the present one, show the result of the exact method."""
        before = self._lesson
        fresh = before is None or before.steps is not lesson.steps
        complete = lesson.exact is not None and (before is None or before.exact is not lesson.exact)
        self._lesson = lesson
        if fresh:
            self.playback.pause()
            self.playback.set_count(len(lesson.steps))
        if fresh or complete:
            self.link.frame(_outline(lesson))
        self._show_exact()
        self._show_step(self.playback.step)

    def wait(self, sentence: str = WAIT) -> None:
        self.sentence.setText(tr(sentence))

    @property
    def step(self) -> AnnealingStep | None:
        """The current step."""
        return self._lesson.steps[self.playback.step] if self._lesson is not None else None

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        if self._lesson is not None:
            self._show_exact()
            self._show_step(self.playback.step)

    def release(self) -> None:
        """Stop, and release graphics memory."""
        self.playback.pause()
        for frame in self.frames.values():
            frame.view.release()

    def colour_of(self, step: AnnealingStep) -> str:
        """Colour of a step: rejected moves orange-red, improvements green, uphill moves blue."""
        theme = self._theme
        return {texts.REFUSED: theme.bad, texts.ACCEPTED: theme.good, texts.LUCKY: theme.fit}.get(
            texts.outcome_of(step), theme.muted
        )

    def _is_ready(self, number: int) -> bool:
        """Whether the formulas of a step are set, so that it shows one step everywhere."""
        lesson = self._lesson
        if lesson is None or number >= len(lesson.steps):
            return True
        step = lesson.steps[number]
        return prepare((*texts.loss_lines(lesson.weights, step.evaluation), *texts.rule_lines(step, lesson)))

    def _show_step(self, number: int) -> None:
        lesson = self._lesson
        if lesson is None:
            return
        step = lesson.steps[number]
        self.sentence.setText(texts.sentence_of(step, lesson))
        self.loss_formula.set_lines(*texts.loss_lines(lesson.weights, step.evaluation))
        self.rule.set_lines(*texts.rule_lines(step, lesson))
        self.frames["annealing"].view.draw(partial(self._fill_step, step))
        solid = step.polyhedron
        self.frames["annealing"].set_texts(
            tr("Annealing, step {number} of {count}", number=step.number, count=len(lesson.steps) - 1),
            tr(
                "loss {loss:.4g}; {facets} facets of {planes} planes",
                loss=step.evaluation.loss,
                facets=solid.n_facets,
                planes=lesson.n_facets,
            ),
        )
        self._plot_loss(number)
        self._plot_chance(number)
        self._plot_terms(step)

    def _fill_step(self, step: AnnealingStep, plotter: Any) -> None:
        lesson, move = self._lesson, step.move
        if lesson is None:
            return
        taken = move is not None and move.accepted
        facet, other_facet = (step.proposed_facet, step.facet) if taken else (step.facet, step.proposed_facet)
        other = step.before if taken else step.proposal
        ink = self._theme.surroundings
        show_move(
            plotter, step.polyhedron, facet, other, other_facet, lesson.centre, self.colour_of(step), ink
        )
        actor = plotter.actors[surfaces.SURFACE]
        actor.prop.culling = "back"
        actor.prop.opacity = 1.0 if other is None else TRANSLUCENT

    def _show_exact(self) -> None:
        lesson, frame = self._lesson, self.frames["exact"]
        exact = lesson.exact if lesson is not None else None
        if lesson is None or exact is None:
            frame.view.draw(surfaces.clear)
            frame.set_texts(tr("Exact method"), tr("being computed …"))
            self.exact_formula.set_lines()
            return
        overlay = SceneShape(FIT, lesson.approximated)
        solid, centre = exact.polyhedron, exact.centre

        def fill(plotter: Any) -> None:
            surfaces.show_polyhedron(plotter, solid, centre, self._theme.surroundings)
            show_other(plotter, overlay, True)
            surfaces.set_opacity(plotter, 0.15, OTHER)

        frame.view.draw(fill)
        frame.set_texts(
            tr("Exact method"),
            tr(
                "loss {loss:.4g}; {facets} facets; translucent: target",
                loss=exact.loss,
                facets=exact.n_facets,
            ),
        )
        self.exact_formula.set_lines(*texts.exact_lines(lesson))

    def _plot_loss(self, number: int) -> None:
        lesson, theme = self._lesson, self._theme
        if lesson is None:
            return
        seen = lesson.steps[: number + 1]
        k = tuple(float(step.number) for step in seen)
        present = PlotCurve(tr("current"), theme.polyhedron, k, tuple(step.evaluation.loss for step in seen))
        curves = [present, *self._proposals(seen)]
        if lesson.exact is not None:
            ends = (0.0, float(len(lesson.steps) - 1))
            curves.append(
                PlotCurve(tr("exact method"), theme.particle, ends, (lesson.exact.loss,) * 2, dash=True)
            )
        self.loss.set_curves(curves)
        self.loss.set_marker(float(number))
        highest = max(step.evaluation.loss for step in lesson.steps)
        self.loss.canvas.getViewBox().setXRange(0, len(lesson.steps) - 1, padding=0.01)
        self.loss.canvas.getViewBox().setYRange(0.0, 1.6 * highest, padding=0.0)

    def _proposals(self, seen: tuple[AnnealingStep, ...]) -> list[PlotCurve]:
        curves = []
        for outcome, label, colour in (
            (texts.ACCEPTED, tr("better"), self._theme.good),
            (texts.LUCKY, tr("worse, accepted"), self._theme.fit),
            (texts.REFUSED, tr("rejected"), self._theme.bad),
        ):
            chosen = [
                (float(step.number), step.move.proposed.loss)
                for step in seen
                if step.move is not None
                and step.move.proposed is not None
                and texts.outcome_of(step) == outcome
            ]
            x, y = zip(*chosen, strict=True) if chosen else ((), ())
            curves.append(PlotCurve(label, colour, tuple(x), tuple(y), markers=True, line=False))
        return curves

    def _plot_chance(self, number: int) -> None:
        lesson, theme = self._lesson, self._theme
        if lesson is None:
            return
        k = np.arange(len(lesson.steps))
        chance = tuple(float(lesson.settings.acceptance_probability(int(each))) for each in k)
        drawn = [(float(step.number), step.move.drawn) for step in lesson.steps[1 : number + 1] if step.move]
        x, y = zip(*drawn, strict=True) if drawn else ((), ())
        self.chance.set_curves(
            [
                PlotCurve("T(k)", theme.fit, tuple(map(float, k)), chance),
                PlotCurve(tr("drawn u"), theme.muted, tuple(x), tuple(y), markers=True, line=False),
            ]
        )
        self.chance.set_marker(float(number))
        self.chance.canvas.getViewBox().setXRange(0, len(lesson.steps) - 1, padding=0.01)
        self.chance.canvas.getViewBox().setYRange(0.0, 1.0, padding=0.02)

    def _plot_terms(self, step: AnnealingStep) -> None:
        lesson, theme = self._lesson, self._theme
        if lesson is None:
            return
        move = step.move
        before = texts.terms_of(lesson.weights, move.before if move else step.evaluation)
        series = [BarSeries(tr("before"), theme.particle, tuple(before.values()))]
        if move is not None and move.proposed is not None:
            proposed = texts.terms_of(lesson.weights, move.proposed)
            series.append(BarSeries(tr("proposed"), self.colour_of(step), tuple(proposed.values())))
        if lesson.exact is not None:
            exact = texts.exact_terms(lesson)
            series.append(BarSeries(tr("exact method"), theme.polyhedron, tuple(exact.values())))
        tips = [definition(key) for key in before]
        self.terms.set_bars([texts.plain(key) for key in before], series, tips=tips)

    def _arrange(self) -> None:
        of_exact = QLabel(tr("Exact method:"))
        parts = lesson_columns(
            "lecture_annealing",
            list(self.frames.values()),
            [self.loss, self.chance],
            [self.sentence, self.rule, self.loss_formula, of_exact, self.exact_formula],
            self.terms,
        )
        vbox((parts, 1), self.playback, parent=self)


def _outline(lesson: AnnealingLesson) -> FloatArray:
    """Points of all that the views show before a move and beside it, shape (n, 3): all stay whole in them."""
    solids = [placed(lesson.steps[0].polyhedron, lesson.centre)]
    if lesson.exact is not None:
        solids.append(placed(lesson.exact.polyhedron, lesson.exact.centre))
    return np.vstack([lesson.approximated.vertices, *(each.vertices for each in solids)])
