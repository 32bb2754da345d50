"""Volume that a union of convex parts shares with a particle, by quadrature over parallel lines.

Every part is one interval on a line, and the union of at most as many.
"""

import numpy as np

from regolith_studio.coarsening.compound.measures import MeasuredCompound, Planes
from regolith_studio.coarsening.compound.scan_lines import ScanLines, scan_lines
from regolith_studio.coarsening.core.overlap import jaccard
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.vectors import along, dot, mixed, row

NEAR = 0.01
"""Distances of the surfaces below this count as this, at unit volume, for the second derivative."""
SLANTED = 1e-9
"""Cosines below this count as this in derivatives of lines that graze a plane."""
N_LINES = 60_000


def shared_with_lines(
    compound: MeasuredCompound, lines: ScanLines, tangents: FloatArray, scales: FloatArray
) -> tuple[float, FloatArray, FloatArray]:
    """Shared volume, its derivative with the planes' coordinates, (3 n,), and a second derivative, (n, 3, 3).

    The second one is that of the volume in which they differ, majorised by squares of the distances of the
    two surfaces (iteratively reweighted least squares); it leaves out how planes act together.
    """
    return _shared(compound.planes, compound.centroids, lines, tangents, scales)


def _shared(
    planes: Planes, pivots: FloatArray, lines: ScanLines, tangents: FloatArray, scales: FloatArray
) -> tuple[float, FloatArray, FloatArray]:
    normals, offsets, first = planes[:3]
    n, k = len(offsets), len(first) - 1
    gradient, curvature = np.zeros(3 * n), np.zeros((n, 3, 3))
    shared = _fill_overlap(
        normals,
        offsets,
        first,
        lines.directions @ normals.T,
        lines.directions,
        lines.bundle,
        lines.points,
        lines.first,
        lines.distance,
        lines.sign,
        pivots,
        tangents,
        scales,
        np.empty((k, 2)),
        np.empty((k, 2), dtype=np.int64),
        gradient,
        curvature,
    )
    return shared * lines.weight, gradient * lines.weight, curvature * lines.weight


@kernel_noalloc
def _fill_overlap(
    normals: FloatArray,
    offsets: FloatArray,
    first: IntArray,
    speeds: FloatArray,
    directions: FloatArray,
    bundle: IntArray,
    points: FloatArray,
    crossed: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    pivots: FloatArray,
    tangents: FloatArray,
    scales: FloatArray,
    covers: FloatArray,
    by: IntArray,
    gradient: FloatArray,
    curvature: FloatArray,
) -> float:
    """Shared length of all lines; adds to its gradient and the curvature.

    Parameters
    ----------
    speeds
        Scalar products of directions and normals, (3, n).
    covers, by
        Scratch: intervals of the parts, and the planes that bound them, (k, 2) each.
    """
    total = 0.0
    for i in range(len(points)):
        count = _fill_intervals(normals, offsets, first, speeds[bundle[i]], points, i, covers, by)
        c = 0
        while c < count:
            low, high, enter, leave = covers[c, 0], covers[c, 1], by[c, 0], by[c, 1]
            c += 1
            while c < count and covers[c, 0] <= high:
                if covers[c, 1] > high:
                    high, leave = covers[c, 1], by[c, 1]
                c += 1
            for j in range(crossed[i], crossed[i + 1]):
                total += sign[j] * (min(max(distance[j], low), high) - low)
            for end in range(2):
                t, plane = (low, enter) if end == 0 else (high, leave)
                inside, nearest = 0.0, 1.0
                for j in range(crossed[i], crossed[i + 1]):
                    nearest = min(nearest, abs(distance[j] - t))
                    if distance[j] > t:
                        inside += sign[j]
                slant = abs(speeds[bundle[i], plane])
                x = mixed(row(points, i), 1.0, row(directions, bundle[i]), t)
                x = mixed(x, 1.0, row(pivots, plane), -1.0)
                one, two = row(tangents[plane], 0), row(tangents[plane], 1)
                lever = (1.0, -dot(one, x) / scales[plane], -dot(two, x) / scales[plane])
                size, stiffness = inside / max(slant, SLANTED), slant / max(nearest * slant, NEAR)
                for a in range(3):
                    gradient[3 * plane + a] += size * lever[a]
                    for b in range(3):
                        curvature[plane, a, b] += 3.0 * stiffness * lever[a] * lever[b]
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
    shared, _, _ = _shared(planes, np.zeros((n, 3)), lines, np.zeros((n, 2, 3)), np.ones(n))
    return jaccard(shared, 1.0, compound.volume)
