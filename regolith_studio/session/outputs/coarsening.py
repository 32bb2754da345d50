"""Coarsened particles: one STL each, and ``coarsening.json`` with their errors."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.lower_bounds import bounds_in_force
from regolith_studio.coarsening.reasons import EXACT
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.atomic import write_bytes, write_in_stage
from regolith_studio.io.file_names import file_stem
from regolith_studio.io.own_files import json_bytes
from regolith_studio.io.tables import Cell, Column, Table
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest

STL_HEADER = "Regolith Studio, coarsened particle, micrometres"


def write_coarsening(folder: Path, request: CoarseningRequest, done: Sequence[CoarsenedParticle]) -> None:
    """Write ``<name>.stl`` for each particle that succeeded, in its own frame, and ``coarsening.json``.

    A union of several parts has ``<name>.part1.stl`` ... besides.

    The durations are in ``times.json`` alone, so that equal runs have equal results.
    """
    for each in done:
        if each.coarsened:
            for file, mesh in meshes_of(each.name, each.coarsened).items():
                write_in_stage(folder, file, stl_bytes(mesh.triangles, STL_HEADER))
    times = {each.name: round(each.seconds, 3) for each in done}
    write_bytes(folder / "times.json", json_bytes({"seconds": times}))
    write_bytes(folder / "coarsening.json", json_bytes(coarsening_document(request, done)))


def coarsening_document(request: CoarseningRequest, done: Sequence[CoarsenedParticle]) -> dict[str, Any]:
    """What ``coarsening.json`` holds."""
    return document_head(request) | {
        "particles": [coarsening_entry(each, each.coarsened) for each in done if each.coarsened],
        "failed": [{"name": each.name, "reason": each.problem} for each in done if not each.coarsened],
    }


def document_head(request: CoarseningRequest) -> dict[str, Any]:
    """What ``coarsening.json`` says before it comes to the particles."""
    return {
        "format": "regolith-studio coarsening",
        "version": 1,
        "unit": "um",
        "order": request_document(request),
    }


def request_document(request: CoarseningRequest) -> dict[str, Any]:
    """A request as plain JSON values; the largest error only if it is the stopping criterion."""
    values = asdict(request) | {
        "weights": dict(request.weights),
        "keep": sorted(request.kept),
        "settings": dict(request.settings),
    }
    if request.largest_error is None:
        del values["largest_error"]
    return values


def notes_on(done: Sequence[CoarsenedParticle]) -> list[str]:
    """Why requests are not met, and what users should know of results, one sentence each with the name."""
    results = [(each.name, each.coarsened) for each in done if each.coarsened]
    reasons = [f"{name}: {coarse.reason}" for name, coarse in results if coarse.reason]
    return reasons + [f"{name}: {coarse.warning}" for name, coarse in results if coarse.warning]


def error_table(done: Sequence[CoarsenedParticle]) -> Table:
    """Facets, vertices, triangles and the errors of each particle, with what no polyhedron can do better."""
    symbols = [Column(CATALOGUE[key].symbol, "%") for key in LOSS_KEYS]
    columns = (Column("name"), Column("facets"), Column("vertices"), Column("triangles"), *symbols)
    results = [each.coarsened for each in done if each.coarsened]
    free = any(coarse.free_jaccard_distance is not None for coarse in results)
    rows: list[tuple[Cell, ...]] = [
        (
            each.name,
            coarse.n_facets,
            coarse.n_vertices,
            coarse.n_triangles,
            *[_per_cent(coarse.errors[key], bounds[key]) for key in LOSS_KEYS],
            _per_cent(coarse.jaccard_distance, bounds[JACCARD]),
            *([_when_free(coarse)] if free else []),
        )
        for each in done
        if (coarse := each.coarsened)
        for bounds in (bounds_in_force(coarse.bounds, coarse.errors),)
    ]
    last = [Column("Jaccard", "%"), *([Column("Jaccard, overlap alone", "%")] if free else [])]
    return Table("", (*columns, *last), tuple(rows))


def _when_free(coarse: CoarseningResult) -> str:
    """The Jaccard distance where the overlap alone counts."""
    free = coarse.free_jaccard_distance
    return "" if free is None else f"{100 * free:.2g}"


def _per_cent(error: float, bound: float) -> str:
    """An error with its bound in brackets where there is one; below 1e-6 it counts as none."""
    shown = f"{100 * error:.2g}" if error > EXACT else "0"
    return f"{shown} (>= {100 * bound:.2g})" if bound > EXACT else shown


def coarsening_entry(each: CoarsenedParticle, coarse: CoarseningResult) -> dict[str, Any]:
    """One particle in ``coarsening.json``, without the time that it took."""
    return {
        "name": each.name,
        "file": f"{file_stem(each.name)}.stl",
        "method": coarse.method,
        "n_facets_asked": coarse.n_facets_asked,
        "n_facets": coarse.n_facets,
        "n_vertices": coarse.n_vertices,
        "n_triangles": coarse.n_triangles,
        "errors": dict(coarse.errors),
        "jaccard_distance": coarse.jaccard_distance,
        "loss": coarse.loss,
        "bounds": dict(coarse.bounds),
        "reason": coarse.reason,
        "warning": coarse.warning,
        "free_jaccard_distance": coarse.free_jaccard_distance,
        "target": dict(coarse.target),
        "achieved": dict(coarse.achieved),
        "centre": coarse.centre.tolist(),
        **_planes(each.name, coarse),
        "steps": dict(coarse.steps),
        "variants": {name: dict(errors) for name, errors in coarse.variants.items()},
        "notes": list(each.notes),
    }


def meshes_of(name: str, coarse: CoarseningResult) -> dict[str, Mesh]:
    """Triangles in the particle's own frame by file name: the whole first, then each part of several."""
    solid = coarse.polyhedron
    meshes = {f"{file_stem(name)}.stl": coarse.mesh}
    if isinstance(solid, ConvexCompound):
        for number, part in enumerate(solid.part_meshes, start=1):
            meshes[_part_file(name, number)] = part.moved(shift=coarse.centre)
    return meshes


def _part_file(name: str, number: int) -> str:
    return f"{file_stem(name)}.part{number}.stl"


def _planes(name: str, coarse: CoarseningResult) -> dict[str, Any]:
    """Half-spaces about the particle's centroid; of several parts each about its own origin."""
    solid = coarse.polyhedron
    if not isinstance(solid, ConvexCompound):
        planes = solid.half_spaces
        return {"normals": planes.normals.tolist(), "offsets": planes.offsets.tolist()}
    parts = [
        {
            "file": _part_file(name, number),
            "origin": (place + coarse.centre).tolist(),
            "n_facets": part.n_facets,
            "normals": part.half_spaces.normals.tolist(),
            "offsets": part.half_spaces.offsets.tolist(),
        }
        for number, (part, place) in enumerate(zip(solid.parts, solid.places, strict=True), start=1)
    ]
    return {
        "parts": parts,
        "centroid": (solid.centroid + coarse.centre).tolist(),
        "inertia": solid.inertia.tolist(),
    }
