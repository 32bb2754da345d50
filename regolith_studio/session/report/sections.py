"""A report as data: its sections, and what they are made from."""

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.tables import Cell, Column, Table
from regolith_studio.jobs.dataset_jobs import MeasuredPopulation
from regolith_studio.jobs.events import Step
from regolith_studio.jobs.executor import Executor
from regolith_studio.session.report.settings import ReportSettings

TITLE = "Regolith Studio: report on a sample"
MIN_SHOWN = 5e-5
"""Numbers below this, in the unit of their column, are shown as 0, as in Fig. 8; the CSV files hold them."""


@dataclass(frozen=True)
class ReportFigure:
    """A PNG file and its caption."""

    file: Path
    caption: str


@dataclass(frozen=True, eq=False)
class ReportSection:
    """What a report says of one figure or table of the paper.

    - ``title``: heading.
    - ``paragraphs``: method and results, in plain text.
    - ``figures``, ``tables``: in this order.
    - ``meshes``: by caption, to be turned in the page.
    - ``problem``: why the figure is missing, in one sentence.
    """

    title: str
    paragraphs: tuple[str, ...] = ()
    figures: tuple[ReportFigure, ...] = ()
    tables: tuple[Table, ...] = ()
    meshes: Mapping[str, Mesh] = field(default_factory=dict)
    problem: str = ""


def interval_text(value: Cell, low: Cell, high: Cell) -> str:
    """A number with its interval; empty where there is none."""
    if not (isinstance(value, float) and isinstance(low, float) and isinstance(high, float)):
        return ""
    return f"{_shown(value)} ({_shown(low)} to {_shown(high)})"


def _shown(value: float) -> str:
    return "0" if abs(value) < MIN_SHOWN else f"{value:.3g}"


def error_table(table: Table, by: str, title: str, **only: Cell) -> Table:
    """The RMSRE of a study's table with their intervals, a row a value of `by`, a column a descriptor.

    ``table``: with the columns ``descriptor``, ``rmsre``, ``rmsre_low`` and ``rmsre_high``. ``only``: values
    of columns; other rows are left out.
    """
    lines: dict[str, dict[str, str]] = {}
    for row in table.records:
        if all(row[name] == value for name, value in only.items()):
            shown = interval_text(row["rmsre"], row["rmsre_low"], row["rmsre_high"])
            lines.setdefault(str(row[by]), {})[str(row["descriptor"])] = shown
    keys = list(dict.fromkeys(key for line in lines.values() for key in line))
    columns = (Column(by), *(Column("J" if key == JACCARD else CATALOGUE[key].symbol, "%") for key in keys))
    rows = tuple((name or "all", *(line.get(key, "") for key in keys)) for name, line in lines.items())
    return Table(title, columns, rows)


def selected_columns(table: Table, names: tuple[str, ...], title: str) -> Table:
    """The columns of these names."""
    columns = {column.name: column for column in table.columns}
    rows = tuple(tuple(row[name] for name in names) for row in table.records)
    return Table(title, tuple(columns[name] for name in names), rows)


def png_of(files: Sequence[Path], stem: str) -> Path:
    """The PNG of this stem among the files of a study."""
    return next(path for path in files if path.name == f"{stem}.png")


SectionSteps = Generator[Step, None, ReportSection]


@dataclass
class ReportDraft:
    """What the sections of a report are made from.

    - ``folder``: of the report; every section writes into a folder of its own below it.
    - ``population``: descriptors of the sample, as soon as they are known.
    - ``dataset``: the representatives, as soon as they are made.
    """

    particles: tuple[Particle, ...]
    settings: ReportSettings
    folder: Path
    executor: Executor
    population: MeasuredPopulation | None = None
    dataset: Dataset | None = None

    @cached_property
    def studied(self) -> tuple[Particle, ...]:
        """The particles of Figs. 3 and 8: all, or as many as asked for, at random, in their order."""
        count = min(self.settings.study_particles, len(self.particles))
        rng = np.random.default_rng(np.random.SeedSequence(self.settings.seed))
        places = np.sort(rng.choice(len(self.particles), count, replace=False))
        return tuple(self.particles[int(at)] for at in places)

    @cached_property
    def drawn(self) -> tuple[Particle, ...]:
        """The particles of Figs. 2 and 7: evenly from all over the sample."""
        places = np.linspace(0, len(self.particles) - 1, self.settings.drawn)
        return tuple(self.particles[int(at)] for at in np.unique(places.round()))

    @property
    def representatives(self) -> Dataset:
        """The dataset."""
        if self.dataset is None:
            raise InputError("There is no dataset of representative particles, as said above.")
        return self.dataset
