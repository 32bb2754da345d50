"""``study``: tables and figures over a sample."""

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.command_group import CommandGroup
from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.inputs import ReadingOptions
from regolith_studio.cli.options import (
    FACETS,
    CoarseningOptions,
    Degrees,
    Facets,
    Folder,
    Jobs,
    Json,
    Meshes,
    Resume,
    Seed,
    usage_errors,
    whole_numbers,
)
from regolith_studio.harmonics.fit_options import FitOptions

if TYPE_CHECKING:
    from regolith_studio.session.choices import Choices
    from regolith_studio.studies.loss_variants import LossVariant
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from regolith_studio.cli.options import Preset

if TYPE_CHECKING:
    from regolith_studio.jobs.events import Steps


Below = Annotated[
    float,
    typer.Option(
        "--below",
        min=0.0,
        max=1e6,
        help="Report the smallest l_max with every error below this limit.",
        metavar="PERCENT",
    ),
]

BoxMetric = Annotated[
    str,
    typer.Option(
        "--box",
        help="Bounding box of the diameters: exact, or trimesh (the heuristic of the paper's program).",
        metavar="BOX",
    ),
]

Losses = Annotated[
    list[str] | None,
    typer.Option(
        "--loss",
        help="A row: a preset, a single descriptor (only_volume, ...) or chosen; Fig. 8 if omitted.",
        metavar="NAME",
    ),
]
SampleSources = Annotated[
    list[str],
    typer.Argument(metavar="FIT|MESH...", help="The fit of a sample, or its meshes."),
]
Models = Annotated[
    str,
    typer.Option(
        "--models", help="Keys of the models, separated by commas.", metavar="LIST", show_default="all"
    ),
]
DrawDegree = Annotated[
    int | None,
    typer.Option(
        "--l-max",
        help="Degree of drawn particles; they are compared with the particles with all their degrees.",
        metavar="L",
        show_default="all of the sample for sample_matched, 10 for the others",
    ),
]
Draws = Annotated[
    int,
    typer.Option(
        "--draws",
        min=0,
        max=1_000_000,
        help="Number of particles per draw.",
        metavar="N",
        show_default="half the sample, at most 1000",
    ),
]
Splits = Annotated[
    int,
    typer.Option(
        "--splits", min=1, max=1000, help="Number of random halves that models are fitted to.", metavar="N"
    ),
]
Repeats = Annotated[
    int, typer.Option("--repeats", min=1, max=1000, help="Number of draws from each fit.", metavar="N")
]
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
    cls=CommandGroup, help="Tables and figures over a sample.", no_args_is_help=True, rich_markup_mode=None
)


@app.command("lmax")
@with_dataclass_options
def lmax(
    *,
    meshes: Meshes,
    output: Folder,
    degrees: Degrees = "1-20",
    below: Below = 5.0,
    radii: FitOptions,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """RMSRE of the descriptors against l_max (Fig. 3)."""
    from regolith_studio.cli.inputs import exit_code
    from regolith_studio.jobs.particle_jobs import FIT_DEGREE
    from regolith_studio.jobs.study_jobs import study_lmax
    from regolith_studio.session.choices import Choices
    from regolith_studio.studies.lmax import enough_degrees

    wanted = whole_numbers(degrees, 0, FIT_DEGREE)
    with usage_errors():
        Choices(seed=seed)
    loaded = reading.read(meshes)
    study = partial(study_lmax, loaded.particles, jobs, seed, degrees=wanted)
    steps = partial(study, fit_options=radii)
    found = conclude("lmax_study", steps, output, json, resume)
    if not json:
        typer.echo(enough_degrees(found, below / 100))
    raise typer.Exit(exit_code(meshes, loaded))


@app.command("coarsening")
@with_dataclass_options
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
@with_dataclass_options
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
    from regolith_studio.jobs.study_jobs import study_gallery

    wish = how.choices(n_facets=facets, seed=seed)
    rows = _rows(loss, wish, bool(how.weight))
    loaded = reading.read(meshes)
    study = partial(study_gallery, loaded.particles, wish.order, rows, jobs)
    conclude("solids_study", study, output, json, resume)
    raise typer.Exit(exit_code(meshes, loaded))


@app.command("population")
@with_dataclass_options
def population(
    *,
    sources: SampleSources,
    output: Folder,
    models: Models = "",
    l_max: DrawDegree = None,
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
    from regolith_studio.cli.terminal import print_errors, print_table
    from regolith_studio.descriptors.catalogue import CATALOGUE
    from regolith_studio.errors import InputError
    from regolith_studio.jobs.model_jobs import GenerationRequest
    from regolith_studio.jobs.study_jobs import study_population
    from regolith_studio.shape_models.sample import Sample
    from regolith_studio.studies.population import KEYS
    from regolith_studio.studies.population_tables import target_table

    with usage_errors():
        order = GenerationRequest(l_max=l_max, seed=seed)
    source = shape_source(sources, reading, order, jobs)
    print_errors(source.notes)
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


def _rows(names: Sequence[str] | None, wish: "Choices", weighted: bool) -> "tuple[LossVariant, ...]":
    """The rows of a study by name; without names Fig. 8's, and those that the options weight."""
    from regolith_studio.session.study_requests import CHOSEN, chosen_rows
    from regolith_studio.studies.loss_variants import PAPER_LOSSES

    with usage_errors():
        return chosen_rows(tuple(names or (*PAPER_LOSSES, *((CHOSEN,) if weighted else ()))), wish)


def _words(text: str) -> tuple[str, ...]:
    return tuple(word.strip() for word in text.split(",") if word.strip())


Counts = Annotated[str, typer.Option("--facets", help="Numbers of facets, such as 12,20,50.", metavar="LIST")]
OverlapFactors = Annotated[
    str,
    typer.Option(
        "--factors",
        help="Factors on the weight of the overlap; the exact method adds and drops constraints instead.",
        metavar="LIST",
    ),
]
ChangeFactors = Annotated[
    str, typer.Option("--factors", help="Factors on one weight at a time.", metavar="LIST")
]


@dataclass(frozen=True, kw_only=True)
class VariedOptions:
    """What the three studies take besides the values that vary."""

    preset: Preset = ""
    how: CoarseningOptions
    box: BoxMetric = "exact"
    reading: ReadingOptions
    json: Json = False
    jobs: Jobs = 1
    resume: Resume = False
    seed: Seed = 0

    def run(
        self, key: str, values: str, meshes: Sequence[Path], output: Path, n_facets: int = FACETS
    ) -> None:
        """Do the study of this key and leave the program with its exit code."""
        from regolith_studio.cli.inputs import exit_code
        from regolith_studio.jobs.study_jobs import study_coarsening
        from regolith_studio.session.study_requests import varied_rows

        check_box(self.box)
        wish = self.how.choices(self.preset, n_facets=n_facets, seed=self.seed)
        with usage_errors():
            rows = varied_rows(key, wish, values)
        loaded = self.reading.read(meshes)
        order = wish.order
        study = partial(study_coarsening, loaded.particles, order, self.jobs, rows=rows, box_metric=self.box)
        conclude(f"{key}_study", study, output, self.json, self.resume)
        raise typer.Exit(exit_code(meshes, loaded))


@app.command("facets")
@with_dataclass_options
def facet_counts(
    *, meshes: Meshes, output: Folder, facets: Counts = "8,12,16,20,30,50", varied: VariedOptions
) -> None:
    """RMSRE of the descriptors against the number of facets."""
    varied.run("facets", facets, meshes, output)


@app.command("tradeoff")
@with_dataclass_options
def tradeoff(
    *,
    meshes: Meshes,
    output: Folder,
    facets: Facets = FACETS,
    factors: OverlapFactors = "0,0.1,0.3,1,3,10,30",
    varied: VariedOptions,
) -> None:
    """Trade-off between overlap and descriptor errors."""
    varied.run("tradeoff", factors, meshes, output, facets)


@app.command("sensitivity")
@with_dataclass_options
def sensitivity(
    *,
    meshes: Meshes,
    output: Folder,
    facets: Facets = FACETS,
    factors: ChangeFactors = "0,4",
    varied: VariedOptions,
) -> None:
    """Sensitivity of each descriptor's error to each weight of the loss."""
    varied.run("sensitivity", factors, meshes, output, facets)


def check_box(box: str) -> None:
    """Refuse a box metric that there is not."""
    from regolith_studio.descriptors.shape_cache import BOX_METRICS

    if box not in BOX_METRICS:
        raise typer.BadParameter(f"The box must be one of {', '.join(BOX_METRICS)}, got {box!r}.")


def conclude(kind: str, study: Callable[..., "Steps"], folder: Path, json: bool, resume: bool = False) -> Any:
    """Follow a study to its end, write its files, print its table (or the list of files).

    Parameters
    ----------
    study
        Makes the steps; is given the `answers` that go to disk as they come.
    resume
        Whether to go on with those that are there.
    """
    from regolith_studio.cli.terminal import print_json, print_table, run_with_progress
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.jobs.study_checkpoint import StudyCheckpoint
    from regolith_studio.session.outputs.studies import STUDIES

    with StudyCheckpoint(folder / "journal" / f"{kind}.sqlite", resume) as answers:
        found = run_with_progress(study(answers=answers))
        with staged_folder(folder, kind) as stage:
            files = [path.name for path in STUDIES[kind].write(found, stage)]
    if json:
        print_json({"folder": str(folder), "files": files})
    else:
        print_table(STUDIES[kind].table(found))
    return found
