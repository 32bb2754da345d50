"""A report as one HTML file that opens without a network: pictures and meshes are inside."""

import base64
from collections.abc import Mapping, Sequence
from html import escape

import numpy as np

from regolith_studio.geometry.decimation import decimated
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.tables import Table, rows_as_text
from regolith_studio.resources import resource
from regolith_studio.session.outputs.summary import html_figure, html_page, html_table
from regolith_studio.session.report.sections import TITLE, ReportSection

MAX_TRIANGLES = 6000
"""Of a mesh in the page; finer ones are decimated, so that they turn smoothly."""
CANVAS_SIZE = (300, 280)
"""Width and height of a mesh in pixels."""


def report_page(sections: Sequence[ReportSection]) -> str:
    """The page."""
    links = "".join(
        f'<li><a href="#section-{number}">{escape(section.title)}</a></li>'
        for number, section in enumerate(sections)
    )
    parts = [f"<h1>{TITLE}</h1>", f"<ol>{links}</ol>"]
    parts += [_section(number, section) for number, section in enumerate(sections)]
    if any(section.meshes for section in sections):
        parts.append(f"<script>\n{resource('report', 'viewer.js').read_text(encoding='utf-8')}</script>")
    return html_page(TITLE, parts)


def _section(number: int, section: ReportSection) -> str:
    parts = [f'<h2 id="section-{number}">{escape(section.title)}</h2>']
    if section.problem:
        parts.append(f"<p><strong>Missing:</strong> {escape(section.problem)}</p>")
    parts += [f"<p>{escape(text)}</p>" for text in section.paragraphs]
    for figure in section.figures:
        encoded = _base64(figure.file.read_bytes())
        parts.append(html_figure(f"data:image/png;base64,{encoded}", figure.caption))
    if section.meshes:
        parts.append(_turned(section.meshes))
    parts += [_table(table) for table in section.tables]
    return "\n".join(parts)


def _table(table: Table) -> str:
    header, *rows = rows_as_text(table, digits=4)
    return f"<h3>{escape(table.title)}</h3>{html_table(header, rows)}"


def _turned(meshes: Mapping[str, Mesh]) -> str:
    """Canvases that ``viewer.js`` draws on."""
    width, height = CANVAS_SIZE
    cells = [
        f'<figure style="margin: 0"><canvas width="{width}" height="{height}" tabindex="0" role="img" '
        f'style="touch-action: none; cursor: grab" aria-label="{escape(caption)}" {_mesh_data(mesh)}>'
        f"</canvas><figcaption>{escape(caption)}</figcaption></figure>"
        for caption, mesh in meshes.items()
    ]
    return (
        '<div class="turned" style="display: flex; flex-wrap: wrap; gap: 1rem">'
        f"{''.join(cells)}</div><p>Drag to turn, or use the arrow keys; Ctrl and the wheel zoom, a double "
        "click resets.</p>"
    )


def _mesh_data(mesh: Mesh) -> str:
    shown = mesh if len(mesh.faces) <= MAX_TRIANGLES else decimated(mesh, MAX_TRIANGLES)
    centred = shown.vertices - shown.bounds.mean(axis=0)
    points = _base64(np.asarray(centred, dtype="<f4").tobytes())
    triangles = _base64(np.asarray(shown.faces, dtype="<u4").tobytes())
    return f'data-points="{points}" data-triangles="{triangles}"'


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")
