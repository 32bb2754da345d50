"""``study``: tables and figures over a sample."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.generate import shape_source
from regolith_studio.cli.options import (
    FACETS,
    CoarseningOptions,
    Degrees,
    Facets,
    Folder,
    Jobs,
    Json,
    Meshes,
    Preset,
    ReadingOptions,
    Resume,
    Seed,
    exit_code,
    usage_errors,
    whole_numbers,
    with_dataclass_options,
    words,
)
from regolith_studio.cli.repose_options import Contact, EngineKey, Measure, Particles, Test
from regolith_studio.cli.terminal import (
    command_group,
    print_errors,
    print_json,
    print_table,
    run_with_progress,
)
from regolith_studio.harmonics.fit_options import FitOptions

if TYPE_CHECKING:
    from regolith_studio.geometry.particle import Particle
    from regolith_studio.jobs.events import Steps
    from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
    from regolith_studio.session.choices import Choices
    from regolith_studio.studies.loss_variants import LossVariant


app = command_group("Tables and figures over a sample.")

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
WithCompound = Annotated[
    bool,
    typer.Option(
        "--compound",
        help="Add a row: unions of convex parts that keep all descriptors (--loss compound alone).",
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
        min=0,
        max=30,
        help="Degree of drawn particles; they are compared with the particles with all their degrees.",
        metavar="L",
        show_default="all of the sample for recombined, sample_matched and hull_field, 10 for the others",
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
Counts = Annotated[str, typer.Option("--facets", help="Numbers of facets, such as 12,20,50.", metavar="LIST")]
OverlapFactors = Annotated[
    str,
    typer.Option(
        "--factors",
        help="Factors on the overlap weight; the exact method adds and drops constraints instead.",
        metavar="LIST",
    ),
]
ChangeFactors = Annotated[
    str, typer.Option("--factors", help="Factors on one weight at a time.", metavar="LIST")
]


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """How the sample of a study is read, and how the study is run."""

    reading: ReadingOptions
    json: Json = False
    jobs: Jobs = 1
    resume: Resume = False
    seed: Seed = 0

    def finish(self, kind: str, study: Callable[..., "Steps"], folder: Path) -> Any:
        """Run a study, write its files, print its table (or the list of files); returns its result.

        ``study``: makes the steps; takes the number of `workers` and the checkpoint of `answers`.
        """
        from regolith_studio.io.atomic import JOURNAL, staged_folder
        from regolith_studio.jobs.study_jobs import StudyCheckpoint
        from regolith_studio.session.outputs.studies import STUDIES

        with StudyCheckpoint(folder / JOURNAL / f"{kind}.sqlite", self.resume) as answers:
            result = run_with_progress(study(workers=self.jobs, answers=answers))
            with staged_folder(folder, kind) as stage:
                files = [path.name for path in STUDIES[kind].write(result, stage)]
        if self.json:
            print_json({"folder": str(folder), "files": files})
        else:
            print_table(STUDIES[kind].table(result))
        return result

    def study(
        self, kind: str, study: Callable[..., "Steps"], meshes: Sequence[Path], folder: Path, **options: Any
    ) -> tuple[Any, int]:
        """Run a study of the particles in files; returns its result and the exit code."""
        loaded = self.reading.read(meshes)
        result = self.finish(kind, partial(study, loaded.particles, **options), folder)
        return result, exit_code(loaded)


@app.command("lmax")
@with_dataclass_options
def lmax(
    *,
    meshes: Meshes,
    output: Folder,
    degrees: Degrees = "1-20",
    below: Below = 5.0,
    radii: FitOptions,
    run: RunOptions,
) -> None:
    """RMSRE of the descriptors against l_max (Fig. 3)."""
    from regolith_studio.harmonics.fit_options import FIT_DEGREE
    from regolith_studio.jobs.study_jobs import study_lmax
    from regolith_studio.session.choices import Choices
    from regolith_studio.studies.lmax import enough_degrees

    chosen = whole_numbers(degrees, 0, FIT_DEGREE)
    with usage_errors():
        Choices(seed=run.seed)
    options = {"seed": run.seed, "degrees": chosen, "fit_options": radii}
    result, code = run.study("lmax_study", study_lmax, meshes, output, **options)
    if not run.json:
        typer.echo(enough_degrees(result, below / 100))
    raise typer.Exit(code)


@dataclass(frozen=True, kw_only=True)
class LossOptions:
    """What studies take whose rows are sets of loss weights."""

    facets: Facets = FACETS
    loss: Losses = None
    compound: WithCompound = False
    how: CoarseningOptions
    run: RunOptions

    def study(
        self, kind: str, study: Callable[..., "Steps"], meshes: Sequence[Path], output: Path, **options: Any
    ) -> None:
        """Run a study of these rows and end the program with its exit code."""
        choices = self.how.choices(n_facets=self.facets, seed=self.run.seed)
        options |= {"request": choices.coarsening_request, "rows": self._rows(choices)}
        _, code = self.run.study(kind, study, meshes, output, **options)
        raise typer.Exit(code)

    def _rows(self, choices: "Choices") -> "tuple[LossVariant, ...]":
        """The rows by name; without names Fig. 8's, and those that the options weight."""
        from regolith_studio.session.study_requests import CHOSEN, COMPOUND, chosen_rows
        from regolith_studio.studies.loss_variants import PAPER_LOSSES

        chosen = tuple(self.loss or (*PAPER_LOSSES, *((CHOSEN,) if self.how.weight else ())))
        added = (COMPOUND,) if self.compound and COMPOUND not in chosen else ()
        with usage_errors():
            return chosen_rows((*chosen, *added), choices)


@app.command("coarsening")
@with_dataclass_options
def coarsening(*, meshes: Meshes, output: Folder, box: BoxMetric = "exact", losses: LossOptions) -> None:
    """RMSRE of the descriptors for each set of loss weights (Fig. 8)."""
    from regolith_studio.jobs.study_jobs import study_coarsening

    check_box(box)
    losses.study("coarsening_study", study_coarsening, meshes, output, box_metric=box)


@app.command("solids")
@with_dataclass_options
def solids(*, meshes: Meshes, output: Folder, losses: LossOptions) -> None:
    """The polyhedra that each set of loss weights makes of each particle (Fig. 7)."""
    from regolith_studio.jobs.study_jobs import study_gallery

    losses.study("solids_study", study_gallery, meshes, output)


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
    run: RunOptions,
) -> None:
    """Drawn against measured particles: models fitted to one half, evaluated on the other (Figs. 4-6)."""
    from regolith_studio.descriptors.catalogue import CATALOGUE
    from regolith_studio.errors import InputError
    from regolith_studio.jobs.model_jobs import GenerationRequest
    from regolith_studio.jobs.study_jobs import study_population
    from regolith_studio.shape_models.sample import Sample
    from regolith_studio.studies.population import KEYS
    from regolith_studio.studies.population_tables import target_table

    with usage_errors():
        request = GenerationRequest(l_max=l_max, seed=run.seed)
    source, code = shape_source(sources, run.reading, request, run.jobs)
    print_errors(source.notes)
    if not isinstance(source.content, Sample):
        raise InputError(
            f"{source.name} holds no measured particles to judge models on; give a fit, or meshes."
        )
    steps = partial(
        study_population,
        source.content,
        words(models) or None,
        l_max=l_max,
        n_draws=draws or None,
        n_splits=splits,
        n_repeats=repeats,
        keys=tuple(CATALOGUE) if descriptors == "all" else words(descriptors) or KEYS,
        seed=run.seed,
    )
    study = run.finish("population_study", steps, output)
    if not run.json:
        typer.echo()
        print_table(target_table(study))
    raise typer.Exit(code)


@dataclass(frozen=True, kw_only=True)
class VariedOptions:
    """What the three studies take besides the values that vary."""

    preset: Preset = ""
    how: CoarseningOptions
    box: BoxMetric = "exact"
    run: RunOptions

    def study(
        self,
        key: str,
        values: str,
        meshes: Sequence[Path],
        output: Path,
        n_facets: int = FACETS,
        compound: bool = False,
    ) -> None:
        """Run the study of this key and end the program with its exit code."""
        from regolith_studio.jobs.study_jobs import study_coarsening
        from regolith_studio.session.study_requests import varied_rows

        check_box(self.box)
        choices = self.how.choices(self.preset, n_facets=n_facets, seed=self.run.seed)
        with usage_errors():
            rows = varied_rows(key, choices, values, compound)
        options = {"request": choices.coarsening_request, "rows": rows, "box_metric": self.box}
        _, code = self.run.study(f"{key}_study", study_coarsening, meshes, output, **options)
        raise typer.Exit(code)


@app.command("facets")
@with_dataclass_options
def facet_counts(
    *, meshes: Meshes, output: Folder, facets: Counts = "8,12,16,20,30,50", varied: VariedOptions
) -> None:
    """RMSRE of the descriptors against the number of facets."""
    varied.study("facets", facets, meshes, output)


@app.command("tradeoff")
@with_dataclass_options
def tradeoff(
    *,
    meshes: Meshes,
    output: Folder,
    facets: Facets = FACETS,
    factors: OverlapFactors = "0,0.1,0.3,1,3,10,30",
    compound: WithCompound = False,
    varied: VariedOptions,
) -> None:
    """Trade-off between overlap and descriptor errors."""
    varied.study("tradeoff", factors, meshes, output, facets, compound)


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
    varied.study("sensitivity", factors, meshes, output, facets)


def check_box(box: str) -> None:
    """Raise an error for an unknown box metric."""
    from regolith_studio.descriptors.catalogue import BOX_METRICS

    if box not in BOX_METRICS:
        raise typer.BadParameter(f"The box must be one of {', '.join(BOX_METRICS)}, got {box!r}.")


VoxelSize = Annotated[
    str,
    typer.Option(
        "--voxel-size", help="Edge of a voxel, or X,Y,Z; read from the file if omitted.", metavar="SIZE"
    ),
]
Grains = Annotated[
    Path | None,
    typer.Option(
        "--recipe", help="extraction.json with the settings from a scan to its grains.", metavar="FILE"
    ),
]
DrawnBy = Annotated[
    str,
    typer.Option(
        "--model", help="Draw particles of this shape model; measured grains if omitted.", metavar="NAME"
    ),
]
Count = Annotated[
    int, typer.Option("--representatives", min=1, max=1000, help="Number of simulated shapes.", metavar="N")
]
Points = Annotated[
    int,
    typer.Option("--points", min=4, max=4096, help="Points of the design, a power of two.", metavar="N"),
]
Heaps = Annotated[
    int, typer.Option("--heaps", min=2, max=1000, help="Number of heaps of each step.", metavar="N")
]
NoHeaps = Annotated[bool, typer.Option("--no-heaps", help="Descriptors only; no heap is simulated.")]


@with_dataclass_options
def uncertainty(
    *,
    sources: Meshes,
    output: Folder,
    voxel_size: VoxelSize = "",
    recipe: Grains = None,
    model: DrawnBy = "",
    representatives: Count = 10,
    facets: Facets = FACETS,
    preset: Preset = "",
    how: CoarseningOptions,
    points: Points = 16,
    heaps: Heaps = 6,
    no_heaps: NoHeaps = False,
    particles: Particles = 300,
    engine: EngineKey = "mujoco",
    contact: Contact = None,
    test: Test = None,
    measure: Measure = None,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """What each step from the voxel to the angle of repose costs: shares of the variance.

    The input is a scan, or the meshes of a sample; steps that it lacks are named as not counted. The folder
    holds what is known so far at any time; --resume goes on with the design, and heaps are never run twice.
    """
    from regolith_studio.cli.repose_options import CaseOptions
    from regolith_studio.jobs.uncertainty import UncertaintyRequest, uncertainty_steps
    from regolith_studio.jobs.uncertainty_chain import Chain
    from regolith_studio.studies.uncertainty import budget_document, steps_table, values_table

    choices = how.choices(preset, n_facets=facets, seed=seed)
    case = CaseOptions(engine, contact, test, None, measure).request(n_particles=particles, seed=seed)
    with usage_errors():
        request = UncertaintyRequest(points, 0 if no_heaps else heaps, case)
    source, code = _source(sources, voxel_size, reading)
    chain = Chain.of(
        source,
        grains=_grains(recipe),
        coarsening=choices.coarsening_request,
        model=model,
        n_representatives=representatives,
        seed=seed,
    )
    budget = run_with_progress(uncertainty_steps(chain, request, output, jobs, resume), logged=True)
    if json:
        print_json(budget_document(budget) | {"folder": str(output)})
        raise typer.Exit(code)
    print_table(values_table(budget))
    typer.echo()
    print_table(steps_table(budget))
    notes = budget.angle.notes if budget.angle else ()
    print_errors([note for note in (budget.descriptors.note, *notes) if note])
    raise typer.Exit(code)


def _source(
    sources: list[Path], voxel_size: str, reading: ReadingOptions
) -> "tuple[tuple[Particle, ...] | VolumeInput, int]":
    """The scan, or the particles, and the exit code of reading them."""
    from regolith_studio.cli.volume_options import VolumeOptions
    from regolith_studio.session.file_kinds import FileKind, kind_of_all

    if kind_of_all(sources) is FileKind.VOLUME:
        with usage_errors():
            return VolumeOptions(voxel_size=voxel_size, unit=reading.unit or "").of(sources[0]), 0
    loaded = reading.read(sources)
    return tuple(loaded.particles), exit_code(loaded)


def _grains(recipe: Path | None) -> "GrainSettings":
    from regolith_studio.jobs.extraction_settings import GrainSettings, read_grain_settings

    return read_grain_settings(recipe) if recipe else GrainSettings()
