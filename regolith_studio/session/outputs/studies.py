"""Tables and figures of studies as files."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from pkgutil import resolve_name
from types import MappingProxyType
from typing import Any

from regolith_studio.io.atomic import staged_folder
from regolith_studio.io.tables import Table
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.messages import N_
from regolith_studio.studies.coarsening import rmsre_table as coarsening_table
from regolith_studio.studies.lmax import rmsre_table as lmax_table
from regolith_studio.studies.polyhedron_gallery import gallery_table
from regolith_studio.studies.population_tables import ranking_table
from regolith_studio.studies.sweeps import SWEEPS

FIGURES = "regolith_studio.studies.figures"


@dataclass(frozen=True)
class StudyKind:
    """One kind of study: what it is called, and how it becomes files.

    - ``title``: what it shows, and where in the paper.
    - ``picture``: name of its main figure.
    - ``write``: writes tables (CSV, JSON) and figures (PNG, SVG) into a folder, and returns their paths.
    - ``table``: its main table.
    """

    title: str
    picture: str
    write: Callable[[Any, Path], tuple[Path, ...]]
    table: Callable[[Any], Table]


def _write(name: str, *given: Any) -> tuple[Path, ...]:
    """Call ``module:function`` of ``studies.figures``, which imports matplotlib."""
    written: tuple[Path, ...] = resolve_name(f"{FIGURES}.{name}")(*given)
    return written


STUDIES: Mapping[str, StudyKind] = {
    "lmax_study": StudyKind(
        "RMSRE of the descriptors against l_max (Fig. 3)",
        "lmax_rmsre.png",
        partial(_write, "degrees:write_lmax_study"),
        lmax_table,
    ),
    "coarsening_study": StudyKind(
        "RMSRE of the descriptors for each set of loss weights (Fig. 8)",
        "coarsening_rmsre.png",
        partial(_write, "coarsening:write_coarsening_study"),
        coarsening_table,
    ),
    "population_study": StudyKind(
        "Drawn against measured particles (Figs. 4 to 6)",
        "population_number.png",
        partial(_write, "population:write_population_study"),
        ranking_table,
    ),
    "solids_study": StudyKind(
        "Polyhedra of some particles by loss (Fig. 7)",
        "solids.png",
        partial(_write, "degrees:write_gallery"),
        gallery_table,
    ),
    **{
        f"{key}_study": StudyKind(
            each.title, f"{key}.png", partial(_write, "coarsening:write_sweep", key), each.table
        )
        for key, each in SWEEPS.items()
    },
}
"""The first two can be asked for by a recipe, by the keys of ``session.choices.Kind``."""


def write_studies(
    studies: tuple[tuple[str, object], ...], folder: Path, origins: Mapping[str, str] = MappingProxyType({})
) -> Steps:
    """Write tables and figures; returns their paths. A job.

    ``origins``: by kind, what a study was made from and with, written beside it as a text.
    """
    yield Started(N_("Writing figures"), len(studies))
    written: tuple[Path, ...] = ()
    for number, (kind, study) in enumerate(studies, start=1):
        with staged_folder(folder, kind) as stage:
            names = [path.name for path in STUDIES[kind].write(study, stage)]
            if kind in origins:
                names.append(f"{kind}.txt")
                (stage / names[-1]).write_text(origins[kind], encoding="utf-8")
            written += tuple(folder / name for name in names)
        yield Progress(number, len(studies), STUDIES[kind].title)
    return written
