"""Polyhedra of some particles for each loss, as data and as a table (Fig. 7)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from regolith_studio.coarsening.lower_bounds import bounds_in_force
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.io.tables import Cell, Column, Table


@dataclass(frozen=True, eq=False)
class GalleryPolyhedron:
    """What a gallery keeps of a coarsened particle; can be converted to a JSON document and back.

    Parameters
    ----------
    method, polyhedron, errors, jaccard_distance, loss, bounds, reason
        As in :class:`regolith_studio.coarsening.result.CoarseningResult`.
    """

    method: str
    polyhedron: ConvexPolyhedron
    errors: Mapping[str, float]
    jaccard_distance: float
    loss: float
    bounds: Mapping[str, float]
    reason: str | None

    @classmethod
    def of(cls, found: CoarseningResult) -> Self | str:
        """Of a particle just coarsened; a sentence for a union of several parts, which is not drawn."""
        solid = found.polyhedron
        if isinstance(solid, ConvexCompound):
            return f"A compound of {solid.n_parts} parts is not drawn in this figure."
        return cls(
            found.method,
            solid,
            found.errors,
            found.jaccard_distance,
            found.loss,
            found.bounds,
            found.reason,
        )

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> Self:
        """The inverse of :meth:`document`."""
        planes = HalfSpaces(np.array(document["normals"]), np.array(document["offsets"]))
        facets = tuple(tuple(facet) for facet in document["facets"])
        polyhedron = ConvexPolyhedron(planes, np.array(document["vertices"]), facets)
        kept = ("errors", "jaccard_distance", "loss", "bounds", "reason")
        return cls(document["method"], polyhedron, *(document[key] for key in kept))

    def document(self) -> dict[str, Any]:
        """As JSON takes it, to the last bit."""
        solid = self.polyhedron
        return {
            "method": self.method,
            "normals": solid.half_spaces.normals.tolist(),
            "offsets": solid.half_spaces.offsets.tolist(),
            "vertices": solid.vertices.tolist(),
            "facets": [[int(corner) for corner in facet] for facet in solid.facets],
            "errors": {key: float(error) for key, error in self.errors.items()},
            "jaccard_distance": float(self.jaccard_distance),
            "loss": float(self.loss),
            "bounds": {key: float(bound) for key, bound in self.bounds.items()},
            "reason": self.reason,
        }


@dataclass(frozen=True, eq=False)
class GalleryStudy:
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
    cells: Mapping[tuple[int, int], GalleryPolyhedron | str]


def gallery_table(study: GalleryStudy) -> Table:
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


def _numbers(found: GalleryPolyhedron | str) -> tuple[Cell, ...]:
    if isinstance(found, str):
        return (*(None,) * (4 + 2 * (len(LOSS_KEYS) + 1) + 1), found)
    errors = [100 * found.errors[key] for key in LOSS_KEYS]
    held = bounds_in_force(found.bounds, found.errors)
    bounds = [100 * held[key] for key in (*LOSS_KEYS, JACCARD)]
    solid = found.polyhedron
    counts = (found.method, solid.n_facets, solid.n_vertices, solid.n_triangles)
    return (*counts, *errors, 100 * found.jaccard_distance, *bounds, found.loss, found.reason)
