"""Particles of a simulation by instancing: each shape is stored once, each particle is a place in a list.

The scene is in micrometres, as all others. Each function may be called again and again on one plotter.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion
from scipy.spatial import ConvexHull
from vtkmodules.vtkRenderingCore import vtkActor, vtkGlyph3DMapper

from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.scene import palette, plotter_setup
from regolith_studio.scene.palette import ThemeColors

MAX_CELLS = 150
"""Of the grid from its middle, which lies on the ground; particles beyond are never hidden."""
MAX_HIDDEN_DIAMETER = 2.0
"""Of a particle that may be hidden, in mean diameters: a larger one reaches out of the layers above it."""


@dataclass(frozen=True)
class HiddenDepth:
    """How deep a particle is hidden.

    ``cell``: edge of the cells of a grid, in mean diameters. ``layers``: so many layers of cells that hold
    particles lie around the cell of a hidden particle.
    """

    cell: float
    layers: int


AT_REST = HiddenDepth(2.0, 2)
"""At most three pixels in ten thousand change."""
MOVING = HiddenDepth(2.0, 1)
"""Of a heap of 100,000 particles a fifth is left, and at most one pixel in eighty changes. Smaller cells of a
heap of particles of many sizes are often empty, and then hide nothing."""


def hidden_particles(pile: ParticleState, depth: HiddenDepth) -> NDArray[np.bool_]:
    """Whether others hide a particle from all sides; the ground hides what lies on it from below."""
    if not len(pile):
        return np.zeros(0, dtype=bool)
    mean = float(pile.diameters.mean())
    middle = np.array([*np.median(pile.points[:, :2], axis=0), 0.0])
    cells = np.floor((pile.points - middle) / (depth.cell * mean))
    inside = ((np.abs(cells) < MAX_CELLS) & (cells >= [-MAX_CELLS, -MAX_CELLS, 0])).all(axis=1)
    if not inside.any():
        return np.zeros(len(pile), dtype=bool)
    grid = cells[inside].astype(np.int64)
    grid[:, :2] -= grid[:, :2].min(axis=0)
    grid += depth.layers
    occupied = np.zeros(grid.max(axis=0) + 1 + depth.layers, dtype=bool)
    occupied[tuple(grid.T)] = True
    occupied[:, :, : depth.layers] = True
    core = binary_erosion(occupied, np.ones((3, 3, 3), dtype=bool), iterations=depth.layers)
    hidden = np.zeros(len(pile), dtype=bool)
    hidden[inside] = core[tuple(grid.T)]
    return hidden & (pile.diameters <= MAX_HIDDEN_DIAMETER * mean)


def without(pile: ParticleState, left_out: NDArray[np.bool_]) -> ParticleState:
    """The other particles."""
    kept = np.flatnonzero(~left_out)
    return ParticleState(
        pile.points[kept],
        pile.diameters[kept],
        pile.orientations[kept],
        pile.class_index[kept],
        pile.time,
        pile.wall,
        pile.phase,
    )


def octahedron_of(parts: Sequence[FloatArray]) -> FloatArray:
    """Corners of an octahedron of unit volume with the axes and proportions of a shape, shape (6, 3).

    ``parts``: vertices of the convex parts of the shape.
    """
    vertices = np.concatenate(list(parts))
    axes = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)[2]
    along = vertices @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    half = (high - low) / 2
    half *= (0.75 / half.prod()) ** (1 / 3)  # an octahedron has the volume 4/3 a b c
    return np.asarray(((low + high) / 2 + np.concatenate([np.diag(half), -np.diag(half)])) @ axes)


HEAP, COARSE_HEAP, PLATE, CYLINDER = "heap", "coarse_heap", "plate", "cylinder"
MICROMETRES = 1e6
UNIT_BALL = (np.pi / 6) ** (1 / 3)
COLOURS = ("#e8b04a", "#c98f2e", "#f3cf85", "#b5a18a", "#d8c3a0", "#9f8f7d", "#e3a06b", "#bfae6a")
"""One for each shape, in turn: shades of sand that can be told apart."""
N_AROUND = 96
MANY_TRIANGLES = 150_000
"""Of a heap that is drawn coarsely while the view turns."""
BALL_LEVEL, BALL_TRIANGLES = 2, 320
"""Subdivisions of the icosahedron that stands for a ball, and its triangles."""


def show_heap(
    plotter: Any,
    shapes: Sequence[Sequence[FloatArray]],
    pile: ParticleState,
    spheres: bool = False,
    coarse: bool = False,
) -> None:
    """The particles of one moment; of a large heap without those that others hide.

    - ``plotter``: any pyvista plotter.
    - ``shapes``: vertices of the convex parts of each unit-volume shape, each of shape (k, 3).
    - ``pile``: the particles, in metres.
    - ``spheres``: draw balls of the same volumes instead.
    - ``coarse``: draw octahedra instead, as is enough while the view turns.
    """
    plotter_setup.sample_pixels(plotter, once=coarse)
    if is_large(shapes, pile, spheres):
        pile = without(pile, hidden_particles(pile, MOVING if coarse else AT_REST))
    for each in (HEAP, COARSE_HEAP):
        if each in plotter.actors:
            plotter.actors[each].SetVisibility(False)
    if not len(pile):
        return
    instances, name = _instances(pile, len(shapes)), COARSE_HEAP if coarse else HEAP
    actor = plotter.actors.get(name)
    if actor is not None and _kinds(actor) == _signature(shapes, spheres):
        actor.GetMapper().SetInputData(instances)
        actor.SetVisibility(True)
        return
    if actor is not None:
        plotter.remove_actor(name, render=False)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(instances)
    mapper.SetSourceIndexing(True)
    mapper.SetSourceIndexArray("shape")
    for kind, shape in enumerate(shapes):
        mapper.SetSourceData(kind, _body(shape, spheres, coarse))
    mapper.SetOrientationArray("turn")
    mapper.SetOrientationModeToQuaternion()
    mapper.SetScaleArray("scale")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("colour")
    mapper.SetColorModeToDirectScalars()
    fresh: Any = vtkActor()
    fresh.SetMapper(mapper)
    material = palette.POLYHEDRON_MATERIAL
    fresh.GetProperty().SetAmbient(material.ambient)
    fresh.GetProperty().SetDiffuse(material.diffuse)
    fresh.GetProperty().BackfaceCullingOn()  # the bodies are closed; software OpenGL takes half the time
    fresh.regolith_signature = _signature(shapes, spheres)
    plotter.add_actor(fresh, name=name, reset_camera=False, render=False)


def is_large(shapes: Sequence[Sequence[FloatArray]], pile: ParticleState, spheres: bool = False) -> bool:
    """Whether a heap has so many triangles that software OpenGL takes more than a tenth of a second."""
    if not shapes:
        return False
    if spheres:
        return len(pile) * BALL_TRIANGLES > MANY_TRIANGLES
    triangles = [sum(2 * len(part) - 4 for part in parts) for parts in shapes]
    return len(pile) * float(np.mean(triangles)) > MANY_TRIANGLES


def show_apparatus(
    plotter: Any,
    pile: ParticleState,
    diameter: float,
    height: float,
    reach: float,
    surroundings: ThemeColors = palette.LIGHT,
) -> None:
    """Plate and cylinder.

    - ``pile``: tells where the cylinder's rim is; none is drawn once it is gone.
    - ``diameter``, ``height``: of the cylinder in metres.
    - ``reach``: radius of the plate in metres.
    """
    if PLATE not in plotter.actors:
        plate = pv.Disc(center=(0, 0, 0), inner=0.0, outer=1.0, normal=(0, 0, 1), r_res=1, c_res=N_AROUND)
        plotter.add_mesh(plate, name=PLATE, lighting=False, reset_camera=False, render=False)
        tube = pv.Cylinder(
            center=(0, 0, 0.5),
            direction=(0, 0, 1),
            radius=0.5,
            height=1.0,
            resolution=N_AROUND,
            capping=False,
        )
        plotter.add_mesh(
            tube, name=CYLINDER, opacity=0.16, smooth_shading=True, reset_camera=False, render=False
        )
    plate, tube = plotter.actors[PLATE], plotter.actors[CYLINDER]
    plate.prop.color = surroundings.background_low if surroundings is palette.DARK else "#d5dbe2"
    tube.prop.color = palette.FIT
    plate.SetScale(reach * MICROMETRES, reach * MICROMETRES, 1.0)
    gone = not np.isfinite(pile.wall)
    tube.SetVisibility(not gone)
    if not gone:
        tube.SetScale(diameter * MICROMETRES, diameter * MICROMETRES, height * MICROMETRES)
        tube.SetPosition(0.0, 0.0, pile.wall * MICROMETRES)


def framing_corners(diameter: float, height: float) -> FloatArray:
    """Corners of what a view should show of a test, in micrometres, shape (8, 3)."""
    return box_corners(1.7 * diameter, height)


def box_corners(reach: float, top: float) -> FloatArray:
    """Corners of a box on the ground, of metres, in micrometres, shape (8, 3)."""
    sides, heights = (-reach, reach), (0.0, top)
    return MICROMETRES * np.array([(x, y, z) for x in sides for y in sides for z in heights])


def _instances(pile: ParticleState, n_shapes: int) -> pv.PolyData:
    data: pv.PolyData = pv.PolyData(MICROMETRES * np.asarray(pile.points))
    kinds = np.minimum(pile.class_index, n_shapes - 1)
    data.point_data["shape"] = kinds.astype(np.int32)
    data.point_data["turn"] = pile.orientations.astype(np.float32)
    data.point_data["scale"] = (MICROMETRES * UNIT_BALL * pile.diameters).astype(np.float32)
    inks = np.array([pv.Color(colour).int_rgb for colour in COLOURS], dtype=np.uint8)
    data.point_data["colour"] = inks[kinds % len(inks)]
    return data


def _body(shape: Sequence[FloatArray], spheres: bool, coarse: bool) -> pv.PolyData:
    if coarse:
        return _facets((octahedron_of((icosphere(1).vertices,) if spheres else shape),))
    return _ball() if spheres else _facets(shape)


def _facets(parts: Sequence[FloatArray]) -> pv.PolyData:
    """Convex bodies with one normal a facet, corners repeated, so that edges stay sharp."""
    hulls = [_oriented_hull(vertices) for vertices in parts]
    corners = np.concatenate([each[0] for each in hulls])
    normals = np.concatenate([each[1] for each in hulls])
    n = len(corners)
    cells = np.column_stack([np.full(n, 3), np.arange(3 * n).reshape(n, 3)]).ravel()
    body: pv.PolyData = pv.PolyData(corners.reshape(-1, 3), faces=cells)
    body.point_data["Normals"] = np.repeat(normals, 3, axis=0).astype(np.float32)
    body.GetPointData().SetActiveNormals("Normals")
    return body


def _oriented_hull(vertices: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Corners (t, 3, 3) of the hull's triangles, counter-clockwise from outside, and normals (t, 3)."""
    hull = ConvexHull(vertices)
    corners = vertices[hull.simplices]
    normals = hull.equations[:, :3]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = (across * normals).sum(axis=1) < 0.0
    corners[inward] = corners[inward][:, ::-1]
    return corners, normals


def _ball() -> pv.PolyData:
    """A ball of unit volume."""
    mesh = icosphere(BALL_LEVEL)
    cells = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces]).ravel()
    body: pv.PolyData = pv.PolyData(mesh.vertices / UNIT_BALL / 2, faces=cells)
    body.point_data["Normals"] = np.array(mesh.vertices, dtype=np.float32)
    body.GetPointData().SetActiveNormals("Normals")
    return body


def _signature(shapes: Sequence[Sequence[FloatArray]], spheres: bool) -> tuple[object, ...]:
    """What the sources of the instances were made from."""
    return (spheres, *(tuple((len(part), float(part[0].sum())) for part in parts) for parts in shapes))


def _kinds(actor: Any) -> object:
    return getattr(actor, "regolith_signature", None)
