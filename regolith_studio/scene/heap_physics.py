"""The last moment of a run as rigid bodies, for MuJoCo (MJCF) and for programs that read USD physics."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.exporters.mujoco import MjcfShape, mjcf_model
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dataset.sampling import PackedParticles
from regolith_studio.dem.run_io import RunSummary, read_shapes
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import union_of_meshes
from regolith_studio.geometry.mesh import Mesh


def heap_shapes(run: RunSummary) -> list[MjcfShape]:
    """Unit-volume shapes of a run as convex parts."""
    shapes = []
    for number, parts in enumerate(read_shapes(run.folder)):
        hulls = [Mesh(vertices, np.empty((0, 3), dtype=np.int64)).hull for vertices in parts]
        union = hulls[0] if len(hulls) == 1 else union_of_meshes(hulls)
        shapes.append(MjcfShape(f"shape_{number:02d}", hulls, union.inertia))
    return shapes


def heap_mjcf(run: RunSummary, shapes: Sequence[MjcfShape], pile: ParticleState) -> bytes:
    """An MJCF model of the heap on its plate."""
    contact, test = _parameters(run)
    bodies = PackedParticles(pile.class_index, pile.diameters, pile.points, pile.orientations)
    return mjcf_model(run.folder.resolve().name, shapes, bodies, contact, test)[0].encode("utf-8")


def heap_usd(run: RunSummary, shapes: Sequence[MjcfShape], pile: ParticleState) -> bytes:
    """The heap as USD text: rigid bodies of convex hulls by UsdPhysics, in metres and kg, z up.

    Each body states mass, principal moments and their axes, as parts that overlap would count twice, and
    refers to the hulls of its shape, which stand in the file once.
    """
    contact, test = _parameters(run)
    scales = pile.diameters * (np.pi / 6) ** (1 / 3)
    lines = [_HEAD, *map(_prototype, shapes), _SCENE.format(gravity=test.gravity)]
    lines += [_material("grains", contact.static_friction, contact.dynamic_friction, contact.restitution)]
    lines += [_material("plate", test.plate_friction, test.plate_friction, contact.restitution)]
    reach = 2.0 * float(np.abs(pile.points[:, :2]).max()) + 10.0 * float(pile.diameters.max())
    lines += [_PLATE.format(reach=reach, half=reach / 2)]
    frames = [_principal_frame(shape.inertia) for shape in shapes]
    for number, (kind, scale) in enumerate(zip(pile.class_index.tolist(), scales.tolist(), strict=True)):
        moments, axes = frames[kind]
        lines.append(
            _BODY.format(
                number=number,
                place=_row(pile.points[number]),
                turn=_row(pile.orientations[number]),
                mass=contact.density * scale**3,
                moments=_row(moments * contact.density * scale**5),
                axes=_row(axes),
                shape=shapes[kind].name,
                scale=scale,
            )
        )
    return ("\n".join([*lines, "}", ""])).encode("ascii")


def _parameters(run: RunSummary) -> tuple[ContactParameters, LiftingCylinderTest]:
    """Tables 1 and 2 of a run."""
    case: Any = run.document.get("case")
    try:
        return ContactParameters(**case["contact"]), LiftingCylinderTest(**case["test"])
    except (KeyError, TypeError) as error:
        raise FileError(f"{run.folder} does not state its contact parameters.") from error


def _row(values: FloatArray) -> str:
    return ", ".join(f"{value:.9g}" for value in values.tolist())


def _principal_frame(inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Principal moments, shape (3,), and the quaternion (w, x, y, z) of their axes."""
    moments, axes = np.linalg.eigh(inertia)
    turn = Rotation.from_matrix(axes * np.linalg.det(axes))
    return moments, np.asarray(turn.as_quat(scalar_first=True))


def _material(name: str, static: float, dynamic: float, restitution: float) -> str:
    return f"""    def Material "{name}_material" (
        prepend apiSchemas = ["PhysicsMaterialAPI"]
    )
    {{
        float physics:staticFriction = {static:.9g}
        float physics:dynamicFriction = {dynamic:.9g}
        float physics:restitution = {restitution:.9g}
    }}"""


def _prototype(shape: MjcfShape) -> str:
    """The hulls of a unit-volume shape, which are in no scene by themselves."""
    hulls = "\n".join(_hull(number, part) for number, part in enumerate(shape.parts))
    return f'class Xform "{shape.name}"\n{{\n{hulls}\n}}'


def _hull(number: int, part: Mesh) -> str:
    points = ", ".join(f"({_row(point)})" for point in part.vertices)
    return f"""    def Mesh "hull_{number}" (
        prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"]
    )
    {{
        uniform token physics:approximation = "convexHull"
        uniform token subdivisionScheme = "none"
        int[] faceVertexCounts = [{", ".join("3" for _ in part.faces)}]
        int[] faceVertexIndices = [{", ".join(map(str, part.faces.ravel().tolist()))}]
        point3f[] points = [{points}]
    }}"""


_HEAD = """#usda 1.0
(
    defaultPrim = "heap"
    kilogramsPerUnit = 1
    metersPerUnit = 1
    upAxis = "Z"
)
"""

_SCENE = """def Xform "heap"
{{
    def PhysicsScene "scene"
    {{
        vector3f physics:gravityDirection = (0, 0, -1)
        float physics:gravityMagnitude = {gravity:.9g}
    }}"""

_PLATE = """    def Cube "plate" (
        prepend apiSchemas = ["PhysicsCollisionAPI", "MaterialBindingAPI"]
    )
    {{
        double size = {reach:.9g}
        double3 xformOp:translate = (0, 0, -{half:.9g})
        uniform token[] xformOpOrder = ["xformOp:translate"]
        rel material:binding:physics = </heap/plate_material>
    }}"""

_BODY = """    def Xform "particle_{number}" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {{
        double3 xformOp:translate = ({place})
        quatf xformOp:orient = ({turn})
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]
        float physics:mass = {mass:.9g}
        point3f physics:centerOfMass = (0, 0, 0)
        float3 physics:diagonalInertia = ({moments})
        quatf physics:principalAxes = ({axes})
        def "shape" (
            prepend references = </{shape}>
            prepend apiSchemas = ["MaterialBindingAPI"]
        )
        {{
            double3 xformOp:scale = ({scale:.9g}, {scale:.9g}, {scale:.9g})
            uniform token[] xformOpOrder = ["xformOp:scale"]
            rel material:binding:physics = </heap/grains_material>
        }}
    }}"""
