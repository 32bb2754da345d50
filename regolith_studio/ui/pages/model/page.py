"""Page "Shape model": controls, spectrum with a drawn particle, gallery and evaluation."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFileDialog, QWidget

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.synthesis import level_for
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.model_jobs import (
    GenerationRequest,
    GenerationResult,
    ModelFitResult,
    compare_distributions,
    draw_live,
    draw_shapes,
    evaluate_models,
    fit_shapes,
    make_card,
    make_particles,
)
from regolith_studio.messages import N_, Message
from regolith_studio.readers.shape_files import ShapeSource, read_shape_source
from regolith_studio.session.provenance import VirtualSource
from regolith_studio.shape_models.materials import MaterialCard, write_card
from regolith_studio.shape_models.models import MODELS, write_model
from regolith_studio.shape_models.protocol import EditableModel, FittedModel, relative_amplitudes
from regolith_studio.shape_models.sample import Sample
from regolith_studio.ui.layout import FoldingSplitter, hbox, padded, scrolled_column, stacked, tabs
from regolith_studio.ui.page import PageContext, PageWidget, ValuePanel
from regolith_studio.ui.pages.model.controls import (
    DistributionsPanel,
    DrawControls,
    LiveShape,
    ShapeGallery,
    SourceControls,
    default_degree,
    request_from,
)
from regolith_studio.ui.pages.model.evaluation import EvaluationPanel
from regolith_studio.ui.pages.model.sources import OPEN_PARTICLES, SourceBox, is_drawn, name_of, usual_sizes
from regolith_studio.ui.result_card import ResultRecord, RunController
from regolith_studio.ui.translation import number_text, tr, translate
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.widgets.labels import short_number
from regolith_studio.ui.widgets.toast import Toast

MODEL_FILES, CARD_FILES = N_("Models (*.json)"), N_("Cards (*.json)")


def save_model(parent: QWidget, toast: Toast, model: FittedModel, source: ShapeSource) -> None:
    name, _ = QFileDialog.getSaveFileName(parent, tr("Save the model"), "model.json", tr(MODEL_FILES))
    if not name:
        return
    path = _json_path(name)
    with toast.reporting():
        write_model(path, model, {"source": source.name, "sha256": source.sha256 or None})
        toast.note(tr("Saved {name}.", name=path.name))


def save_card(parent: QWidget, context: PageContext, sample: Sample, source: ShapeSource) -> None:
    """Ask for a name and write the card of a sample; the file's name becomes that of the material."""
    name, _ = QFileDialog.getSaveFileName(parent, tr("Save a material card"), "material.json", tr(CARD_FILES))
    if not name:
        return
    path = _json_path(name)
    key = re.sub(r"[^a-z0-9_]+", "_", path.stem.lower()).strip("_") or "material"
    template = N_("Statistics of {count} particles of {name}, made by Regolith Studio.")
    origin = Message(template, count=len(sample), name=source.name)
    job = Job(make_card, (sample, key, path.stem, origin))
    context.start(tr("Making a material card"), job, partial(_write_card, context.toast, path), queue="card")


def _json_path(name: str) -> Path:
    """The path of a name that the user may have typed without its suffix."""
    return Path(name if name.endswith(".json") else f"{name}.json")


def _write_card(toast: Toast, path: Path, card: MaterialCard) -> None:
    try:
        write_card(card, path)
    except (RegolithError, OSError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        toast.problem(tr("The card {name} cannot be written ({reason}).", name=path.name, reason=reason))
        return
    toast.note(tr("Saved {name}.", name=path.name))


def drawn_record(drawn: GenerationResult, fitted: ModelFitResult | None) -> ResultRecord:
    """The drawn particles as their card shows them."""
    count, ends, rejected = len(drawn.draws), drawn.radii, drawn.draws.rejected
    radii = " – ".join(short_number(end, 3) for end in ends) if ends is not None else "–"
    degree, seed = drawn.model.l_max, drawn.request.seed
    made_with = tr(
        "{model}, l_max = {degree}, seed {seed}",
        model=tr(MODELS[drawn.model.key].label),
        degree=degree,
        seed=seed,
    )
    note = tr("{count:,} draws rejected", count=rejected) + "." if rejected else ""
    source = tr("Drawn from {name}", name=name_of(fitted.source)) if fitted is not None else ""
    return ResultRecord((number_text(count, ","), radii), source, made_with, note=note)


SOURCE_FILTER = N_("Fits, models and material cards (*.json);;All files (*)")
DRAWN = N_("A drawn particle")
MAX_ADOPTED = 2000
"""Maximum number of drawn particles that are opened, as each becomes a mesh in memory."""


class ModelPage(PageWidget):
    """Starts jobs for models, particles and evaluations, and shows their results."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("model")
        self._context = context
        self._sources = SourceBox(context.session)
        self._fitted: ModelFitResult | None = None
        self._model: FittedModel | None = None
        self._fitted_to: tuple[object, ...] = ()
        self._drawn: GenerationResult | None = None
        self._drawn_for: tuple[object, ...] | None = None
        self._live_seed = 0
        self._unread: tuple[str, dict[str, bool]] | None = (
            None  # source of a project, and what was made of it
        )

    def build(self) -> None:
        views, bindings = self._context.views, self._context.bindings
        self.source = SourceControls()
        self.drawing = DrawControls()
        self.live, self.gallery = LiveShape(make_view(views)), ShapeGallery(make_view(views))
        self.distributions = DistributionsPanel()
        self.evaluation = EvaluationPanel()
        self.judging = RunController(self._context, self.evaluation.card, "evaluate", self.evaluate)
        self.draws = RunController(self._context, self.drawing.card, "draw", self.draw)
        self.fitting = RunController(self._context, self.drawing.card, "fit", None)
        self._place()
        self._connect()
        bindings.refresh("particles", self._show_sources)

    # --- the page of the window ----------------------------------------------------------------

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "open_source": self.open_source,
            "fit_model": self.fit_model,
            "draw": self.draw,
            "another": self.another,
            "judge": self.evaluate,
            "adopt": self.adopt,
            "save_model": self.save_model,
            "save_card": self.save_card,
        }

    def panels(self) -> Mapping[str, ValuePanel]:
        return {"source": self.source, "drawing": self.drawing, "evaluation": self.evaluation}

    def state(self) -> dict[str, Any]:
        made = {"fitted": self._fitted is not None, "drawn": self._drawn is not None}
        state = self.settings() | {"made": made if made["fitted"] else {}}
        if self._sources.paths:
            state["files"] = dict(self._sources.paths)
        if self._unread is not None:
            state |= {"source": state["source"] | {"source": self._unread[0]}, "made": self._unread[1]}
        return state

    def resume(self, state: Mapping[str, Any]) -> None:
        made = state.get("made") or {}
        self._show_sources()
        if self._unread is not None:
            return
        if made.get("drawn"):
            self.draw()
        elif made.get("fitted"):
            self.fit_model()

    def restore(self, state: Mapping[str, Any]) -> None:
        files = state.get("files")
        if isinstance(files, Mapping):
            for problem in self._sources.restore({str(key): str(path) for key, path in files.items()}):
                self._context.toast.problem(problem)
            self._show_sources()
        super().restore(state)
        chosen = str(dict(state.get("source") or {}).get("source"))
        is_unread = chosen in self._sources.paths and chosen not in self._sources.labels()
        self._unread = (chosen, state.get("made") or {}) if is_unread else None

    def on_close(self) -> None:
        self.live.frame.view.release()
        self.gallery.frame.view.release()

    # --- commands ------------------------------------------------------------------------------

    def open_source(self) -> None:
        """Ask for a fit, model or card and select it."""
        name, _ = QFileDialog.getOpenFileName(self, tr("Open a fit, model or card"), "", tr(SOURCE_FILTER))
        if name:
            self.open_path(Path(name))

    def open_path(self, path: Path) -> None:
        """Select a fit, model or card in a file."""
        self._try(lambda: self._add(read_shape_source(str(path)), path))

    def fit_model(self) -> None:
        """Fit the selected model to the selected sample, or take the model of the source."""
        self._try(self._fit)

    def draw(self) -> None:
        """Draw the particles; fit the model first unless it is fitted to what is selected."""
        self._try(self._draw)

    def another(self) -> None:
        """Show another particle of the model, with the next seed."""
        if self._model is None:
            self._context.toast.problem(tr("There is no model to draw from: fit one first."))
            return
        self._live_seed += 1
        self._request_live(again=True)

    def evaluate(self) -> None:
        """Evaluate the selected model, or all."""
        self._try(self._evaluate)

    def adopt(self) -> None:
        if self._drawn is None or self._fitted is None:
            self._context.toast.problem(tr("There are no drawn particles yet: draw some first."))
            return
        draws = self._drawn.draws
        if len(draws) > MAX_ADOPTED:
            self._context.toast.problem(
                tr(
                    "{count:,} particles are too many to open; at most {most:,}. For more use: "
                    "regolith-studio generate.",
                    count=len(draws),
                    most=MAX_ADOPTED,
                )
            )
            return
        answer = self._context.commands.ask_before_making()
        if not answer:
            return
        level = level_for(draws.l_max)
        origin = VirtualSource.of(self._drawn, self._fitted, level)
        job = Job(make_particles, (draws, self._drawn.model, origin.population.name, level))
        self._context.start(
            tr("Making virtual particles"),
            job,
            lambda made: self._take_over(made, origin, answer),
            queue="adopt",
        )

    def save_model(self) -> None:
        if self._model is None or self._fitted is None:
            self._context.toast.problem(tr("There is no model to save: fit one first."))
            return
        save_model(self, self._context.toast, self._model, self._fitted.source)

    def save_card(self) -> None:
        sample = self._sample()
        if sample is None or self._fitted is None:
            self._context.toast.problem(tr("A material card needs a model of a sample: fit one first."))
            return
        save_card(self, self._context, sample, self._fitted.source)

    # --- work ----------------------------------------------------------------------------------

    def _fit(self, then: Callable[[], None] | None = None) -> None:
        """Fit the model; where something follows, the card of the drawn particles says how far it is."""
        origin, fitted_to = self._sources.origin(self.source.value()["source"]), self._to_fit()
        job = Job(fit_shapes, (origin, self._request(), bool(self.source.value()["half"])))

        def show(fitted: ModelFitResult) -> None:
            self._fitted_to = fitted_to
            self._show_fitted(fitted)
            if then is not None:
                then()

        title = tr("Fitting a model of shapes")
        if then is None:
            if self.fitting.running:
                self.fitting.forget()
            self._context.start(title, job, show, queue="fit")
        else:
            self.fitting.start(title, job, show)

    def _to_fit(self) -> tuple[object, ...]:
        """What a fit depends on; drawn particles that are open count as those that they were drawn from."""
        chosen, request = self.source.value(), self._request()
        seed = request.seed if chosen["half"] else 0
        entries = self._context.session.particles if chosen["source"] == OPEN_PARTICLES else ()
        drawn = bool(entries) and all(map(is_drawn, entries))
        particles = self._fitted_to[-1:] if drawn else (tuple(entry.particle for entry in entries),)
        return chosen["source"], chosen["half"], replace(request, n=1, size_range=None, seed=seed), *particles

    def _draw(self) -> None:
        if self._model is None or self._fitted_to != self._to_fit():
            self._fit(then=lambda: self._try(self._draw_fitted))
        else:
            self._draw_fitted()

    def _draw_fitted(self) -> None:
        job = Job(draw_shapes, (self._model, self._request()))
        self._drawn_for = self._to_fit(), self.drawing.value()
        self.draws.start(tr("Drawing particles"), job, self._show_drawn)

    def _evaluate(self) -> None:
        sample = self._sample()
        if sample is None:
            raise InputError(tr("Models are evaluated on measured particles: fit one to a sample first."))
        request, chosen = self._request(), self.evaluation.value()
        key = str(self.source.value()["model"])
        default = min(default_degree(key), sample.l_max)
        options = {
            "l_max": None if request.l_max == default else request.l_max,
            "n_splits": chosen["splits"],
            "n_repeats": chosen["repeats"],
            "seed": request.seed,
        }
        job = Job(evaluate_models, (sample, None if chosen["all_models"] else (key,)), options)
        self.judging.start(tr("Evaluating models"), job, self.evaluation.show_evaluated)

    def _request(self) -> GenerationRequest:
        source = self.source.value()
        return request_from(source, self.drawing.value(), self._sources.kind(source["source"]).brings_model)

    # --- results -------------------------------------------------------------------------------

    def _show_fitted(self, fitted: ModelFitResult) -> None:
        self._fitted, self._model, self._drawn = fitted, fitted.model, None
        model = fitted.model
        self.live.spectrum.setValue(relative_amplitudes(model), editable=isinstance(model, EditableModel))
        self._live_seed = 0
        if fitted.first is None:
            self._request_live()  # which shows why there is none
        else:
            self._show_live(fitted, fitted.first, again=True)
        self.gallery.show_shapes(fitted.examples, ())
        self._context.stop("compare")
        self.draws.forget()
        self.distributions.show_compared(None)
        self.evaluation.show_evaluated(None)
        self.judging.forget()
        self._show_state()
        self.drawing.show_names(getattr(model, "names", ()))
        if (sizes := usual_sizes(fitted.source)) is not None:
            self.drawing.suggest(*sizes)
        if fitted.source.notes:
            self._context.toast.problem(fitted.source.notes[0], "\n".join(fitted.source.notes))

    def _show_drawn(self, drawn: GenerationResult) -> ResultRecord:
        self._drawn = drawn
        self.gallery.show_shapes(self._fitted.examples if self._fitted else (), drawn.examples)
        job = Job(compare_distributions, (self._sample(), drawn.draws, drawn.request.size_range))
        self.distributions.show_waiting()
        self._context.start(
            tr("Comparing distributions"),
            job,
            self.distributions.show_compared,
            failed=self._fail_to_compare,
            stopped=lambda: self.distributions.show_compared(None),
            queue="compare",
            repeats=True,
        )
        self._show_state()
        return drawn_record(drawn, self._fitted)

    def _fail_to_compare(self, failure: Failed) -> None:
        self.distributions.show_compared(None)
        self._context.toast.problem(failure.sentence, failure.details)

    def _request_live(self, again: bool = False) -> None:
        """Draw the particle of the present model and seed."""
        fitted = self._fitted
        if self._model is None or fitted is None:
            self.live.show_mesh(None)
            return
        self._context.start(
            tr("Drawing particles"),
            Job(draw_live, (self._model, self._live_seed)),
            lambda mesh: self._show_live(fitted, mesh, again),
            failed=lambda failure: self.live.frame.set_texts(tr(DRAWN), translate(failure.sentence)),
            queue="live",
            repeats=True,
            after_running=True,
        )

    def _show_live(self, fitted: ModelFitResult, mesh: Mesh, again: bool) -> None:
        if fitted is self._fitted:
            radius = float(np.cbrt(3 * mesh.volume / (4 * np.pi)))
            self.live.show_mesh(mesh, tr("equivalent radius {radius:.3g} µm", radius=radius), again)

    def _edit(self, amplitudes: np.ndarray[Any, np.dtype[np.float64]]) -> None:
        if self._fitted is not None and isinstance(model := self._fitted.model, EditableModel):
            self._model = model.with_amplitudes(amplitudes) if self.live.spectrum.is_changed() else model
            self._request_live()

    def _rename(self, names: tuple[str, ...]) -> None:
        model: Any = self._model
        if not hasattr(model, "renamed") or names == model.names:
            return
        try:
            self._model = model.renamed(names)
            if self._drawn is not None and isinstance(self._drawn.model, type(model)):
                self._drawn = replace(self._drawn, model=self._drawn.model.renamed(names))
        finally:
            self.drawing.show_names(getattr(self._model, "names", ()))

    def _take_over(self, particles: tuple[Particle, ...], origin: VirtualSource, answer: str) -> None:
        if self._context.commands.adopt(particles, origin, answer):
            self._context.toast.note(tr("{count:,} virtual particles are open now.", count=len(particles)))

    # --- the state of the controls -------------------------------------------------------------

    def _show_sources(self) -> None:
        self.source.set_sources(self._sources.labels())
        self._show_source()

    def _on_source(self) -> None:
        self._unread = None
        self._show_source()

    def _show_source(self) -> None:
        kind = self._sources.kind(self.source.value()["source"])
        self.source.show_kind(kind.brings_model, kind.max_degree, kind.words)
        self._show_state()

    def _show_state(self) -> None:
        known = self.source.value()["source"] != OPEN_PARTICLES or bool(self._context.session.particles)
        self.drawing.set_ready(source=known, drawn=self._drawn is not None)
        missing = tr("Fit a model to a sample of 20 particles or more.")
        self.evaluation.card.set_startable("" if self._sample() else missing)
        self._mark_drawn()

    def _mark_drawn(self) -> None:
        """Mark the drawn particles as outdated where they are not what would be drawn now."""
        try:
            asked = self._to_fit(), self.drawing.value()
        except RegolithError:  # the radii contradict each other
            asked = None
        self.draws.set_outdated(asked != self._drawn_for)

    def _sample(self) -> Sample | None:
        content = self._fitted.source.content if self._fitted else None
        return content if isinstance(content, Sample) else None

    def _add(self, source: ShapeSource, path: Path) -> None:
        key = self._sources.add(source, path)
        self.source.set_sources(self._sources.labels())
        self.source.choose_source(key)
        self._show_source()

    def _try(self, action: Callable[[], None]) -> None:
        with self._context.toast.reporting():
            action()

    def _place(self) -> None:
        shown = [(self.gallery, tr("Gallery")), (self.distributions, tr("Distributions"))]
        self._tabs = tabs("model_tabs", [*shown, (self.evaluation, tr("Evaluation"))])
        middle = stacked([self.live, self._tabs], [380, 420], stretch=1)
        middle.setObjectName("model_rows")
        controls = scrolled_column([self.source, self.drawing])
        columns = FoldingSplitter(padded(middle, 10, 10, 2, 8), controls, (900, 310))
        columns.setObjectName("model_columns")
        hbox(columns, parent=self)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        bar = self._tabs.tabBar().sizeHint().height()
        self._tabs.setMinimumHeight(bar + self.gallery.minimumSizeHint().height())

    def _connect(self) -> None:
        self.source.sourceChanged.connect(lambda _: self._on_source())
        self.source.open.clicked.connect(self.open_source)
        self.source.fit.clicked.connect(self.fit_model)
        for panel in (self.source, self.drawing):
            panel.requestChanged.connect(self._mark_drawn)
        self.drawing.adopt.clicked.connect(self.adopt)
        self.drawing.namesChanged.connect(lambda names: self._try(lambda: self._rename(names)))
        self.live.spectrum.valueChanged.connect(self._edit)
        self.live.reset.clicked.connect(self.live.spectrum.reset)
        self.live.another.clicked.connect(self.another)
