"""A report as one HTML file that opens without a network: pictures are inside."""

import base64
from collections.abc import Sequence
from html import escape

from regolith_studio.io.tables import Table, rows_as_text
from regolith_studio.session.outputs.summary import html_figure, html_page, html_table
from regolith_studio.session.report.sections import TITLE, ReportSection


def report_page(sections: Sequence[ReportSection]) -> str:
    """The page."""
    links = "".join(
        f'<li><a href="#section-{number}">{escape(section.title)}</a></li>'
        for number, section in enumerate(sections)
    )
    parts = [f"<h1>{TITLE}</h1>", f"<ol>{links}</ol>"]
    parts += [_section(number, section) for number, section in enumerate(sections)]
    return html_page(TITLE, parts)


def _section(number: int, section: ReportSection) -> str:
    parts = [f'<h2 id="section-{number}">{escape(section.title)}</h2>']
    if section.problem:
        parts.append(f"<p><strong>Missing:</strong> {escape(section.problem)}</p>")
    parts += [f"<p>{escape(text)}</p>" for text in section.paragraphs]
    for figure in section.figures:
        encoded = base64.b64encode(figure.file.read_bytes()).decode("ascii")
        parts.append(html_figure(f"data:image/png;base64,{encoded}", figure.caption))
    parts += [_table(table) for table in section.tables]
    return "\n".join(parts)


def _table(table: Table) -> str:
    header, *rows = rows_as_text(table, digits=4)
    return f"<h3>{escape(table.title)}</h3>{html_table(header, rows)}"
