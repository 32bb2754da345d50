"""Topology of a triangular mesh: edges, neighbours, connected bodies and orientation, from indices alone."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import int64
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel


@dataclass(frozen=True)
class EdgeTable:
    """The undirected edges of m triangles; half-edge 3 f + k runs from corner k of face f to the next.

    - ``ends``: vertices of each edge, the lower index first, shape (e, 2).
    - ``uses``: number of triangles at each edge, shape (e,).
    - ``edge``: edge of each half-edge, shape (3 m,).
    - ``forward``: whether each half-edge runs from the lower index to the higher, shape (3 m,).
    """

    ends: IntArray
    uses: IntArray
    edge: IntArray
    forward: BoolArray

    @property
    def open_edges(self) -> int:
        """Number of edges of one triangle only."""
        return int(np.count_nonzero(self.uses == 1))

    @property
    def non_manifold_edges(self) -> int:
        """Number of edges of three triangles or more (non-manifold)."""
        return int(np.count_nonzero(self.uses > 2))


def edge_table(faces: IntArray, n_vertices: int) -> EdgeTable:
    """The edges of triangles, shape (m, 3); an edge from a vertex to itself counts as one."""
    start, stop = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    low, high = np.minimum(start, stop), np.maximum(start, stop)
    keys, edge, uses = np.unique(low * n_vertices + high, return_inverse=True, return_counts=True)
    ends = np.column_stack([keys // max(n_vertices, 1), keys % max(n_vertices, 1)])
    return EdgeTable(ends, uses.astype(np.int64), edge.astype(np.int64), start < stop)


def neighbours(table: EdgeTable) -> IntArray:
    """For each half-edge the one across an edge of exactly two triangles, else -1; shape (3 m,)."""
    across = np.full(len(table.edge), -1, dtype=np.int64)
    order = np.argsort(table.edge, kind="stable")
    first = np.cumsum(table.uses) - table.uses
    pairs = first[table.uses == 2]
    across[order[pairs]], across[order[pairs + 1]] = order[pairs + 1], order[pairs]
    return across


@dataclass(frozen=True)
class MeshBodies:
    """Triangles connected across edges.

    - ``body``: index of each triangle's body, shape (m,), from 0.
    - ``turned``: whether a triangle must be turned round to agree with the first of its body, shape (m,).
    - ``conflicts``: number of edges across which no turning can bring agreement (one-sided surfaces).
    """

    body: IntArray
    turned: BoolArray
    conflicts: int

    @property
    def count(self) -> int:
        """Number of bodies."""
        return int(self.body.max()) + 1 if len(self.body) else 0


def find_bodies(across: IntArray, forward: BoolArray) -> MeshBodies:
    """Walk from triangle to triangle over the `across` of all half-edges."""
    body, turned = np.full(len(across) // 3, -1), np.zeros(len(across) // 3, dtype=np.bool_)
    conflicts = label_bodies(across, forward, body, turned)
    return MeshBodies(body, turned, int(conflicts))


@kernel
def label_bodies(across: IntArray, forward: BoolArray, body: IntArray, turned: BoolArray) -> int:
    """Fill body (-1 before) and turn of each triangle by a flood fill; the number of contradictions."""
    m = len(across) // 3
    queue = np.empty(m, dtype=np.int64)
    count = int64(0)
    conflicts = int64(0)
    for seed in range(m):
        if body[seed] >= 0:
            continue
        body[seed] = count
        queue[0] = seed
        head, tail = 0, 1
        while head < tail:
            face = queue[head]
            head += 1
            for half in range(3 * face, 3 * face + 3):
                other = across[half]
                if other < 0:
                    continue
                neighbour = other // 3
                turn = turned[face] ^ (forward[half] == forward[other])
                if body[neighbour] < 0:
                    body[neighbour] = count
                    turned[neighbour] = turn
                    queue[tail] = neighbour
                    tail += 1
                elif turned[neighbour] != turn:
                    conflicts += 1
        count += 1
    # Each contradiction is met from both of its triangles.
    return conflicts // 2  # type: ignore[return-value]


def pinched_corners(faces: IntArray, table: EdgeTable) -> int:
    """How many corners a closed mesh lacks because parts of its surface touch in a point and share it."""
    start, half = faces.ravel(), np.arange(faces.size)
    stop = half - half % 3 + (half + 1) % 3
    across = neighbours(table)
    here, there = half[across >= 0], across[across >= 0]
    same = start[here] == start[there]
    joined = np.concatenate([np.where(same, there, stop[there]), np.where(same, stop[there], there)])
    links = (np.ones(len(joined), dtype=np.int8), (np.concatenate([here, stop[here]]), joined))
    fans = connected_components(coo_array(links, shape=(faces.size, faces.size)), directed=False)[0]
    return int(fans - len(np.unique(start)))


MAX_CACHED_FACES = 100_000
"""Larger meshes are not cached."""


@dataclass(frozen=True, eq=False)
class Connectivity:
    """How m triangles are connected; its arrays are read-only, because it may be shared.

    - ``table``: their edges.
    - ``across``: for each half-edge the one across an edge of exactly two triangles, else -1; shape (3 m,).
    - ``parts``: the bodies that they form.
    - ``vertices_used``: number of vertices that a face uses.
    - ``duplicate_faces``: triangles on the same three vertices as one before.
    """

    table: EdgeTable
    across: IntArray
    parts: MeshBodies
    vertices_used: int
    duplicate_faces: int

    @classmethod
    def of(cls, faces: IntArray, n_vertices: int) -> "Connectivity":
        """Of triangles, shape (m, 3); the last results are cached.

        Synthesised particles all have the faces of one sphere: only the first of them costs anything.
        """
        if len(faces) > MAX_CACHED_FACES:
            return _compute(faces, n_vertices)
        return _cached(np.ascontiguousarray(faces, dtype=np.int64).tobytes(), n_vertices)

    @property
    def closed(self) -> bool:
        """Whether every edge belongs to exactly two triangles."""
        return bool(len(self.table.uses)) and bool((self.table.uses == 2).all())

    @property
    def agrees(self) -> bool:
        """Whether triangles run the opposite way along the edges that two of them share."""
        paired = self.across >= 0
        forward = self.table.forward
        return bool(len(paired)) and not (forward[paired] == forward[self.across[paired]]).any()


def genus(faces: IntArray, n_vertices: int) -> int:
    """Tunnels (handles) of closed bodies, by Euler's formula; 0 where the surface is open."""
    found = Connectivity.of(faces, n_vertices)
    if not found.closed:
        return 0
    euler = found.vertices_used - len(found.table.ends) + len(faces) + pinched_corners(faces, found.table)
    return max(0, found.parts.count - euler // 2)


@lru_cache(maxsize=2)
def _cached(content: bytes, n_vertices: int) -> Connectivity:
    return _compute(np.frombuffer(content, dtype=np.int64).reshape(-1, 3), n_vertices)


def _compute(faces: IntArray, n_vertices: int) -> Connectivity:
    table = edge_table(faces, n_vertices)
    across = neighbours(table)
    parts = find_bodies(across, table.forward)
    for array in (table.ends, table.uses, table.edge, table.forward, across, parts.body, parts.turned):
        array.flags.writeable = False
    duplicates = len(faces) - len(np.unique(np.sort(faces, axis=1), axis=0))
    return Connectivity(table, across, parts, len(np.unique(faces)), duplicates)


def merged_vertices(
    vertices: FloatArray, faces: IntArray, tolerance: float = 0.0
) -> tuple[FloatArray, IntArray]:
    """Mesh data in which vertices no farther apart than `tolerance` are one.

    Chains of near vertices become one too; each group keeps the place of its first vertex.
    Vertices that no face uses are left out.
    """
    used, compact = np.unique(faces, return_inverse=True)
    points = vertices[used]
    group = _equal(points) if tolerance == 0.0 else _near(points, tolerance)
    _, first, inverse = np.unique(group, return_index=True, return_inverse=True)
    return points[first], inverse[compact].reshape(-1, 3).astype(np.int64)


def _equal(points: FloatArray) -> IntArray:
    """For each point the index of the first one at exactly the same place."""
    order = np.lexsort(points.T)
    ordered = points[order]
    new = np.ones(len(points), dtype=np.bool_)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    number = np.cumsum(new) - 1
    group = np.empty(len(points), dtype=np.int64)
    group[order] = order[new][number] if len(points) else number
    return group


def _near(points: FloatArray, tolerance: float) -> IntArray:
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(points),) * 2)
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)
