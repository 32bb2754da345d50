"""Descriptors of half-spaces by scipy and brute force; shares no code with the program.

The box is searched over all edges of the hull (O'Rourke 1985): the normal of one side runs over the arc
between the normals of the two facets of an edge, in steps of `step` degrees, and the directions of all
edges are tried in the plane; every minimum within 3 % of the least is refined by scipy's bounded scalar
minimisation.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.spatial import ConvexHull, HalfspaceIntersection

Array = NDArray[np.float64]


def measured(normals: Array, offsets: Array, step: float = 0.5) -> dict[str, float]:
    """V, A, S, D_min, D_max, AR of the polyhedron <n_i, x> <= h_i."""
    size = float(np.max(offsets))
    corners = HalfspaceIntersection(np.c_[normals, -offsets / size], np.zeros(3)).intersections
    hull = ConvexHull(corners)
    extents = size * least_box(hull, step)
    volume, area = hull.volume * size**3, hull.area * size**2
    return {
        "volume": volume,
        "sphericity": np.pi ** (1 / 3) * (6 * volume) ** (2 / 3) / area,
        "min_diameter": extents.min(),
        "max_diameter": extents.max(),
        "aspect_ratio": extents.max() / extents.min(),
        "convex_hull_volume": volume,
    }


def least_box(hull: ConvexHull, step: float) -> Array:
    """Edge lengths of the least box around a hull, shape (3,)."""
    points = hull.points[hull.vertices]
    normals = hull.equations[:, :3]
    arcs, directions = [], []
    for facet, neighbours in enumerate(hull.neighbors):
        for corner, other in enumerate(neighbours):
            if other < facet:
                continue
            ends = np.delete(hull.simplices[facet], corner)
            edge = hull.points[ends[1]] - hull.points[ends[0]]
            if np.linalg.norm(np.cross(normals[facet], normals[other])) > 1e-9:
                arcs.append((normals[facet], normals[other]))
                directions.append(edge / np.linalg.norm(edge))
    edges = np.array(directions)

    def extents(axis: Array) -> Array:
        flat = edges - np.outer(edges @ axis, axis)
        long = np.linalg.norm(flat, axis=1)
        along = flat[long > 1e-9] / long[long > 1e-9, None]
        across = np.cross(axis, along)
        height = np.ptp(points @ axis)
        wide, deep = np.ptp(points @ along.T, axis=0), np.ptp(points @ across.T, axis=0)
        best = int(np.argmin(wide * deep))
        return np.array([height, wide[best], deep[best]])

    def turned(arc: tuple[Array, Array], t: float) -> Array:
        one, two = arc
        across = two - one * (one @ two)
        across /= np.linalg.norm(across)
        return np.asarray(np.cos(t) * one + np.sin(t) * across)

    found = []
    for arc in arcs:
        angle = float(np.arccos(np.clip(arc[0] @ arc[1], -1, 1)))
        grid = np.linspace(0.0, angle, max(3, int(np.ceil(np.degrees(angle) / step)) + 1))
        volumes = [float(np.prod(extents(turned(arc, t)))) for t in grid]
        for k, volume in enumerate(volumes):
            before, after = max(k - 1, 0), min(k + 1, len(grid) - 1)
            if volume <= min(volumes[before], volumes[after]):
                found.append((volume, arc, grid[before], grid[after], grid[k]))
    found.sort(key=lambda item: item[0])
    best, answer = np.inf, np.zeros(3)
    for volume, arc, low, high, at in found:
        if volume > 1.03 * found[0][0]:
            break
        refined = minimize_scalar(
            lambda t, arc=arc: float(np.prod(extents(turned(arc, t)))),
            bounds=(low, high),
            method="bounded",
            options={"xatol": 1e-12},
        )
        for t in (refined.x, at):
            box = extents(turned(arc, t))
            if np.prod(box) < best:
                best, answer = float(np.prod(box)), box
    return answer
