"""Project Chrono and its DEM-Engine: triangle meshes as OBJ, mass properties and sizes as JSON."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.size_distributions import size_classes
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.own_files import canonical_json
from regolith_studio.messages import N_

_NOTE = b"""meshes/*.obj are closed, outward, of volume 1, centroid at the origin, principal axes x, y, z.
A particle of scale s (particles.json, metres) at density rho has mass rho s^3 and principal moments
rho s^5 moments. DEM-Engine: mesh = solver.LoadMeshType("meshes/SHAPE.obj", material);
mesh.SetMass(..), mesh.SetMOI(..), mesh.Scale(s). Chrono: ChTriangleMeshConnected::CreateFromWavefrontFile.
Of a compound the mesh is the surface of the union, volume and moments are those of the union, and 'parts'
names a mesh for each convex part in the same frame, for collision shapes of Chrono that are convex hulls.
The OBJ files are read back by an independent reader in this program's tests; Chrono itself was not run."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    keys = shape_names(dataset)
    files = {}
    records = []
    for index, (key, one) in enumerate(zip(keys, dataset.representatives, strict=True)):
        sizes = size_classes(one.sizes)
        files[f"meshes/{key}.obj"] = _obj(key, one.shape.mesh)
        parts = one.shape.part_meshes if isinstance(one.shape, ConvexCompound) else ()
        names = [f"meshes/{key}.part{number}.obj" for number in range(1, len(parts) + 1)]
        files |= {name: _obj(key, part) for name, part in zip(names, parts, strict=True)}
        records.append(
            {
                "key": key,
                "name": one.name,
                "mesh": f"meshes/{key}.obj",
                "parts": names,
                "volume": one.shape.volume,
                "moments": one.shape.mesh.inertia.diagonal().tolist(),
                "circumscribed_radius": float(np.linalg.norm(one.shape.vertices, axis=1).max()),
                "weight_number": float(dataset.class_weights("number")[index]),
                "scales_m": (sizes.diameters * options.to_metres).tolist(),
                "scale_number_shares": sizes.number.tolist(),
            }
        )
    contact = options.contact
    content = {
        "length_unit": "m",
        "coarse_graining_factor": options.coarse_graining_factor,
        "material": {
            "density_kg_m3": contact.density,
            "E_Pa": contact.youngs_modulus,
            "nu": contact.poissons_ratio,
            "CoR": contact.restitution,
            "mu": contact.dynamic_friction,
            "Crr": contact.rolling_friction,
        },
        "shapes": records,
    }
    tables = {"particles.json": canonical_json(content).encode("utf-8"), "sizes.csv": sizes_csv(dataset)}
    return files | tables | {NOTES: _NOTE}


def _obj(key: str, mesh: Mesh) -> bytes:
    """Triangles, so that every reader takes them; indices from 1."""
    lines = ["# regolith-studio, in the frame of a shape of volume 1", f"o {key}"]
    lines += ["v " + " ".join(map(repr, corner)) for corner in mesh.vertices.tolist()]
    lines += ["f " + " ".join(str(index + 1) for index in face) for face in mesh.faces.tolist()]
    return ("\n".join(lines) + "\n").encode("ascii")


EXPORTER = Exporter(
    key="chrono",
    label="Chrono, DEM-Engine (OBJ, JSON)",
    units=N_("shapes of volume 1; scales in metres, coarse graining applied; SI material"),
    carries=(
        N_("shapes as triangles"),
        N_("mass and inertia"),
        N_("class weights, sizes"),
        N_("elastic constants, friction"),
    ),
    loses=(N_("polygonal facets: they are cut into triangles"), N_("surface energy (JKR)")),
    load_command='solver.LoadMeshType("{folder}/meshes/{shape}.obj", material)',
    files=_files,
    convex_only="",
)
