"""``uncertainty``: what each step from the voxel to the angle of repose costs."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.options import (
    FACETS,
    CoarseningOptions,
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
)
from regolith_studio.cli.repose_options import Contact, EngineKey, Measure, Particles, Test
from regolith_studio.cli.terminal import print_errors, print_json, print_table, run_with_progress

if TYPE_CHECKING:
    from regolith_studio.geometry.particle import Particle
    from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput

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
