"""``repose``: the angle of repose of simulated or imported particles (sections 2.6 and 3.3)."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.options import Folder, Json, Seed, Settings, as_bad_use, values

if TYPE_CHECKING:
    from regolith_studio.dem.evaluation.settings import EvaluationSettings

app = typer.Typer(
    help="The angle of repose: simulate a lifting cylinder, measure a pile.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
Figures = Annotated[
    Path | None, typer.Option("--output", "-o", help="Folder for the JSON and Fig. 9.", metavar="DIR")
]
PositionUnit = Annotated[
    str, typer.Option("--unit", help="Length unit of files that have none: m mm um cm nm.", metavar="U")
]
Diameter = Annotated[
    float, typer.Option("--diameter", help="Of all particles, where the file has none.", metavar="D")
]


@app.command("run")
def run(
    dataset: Annotated[Path, typer.Argument(metavar="DATASET", help="A dataset folder.")],
    output: Folder,
    particles: Annotated[
        int, typer.Option("--particles", "-n", help="Simulated particles.", metavar="N")
    ] = 300,
    engine: Annotated[
        str, typer.Option("--engine", help="See the command engines.", metavar="KEY")
    ] = "mujoco",
    contact: Annotated[
        list[str] | None, typer.Option("--contact", help="One value of Table 1, in SI.", metavar="KEY=VALUE")
    ] = None,
    test: Annotated[
        list[str] | None, typer.Option("--test", help="One value of Table 2, in SI.", metavar="KEY=VALUE")
    ] = None,
    set_: Settings = None,
    measure_set: Annotated[
        list[str] | None,
        typer.Option("--measure", help="One setting of the evaluation.", metavar="KEY=VALUE"),
    ] = None,
    coarse_graining: Annotated[
        float,
        typer.Option(
            "--coarse-graining", help="Factor on sizes; by itself, what the mass asks.", metavar="F"
        ),
    ] = 0.0,
    spheres: Annotated[bool, typer.Option("--spheres", help="Balls instead of the polyhedra.")] = False,
    cohesion: Annotated[str, typer.Option("--cohesion", help="none, given or scaled.", metavar="C")] = "none",
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace an earlier run.")] = False,
    json: Json = False,
    seed: Seed = 0,
) -> None:
    """Simulate the lifting cylinder with particles of a dataset and measure the pile (section 2.6)."""
    from regolith_studio.cli.terminal import complain, follow, print_json
    from regolith_studio.dem.case import ReposeCase
    from regolith_studio.dem.engines import engine_named
    from regolith_studio.dem.parameters import ContactParameters, LiftingCylinderTest
    from regolith_studio.jobs.repose import ReposeOrder, simulate_repose

    with as_bad_use():
        code = engine_named(engine)
        case = ReposeCase(
            test=filled(LiftingCylinderTest, values(test, "value"), "value of the test"),
            contact=filled(ContactParameters, values(contact, "value"), "contact parameter"),
            n_particles=particles,
            coarse_graining=coarse_graining,
            shapes="spheres" if spheres else "polyhedra",
            cohesion=cohesion,  # type: ignore[arg-type]  # checked there
            seed=seed,
        )
    order = ReposeOrder(
        case,
        engine,
        filled(code.Settings, values(set_, "setting"), f"setting of {code.label}"),
        evaluation_settings(measure_set),
        overwrite,
    )
    done = follow(simulate_repose(dataset, output, order))
    complain(run_remarks(done.document))
    if json:
        print_json(done.document)
    else:
        typer.echo(run_in_words(done.document))


@app.command("engines")
def engines(json: Json = False) -> None:
    """What each engine represents of the paper's contact model, and whether it is here."""
    from regolith_studio.cli.terminal import print_json
    from regolith_studio.dem.engine_table import HEADINGS, engine_rows

    rows = engine_rows()
    if json:
        print_json(rows)
        return
    for row in rows:
        typer.echo(f"{row['label']} ({row['key']}, {row['licence']}): {row['version'] or row['problem']}")
        for key, heading in HEADINGS.items():
            typer.echo(f"  {heading.lower():17}{row[key]}")


@app.command("measure")
def measure(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Particle positions at rest.")],
    output: Figures = None,
    set_: Settings = None,
    diameter: Diameter = 0.0,
    unit: PositionUnit = "m",
    json: Json = False,
) -> None:
    """Measure the angle of repose of a pile: both sections and both models of the paper."""
    from regolith_studio.cli.terminal import complain, print_json
    from regolith_studio.dem.repose import measure_repose, measurement_document

    settings = evaluation_settings(set_)
    points, diameters = read_positions(file, unit, diameter)
    measurement = measure_repose(points, diameters, settings)
    document = {"file": str(file), "length_unit": "m"} | measurement_document(measurement)
    if output is not None:
        from regolith_studio.session.outputs.staging import json_bytes, staged_folder
        from regolith_studio.studies.repose_figures import write_section_figure

        with staged_folder(output) as stage:
            (stage / "repose.json").write_bytes(json_bytes(document))
            write_section_figure(points, diameters, measurement, stage)
    complain(measurement.warnings)
    if json:
        print_json(document)
    else:
        typer.echo(in_words(document))


def evaluation_settings(entries: list[str] | None) -> "EvaluationSettings":
    """Settings of the evaluation from KEY=VALUE entries; a wrong one is bad use."""
    from regolith_studio.dem.evaluation.settings import EvaluationSettings

    found: EvaluationSettings = filled(EvaluationSettings, values(entries, "setting"), "evaluation setting")
    return found


def filled(kind: type[Any], given: dict[str, Any], what: str) -> Any:
    """A settings dataclass with the given values; an unknown name or a bad value is bad use."""
    import dataclasses

    known = {each.name: each for each in dataclasses.fields(kind)}
    for name, value in given.items():
        if name not in known:
            raise typer.BadParameter(f"There is no {what} {name!r}; there are {', '.join(known)}.")
        default = known[name].default
        if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
            given[name] = float(value)
        elif not isinstance(given[name], type(default)):
            raise typer.BadParameter(f"The {what} {name} must be like {default!r}, got {value!r}.")
    with as_bad_use():
        return kind(**given)


def read_positions(file: Path, unit: str, diameter: float) -> tuple[Any, Any]:
    """Points (n, 3) and diameters (n,) in metres.

    Raises
    ------
    FileError
        If the file holds no positions, or no diameters and none is given.
    """
    from regolith_studio.dem.pile import read_pile
    from regolith_studio.errors import FileError

    if file.suffix.lower() != ".npz":
        raise FileError(f"{file.name} is no result of this program (.npz).")
    del unit, diameter
    pile = read_pile(file)
    return pile.points, pile.diameters


def in_words(document: dict[str, Any]) -> str:
    """The measurement in a few lines for a person."""
    paper = document["paper_sections"]
    low, high = document["interval_deg"]
    lines = [
        f"angle of repose      {document['angle_deg']:.1f} deg ({low:.1f} to {high:.1f}, "
        f"{100 * document['settings']['confidence']:g} % interval, {len(document['sections'])} sections)"
    ]
    for section in document["sections"][:2]:
        two = section["asymmetric"]
        lines.append(
            f"section {section['plane']}          left {two['left_deg']:.1f}  right {two['right_deg']:.1f}  "
            f"symmetric {section['symmetric']['angle_deg']:.1f}"
        )
    lines.append(
        f"the paper's sections asymmetric {paper['asymmetric']['mean_deg']:.1f}  "
        f"symmetric {paper['symmetric']['mean_deg']:.1f}"
    )
    return "\n".join(lines)


def run_remarks(document: dict[str, Any]) -> list[str]:
    """Sentences about a run that its user should read."""
    return [*document["particles"]["sentences"], *document["checks"]["problems"]]


def run_in_words(document: dict[str, Any]) -> str:
    """The result of a run in a few lines for a person."""
    checks, measurement = document["checks"], document["measurement"]
    angle = in_words(measurement) if measurement["status"] == "pile" else measurement["reason"]
    lines = [
        angle,
        f"filled to            {100 * checks['fill_height']:.2f} cm, packed {checks['solid_fraction']:.2f}",
        f"particles            {checks['particles_out']} of {checks['particles_in']}",
        f"overlap at rest      {100 * checks['largest_overlap']:.2f} % of the mean diameter at most",
        f"energy gained        {checks['energy_gain']:.1e} m g d a particle",
        f"time                 {document['run']['seconds']:.0f} s",
    ]
    return "\n".join(lines)
