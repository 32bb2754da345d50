"""Distances of pairs of particles by the separating axis theorem, many pairs at a time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, cKDTree
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.initial_packing import enclosing_radii
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray, IntArray

PARALLEL = 1e-9
"""Planes are one, and edges parallel, if their unit normals or directions differ by less."""
CHUNK_BYTES = 32_000_000
"""Approximate memory for the pairs that are computed together."""


def overlap_depths(prepared: PreparedCase, particles: ParticleState, rounding: float = 0.0) -> FloatArray:
    """Depth of every pair of particles that overlap, in metres, shape (m,).

    ``rounding``: radius of a ball that is added to every polyhedron, in equivalent diameters. The depth is
    then an upper bound where corners meet corners or edges.
    """
    reach = enclosing_radii(prepared) + rounding * particles.diameters
    depths = -separations(prepared, particles, near_pairs(particles.points, reach), rounding=rounding)
    return np.asarray(depths[depths > 0.0])


def near_pairs(points: FloatArray, reach: FloatArray) -> IntArray:
    """Pairs whose spheres of radius `reach` about `points` overlap, shape (m, 2), each pair once.

    Each pair is found by its larger sphere, so that few large particles cost little among many small ones.
    """
    # Twice its own radius reaches every smaller sphere that it may touch.
    neighbours = cKDTree(points).query_ball_point(points, 2.0 * reach)
    first = np.repeat(np.arange(len(points)), [len(each) for each in neighbours])
    second = np.fromiter((k for each in neighbours for k in each), dtype=np.int64, count=len(first))
    # Equal spheres find each other: the index decides, so that each pair comes once.
    smaller = (reach[second] < reach[first]) | ((reach[second] == reach[first]) & (second < first))
    first, second = first[smaller], second[smaller]
    near = np.linalg.norm(points[first] - points[second], axis=1) < reach[first] + reach[second]
    return np.column_stack([first[near], second[near]])


def separations(
    prepared: PreparedCase,
    particles: ParticleState,
    pairs: IntArray,
    limit: float = 0.0,
    rounding: float = 0.0,
) -> FloatArray:
    """Distance of the particles of each pair, negative where they overlap, in metres, shape (m,).

    The facets of the hull of all differences of the points of two convex bodies are those of both bodies and
    the parallelograms of the pairs of edges whose arcs on the sphere of normals cross (D. Gregorius,
    *The separating axis test between convex polyhedra*, Game Developers Conference 2013). The distance is the
    maximum over these facets: exact for overlaps; a lower bound where corners face corners or edges, and
    where it is above `limit`. Of particles with several convex parts it is that of their nearest parts.

    ``pairs``: indices, shape (m, 2). ``rounding``: radius of a ball that is added to every polyhedron, in
    equivalent diameters.
    """
    radii = rounding * particles.diameters
    if prepared.case.shapes == "spheres":
        radii = radii + particles.diameters / 2
        ways = particles.points[pairs[:, 0]] - particles.points[pairs[:, 1]]
        return np.asarray(np.linalg.norm(ways, axis=1) - radii[pairs].sum(axis=1))
    shapes = prepared.part_vertices
    forms = _Forms.of([part for parts in shapes for part in parts])
    counts = np.array([len(parts) for parts in shapes])
    owner, part_pairs = _pairs_of_parts(prepared.class_index, counts, pairs)
    turns = Rotation.from_quat(particles.orientations, scalar_first=True).as_matrix()
    distances = np.full(len(pairs), np.inf)
    step = max(1, CHUNK_BYTES // forms.bytes_per_pair)
    for start in range(0, len(owner), step):
        own = owner[start : start + step]
        a, b = pairs[own].T
        one, other = (
            forms.placed(part_pairs[start : start + step, side], prepared.scales[k], turns[k])
            for side, k in enumerate((a, b))
        )
        between = particles.points[b] - particles.points[a]
        rounded = radii[a] + radii[b]
        distance = _distances(one, other, between, limit + rounded) - rounded
        np.minimum.at(distances, own, distance)
    return distances


def _pairs_of_parts(class_index: IntArray, counts: IntArray, pairs: IntArray) -> tuple[IntArray, IntArray]:
    """Every part of one particle of a pair with every part of the other: the index of the pair, shape (p,),
    and the indices of both parts among those of all shapes, shape (p, 2)."""
    a, b = class_index[pairs[:, 0]], class_index[pairs[:, 1]]
    total = counts[a] * counts[b]
    owner = np.repeat(np.arange(len(pairs)), total)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(total) - total, total)
    first = np.cumsum(counts) - counts
    parts = first[a][owner] + place // counts[b][owner], first[b][owner] + place % counts[b][owner]
    return owner, np.column_stack(parts)


@dataclass(frozen=True, eq=False)
class _Forms:
    """Convex bodies in arrays of one size: shorter ones repeat their last entry, which changes no maximum.

    - ``vertices``: shape (..., v, 3).
    - ``normals``, ``offsets``: of the planes, outwards, shapes (..., f, 3) and (..., f).
    - ``starts``, ``edges``, ``left``, ``right``: one end of each edge, its unit direction, and the normals
      of the facets on both sides, shape (..., e, 3) each.
    """

    vertices: FloatArray
    normals: FloatArray
    offsets: FloatArray
    starts: FloatArray
    edges: FloatArray
    left: FloatArray
    right: FloatArray

    @classmethod
    def of(cls, bodies: Sequence[FloatArray]) -> "_Forms":
        """The hulls of vertices, each of shape (k, 3)."""
        rows = [_hull_arrays(each) for each in bodies]
        return cls(*(_padded(column) for column in zip(*rows, strict=True)))

    @property
    def bytes_per_pair(self) -> int:
        v, f, e = (each.shape[1] for each in (self.vertices, self.normals, self.edges))
        # The matrices of `_edge_distances` and `_distances`, and the vectors of the edges.
        return int(8 * (6 * e * e + 4 * v * f + 12 * e))

    def placed(self, bodies: IntArray, scales: FloatArray, turns: FloatArray) -> "_Forms":
        """Bodies that are scaled and turned, one for each of `bodies`."""
        sizes = scales[:, None, None]

        def turned(ways: FloatArray) -> FloatArray:
            return np.asarray(ways[bodies] @ turns.transpose(0, 2, 1))

        return _Forms(
            sizes * turned(self.vertices),
            turned(self.normals),
            scales[:, None] * self.offsets[bodies],
            sizes * turned(self.starts),
            turned(self.edges),
            turned(self.left),
            turned(self.right),
        )

    def chosen(self, which: IntArray) -> "_Forms":
        """Some of the bodies."""
        return _Forms(*(getattr(self, name)[which] for name in self.__dataclass_fields__))


def _hull_arrays(corners: FloatArray) -> tuple[FloatArray, ...]:
    """The arrays of :class:`_Forms` of one body; edges within a facet are left out."""
    hull = ConvexHull(corners)
    # Qhull gives a facet of k corners as k - 2 triangles with equations that differ in the last bits.
    planes = np.unique(np.round(hull.equations, 9), axis=0)
    face, opposite = np.nonzero(hull.neighbors > np.arange(len(hull.simplices))[:, None])
    beside = hull.neighbors[face, opposite]
    ends = hull.simplices[face[:, None], (opposite[:, None] + np.array([1, 2])) % 3]
    left, right = hull.equations[face, :3], hull.equations[beside, :3]
    # An edge within a facet has no arc on the sphere of normals.
    real = np.linalg.norm(left - right, axis=1) > PARALLEL
    starts = corners[ends[real, 0]]
    ways = corners[ends[real, 1]] - starts
    edges = ways / np.linalg.norm(ways, axis=1)[:, None]
    return corners[hull.vertices], planes[:, :3], -planes[:, 3], starts, edges, left[real], right[real]


def _padded(arrays: Sequence[FloatArray]) -> FloatArray:
    longest = max(map(len, arrays))
    rows = [np.concatenate([each, np.repeat(each[-1:], longest - len(each), axis=0)]) for each in arrays]
    return np.array(rows)


def _distances(one: _Forms, other: _Forms, between: FloatArray, limits: FloatArray) -> FloatArray:
    """Of pairs of bodies, the second of each `between` away from the first; lower bounds above `limits`."""
    ways = between[:, :, None]
    ahead = (one.normals @ ways)[..., 0] - one.offsets
    ahead += (one.normals @ other.vertices.transpose(0, 2, 1)).min(axis=2)
    behind = -(other.normals @ ways)[..., 0] - other.offsets
    behind += (other.normals @ one.vertices.transpose(0, 2, 1)).min(axis=2)
    gaps: FloatArray = np.maximum(ahead.max(axis=1), behind.max(axis=1))
    # Facets alone part most pairs; the pairs of edges cost the square of their number.
    close = np.flatnonzero(gaps <= limits)
    which, distance = _edge_distances(one.chosen(close), other.chosen(close), between[close])
    np.maximum.at(gaps, close[which], distance)
    return gaps


def _edge_distances(one: _Forms, other: _Forms, between: FloatArray) -> tuple[IntArray, FloatArray]:
    """Distances along the normals of the pairs of edges that form a facet of the hull of differences.

    Returns the index of the bodies, shape (p,), and the distances, shape (p,).
    """
    arc, other_arc = np.cross(one.right, one.left), np.cross(other.right, other.left)
    a, b = one.left, one.right
    c, d = -other.left.transpose(0, 2, 1), -other.right.transpose(0, 2, 1)
    across_c, across_d = arc @ c, arc @ d
    across_a, across_b = (each @ other_arc.transpose(0, 2, 1) for each in (a, b))
    # Both arcs cross, and on the same side of the sphere: the third condition excludes antipodes.
    crossing = (across_c * across_d < 0.0) & (across_a * across_b < 0.0) & (across_c * across_b > 0.0)
    which, i, j = np.nonzero(crossing)
    normals = np.cross(one.edges[which, i], other.edges[which, j])
    lengths = np.linalg.norm(normals, axis=1)
    outwards = np.einsum("pi,pi->p", normals, a[which, i] + b[which, i])
    gaps = other.starts[which, j] + between[which] - one.starts[which, i]
    # The cross product of two edges may point into the first body.
    distance = np.einsum("pi,pi->p", normals, gaps) * np.sign(outwards)
    # Parallel edges span no facet.
    return which, np.where(lengths > PARALLEL, distance / np.maximum(lengths, PARALLEL), -np.inf)
