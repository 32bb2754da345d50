"""YADE: a script that drops drawn polyhedra into a cylinder and lifts it."""

from dataclasses import replace

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
from regolith_studio.dataset.sampling import PackedParticles, fitted_cylinder, pack_on_lattice, sample_dataset
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.own_files import canonical_json
from regolith_studio.io.tables import csv_bytes
from regolith_studio.messages import N_
from regolith_studio.resources import resource

OVERLAP = 1e-2
"""Share of its volume by which the largest particle overlaps another under the weight of all."""

MIN_DIAMETER = 2.5e-6
"""In metres. YADE takes lengths below 3e-10 m as none, a share of 1e-4 here."""

PART_MASS = 0.01
"""Share of a compound's mass that its parts have in YADE."""

_NOTE = """yade_case.py builds the case from case.json and particles.csv: {n} drawn particles above each
other in the tube, a plate, gravity, and the lift of the tube. The tube is {wide:.3g} mm wide: smaller than
asked for where so few particles would only cover its ground, so that they fill it as high for its width as in
the paper; it is longer while it holds them above each other.
YADE takes the convex hull of each shape's vertices, and finds volume and moments of inertia by itself. The
script builds each shape in its principal axes and then sets position and orientation, since YADE turns a body
into its principal axes only above some 6 mm.
A compound is a clump of its convex parts with mass, centre and inertia of the union: its parts weigh a
hundredth, and six points that touch nothing the rest, since YADE adds up the members of a clump as if none
overlapped, and turns their moments the wrong way.
Measured with YADE 2023.02a of Debian: volumes, masses and principal moments agree with the dataset to 1e-9.
Its law for polyhedra is volumetric (force by overlapping volume, no JKR): an angle of
repose from it is qualitative. The stiffness is chosen so that the largest particle overlaps another
by a hundredth of its volume under the weight of all; the time step follows from it: a fifth of the time in
which the smallest particle, pressed by its whole face, would swing. Run it on one thread (yade -j1): YADE's
law for polyhedra keeps one shear force for all contacts, which several threads would write at once; so
friction acts while particles slide and has no memory at rest. It costs some 0.1 ms for two particles in
contact and a step."""

COLUMNS = ("class", "scale", "diameter_m", "x", "y", "z", "qw", "qx", "qy", "qz")


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    _check_size(dataset, options)
    options = replace(options, test=fitted_cylinder(dataset, options))
    bodies = pack_on_lattice(dataset, options, within=options.test.diameter)
    return {
        "yade_case.py": resource("exports", "yade_case.py").read_bytes(),
        "case.json": canonical_json(_case(dataset, options, bodies)).encode("utf-8"),
        "particles.csv": csv_bytes([COLUMNS, *_rows(bodies)]),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE.format(n=len(bodies), wide=options.test.diameter * 1e3).encode("utf-8"),
    }


def _check_size(dataset: Dataset, options: ExportOptions) -> None:
    drawn = sample_dataset(dataset, options.n_particles, options.seed).diameter
    needed = round(MIN_DIAMETER / (float(drawn.min()) * MICROMETRE), 6)
    if options.coarse_graining_factor < needed:
        size = float(drawn.min()) * options.coarse_graining_factor
        raise DatasetError(
            f"YADE cannot hold particles of {size:.3g} um, since it takes lengths below 0.0003 um as none; "
            f"a coarse-graining factor of {np.ceil(needed):g} would do."
        )


def _rows(bodies: PackedParticles) -> list[tuple[object, ...]]:
    table = np.column_stack([bodies.scale, bodies.diameter, bodies.position, bodies.orientation])
    return [(which, *row) for which, row in zip(bodies.class_index.tolist(), table.tolist(), strict=True)]


def _case(dataset: Dataset, options: ExportOptions, bodies: PackedParticles) -> dict[str, object]:
    masses = options.contact.density * bodies.scale**3
    largest, smallest = float(bodies.scale.max()), float(bodies.scale.min())
    stiffness = float(masses.sum()) * options.test.gravity / (OVERLAP * largest**3)
    top = float(bodies.position[:, 2].max()) + 2 * largest
    time_step = 0.2 * np.sqrt(options.contact.density * smallest / stiffness)
    return case_settings(options) | {
        "length_unit": "m",
        "volumetric_stiffness": stiffness,
        "time_step": float(time_step),
        "damping": 0.4,
        "duration": options.times.duration(options.test),
        "largest_diameter": float(bodies.diameter.max()),
        "tube_stretch": max(1.0, top / options.test.height),
        "shapes": [
            {"key": key, "name": one.name, **_members(one.shape)}
            for key, one in zip(shape_names(dataset), dataset.representatives, strict=True)
        ],
    }


def _members(shape: Polyhedron) -> dict[str, object]:
    """Vertices of the convex parts; of a compound also what makes the sums over a clump those of the union.

    YADE adds up mass, centre and inertia of the members of a clump as if none overlapped, and turns moments
    of members the wrong way. So the parts get :data:`PART_MASS` of the mass and no moments about their own
    centres, and six points the rest: pairs at the same distance on both sides of their centre, along the
    principal axes of the second moments that are missing.
    """
    parts = shape.part_meshes
    members: dict[str, object] = {"parts": [part.vertices.tolist() for part in parts]}
    if len(parts) == 1:
        return members
    volumes = np.array([part.volume for part in parts])
    shares = PART_MASS * volumes / volumes.sum()
    centres = np.array([part.centroid for part in parts])
    centre, second = shares @ centres, (centres.T * shares) @ centres
    rest = 1.0 - PART_MASS
    middle = (shape.centroid - centre) / rest
    missing = _second_moments(shape.mesh) - second - rest * np.outer(middle, middle)
    squares, axes = np.linalg.eigh(missing)
    # A pair of points of rest / 6 each adds rest / 3 times the square of its distance.
    reach = np.sqrt(squares / (rest / 3)) * axes
    points = [[*(middle + side * arm).tolist(), rest / 6] for arm in reach.T for side in (-1.0, 1.0)]
    return members | {"mass_shares": shares.tolist(), "points": points}


def _second_moments(mesh: Mesh) -> FloatArray:
    """Mean of x x^T over a solid about the origin, shape (3, 3)."""
    about = np.trace(mesh.inertia) / 2 * np.eye(3) - mesh.inertia
    return np.asarray(about / mesh.volume + np.outer(mesh.centroid, mesh.centroid))


EXPORTER = Exporter(
    key="yade",
    label="YADE (script)",
    units=N_("SI; coarse graining applied"),
    carries=(N_("drawn particles: shape, size, orientation"), N_("friction"), N_("lifting cylinder")),
    loses=(
        N_("weights and size distributions: only a sample is drawn (sizes.csv has them)"),
        N_("Hertz, Mindlin-Deresiewicz, JKR, restitution: the law is volumetric"),
    ),
    load_command="yade -j1 {shell}/yade_case.py",
    files=_files,
    convex_only="",
)
