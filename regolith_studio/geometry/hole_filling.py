"""Holes of a surface: their boundaries, and triangles that close them with the least area."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.geometry.topology import edge_table, neighbours

MAX_EXACT_BOUNDARY = 300
"""Boundaries with more corners are closed by a fan about their middle: the best cover takes cubic time."""


@dataclass(frozen=True)
class FilledHoles:
    """A mesh whose holes are closed.

    - ``vertices``, ``faces``: those of the open mesh, then the new ones.
    - ``count``: number of holes.
    - ``area``: area of all new triangles, in the square of the mesh's unit.
    """

    vertices: FloatArray
    faces: IntArray
    count: int
    area: float


def hole_boundaries(faces: IntArray, n_vertices: int) -> list[IntArray]:
    """Vertices around each hole, in the order in which the missing triangles run.

    The faces must be wound consistently. Where two holes touch in a vertex, each has its own boundary.
    """
    table = edge_table(faces, n_vertices)
    lone = np.flatnonzero(neighbours(table) < 0)
    # A missing triangle runs the other way along the edge.
    start, stop = np.roll(faces, -1, axis=1).ravel()[lone], faces.ravel()[lone]
    onward: dict[int, list[int]] = {}
    for a, b in zip(start.tolist(), stop.tolist(), strict=True):
        onward.setdefault(a, []).append(b)
    loops = []
    for seed in sorted(onward):
        while onward[seed]:
            loops += _walk(seed, onward)
    return [np.array(loop, dtype=np.int64) for loop in loops]


def _walk(seed: int, onward: dict[int, list[int]]) -> list[list[int]]:
    """Loops met on a walk from `seed` until no boundary leads on; each is cut off as soon as it closes."""
    loops, path, place = [], [seed], {seed: 0}
    while onward.get(path[-1]):
        step = onward[path[-1]].pop()
        if step in place:
            cut = place[step]
            loops.append(path[cut:])
            for vertex in path[cut + 1 :]:
                del place[vertex]
            del path[cut + 1 :]
        else:
            place[step] = len(path)
            path.append(step)
    return loops


def fill_holes(vertices: FloatArray, faces: IntArray, *, only_fans: bool = False) -> FilledHoles:
    """Close every hole of a consistently wound mesh.

    A hole gets the triangulation of its boundary with the least area, which is exact for flat ones; a
    fan about the boundary's middle where the boundary is long or its triangulation would double an edge.
    """
    holes = [boundary for boundary in hole_boundaries(faces, len(vertices)) if len(boundary) >= 3]
    middles: list[FloatArray] = []
    patches = [faces]
    area = 0.0
    taken = _edges_between(holes, faces, len(vertices))
    for boundary in holes:
        patch = None if only_fans else _min_area_patch(vertices, boundary, taken)
        if patch is None:
            middle = vertices[boundary].mean(axis=0)
            apex = np.full(len(boundary), len(vertices) + len(middles))
            patch = np.column_stack([boundary, np.roll(boundary, -1), apex])
            area += _area(vertices[patch[:, 0]], vertices[patch[:, 1]], middle)
            middles.append(middle)
        else:
            area += _area(*np.moveaxis(vertices[patch], 1, 0))
        patches.append(patch)
    points = np.concatenate([vertices, middles]) if middles else vertices
    return FilledHoles(points, np.concatenate(patches), len(holes), area)


def _area(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def _edges_between(holes: list[IntArray], faces: IntArray, n_vertices: int) -> set[tuple[int, ...]]:
    """The edges of a mesh whose both ends lie on a boundary, as pairs with the lower index first."""
    if not holes:
        return set()
    on_boundary = np.zeros(n_vertices, dtype=np.bool_)
    on_boundary[np.concatenate(holes)] = True
    ends = edge_table(faces, n_vertices).ends
    return {tuple(edge) for edge in ends[on_boundary[ends].all(axis=1)].tolist()}


def _min_area_patch(vertices: FloatArray, boundary: IntArray, taken: set[tuple[int, ...]]) -> IntArray | None:
    """Least-area triangles of a boundary whose inner edges are new; adds those to `taken`."""
    n = len(boundary)
    if n > MAX_EXACT_BOUNDARY:
        return None
    barred = np.zeros((n, n), dtype=np.bool_)
    for i in range(n):
        # The first corner and the last are neighbours. A chord that is an edge of the mesh already is barred,
        # or it would get four triangles.
        for k in range(i + 2, n - (i == 0)):
            barred[i, k] = (min(boundary[i], boundary[k]), max(boundary[i], boundary[k])) in taken
    places = np.empty((n - 2, 3), dtype=np.int64)
    if not least_area_triangles(vertices[boundary], barred, places):
        return None
    triangles = boundary[places]
    for ends in np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2).tolist():
        taken.add((min(ends), max(ends)))
    return triangles


@kernel
def least_area_triangles(points: FloatArray, barred: BoolArray, triangles: IntArray) -> bool:
    """Fill `triangles` (n - 2, 3): triangulation of a closed polygon in space with the least area.

    Dynamic programming over the polygon's chords (Barequet and Sharir 1995); chords (i, k), i < k,
    with ``barred[i, k]`` are not used. False where no triangulation is left.
    """
    n = len(points)
    cost = np.full((n, n), np.inf)
    apex = np.full((n, n), -1, dtype=np.int64)
    for i in range(n - 1):
        cost[i, i + 1] = 0.0
    for span in range(2, n):
        for i in range(n - span):
            k = i + span
            if barred[i, k]:
                continue
            for j in range(i + 1, k):
                # No area is computed where the rest alone is no less.
                if cost[i, j] + cost[j, k] < cost[i, k]:
                    normal = np.cross(points[j] - points[i], points[k] - points[i])
                    value = cost[i, j] + cost[j, k] + np.sqrt((normal * normal).sum()) / 2
                    if value < cost[i, k]:
                        cost[i, k] = value
                        apex[i, k] = j
    if not np.isfinite(cost[0, n - 1]):
        return False
    stack = np.empty((n, 2), dtype=np.int64)
    stack[0, 0], stack[0, 1] = 0, n - 1
    height, found = 1, 0
    while height > 0:
        height -= 1
        i, k = stack[height]
        if k - i < 2:
            continue
        j = apex[i, k]
        triangles[found, 0], triangles[found, 1], triangles[found, 2] = i, j, k
        found += 1
        stack[height, 0], stack[height, 1] = i, j
        stack[height + 1, 0], stack[height + 1, 1] = j, k
        height += 2
    return True


MAX_COVER = 0.47
"""A mesh with more than this share of its closed surface missing is an open sheet, not a particle."""
MIN_INSIDE, MIN_WINDING = 0.9, 0.58
"""What a body has of each share of its :class:`Enclosure`, and of its winding number.

Ellipsoids that lack 1 to 50 % have 1.00 of both shares; of 32 crumpled sheets all but one have 0.44 to 0.85
of the volume wrapped once, and that one 0.78 of it inside. Half an ellipsoid winds by 0.60 to 0.86.
"""
N_RAYS = 1500
N_POINTS = 400
COVER_CHUNK = 4096
"""Triangles of the cover that are seen from all points at the same time, for the memory."""
OFF_CENTRE = (0.0123, 0.0171, 0.0087)
"""Shares of the box's edges by which the rays begin beside its middle, where models have symmetry planes."""


@dataclass(frozen=True)
class Enclosure:
    """How a surface encloses, before and after its holes are closed.

    - ``wrapped_once``: share of the volume about which the closed surface winds that it winds about exactly
      once.
    - ``inside``: share of that volume about which the open surface alone winds by more than a half.
    - ``winding``: mean winding number of the open surface there: 1 of a closed surface, 0.5 of a flat sheet.
    """

    wrapped_once: float
    inside: float
    winding: float


def enclosure(closed: Mesh, n_cover: int) -> Enclosure:
    """How a closed mesh encloses if its last `n_cover` triangles are taken away; all 0 for no volume."""
    points, volumes, windings = _ray_segments(closed)
    # The mesh is inside out.
    if volumes @ windings < 0:
        windings = -windings
    wrapped, once = windings != 0, windings == 1
    if not volumes[once].sum() > 0.0:
        return Enclosure(0.0, 0.0, 0.0)
    chosen = points[once][_systematic_sample(volumes[once])]
    cover = closed.triangles[len(closed.faces) - n_cover :]
    parts = np.array_split(cover, 1 + len(cover) // COVER_CHUNK)
    # Of either sign, as the mesh may be inside out.
    missing = np.abs(sum(solid_angles(part, chosen) for part in parts)) / (4 * np.pi)
    return Enclosure(
        float(volumes[once].sum() / volumes[wrapped].sum()),
        float(np.mean(missing < 0.5)),
        float(1.0 - missing.mean()),
    )


def require_closed_volume(closed: Mesh, n_cover: int, share: float) -> None:
    """Raise GeometryError if a closed mesh bounds no volume without its cover, which has `share` of its area.

    Such meshes are crumpled and curved sheets; see :func:`enclosure`.
    """
    sheet = "The mesh is an open sheet, not a body:"
    if share > MAX_COVER:
        raise GeometryError(f"{sheet} to close it would take {100 * share:.2g} % of the surface.")
    found = enclosure(closed, n_cover)
    if found.wrapped_once < MIN_INSIDE:
        tangled = f"{100 * (1 - found.wrapped_once):.0f} %"
        raise GeometryError(
            f"{sheet} of what it would enclose if it were closed, {tangled} is outside or wrapped twice."
        )
    if found.inside < MIN_INSIDE or found.winding < MIN_WINDING:
        raise GeometryError(
            f"{sheet} from the points inside it covers only {100 * found.winding:.0f} % of all directions."
        )


def solid_angles(triangles: FloatArray, points: FloatArray) -> FloatArray:
    """Sum of the signed solid angles of triangles (m, 3, 3) as seen from each point (n, 3), shape (n,).

    Van Oosterom and Strackee (1983). Positive where the triangles turn their inner side to the point.
    """
    a, b, c = (triangles[None, :, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(edge, axis=2) for edge in (a, b, c))
    volume = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
    dots = [np.einsum("ijk,ijk->ij", *pair) for pair in ((a, b), (b, c), (c, a))]
    turn = la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb
    return np.asarray(2 * np.arctan2(volume, turn).sum(axis=1))


def _ray_segments(mesh: Mesh) -> tuple[FloatArray, FloatArray, IntArray]:
    """Stretches of rays between two crossings: a point in each, the volume it stands for, its winding."""
    low, high = mesh.bounds
    origin = (low + high) / 2 + np.array(OFF_CENTRE) * (high - low)
    directions = fibonacci_directions(N_RAYS)
    hits = radial_hits(mesh, origin, directions)
    begins = np.flatnonzero(np.diff(hits.ray, prepend=-1))
    lengths = np.diff(begins, append=len(hits.ray))
    # From outside inwards, as the winding number is known to be 0 there.
    outward = np.cumsum(hits.sign[::-1])[::-1]
    beyond = np.append(outward, 0)[begins + lengths]
    start = np.concatenate([[0.0], hits.distance[:-1]])
    start[begins] = 0.0
    near, far = start**3, hits.distance**3
    # As much of the segment's volume lies before this point as behind it.
    middle = origin + directions[hits.ray] * np.cbrt((near + far) / 2)[:, None]
    return middle, far - near, outward - np.repeat(beyond, lengths)


def _systematic_sample(weights: FloatArray) -> IntArray:
    """Indices of N_POINTS items, each as often as its weight says (systematic sampling)."""
    steps = (np.arange(N_POINTS) + 0.5) / N_POINTS * weights.sum()
    picks = np.searchsorted(np.cumsum(weights), steps)
    return np.asarray(np.minimum(picks, len(weights) - 1), dtype=np.int64)
