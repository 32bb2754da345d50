"""A report as a PDF of A4 pages: the text and tables of the page, and its pictures."""

import textwrap
from collections.abc import Sequence
from pathlib import Path

from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure
from matplotlib.image import imread

from regolith_studio.io.tables import Table, rows_as_text
from regolith_studio.session.report.sections import TITLE, ReportFigure, ReportSection
from regolith_studio.studies.figures import DOTS_PER_INCH, MATPLOTLIB_LOCK

PAGE = (8.27, 11.69)
"""A4 in inches."""
MARGIN = 0.8
POINT = 1 / 72
LEADING = 1.4
LINE = PAGE[0] - 2 * MARGIN
"""Width of the text in inches."""
TEXT_SIZE, HEADING_SIZE, TITLE_SIZE, TABLE_SIZE, MIN_TABLE_SIZE = 9.0, 13.0, 18.0, 7.5, 6.5
"""In points."""
LETTER, MONO_LETTER = 0.55, 0.605
"""Mean width of a letter as a share of the size of the type."""
GAP = "  "
"""Between the columns of a table."""
MAX_PICTURE = 6.0
"""Height of a picture in inches."""


def write_report_pdf(sections: Sequence[ReportSection], path: Path) -> None:
    """Write the PDF; the same sections give the same bytes."""
    with MATPLOTLIB_LOCK, PdfPages(path, metadata={"Title": TITLE, "CreationDate": None}) as pages:
        flow = _PageFlow(pages)
        flow.text(TITLE, TITLE_SIZE)
        for section in sections:
            flow.text(section.title, HEADING_SIZE, keep=2.5)
            if section.problem:
                flow.text(f"Missing: {section.problem}", TEXT_SIZE)
            for paragraph in section.paragraphs:
                flow.text(paragraph, TEXT_SIZE)
            for figure in section.figures:
                flow.picture(figure)
            for table in section.tables:
                flow.table(table)
        flow.close()


def column_groups(widths: Sequence[int], letters: int) -> list[list[int]]:
    """Columns of a table that fit beside each other; each group begins with the first column.

    ``widths``: of the columns in letters. ``letters``: width of a line; a column that is too wide for it
    even alone gets a group of its own.
    """
    groups, used = [[0]], widths[0]
    for column, width in enumerate(widths[1:], start=1):
        if used + len(GAP) + width > letters and len(groups[-1]) > 1:
            groups.append([0])
            used = widths[0]
        groups[-1].append(column)
        used += len(GAP) + width
    return groups


class _PageFlow:
    """Fills pages from top to bottom."""

    def __init__(self, pages: PdfPages) -> None:
        self._pages = pages
        self._figure = Figure(figsize=PAGE)
        self._used = MARGIN

    def close(self) -> None:
        """Write the last page."""
        self._pages.savefig(self._figure)  # type: ignore[no-untyped-call]

    def text(self, text: str, size: float, keep: float = 0.0) -> None:
        """Wrapped lines; with `keep` on a new page where so many inches do not follow on this one."""
        width = int(LINE / (LETTER * size * POINT))
        self._make_room(keep)
        for line in textwrap.wrap(text, width):
            self._line(line, size)
        self._used += 0.5 * size * POINT

    def table(self, table: Table) -> None:
        """Columns in a fixed-width type, one group of columns below the other where they do not fit."""
        lines = rows_as_text(table)
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        self.text(table.title, TEXT_SIZE, keep=1.0)
        for part in column_groups(widths, int(LINE / (MONO_LETTER * MIN_TABLE_SIZE * POINT))):
            shown = [GAP.join(line[k].ljust(widths[k]) for k in part) for line in lines]
            size = min(TABLE_SIZE, LINE / (MONO_LETTER * POINT * max(map(len, shown))))
            for line in shown:
                self._line(line, size, family="monospace")
            self._used += TEXT_SIZE * POINT

    def picture(self, figure: ReportFigure) -> None:
        """A picture and its caption, on one page."""
        image = imread(figure.file)
        height, width = (pixels / DOTS_PER_INCH for pixels in image.shape[:2])
        scale = min(1.0, LINE / width, MAX_PICTURE / height)
        height, width = scale * height, scale * width
        self._make_room(height + 0.6)
        bottom = PAGE[1] - self._used - height
        axes = self._figure.add_axes((MARGIN / PAGE[0], bottom / PAGE[1], width / PAGE[0], height / PAGE[1]))
        axes.imshow(image, aspect="auto", interpolation="none")
        axes.set_axis_off()
        self._used += height
        self.text(figure.caption, TEXT_SIZE)

    def _line(self, text: str, size: float, family: str = "sans-serif") -> None:
        height = LEADING * size * POINT
        self._make_room(height)
        self._figure.text(
            MARGIN / PAGE[0],
            1 - (self._used + size * POINT) / PAGE[1],
            text,
            fontsize=size,
            family=family,
            parse_math=False,
        )
        self._used += height

    def _make_room(self, height: float) -> None:
        if self._used > MARGIN and self._used + height > PAGE[1] - MARGIN:
            self._pages.savefig(self._figure)  # type: ignore[no-untyped-call]
            self._figure, self._used = Figure(figsize=PAGE), MARGIN
