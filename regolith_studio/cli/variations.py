"""``study faces``, ``study tradeoff``, ``study sensitivity``: what a choice about the coarsening costs."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.coarsen import choices_from
from regolith_studio.cli.options import (
    Faces,
    Folder,
    Jobs,
    Json,
    LMax,
    Meshes,
    Method,
    Preset,
    RadiusRule,
    Reference,
    Repair,
    Resume,
    Seed,
    Settings,
    StarPoint,
    Target,
    Unit,
    Weights,
    as_bad_use,
)

if TYPE_CHECKING:
    from regolith_studio.jobs.events import Steps
    from regolith_studio.session.choices import Choices

BoxMetric = Annotated[
    str,
    typer.Option(
        "--box",
        help="Bounding box of the diameters: exact, or trimesh, the heuristic of the paper's program.",
        metavar="BOX",
    ),
]
Counts = Annotated[str, typer.Option("--faces", help="Numbers of facets, such as 12,20,50.", metavar="LIST")]
OverlapFactors = Annotated[
    str,
    typer.Option(
        "--factors",
        help="Factors on the weight of the overlap; the exact method takes conditions on and off instead.",
        metavar="LIST",
    ),
]
ChangeFactors = Annotated[
    str, typer.Option("--factors", help="Factors on one weight at a time.", metavar="LIST")
]


def faces(
    meshes: Meshes,
    output: Folder,
    faces: Counts = "8,12,16,20,30,50",
    method: Method = "",
    preset: Preset = "",
    weight: Weights = None,
    set_: Settings = None,
    target: Target = "fit",
    l_max: LMax = 10,
    star_point: StarPoint = "",
    rule: RadiusRule = "volume",
    reference: Reference = "sphere",
    box: BoxMetric = "exact",
    unit: Unit = "um",
    repair: Repair = True,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """RMSRE of the descriptors against the number of faces."""
    wish = choices_from(20, method, preset, weight, set_, target, l_max, seed, star_point, rule, reference)
    _vary("faces", faces, wish, meshes, output, box, (unit, repair), json, jobs, resume)


def tradeoff(
    meshes: Meshes,
    output: Folder,
    faces: Faces = 20,
    factors: OverlapFactors = "0,0.1,0.3,1,3,10,30",
    method: Method = "",
    preset: Preset = "",
    weight: Weights = None,
    set_: Settings = None,
    target: Target = "fit",
    l_max: LMax = 10,
    star_point: StarPoint = "",
    rule: RadiusRule = "volume",
    reference: Reference = "sphere",
    box: BoxMetric = "exact",
    unit: Unit = "um",
    repair: Repair = True,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """Overlap against descriptors: what one costs the other."""
    wish = choices_from(faces, method, preset, weight, set_, target, l_max, seed, star_point, rule, reference)
    _vary("tradeoff", factors, wish, meshes, output, box, (unit, repair), json, jobs, resume)


def sensitivity(
    meshes: Meshes,
    output: Folder,
    faces: Faces = 20,
    factors: ChangeFactors = "0,4",
    method: Method = "",
    preset: Preset = "",
    weight: Weights = None,
    set_: Settings = None,
    target: Target = "fit",
    l_max: LMax = 10,
    star_point: StarPoint = "",
    rule: RadiusRule = "volume",
    reference: Reference = "sphere",
    box: BoxMetric = "exact",
    unit: Unit = "um",
    repair: Repair = True,
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    seed: Seed = 0,
) -> None:
    """What changing one weight of the loss changes in every descriptor."""
    wish = choices_from(faces, method, preset, weight, set_, target, l_max, seed, star_point, rule, reference)
    _vary("sensitivity", factors, wish, meshes, output, box, (unit, repair), json, jobs, resume)


def _vary(
    key: str,
    values: str,
    wish: "Choices",
    meshes: Sequence[Path],
    output: Path,
    box: str,
    reading: tuple[str, bool],
    json: bool,
    jobs: int,
    resume: bool,
) -> None:
    from regolith_studio.cli.inputs import exit_code, read_inputs
    from regolith_studio.jobs.studying import study_coarsening
    from regolith_studio.session.variations import varied_rows

    check_box(box)
    with as_bad_use():
        rows = varied_rows(key, wish, values)
    loaded = read_inputs(meshes, *reading)
    study = partial(study_coarsening, loaded.particles, wish.order, jobs, rows=rows, box_metric=box)
    conclude(f"{key}_study", study, output, json, resume)
    raise typer.Exit(exit_code(meshes, loaded))


def check_box(box: str) -> None:
    """Refuse a box metric that there is not."""
    from regolith_studio.descriptors.facts import BOX_METRICS

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
    from regolith_studio.cli.terminal import follow, print_json, print_table
    from regolith_studio.jobs.answers import Answers
    from regolith_studio.session.outputs.staging import staged_folder
    from regolith_studio.session.outputs.studies import STUDIES

    with Answers(folder / "journal" / f"{kind}.jsonl", resume) as answers:
        found = follow(study(answers=answers))
        with staged_folder(folder) as stage:
            files = [path.name for path in STUDIES[kind].write(found, stage)]
    if json:
        print_json({"folder": str(folder), "files": files})
    else:
        print_table(STUDIES[kind].table(found))
    return found
