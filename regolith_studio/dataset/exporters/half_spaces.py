"""Half-spaces as numbers: the shapes exactly, for any program."""

from typing import Any

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.io.own_files import canonical_json
from regolith_studio.io.tables import csv_bytes
from regolith_studio.messages import N_

_NOTE = b"""All x with <normal, x> <= offset; normals have length 1 and point out; every plane bears a facet.
A compound is the union of its parts: in half_spaces.json they stand in 'parts', in half_spaces.csv the column
part tells them apart. Offsets of a part are negative where the origin of the shape lies outside it.
Floats are written so that they read back bit for bit. sizes.csv: classes, weights, sizes."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    del options
    shapes, rows = [], []
    for index, (key, one) in enumerate(zip(shape_names(dataset), dataset.representatives, strict=True)):
        parts = [
            {"normals": normals.tolist(), "offsets": offsets.tolist()}
            for normals, offsets in one.shape.part_planes
        ]
        planes: dict[str, Any] = {"parts": parts} if isinstance(one.shape, ConvexCompound) else parts[0]
        shapes.append({"key": key, "name": one.name} | planes)
        rows += [
            (index, one.name, number, *normal, offset)
            for number, part in enumerate(parts)
            for normal, offset in zip(part["normals"], part["offsets"], strict=True)
        ]
    text = canonical_json({"format": "half-spaces", "length_unit": "unit volume", "shapes": shapes})
    return {
        "half_spaces.json": text.encode("utf-8"),
        "half_spaces.csv": csv_bytes([("class", "name", "part", "nx", "ny", "nz", "offset"), *rows]),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE,
    }


EXPORTER = Exporter(
    key="half-spaces",
    label="Half-spaces (JSON, CSV)",
    general=True,
    units=N_("shapes of volume 1 without a length unit; diameters in micrometres"),
    carries=(N_("shapes exactly"), N_("class weights by number and mass"), N_("sizes")),
    loses=(N_("provenance of the particles (in dataset.json)"),),
    load_command="python -m json.tool {shell}/half_spaces.json",
    files=_files,
    convex_only="",
)
