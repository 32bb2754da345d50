"""Aspherix: particle templates of convex shapes, one for each class and size."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.lifting_cylinder import MICROMETRE
from regolith_studio.dataset.size_distributions import size_classes
from regolith_studio.io.stl import stl_bytes
from regolith_studio.messages import N_

_NOTE = b"""templates.asx: one particle_template for each class and size, its share of the mass behind it as a
comment. Include it in an input script after the materials and hand the templates to an insertion
with those mass fractions. Aspherix is a commercial program: the syntax follows its published
examples, and these files were not run by it. LIGGGHTS-PUBLIC has no convex particles."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    keys = shape_names(dataset)
    files = {
        f"meshes/{key}.stl": stl_bytes(one.convex.mesh.triangles, f"regolith-studio unit-volume {key}")
        for key, one in zip(keys, dataset.representatives, strict=True)
    }
    to_metres = options.coarse_graining_factor * MICROMETRE * (np.pi / 6) ** (1 / 3)
    lines = [f"# convex templates, SI units, coarse-graining factor {options.coarse_graining_factor:g}"]
    weights = dataset.class_weights("volume")
    for key, one, weight in zip(keys, dataset.representatives, weights, strict=True):
        sizes = size_classes(one.sizes)
        for number, (diameter, mass) in enumerate(zip(sizes.diameters, sizes.mass, strict=True)):
            scale = float(diameter * to_metres)
            lines.append(
                f"particle_template id {key}_{number:02d} material regolith shape convex "
                f"file meshes/{key}.stl scale {scale!r}  # mass fraction {float(weight * mass)!r}"
            )
    text = ("\n".join(lines) + "\n").encode("ascii")
    return files | {"templates.asx": text, "sizes.csv": sizes_csv(dataset), NOTES: _NOTE}


EXPORTER = Exporter(
    key="aspherix",
    label="Aspherix (convex templates)",
    units=N_("shapes of volume 1; scales in metres, coarse graining applied"),
    carries=(N_("shapes"), N_("sizes, one template each"), N_("mass fractions (as comments)")),
    loses=(N_("contact parameters"), N_("continuous size distributions: at most 16 sizes a class")),
    load_command="include {folder}/templates.asx",
    files=_files,
)
