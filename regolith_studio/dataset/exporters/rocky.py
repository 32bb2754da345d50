"""ANSYS Rocky: a script for its scripting interface that builds the lifting-cylinder case of section 2.6."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import (
    MICROMETRE,
    NOTES,
    Exporter,
    ExportOptions,
    case_settings,
    shape_names,
    sizes_csv,
)
from regolith_studio.dataset.lifting_cylinder import box_mesh, particle_count, tube_mesh
from regolith_studio.dataset.size_distributions import size_classes
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.io.own_files import canonical_json
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.messages import N_
from regolith_studio.resources import resource

_NOTE = """rocky_case.py reads case.json and builds the case: materials, damped Hertzian and
Mindlin-Deresiewicz contacts, JKR, coarse graining, one particle input a shape, a tube
that is lifted off a plate. About {count:,.0f} particles of {mass:.4g} g in all, coarse graining {factor:g}.
Rocky counts sizes by mass: the percentages in case.json are cumulative mass percentages, converted
from the dataset's, and each shape is filled in with its share of the mass. Sizes are equivalent diameters,
so that the STL files need no unit. Of compounds the surface of the union is imported as a concave particle.
Restitution, wall friction and lifting speed are not given in the paper.
When it has been simulated, rocky_positions.py writes the particles' positions for the measurement of the
angle of repose.
Method names are those of the interface's public reference for 2024 R2 to 2026 R1; the script is tested
against a recorder that knows these names, not against the licensed program. Compare one shape by
GetExportToolkit().ExportParticleToStl before you trust a long run."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    keys = shape_names(dataset)
    meshes = {
        f"meshes/{key}.stl": stl_bytes(one.shape.mesh.triangles, f"regolith-studio unit-volume {key}")
        for key, one in zip(keys, dataset.representatives, strict=True)
    }
    test, factor = options.test, options.coarse_graining_factor
    count = particle_count(dataset, test.mass, options.contact.density, factor)
    notes = _NOTE.format(count=count, mass=test.mass * 1e3, factor=factor)
    return meshes | {
        "rocky_case.py": resource("exports", "rocky_case.py").read_bytes(),
        "rocky_positions.py": resource("exports", "rocky_positions.py").read_bytes(),
        "case.json": canonical_json(_case(dataset, options, keys)).encode("utf-8"),
        "walls/tube.stl": stl_bytes(
            tube_mesh(test.diameter, test.height).triangles, "regolith-studio tube, metres"
        ),
        "walls/plate.stl": stl_bytes(box_mesh(_plate(options)).triangles, "regolith-studio plate, metres"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: notes.encode("utf-8"),
    }


def _case(dataset: Dataset, options: ExportOptions, keys: list[str]) -> dict[str, object]:
    test = options.test
    shares = dataset.class_weights("volume")
    particles = []
    for key, one, share in zip(keys, dataset.representatives, shares, strict=True):
        sizes = size_classes(one.sizes)
        percent = 100 * np.cumsum(sizes.mass)
        percent[-1] = 100.0
        rows = np.column_stack([sizes.diameters * MICROMETRE, percent])[::-1]
        particles.append(
            {
                "key": key,
                "name": one.name,
                "mesh": f"meshes/{key}.stl",
                "concave": isinstance(one.shape, ConvexCompound),
                "mass": float(share * test.mass),
                "sizes": rows.tolist(),
            }
        )
    # The largest square within the tube.
    inner = test.diameter / np.sqrt(2.0)
    reach = 3 * test.diameter
    return case_settings(options) | {
        "project": "lifting_cylinder.rocky",
        "length_unit": "m",
        "duration": options.times.duration(test),
        "particles": particles,
        "filling_box": {
            "seed": [0.0, 0.0, test.height / 2],
            "center": [0.0, 0.0, test.height / 2],
            "dimensions": [inner, inner, 0.98 * test.height],
        },
        "domain": [[-reach, -reach, -0.1 * test.height], [reach, reach, 2.2 * test.height]],
    }


def _plate(options: ExportOptions) -> np.ndarray:
    reach = 3 * options.test.diameter
    return np.array([[-reach, -reach, -0.05 * options.test.height], [reach, reach, 0.0]])


EXPORTER = Exporter(
    key="rocky",
    label="ANSYS Rocky (script)",
    units=N_(
        "SI; sizes are equivalent diameters in metres before coarse graining, which Rocky applies itself"
    ),
    carries=(
        N_("shapes"),
        N_("class weights as shares of the mass"),
        N_("sizes as cumulative percentages by mass"),
        N_("contact parameters: damped Hertzian, Mindlin-Deresiewicz, JKR"),
        N_("coarse graining, lifting cylinder"),
    ),
    loses=(N_("continuous size distributions: at most 16 sizes per shape"), N_("rolling resistance")),
    load_command="python {shell}/rocky_case.py",
    files=_files,
    convex_only="",
    fills_mass=True,
)
