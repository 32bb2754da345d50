"""Rockable and exaDEM: sphero-polyhedra with polygonal facets in their eigenframe."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, number_row, shape_names, sizes_csv
from regolith_studio.dataset.rounded_polyhedra import rounded_parts
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.messages import N_

_NOTE = """shapes.shp holds all shapes, of volume 1 before rounding; a particle's homothety is its
scale d (pi/6)^(1/3), and the Minkowski radius scales with it. Facets stay in their planes: vertices lie
inside by the radius. 'volume' is that of the rounded body (Steiner's formula), 'I/m' that of the sharp one.
A compound has the vertices, edges and facets of all its convex parts, also where they lie within another
part, which changes no contact; its 'volume' and 'I/m' are those of the sharp union.
exaDEM admits 8 vertices a particle unless it is compiled for more: these shapes need {most}
(cmake -DEXADEM_MAX_VERTICES={most} or as your version calls it).
Rounding takes {least:.3g} to {worst:.3g} % of the volume. Neither program was run on these files; they are
read back by an independent reader of the published syntax."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    blocks, lost, most = [], [], 0
    for key, one in zip(shape_names(dataset), dataset.representatives, strict=True):
        text, volume, vertices = _block(key, one.shape, options.rounding)
        blocks.append(text)
        lost.append(100 * (1 - volume))
        most = max(most, vertices)
    notes = _NOTE.format(most=most, least=min(lost), worst=max(lost))
    return {
        "shapes.shp": "".join(blocks).encode("ascii"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: notes.encode("utf-8"),
    }


def _block(key: str, shape: Polyhedron, rounding: float) -> tuple[str, float, int]:
    """Text of a shape, its volume (of a compound that of the sharp union), and the number of its vertices."""
    bodies = rounded_parts(shape, rounding)
    first = np.cumsum([0, *(body.core.n_vertices for body, _ in bodies)]).tolist()
    corners = np.concatenate([body.core.vertices + place for body, place in bodies])
    edges = [
        (a + start, b + start) for (body, _), start in zip(bodies, first, strict=False) for a, b in body.edges
    ]
    facets = [
        [corner + start for corner in facet]
        for (body, _), start in zip(bodies, first, strict=False)
        for facet in body.core.facets
    ]
    radius = bodies[0][0].radius
    volume = bodies[0][0].volume if len(bodies) == 1 else shape.volume
    low, high = corners.min(axis=0), corners.max(axis=0)
    lines = ["<", f"name {key}", f"radius {radius!r}", "preCompDone y"]
    lines += [f"nv {len(corners)}", *(number_row(corner) for corner in corners)]
    lines += [f"ne {len(edges)}", *(f"{a} {b}" for a, b in edges)]
    lines += [f"nf {len(facets)}"]
    lines += [" ".join(map(str, (len(facet), *facet))) for facet in facets]
    lines += [
        f"obb.extent {number_row((high - low) / 2 + radius)}",
        "obb.e1 1 0 0",
        "obb.e2 0 1 0",
        "obb.e3 0 0 1",
        f"obb.center {number_row((high + low) / 2)}",
        "position 0 0 0",
        "orientation 1 0 0 0",
        f"volume {volume!r}",
        f"I/m {number_row(shape.mesh.inertia.diagonal())}",
        ">",
        "",
    ]
    return "\n".join(lines), volume, len(corners)


EXPORTER = Exporter(
    key="rockable",
    label="Rockable, exaDEM (.shp)",
    units=N_("shapes of volume 1 (before rounding) without a length unit; diameters in micrometres"),
    carries=(
        N_("polygonal facets, edges, vertices"),
        N_("volume and inertia"),
        N_("weights and sizes (sizes.csv)"),
    ),
    loses=(
        N_("contact parameters"),
        N_("size distributions inside the .shp: give each particle its homothety"),
    ),
    load_command="shapeFile {folder}/shapes.shp",
    files=_files,
    convex_only="",
    alters=N_("both programs need rounded edges; facets stay in their planes, corners are lost."),
)
