"""The paper's loss and its annealing as one writes them down with scipy and trimesh.

Two ways to measure a polyhedron, neither slow on purpose: one makes a mesh of it and asks it by the same
functions as the particle, trimesh's volume, area, hull and box; ``lean`` knows that it is convex, takes
volume and area from scipy's hull and asks trimesh for the box alone. Three ways to the IoU: none, the boolean
of two meshes by manifold3d (exact), or a fixed cloud of 4,000 points in the particle's bounding box (an error
of some per cent). Two boxes: trimesh's heuristic, which is no minimum, and with ``exact`` that of O'Rourke in
steps of 1 degree.
"""

from importlib.util import find_spec

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from benchmarks.independent import least_box

KEYS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio", "convex_hull_volume")
CLOUD = 4000
HAS_BOOLEANS = find_spec("manifold3d") is not None
"""Whether trimesh can intersect two meshes."""
Array = NDArray[np.float64]


class PlainLoss:
    """Eq. 9 with all weights 1, as a function of the foot points of the half-spaces.

    Parameters
    ----------
    vertices, faces
        The particle.
    overlap
        ``none``, ``points`` or ``boolean``.
    lean
        Whether scipy's hull measures volume and area.
    exact
        Whether the polyhedron's box is the least one; the particle's own stays trimesh's.
    """

    def __init__(
        self,
        vertices: Array,
        faces: NDArray[np.int64],
        overlap: str = "none",
        lean: bool = False,
        exact: bool = False,
    ) -> None:
        self._mesh = trimesh.Trimesh(vertices, faces)
        self._overlap, self._lean, self._exact = overlap, lean, exact
        mesh = self._mesh
        _, box = trimesh.bounds.oriented_bounds(mesh)
        self._wanted = described(mesh.volume, mesh.area, box, mesh.convex_hull.volume)
        if overlap == "points":
            rng = np.random.default_rng(0)
            low, high = mesh.bounds
            self._cloud = rng.uniform(low, high, (CLOUD, 3))
            self._inside = mesh.contains(self._cloud)

    def __call__(self, points: Array) -> float:
        offsets = np.linalg.norm(points, axis=1)
        normals = points / offsets[:, None]
        try:
            with np.errstate(divide="ignore", invalid="ignore"):  # an open polyhedron has corners at infinity
                corners = HalfspaceIntersection(np.c_[normals, -offsets], np.zeros(3)).intersections
            if not np.isfinite(corners).all():
                return np.inf
            if self._lean:
                mesh, hull = None, ConvexHull(corners)
                volume, area, hull_volume = hull.volume, hull.area, hull.volume
            else:
                mesh = trimesh.convex.convex_hull(corners)
                volume, area, hull_volume = mesh.volume, mesh.area, mesh.convex_hull.volume
        except QhullError:
            return np.inf
        if self._exact:
            box = least_box(ConvexHull(corners), 1.0)
        else:
            _, box = trimesh.bounds.oriented_bounds(corners if mesh is None else mesh)
        found = described(volume, area, np.asarray(box), hull_volume)
        loss = sum(abs(found[key] - self._wanted[key]) / self._wanted[key] for key in KEYS)
        if self._overlap != "none":
            loss += 1.0 - self._shared_share(corners, normals, offsets, mesh, volume)
        return float(loss)

    def _shared_share(
        self, corners: Array, normals: Array, offsets: Array, mesh: trimesh.Trimesh | None, volume: float
    ) -> float:
        """Intersection over union."""
        if self._overlap == "points":
            within = (self._cloud @ normals.T <= offsets).all(axis=1)
            return np.count_nonzero(within & self._inside) / np.count_nonzero(within | self._inside)
        solid = trimesh.convex.convex_hull(corners) if mesh is None else mesh
        shared = trimesh.boolean.intersection([self._mesh, solid], check_volume=False).volume
        return float(shared / (volume + self._mesh.volume - shared))


def described(volume: float, area: float, box: Array, hull_volume: float) -> dict[str, float]:
    """The descriptors of Eq. 8 from what they are made of."""
    edges = np.sort(box)
    return {
        "volume": volume,
        "sphericity": np.pi ** (1 / 3) * (6 * volume) ** (2 / 3) / area,
        "min_diameter": edges[0],
        "max_diameter": edges[-1],
        "aspect_ratio": edges[-1] / edges[0],
        "convex_hull_volume": hull_volume,
    }


def plain_annealing(loss: PlainLoss, start: Array, seed: int) -> Array:
    """Section 2.4 as printed, from the foot points of the decimated hull's planes."""
    rng = np.random.default_rng(seed)
    points = start * (1 + 1e-7 * rng.random((len(start), 1)))
    now = loss(points)
    for k in range(1, 101):
        proposal = points.copy()
        i = rng.integers(len(points))
        proposal[i] = rng.normal(points[i], np.linalg.norm(points, axis=1).mean())
        then = loss(proposal)
        if then < now or (np.isfinite(then) and rng.random() < 0.2 * 0.9**k):
            points, now = proposal, then
    return points
