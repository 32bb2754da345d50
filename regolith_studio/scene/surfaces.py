"""Show the three surfaces: particle, spherical-harmonics fit, coarsened polyhedron.

Each function may be called again and again on one plotter: the actors stay, only their data change,
and the camera is left alone.
"""

from collections.abc import Callable, Set
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.label_surface import LabelSurface
from regolith_studio.jobs.events import Started, Steps
from regolith_studio.messages import N_
from regolith_studio.scene import annotations, palette
from regolith_studio.scene.palette import Material, ThemeColors

SURFACE = "surface"
OUTLINE = "outline"
LINE_WIDTH = 1.6
"""Of the outlines of facets, in pixels."""


SHADES = "shades"
"""Brightness of the darkest part of a compound; the first has that of the material."""
SHARP_EDGE = 50.0
"""Degrees between the normals of two triangles above which their edge is drawn sharp: a cube's, no scan's."""


def show_particle(plotter: Any, mesh: Mesh) -> None:
    """The particle as measured, smoothly shaded between its sharp edges."""
    surface = with_sharp_edges(smooth_surface(mesh))
    _show_surface(plotter, surface, palette.PARTICLE_MATERIAL, smooth=True)


def show_smooth(plotter: Any, mesh: Mesh, material: Material, layer: str = "") -> None:
    """Any mesh, smoothly shaded; surfaces of different layers stand beside each other."""
    _show_surface(plotter, smooth_surface(mesh), material, smooth=True, layer=layer)


def show_fit(
    plotter: Any,
    mesh: Mesh,
    distances: FloatArray | None = None,
    span: float | None = None,
    surroundings: ThemeColors = palette.LIGHT,
    write: Callable[[float], str] = annotations.distance_text,
) -> None:
    """The fit, in its own colour or coloured by its distance from the particle.

    - ``plotter``: any pyvista plotter.
    - ``mesh``: surface of the fit.
    - ``distances``: signed distance of each vertex from the particle, shape (n,), positive outside.
    - ``span``: distance at both ends of the colour map; the largest distance if not given.
    - ``surroundings``: whose ink the scale of the map is written with.
    - ``write``: the text of a distance at the scale.
    """
    surface = smooth_surface(mesh)
    if distances is not None:
        surface.point_data["distance"] = distances
    actor = _show_surface(plotter, surface, palette.FIT_MATERIAL, smooth=True)
    mapper = actor.mapper
    annotations.hide_colour_scale(plotter)
    mapper.scalar_visibility = distances is not None
    if distances is not None:
        reach = span if span is not None else float(np.abs(distances).max(initial=0.0))
        mapper.lookup_table = pv.LookupTable(palette.ERROR_MAP, scalar_range=(-reach or -1.0, reach or 1.0))
        mapper.scalar_range = (-reach or -1.0, reach or 1.0)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("distance")
        annotations.show_colour_scale(plotter, mapper, surroundings, write)


def show_polyhedron(
    plotter: Any,
    polyhedron: Polyhedron,
    centre: ArrayLike = (0.0, 0.0, 0.0),
    surroundings: ThemeColors = palette.LIGHT,
    layer: str = "",
) -> None:
    """The coarsened polyhedron: flat facets, each outlined (facets, not triangles); parts in shades.

    - ``plotter``: any pyvista plotter.
    - ``polyhedron``: about its own origin.
    - ``centre``: where that origin lies in the particle's frame.
    - ``surroundings``: whose outline colour is used.
    - ``layer``: surfaces of different layers stand beside each other.
    """
    if isinstance(polyhedron, ConvexCompound):
        corners = polyhedron.mesh.vertices + np.asarray(centre, dtype=np.float64)
        polygons = _polygons(corners, tuple(map(tuple, polyhedron.mesh.faces.tolist())))
        polygons.cell_data[SHADES] = part_shades(polyhedron)
        lines = exposed_edges(polyhedron)
    else:
        corners = polyhedron.vertices + np.asarray(centre, dtype=np.float64)
        polygons, lines = _polygons(corners, polyhedron.facets), facet_edges(polyhedron)
    actor = _show_surface(plotter, polygons, palette.POLYHEDRON_MATERIAL, smooth=False, layer=layer)
    _show_shades(actor.mapper, SHADES in polygons.cell_data)
    _show_lines(plotter, pv.PolyData(corners.copy(), lines=lines), surroundings.outline, layer)


def clear(plotter: Any) -> None:
    """Show no surface."""
    annotations.hide_colour_scale(plotter)
    hide(plotter)


def hide(plotter: Any, layer: str = "") -> None:
    """Show no surface of a layer."""
    for name in (SURFACE, OUTLINE):
        if layer + name in plotter.actors:
            plotter.actors[layer + name].SetVisibility(False)


def set_opacity(plotter: Any, opacity: float, layer: str = "") -> None:
    """Let light through a surface, or none."""
    actor = plotter.actors.get(layer + SURFACE)
    if actor is not None:
        actor.prop.opacity = opacity


def widen_lines(plotter: Any, factor: float) -> None:
    """Draw the outlines of facets `factor` times as wide as usual, for larger pictures."""
    actor = plotter.actors.get(OUTLINE)
    if actor is not None:
        actor.prop.line_width = LINE_WIDTH * factor


def set_wireframe(plotter: Any, wireframe: bool) -> None:
    """Draw the surface as its triangle mesh, or filled."""
    actor = plotter.actors.get(SURFACE)
    if actor is not None:
        actor.prop.style = "wireframe" if wireframe else "surface"
        actor.prop.lighting = not wireframe


def _show_surface(plotter: Any, data: pv.PolyData, material: Material, smooth: bool, layer: str = "") -> Any:
    actor = _replaced(plotter, layer + SURFACE, data)
    if actor is None:
        actor = plotter.add_mesh(
            data,
            name=layer + SURFACE,
            color=material.colour,
            show_scalar_bar=False,
            copy_mesh=False,
            reset_camera=False,
            render=False,
        )
        actor.mapper.resolve = "polygon_offset"
    prop = actor.prop
    prop.color = material.colour
    prop.ambient, prop.diffuse = material.ambient, material.diffuse
    prop.specular, prop.specular_power = material.specular, material.specular_power
    prop.interpolation = "Phong" if smooth else "Flat"
    return actor


def _show_lines(plotter: Any, data: pv.PolyData, colour: str, layer: str = "") -> None:
    actor = _replaced(plotter, layer + OUTLINE, data)
    if actor is None:
        actor = plotter.add_mesh(
            data,
            name=layer + OUTLINE,
            line_width=LINE_WIDTH,
            lighting=False,
            copy_mesh=False,
            reset_camera=False,
            render=False,
        )
        # else a facet that is seen nearly from its side hides pieces of its own edges
        actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-1.0, -8.0)
    actor.prop.color = colour


def _replaced(plotter: Any, name: str, data: pv.PolyData) -> Any | None:
    """The actor of this name with new data, or ``None`` where the plotter has none yet."""
    actor = plotter.actors.get(name)
    if actor is not None:
        actor.mapper.dataset = data
        actor.SetVisibility(True)
    return actor


def smooth_surface(mesh: Mesh) -> pv.PolyData:
    """The mesh with one normal a vertex: the mean of its triangles' normals, weighted by area."""
    cells = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces])
    data: pv.PolyData = pv.PolyData(np.array(mesh.vertices), faces=cells.ravel())
    corners = np.repeat(mesh.face_area_vectors, 3, axis=0)
    normals = np.stack(
        [
            np.bincount(mesh.faces.ravel(), weights=corners[:, axis], minlength=len(mesh.vertices))
            for axis in range(3)
        ],
        axis=1,
    )
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    data.point_data["Normals"] = (normals / np.where(length > 0.0, length, 1.0)).astype(np.float32)
    data.GetPointData().SetActiveNormals("Normals")
    return data


def with_sharp_edges(surface: pv.PolyData) -> pv.PolyData:
    """The surface with vertices doubled along edges that are too sharp to be shaded smoothly."""
    split: pv.PolyData = surface.compute_normals(
        cell_normals=False,
        split_vertices=True,
        feature_angle=SHARP_EDGE,
        consistent_normals=False,
        auto_orient_normals=False,
    )
    return split


def _polygons(vertices: FloatArray, facets: tuple[tuple[int, ...], ...]) -> pv.PolyData:
    cells = [item for facet in facets for item in (len(facet), *facet)]
    polygons: pv.PolyData = pv.PolyData(np.array(vertices), faces=np.array(cells, dtype=np.int64))
    return polygons


def facet_edges(polyhedron: ConvexPolyhedron) -> FloatArray:
    """Each edge between two facets once, in VTK's layout of lines."""
    edges = {
        (min(a, b), max(a, b))
        for facet in polyhedron.facets
        for a, b in zip(facet, facet[1:] + facet[:1], strict=True)
    }
    return np.array([item for edge in sorted(edges) for item in (2, *edge)], dtype=np.int64)


def part_shades(compound: ConvexCompound) -> NDArray[np.uint8]:
    """Colour of each triangle of a compound, (m, 3) of 0 to 255: each part its own tone."""
    tones = np.array([pv.Color(tone).int_rgb for tone in palette.PART_TONES])
    places = np.linspace(0.0, len(tones) - 1.0, compound.n_parts)
    shades = [np.interp(places, np.arange(len(tones)), channel) for channel in tones.T]
    colours = np.round(np.column_stack(shades)).astype(np.uint8)
    return np.asarray(colours[compound.facet_parts[compound.triangle_facets]])


def exposed_edges(compound: ConvexCompound) -> FloatArray:
    """Each edge of the union between two facets once, in VTK's layout of lines."""
    faces, facet = compound.mesh.faces, np.repeat(compound.triangle_facets, 3)
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    order = np.lexsort((facet, ends[:, 1], ends[:, 0]))
    one, two = order[0::2], order[1::2]  # the surface is closed: each edge occurs twice
    between = ends[one[facet[one] != facet[two]]]
    return np.column_stack([np.full(len(between), 2), between]).ravel()


def _show_shades(mapper: Any, shaded: bool) -> None:
    """Colour triangles by the array :data:`SHADES`, or all alike."""
    mapper.scalar_visibility = shaded
    if shaded:
        mapper.SetScalarModeToUseCellFieldData()
        mapper.SelectColorArray(SHADES)
        mapper.SetColorModeToDirectScalars()


NEAREST = 12
"""Triangles, those with the nearest middles, that are measured for each point."""


def signed_distances(points: FloatArray, surface: Mesh) -> FloatArray:
    """Distance of each point from a surface: positive outside, negative inside.

    The nearest of a few triangles whose middles are nearest; exact for surfaces of evenly sized
    triangles, as fits and contoured scans are.

    ``points``: shape (n, 3). ``surface``: closed, outward oriented.

    Returns shape (n,), in the unit of the points.
    """
    count = min(NEAREST, len(surface.faces))
    middles = surface.triangles.mean(axis=1)
    _, near = cKDTree(middles).query(points, k=count)
    near = near.reshape(len(points), count)
    closest = _closest_points(np.repeat(points, count, axis=0), surface.triangles[near.ravel()])
    step = np.repeat(points, count, axis=0) - closest
    length = np.linalg.norm(step, axis=1).reshape(len(points), count)
    best = length.argmin(axis=1)
    rows = np.arange(len(points))
    outward = surface.face_area_vectors[near[rows, best]]
    step = step.reshape(len(points), count, 3)[rows, best]
    side = np.where(np.einsum("ij,ij->i", step, outward) < 0.0, -1.0, 1.0)
    return np.asarray(side * length[rows, best], dtype=np.float64)


def _closest_points(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """The point of each triangle (n, 3, 3) that is nearest to its point (n, 3)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    area = np.einsum("ij,ij->i", normal, normal)
    safe = np.where(area > 0.0, area, 1.0)
    v = np.einsum("ij,ij->i", np.cross(c - a, normal), points - a) / safe
    w = np.einsum("ij,ij->i", np.cross(normal, b - a), points - a) / safe
    inside = (area > 0.0) & (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0)
    best = a + v[:, None] * (b - a) + w[:, None] * (c - a)
    distance = np.where(inside, np.linalg.norm(points - best, axis=1), np.inf)
    for first, second in ((a, b), (b, c), (c, a)):
        along = second - first
        square = np.einsum("ij,ij->i", along, along)
        share = np.einsum("ij,ij->i", points - first, along) / np.where(square > 0.0, square, 1.0)
        foot = first + np.clip(share, 0.0, 1.0)[:, None] * along
        reach = np.linalg.norm(points - foot, axis=1)
        nearer = reach < distance
        best = np.where(nearer[:, None], foot, best)
        distance = np.where(nearer, reach, distance)
    return np.asarray(best)


def measure_distances(fit: Mesh, particle: Mesh) -> Steps:
    """A job: :func:`signed_distances` of a fit's vertices."""
    yield Started(N_("Measuring distances"))
    return signed_distances(fit.vertices, particle)


GRAINS, OTHERS, BOX = "grains", "other grains", "box"
_FAINT = 0.12
"""Opacity of the grains that are not highlighted."""


def show_grains(
    plotter: Any,
    surface: LabelSurface | None,
    colours: NDArray[np.uint8],
    size: NDArray[np.float64],
    highlighted: Set[int] = frozenset(),
) -> None:
    """Show the surfaces of labels in the box of their volume, or the box alone.

    - ``colours``: RGB of each face, shape (m, 3).
    - ``size``: edges of the volume in micrometres, shape (3,).
    - ``highlighted``: labels that are seen through all others; with none, all are opaque.
    """
    for name in (GRAINS, OTHERS, BOX):
        plotter.remove_actor(name, render=False)
    box = pv.Box((0.0, size[0], 0.0, size[1], 0.0, size[2]))
    plotter.add_mesh(
        box, name=BOX, style="wireframe", color="grey", lighting=False, reset_camera=False, render=False
    )
    if surface is None:
        return
    chosen = np.isin(surface.labels, list(highlighted)) if highlighted else np.ones(len(surface.labels), bool)
    for name, faces, opacity in ((GRAINS, chosen, 1.0), (OTHERS, ~chosen, _FAINT)):
        if not faces.any():
            continue
        triangles: Any = surface.faces[faces]
        mesh = pv.PolyData.from_regular_faces(surface.vertices, triangles)
        mesh.cell_data["colours"] = colours[faces]
        plotter.add_mesh(
            mesh,
            name=name,
            scalars="colours",
            rgb=True,
            opacity=opacity,
            show_scalar_bar=False,
            reset_camera=False,
            render=False,
        )
