"""``study faces``, ``study tradeoff``, ``study sensitivity``: what a choice about the coarsening costs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.grouping import grouped
from regolith_studio.cli.option_groups import FACETS, CoarseningOptions, ReadingOptions
from regolith_studio.cli.options import (
    Facets,
    Folder,
    Jobs,
    Json,
    Meshes,
    Preset,
    Resume,
    Seed,
    as_bad_use,
)

if TYPE_CHECKING:
    from regolith_studio.jobs.events import Steps

BoxMetric = Annotated[
    str,
    typer.Option(
        "--box",
        help="Bounding box of the diameters: exact, or trimesh, the heuristic of the paper's program.",
        metavar="BOX",
    ),
]
Counts = Annotated[str, typer.Option("--facets", help="Numbers of facets, such as 12,20,50.", metavar="LIST")]
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
        with as_bad_use():
            rows = varied_rows(key, wish, values)
        loaded = self.reading.read(meshes)
        order = wish.order
        study = partial(study_coarsening, loaded.particles, order, self.jobs, rows=rows, box_metric=self.box)
        conclude(f"{key}_study", study, output, self.json, self.resume)
        raise typer.Exit(exit_code(meshes, loaded))


@grouped
def faces(
    *, meshes: Meshes, output: Folder, faces: Counts = "8,12,16,20,30,50", varied: VariedOptions
) -> None:
    """RMSRE of the descriptors against the number of facets."""
    varied.run("faces", faces, meshes, output)


@grouped
def tradeoff(
    *,
    meshes: Meshes,
    output: Folder,
    facets: Facets = FACETS,
    factors: OverlapFactors = "0,0.1,0.3,1,3,10,30",
    varied: VariedOptions,
) -> None:
    """Overlap against descriptors: what one costs the other."""
    varied.run("tradeoff", factors, meshes, output, facets)


@grouped
def sensitivity(
    *,
    meshes: Meshes,
    output: Folder,
    facets: Facets = FACETS,
    factors: ChangeFactors = "0,4",
    varied: VariedOptions,
) -> None:
    """What changing one weight of the loss changes in every descriptor."""
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
    from regolith_studio.cli.terminal import follow, print_json, print_table
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.jobs.study_checkpoint import StudyCheckpoint
    from regolith_studio.session.outputs.studies import STUDIES

    with StudyCheckpoint(folder / "journal" / f"{kind}.sqlite", resume) as answers:
        found = follow(study(answers=answers))
        with staged_folder(folder) as stage:
            files = [path.name for path in STUDIES[kind].write(found, stage)]
    if json:
        print_json({"folder": str(folder), "files": files})
    else:
        print_table(STUDIES[kind].table(found))
    return found
