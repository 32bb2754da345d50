"""LIGGGHTS-PUBLIC: multi-sphere templates with mass and inertia of the polyhedra, and their distribution."""

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.multisphere import fit_spheres_by, sphere_fit_errors
from regolith_studio.dataset.size_distributions import size_classes
from regolith_studio.messages import N_

SEED = 32452843
"""Of the templates and of the distribution: a prime above 10,000, as LIGGGHTS asks for."""
N_TRIES = 1_000_000
"""Points of the Monte Carlo integration that LIGGGHTS makes of every template."""

_NOTE = """templates.in: one fix particletemplate/multisphere for each class and size, and a fix
particledistribution/discrete that draws them by mass; include it after the materials of atom type 1, and
hand the distribution (pdd) to an insertion, together with a fix multisphere. mass and inertia_tensor are
those of the polyhedron in SI units, so that the overlap of the spheres does not count twice; the axes of
each sphere file are the principal axes of the polyhedron. Read back by an independent reader of the
documented syntax; LIGGGHTS itself was not run. The spheres miss each polyhedron by (Jaccard distance):
{rows}"""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    files, fits = {}, []
    templates: list[tuple[str, float]] = []
    lines = [f"# multi-sphere templates, SI units, coarse-graining factor {options.coarse_graining_factor:g}"]
    by_mass = dataset.class_weights("volume")
    for key, one, weight in zip(shape_names(dataset), dataset.representatives, by_mass, strict=True):
        spheres = fit_spheres_by(one.shape, options.n_spheres, options.max_error)
        name = f"spheres/{key}.txt"
        files[name] = "".join(" ".join(map(repr, row)) + "\n" for row in spheres.tolist()).encode("ascii")
        fits.append(f"  {key}: {len(spheres)} spheres, {sphere_fit_errors(one.shape, spheres).jaccard:.3f}")
        moments = one.shape.mesh.inertia.diagonal()
        sizes = size_classes(one.sizes)
        for number, (diameter, share) in enumerate(zip(sizes.diameters, sizes.mass, strict=True)):
            scale = float(diameter * options.to_metres)
            fix = f"pts_{key}_{number:02d}"
            templates.append((fix, float(weight * share)))
            lines.append(
                f"fix {fix} all particletemplate/multisphere {SEED} atom_type 1 "
                f"density constant {options.contact.density!r} nspheres {len(spheres)} ntry {N_TRIES} "
                f"spheres file {name} scale {scale!r} type {len(templates)} "
                + _mass_and_inertia(options.contact.density, scale, moments.tolist())
            )
    shares = " ".join(f"{fix} {share!r}" for fix, share in templates)
    lines.append(f"fix pdd all particledistribution/discrete {SEED} {len(templates)} {shares}")
    return files | {
        "templates.in": ("\n".join(lines) + "\n").encode("ascii"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE.format(rows="\n".join(fits)).encode("utf-8"),
    }


def _mass_and_inertia(density: float, scale: float, moments: list[float]) -> str:
    """Of a polyhedron of volume ``scale**3`` whose shape of volume 1 has these principal moments."""
    x, y, z = (density * scale**5 * moment for moment in moments)
    return f"mass {density * scale**3!r} inertia_tensor {x!r} 0 0 {y!r} 0 {z!r} use_density"


EXPORTER = Exporter(
    key="liggghts",
    label="LIGGGHTS (multi-sphere templates)",
    units=N_("spheres of shapes of volume 1; scales, masses and moments in SI, coarse graining applied"),
    carries=(
        N_("shapes approximately"),
        N_("mass and inertia"),
        N_("sizes, one template each, by mass"),
        N_("density"),
    ),
    loses=(
        N_("flat facets and edges"),
        N_("elastic constants and friction: they belong to the materials of the input script"),
        N_("continuous size distributions: at most 16 sizes per class"),
    ),
    load_command="include {folder}/templates.in",
    files=_files,
    convex_only="",
    alters=N_("overlapping spheres stand for each polyhedron; facets become bumpy, corners round."),
)
