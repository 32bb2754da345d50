"""LAMMPS: drawn particles as bodies of the style ``rounded/polyhedron``."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, number_row, sizes_csv
from regolith_studio.dataset.rounded_polyhedra import RoundedPolyhedron, rounded
from regolith_studio.dataset.sampling import PackedParticles, pack_on_lattice
from regolith_studio.errors import DatasetError
from regolith_studio.messages import N_

LINES, WIDTH = 32, 250
"""Most lines of a body, and characters of a line, that LAMMPS reads (MAXBODY and MAXLINE of its sources)."""

_NOTE = """particles.data: units si, atom_style body rounded/polyhedron {fewest} {most}; needs package BODY.
in.particles reads it and drops the particles for a few steps; its stiffness is soft on purpose.
Facets are cut into triangles and stay in their planes: vertices lie inside by the radius, and LAMMPS
rounds with it. Masses and inertia are those of the sharp polyhedra (density x volume); rounding takes
{least:.3g} to {worst:.3g} % of the volume. The pair style is linear and elastic with Coulomb friction, not
Hertz, Mindlin or JKR."""

_INPUT = """# particles of {name}: SI units, coarse-graining factor {factor:g}
units           si
atom_style      body rounded/polyhedron {fewest} {most}
boundary        f f f
comm_modify     vel yes cutoff {cutoff!r}
read_data       particles.data
neighbor        {skin!r} bin
neigh_modify    delay 0 every 1 check yes
pair_style      body/rounded/polyhedron 0.0 0.0 {friction!r} 1.0 {skin!r}
pair_coeff      * * {stiffness!r} {stiffness!r}
timestep        {timestep!r}
fix             motion all nve/body
fix             weight all gravity {gravity} vector 0 0 -1
thermo          10
thermo_style    custom step atoms ke
variable        total equal mass(all)
run             ${{steps}}
print           "total mass $(v_total:%.15g) kg"
"""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    bodies = pack_on_lattice(dataset, options)
    shapes = [rounded(one.convex, options.rounding) for one in dataset.representatives]
    counts = [_room(shape) for shape in shapes]
    lost = [100 * (1 - shape.volume) for shape in shapes]
    bounds = {"fewest": min(shape.core.n_vertices for shape in shapes), "most": max(counts)}
    notes = _NOTE.format(**bounds, least=min(lost), worst=max(lost))
    return {
        "particles.data": _data(dataset, bodies, shapes, options.contact.density).encode("ascii"),
        "in.particles": _input(dataset, bodies, options, bounds).encode("utf-8"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: notes.encode("utf-8"),
    }


def _room(shape: RoundedPolyhedron) -> int:
    """Nmax of the atom style: LAMMPS reserves nine numbers for each vertex and fails where it takes more."""
    core = shape.core
    numbers = 3 * core.n_vertices + 2 * len(shape.edges) + 4 * core.n_triangles
    return max(core.n_vertices, -(-numbers // 9))


def _data(dataset: Dataset, bodies: PackedParticles, shapes: list[RoundedPolyhedron], density: float) -> str:
    reach = float(bodies.scale.max()) * 4
    low, high = bodies.position.min(axis=0) - reach, bodies.position.max(axis=0) + reach
    masses = density * bodies.scale**3
    lines = ["Regolith Studio: bodies rounded/polyhedron, SI units", "", f"{len(bodies)} atoms"]
    lines += [f"{len(bodies)} bodies", "1 atom types", ""]
    lines += [
        f"{number_row(pair)} {axis}lo {axis}hi"
        for axis, pair in zip("xyz", zip(low, high, strict=True), strict=True)
    ]
    lines += ["", "Atoms # body", ""]
    lines += [
        f"{index + 1} 1 1 {float(mass)!r} {number_row(place)}"
        for index, (mass, place) in enumerate(zip(masses, bodies.position, strict=True))
    ]
    lines += ["", "Bodies", ""]
    for index, which in enumerate(bodies.class_index.tolist()):
        inertia = dataset.representatives[which].convex.mesh.inertia
        lines += _body(index, shapes[which], inertia, bodies, masses[index])
    return "\n".join(lines) + "\n"


def _body(
    index: int, shape: RoundedPolyhedron, inertia: np.ndarray, bodies: PackedParticles, mass: float
) -> list[str]:
    """One entry of the section Bodies, turned as the particle is."""
    turn, scale = bodies.rotation_of(index), float(bodies.scale[index])
    tensor = turn @ (inertia * mass * scale**2) @ turn.T
    corners = shape.core.vertices @ turn.T * scale
    edges, faces = shape.edges, shape.core.mesh.faces.tolist()
    size = 6 + 3 * len(corners) + 2 * len(edges) + 4 * len(faces) + 1
    values = [*tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]], *corners.ravel()]
    words = [f"{value:.10g}" for value in values]
    words += [str(end) for edge in edges for end in edge]
    words += [f"{a} {b} {c} -1" for a, b, c in faces]
    lines = _wrapped([*words, f"{2 * shape.radius * scale:.10g}"])
    if len(lines) + 2 > LINES:
        raise DatasetError(
            f"LAMMPS cannot read bodies of {len(corners)} vertices and {len(faces)} triangles: more than "
            f"{LINES} lines of its data files; coarsen to fewer faces."
        )
    return [f"{index + 1} 3 {size}", f"{len(corners)} {len(edges)} {len(faces)}", *lines]


def _wrapped(words: list[str]) -> list[str]:
    """The words on as few lines as LAMMPS' line length allows."""
    lines = [words[0]]
    for word in words[1:]:
        if len(lines[-1]) + 1 + len(word) < WIDTH:
            lines[-1] += " " + word
        else:
            lines.append(word)
    return lines


def _input(dataset: Dataset, bodies: PackedParticles, options: ExportOptions, bounds: dict[str, int]) -> str:
    """A soft stiffness: the weight of the heaviest particle presses a thousandth of its size."""
    size = float(bodies.scale.max())
    mass = options.contact.density * size**3
    stiffness = mass * options.test.gravity / (1e-3 * size)
    return _INPUT.format(
        name=" ".join(dataset.name.split()),
        factor=options.coarse_graining_factor,
        cutoff=6 * size,
        skin=0.1 * size,
        gravity=options.test.gravity,
        friction=options.contact.dynamic_friction,
        stiffness=stiffness,
        timestep=0.01 * float(np.sqrt(options.contact.density * float(bodies.scale.min()) ** 3 / stiffness)),
        **bounds,
    )


EXPORTER = Exporter(
    key="lammps",
    label="LAMMPS (body rounded/polyhedron)",
    units=N_("SI; coarse graining applied"),
    carries=(N_("drawn particles: shape, size, orientation"), N_("mass and inertia"), N_("friction")),
    loses=(
        N_("weights and size distributions: only a sample is drawn (sizes.csv has them)"),
        N_("Hertz, Mindlin-Deresiewicz, JKR: the pair style is linear"),
    ),
    load_command="cd {shell} && lmp -in in.particles -var steps 100",
    files=_files,
    convex_only=N_(
        "A body rounded/polyhedron is one polyhedron; the format multi-sphere can hold compounds."
    ),
    alters=N_("LAMMPS rounds edges; facets stay in their planes, corners are lost."),
)
