"""Polyhedra of some particles for each loss, as data and as a table (Fig. 7)."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from regolith_studio.coarsening.lower_bounds import bounds_in_force
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.io.tables import Cell, Column, Table


@dataclass(frozen=True, eq=False)
class GalleryPolyhedron:
    """What a gallery keeps of a coarsened particle; can be converted to a JSON document and back.

    ``method``, ``polyhedron``, ``errors``, ``jaccard_distance``, ``loss``, ``bounds``, ``reason``: as in
    :class:`regolith_studio.coarsening.result.CoarseningResult`.
    """

    method: str
    polyhedron: Polyhedron
    errors: Mapping[str, float]
    jaccard_distance: float
    loss: float
    bounds: Mapping[str, float]
    reason: str | None

    @classmethod
    def of(cls, result: CoarseningResult) -> "GalleryPolyhedron":
        """Of a particle just coarsened."""
        return cls(*(getattr(result, each.name) for each in fields(cls)))

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> "GalleryPolyhedron":
        """The inverse of :meth:`document`."""
        parts = tuple(map(_part_from, document["parts"]))
        places = np.array([part["place"] for part in document["parts"]])
        compound = len(parts) > 1 or places.any()
        solid = ConvexCompound(parts, places) if compound else parts[0]
        kept = ("errors", "jaccard_distance", "loss", "bounds", "reason")
        return cls(document["method"], solid, *(document[key] for key in kept))

    def document(self) -> dict[str, Any]:
        """As JSON takes it, to the last bit."""
        solid = self.polyhedron
        if isinstance(solid, ConvexCompound):
            pairs = list(zip(solid.parts, solid.places.tolist(), strict=True))
        else:
            pairs = [(solid, [0.0, 0.0, 0.0])]
        return {
            "method": self.method,
            "parts": [_part_document(part, place) for part, place in pairs],
            "errors": {key: float(error) for key, error in self.errors.items()},
            "jaccard_distance": float(self.jaccard_distance),
            "loss": float(self.loss),
            "bounds": {key: float(bound) for key, bound in self.bounds.items()},
            "reason": self.reason,
        }


def _part_document(part: ConvexPolyhedron, place: list[float]) -> dict[str, Any]:
    return {
        "place": place,
        "normals": part.half_spaces.normals.tolist(),
        "offsets": part.half_spaces.offsets.tolist(),
        "vertices": part.vertices.tolist(),
        "facets": [[int(corner) for corner in facet] for facet in part.facets],
    }


def _part_from(document: Mapping[str, Any]) -> ConvexPolyhedron:
    planes = HalfSpaces(np.array(document["normals"]), np.array(document["offsets"]))
    facets = tuple(tuple(facet) for facet in document["facets"])
    return ConvexPolyhedron(planes, np.array(document["vertices"]), facets)


@dataclass(frozen=True, eq=False)
class GalleryStudy:
    """Some particles, each coarsened by every loss.

    ``rows``, ``names``: labels of the losses, names of the particles. ``cells``: by number of row and
    particle: the polyhedron, or the sentence that says why there is none.
    """

    rows: tuple[str, ...]
    names: tuple[str, ...]
    cells: Mapping[tuple[int, int], GalleryPolyhedron | str]


def gallery_table(study: GalleryStudy) -> Table:
    """Facets, errors and what no polyhedron can do better, a line a picture."""
    lines = [
        (study.rows[row], study.names[column], *_numbers(cell))
        for (row, column), cell in sorted(study.cells.items(), key=lambda item: item[0])
    ]
    counts = ("method", "facets", "vertices", "triangles")
    errors = [Column(key, "%") for key in (*LOSS_KEYS, JACCARD)]
    bounds = [Column(f"{key}_bound", "%") for key in (*LOSS_KEYS, JACCARD)]
    columns = (*map(Column, ("row", "name", *counts)), *errors, *bounds, Column("loss"), Column("reason"))
    notes = ("Relative errors of Eq. 8 and the Jaccard distance of Eq. 7; a bound is the least attainable.",)
    return Table("Polyhedra by loss and particle", columns, tuple(lines), notes)


def _numbers(cell: GalleryPolyhedron | str) -> tuple[Cell, ...]:
    if isinstance(cell, str):
        return (*(None,) * (4 + 2 * (len(LOSS_KEYS) + 1) + 1), cell)
    errors = [100 * cell.errors[key] for key in LOSS_KEYS]
    held = bounds_in_force(cell.bounds, cell.errors)
    bounds = [100 * held[key] for key in (*LOSS_KEYS, JACCARD)]
    solid = cell.polyhedron
    counts = (cell.method, solid.n_facets, solid.n_vertices, solid.n_triangles)
    return (*counts, *errors, 100 * cell.jaccard_distance, *bounds, cell.loss, cell.reason)
