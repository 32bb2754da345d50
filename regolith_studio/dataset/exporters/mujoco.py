"""MuJoCo: an MJCF model of drawn particles, falling on a plate."""

from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, number_row, shape_names, sizes_csv
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dataset.sampling import PackedParticles, pack_on_lattice
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.messages import N_


@dataclass(frozen=True)
class _Units:
    """Names of the units of length and mass, and how many of them are a metre and a kilogram; times in ms."""

    length: str
    mass: str
    per_metre: float
    per_kilogram: float


UNITS = (_Units("mm", "mg", 1e3, 1e6), _Units("um", "pg", 1e6, 1e15))
MIN_MOMENT = 1e-13
"""Smallest moment of inertia in the units of the file; MuJoCo refuses bodies below 1e-15 (mjMINVAL)."""

_NOTE = """Lengths in {length}, masses in {mass}, times in ms: in SI units MuJoCo refuses particles this
small. Each mesh of the file is a shape of volume 1 with a scale; bodies of the same shape and size share
one. A compound is a body of several geoms, one a convex part, with mass and inertia of the union.
Contacts of MuJoCo are soft constraints with Coulomb friction, not Hertz, Mindlin or JKR."""


@dataclass(frozen=True, eq=False)
class MjcfShape:
    """A shape of volume 1 about its centre of mass, as convex parts.

    - ``name``: unique.
    - ``parts``: closed convex meshes.
    - ``inertia``: of the union at density 1, shape (3, 3).
    """

    name: str
    parts: Sequence[Mesh]
    inertia: FloatArray


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    shapes = [
        MjcfShape(key, each.shape.part_meshes, each.shape.mesh.inertia)
        for key, each in zip(shape_names(dataset), dataset.representatives, strict=True)
    ]
    bodies = pack_on_lattice(dataset, options)
    text, notes = mjcf_model(dataset.name, shapes, bodies, options.contact, options.test)
    return {
        "particles.xml": text.encode("utf-8"),
        "sizes.csv": sizes_csv(dataset),
        NOTES: notes.encode("utf-8"),
    }


def mjcf_model(
    name: str,
    shapes: Sequence[MjcfShape],
    bodies: PackedParticles,
    contact: ContactParameters,
    test: LiftingCylinderTest,
) -> tuple[str, str]:
    """An MJCF model of particles on a plate, and what its reader should know.

    Raises DatasetError if the particles are too small for MuJoCo.
    """
    units = _units(shapes, bodies, contact.density)
    density = contact.density * units.per_kilogram / units.per_metre**3
    scales = bodies.scale * units.per_metre
    assets: dict[tuple[int, float], str] = {}
    lines = []
    for index, (which, scale) in enumerate(zip(bodies.class_index.tolist(), scales.tolist(), strict=True)):
        mesh = assets.setdefault((which, scale), f"{shapes[which].name}_{len(assets)}")
        place, turn = bodies.position[index] * units.per_metre, bodies.orientation[index]
        lines += [
            f'    <body name="particle_{index}" pos="{number_row(place)}" quat="{number_row(turn)}">',
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
        f'vertex="{number_row(part.vertices.ravel())}" '
        f'face="{" ".join(map(str, part.faces.ravel().tolist()))}"/>'
        for (which, scale), mesh in assets.items()
        for name, part in zip(_mesh_names(mesh, shapes[which]), shapes[which].parts, strict=True)
    ]
    reach = float(np.abs(bodies.position).max() * units.per_metre) * 4
    rolling = contact.rolling_friction / 2 * float(bodies.diameter.mean()) * units.per_metre
    text = _model(name, contact, test, units, reach, rolling, meshes, lines)
    return text, _NOTE.format(length=units.length, mass=units.mass)


def _units(shapes: Sequence[MjcfShape], bodies: PackedParticles, density: float) -> _Units:
    """The first units in which MuJoCo takes the smallest moment of inertia."""
    least = np.array([np.linalg.eigvalsh(each.inertia)[0] for each in shapes])
    smallest = float((least[bodies.class_index] * density * bodies.scale**5).min())
    for units in UNITS:
        if smallest * units.per_kilogram * units.per_metre**2 > MIN_MOMENT:
            return units
    # Moments of inertia grow with the fifth power of the size.
    factor = (MIN_MOMENT / (smallest * UNITS[-1].per_kilogram * UNITS[-1].per_metre ** 2)) ** 0.2
    raise DatasetError(
        f"MuJoCo refuses bodies with so small moments of inertia as those of the smallest particle, "
        f"{1e6 * bodies.diameter.min():.3g} um; a coarse-graining factor {np.ceil(factor):g} times as large "
        "would do."
    )


def _model(
    name: str,
    contact: ContactParameters,
    test: LiftingCylinderTest,
    units: _Units,
    reach: float,
    rolling: float,
    meshes: list[str],
    bodies: list[str],
) -> str:
    density = contact.density * units.per_kilogram / units.per_metre**3
    gravity = test.gravity * units.per_metre * 1e-6
    return "\n".join(
        [
            f"<mujoco model={quoteattr(name)}>",
            f"  <!-- {units.length}, {units.mass}, ms; z up -->",
            f'  <option gravity="0 0 {-gravity!r}" timestep="0.01" integrator="implicitfast"/>',
            '  <compiler inertiafromgeom="auto" boundmass="0" boundinertia="0"/>',
            f'  <statistic extent="{reach!r}"/>',
            "  <default>",
            f'    <default class="grain"><geom density="{density!r}" condim="{6 if rolling else 3}" '
            f'friction="{contact.dynamic_friction!r} {rolling!r} {rolling!r}"/></default>',
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


def _mesh_names(mesh: str, shape: MjcfShape) -> list[str]:
    """Of the convex parts of a shape; a convex shape is its only part."""
    count = len(shape.parts)
    return [mesh] if count == 1 else [f"{mesh}_part{number}" for number in range(1, count + 1)]


def _inertial(shape: MjcfShape, mass: float, scale: float) -> list[str]:
    """Mass and inertia of a compound: those that MuJoCo sums over its geoms count twice what parts share."""
    if len(shape.parts) == 1:
        return []
    tensor = (shape.inertia * mass * scale**2)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return [f'      <inertial pos="0 0 0" mass="{mass!r}" fullinertia="{number_row(tensor)}"/>']


EXPORTER = Exporter(
    key="mujoco",
    label="MuJoCo (MJCF)",
    units=N_("mm, mg, ms, or um, pg, ms below some 5 um; coarse graining applied"),
    carries=(
        N_("drawn particles: shape, size, orientation"),
        N_("mass and inertia"),
        N_("friction"),
        N_("rolling resistance"),
    ),
    loses=(
        N_("weights and size distributions: only a sample is drawn (sizes.csv has them)"),
        N_("Hertz, Mindlin-Deresiewicz, JKR: MuJoCo's contacts are soft constraints"),
    ),
    load_command="python -m mujoco.viewer --mjcf={shell}/particles.xml",
    files=_files,
    convex_only="",
)
