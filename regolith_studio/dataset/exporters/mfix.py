"""MFiX (glued-sphere model): component spheres of each shape, drawn particles, and the phases' keywords."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.multisphere import bare_areas, fit_spheres_by, sphere_fit_errors
from regolith_studio.dataset.sampling import PackedParticles, pack_on_lattice
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.io.tables import csv_bytes
from regolith_studio.messages import N_

_NOTE = """One solids phase a shape. gsp_config.csv: its component spheres, in units of the phase's bounding
diameter; each has the part of the polyhedron's surface that its free part of the union stands for, and no
neighbours, whose areas only the conduction of heat inside a particle needs. particle_input.csv: drawn
particles on a lattice, z up, with bounding diameters in metres (SI, coarse graining applied) and quaternions.
solids.mfx: keywords of the phases, for the project file, with the domain that the particles need.
MFiX adds up overlapping spheres as if none overlapped. So each phase has the density with which its particles
have the polyhedra's mass, and volume fractions that MFiX states are too large by the factor below. Moments of
inertia follow from the spheres. Read back by an independent reader of the published format (MFiX 25.1);
MFiX itself was not run.
{rows}"""

COLUMNS = ("x", "y", "z", "rel_d", "rel_sa", *"wesntb", *(f"{side}_na" for side in "wesntb"), "pid")
PARTICLE_COLUMNS = (
    *("X", "Y", "Z", "phase_id", "diameter", "density", "U", "V", "W", "t_s"),
    *("gsp_q1", "gsp_q2", "gsp_q3", "gsp_q4"),
)
TEMPERATURE = 293.15
"""Of the particles in kelvin; without meaning as long as the energy equation is off."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    particles = pack_on_lattice(dataset, options)
    shapes = [one.shape for one in dataset.representatives]
    fitted = [fit_spheres_by(shape, options.n_spheres, options.max_error) for shape in shapes]
    bounds = np.array([bounding_diameter(spheres) for spheres in fitted])
    summed = np.array([4 / 3 * np.pi * (spheres[:, 3] ** 3).sum() for spheres in fitted])
    volumes = np.array([shape.volume for shape in shapes])
    densities = options.contact.density * volumes / summed
    config, fits = [COLUMNS], []
    for phase, (key, shape, spheres) in enumerate(zip(shape_names(dataset), shapes, fitted, strict=True)):
        config += _component_spheres(shape, spheres, float(bounds[phase]), phase + 1)
        fits.append(
            f"  phase {phase + 1} ({key}): {len(spheres)} spheres, "
            f"Jaccard distance {sphere_fit_errors(shape, spheres).jaccard:.3f}, summed volume "
            f"{summed[phase] / volumes[phase]:.2f} times the polyhedron's, moments of inertia up to "
            f"{100 * _inertia_error(shape, spheres):.1f} % off"
        )
    return {
        "gsp_config.csv": b"#version = 1\n" + csv_bytes(config),
        "particle_input.csv": csv_bytes(_particles(particles, bounds, densities)),
        "solids.mfx": _keywords(dataset, particles, bounds, densities, options).encode("ascii"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE.format(rows="\n".join(fits)).encode("utf-8"),
    }


def bounding_diameter(spheres: FloatArray) -> float:
    """Diameter of the ball about the origin that holds all spheres, rows x, y, z, r."""
    return float(2 * (np.linalg.norm(spheres[:, :3], axis=1) + spheres[:, 3]).max())


def _component_spheres(
    shape: Polyhedron, spheres: FloatArray, bound: float, phase: int
) -> list[tuple[float, ...]]:
    bare = bare_areas(spheres)
    areas = shape.mesh.surface_area * bare / bare.sum() / bound**2
    placed = np.column_stack([spheres[:, :3], 2 * spheres[:, 3]]) / bound
    alone = (-1,) * 6 + (0.0,) * 6
    return [(*row, area, *alone, phase) for row, area in zip(placed.tolist(), areas.tolist(), strict=True)]


def _inertia_error(shape: Polyhedron, spheres: FloatArray) -> float:
    """Largest difference of a moment of inertia as MFiX adds it up, at equal mass, over the largest."""
    mass = spheres[:, 3] ** 3 / (spheres[:, 3] ** 3).sum() * shape.volume
    squares = spheres[:, :3] ** 2
    summed = mass @ (squares.sum(axis=1, keepdims=True) - squares + 0.4 * spheres[:, 3:] ** 2)
    exact = np.diag(shape.mesh.inertia)
    return float(np.abs(summed - exact).max() / exact.max())


def _particles(
    particles: PackedParticles, bounds: FloatArray, densities: FloatArray
) -> list[tuple[object, ...]]:
    which = particles.class_index
    columns = zip(
        particles.position.tolist(),
        (which + 1).tolist(),
        (bounds[which] * particles.scale).tolist(),
        densities[which].tolist(),
        particles.orientation.tolist(),
        strict=True,
    )
    return [
        PARTICLE_COLUMNS,
        *((*place, *rest, 0.0, 0.0, 0.0, TEMPERATURE, *turn) for place, *rest, turn in columns),
    ]


def _keywords(
    dataset: Dataset,
    particles: PackedParticles,
    bounds: FloatArray,
    densities: FloatArray,
    options: ExportOptions,
) -> str:
    contact, phases = options.contact, range(1, len(bounds) + 1)
    medians = [one.sizes.quantile(0.5) * options.to_metres for one in dataset.representatives]
    reach = float((bounds[particles.class_index] * particles.scale).max())
    low, high = particles.position.min(axis=0) - reach, particles.position.max(axis=0) + reach
    pairs = len(bounds) * (len(bounds) + 1) // 2
    lines = [
        "# Phases of the glued-sphere model; kn, kt_fac or Hertzian stiffness are yours to choose",
        *(
            f"# domain at least {axis}: {start!r} to {end!r} m"
            for axis, start, end in zip("xyz", low.tolist(), high.tolist(), strict=True)
        ),
        f"mmax = {len(bounds)}",
        *(f"solids_model({k}) = 'GSP'" for k in phases),
        *(f"d_p0({k}) = {float(bounds[k - 1] * medians[k - 1])!r}" for k in phases),
        *(f"ro_s0({k}) = {float(densities[k - 1])!r}" for k in phases),
        "gener_part_config = .False.",
        f"mew = {contact.static_friction!r}",
        f"mew_w = {options.test.plate_friction!r}",
        *(f"des_en_input({k}) = {contact.restitution!r}" for k in range(1, pairs + 1)),
        *(f"des_en_wall_input({k}) = {contact.restitution!r}" for k in phases),
        "gravity_x = 0.0",
        "gravity_y = 0.0",
        f"gravity_z = {-options.test.gravity!r}",
    ]
    return "\n".join(lines) + "\n"


EXPORTER = Exporter(
    key="mfix",
    label="MFiX (glued spheres)",
    units=N_("spheres in bounding diameters; particles in SI, coarse graining applied"),
    carries=(
        N_("drawn particles: shape approximately, size, orientation"),
        N_("mass"),
        N_("friction, restitution"),
    ),
    loses=(
        N_("weights and size distributions: only a sample is drawn (sizes.csv has them)"),
        N_("flat facets and edges"),
        N_("moments of inertia are sums over the spheres"),
        N_("elastic constants"),
    ),
    load_command="cp {shell}/gsp_config.csv {shell}/particle_input.csv PROJECT",
    files=_files,
    convex_only="",
    alters=N_("overlapping spheres stand for each polyhedron; facets become bumpy, corners round."),
)
