"""LAMMPS: drawn particles as rigid clumps of overlapping spheres with the mass and inertia of the shapes."""

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, number_row, shape_names, sizes_csv
from regolith_studio.dataset.multisphere import fit_spheres_by, sphere_fit_errors
from regolith_studio.dataset.sampling import PackedParticles, pack_on_lattice
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_

_NOTE = """particles.data: spheres with the number of their clump, atom_style hybrid sphere bond; needs the
packages GRANULAR, RIGID and MOLECULE. bodies.txt gives each clump mass, centre and inertia of its shape (of a
compound those of the union) in place of those of overlapping spheres: fix rigid/small ... infile.
in.particles drops the particles for a few steps; its contacts are Hertz and Mindlin, with a modulus that is
soft on purpose.
The mismatch is Jaccard's distance, 1 minus the shared volume over that of both together:
{rows}"""

_INPUT = """# particles of {name}: SI units, coarse-graining factor {factor:g}
units           si
atom_style      hybrid sphere bond
boundary        f f f
newton          off
comm_modify     vel yes cutoff {cutoff!r}
read_data       particles.data
neighbor        {skin!r} bin
neigh_modify    delay 0 every 1 check yes exclude molecule/intra all
pair_style      granular
pair_coeff      * * hertz/material {modulus!r} {restitution!r} {poisson!r} &
                tangential mindlin_rescale NULL 1.0 {friction!r} damping tsuji
timestep        {timestep!r}
fix             down all gravity {gravity!r} vector 0 0 -1
fix             clumps all rigid/small molecule infile bodies.txt gravity down
fix             plate all wall/gran granular hertz/material {modulus!r} {restitution!r} {poisson!r} &
                tangential mindlin_rescale NULL 1.0 {plate!r} damping tsuji zplane 0 NULL
compute         place all rigid/local clumps mol x y z mass inertiax inertiay inertiaz
dump            place all local {every} body.*.dump c_place[*]
dump_modify     place format float %.15g
compute         motion all ke/rigid clumps
thermo          {every}
thermo_style    custom step c_motion
thermo_modify   norm no
run             ${{steps}}
"""

SOFTNESS = 2e4
"""Young's modulus over density, gravity and mean diameter."""
STEP = 0.15
"""Of Rayleigh's time of the smallest sphere."""
EVERY = 1000


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    bodies = pack_on_lattice(dataset, options)
    clumps, fits = [], []
    for key, one in zip(shape_names(dataset), dataset.representatives, strict=True):
        # LAMMPS knows no rigid body of one sphere.
        clumps.append(fit_spheres_by(one.shape, max(2, options.n_spheres), options.max_error))
        error = sphere_fit_errors(one.shape, clumps[-1]).jaccard
        fits.append(f"  {key}: {len(clumps[-1])} spheres, mismatch {error:.3f}")
    return {
        "particles.data": _data(bodies, clumps).encode("ascii"),
        "bodies.txt": _bodies(dataset, bodies, options.contact.density).encode("ascii"),
        "in.particles": _input(dataset, bodies, clumps, options).encode("utf-8"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE.format(rows="\n".join(fits)).encode("utf-8"),
    }


def _data(bodies: PackedParticles, clumps: list[FloatArray]) -> str:
    reach = 4 * float(bodies.scale.max())
    low, high = bodies.position.min(axis=0) - reach, bodies.position.max(axis=0) + reach
    low[2] = min(float(low[2]), -reach)
    atoms: list[str] = []
    for index, which in enumerate(bodies.class_index.tolist()):
        scale, turn = float(bodies.scale[index]), bodies.rotation_of(index)
        places = bodies.position[index] + clumps[which][:, :3] @ turn.T * scale
        for place, radius in zip(places.tolist(), (clumps[which][:, 3] * scale).tolist(), strict=True):
            atoms.append(f"{len(atoms) + 1} 1 {number_row(place)} {2 * radius!r} 1.0 {index + 1}")
    lines = ["Regolith Studio: clumps of spheres, SI units", "", f"{len(atoms)} atoms", "1 atom types", ""]
    lines += [f"{number_row([low[k], high[k]])} {axis}lo {axis}hi" for k, axis in enumerate("xyz")]
    return "\n".join([*lines, "", "Atoms # hybrid sphere bond", "", *atoms, ""])


def _bodies(dataset: Dataset, bodies: PackedParticles, density: float) -> str:
    """Mass, centre, inertia and no motion of each clump: the file of fix rigid/small."""
    lines = [str(len(bodies))]
    for index, which in enumerate(bodies.class_index.tolist()):
        turn, scale = bodies.rotation_of(index), float(bodies.scale[index])
        tensor = turn @ dataset.representatives[which].shape.mesh.inertia @ turn.T * density * scale**5
        entries = tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        values = [density * scale**3, *bodies.position[index].tolist(), *entries.tolist()]
        lines.append(f"{index + 1} {number_row(values)} 0 0 0 0 0 0 0 0 0")
    return "\n".join([*lines, ""])


def _input(
    dataset: Dataset, bodies: PackedParticles, clumps: list[FloatArray], options: ExportOptions
) -> str:
    contact, size = options.contact, float(bodies.scale.max())
    modulus = SOFTNESS * contact.density * options.test.gravity * float(bodies.diameter.mean())
    smallest = min(float(clump[:, 3].min()) for clump in clumps) * float(bodies.scale.min())
    shear = modulus / (2 * (1 + contact.poissons_ratio))
    rayleigh = (
        np.pi * smallest * np.sqrt(contact.density / shear) / (0.1631 * contact.poissons_ratio + 0.8766)
    )
    return _INPUT.format(
        name=" ".join(dataset.name.split()),
        factor=options.coarse_graining_factor,
        cutoff=6 * size,
        skin=0.1 * size,
        modulus=modulus,
        restitution=min(max(contact.restitution, 0.05), 0.98),
        poisson=contact.poissons_ratio,
        friction=contact.static_friction,
        plate=options.test.plate_friction,
        timestep=STEP * float(rayleigh),
        gravity=options.test.gravity,
        every=EVERY,
    )


EXPORTER = Exporter(
    key="lammps-clumps",
    label="LAMMPS (clumps of spheres)",
    units=N_("SI; coarse graining applied"),
    carries=(
        N_("drawn particles: shape approximately, size, orientation"),
        N_("mass and inertia"),
        N_("friction, restitution"),
    ),
    loses=(
        N_("weights and size distributions: only a sample is drawn (sizes.csv has them)"),
        N_("flat facets and edges"),
        N_("JKR, true stiffness: the modulus is reduced"),
    ),
    load_command="cd {shell} && lmp -in in.particles -var steps 1000",
    files=_files,
    alters=N_("overlapping spheres stand for each polyhedron; facets become bumpy, corners round."),
    convex_only="",
)
