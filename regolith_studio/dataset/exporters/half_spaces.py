"""Half-spaces as numbers: the shapes exactly, for any program."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.io.json_text import canonical_json
from regolith_studio.io.tables import csv_bytes
from regolith_studio.messages import N_

_NOTE = b"""All x with <normal, x> <= offset; normals have length 1 and point out; every plane bears a facet.
Floats are written so that they read back bit for bit. sizes.csv: classes, weights, sizes."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    del options
    shapes, rows = [], []
    for index, (key, one) in enumerate(zip(shape_names(dataset), dataset.representatives, strict=True)):
        planes = one.convex.half_spaces
        shapes.append(
            {
                "key": key,
                "name": one.name,
                "normals": planes.normals.tolist(),
                "offsets": planes.offsets.tolist(),
            }
        )
        rows += [
            (index, one.name, *equation)
            for equation in np.column_stack([planes.normals, planes.offsets]).tolist()
        ]
    text = canonical_json({"format": "half-spaces", "length_unit": "unit volume", "shapes": shapes})
    return {
        "half_spaces.json": text.encode("utf-8"),
        "half_spaces.csv": csv_bytes([("class", "name", "nx", "ny", "nz", "offset"), *rows]),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE,
    }


EXPORTER = Exporter(
    key="half-spaces",
    label="Half-spaces (JSON, CSV)",
    units=N_("shapes of volume 1 without a length unit; diameters in micrometres"),
    carries=(N_("shapes exactly"), N_("class weights by number and mass"), N_("sizes")),
    loses=(N_("where the particles come from (dataset.json has it)"),),
    load_command="python -m json.tool {shell}/half_spaces.json",
    files=_files,
)
