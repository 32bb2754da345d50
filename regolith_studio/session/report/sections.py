"""A report as data: sections of text, tables and pictures, the same for the page and the PDF."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.tables import Cell, Column, Table

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

    Parameters
    ----------
    title
        Heading.
    paragraphs
        Method and results, in plain text.
    figures, tables
        In this order.
    meshes
        By caption, to be turned in the page; the PDF has none.
    problem
        Why the figure is missing, in one sentence.
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

    Parameters
    ----------
    table
        With the columns ``descriptor``, ``rmsre``, ``rmsre_low`` and ``rmsre_high``.
    only
        Values of columns; other rows are left out.
    """
    names = [column.name for column in table.columns]
    lines: dict[str, dict[str, str]] = {}
    for cells in table.rows:
        row = dict(zip(names, cells, strict=True))
        if all(row[name] == value for name, value in only.items()):
            shown = interval_text(row["rmsre"], row["rmsre_low"], row["rmsre_high"])
            lines.setdefault(str(row[by]), {})[str(row["descriptor"])] = shown
    keys = list(dict.fromkeys(key for line in lines.values() for key in line))
    columns = (Column(by), *(Column("J" if key == JACCARD else CATALOGUE[key].symbol, "%") for key in keys))
    rows = tuple((name or "all", *(line.get(key, "") for key in keys)) for name, line in lines.items())
    return Table(title, columns, rows)


def selected_columns(table: Table, names: tuple[str, ...], title: str) -> Table:
    """The columns of these names."""
    at = [[column.name for column in table.columns].index(name) for name in names]
    rows = tuple(tuple(row[k] for k in at) for row in table.rows)
    return Table(title, tuple(table.columns[k] for k in at), rows)


def png_of(files: Sequence[Path], stem: str) -> Path:
    """The PNG of this stem among the files of a study."""
    return next(path for path in files if path.name == f"{stem}.png")
