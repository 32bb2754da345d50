"""Shapes as GSD files and HOOMD-blue know them: ``ConvexPolyhedron`` with vertices."""

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.io.own_files import canonical_json
from regolith_studio.messages import N_

_NOTE = b"""type_shapes goes into the GSD chunk particles/type_shapes, types into particles/types:
    frame.particles.types, frame.particles.type_shapes = content["types"], content["type_shapes"]
HOOMD-blue: mc = hoomd.hpmc.integrate.ConvexPolyhedron(); mc.shape[type] = dict(vertices=shape["vertices"]).
moments are principal moments of inertia at density 1 (the axes of each shape are its principal axes).
A type has one size; make one type a size from sizes.csv: multiply vertices by d (pi/6)^(1/3)."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    del options
    shapes = [one.convex for one in dataset.representatives]
    content = {
        "types": shape_names(dataset),
        "names": [one.name for one in dataset.representatives],
        "type_shapes": [
            {"type": "ConvexPolyhedron", "rounding_radius": 0.0, "vertices": shape.vertices.tolist()}
            for shape in shapes
        ],
        "moments": [shape.mesh.inertia.diagonal().tolist() for shape in shapes],
    }
    return {
        "type_shapes.json": canonical_json(content).encode("utf-8"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE,
    }


EXPORTER = Exporter(
    key="hoomd",
    label="GSD, HOOMD-blue (shape JSON)",
    units=N_("shapes of volume 1 without a length unit; diameters in micrometres"),
    carries=(N_("shapes by their vertices"), N_("class weights by number and mass, sizes (sizes.csv)")),
    loses=(N_("facets: they are those of the vertices' hull"), N_("contact parameters")),
    load_command="python -m json.tool {shell}/type_shapes.json",
    files=_files,
    convex_only=N_(
        "GSD has type_shapes of convex polyhedra and of unions of spheres, not of unions of polyhedra."
    ),
)
