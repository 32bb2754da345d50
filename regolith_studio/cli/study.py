"""``study``: tables and figures over a sample."""

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli import variations
from regolith_studio.cli.grouping import grouped
from regolith_studio.cli.option_groups import FACETS, CoarseningOptions, ExpansionOptions, ReadingOptions
from regolith_studio.cli.options import (
    Degrees,
    Facets,
    Folder,
    Jobs,
    Json,
    Level,
    LMax,
    Meshes,
    Resume,
    Seed,
    as_bad_use,
    whole_numbers,
)
from regolith_studio.cli.variations import BoxMetric, check_box, conclude
from regolith_studio.cli.whole_help import WholeHelp

if TYPE_CHECKING:
    from regolith_studio.session.choices import Choices
    from regolith_studio.studies.loss_rows import StudyRow

Below = Annotated[
    float,
    typer.Option(
        "--below", help="Ask for the smallest l_max with every error below this.", metavar="PERCENT"
    ),
]

Losses = Annotated[
    list[str] | None,
    typer.Option(
        "--loss",
        help="A row: a preset, a descriptor alone (only_volume, ...), or chosen for --weight; else Fig. 8.",
        metavar="NAME",
    ),
]
SampleSources = Annotated[
    list[str],
    typer.Argument(metavar="FIT|MESH...", help="The fit of a sample, or its meshes."),
]
Models = Annotated[
    str,
    typer.Option("--models", help="Models by key, separated by commas.", metavar="LIST", show_default="all"),
]
Draws = Annotated[
    int,
    typer.Option(
        "--draws",
        help="Particles of each drawing.",
        metavar="N",
        show_default="half the sample, at most 1000",
    ),
]
Splits = Annotated[int, typer.Option("--splits", help="Random halves to fit to.", metavar="N")]
Repeats = Annotated[int, typer.Option("--repeats", help="Drawings from each fit.", metavar="N")]
DescriptorKeys = Annotated[
    str,
    typer.Option(
        "--descriptors",
        help="Keys of descriptors, separated by commas; or all.",
        metavar="LIST",
        show_default="r_eq, A, AR, S, V/CH",
    ),
]

app = typer.Typer(
    cls=WholeHelp, help="Tables and figures over a sample.", no_args_is_help=True, rich_markup_mode=None
)


@app.command("lmax")
@grouped
def lmax(
    *,
    meshes: Meshes,
    output: Folder,
    degrees: Degrees = "1-20",
    level: Level = 4,
    below: Below = 5.0,
    radii: ExpansionOptions,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """RMSRE of the descriptors against l_max (Fig. 3)."""
    from regolith_studio.cli.inputs import exit_code
    from regolith_studio.jobs.study_jobs import study_lmax
    from regolith_studio.session.choices import L_MAX_LIMIT, Choices
    from regolith_studio.studies.lmax import enough_degrees

    wanted = whole_numbers(degrees, 0, L_MAX_LIMIT)
    with as_bad_use():
        Choices(level=level, seed=seed)
    loaded = reading.read(meshes)
    study = partial(study_lmax, loaded.particles, jobs, seed, degrees=wanted, level=level)
    steps = partial(study, fit_options=radii.fit_options)
    found = conclude("lmax_study", steps, output, json, resume)
    if not json:
        typer.echo(enough_degrees(found, below / 100))
    raise typer.Exit(exit_code(meshes, loaded))


@app.command("coarsening")
@grouped
def coarsening(
    *,
    meshes: Meshes,
    output: Folder,
    facets: Facets = FACETS,
    loss: Losses = None,
    how: CoarseningOptions,
    box: BoxMetric = "exact",
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """RMSRE of the descriptors for each set of loss weights (Fig. 8)."""
    from regolith_studio.cli.inputs import exit_code
    from regolith_studio.jobs.study_jobs import study_coarsening

    check_box(box)
    wish = how.choices(n_facets=facets, seed=seed)
    rows = _rows(loss, wish, bool(how.weight))
    loaded = reading.read(meshes)
    study = partial(study_coarsening, loaded.particles, wish.order, jobs, rows=rows, box_metric=box)
    conclude("coarsening_study", study, output, json, resume)
    raise typer.Exit(exit_code(meshes, loaded))


@app.command("solids")
@grouped
def solids(
    *,
    meshes: Meshes,
    output: Folder,
    facets: Facets = FACETS,
    loss: Losses = None,
    how: CoarseningOptions,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """The polyhedra that each set of loss weights makes of each particle (Fig. 7)."""
    from regolith_studio.cli.inputs import exit_code
    from regolith_studio.session.study_requests import study_gallery

    wish = how.choices(n_facets=facets, seed=seed)
    rows = _rows(loss, wish, bool(how.weight))
    loaded = reading.read(meshes)
    study = partial(study_gallery, loaded.particles, wish.order, rows, jobs)
    conclude("solids_study", study, output, json, resume)
    raise typer.Exit(exit_code(meshes, loaded))


@app.command("population")
@grouped
def population(
    *,
    sources: SampleSources,
    output: Folder,
    models: Models = "",
    l_max: LMax = 10,
    draws: Draws = 0,
    splits: Splits = 5,
    repeats: Repeats = 5,
    descriptors: DescriptorKeys = "",
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """Drawn against measured particles: models fitted to one half, judged on the other (Figs. 4-6)."""
    from regolith_studio.cli.generate import shape_source
    from regolith_studio.cli.terminal import complain, print_table
    from regolith_studio.descriptors.catalogue import CATALOGUE
    from regolith_studio.errors import InputError
    from regolith_studio.jobs.model_jobs import GenerationRequest
    from regolith_studio.jobs.study_jobs import study_population
    from regolith_studio.shape_models.sample import Sample
    from regolith_studio.studies.population import KEYS
    from regolith_studio.studies.population_tables import target_table

    with as_bad_use():
        order = GenerationRequest(l_max=l_max, seed=seed)
    source = shape_source(sources, reading, order, jobs)
    complain(source.notes)
    if not isinstance(source.content, Sample):
        raise InputError(
            f"{source.name} holds no measured particles to judge models on; give a fit, or meshes."
        )
    steps = partial(
        study_population,
        source.content,
        _words(models) or None,
        jobs,
        l_max=l_max,
        n_draws=draws or None,
        n_splits=splits,
        n_repeats=repeats,
        keys=tuple(CATALOGUE) if descriptors == "all" else _words(descriptors) or KEYS,
        seed=seed,
    )
    study = conclude("population_study", steps, output, json, resume)
    if not json:
        typer.echo()
        print_table(target_table(study))


def _rows(names: Sequence[str] | None, wish: "Choices", weighted: bool) -> "tuple[StudyRow, ...]":
    """The rows of a study by name; without names Fig. 8's, and those that the options weight."""
    from regolith_studio.session.study_requests import CHOSEN, chosen_rows
    from regolith_studio.studies.loss_rows import PAPER_ROWS

    with as_bad_use():
        return chosen_rows(tuple(names or (*PAPER_ROWS, *((CHOSEN,) if weighted else ()))), wish)


def _words(text: str) -> tuple[str, ...]:
    return tuple(word.strip() for word in text.split(",") if word.strip())


for _command in (variations.faces, variations.tradeoff, variations.sensitivity):
    app.command(_command.__name__)(_command)
