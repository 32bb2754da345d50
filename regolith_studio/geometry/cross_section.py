"""What a plane cuts out of a closed surface: the outline and its area."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class CrossSection:
    """The outline where a plane meets a closed surface; may have several loops, or none.

    - ``normal``: unit normal of the plane <n, x> = `offset`, shape (3,).
    - ``points``: where edges pass the plane, shape (p, 3).
    - ``segments``: start and end of each piece of outline as indices of `points`, shape (k, 2); the inside
      lies on the left, seen with the normal towards the eye.
    """

    normal: FloatArray
    offset: float
    points: FloatArray
    segments: IntArray

    @property
    def area(self) -> float:
        """Enclosed area, by Green's theorem; holes count as holes."""
        if not len(self.segments):
            return 0.0
        # About the middle: the areas of triangles with a far origin are large and cancel.
        middle = self.points.mean(axis=0)
        start, end = (self.points[self.segments[:, side]] - middle for side in (0, 1))
        return float(np.cross(start, end).sum(axis=0) @ self.normal) / 2

    @property
    def length(self) -> float:
        """Length of the outline."""
        start, end = (self.points[self.segments[:, side]] for side in (0, 1))
        return float(np.linalg.norm(end - start, axis=1).sum())

    def flat(self) -> FloatArray:
        """The points in the axes of :func:`plane_axes`, shape (p, 2)."""
        return np.asarray(self.points @ np.stack(plane_axes(self.normal)).T)

    def loops(self) -> list[list[int]]:
        """Indices of `points` around each loop, the first one again at the end."""
        leaving: dict[int, list[int]] = {}
        for start, end in self.segments.tolist():
            leaving.setdefault(start, []).append(end)
        loops: list[list[int]] = []
        while leaving:
            loop = [next(iter(leaving))]
            while ends := leaving.get(loop[-1]):
                here = loop[-1]
                loop.append(ends.pop())
                if not ends:
                    del leaving[here]
            loops.append(loop)
        return loops

    def outline(self) -> FloatArray:
        """The loops in the axes of :func:`plane_axes`, separated by rows of NaN, shape (m, 2)."""
        flat, gap = self.flat(), np.full((1, 2), np.nan)
        parts = [part for loop in self.loops() for part in (flat[loop], gap)]
        return np.vstack(parts[:-1]) if parts else np.empty((0, 2))


def cross_section(mesh: Mesh, normal: ArrayLike, offset: float) -> CrossSection:
    """Cut a closed, outward oriented mesh by the plane <n, x> = `offset`; `normal` need not have length 1.

    A vertex on the plane counts as lying above it, so that every loop closes.

    Raises ValueError if the normal vanishes.
    """
    unit = np.asarray(normal, dtype=np.float64)
    length = float(np.linalg.norm(unit))
    if not length > 0.0:
        raise ValueError("the normal of a plane must not vanish")
    unit = unit / length
    height = mesh.vertices @ unit - offset / length
    above = height >= 0.0
    faces = mesh.faces[_mixed(above[mesh.faces])]
    falling, rising = _crossed_edges(faces, above)
    edges, place = np.unique(np.sort(np.vstack([falling, rising]), axis=1), axis=0, return_inverse=True)
    low, high = height[edges[:, 0]], height[edges[:, 1]]
    share = (low / (low - high))[:, None]
    points = (1.0 - share) * mesh.vertices[edges[:, 0]] + share * mesh.vertices[edges[:, 1]]
    segments = np.asarray(place, dtype=np.int64).reshape(2, len(faces)).T
    return CrossSection(unit, offset / length, points, segments)


def plane_axes(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors that span a plane and make a right-handed frame with its unit normal.

    The second is as near to z as can be, as if seen from the side; to y where the normal is z.
    """
    up = np.array([0.0, 0.0, 1.0]) if abs(normal[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    across = np.cross(up, normal)
    across /= np.linalg.norm(across)
    return across, np.cross(normal, across)


def _mixed(above: BoolArray) -> IntArray:
    """Rows with corners on both sides."""
    return np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))


def _crossed_edges(faces: IntArray, above: BoolArray) -> tuple[IntArray, IntArray]:
    """The edge of each face that goes down through the plane, and the one that comes up.

    Seen from outside with the normal up, a face's boundary goes counter-clockwise; the outline runs from
    where it falls to where it rises.
    """
    following = np.roll(faces, -1, axis=1)
    falls = above[faces] & ~above[following]
    rises = ~above[faces] & above[following]
    rows = np.arange(len(faces))
    down, up = falls.argmax(axis=1), rises.argmax(axis=1)
    falling = np.stack([faces[rows, down], following[rows, down]], axis=1)
    rising = np.stack([faces[rows, up], following[rows, up]], axis=1)
    return falling, rising
