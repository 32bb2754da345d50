"""What the triangles of a mesh say by their indices alone, wherever their corners lie."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from regolith_studio.geometry.arrays import IntArray
from regolith_studio.geometry.edges import Bodies, EdgeTable, bodies, edge_table, neighbours

MOST_REMEMBERED = 100_000
"""Meshes with more faces are worked out anew each time."""


@dataclass(frozen=True, eq=False)
class Connectivity:
    """How m triangles hang together; its arrays are locked, because it may be shared.

    Parameters
    ----------
    table
        Their edges.
    across
        For each half-edge the one across an edge of exactly two triangles, else -1; shape (3 m,).
    parts
        The bodies that they form.
    vertices_used
        Number of vertices that a face uses.
    duplicate_faces
        Triangles on the same three vertices as one before.
    """

    table: EdgeTable
    across: IntArray
    parts: Bodies
    vertices_used: int
    duplicate_faces: int

    @classmethod
    def of(cls, faces: IntArray, n_vertices: int) -> "Connectivity":
        """Of triangles, shape (m, 3); what was asked last is remembered.

        Synthesised particles all have the faces of one sphere: only the first of them costs anything.
        """
        if len(faces) > MOST_REMEMBERED:
            return _worked_out(faces, n_vertices)
        return _remembered(np.ascontiguousarray(faces, dtype=np.int64).tobytes(), n_vertices)

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


@lru_cache(maxsize=2)
def _remembered(content: bytes, n_vertices: int) -> Connectivity:
    return _worked_out(np.frombuffer(content, dtype=np.int64).reshape(-1, 3), n_vertices)


def _worked_out(faces: IntArray, n_vertices: int) -> Connectivity:
    table = edge_table(faces, n_vertices)
    across = neighbours(table)
    parts = bodies(across, table.forward)
    for array in (table.ends, table.uses, table.edge, table.forward, across, parts.body, parts.turned):
        array.flags.writeable = False
    duplicates = len(faces) - len(np.unique(np.sort(faces, axis=1), axis=0))
    return Connectivity(table, across, parts, len(np.unique(faces)), duplicates)
