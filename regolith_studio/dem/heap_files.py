"""Shapes and particles of a run in the formats of OVITO (extended XYZ) and of glTF viewers (GLB)."""

import io
import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from regolith_studio.dem.run_io import RunSummary, read_shapes
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError, GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import union_of_meshes
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.glb import Z_UP_TO_Y_UP, MeshBuffer, glb_bytes

UNIT_DIAMETER = float((np.pi / 6) ** (1 / 3))
"""Factor from a body of unit volume to one of unit equivalent diameter."""
BALL_LEVEL = 2
"""Subdivisions of the icosahedron that stands for a sphere: 320 triangles, 3 % less volume."""


@dataclass(frozen=True, eq=False)
class RunShapes:
    """Shapes of a run as closed meshes of unit equivalent diameter about their centres of mass.

    Parameters
    ----------
    meshes
        One for each shape; of compounds the surface of the union. One icosphere for a run with spheres.
    spheres
        Whether all particles are spheres.
    """

    meshes: tuple[Mesh, ...]
    spheres: bool

    @property
    def names(self) -> list[str]:
        """``shape_00``, ``shape_01`` ..."""
        digits = max(2, len(str(len(self.meshes) - 1)))
        return [f"shape_{index:0{digits}d}" for index in range(len(self.meshes))]

    def index(self, pile: ParticleState) -> IntArray:
        """Index of the mesh of each particle.

        Raises
        ------
        FileError
            If a particle has a shape that the run does not hold.
        """
        if self.spheres:
            return np.zeros(len(pile), dtype=np.int64)
        if len(pile) and not 0 <= pile.class_index.min() <= pile.class_index.max() < len(self.meshes):
            raise FileError(f"The particles of the run have other shapes than its {len(self.meshes)}.")
        return pile.class_index


def run_shapes(run: RunSummary) -> RunShapes:
    """The shapes that the particles of a run have.

    Raises
    ------
    FileError
        If they are missing or broken.
    """
    case = run.document.get("case")
    if isinstance(case, dict) and case.get("shapes") == "spheres":
        ball = icosphere(BALL_LEVEL)
        return RunShapes((Mesh(ball.vertices / 2, ball.faces),), spheres=True)
    try:
        meshes = tuple(_surface(parts).moved(scale=UNIT_DIAMETER) for parts in read_shapes(run.folder))
    except (GeometryError, ValueError) as error:
        raise FileError(f"{run.folder} holds no shapes that can be exported.") from error
    if not meshes:
        raise FileError(f"{run.folder} holds no shapes.")
    return RunShapes(meshes, spheres=False)


def _surface(parts: Sequence[FloatArray]) -> Mesh:
    """Surface of the union of convex bodies, given by their vertices."""
    hulls = [Mesh(vertices, np.empty((0, 3), dtype=np.int64)).hull for vertices in parts]
    return hulls[0] if len(hulls) == 1 else union_of_meshes(hulls)


def extended_xyz(shapes: RunShapes, pile: ParticleState) -> bytes:
    """One frame with OVITO's names of properties: type, position, radius and orientation (x, y, z, w).

    Lengths are in metres.
    """
    names = np.array(shapes.names)[shapes.index(pile)]
    numbers = np.column_stack(
        [pile.points, pile.diameters / 2, pile.orientations[:, 1:], pile.orientations[:, 0]]
    )
    text = io.StringIO()
    properties = "species:S:1:pos:R:3:radius:R:1:orientation:R:4"
    text.write(f'{len(pile)}\nProperties={properties} Time={pile.time:.9g} pbc="F F F"\n')
    line = "%s %.7g %.7g %.7g %.7g %.6g %.6g %.6g %.6g\n"
    text.writelines(line % (name, *row) for name, row in zip(names, numbers.tolist(), strict=True))
    return text.getvalue().encode("ascii")


def heap_glb(shapes: RunShapes, pile: ParticleState, colours: Sequence[Sequence[float]]) -> bytes:
    """A scene with one node for each particle, which share a mesh for each shape; in metres, y up.

    Parameters
    ----------
    colours
        Red, green and blue from 0 to 1, linear, for the shapes in turn.
    """
    buffer = MeshBuffer()
    for number, (name, mesh) in enumerate(zip(shapes.names, shapes.meshes, strict=True)):
        normals = mesh.face_area_vectors / mesh.face_areas[:, None]
        corners = mesh.triangles.reshape(-1, 3)
        buffer.add(name, corners, np.repeat(normals, 3, axis=0), number % len(colours))
    root = {"name": "heap", "rotation": Z_UP_TO_Y_UP, "children": list(range(1, len(pile) + 1))}
    content = {
        "asset": {"version": "2.0", "generator": "regolith-studio"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "materials": [_material(number, colour) for number, colour in enumerate(colours)],
        **buffer.document(),
    }
    head = json.dumps(content, separators=(",", ":"), allow_nan=False)[:-1]
    first = json.dumps(root, separators=(",", ":"))
    nodes = ",".join((first, *_nodes(shapes.index(pile), pile)))
    return glb_bytes(f'{head},"nodes":[{nodes}]}}'.encode("ascii"), buffer.binary)


def _nodes(index: IntArray, pile: ParticleState) -> list[str]:
    """JSON of the node of each particle, with the digits that single precision has."""
    numbers = np.column_stack(
        [index, pile.points, pile.orientations[:, 1:], pile.orientations[:, 0], *[pile.diameters] * 3]
    )
    node = (
        '{"mesh":%d,"translation":[%.7g,%.7g,%.7g],"rotation":[%.7g,%.7g,%.7g,%.7g],"scale":[%.7g,%.7g,%.7g]}'
    )
    return [node % tuple(row) for row in numbers.tolist()]


def _material(number: int, colour: Sequence[float]) -> dict[str, object]:
    surface = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}
    return {"name": f"sand_{number}", "pbrMetallicRoughness": surface}
