"""Overlap depth of particles: the minimum translation that separates two convex polyhedra."""

import numpy as np
from scipy.spatial import ConvexHull, cKDTree
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.initial_packing import enclosing_radii
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray

PARALLEL = 1e-9
"""Edges with a smaller cross product of unit directions are parallel."""


def overlap_depths(prepared: PreparedCase, particles: ParticleState) -> FloatArray:
    """Depth of every pair of particles that overlap, in metres, shape (m,).

    By the separating axis theorem: the minimum overlap of the projections on the normals of both polyhedra
    and on the cross products of their edges.
    """
    forms = [_normals_and_edges(shape) for shape in prepared.shapes]
    turns = Rotation.from_quat(particles.orientations, scalar_first=True)
    reach, scales = enclosing_radii(prepared), prepared.scales
    pairs = cKDTree(particles.points).query_pairs(2.0 * float(reach.max()), output_type="ndarray")
    apart = np.linalg.norm(particles.points[pairs[:, 0]] - particles.points[pairs[:, 1]], axis=1)
    pairs = pairs[apart < reach[pairs].sum(axis=1)]

    def placed(k: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        kind = int(prepared.class_index[k])
        normals, edges = forms[kind]
        corners = turns[k].apply(prepared.shapes[kind] * scales[k]) + particles.points[k]
        return corners, turns[k].apply(normals), turns[k].apply(edges)

    depths = [depth for a, b in pairs.tolist() if (depth := _depth(placed(a), placed(b))) > 0.0]
    return np.array(depths)


def _normals_and_edges(corners: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit normals of the facets and unit directions of the edges of a hull, each direction once."""
    hull = ConvexHull(corners)
    normals = np.unique(np.round(hull.equations[:, :3], 9), axis=0)
    ends = np.sort(
        np.concatenate([hull.simplices[:, [0, 1]], hull.simplices[:, [1, 2]], hull.simplices[:, [2, 0]]])
    )
    ends = np.unique(ends, axis=0)
    edges = corners[ends[:, 1]] - corners[ends[:, 0]]
    return normals, edges / np.linalg.norm(edges, axis=1)[:, None]


def _depth(
    one: tuple[FloatArray, FloatArray, FloatArray], other: tuple[FloatArray, FloatArray, FloatArray]
) -> float:
    """Of two polyhedra given by vertices, normals and edges; 0 or less if they are separate."""
    rough = _min_overlap(one[0], other[0], np.vstack([one[1], other[1]]))
    if rough <= 0.0:
        return rough
    crossed = np.cross(one[2][:, None, :], other[2][None, :, :]).reshape(-1, 3)
    length = np.linalg.norm(crossed, axis=1)
    crossed = crossed[length > PARALLEL] / length[length > PARALLEL][:, None]
    return min(rough, _min_overlap(one[0], other[0], crossed))


def _min_overlap(one: FloatArray, other: FloatArray, directions: FloatArray) -> float:
    """Of the projections on unit directions, for a translation either way."""
    a, b = one @ directions.T, other @ directions.T
    ways = np.minimum(a.max(axis=0) - b.min(axis=0), b.max(axis=0) - a.min(axis=0))
    return float(ways.min(initial=np.inf))
