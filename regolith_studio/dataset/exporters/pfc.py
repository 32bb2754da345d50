"""PFC3D: geometry sets of the polyhedra, and clump templates of spheres with their mass properties."""

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.multisphere import fit_spheres_by, sphere_fit_errors
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.messages import N_

_NOTE = """templates.dat (PFC 6 and later): "geometry import" reads each polyhedron, exactly, as a geometry
set; "clump template create" makes a template of the same name of its pebbles (spheres), with that set as
its surface description, and with volume and inertia (11 22 33 12 13 23, at density 1 as PFC asks for) of the
polyhedron: overlapping pebbles do not count twice. All shapes have volume 1 and lie in their principal axes;
a clump of equivalent diameter d, of sizes.csv, has the volume (pi/6) d^3. Read back by an independent reader
of the documented syntax; PFC itself, a commercial program, was not run. The pebbles miss each polyhedron by
(Jaccard distance):
{rows}"""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    files, fits = {}, []
    lines = ["; regolith-studio: shapes of volume 1, for PFC3D"]
    for key, one in zip(shape_names(dataset), dataset.representatives, strict=True):
        spheres = fit_spheres_by(one.shape, options.n_spheres, options.max_error)
        fits.append(f"  {key}: {len(spheres)} pebbles, {sphere_fit_errors(one.shape, spheres).jaccard:.3f}")
        triangles = one.shape.mesh.triangles
        files[f"meshes/{key}.stl"] = stl_bytes(triangles, f"regolith-studio unit-volume {key}")
        lines += _template(key, one.shape, spheres)
    return files | {
        "templates.dat": ("\n".join(lines) + "\n").encode("ascii"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE.format(rows="\n".join(fits)).encode("utf-8"),
    }


def _template(key: str, shape: Polyhedron, spheres: FloatArray) -> list[str]:
    """Commands of one shape; ``...`` continues a line."""
    pebbles = [f"        {r!r} {x!r} {y!r} {z!r} ..." for x, y, z, r in spheres.tolist()]
    moments = " ".join(map(repr, shape.mesh.inertia.diagonal().tolist()))
    return [
        f"geometry import 'meshes/{key}.stl' format stl set '{key}'",
        "clump template create ...",
        f"    name '{key}' ...",
        f"    geometry '{key}' ...",
        f"    pebbles {len(spheres)} ...",
        *pebbles,
        f"    volume {shape.volume!r} ...",
        f"    inertia {moments} 0 0 0 ...",
        "    position 0 0 0",
    ]


EXPORTER = Exporter(
    key="pfc",
    label="PFC3D (geometry, clump templates)",
    units=N_("shapes of volume 1 without a length unit; diameters in micrometres"),
    carries=(
        N_("shapes exactly, as geometry sets"),
        N_("shapes approximately, as pebbles"),
        N_("volume and inertia"),
        N_("class weights by number and mass, sizes (sizes.csv)"),
    ),
    loses=(N_("flat facets and edges of the clumps"), N_("contact parameters")),
    load_command="program call '{folder}/templates.dat'",
    files=_files,
    convex_only="",
    alters=N_("overlapping spheres stand for each polyhedron; facets become bumpy, corners round."),
)
