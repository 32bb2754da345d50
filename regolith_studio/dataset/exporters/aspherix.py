"""Aspherix: particle templates of convex shapes or unions of convex bodies, one for each class and size."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.size_distributions import size_classes
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.messages import N_

_NOTE = b"""templates.asx: one particle_template for each class and size, its share of the mass behind it as a
comment. Include it in an input script after the materials and hand the templates to an insertion
with those mass fractions. Aspherix is a commercial program: the syntax follows its published
reference, and these files were not run by it. LIGGGHTS-PUBLIC has no convex particles.
A compound is a concave particle of several convex_body commands, as concave_decomposition would write them:
its parts are exact, so that nothing needs to be decomposed. Their STL files are in metres, for each size.
Masses add up to that of the union, in proportion to the parts' volumes, and the centres of mass are moved
together so that their mean is the union's centre; the template's moment_of_inertia is that of the union."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    files: dict[str, bytes] = {}
    lines = [f"# particle templates, SI units, coarse-graining factor {options.coarse_graining_factor:g}"]
    weights = dataset.class_weights("volume")
    for key, one, weight in zip(shape_names(dataset), dataset.representatives, weights, strict=True):
        if not isinstance(one.shape, ConvexCompound):
            header = f"regolith-studio unit-volume {key}"
            files[f"meshes/{key}.stl"] = stl_bytes(one.shape.mesh.triangles, header)
        sizes = size_classes(one.sizes)
        for number, (diameter, mass) in enumerate(zip(sizes.diameters, sizes.mass, strict=True)):
            scale, name = float(diameter * options.to_metres), f"{key}_{number:02d}"
            if isinstance(one.shape, ConvexCompound):
                bodies, form = _bodies(one.shape, name, scale, options.contact.density)
                lines += bodies
                files |= _part_files(one.shape, name, scale)
            else:
                form = f"shape convex file meshes/{key}.stl scale {scale!r}"
            fraction = float(weight * mass)
            lines.append(
                f"particle_template id {name} material regolith {form}  # mass fraction {fraction!r}"
            )
    text = ("\n".join(lines) + "\n").encode("ascii")
    return files | {"templates.asx": text, "sizes.csv": sizes_csv(dataset), NOTES: _NOTE}


def _part_files(shape: ConvexCompound, name: str, scale: float) -> dict[str, bytes]:
    """STL files of the parts in metres."""
    return {
        f"meshes/{body}.stl": stl_bytes(part.triangles * scale, f"regolith-studio {body}, metres")
        for body, part in zip(_body_names(shape, name), shape.part_meshes, strict=True)
    }


def _bodies(shape: ConvexCompound, name: str, scale: float, density: float) -> tuple[list[str], str]:
    """Commands for the convex bodies, and the form of the template that unites them."""
    volumes = np.array([part.volume for part in shape.part_meshes])
    centres = np.array([part.centroid for part in shape.part_meshes])
    shares = volumes / volumes.sum()
    centres += shape.centroid - shares @ centres
    names = _body_names(shape, name)
    lines = [
        f"convex_body id {body} file meshes/{body}.stl mass {float(share * density * scale**3)!r} "
        f"center_of_mass {_vector(centre * scale)}"
        for body, share, centre in zip(names, shares, centres, strict=True)
    ]
    inertia = shape.inertia * density * scale**5
    principal, mixed = inertia.diagonal(), inertia[[1, 0, 1], [0, 2, 2]]
    moments = f"moment_of_inertia principal {_vector(principal)} off_diagonal {_vector(mixed)}"
    return lines, f"shape concave convex_bodies {{{','.join(names)}}} {moments}"


def _body_names(shape: ConvexCompound, name: str) -> list[str]:
    return [f"{name}_part{number}" for number in range(1, shape.n_parts + 1)]


def _vector(values: FloatArray) -> str:
    return f"({','.join(map(repr, values.tolist()))})"


EXPORTER = Exporter(
    key="aspherix",
    label="Aspherix (convex templates)",
    units=N_("shapes of volume 1; scales in metres, coarse graining applied"),
    carries=(N_("shapes"), N_("sizes, one template each"), N_("mass fractions (as comments)")),
    loses=(N_("contact parameters"), N_("continuous size distributions: at most 16 sizes per class")),
    load_command="include {folder}/templates.asx",
    files=_files,
    convex_only="",
)
