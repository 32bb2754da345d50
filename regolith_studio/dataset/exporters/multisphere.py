"""Overlapping spheres: for programs that know nothing but spheres. Approximate."""

from dataclasses import astuple

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.multisphere import fit_spheres_by, sphere_fit_errors
from regolith_studio.io.tables import csv_bytes
from regolith_studio.messages import N_

_NOTE = """One file a shape, a line a sphere: x y z r, in the frame of the shape (volume 1, centroid at the
origin). The spheres overlap, and stand out of the polyhedron a little where they fall short elsewhere, so
that their union has its volume. The mismatch is Jaccard's distance, 1 minus the shared volume over that of
both together:
{rows}
Programs that take the mass of the union get the right one. Programs that add up overlapping spheres do not:
set mass and inertia by hand there (density x scale^3, moments in fit.csv).
A particle of diameter d has every number times d (pi/6)^(1/3). fit.csv: spheres, volume of the union, moments
of inertia of the polyhedron (density 1), and the errors of the union as shares (its moments of inertia at
equal mass, the largest difference)."""

HEADER = (
    *("shape", "spheres", "union_volume", "moment_x", "moment_y", "moment_z"),
    *("volume_error", "area_error", "inertia_error", "jaccard_distance"),
)


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    files, rows, fits = {}, [], []
    for key, one in zip(shape_names(dataset), dataset.representatives, strict=True):
        spheres = fit_spheres_by(one.shape, options.n_spheres, options.max_error)
        errors = sphere_fit_errors(one.shape, spheres)
        text = "".join(" ".join(map(repr, row)) + "\n" for row in spheres.tolist())
        files[f"spheres/{key}.txt"] = text.encode("ascii")
        moments = np.diag(one.shape.mesh.inertia).tolist()
        volume = one.shape.volume * (1 + errors.volume)
        rows.append((key, len(spheres), volume, *moments, *astuple(errors)))
        fits.append(
            f"  {key}: {len(spheres)} spheres, mismatch {errors.jaccard:.3f}, "
            f"volume {100 * errors.volume:+.2f} %, area {100 * errors.area:+.1f} %, "
            f"moments of inertia up to {100 * errors.inertia:.2f} % off"
        )
    return files | {
        "fit.csv": csv_bytes([HEADER, *rows]),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE.format(rows="\n".join(fits)).encode("utf-8"),
    }


EXPORTER = Exporter(
    key="multi-sphere",
    label="Multi-sphere (x y z r)",
    units=N_("spheres in the frame of a shape of volume 1; diameters in micrometres"),
    carries=(
        N_("shapes approximately"),
        N_("weights and sizes (sizes.csv)"),
        N_("true moments of inertia (fit.csv)"),
    ),
    loses=(N_("flat facets and edges"), N_("contact parameters")),
    load_command="file {folder}/spheres/{shape}.txt",
    files=_files,
    convex_only="",
    alters=N_("overlapping spheres stand for each polyhedron; facets become bumpy, corners round."),
)
