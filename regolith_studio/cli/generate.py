"""``generate``, ``card``, ``match``: virtual particles, material cards, and how near materials are."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.options import (
    Folder,
    Jobs,
    Json,
    OptionalFolder,
    ReadingOptions,
    Seed,
    claim_json,
    exit_code,
    mesh_path,
    output_option,
    usage_errors,
    values,
    with_dataclass_options,
)
from regolith_studio.cli.terminal import print_errors, print_json, print_table, run_with_progress

if TYPE_CHECKING:
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.jobs.model_jobs import GenerationRequest
    from regolith_studio.readers.shape_files import ShapeSource
    from regolith_studio.session.outputs.particles import GeneratedParticles
    from regolith_studio.shape_models.realizations import Realizations
    from regolith_studio.studies.population_distances import DistributionComparison

Sources = Annotated[
    list[str],
    typer.Argument(
        metavar="FIT|CARD|MODEL|MESH...",
        help="A fit or model (.json), a material card (file, or name of a shipped one), or mesh files.",
    ),
]
Number = Annotated[
    int,
    typer.Option("--number", "-n", min=1, max=10_000_000, help="Number of particles to draw.", metavar="N"),
]
Model = Annotated[
    str,
    typer.Option(
        "--model",
        help="gaussian_field gaussian_mixture hull_field log_field recombined (default) sample_matched.",
        metavar="NAME",
        show_default=False,
    ),
]
Degree = Annotated[
    int | None,
    typer.Option(
        "--l-max",
        min=1,
        max=30,
        help="Maximum degree of the particles' surfaces.",
        metavar="L",
        show_default="all that the sample has; 10 for fields other than hull_field",
    ),
]
SizeRange = Annotated[
    tuple[float, float] | None,
    typer.Option(
        "--size-range",
        help="Range of equivalent radii in micrometres.",
        metavar="MIN MAX",
        show_default="all",
    ),
]
MeshLevel = Annotated[
    int | None,
    typer.Option(
        "--level",
        min=0,
        max=7,
        help="Subdivisions of the icosahedron that surfaces are drawn on.",
        metavar="N",
        show_default="4 up to l_max = 10, else 5",
    ),
]
Format = Annotated[
    str,
    typer.Option(
        "--format", help="stl for one mesh per particle, npz for the coefficients of all.", metavar="F"
    ),
]
Names = Annotated[
    str,
    typer.Option(
        "--names",
        help="Names of a mixture's components, the most numerous first, such as basalt,glass.",
        metavar="LIST",
    ),
]
ModelFile = Annotated[
    Path | None, output_option("JSON file for the fitted model.", "MODEL.json", claim_json, "--save-model")
]


ModelSettings = Annotated[
    list[str] | None,
    typer.Option("--set", help="A setting of the model; may be repeated.", metavar="KEY=VALUE"),
]


@with_dataclass_options
def generate(
    *,
    sources: Sources,
    output: Folder,
    n: Number = 100,
    model: Model = "",
    set_: ModelSettings = None,
    l_max: Degree = None,
    size_range: SizeRange = None,
    format_: Format = "stl",
    level: MeshLevel = None,
    names: Names = "",
    save_model: ModelFile = None,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Draw virtual particles with the shapes and sizes of a sample (section 2.3)."""
    from regolith_studio.harmonics.synthesis import DEFAULT_LEVEL
    from regolith_studio.io.atomic import staged_folder, staged_together
    from regolith_studio.jobs.model_jobs import GenerationRequest, draw, fit_model, groups_of
    from regolith_studio.session.choices import Choices
    from regolith_studio.session.outputs.particles import GeneratedParticles

    with usage_errors():
        Choices(level=level or DEFAULT_LEVEL)
        request = GenerationRequest(model, tuple(values(set_, "setting").items()), l_max, n, seed, size_range)
        if format_ not in ("stl", "npz"):
            raise typer.BadParameter(f"The format must be stl or npz, got {format_!r}.")
    source, code = shape_source(sources, reading, request, jobs)
    print_errors(source.notes)
    fitted = _named(run_with_progress(fit_model(source, request)), names)
    draws = run_with_progress(draw(fitted, request))
    compared = compared_with(source, draws, size_range, jobs)
    made = GeneratedParticles(source, request, fitted, draws, groups_of(draws, fitted), compared)
    if save_model is None:
        with staged_folder(output, "generate") as stage:
            document = write_particles(stage, made, format_, level, jobs)
    else:
        with staged_together(output, "generate", save_model) as (stage, stream):
            document = write_particles(stage, made, format_, level, jobs)
            stream.write(_model_bytes(made))
    if json:
        print_json(document | {"folder": str(output)})
    else:
        typer.echo(f"{len(draws)} particles by {fitted.key}, l_max = {fitted.l_max}, in {output}")
        if evaluated := getattr(source.content, "evaluated", ""):
            typer.echo(evaluated)
        if compared is not None:
            if compared.comparable:
                print_table(compared.table())
            typer.echo(compared.assessment())
        if bias := document.get("rejection_bias"):
            typer.echo(
                f"{draws.rejected} draws thrown away, which biases those kept: mean radius "
                f"{100 * bias['mean_radius']:+.1f} %, A_2 {100 * bias['second_degree']:+.1f} %."
            )
    raise typer.Exit(code)


CardFile = Annotated[
    Path | None,
    output_option(
        "JSON file of the card to write; without it a card is read and shown.", "CARD.json", claim_json
    ),
]


@with_dataclass_options
def card(
    *,
    sources: Sources,
    output: CardFile = None,
    name: Annotated[str, typer.Option("--name", help="Lower-case name; that of the file if omitted.")] = "",
    label: Annotated[str, typer.Option("--label", help="What people call the material.")] = "",
    origin: Annotated[str, typer.Option("--origin", help="Where the particles come from.")] = "",
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
) -> None:
    """Make the material card of a sample, or show what a card measures, assumes and misses."""
    from regolith_studio.jobs.model_jobs import make_card
    from regolith_studio.shape_models.materials import MaterialCard, write_card
    from regolith_studio.shape_models.sample import Sample

    source, code = shape_source(sources, reading, None, jobs)
    print_errors(source.notes)
    content = source.content
    if output is not None:
        if not isinstance(content, Sample):
            raise typer.BadParameter("A card is made of a sample: give meshes or the file of their fits.")
        title = name or re.sub(r"[^a-z0-9_]+", "_", output.stem.lower())
        steps = make_card(content, title, label or title, origin or f"A sample called {source.name}.")
        content = run_with_progress(steps)
        write_card(content, output)
    if not isinstance(content, MaterialCard):
        raise typer.BadParameter("Name a file for the card with --output, or give a card to be shown.")
    if json:
        print_json(content.model_dump(mode="json"))
    else:
        lines = [f"{content.label}: {content.origin}", *(f"Measured: {each}" for each in content.measured)]
        lines += [*(f"Assumed: {each}" for each in content.assumed), content.evaluated]
        typer.echo("\n".join(filter(None, lines)))
    raise typer.Exit(code)


def compared_with(
    source: "ShapeSource", draws: "Realizations", size_range: tuple[float, float] | None, jobs: int
) -> "DistributionComparison | None":
    """Draws beside the particles of their source, if it has any."""
    from regolith_studio.jobs.model_jobs import compare_distributions
    from regolith_studio.shape_models.sample import Sample

    if not isinstance(source.content, Sample):
        return None
    comparison: DistributionComparison = run_with_progress(
        compare_distributions(source.content, draws, size_range, jobs)
    )
    return comparison


def shape_source(
    sources: list[str],
    reading: ReadingOptions,
    request: "GenerationRequest | None" = None,
    jobs: int = 1,
) -> tuple["ShapeSource", int]:
    """What the arguments of a command name, and its exit code: one fit, card or model, or meshes.

    Meshes are expanded; the code is 1 where some could not be read or expanded.
    """
    from regolith_studio.jobs.model_jobs import fit_request_for, sample_of_meshes
    from regolith_studio.readers.shape_files import is_shape_source, read_shape_source

    named = [source for source in sources if is_shape_source(source)]
    if named and len(sources) > 1:
        raise typer.BadParameter(f"Give one fit, card or model, or meshes only; {named[0]} is not a mesh.")
    if named:
        return read_shape_source(named[0]), 0
    loaded = reading.read([mesh_path(source) for source in sources])
    sample: ShapeSource = run_with_progress(
        sample_of_meshes(loaded.particles, fit_request_for(request), jobs)
    )
    return sample, exit_code(loaded, len(sample.notes))


def _named(fitted: Any, names: str) -> Any:
    """The model with its parts named, if names were given."""
    if not names:
        return fitted
    wanted = [name.strip() for name in names.split(",")]
    if not hasattr(fitted, "renamed"):
        raise typer.BadParameter(f"Only a mixture has parts with names, and the model is {fitted.key}.")
    with usage_errors():
        return fitted.renamed(wanted)


def write_particles(
    folder: Path, made: "GeneratedParticles", format_: str, level: int | None, jobs: "int | Executor"
) -> dict[str, Any]:
    """Write drawn particles into an existing folder, and what is known of them; returns the document."""
    from regolith_studio.harmonics.synthesis import level_for
    from regolith_studio.jobs.model_jobs import write_meshes
    from regolith_studio.session.outputs import particles as outputs

    if format_ == "npz":
        outputs.write_coefficients(folder, made)
        return outputs.write_document(folder, made, {"files": [outputs.ARRAYS, outputs.TABLE]})
    level = level_for(made.draws.l_max) if level is None else level
    facts = run_with_progress(write_meshes(made.draws, made.groups, level, folder, jobs))
    outputs.write_table_of_meshes(folder, made, facts)
    return outputs.write_document(folder, made, {"level": level, "files": ["*.stl", outputs.TABLE]})


def _model_bytes(made: "GeneratedParticles") -> bytes:
    from regolith_studio.shape_models.models import model_bytes

    return model_bytes(made.model, {"source": made.source.name, "sha256": made.source.sha256 or None})


KINDS = "Meshes (folder or ZIP archive), a table of descriptors or of length, width and thickness, or a card"


def match(
    target: Annotated[str, typer.Argument(metavar="TARGET", help=f"{KINDS}.")],
    candidates: Annotated[
        list[str],
        typer.Argument(metavar="CANDIDATE...", help=f"{KINDS}; each group of meshes is one fraction."),
    ],
    output: OptionalFolder = None,
    mass: Annotated[
        float, typer.Option("--mass", min=1e-9, max=1e12, help="Grams of the mixture.", metavar="G")
    ] = 100.0,
    weighting: Annotated[
        str, typer.Option("--weighting", help="How particles count: number or volume.", metavar="HOW")
    ] = "number",
    most: Annotated[
        int,
        typer.Option(
            "--most", min=20, max=100_000, help="Meshes of a group that are measured, at random.", metavar="N"
        ),
    ] = 1000,
    unit: Annotated[
        str,
        typer.Option("--unit", help="Length unit of files without one: um, mm, m, nm or cm.", metavar="U"),
    ] = "um",
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Say how near simulants are to a soil, and which mixture of them is nearest, in grams."""
    from regolith_studio.cli.batch_options import print_first
    from regolith_studio.jobs.matching_jobs import MatchRequest, match_materials
    from regolith_studio.readers.settings import unit_factor
    from regolith_studio.steps import result_of

    with usage_errors():
        unit_factor(unit)
        if weighting not in ("number", "volume"):
            raise typer.BadParameter(f"Particles count by number or by volume, not by {weighting!r}.")
    request = MatchRequest(unit, most, weighting, seed)
    found = run_with_progress(match_materials(target, candidates, request, jobs))
    table = found.match.table(mass)
    if output is not None:
        result_of(found.written(output, mass))
    problems = [problem.with_path for problem in found.problems]
    print_first(found.notes, "more notes")
    print_first(problems, "more problems, all with --json")
    if json:
        notes = (*found.match.notes, *found.notes)
        lists = {"problems": problems, "notes": notes}
        print_json({"target": target, "materials": table.records, **lists})
    else:
        print_table(table)
        typer.echo(" ".join((f"Nearest by itself: {found.match.nearest.name}.", *table.notes)))
    raise typer.Exit(1 if found.problems else 0)
