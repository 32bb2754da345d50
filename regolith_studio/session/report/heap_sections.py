"""Sections of a report about polyhedra and their heap: Figs. 7 to 9, Tables 1 and 2."""

from dataclasses import fields
from typing import Any

import numpy as np

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import presets
from regolith_studio.dataset.parameters import PAPER_COARSE_GRAINING, PAPER_FILL_HEIGHT
from regolith_studio.dem.angle_of_repose import ReposeMeasurement
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.run_io import TIMES
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.io.tables import Column, Table, write_table
from regolith_studio.jobs.dataset_jobs import (
    DatasetBuildResult,
    DatasetOptions,
    RepresentativesRequest,
    build_dataset_folder,
)
from regolith_studio.jobs.repose_jobs import ReposeRequest, ReposeRun, repose_steps
from regolith_studio.jobs.study_jobs import study_coarsening, study_gallery
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.report.sections import (
    ReportDraft,
    ReportFigure,
    ReportSection,
    SectionSteps,
    error_table,
    png_of,
)
from regolith_studio.session.study_requests import chosen_rows
from regolith_studio.studies.coarsening import rmsre_table
from regolith_studio.studies.loss_variants import PAPER_LOSSES
from regolith_studio.studies.polyhedron_gallery import GalleryPolyhedron, gallery_table

GALLERY_LOSSES = ("quadric", "descriptors", "volume_sphericity_aspect_ratio", "aspect_ratio_overlap")
"""The columns of Fig. 7."""
DATASET, HEAP = "dataset", "heap"
N_PAPER_SHAPES, N_PAPER_PARTICLES, N_PAPER_FACETS = 10, 378_000, 20
PAPER_SIZES = "25, 37, 56, 84, 125"


def draw_polyhedra(draft: ReportDraft, title: str) -> SectionSteps:
    """Fig. 7."""
    choices = draft.settings.choices
    rows = chosen_rows(GALLERY_LOSSES, choices)
    study = yield from study_gallery(draft.drawn, choices.coarsening_request, rows, draft.executor)
    files = STUDIES["solids_study"].write(study, draft.folder / "polyhedra")
    table = gallery_table(study)
    failed = [f"{row[1]} ({row[0]}): {row[-1]}" for row in table.rows if row[-1]]
    first = {
        f"{study.names[0]}: {study.rows[row]}": each.polyhedron.mesh
        for (row, column), each in sorted(study.cells.items(), key=lambda item: item[0])
        if column == 0 and isinstance(each, GalleryPolyhedron)
    }
    return ReportSection(
        title,
        (
            f"Each column is a particle, each row a loss (Eq. 9). The polyhedra have {draft.settings.facets} "
            "facets (Eqs. 5 and 6), imitate the expansion of the particle cut at l_max = "
            f"{draft.settings.l_max}, and are made by {_method(draft)}; the first row is quadric decimation. "
            "J is the Jaccard distance (IoU of Eq. 7).",
            *failed,
        ),
        (ReportFigure(png_of(files, "solids"), "Polyhedra by loss and particle."),),
        meshes=first,
    )


def _method(draft: ReportDraft) -> str:
    if draft.settings.method == "annealing":
        return "the simulated annealing of section 2.4"
    label = METHODS[draft.settings.method].label
    return f"the method {label} in place of the annealing of section 2.4"


def compare_losses(draft: ReportDraft, title: str) -> SectionSteps:
    """Fig. 8."""
    choices = draft.settings.choices
    rows = chosen_rows(PAPER_LOSSES, choices)
    study = yield from study_coarsening(draft.studied, choices.coarsening_request, draft.executor, rows=rows)
    files = STUDIES["coarsening_study"].write(study, draft.folder / "losses")
    table = error_table(rmsre_table(study), "row", "RMSRE by loss; J is the mean Jaccard distance")
    unmet = ", ".join(f"{row.label} {n}" for row, n in zip(study.rows, study.n_unmet, strict=True) if n)
    return ReportSection(
        title,
        (
            f"{len(study.names):,} particles are coarsened to {draft.settings.facets} facets by each loss, "
            f"and compared with their expansions at l_max = {draft.settings.l_max}: RMSRE of Eq. 10 over the "
            f"relative errors of Eq. 8. The polyhedra are made by {_method(draft)}; all weights 0 stand for "
            f"quadric decimation. Intervals hold {study.confidence:.0%} of 1,000 resamples of the particles.",
            *([f"Requests that could not be met exactly, by loss: {unmet}."] if unmet else []),
            *(f"{name} was left out: {reason}" for name, reason in study.failures),
        ),
        (ReportFigure(png_of(files, "coarsening_rmsre"), "RMSRE in percent for each set of weights."),),
        (table,),
    )


def make_dataset(draft: ReportDraft, title: str) -> SectionSteps:
    """The representatives of section 2.5, which the heap is made of."""
    settings, choices = draft.settings, draft.settings.choices
    count = min(settings.representatives, len(draft.particles))
    options = DatasetOptions(
        "report",
        settings.preset,
        workers=draft.executor,
        representatives=RepresentativesRequest(count, seed=settings.seed),
    )
    built: DatasetBuildResult = yield from build_dataset_folder(
        draft.particles, choices.coarsening_request, draft.folder / DATASET, options, draft.population
    )
    draft.dataset = built.dataset
    worst = max(
        (each.approximation.errors[key], key)
        for each in built.dataset.representatives
        if each.approximation
        for key in LOSS_KEYS
    )
    return ReportSection(
        title,
        (
            f"{len(built.dataset)} particles stand for all {len(draft.particles):,} (section 2.5), each as a "
            f"convex polyhedron of unit volume with a weight and the sizes of those that it stands for. They "
            f"are coarsened with the preset {presets()[settings.preset].label}; the largest relative error "
            f"of a descriptor (Eq. 8) is {worst[0]:.2g}, of the {CATALOGUE[worst[1]].label.lower()}. The "
            f"folder {DATASET} holds them as STL and JSON.",
        ),
        tables=(representatives_table(built),),
    )


def representatives_table(built: DatasetBuildResult) -> Table:
    """Weight, size and approximation of each representative."""
    rows = tuple(
        (
            each.name,
            each.weight,
            each.n_members,
            float(np.cbrt(each.sizes.mean_cube())),
            each.shape.n_facets,
            each.shape.n_triangles,
            None if each.approximation is None else each.approximation.jaccard_distance,
        )
        for each in built.dataset.representatives
    )
    names = ("name", "weight", "particles")
    columns = (*map(Column, names), Column("diameter", "um"), *map(Column, ("facets", "triangles", "J")))
    return Table("Representatives: diameters of the mean volume, and Jaccard distances J", columns, rows)


def show_parameters(draft: ReportDraft, title: str) -> SectionSteps:
    """Tables 1 and 2, as used for the heap."""
    case = _case(draft)
    prepared, none = None, "There is no heap, so that its numbers are missing."
    if draft.settings.heap and draft.dataset:
        try:
            prepared = prepare(draft.dataset, case)
        except InputError as error:  # Fig. 9 fails of it; the tables are settings
            none = str(error)
    tables = (contact_table(draft, case, prepared), cylinder_table(case, prepared))
    for number, table in enumerate(tables, start=1):
        write_table(table, draft.folder / "tables", f"table_{number}")
    yield from ()
    return ReportSection(
        title,
        (
            "The contact parameters (Table 1) and the lifting cylinder (Table 2) are the paper's; values "
            "that it does not give are marked.",
            *([] if prepared else [none]),
        ),
        tables=tables,
    )


def _case(draft: ReportDraft) -> ReposeCase:
    return ReposeCase(n_particles=draft.settings.heap or N_PAPER_PARTICLES, seed=draft.settings.seed)


def _parameter_rows(parameters: Any) -> list[tuple[str, str, str, str]]:
    """Label, unit, value used and value of the paper."""
    rows = []
    for each in fields(parameters):
        known = each.metadata
        used, default = (f"{known['factor'] * x:g}" for x in (getattr(parameters, each.name), each.default))
        rows.append(
            (known["label"], known["unit"], used, default if "Table" in known["source"] else "not given")
        )
    return rows


_COLUMNS = tuple(map(Column, ("parameter", "unit", "used", "in the paper")))


def contact_table(draft: ReportDraft, case: ReposeCase, prepared: PreparedCase | None) -> Table:
    """Table 1."""
    sizes = grain = ""
    shapes = str(len(draft.dataset)) if draft.dataset else ""
    if prepared is not None:
        fine = 1e6 * prepared.diameters / prepared.coarse_graining
        sizes, grain = f"{fine.min():.3g} to {fine.max():.3g}", f"{prepared.coarse_graining:.3g}"
    rows = (
        *_parameter_rows(case.contact),
        ("Number of particle geometries", "", shapes, str(N_PAPER_SHAPES)),
        ("Particle sizes", "µm", sizes, PAPER_SIZES),
        ("Number of facets of each particle", "", str(draft.settings.facets), str(N_PAPER_FACETS)),
        ("Coarse-graining factor", "", grain, f"{PAPER_COARSE_GRAINING:g}"),
    )
    return Table("Table 1: parameters of the simulation", _COLUMNS, rows)


def cylinder_table(case: ReposeCase, prepared: PreparedCase | None) -> Table:
    """Table 2."""
    low, high = (100 * height for height in PAPER_FILL_HEIGHT)
    fill = count = ""
    if prepared is not None:
        fill, count = f"{100 * prepared.fill_height:.3g} (expected)", f"{len(prepared):,}"
    rows = (
        *_parameter_rows(case.test),
        ("Fill height", "cm", fill, f"{low:g} to {high:g}"),
        ("Number of particles", "", count, f"{N_PAPER_PARTICLES:,}"),
    )
    return Table("Table 2: the lifting cylinder", _COLUMNS, rows)


def simulate_heap(draft: ReportDraft, title: str) -> SectionSteps:
    """Fig. 9."""
    if not draft.settings.heap:
        return ReportSection(title, ("No heap was asked for.",))
    _ = draft.representatives
    folder = draft.folder / HEAP
    run: ReposeRun = yield from repose_steps(draft.folder / DATASET, folder, ReposeRequest(_case(draft)))
    (folder / TIMES).unlink()  # differs from run to run
    if not isinstance(run.measurement, ReposeMeasurement):
        return ReportSection(title, (_run_sentence(run),), problem=str(run.measurement))
    caption = "The x-z and the y-z section: particles, the surface within the cuts, and both fits."
    return ReportSection(
        title,
        (
            _run_sentence(run),
            _angle_sentence(run.measurement),
            *run.measurement.warnings,
            *run.document["run"]["notes"],
            *run.document["checks"]["problems"],
        ),
        (ReportFigure(folder / "sections.png", caption),),
    )


def _run_sentence(run: ReposeRun) -> str:
    engine, case = run.document["engine"], run.document["case"]
    grain = run.document["particles"]["coarse_graining"]
    height = 100 * run.ending.checks.fill_height
    return (
        f"{case['n_particles']:,} polyhedra of the dataset, enlarged {grain:.3g} times so that they have the "
        f"mass of Table 2, fill the cylinder to {height:.2f} cm; it is lifted, and a heap forms (section "
        f"2.6). Simulated by {engine['label']} {engine['version']}; cohesion: {case['cohesion']}. One run is "
        "one filling: other seeds give other angles."
    )


def _angle_sentence(measured: ReposeMeasurement) -> str:
    low, high = measured.interval
    two, one = measured.paper_asymmetric, measured.paper_symmetric
    return (
        f"The angle of repose is {measured.angle:.1f} degrees, between {low:.1f} and {high:.1f} with a "
        f"confidence of {measured.settings.confidence:.0%}, over {len(measured.sections)} sections. In the "
        f"two sections of the paper the flanks have {two.mean:.1f} degrees in the mean (asymmetric model), "
        f"both together {one.mean:.1f} (symmetric model); the upper and lower "
        f"{measured.settings.cut_top:.0%} of the height are left out (section 3.3)."
    )
