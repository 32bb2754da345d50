"""Altair EDEM: one STL a shape, which its polyhedral solver takes as a custom particle shape."""

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.messages import N_

_NOTE = b"""meshes/*.stl are closed, convex, of volume 1, with the centroid at the origin and the principal
axes along x, y and z, where EDEM wants them. In the Creator: Bulk Material, a polyhedral particle, custom
shape, import one file, unit m; no Delaunay meshing, which is for shapes that are not quite convex. The same
files serve as CAD templates of multi-sphere particles (Tools > Options > Particle Display > Import). A
particle of diameter d has the scale d (pi/6)^(1/3); sizes.csv holds diameters in micrometres with their
shares by number and by mass. EDEM is a commercial program and was not run on these files."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    del options
    meshes = {
        f"meshes/{key}.stl": stl_bytes(one.convex.mesh.triangles, f"regolith-studio unit-volume {key}")
        for key, one in zip(shape_names(dataset), dataset.representatives, strict=True)
    }
    return meshes | {"sizes.csv": sizes_csv(dataset), NOTES: _NOTE}


EXPORTER = Exporter(
    key="edem",
    label="EDEM (STL, polyhedral particles)",
    units=N_("shapes of volume 1; diameters in micrometres"),
    carries=(N_("shapes as triangles"), N_("class weights by number and mass, sizes (sizes.csv)")),
    loses=(N_("polygonal facets: they are cut into triangles"), N_("contact parameters")),
    load_command="file {folder}/meshes/{shape}.stl",
    files=_files,
)
