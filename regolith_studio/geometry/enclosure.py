"""Whether an open surface goes round a body, judged by how its own part of the closed one winds.

The share of the surface that is missing does not tell: half an ellipsoid lacks 45 % of its surface, a
crumpled sheet, closed along its short rim, 10 %. What tells them apart is the winding number (Jacobson,
Kavan and Sorkine-Hornung 2013): a body that is closed again has nearly all that it encloses wrapped just
once, and its open surface alone already winds by more than a half about the points inside.
"""

from dataclasses import dataclass

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.directions import fibonacci_directions
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits

LARGEST_COVER = 0.47
"""A mesh with more than this share of its closed surface missing is an open sheet, not a particle."""
LEAST_INSIDE, LEAST_WINDING = 0.9, 0.58
"""What a body has of each share of its :class:`Enclosure`, and of its winding number.

Ellipsoids that lack 1 to 50 % have 1.00 of both shares; of 32 crumpled sheets all but one have 0.44 to 0.85
of the volume wrapped once, and that one 0.78 of it inside. Half an ellipsoid winds by 0.60 to 0.86.
"""
N_RAYS = 1500
N_POINTS = 400
OFF_CENTRE = (0.0123, 0.0171, 0.0087)
"""Shares of the box's edges by which the rays begin beside its middle, where models have symmetry planes."""


@dataclass(frozen=True)
class Enclosure:
    """How a surface encloses, before and after its holes are closed.

    Parameters
    ----------
    wrapped_once
        Share of the volume about which the closed surface winds that it winds about exactly once.
    inside
        Share of that volume about which the open surface alone winds by more than a half.
    winding
        Mean winding number of the open surface there: 1 of a closed surface, 0.5 of a flat sheet.
    """

    wrapped_once: float
    inside: float
    winding: float


def enclosure(closed: Mesh, n_cover: int) -> Enclosure:
    """How a closed mesh encloses if its last `n_cover` triangles are taken away; all 0 for no volume."""
    points, volumes, windings = _stretches(closed)
    if volumes @ windings < 0:
        windings = -windings
    wrapped, once = windings != 0, windings == 1
    if not volumes[once].sum() > 0.0:
        return Enclosure(0.0, 0.0, 0.0)
    chosen = points[once][_spread(volumes[once])]
    cover = closed.triangles[len(closed.faces) - n_cover :]
    missing = np.abs(solid_angles(cover, chosen)) / (4 * np.pi)
    return Enclosure(
        float(volumes[once].sum() / volumes[wrapped].sum()),
        float(np.mean(missing < 0.5)),
        float(1.0 - missing.mean()),
    )


def refuse_sheet(closed: Mesh, n_cover: int, share: float) -> None:
    """Refuse what bounds no volume without its cover, however small that is: crumpled and curved sheets.

    Parameters
    ----------
    closed, n_cover
        As for :func:`enclosure`.
    share
        Of the surface that the cover has.

    Raises
    ------
    GeometryError
        With a sentence that says what is missing.
    """
    sheet = "The mesh is an open sheet, not a body:"
    if share > LARGEST_COVER:
        raise GeometryError(f"{sheet} to close it would take {100 * share:.2g} % of the surface.")
    found = enclosure(closed, n_cover)
    if found.wrapped_once < LEAST_INSIDE:
        tangled = f"{100 * (1 - found.wrapped_once):.0f} %"
        raise GeometryError(
            f"{sheet} of what it would enclose if it were closed, {tangled} is outside or wrapped twice."
        )
    if found.inside < LEAST_INSIDE or found.winding < LEAST_WINDING:
        raise GeometryError(
            f"{sheet} from the points inside it covers only {100 * found.winding:.0f} % of all directions."
        )


def solid_angles(triangles: FloatArray, points: FloatArray) -> FloatArray:
    """Sum of the signed solid angles of triangles (m, 3, 3) as seen from each point (n, 3), shape (n,).

    Van Oosterom and Strackee (1983). Positive where the triangles turn their inner side to the point.
    """
    a, b, c = (triangles[None, :, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(edge, axis=2) for edge in (a, b, c))
    volume = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
    dots = [np.einsum("ijk,ijk->ij", *pair) for pair in ((a, b), (b, c), (c, a))]
    turn = la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb
    return np.asarray(2 * np.arctan2(volume, turn).sum(axis=1))


def _stretches(mesh: Mesh) -> tuple[FloatArray, FloatArray, IntArray]:
    """Stretches of rays between two crossings: a point in each, the volume it stands for, its winding."""
    low, high = mesh.bounds
    origin = (low + high) / 2 + np.array(OFF_CENTRE) * (high - low)
    directions = fibonacci_directions(N_RAYS)
    hits = radial_hits(mesh, origin, directions)
    begins = np.flatnonzero(np.diff(hits.ray, prepend=-1))
    lengths = np.diff(begins, append=len(hits.ray))
    outward = np.cumsum(hits.sign[::-1])[::-1]
    beyond = np.append(outward, 0)[begins + lengths]
    start = np.concatenate([[0.0], hits.distance[:-1]])
    start[begins] = 0.0
    near, far = start**3, hits.distance**3
    middle = origin + directions[hits.ray] * np.cbrt((near + far) / 2)[:, None]
    return middle, far - near, outward - np.repeat(beyond, lengths)


def _spread(weights: FloatArray) -> IntArray:
    """Indices of N_POINTS items, each as often as its weight says (systematic sampling)."""
    steps = (np.arange(N_POINTS) + 0.5) / N_POINTS * weights.sum()
    picks = np.searchsorted(np.cumsum(weights), steps)
    return np.asarray(np.minimum(picks, len(weights) - 1), dtype=np.int64)
