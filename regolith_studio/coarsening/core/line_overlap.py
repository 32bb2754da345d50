"""Volume that a union of convex parts shares with a particle, by quadrature over parallel lines.

Every part is one interval on a line, and the union of at most as many.
"""

import numpy as np

from regolith_studio.coarsening.core.overlap import jaccard
from regolith_studio.coarsening.core.parts import Parts, Planes, parts_for
from regolith_studio.coarsening.core.polyhedron_measures import add_force
from regolith_studio.coarsening.core.scan_lines import ScanLines, scan_lines
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.vectors import along, mixed, row

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


@kernel_noalloc
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
            # The speed w(x) of `plane_coordinates` for a shift and the two tilts.
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


@kernel_noalloc
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
