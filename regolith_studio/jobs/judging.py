"""For the window: a model with examples of its sample, drawn particles, judged models as pictures."""

from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from regolith_studio.errors import GeometryError, RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.surface import reconstruct
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.generating import (
    GenerateOrder,
    draw,
    expansion_of,
    fit_model,
    sample_of_meshes,
)
from regolith_studio.jobs.studying import study_population
from regolith_studio.readers.shape_files import ShapeSource
from regolith_studio.shape_models.draws import Draws, virtual_mesh
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import PopulationStudy, drawn_by_itself
from regolith_studio.studies.population_distances import WEIGHTINGS

if TYPE_CHECKING:  # matplotlib: the page is opened more often than models are judged on it
    from matplotlib.figure import Figure

N_EXAMPLES = 6
LEVEL = 4
"""Icosphere level of the examples."""
MOST_SIZED = 10_000
"""Drawn particles whose sizes are told at once."""
DOTS_PER_INCH = 110
COLUMNS = 5
"""Panels in a row: a window is wider than a page."""

WORTH_A_POOL = 400
"""Particles to be measured beyond which processes are started: some seconds of work, and fits that this
process could not be stopped at."""

Origin = ShapeSource | tuple[Particle, ...]


@dataclass(frozen=True, eq=False)
class FittedShapes:
    """A fitted model, what it was fitted to, and some of the measured particles at its degree.

    Parameters
    ----------
    source
        All that was known; a model fitted to a half has seen only that.
    model
        Fitted.
    n_fitted
        Particles that the model was fitted to; 0 where it came as a card or file.
    examples
        Meshes of measured particles, centred; none where there are none.
    first
        A drawn particle, that of seed 0; none where the model can draw none.
    """

    source: ShapeSource
    model: FittedModel
    n_fitted: int
    examples: tuple[Mesh, ...]
    first: Mesh | None = None


@dataclass(frozen=True, eq=False)
class DrawnShapes:
    """Drawn particles, meshes of the first of them, what they were drawn from, and the ends of their r_eq.

    `radii` is left out where there are more than :data:`MOST_SIZED`.
    """

    draws: Draws
    examples: tuple[Mesh, ...]
    model: FittedModel
    order: GenerateOrder
    radii: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class JudgedShapes:
    """A study, and its figures as PNG by name: number, volume, pairs, quantiles and maybe components."""

    study: PopulationStudy
    pictures: dict[str, bytes]


def fit_shapes(origin: Origin, order: GenerateOrder, half: bool = False) -> Steps:
    """Expand particles where that is needed, and fit; returns :class:`FittedShapes`.

    Parameters
    ----------
    origin
        Particles, or what a file or a material has to offer.
    half
        Fit to the random half that a study with the same seed fits to in its first split.
    """
    if isinstance(origin, tuple):
        source: ShapeSource = yield from sample_of_meshes(origin, expansion_of(order))
    else:
        source = origin
    sample = source.content if isinstance(source.content, Sample) else None
    seen = source
    if sample is not None and half:
        seen = ShapeSource(
            sample.chosen(sample.halves(order.seed)[0]), source.name, source.sha256, source.notes
        )
    model: FittedModel = yield from fit_model(seen, order)
    n_fitted = len(seen.content) if isinstance(seen.content, Sample) else 0
    first: Mesh | None = None
    with suppress(RegolithError):
        first = live_mesh(model, 0)
    examples = _measured_examples(sample, model.l_max) if sample else ()
    if sample is not None:
        _ = sample.equivalent_radii  # kept by the sample; the window asks for them
    return FittedShapes(source, model, n_fitted, examples, first)


def draw_shapes(model: FittedModel, order: GenerateOrder) -> Steps:
    """Draw the particles of an order; returns :class:`DrawnShapes`."""
    draws: Draws = yield from draw(model, order)
    meshes = [virtual_mesh(draws, i, LEVEL) for i in range(min(N_EXAMPLES, len(draws)))]
    radii = draws.equivalent_radii() if 0 < len(draws) <= MOST_SIZED else None
    ends = None if radii is None else (float(radii.min()), float(radii.max()))
    return DrawnShapes(draws, tuple(meshes), model, order, ends)


def judge_shapes(sample: Sample, models: Sequence[str] | None, **options: Any) -> Steps:
    """The study of models with its figures; partial results and the result are :class:`JudgedShapes`.

    Long ones are shared out to one process a core. The options are those of
    :func:`~regolith_studio.studies.population.population_study`.
    """
    rounds = options.get("n_splits", 5) * options.get("n_repeats", 5) * len(models or MODELS)
    n_measured = len(sample) + rounds * drawn_by_itself(len(sample))
    steps = study_population(sample, models, 0 if n_measured > WORTH_A_POOL else 1, **options)
    shown = Progress(0, n_measured, "")
    while True:
        try:
            step: Step = next(steps)
        except StopIteration as end:
            return (yield from judged(end.value, shown))
        if isinstance(step, Progress):
            shown = step
        if isinstance(step, Partial):
            step = Partial((yield from judged(step.value, shown)))
        yield step


def judged(study: PopulationStudy, shown: Progress) -> Generator[Step, None, JudgedShapes]:
    """The study with its figures, drawn one by one; how far the work is stays as `shown`."""
    from regolith_studio.studies import population_figures as figures

    drawings: dict[str, Callable[[], Figure | None]] = {
        **{name: partial(figures.density_figure, study, name, COLUMNS) for name in WEIGHTINGS},
        "quantiles": partial(figures.quantile_figure, study, COLUMNS),
        "components": partial(figures.components_figure, study),
    }
    at_figures, pictures = replace(shown, message="figures"), {}
    for name, draw_one in drawings.items():
        figure = draw_one()
        yield at_figures
        if figure is not None:
            pictures[name] = png_of(figure)
            yield at_figures
    panels = figures.pair_panels(study)
    while True:
        try:
            next(panels)
        except StopIteration as end:
            pictures["pairs"] = png_of(end.value)
            return JudgedShapes(study, pictures)
        yield at_figures


def png_of(figure: "Figure") -> bytes:
    """The figure as PNG."""
    from regolith_studio.studies.figure_files import png_bytes

    return png_bytes(figure, DOTS_PER_INCH)


def draw_live(model: FittedModel, seed: int) -> Steps:
    """:func:`live_mesh` as a job; returns the mesh."""
    yield Started("Drawing a particle", 1)
    return live_mesh(model, seed)


def live_mesh(model: FittedModel, seed: int, level: int = 4) -> Mesh:
    """One particle; the same seed gives the same random numbers, so that it changes with the spectrum."""
    return virtual_mesh(model.draw(1, seed), 0, level)


def _measured_examples(sample: Sample, l_max: int) -> tuple[Mesh, ...]:
    """Particles from all over the sample, in their own places of its order."""
    picks = np.unique(np.linspace(0, len(sample) - 1, N_EXAMPLES).astype(int))
    cut = sample.truncated(min(l_max, sample.l_max))
    meshes = []
    for index in picks:
        try:
            meshes.append(reconstruct(cut.particle(int(index)), level=LEVEL))
        except GeometryError:
            continue
    return tuple(meshes)
