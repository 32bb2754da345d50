"""The job that writes a report: every section after the other, whatever becomes of the others."""

import base64
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.coarsening.decimated_hull import decimated
from regolith_studio.dataset.build import software_versions
from regolith_studio.errors import InputError, JobCancelled, RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import staged_folder, write_bytes
from regolith_studio.io.own_files import json_bytes
from regolith_studio.io.tables import Column, Table, rows_as_text
from regolith_studio.jobs.compile_kernels import compile_first_for
from regolith_studio.jobs.events import Partial, Started, Steps
from regolith_studio.jobs.executor import Executor, open_executor
from regolith_studio.jobs.study_jobs import hash_of_particles
from regolith_studio.messages import N_
from regolith_studio.resources import resource
from regolith_studio.session.outputs.summary import SHOWN_ROWS, html_figure, html_page, html_table
from regolith_studio.session.report.heap_sections import (
    compare_losses,
    draw_polyhedra,
    make_dataset,
    show_parameters,
    simulate_heap,
)
from regolith_studio.session.report.sections import TITLE, ReportDraft, ReportSection, SectionSteps
from regolith_studio.session.report.settings import PAGE, ReportSettings, SectionBegun
from regolith_studio.session.report.shape_sections import (
    compare_degrees,
    compare_population,
    describe_sample,
    draw_degrees,
)
from regolith_studio.settings import settings_of_kind

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
        f'{"".join(cells)}</div><p class="screen">Drag to turn, or use the arrow keys; Ctrl and the '
        "wheel zoom, a double click resets.</p>"
    )


def _mesh_data(mesh: Mesh) -> str:
    shown = mesh if len(mesh.faces) <= MAX_TRIANGLES else decimated(mesh, MAX_TRIANGLES)
    centred = shown.vertices - shown.bounds.mean(axis=0)
    points = _base64(np.asarray(centred, dtype="<f4").tobytes())
    triangles = _base64(np.asarray(shown.faces, dtype="<u4").tobytes())
    return f'data-points="{points}" data-triangles="{triangles}"'


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")


DOCUMENT = "report.json"
PARTS: Mapping[str, Callable[[ReportDraft, str], SectionSteps]] = {
    N_("The sample"): describe_sample,
    N_("Fig. 2: a particle and its spherical harmonics"): draw_degrees,
    N_("Fig. 3: errors against l_max"): compare_degrees,
    N_("Figs. 4 to 6: drawn and measured particles"): compare_population,
    N_("Fig. 7: polyhedra"): draw_polyhedra,
    N_("Fig. 8: errors by loss"): compare_losses,
    N_("Representative particles"): make_dataset,
    N_("Tables 1 and 2: parameters of the heap"): show_parameters,
    N_("Fig. 9: the angle of repose"): simulate_heap,
}
"""Title of each section, and what makes it."""


@dataclass(frozen=True)
class WrittenReport:
    """A report on disk.

    - ``folder``: holds :data:`PAGE`, :data:`DOCUMENT` and a folder a figure.
    - ``files``: relative to the folder, sorted.
    - ``problems``: one sentence for each section that is missing.
    """

    folder: Path
    files: tuple[str, ...]
    problems: tuple[str, ...]


def write_report(
    particles: Sequence[Particle],
    folder: Path,
    settings: ReportSettings | None = None,
    workers: int | Executor = 1,
) -> Steps:
    """Make all figures and tables of the paper for a sample, and a page with them.

    A section that fails says so in its place and stops nothing. Partial results are :class:`SectionBegun`.
    Returns :class:`WrittenReport`.

    ``workers``: processes at a time; 0 for one a core. The files do not depend on it.
    """
    if not particles:
        raise InputError("A report needs at least one particle.")
    settings = settings or ReportSettings()
    yield from compile_first_for(settings.method)
    with open_executor(workers) as executor, staged_folder(folder, "report") as stage:
        draft = ReportDraft(tuple(particles), settings, stage, executor)
        sections: list[ReportSection] = []
        for number, (title, part) in enumerate(PARTS.items(), start=1):
            yield Partial(SectionBegun(number, len(PARTS), title))
            try:
                sections.append((yield from part(draft, title)))
            except JobCancelled:
                raise
            except RegolithError as error:
                sections.append(ReportSection(title, problem=str(error).replace(str(stage), folder.name)))
        yield Started(N_("Writing the report"))
        problems = tuple(f"{each.title}: {each.problem}" for each in sections if each.problem)
        _write_files(stage, draft, [*sections, _provenance(draft)], problems)
        files = sorted(path.relative_to(stage).as_posix() for path in stage.rglob("*") if path.is_file())
    return WrittenReport(folder, tuple(files), problems)


def _write_files(
    stage: Path, draft: ReportDraft, sections: Sequence[ReportSection], problems: Sequence[str]
) -> None:
    write_bytes(stage / PAGE, report_page(sections).encode("utf-8", "backslashreplace"))
    document: dict[str, Any] = {
        "format": "regolith-studio report",
        "settings": asdict(draft.settings),
        "particles": [_origin(each) for each in draft.particles],
        "particles_sha256": hash_of_particles(draft.particles),
        "software": software_versions(),
        "problems": list(problems),
    }
    write_bytes(stage / DOCUMENT, json_bytes(document))


def _origin(particle: Particle) -> dict[str, str]:
    source = particle.source
    return {
        "name": particle.name,
        "group": particle.group,
        "file": Path(source.path).name if source else "",
        "sha256": source.sha256 if source else "",
    }


def _provenance(draft: ReportDraft) -> ReportSection:
    """Settings, versions and hashes."""
    chosen = tuple(
        (each.metadata["label"], each.name, getattr(draft.settings, each.name), each.metadata["tip"])
        for each in settings_of_kind(draft.settings)
    )
    origins = [tuple(_origin(each).values()) for each in draft.particles]
    more = f" The first {SHOWN_ROWS} are shown; {DOCUMENT} holds all." if len(origins) > SHOWN_ROWS else ""
    return ReportSection(
        "How it was made",
        (
            "The same files, settings and versions give the same bytes on one kind of processor.",
            f"SHA-256 of all particles, as read: {hash_of_particles(draft.particles)}.{more}",
        ),
        tables=(
            Table("Settings", tuple(map(Column, ("setting", "name", "value", "meaning"))), chosen),
            Table("Versions", (Column("package"), Column("version")), tuple(software_versions().items())),
            Table(
                "Particles",
                tuple(map(Column, ("name", "group", "file", "sha256"))),
                tuple(origins[:SHOWN_ROWS]),
            ),
        ),
    )
