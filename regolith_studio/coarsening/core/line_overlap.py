"""Overlap of a union of convex parts with a particle, along parallel lines: three bundles on square grids."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.overlap import jaccard
from regolith_studio.coarsening.core.parts import Parts, Planes, parts_for
from regolith_studio.coarsening.core.polyhedron_measures import add_force
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.kernels import inner_kernel, kernel_noalloc
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.vectors import along, mixed, row

# Particles lie in their principal axes: lines along these would run within flat sides.
TURN = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0
"""Directions of the bundles, one a row: far from the principal axes."""
MARGIN = 1e-6


class ScanLines(NamedTuple):
    """Lines and where they cross a particle of unit volume.

    Directions of the three bundles (3, 3); bundle (m,) and a point (m, 3) of each line. Crossings of line i
    are ``first[i]:first[i + 1]``, with distances from the line's point, rising, and sign +1.0 where the line
    leaves the particle, -1.0 where it enters. A unit of length stands for the volume `weight`, so that the
    particle's own is 1.
    """

    directions: FloatArray
    bundle: IntArray
    points: FloatArray
    first: IntArray
    distance: FloatArray
    sign: FloatArray
    weight: float


def scan_lines(mesh: Mesh, n_lines: int) -> ScanLines:
    """Lines as dense as `n_lines` that meet a ball of the volume of a closed mesh, which is 1."""
    low, high = mesh.bounds
    centre = (low + high) / 2.0
    mesh = mesh.moved(shift=-centre)
    radius = float(np.linalg.norm(mesh.vertices, axis=1).max()) * (1.0 + MARGIN)
    # Each of the three bundles has pi r^2 / step^2 lines through the ball of unit volume.
    step = np.sqrt(3.0 * np.pi / n_lines) * (3.0 / (4.0 * np.pi)) ** (1.0 / 3.0)
    per_side = int(2.0 * radius / step) + 1
    grid = (np.arange(per_side) + 0.5) * step - 0.5 * per_side * step
    bundles = [_crossings(mesh, TURN[b], TURN[(b + 1) % 3], TURN[(b + 2) % 3], grid) for b in range(3)]
    lines, distances, signs = (np.concatenate(each) for each in zip(*bundles, strict=True))
    lines = lines + np.repeat(np.arange(3), [len(each[0]) for each in bundles]) * per_side**2
    used, counts = np.unique(lines, return_counts=True)
    bundle, place = np.divmod(used, per_side**2)
    u, v = TURN[(bundle + 1) % 3], TURN[(bundle + 2) % 3]
    points = centre + grid[place // per_side, None] * u + grid[place % per_side, None] * v
    order = np.lexsort((distances, lines))
    distances, signs = distances[order], signs[order]
    first = np.concatenate([[0], np.cumsum(counts)])
    weight = 1.0 / float(np.sum(signs * distances))
    return ScanLines(TURN.copy(), bundle, points, first, distances, signs, weight)


def _crossings(
    mesh: Mesh, along: FloatArray, across: FloatArray, third: FloatArray, grid: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Line, distance and sign of each crossing of one bundle, in no order."""
    flat = np.stack([_heights(mesh.vertices, each) for each in (across, third, along)], axis=1)
    faces = np.array(mesh.faces)
    room = 8 * len(grid) ** 2
    while True:
        line, distance, sign = np.empty(room, dtype=np.int64), np.empty(room), np.empty(room)
        found = _fill_crossings(flat, faces, grid, line, distance, sign)
        if found <= room:
            return line[:found], distance[:found], sign[:found]
        room = found


def _heights(points: FloatArray, axis: FloatArray) -> FloatArray:
    """Coordinates of points along an axis, added up in one order on every processor."""
    x, y, z = points.T
    return np.asarray(x * axis[0] + y * axis[1] + z * axis[2])


@kernel_noalloc
def _fill_crossings(
    flat: FloatArray,
    faces: IntArray,
    grid: FloatArray,
    line: IntArray,
    distance: FloatArray,
    sign: FloatArray,
) -> int:
    """Number of crossings; fills as many as there is room for.

    Two triangles with a common edge work out the same number for it but for its sign, so no line slips
    through between them. `flat` (v, 3) are vertices in the frame of the bundle, its direction last; line (i,
    j) through coordinates i and j of the grid (g,) has the number g i + j.
    """
    found, g = 0, len(grid)
    step = grid[1] - grid[0]
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        low_u, high_u = min(flat[i, 0], flat[j, 0], flat[k, 0]), max(flat[i, 0], flat[j, 0], flat[k, 0])
        low_v, high_v = min(flat[i, 1], flat[j, 1], flat[k, 1]), max(flat[i, 1], flat[j, 1], flat[k, 1])
        from_u, to_u = int(np.floor((low_u - grid[0]) / step)), int(np.ceil((high_u - grid[0]) / step))
        from_v, to_v = int(np.floor((low_v - grid[0]) / step)), int(np.ceil((high_v - grid[0]) / step))
        for a in range(max(from_u, 0), min(to_u, g - 1) + 1):
            for b in range(max(from_v, 0), min(to_v, g - 1) + 1):
                u, v = grid[a], grid[b]
                e0 = (flat[i, 0] - u) * (flat[j, 1] - v) - (flat[i, 1] - v) * (flat[j, 0] - u)
                e1 = (flat[j, 0] - u) * (flat[k, 1] - v) - (flat[j, 1] - v) * (flat[k, 0] - u)
                e2 = (flat[k, 0] - u) * (flat[i, 1] - v) - (flat[k, 1] - v) * (flat[i, 0] - u)
                total = e0 + e1 + e2
                way = 1.0 if total > 0.0 else -1.0
                if way * e0 < 0.0 or way * e1 < 0.0 or way * e2 < 0.0 or total == 0.0:
                    continue
                if way < 0.0 and (e0 == 0.0 or e1 == 0.0 or e2 == 0.0):
                    continue
                if found < len(line):
                    line[found], sign[found] = g * a + b, way
                    distance[found] = (e1 * flat[i, 2] + e2 * flat[j, 2] + e0 * flat[k, 2]) / total
                found += 1
    return found


NEAR = 0.01
"""Distances of the surfaces below this count as this, at unit volume, for the second derivative."""
SLANTED = 1e-9
"""Cosines below this count as this in derivatives of lines that graze a plane."""
N_LINES = 60_000


@kernel_noalloc
def fill_shared_with_lines(
    normals: FloatArray,
    offsets: FloatArray,
    pivots: FloatArray,
    tangents: FloatArray,
    scales: FloatArray,
    lines: ScanLines,
    parts: Parts,
) -> float:
    """Shared volume; fills its charges and a second derivative in `parts`.

    The latter is that of the volume in which they differ, majorised by squares of the distances of the two
    surfaces (iteratively reweighted least squares); it leaves out how planes act together.
    """
    n, total = len(offsets), 0.0
    parts.charges[:, :] = 0.0
    parts.curvature[:, :, :] = 0.0
    for d in range(3):
        for f in range(n):
            parts.speeds[d, f] = along(normals, f, row(lines.directions, d))
    for i in range(len(lines.points)):
        total += _add_line(normals, offsets, pivots, tangents, scales, lines, i, parts)
    for f in range(n):
        for c in range(4):
            parts.charges[f, c] *= lines.weight
        for a in range(3):
            for b in range(3):
                parts.curvature[f, a, b] *= lines.weight
    return total * lines.weight


@inner_kernel
def _add_line(
    normals: FloatArray,
    offsets: FloatArray,
    pivots: FloatArray,
    tangents: FloatArray,
    scales: FloatArray,
    lines: ScanLines,
    i: int,
    parts: Parts,
) -> float:
    """Shared length of line i; adds to charges and curvature."""
    covers, by, speeds, total = parts.covers, parts.by, parts.speeds[lines.bundle[i]], 0.0
    count = _fill_intervals(normals, offsets, parts.first, speeds, lines.points, i, covers, by)
    start, stop, c = lines.first[i], lines.first[i + 1], 0
    while c < count:
        low, high, enter, leave = covers[c, 0], covers[c, 1], by[c, 0], by[c, 1]
        c += 1
        while c < count and covers[c, 0] <= high:
            if covers[c, 1] > high:
                high, leave = covers[c, 1], by[c, 1]
            c += 1
        for j in range(start, stop):
            total += lines.sign[j] * (min(max(lines.distance[j], low), high) - low)
        for end in range(2):
            t, plane = (low, enter) if end == 0 else (high, leave)
            inside, nearest = 0.0, 1.0
            for j in range(start, stop):
                nearest = min(nearest, abs(lines.distance[j] - t))
                if lines.distance[j] > t:
                    inside += lines.sign[j]
            slant = abs(speeds[plane])
            at = mixed(row(lines.points, i), 1.0, row(lines.directions, lines.bundle[i]), t)
            # A plane that moves outward by w moves the end of an interval by w / slant along the line.
            add_force(parts.charges, plane, inside / max(slant, SLANTED), at, pivots)
            x = mixed(at, 1.0, row(pivots, plane), -1.0)
            # The speed w(x) of `polyhedron_measures` for a shift and the two tilts.
            lever = (
                1.0,
                -along(tangents[plane], 0, x) / scales[plane],
                -along(tangents[plane], 1, x) / scales[plane],
            )
            # A facet meets lines in proportion to its slant. The squares of its slants to the three bundles
            # add up to 1, and each bundle has a third of the weight; the distance is taken across the facet.
            stiffness = 3.0 * slant / max(nearest * slant, NEAR)
            for a in range(3):
                for b in range(3):
                    parts.curvature[plane, a, b] += stiffness * lever[a] * lever[b]
    return total


@inner_kernel
def _fill_intervals(
    normals: FloatArray,
    offsets: FloatArray,
    first: IntArray,
    speeds: FloatArray,
    points: FloatArray,
    i: int,
    covers: FloatArray,
    by: IntArray,
) -> int:
    """Intervals of the parts on line i, sorted by where they begin, and how many there are."""
    count = 0
    p = row(points, i)
    for part in range(len(first) - 1):
        low, high, enter, leave = -np.inf, np.inf, 0, 0
        for f in range(first[part], first[part + 1]):
            gap, speed = offsets[f] - along(normals, f, p), speeds[f]
            if speed > 0.0:
                if gap < high * speed:
                    high, leave = gap / speed, f
            elif gap < low * speed:
                low, enter = gap / speed, f
            if not low < high:
                break
        if low < high:
            at = count
            while at > 0 and covers[at - 1, 0] > low:
                for side in range(2):
                    covers[at, side], by[at, side] = covers[at - 1, side], by[at - 1, side]
                at -= 1
            covers[at, 0], covers[at, 1], by[at, 0], by[at, 1] = low, high, enter, leave
            count += 1
    return count


def compound_distance(mesh: Mesh, compound: ConvexCompound, n_lines: int = N_LINES) -> float:
    """Jaccard distance (Eq. 7) of a particle and a union of convex parts in its frame.

    The shared volume is that along `n_lines` parallel lines; the volume of the union is exact.
    The error is below 0.001 for 60,000 lines, 0.0003 as a rule.
    """
    size = mesh.volume ** (1.0 / 3.0)
    particle, compound = mesh.moved(scale=1.0 / size), compound.moved(scale=1.0 / size)
    normals = np.concatenate([part.half_spaces.normals for part in compound.parts])
    offsets = np.concatenate([part.half_spaces.offsets for part in compound.parts])
    places = compound.places[compound.facet_parts]
    first = np.concatenate([[0], np.cumsum([part.n_facets for part in compound.parts])])
    planes = Planes(normals, offsets + np.einsum("ij,ij->i", normals, places), first, compound.places)
    lines = scan_lines(particle, n_lines)
    n = len(normals)
    # Pivots, tangents and scales are for derivatives, which are not asked for here.
    still, parts = (np.zeros((n, 3)), np.zeros((n, 2, 3)), np.ones(n)), parts_for(planes)
    shared = fill_shared_with_lines(planes.normals, planes.offsets, *still, lines, parts)
    return jaccard(shared, 1.0, compound.volume)
