"""The job that writes a report: every section after the other, whatever becomes of the others."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from regolith_studio.dataset.build import software_versions
from regolith_studio.errors import InputError, JobCancelled, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import staged_folder, write_bytes
from regolith_studio.io.json_text import json_bytes
from regolith_studio.io.tables import Column, Table
from regolith_studio.jobs.compile_kernels import compile_first_for
from regolith_studio.jobs.events import Partial, Started, Steps
from regolith_studio.jobs.executor import Executor, open_executor
from regolith_studio.jobs.study_jobs import hash_of_particles
from regolith_studio.messages import N_
from regolith_studio.session.outputs.summary import SHOWN_ROWS
from regolith_studio.session.report.draft import ReportDraft, SectionSteps
from regolith_studio.session.report.heap_sections import (
    compare_losses,
    draw_polyhedra,
    make_dataset,
    show_parameters,
    simulate_heap,
)
from regolith_studio.session.report.page import report_page
from regolith_studio.session.report.sections import ReportSection
from regolith_studio.session.report.settings import ReportSettings
from regolith_studio.session.report.shape_sections import (
    compare_degrees,
    compare_population,
    describe_sample,
    draw_degrees,
)
from regolith_studio.settings import settings_of_kind

PAGE, PDF, DOCUMENT = "report.html", "report.pdf", "report.json"
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

    Parameters
    ----------
    folder
        Holds :data:`PAGE`, :data:`PDF`, :data:`DOCUMENT` and a folder a figure.
    files
        Relative to the folder, sorted.
    problems
        One sentence for each section that is missing.
    """

    folder: Path
    files: tuple[str, ...]
    problems: tuple[str, ...]


@dataclass(frozen=True)
class SectionBegun:
    """Emitted before a section is made.

    Parameters
    ----------
    number, total
        Of the sections, from 1.
    """

    number: int
    total: int
    title: str


def write_report(
    particles: Sequence[Particle],
    folder: Path,
    settings: ReportSettings | None = None,
    workers: int | Executor = 1,
) -> Steps:
    """Make all figures and tables of the paper for a sample, and a page and a PDF with them.

    A section that fails says so in its place and stops nothing. Partial results are :class:`SectionBegun`.
    Returns :class:`WrittenReport`.

    Parameters
    ----------
    workers
        Processes at a time; 0 for one a core. The files do not depend on it.

    Raises
    ------
    InputError
        If there is no particle.
    FileError
        If the folder cannot be written.
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
    from regolith_studio.session.report.pdf import write_report_pdf  # matplotlib

    write_report_pdf(sections, stage / PDF)
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
