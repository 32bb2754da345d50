"""Sections of a report about the shapes of a sample: descriptors, Figs. 2 to 6."""

import numpy as np

from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import FIT_DEGREE
from regolith_studio.harmonics.synthesis import gallery
from regolith_studio.io.tables import Column, Table, write_table
from regolith_studio.jobs.dataset_jobs import MeasuredPopulation, measure_population
from regolith_studio.jobs.model_jobs import sample_of_meshes
from regolith_studio.jobs.particle_jobs import FitRequest, fit_sample
from regolith_studio.jobs.study_jobs import study_lmax, study_population
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.report.sections import (
    ReportDraft,
    ReportFigure,
    ReportSection,
    SectionSteps,
    error_table,
    interval_text,
    png_of,
    selected_columns,
)
from regolith_studio.shape_models.models import DEFAULT_MODEL, MODELS
from regolith_studio.studies.lmax import DEFAULT_DEGREES, enough_degrees, rmsre_table
from regolith_studio.studies.population_distances import CONFIDENCE
from regolith_studio.studies.population_tables import PAPERS_MODEL, PAPERS_PAIRS, distance_table

SHOWN_DEGREES = (1, 2, 5, 10, 20, 30)
"""Of Fig. 2, besides the chosen one."""
SURFACE_LEVEL = 4
"""Icosphere level of the surfaces of Fig. 2."""
SMALL_ERROR = 0.05
"""RMSRE that the smallest sufficient l_max is named for."""
MIN_HIDDEN = 5e-4
"""Share of the surface that is said to be hidden; less is shown as 0.0%."""
N_RESAMPLES = 1000
DESCRIPTORS = ("equivalent_radius", "surface_area", *LOSS_KEYS)


def describe_sample(draft: ReportDraft, title: str) -> SectionSteps:
    """The descriptors of all particles, with means and their intervals."""
    population = yield from measure_population(draft.particles, draft.executor)
    draft.population = population
    table = descriptor_means(population, draft.settings.seed)
    write_table(table, draft.folder / "sample", "descriptors")
    groups = sorted({particle.group for particle in draft.particles if particle.group})
    left_out = [f"{name} has no descriptors: {reason}" for name, reason in population.omitted]
    return ReportSection(
        title,
        (
            f"The sample holds {len(draft.particles):,} particles"
            + (f" ({', '.join(groups)})" if groups else "")
            + f"; {len(population.kept):,} of them can be described. Volume, surface area, sphericity (Eq. "
            "1), the edges of the minimum-volume box, their ratio (Eq. 2) and the volume of the convex hull "
            "are those of section 2.2; the box is exact. Eq. 1 is taken without the 3 in its denominator, so "
            "that a sphere has S = 1. Lengths are in micrometres.",
            f"Intervals hold the mean of {CONFIDENCE:.0%} of {N_RESAMPLES:,} resamples of the particles.",
            *left_out,
        ),
        tables=(table,),
    )


def descriptor_means(population: MeasuredPopulation, seed: int) -> Table:
    """Mean with its bootstrap interval, standard deviation and range of each descriptor."""
    values = np.array([[each[key] for key in DESCRIPTORS] for each in population.descriptors])
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    counts = rng.multinomial(len(values), np.full(len(values), 1 / len(values)), N_RESAMPLES)
    tail = 50 * (1 - CONFIDENCE)
    low, high = np.percentile(counts @ values / len(values), [tail, 100 - tail], axis=0)
    numbers = (values.mean(axis=0), low, high, values.std(axis=0), values.min(axis=0), values.max(axis=0))
    rows = tuple(
        (
            CATALOGUE[key].label,
            CATALOGUE[key].symbol,
            CATALOGUE[key].unit,
            *(x[k] for x in numbers),
        )
        for k, key in enumerate(DESCRIPTORS)
    )
    names = ("descriptor", "symbol", "unit", "mean", "low", "high", "deviation", "min", "max")
    return Table(f"Descriptors of {len(values):,} particles", tuple(map(Column, names)), rows)


def draw_degrees(draft: ReportDraft, title: str) -> SectionSteps:
    """Fig. 2: the first particle to be drawn that can be fitted."""
    outcomes = yield from fit_sample(draft.drawn, FitRequest(FIT_DEGREE), draft.executor)
    particle, fit = _first_fit(draft.drawn, outcomes)
    degrees = sorted({*SHOWN_DEGREES, draft.settings.l_max})
    cut = dict(gallery(fit, degrees, SURFACE_LEVEL))
    surfaces: dict[str, Mesh | None] = {particle.name: particle.mesh}
    surfaces |= {f"l_max = {degree}": surface for degree, surface in cut.items()}
    from regolith_studio.studies.figures.degrees import write_degrees  # matplotlib

    picture, _ = write_degrees(surfaces, draft.folder / "degrees")
    rows = tuple((d, (d + 1) ** 2, 100 * fit.truncated(d).radial_error) for d in degrees)
    columns = (Column("l_max"), Column("coefficients"), Column("error", "%"))
    table = Table("Error of the radius, root mean square over all directions", columns, rows)
    write_table(table, draft.folder / "degrees", "degrees")
    hidden = fit.hidden_surface_share
    seen = (
        f"{hidden:.1%} of the surface cannot be seen from the star point; there the radius keeps the volume "
        "and not the form."
        if hidden >= MIN_HIDDEN
        else "The whole surface can be seen from the star point."
    )
    turned = {particle.name: particle.mesh, f"l_max = {draft.settings.l_max}": cut[draft.settings.l_max]}
    return ReportSection(
        title,
        (
            f"The distance of the surface of {particle.name} from its star point is expanded in real "
            f"spherical harmonics (Eq. 3) up to degree {FIT_DEGREE} and cut at l_max (Eq. 4). At l_max = "
            f"{draft.settings.l_max} the radius is off by "
            f"{fit.truncated(draft.settings.l_max).radial_error:.1%} of its mean. {seen}",
            *fit.notes,
        ),
        (ReportFigure(picture, f"{particle.name} and its expansion cut at several degrees l_max."),),
        (table,),
        {name: mesh for name, mesh in turned.items() if mesh is not None},
    )


def _first_fit(
    particles: tuple[Particle, ...], outcomes: tuple[HarmonicFit | str, ...]
) -> tuple[Particle, HarmonicFit]:
    for particle, outcome in zip(particles, outcomes, strict=True):
        if isinstance(outcome, HarmonicFit):
            return particle, outcome
    raise InputError(f"None of the {len(particles)} particles drawn can be fitted: {outcomes[0]}")


def compare_degrees(draft: ReportDraft, title: str) -> SectionSteps:
    """Fig. 3."""
    l_max, seed = draft.settings.l_max, draft.settings.seed
    degrees = tuple(sorted({*DEFAULT_DEGREES, l_max}))
    study = yield from study_lmax(draft.studied, draft.executor, seed, degrees=degrees)
    files = STUDIES["lmax_study"].write(study, draft.folder / "lmax")
    shown = error_table(rmsre_table(study), "group", f"RMSRE at l_max = {l_max}", l_max=l_max)
    return ReportSection(
        title,
        (
            f"The descriptors of {len(study.names):,} particles are compared with those of their expansions "
            f"cut at each l_max from {degrees[0]} to {degrees[-1]}: root mean squared relative errors of Eq. "
            f"10. Shades, and the intervals of the table, hold {study.confidence:.0%} of {N_RESAMPLES:,} "
            "resamples of the particles.",
            enough_degrees(study, SMALL_ERROR).replace("\n", " "),
            *(f"{name} was left out: {reason}" for name, reason in study.failures),
        ),
        (ReportFigure(png_of(files, "lmax_rmsre"), "RMSRE of the descriptors against l_max, by group."),),
        (shown,),
    )


def compare_population(draft: ReportDraft, title: str) -> SectionSteps:
    """Figs. 4 to 6: the paper's model and the one that is matched to the sample."""
    settings = draft.settings
    degree = FitRequest(min(FIT_DEGREE, 2 * settings.l_max))  # the matched model needs twice the degree
    source = yield from sample_of_meshes(draft.particles, degree, draft.executor)
    study = yield from study_population(
        source.content,
        (PAPERS_MODEL, DEFAULT_MODEL),
        draft.executor,
        l_max=settings.l_max,
        n_splits=settings.splits,
        n_repeats=1,
        keys=PAPERS_PAIRS,
        seed=settings.seed,
    )
    files = STUDIES["population_study"].write(study, draft.folder / "population")
    table = shown_distances(distance_table(study))
    return ReportSection(
        title,
        (
            f"Two models are fitted to random halves of {len(study.measured):,} particles (number of halves: "
            f"{settings.splits}), and {study.n_draws:,} particles with l_max = {settings.l_max} are drawn "
            f"from each fit and compared with the other half: {MODELS[PAPERS_MODEL].label} is the Gaussian "
            f"random field of section 2.3, {MODELS[DEFAULT_MODEL].label} is matched to the sample. Distances "
            "are shares of the measured mean; the floor is the distance between random halves of the sample, "
            "below which nothing can be told apart.",
            _nearest(table),
            *source.notes,
        ),
        (
            ReportFigure(png_of(files, "population_number"), "Fig. 4: densities by number."),
            ReportFigure(png_of(files, "population_volume"), "Fig. 5: densities by volume."),
            ReportFigure(
                png_of(files, "population_pairs"),
                "Fig. 6: pairs of descriptors; contours hold 25, 50, 75 and 95 % of the particles.",
            ),
        ),
        (table,),
    )


def shown_distances(table: Table) -> Table:
    """The distances with the names of models and descriptors that the figures have."""
    names = (
        "model",
        "weighting",
        "descriptor",
        "wasserstein",
        "wasserstein_low",
        "wasserstein_high",
        "floor",
    )
    chosen = selected_columns(table, names, "")
    rows = tuple(
        (MODELS[str(model)].label, by, CATALOGUE[str(key)].label, *values)
        for model, by, key, *values in chosen.rows
    )
    columns = map(Column, ("model", "by", "descriptor"))
    numbers = (Column(name, "%") for name in ("distance", "low", "high", "floor"))
    title = "Wasserstein distances of drawn from measured particles, of the mean"
    return Table(title, (*columns, *numbers), rows)


def _nearest(table: Table) -> str:
    """The distances of the aspect ratio by number, in a sentence."""
    nearest = [
        f"{interval_text(mean, low, high)} % for {model}"
        for model, by, label, mean, low, high, _ in table.rows
        if (by, label) == ("number", CATALOGUE["aspect_ratio"].label)
    ]
    return f"The distance of the aspect ratio, by number, is {' and '.join(nearest)}."
