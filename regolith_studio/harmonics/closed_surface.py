"""The one thing that a radius function needs of a mesh: that its triangles close."""

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.mesh import Mesh

Words = NDArray[np.uint64]


def is_closed(mesh: Mesh) -> bool:
    """Whether each edge is run through as often in one direction as in the other.

    Then, and only then, volume, inside and outside have a meaning: every ray from a point meets the
    surface with the same sum of signs. Corners at equal coordinates count as one, so that seams do not
    matter. The edges, as words that change sign with direction, are added up modulo 2^64: an open mesh
    passes with a chance of 5e-20.
    """
    corner = _vertex_words(mesh)[mesh.faces]
    start, end = corner, np.roll(corner, -1, axis=1)
    forward = start < end
    low, high = np.where(forward, start, end), np.where(forward, end, start)
    word = _mixed(low + _mixed(high))
    word[start == end] = 0
    total = np.where(forward, word, ~word + np.uint64(1)).sum(dtype=np.uint64)
    return bool(total == 0)


def checked_solid(mesh: Mesh) -> Mesh:
    """The mesh itself, if it is closed and encloses a positive volume.

    Raises
    ------
    GeometryError
        If it is open, flat or inside out.
    """
    if len(mesh.faces) < 4:
        raise GeometryError(f"A particle needs at least four triangles, this mesh has {len(mesh.faces)}.")
    if not is_closed(mesh):
        raise GeometryError("The mesh is open or its triangles are not wound alike: repair it first.")
    size = float(np.ptp(mesh.bounds, axis=0).max())
    if not mesh.volume > 1e-12 * size**3:
        state = "is inside out" if mesh.volume < -1e-12 * size**3 else "encloses no volume"
        raise GeometryError(f"The mesh {state}: its signed volume is {mesh.volume:.3g}.")
    return mesh


def _vertex_words(mesh: Mesh) -> Words:
    """A word for each vertex, equal for equal coordinates, shape (n,)."""
    bits = (mesh.vertices + 0.0).view(np.uint64)
    return _mixed(bits[:, 0] + _mixed(bits[:, 1] + _mixed(bits[:, 2])))


def _mixed(words: Words) -> Words:
    """The finaliser of SplitMix64 (Steele, Lea and Flood 2014): a bijection that scatters all bits."""
    mixed = words + np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return mixed ^ (mixed >> np.uint64(31))
