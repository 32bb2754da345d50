"""The polyhedra that each loss makes of some particles, as numbers (Fig. 7)."""

from collections.abc import Mapping
from dataclasses import dataclass

from regolith_studio.coarsening.result import Coarsened
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.studies.tables import Cell, Column, Table


@dataclass(frozen=True, eq=False)
class SolidStudy:
    """Some particles, each coarsened by every loss.

    Parameters
    ----------
    rows, names
        Labels of the losses, names of the particles.
    cells
        By number of row and particle: the polyhedron, or the sentence that says why there is none.
    """

    rows: tuple[str, ...]
    names: tuple[str, ...]
    cells: Mapping[tuple[int, int], Coarsened | str]


def solid_table(study: SolidStudy) -> Table:
    """Facets, errors and what no polyhedron can do better, a line a picture."""
    lines = [
        (study.rows[row], study.names[column], *_numbers(found))
        for (row, column), found in sorted(study.cells.items(), key=lambda item: item[0])
    ]
    counts = ("method", "facets", "vertices", "triangles")
    errors = [Column(key, "%") for key in (*LOSS_KEYS, JACCARD)]
    bounds = [Column(f"{key}_bound", "%") for key in (*LOSS_KEYS, JACCARD)]
    columns = (*map(Column, ("row", "name", *counts)), *errors, *bounds, Column("loss"), Column("reason"))
    notes = ("Relative errors of Eq. 8 and the Jaccard distance of Eq. 7; a bound is the least attainable.",)
    return Table("Polyhedra by loss and particle", columns, tuple(lines), notes)


def _numbers(found: Coarsened | str) -> tuple[Cell, ...]:
    if isinstance(found, str):
        return (*(None,) * (4 + 2 * (len(LOSS_KEYS) + 1) + 1), found)
    errors = [100 * found.errors[key] for key in LOSS_KEYS]
    bounds = [100 * found.bounds[key] for key in (*LOSS_KEYS, JACCARD)]
    counts = (found.method, found.n_faces, found.n_vertices, found.n_triangles)
    return (*counts, *errors, 100 * found.jaccard_distance, *bounds, found.loss, found.reason)
