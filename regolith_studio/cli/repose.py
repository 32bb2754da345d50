"""``repose``: the angle of repose of simulated or imported particles (sections 2.6 and 3.3)."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.batch_options import Address, Runner, Tls, chosen_executor
from regolith_studio.cli.options import (
    Folder,
    Jobs,
    Json,
    Seed,
    claim_folder,
    option_of,
    output_option,
    usage_errors,
    with_dataclass_options,
    words,
)
from regolith_studio.cli.repose_calibrate import calibrate
from regolith_studio.cli.repose_options import (
    CaseOptions,
    DrumOptions,
    EngineKey,
    Particles,
    check_results_folder,
    evaluation_settings,
    varied_values,
)
from regolith_studio.cli.terminal import (
    command_group,
    print_errors,
    print_json,
    print_result,
    print_table,
    run_with_progress,
)
from regolith_studio.dataset.parameters import DrumRotation, rpm_of

if TYPE_CHECKING:
    from regolith_studio.jobs.repose_jobs import ReposeRequest, ReposeRun

app = command_group("The angle of repose: simulate a lifting cylinder or a drum, measure a pile.")
Figures = Annotated[
    Path | None,
    output_option("Folder for repose.json and the figure of the sections (Fig. 9).", "DIR", claim_folder),
]
Base = Annotated[
    float | None,
    typer.Option(
        "--base",
        min=-1e12,
        max=1e12,
        help="Height of the plate in the file's unit; otherwise 0, or where the lowest particles reach to "
        "if that is more than a mean diameter away.",
        metavar="Z",
    ),
]
EvaluationSetting = Annotated[
    list[str] | None,
    typer.Option("--set", help="A setting of the evaluation; may be repeated.", metavar="KEY=VALUE"),
]
PositionUnit = Annotated[
    str, typer.Option("--unit", help="Length unit of files without one: m, mm, um, cm or nm.", metavar="U")
]
Columns = Annotated[
    str,
    typer.Option(
        "--columns",
        help="Names of all columns of a table or XYZ file, in their order: x y z radius ...",
        metavar="NAMES",
    ),
]
Diameter = Annotated[
    float,
    typer.Option(
        "--diameter",
        min=0.0,
        max=1e12,
        help="Diameter of all particles, for files without diameters.",
        metavar="D",
    ),
]
CoarseGraining = Annotated[
    float,
    typer.Option(
        "--coarse-graining",
        min=0.0,
        max=1e5,
        help="Coarse-graining factor on sizes; chosen from the mass if omitted.",
        metavar="F",
    ),
]
Spheres = Annotated[bool, typer.Option("--spheres", help="Simulate spheres instead of polyhedra.")]
Filling = Annotated[
    Path | None,
    typer.Option(
        "--filling",
        help="Folder of a run of the same particles, whose filled cylinder is taken again.",
        metavar="RUN",
    ),
]
Bond = Annotated[
    float,
    typer.Option(
        "--bond",
        min=0.0,
        max=1e4,
        help="Cohesion as the pull-off force of two mean simulated particles over the weight of one.",
        metavar="B",
    ),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace an existing run in the folder.")]
DatasetFolder = Annotated[Path, typer.Argument(metavar="DATASET", help="A dataset folder.")]


@dataclass(frozen=True, kw_only=True)
class SingleRunOptions:
    """Options of one run: which particles it takes, and how it is done."""

    particles: Particles = 1000
    coarse_graining: CoarseGraining = 0.0
    spheres: Spheres = False
    bond: Bond = 0.0
    filling: Filling = None
    overwrite: Overwrite = False
    jobs: Jobs = 1
    seed: Seed = 0

    @property
    def case(self) -> dict[str, Any]:
        """Fields of ``ReposeCase``."""
        return {
            "n_particles": self.particles,
            "coarse_graining": self.coarse_graining,
            "shapes": "spheres" if self.spheres else "polyhedra",
            "bond_number": self.bond,
            "seed": self.seed,
        }

    def simulate(self, dataset: Path, output: Path, request: "ReposeRequest") -> "ReposeRun":
        """Run a case, with its notes before and after."""
        from regolith_studio.dem.case import scaling_report
        from regolith_studio.jobs.repose_jobs import prepared_case, simulate_prepared
        from regolith_studio.jobs.runners.process_pool import cores

        threads = self.jobs or cores()
        request = replace(request, filling=self.filling, overwrite=self.overwrite, threads=threads)
        prepared = prepared_case(dataset, request)
        before = [*scaling_report(prepared).sentences, *prepared.filling_notes]
        print_errors(before)
        done: ReposeRun = run_with_progress(simulate_prepared(prepared, output, request))
        print_errors(note for note in run_notes(done.document) if note not in before)
        return done


app.command("calibrate")(calibrate)


@app.command("engines")
def engines(json: Json = False) -> None:
    """List the DEM engines: what each represents of the contact model, and its version if available."""
    from regolith_studio.dem.engines import CAPABILITY_LABELS, engine_rows

    rows = engine_rows()
    if json:
        print_json(rows)
        return
    for row in rows:
        typer.echo(f"{row['label']} ({row['key']}, {row['licence']}): {row['version'] or row['problem']}")
        for key, heading in CAPABILITY_LABELS.items():
            typer.echo(f"  {heading.lower():17}{row[key]}")


@app.command("export")
def export(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="Folder of a finished or stopped run.")],
    output: Folder,
    every: Annotated[
        int,
        typer.Option(
            "--every",
            min=1,
            max=1_000_000,
            help="Export every so many snapshots; the last moment is always exported.",
            metavar="N",
        ),
    ] = 1,
    json: Json = False,
) -> None:
    """Export a run as a series for ParaView and for OVITO, and its last moment as GLB."""
    from regolith_studio.scene.repose_export import repose_export_steps

    done = run_with_progress(repose_export_steps(run, output, every))
    if json:
        print_json({"folder": str(done.folder), "n_particles": done.n_particles, "times_s": done.times})
        return
    count = f"{len(done.times):,} moments of {done.n_particles:,} particles"
    typer.echo(f"{count} in {done.folder}; README.txt there says how to open them.")


@app.command("measure")
def measure(
    file: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="File of positions: final.npz, CSV, XYZ or LAMMPS dump."),
    ],
    output: Figures = None,
    set_: EvaluationSetting = None,
    diameter: Diameter = 0.0,
    unit: PositionUnit = "m",
    columns: Columns = "",
    base: Base = None,
    json: Json = False,
) -> None:
    """Measure the angle of repose of a pile: both sections and both models of the paper."""
    from regolith_studio.dem.angle_of_repose import measure_repose, measurement_document

    settings = evaluation_settings(set_)
    points, diameters = positions_in(file, unit, diameter, columns)
    metres = 1.0 if file.suffix.lower() == ".npz" else metres_in(unit)
    measurement = measure_repose(points, diameters, settings, None if base is None else base * metres)
    document = {"file": str(file), "length_unit": "m"} | measurement_document(measurement)
    if output is not None:
        from regolith_studio.io.atomic import staged_folder
        from regolith_studio.io.own_files import json_bytes
        from regolith_studio.studies.figures.repose import write_section_figure

        with staged_folder(output, "repose") as stage:
            (stage / "repose.json").write_bytes(json_bytes(document))
            write_section_figure(points, diameters, measurement, stage)
    print_errors(measurement.warnings)
    print_result(document, in_words(document), json)


def positions_in(file: Path, unit: str, diameter: float, columns: str = "") -> tuple[Any, Any]:
    """Points (n, 3) and diameters (n,) in metres."""
    from regolith_studio.dem.run_io import read_final_state
    from regolith_studio.errors import FileError
    from regolith_studio.readers.positions import read_positions

    if file.suffix.lower() == ".npz":
        pile = read_final_state(file)
        return pile.points, pile.diameters
    metres = metres_in(unit)
    positions = read_positions(file, unit, columns=columns)
    print_errors(positions.notes)
    if diameter > 0.0:
        return positions.points, diameter * metres
    if positions.diameters is None:
        raise FileError(f"{file.name} holds no diameters; name one for all particles with --diameter.")
    return positions.points, positions.diameters


def metres_in(unit: str) -> float:
    """Metres in a unit of length; an unknown one is bad use."""
    from regolith_studio.readers.settings import unit_factor

    with usage_errors():
        return unit_factor(unit) * 1e-6


@app.command("run")
@with_dataclass_options
def run(
    *,
    dataset: DatasetFolder,
    output: Folder,
    how: CaseOptions,
    cohesion: Annotated[
        str, typer.Option("--cohesion", help="Cohesion: none, given or scaled.", metavar="C")
    ] = "none",
    single: SingleRunOptions,
    json: Json = False,
) -> None:
    """Simulate the lifting cylinder with particles of a dataset and measure the heap (section 2.6)."""
    done = single.simulate(dataset, output, how.request(cohesion=cohesion, **single.case))
    print_result(done.document, run_in_words(done.document), json)


@app.command("drum")
@with_dataclass_options
def drum(
    *,
    dataset: DatasetFolder,
    output: Folder,
    rpm: Annotated[
        float | None, option_of(DrumRotation, "rpm", tip="Revolutions in a minute; 10 if omitted.")
    ] = None,
    froude: Annotated[
        float | None,
        typer.Option(
            "--froude",
            min=1e-9,
            max=100.0,
            help="Speed as centripetal over gravitational acceleration at the wall, instead of --rpm.",
            metavar="F",
        ),
    ] = None,
    turns: Annotated[
        float, option_of(DrumRotation, "turns", tip="Turns that are measured, after a quarter.")
    ] = DrumRotation.turns,
    moments: Annotated[
        int, option_of(DrumRotation, "moments", tip="Moments at which the surface is measured.")
    ] = DrumRotation.moments,
    measured: Annotated[
        float | None,
        typer.Option(
            "--measured",
            min=-90.0,
            max=90.0,
            help="Your own dynamic angle in degrees, to compare.",
            metavar="A",
        ),
    ] = None,
    measured_error: Annotated[
        float, typer.Option("--measured-error", min=0.0, max=45.0, help="Its standard error.", metavar="E")
    ] = 1.0,
    how: DrumOptions,
    single: SingleRunOptions,
    json: Json = False,
) -> None:
    """Simulate a rotating drum with particles of a dataset; measure dynamic, upper and lower angle."""
    from regolith_studio.dem.drum_angle import DrumMeasurement, compare_angles

    if rpm is not None and froude is not None:
        raise typer.BadParameter("Give either --rpm or --froude.")
    rotation = {"rpm": DrumRotation.rpm if rpm is None else rpm, "turns": turns, "moments": moments}
    request = how.request(rotation, **single.case)
    if froude is not None:
        with usage_errors():
            turning = DrumRotation(rpm_of(froude, request.case.test), turns, moments)
        request = replace(request, case=replace(request.case, drum=turning))
    done = single.simulate(dataset, output, request)
    document, angles = dict(done.document), done.measurement
    if measured is not None and isinstance(angles, DrumMeasurement):
        document["measured"] = compare_angles(angles.angle, angles.interval, measured, measured_error)
    if json:
        print_json(document)
        return
    typer.echo(run_in_words(document))
    if "measured" in document:
        low, high = document["measured"]["interval_deg"]
        difference = document["measured"]["difference_deg"]
        typer.echo(f"less the measured    {difference:+.1f} deg ({low:+.1f} to {high:+.1f}, 95 % interval)")


@app.command("study")
@with_dataclass_options
def study(
    *,
    datasets: Annotated[list[Path], typer.Argument(metavar="DATASET...", help="Dataset folders.")],
    output: Folder,
    vary: Annotated[
        str,
        typer.Option(
            "--vary",
            help="Parameter to vary, of Table 1 or 2 in SI units, shapes, cohesion or n_particles.",
            metavar="KEY=V1,V2",
        ),
    ] = "",
    repeats: Annotated[
        int, typer.Option("--repeats", min=1, max=1000, help="Number of seeds per value.", metavar="N")
    ] = 1,
    against: Annotated[
        str,
        typer.Option(
            "--against",
            help="Shape statistics of the datasets, such as aspect_ratio,sphericity, over which a response "
            "surface is fitted to the angles.",
            metavar="KEYS",
        ),
    ] = "",
    same_filling: Annotated[
        bool,
        typer.Option(
            "--same-filling",
            help="Fill the cylinder once for each seed, with the first value; lift it again with the others.",
        ),
    ] = False,
    particles: Particles = 1000,
    bond: Bond = 0.0,
    how: CaseOptions,
    runner: Runner = "processes",
    address: Address = "",
    tls: Tls = None,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Measure the angle of repose against a parameter or for several datasets; resumes a stopped study."""
    from regolith_studio.errors import InputError
    from regolith_studio.jobs.repose_study import ReposeVariant, study_repose, with_value, write_study
    from regolith_studio.studies.repose import (
        fit_repose_surface,
        repose_means,
        repose_table,
        surface_document,
        surface_table,
    )

    key, points = varied_values(vary)
    if points and against:
        raise typer.BadParameter("--against compares datasets as they are; leave out --vary.")
    check_results_folder(output, datasets)
    keys, statistics = _statistics(against, datasets)
    request = how.request(n_particles=particles, bond_number=bond, seed=seed)
    rows = []
    for folder in datasets:
        name = (key if len(datasets) == 1 else f"{key} {folder.name}") if points else "dataset"
        with usage_errors():
            rows += [ReposeVariant(name, point, folder, with_value(request, key, point)) for point in points]
        if not points:
            rows.append(ReposeVariant(name, folder.name, folder, request))
    with chosen_executor(runner, jobs, address, tls) as executor:
        done = run_with_progress(study_repose(rows, output, repeats, executor, same_filling))
    print_errors(dict.fromkeys(note for each in done.runs for note in each.document["filling"]["notes"]))
    try:
        surface = fit_repose_surface(done, statistics, keys) if keys else None
    except InputError:
        write_study(done, output)
        raise
    files = write_study(done, output, surface)
    if json:
        print_json({"folder": str(output), "files": files})
        return
    print_table(repose_table(done))
    if (means := repose_means(done)) is not None:
        print_table(means)
    if surface is not None:
        print_table(surface_table(surface))
        typer.echo(surface_in_words(surface_document(surface)))


@app.command("verify")
def verify(
    engine: EngineKey = "mujoco",
    quick: Annotated[
        bool, typer.Option("--quick", help="Leave out gravity and dice, which take more than minutes.")
    ] = False,
    json: Json = False,
) -> None:
    """Verify an engine: friction, energy, rest, contacts, time step, gravity, packings of dice."""
    from regolith_studio.dem.verification.certificate import certificate_document
    from regolith_studio.jobs.repose_jobs import verify_engine

    with usage_errors():
        done = run_with_progress(verify_engine(engine, quick))
    document = certificate_document(done)
    print_result(document, certificate_in_words(document), json)
    raise typer.Exit(0 if done.passed else 1)


def certificate_in_words(document: dict[str, Any]) -> str:
    """The lines of a certificate."""
    lines = [f"{document['engine']} {document['version']}"]
    for each in document["lines"]:
        assessment = "passed" if each["passed"] else "FAILED"
        value = "no value" if each["value"] is None else f"{each['value']:.3g} {each['unit']}".rstrip()
        lines.append(f"{assessment}  {each['what']}: {value}")
        details = [
            f"band: {each['band']}",
            *([each["note"]] if each["note"] else []),
            f"{each['seconds']:.0f} s",
        ]
        lines.append("        " + "; ".join(details))
    if document["left_out"]:
        lines.append(f"not measured: {', '.join(document['left_out'])}")
    return "\n".join(lines)


def _statistics(against: str, folders: list[Path]) -> tuple[list[str], dict[str, Any]]:
    """Names of shape statistics, and their values for each dataset by the name of its folder, checked to
    suffice for a response surface before any run."""
    import numpy as np

    from regolith_studio.dataset.folder_io import read_dataset
    from regolith_studio.studies.repose import fit_response_surface, shape_statistics

    keys = list(words(against))
    if not keys:
        return [], {}
    names = [folder.name for folder in folders]
    if len(set(names)) < len(names):
        raise typer.BadParameter("The folders of the datasets must have different names.")
    with usage_errors():
        values = shape_statistics([read_dataset(folder) for folder in folders], keys)
        fit_response_surface(keys, values, np.zeros(len(values)))
    return keys, dict(zip(names, values, strict=True))


def in_words(document: dict[str, Any]) -> str:
    """A measurement."""
    paper = document["paper_sections"]
    low, high = document["interval_deg"]
    lines = [
        f"angle of repose      {document['angle_deg']:.1f} deg ({low:.1f} to {high:.1f}, "
        f"{100 * document['settings']['confidence']:g} % interval, "
        f"{len(document['sections'])} of {document['settings']['azimuths']} sections)"
    ]
    in_paper = [section for section in document["sections"] if section["plane"]]
    for section in in_paper:
        two = section["asymmetric"]
        lines.append(
            f"section {section['plane']}          left {two['left_deg']:.1f}  right {two['right_deg']:.1f}  "
            f"symmetric {section['symmetric']['angle_deg']:.1f}"
        )
    if len(in_paper) == 2:
        lines.append(
            f"these two sections   asymmetric {paper['asymmetric']['mean_deg']:.1f}  "
            f"symmetric {paper['symmetric']['mean_deg']:.1f}"
        )
    return "\n".join(lines)


def run_notes(document: dict[str, Any]) -> list[str]:
    """Sentences about a run that its user should read."""
    return [
        *document["run"]["notes"],
        *document["checks"]["problems"],
        *(document["measurement"].get("warnings", ()) if "drum" in document["case"] else ()),
    ]


def surface_in_words(document: dict[str, Any]) -> str:
    """The change of the angle over the range of each statistic."""
    lines = [
        f"{document['kind']} surface, residual standard deviation "
        f"{document['residual_standard_deviation_deg']:.1f} deg"
    ]
    for each in document["effects"]:
        low, high = each["interval_deg"]
        lines.append(
            f"{each['statistic']:20} {each['change_over_range_deg']:+.1f} deg ({low:+.1f} to {high:+.1f}) "
            f"over its range of {each['range']:.3g}"
        )
    return "\n".join(lines)


def run_in_words(document: dict[str, Any]) -> str:
    """The result of a run."""
    from regolith_studio.dem.drum_angle import drum_in_words

    checks, measurement, heap = document["checks"], document["measurement"], document["packing"]["heap"]
    words = {"pile": in_words, "drum": drum_in_words}.get(measurement["status"])
    lines = [
        measurement["reason"] if words is None else words(measurement),
        f"filled to            {100 * checks['fill_height']:.2f} cm, packed {checks['solid_fraction']:.2f}",
        f"particles            {checks['particles_out']} of {checks['particles_in']}",
        f"overlap at rest      {100 * checks['max_overlap']:.2f} % of the mean diameter at most, "
        f"above 2 % in {100 * checks['deep_contacts']:.2f} % of the contacts",
        f"in the plate         {100 * checks['plate_depth']:.2f} % of the mean diameter at most",
        f"energy gained        {checks['energy_gain']:.1e} m g d a particle",
    ]
    if heap is not None:
        lines.insert(
            2,
            f"inside the heap      packed {heap['solid_fraction']:.2f}, {heap['bulk_density']:.0f} kg/m^3, "
            f"{heap['coordination_number']:.1f} contacts a particle ({heap['n_particles']} particles)",
        )
    return "\n".join(lines)
