"""MuJoCo: an MJCF model of drawn particles, falling on a plate."""

from xml.sax.saxutils import quoteattr

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.packing import pack_on_lattice
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.messages import N_

MILLIMETRES = 1e3
"""Per metre."""

_NOTE = b"""Lengths in mm, masses in mg, times in ms (forces in mN): in SI units MuJoCo refuses particles this
small. Each mesh of the file is a shape of volume 1 with a scale; bodies of the same shape and size share
one. A compound is a body of several geoms, one a convex part, with mass and inertia of the union.
Contacts of MuJoCo are soft constraints with Coulomb friction, not Hertz, Mindlin or JKR."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    bodies = pack_on_lattice(dataset, options)
    keys, density = shape_names(dataset), options.contact.density * 1e-3
    scales = bodies.scale * MILLIMETRES
    shapes = [one.shape for one in dataset.representatives]
    assets: dict[tuple[int, float], str] = {}
    lines = []
    for index, (which, scale) in enumerate(zip(bodies.class_index.tolist(), scales.tolist(), strict=True)):
        mesh = assets.setdefault((which, scale), f"{keys[which]}_{len(assets)}")
        place, turn = bodies.position[index] * MILLIMETRES, bodies.orientation[index]
        lines += [
            f'    <body name="particle_{index}" pos="{_row(place)}" quat="{_row(turn)}">',
            "      <freejoint/>",
            *_inertial(shapes[which], density * scale**3, scale),
            *(
                f'      <geom type="mesh" mesh="{name}" class="grain"/>'
                for name in _mesh_names(mesh, shapes[which])
            ),
            "    </body>",
        ]
    meshes = [
        f'    <mesh name="{name}" inertia="exact" scale="{scale!r} {scale!r} {scale!r}" '
        f'vertex="{_row(part.vertices.ravel())}" face="{" ".join(map(str, part.faces.ravel().tolist()))}"/>'
        for (which, scale), mesh in assets.items()
        for name, part in zip(_mesh_names(mesh, shapes[which]), shapes[which].part_meshes, strict=True)
    ]
    reach = float(np.abs(bodies.position).max() * MILLIMETRES) * 4
    text = _model(dataset.name, options, density, reach, meshes, lines)
    return {"particles.xml": text.encode("utf-8"), "sizes.csv": sizes_csv(dataset), NOTES: _NOTE}


def _model(
    name: str, options: ExportOptions, density: float, reach: float, meshes: list[str], bodies: list[str]
) -> str:
    contact, test = options.contact, options.test
    return "\n".join(
        [
            f"<mujoco model={quoteattr(name)}>",
            "  <!-- mm, mg, ms; z up -->",
            f'  <option gravity="0 0 {-test.gravity * 1e-3!r}" timestep="0.01" integrator="implicitfast"/>',
            '  <compiler inertiafromgeom="auto" boundmass="0" boundinertia="0"/>',
            f'  <statistic extent="{reach!r}"/>',
            "  <default>",
            f'    <default class="grain"><geom density="{density!r}" condim="3" '
            f'friction="{contact.dynamic_friction!r} 0 0"/></default>',
            "  </default>",
            "  <asset>",
            *meshes,
            "  </asset>",
            "  <worldbody>",
            f'    <geom name="plate" type="plane" size="{reach!r} {reach!r} 1" '
            f'friction="{test.plate_friction!r} 0 0"/>',
            *bodies,
            "  </worldbody>",
            "</mujoco>",
            "",
        ]
    )


def _mesh_names(mesh: str, shape: Polyhedron) -> list[str]:
    """Of the convex parts of a shape; a convex shape is its only part."""
    count = len(shape.part_meshes)
    return [mesh] if count == 1 else [f"{mesh}_part{number}" for number in range(1, count + 1)]


def _inertial(shape: Polyhedron, mass: float, scale: float) -> list[str]:
    """Mass and inertia of a compound: those that MuJoCo sums over its geoms count twice what parts share."""
    if not isinstance(shape, ConvexCompound):
        return []
    tensor = (shape.inertia * mass * scale**2)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return [f'      <inertial pos="0 0 0" mass="{mass!r}" fullinertia="{_row(tensor)}"/>']


def _row(values: np.ndarray) -> str:
    return " ".join(map(repr, np.asarray(values).tolist()))


EXPORTER = Exporter(
    key="mujoco",
    label="MuJoCo (MJCF)",
    units=N_("mm, mg, ms; coarse graining applied"),
    carries=(N_("drawn particles: shape, size, orientation"), N_("mass and inertia"), N_("friction")),
    loses=(
        N_("weights and size distributions: only a sample is drawn (sizes.csv has them)"),
        N_("Hertz, Mindlin-Deresiewicz, JKR: MuJoCo's contacts are soft constraints"),
    ),
    load_command="python -m mujoco.viewer --mjcf={shell}/particles.xml",
    files=_files,
    convex_only="",
)
