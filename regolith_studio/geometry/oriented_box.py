"""Oriented bounding boxes of minimum volume, exact in the sense of O'Rourke; and trimesh's heuristic box."""

from contextlib import suppress
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh, bounds_of
from regolith_studio.geometry.minimum_box import TooManyCurvesError, minimum_box
from regolith_studio.geometry.minimum_box.hull_topology import Facets, facets_of_hull
from regolith_studio.geometry.sphere_points import fibonacci_directions

JITTER = 1e-10
WELD = 1e-8
"""Vertices of a hull of size 1 that are closer are one for the search."""
# The search takes some 0.1 ms times the square of the turn: up to 1.4 s, and 9 s where a box is known.
MAX_VERTICES, MAX_TURN, MAX_KNOWN_TURN = 10_000, 120.0, 300.0
"""Hulls with more vertices, or more curves of boxes, are thinned for the search; of more curves than the
last, where the box of a thinned hull is known, not all are searched."""
FIRST_CELL = 0.02
"""Cells of a hull of size 1 that is thinned; they grow until the search is short enough."""


@dataclass(frozen=True, eq=False)
class OrientedBox(LockedRecord):
    """A box in any orientation.

    - ``centre``: shape (3,).
    - ``axes``: unit vectors along the edges, one a row, right-handed, shape (3, 3).
    - ``extents``: edge lengths along `axes`, longest first, shape (3,).

    Raises ValueError if a shape is wrong, the axes are not orthonormal or the extents are not sorted.
    """

    centre: FloatArray
    axes: FloatArray
    extents: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", locked_floats(self.centre, (3,), "centre"))
        object.__setattr__(self, "axes", locked_floats(self.axes, (3, 3), "axes"))
        object.__setattr__(self, "extents", locked_floats(self.extents, (3,), "extents"))
        if np.abs(self.axes @ self.axes.T - np.eye(3)).max() > 1e-9:
            raise ValueError("axes must be orthonormal")
        if not self.extents[0] >= self.extents[1] >= self.extents[2] >= 0.0:
            raise ValueError(f"extents must fall and not be negative, got {self.extents}")

    @property
    def volume(self) -> float:
        """Product of the extents."""
        return float(np.prod(self.extents))

    @property
    def max_diameter(self) -> float:
        """D_max of section 2.2: the longest edge."""
        return float(self.extents[0])

    @property
    def intermediate_diameter(self) -> float:
        """The edge between the longest and the shortest."""
        return float(self.extents[1])

    @property
    def min_diameter(self) -> float:
        """D_min of section 2.2: the shortest edge."""
        return float(self.extents[2])

    @property
    def corners(self) -> FloatArray:
        """The eight corners, shape (8, 3)."""
        signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
        return np.asarray(self.centre + (signs * self.extents) @ self.axes)


_of_meshes: WeakKeyDictionary[Mesh, OrientedBox] = WeakKeyDictionary()


def minimum_volume_box(solid: Mesh | ConvexPolyhedron) -> OrientedBox:
    """The oriented bounding box of least volume.

    Found by the branch and bound of :mod:`regolith_studio.geometry.minimum_box` (O'Rourke 1985: two
    adjacent sides are flush with edges of the hull), and independent of unit and orientation. Of boxes that
    tie in volume, the one with the smallest sum of edges is taken. The box of a mesh is kept with it.

    Of fine balls, cones and cylinders, whose edges cannot be ruled out, no box with a side on a facet is
    smaller, but one flush with two edges may be. Hulls of more than `MAX_VERTICES` vertices are thinned: the
    box holds the whole hull; its volume is above the minimum by at most the share by which it is above that
    of the thinned hull's.

    Raises GeometryError if the vertices lie in one plane.
    """
    # Views draw the box again and again: that of 327,680 triangles takes 4 s.
    known = _of_meshes.get(solid) if isinstance(solid, Mesh) else None
    box = known or _searched(solid)
    if isinstance(solid, Mesh):
        _of_meshes[solid] = box
    return box


def heuristic_box(solid: Mesh | ConvexPolyhedron) -> OrientedBox:
    """``trimesh.bounds.oriented_bounds`` of the solid, centred and scaled to size 1 first.

    For comparison only: the box of the paper's program. Its volume is up to 29 % above the minimum, and its
    edges change by up to 23 % when the particle is turned, because it projects only one end of each
    silhouette edge.

    Raises GeometryError if the vertices lie in one plane.
    """
    from trimesh.bounds import oriented_bounds

    hull = solid.mesh.hull if isinstance(solid, ConvexPolyhedron) else solid.hull
    low, high = hull.bounds
    size = float((high - low).max())
    middle = (low + high) / 2
    try:
        # trimesh has absolute tolerances: without scaling 12 % of particles in units from 1e-6 to 1e3 came
        # out wrong.
        to_box, extents = oriented_bounds((hull.vertices - middle) / size)  # type: ignore[no-untyped-call]
    except (ValueError, IndexError) as error:
        raise GeometryError("The mesh is too small or too flat for trimesh's bounding box.") from error
    order = np.argsort(-extents, kind="stable")
    axes = np.asarray(to_box[:3, :3], dtype=np.float64)
    # The transform x -> R x + t takes the centre to the origin, so that it lies at - R' t.
    centre = middle - size * axes.T @ to_box[:3, 3]
    turned = axes[order]
    turned[2] = np.cross(turned[0], turned[1])
    return OrientedBox(centre, turned, np.asarray(extents, dtype=np.float64)[order] * size)


def _searched(solid: Mesh | ConvexPolyhedron) -> OrientedBox:
    hull = solid.mesh if isinstance(solid, ConvexPolyhedron) else solid.hull
    low, high = hull.bounds
    size = float((high - low).max())
    if not size > 0.0:
        raise GeometryError("The mesh is a single point and has no bounding box.")
    middle = (low + high) / 2
    points = (hull.vertices - middle) / size
    axes = _axes_of_box(*_welded(points, hull.faces))
    low_ends, high_ends = bounds_of(points @ axes.T)
    axes = _right_handed(axes[np.argsort(low_ends - high_ends, kind="stable")])
    # Measured again, since the third axis is a cross product now; of edges that tie, rounding may then make a
    # later one the longer, which OrientedBox refuses.
    lows, highs = bounds_of(points @ axes.T)
    extents = np.maximum.accumulate((highs - lows)[::-1])[::-1]
    return OrientedBox(middle + size * ((lows + highs) / 2) @ axes, axes, extents * size)


def _axes_of_box(points: FloatArray, faces: IntArray) -> FloatArray:
    """Axes of the minimum-volume box; where the search would be long, that of a hull of fewer vertices first.

    The box found there rules out most of the edges of the whole hull.
    """
    if len(points) > MAX_VERTICES:
        return _axes_of_thinned(points)
    facets = facets_of_hull(points, faces) or _facets_of_perturbed(points)
    with suppress(TooManyCurvesError):
        return minimum_box(facets, MAX_TURN)
    return minimum_box(facets, MAX_KNOWN_TURN, _axes_of_thinned(points))


def _axes_of_thinned(points: FloatArray) -> FloatArray:
    """Axes of the minimum-volume box of a hull of as many of its vertices as the search can take."""
    cell = FIRST_CELL
    while True:
        hull = Mesh(_farthest_in_cells(points, cell), np.empty((0, 3), dtype=np.int64)).hull
        if len(hull.vertices) <= MAX_VERTICES:
            with suppress(TooManyCurvesError):
                facets = facets_of_hull(hull.vertices, hull.faces) or _facets_of_perturbed(hull.vertices)
                return minimum_box(facets, MAX_TURN)
        cell *= 1.25


def _farthest_in_cells(points: FloatArray, cell: float) -> FloatArray:
    """Of the points in each cell of a cubic grid, the one farthest from the middle."""
    order = np.argsort(-(points**2).sum(axis=1), kind="stable")
    cells = np.floor(points[order] / cell).astype(np.int64)
    # One number a cell, as np.unique of rows sorts records, which is slow.
    n_cells = np.ptp(cells, axis=0) + 1
    _, first = np.unique(np.ravel_multi_index((cells - cells.min(axis=0)).T, n_cells), return_index=True)
    return points[order[np.sort(first)]]


def _welded(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """A hull without edges shorter than `WELD`, which are too short to have a direction."""
    edges = points[faces] - points[np.roll(faces, 1, axis=1)]
    if (edges**2).sum(axis=2).min() >= WELD**2:
        return points, faces
    near = cKDTree(points).query_pairs(WELD, output_type="ndarray")
    graph = coo_array((np.ones(len(near)), near.T), shape=(len(points), len(points)))
    _, first = np.unique(connected_components(graph, directed=False)[1], return_index=True)
    try:
        hull = Mesh(points[first], np.empty((0, 3), dtype=np.int64)).hull
    except GeometryError:
        return points, faces
    return hull.vertices, hull.faces


def _facets_of_perturbed(points: FloatArray) -> Facets:
    """For a hull whose triangles do not close (many points in one plane): move each point by 1e-10."""
    perturbed = Mesh(
        points + JITTER * fibonacci_directions(len(points)), np.empty((0, 3), dtype=np.int64)
    ).hull
    facets = facets_of_hull(perturbed.vertices, perturbed.faces)
    if facets is None:
        raise GeometryError("The convex hull of the mesh does not close, so it has no bounding box.")
    return facets


def _right_handed(axes: FloatArray) -> FloatArray:
    """Largest component of the first two axes positive, third their cross product."""
    turned = axes * np.sign(axes[np.arange(3), np.abs(axes).argmax(axis=1)])[:, None]
    turned[2] = np.cross(turned[0], turned[1])
    return np.asarray(turned)
