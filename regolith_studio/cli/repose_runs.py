"""``repose run`` and ``repose study``."""

from pathlib import Path
from typing import Annotated, Any

import typer

from regolith_studio.cli.grouping import grouped
from regolith_studio.cli.options import Folder, Jobs, Json, Seed, as_bad_use, values
from regolith_studio.cli.repose_options import CaseOptions, Particles


@grouped
def run(
    *,
    dataset: Annotated[Path, typer.Argument(metavar="DATASET", help="A dataset folder.")],
    output: Folder,
    particles: Particles = 300,
    how: CaseOptions,
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
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Simulate the lifting cylinder with particles of a dataset and measure the pile (section 2.6)."""
    from dataclasses import replace

    from regolith_studio.cli.repose_words import run_in_words, run_remarks
    from regolith_studio.cli.terminal import complain, follow, print_json
    from regolith_studio.jobs.repose_jobs import simulate_repose

    del jobs  # a run is one process
    order = how.order(
        n_particles=particles,
        coarse_graining=coarse_graining,
        shapes="spheres" if spheres else "polyhedra",
        cohesion=cohesion,
        seed=seed,
    )
    done = follow(simulate_repose(dataset, output, replace(order, overwrite=overwrite)))
    complain(run_remarks(done.document))
    if json:
        print_json(done.document)
    else:
        typer.echo(run_in_words(done.document))


@grouped
def study(
    *,
    datasets: Annotated[list[Path], typer.Argument(metavar="DATASET...", help="Dataset folders.")],
    output: Folder,
    vary: Annotated[
        str,
        typer.Option(
            "--vary",
            help="A value of Table 1 or 2 in SI, shapes, cohesion, n_particles; else the datasets differ.",
            metavar="KEY=V1,V2",
        ),
    ] = "",
    repeats: Annotated[int, typer.Option("--repeats", min=1, help="Seeds a value.", metavar="N")] = 1,
    particles: Particles = 1000,
    how: CaseOptions,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Angle of repose against one value or one dataset against others; goes on where it was stopped."""
    from regolith_studio.cli.terminal import follow, print_json, print_table
    from regolith_studio.jobs.repose_jobs import ReposeVariant, study_repose, with_value
    from regolith_studio.studies.repose import repose_table, write_repose_study

    del jobs  # one run after the other, so that what is there already is known
    key, points = _varied(vary)
    order = how.order(n_particles=particles, seed=seed)
    rows = []
    for folder in datasets:
        name = (key if len(datasets) == 1 else f"{key} {folder.name}") if points else "dataset"
        with as_bad_use():
            rows += [ReposeVariant(name, point, folder, with_value(order, key, point)) for point in points]
        if not points:
            rows.append(ReposeVariant(name, folder.name, folder, order))
    done = follow(study_repose(rows, output, repeats))
    files = [path.name for path in write_repose_study(done, output)]
    if json:
        print_json({"folder": str(output), "files": files})
    else:
        print_table(repose_table(done))


def _varied(text: str) -> tuple[str, list[Any]]:
    """Name and values of ``KEY=V1,V2``."""
    if not text:
        return "", []
    key, equals, points = text.partition("=")
    if not equals or not all(point.strip() for point in points.split(",")):
        raise typer.BadParameter(f"Write what varies as KEY=V1,V2, got {text!r}.")
    return key, [values([f"{key}={point}"], "value")[key] for point in points.split(",")]
