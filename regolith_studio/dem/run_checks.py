"""Checks after a simulation, the same for all engines: overlaps, energy, rest; height of the filling."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import ConvexHull, cKDTree
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks
from regolith_studio.dem.initial_packing import enclosing_radii
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.messages import N_, Message, Number

MAX_OVERLAP = 0.02
"""Maximum accepted overlap at rest, in mean diameters."""
MAX_ENERGY_GAIN = 0.05
"""Maximum accepted rise of the energy between two samples, in m g d per particle: rounding of the solver."""


def check_run(
    heights: FloatArray,
    overlaps: FloatArray,
    *,
    energy_gain: float,
    kinetic_energy: float,
    at_rest: bool,
    filling: tuple[float, float],
    problems: Sequence[str] = (),
) -> RunChecks:
    """Results of the checks, with a sentence for each check that failed.

    Parameters
    ----------
    heights
        Of the particles' centres above the plate in mean diameters, shape (n,).
    overlaps
        Depths at rest in mean diameters, shape (m,).
    filling
        Height in metres and solid fraction before the lift.
    problems
        Sentences of the engine, which come first.
    """
    kept, sentences = int(np.count_nonzero(heights > -1.0)), list(problems)
    largest = float(overlaps.max(initial=0.0))
    if kept < len(heights):
        template = N_("{lost} of {count} particles fell through the plate.")
        sentences.append(Message(template, lost=len(heights) - kept, count=len(heights)))
    if largest > MAX_OVERLAP:
        template = N_("Particles overlap by up to {overlap} % of the mean diameter.")
        sentences.append(Message(template, overlap=Number(100 * largest, ".1f")))
    if energy_gain > MAX_ENERGY_GAIN:
        template = N_("The energy rose by {gain} m g d per particle without external work.")
        sentences.append(Message(template, gain=Number(energy_gain, ".2g")))
    if not at_rest:
        sentences.append(Message(N_("The heap was still moving at the end.")))
    return RunChecks(
        particles_in=len(heights),
        particles_out=kept,
        mean_overlap=float(overlaps.mean()) if len(overlaps) else 0.0,
        max_overlap=largest,
        energy_gain=energy_gain,
        kinetic_energy=kinetic_energy,
        at_rest=at_rest,
        fill_height=filling[0],
        solid_fraction=filling[1],
        problems=tuple(sentences),
    )


def measure_filling(prepared: PreparedCase, particles: ParticleState) -> tuple[float, float]:
    """Height of a filling in metres, and its solid fraction."""
    height = float(np.quantile(particles.points[:, 2] + particles.diameters / 2, 0.98))
    volume = prepared.mass / prepared.case.contact.density
    return height, volume / (prepared.case.test.area * height)


PARALLEL = 1e-9
"""Edges with a smaller cross product of unit directions are parallel."""
_Form = tuple[FloatArray, FloatArray, FloatArray]
"""Vertices of a convex polyhedron, unit normals of its facets, unit directions of its edges, each (k, 3)."""


def overlap_depths(prepared: PreparedCase, particles: ParticleState, rounding: float = 0.0) -> FloatArray:
    """Depth of every pair of particles that overlap, in metres, shape (m,).

    By the separating axis theorem: the minimum overlap of the projections on the normals of both polyhedra
    and on the cross products of their edges.

    Parameters
    ----------
    rounding
        Radius of a ball that is added to every polyhedron, in equivalent diameters. The depth is then an
        upper bound where corners meet corners or edges.
    """
    reach = enclosing_radii(prepared) + rounding * particles.diameters
    pairs = cKDTree(particles.points).query_pairs(2.0 * float(reach.max()), output_type="ndarray")
    apart = np.linalg.norm(particles.points[pairs[:, 0]] - particles.points[pairs[:, 1]], axis=1)
    depths = -separations(prepared, particles, pairs[apart < reach[pairs].sum(axis=1)], rounding=rounding)
    return np.asarray(depths[depths > 0.0])


def separations(
    prepared: PreparedCase,
    particles: ParticleState,
    pairs: IntArray,
    limit: float = 0.0,
    rounding: float = 0.0,
) -> FloatArray:
    """Distance of the particles of each pair, negative where they overlap, in metres, shape (m,).

    By the separating axis theorem, as in :func:`overlap_depths`: exact for overlaps; a lower bound on the
    distance where corners face corners or edges, and where it is above `limit`.

    Parameters
    ----------
    pairs
        Indices, shape (m, 2).
    rounding
        Radius of a ball that is added to every polyhedron, in equivalent diameters.
    """
    radii = rounding * particles.diameters
    if prepared.case.shapes == "spheres":
        radii = radii + particles.diameters / 2
        ways = particles.points[pairs[:, 0]] - particles.points[pairs[:, 1]]
        return np.asarray(np.linalg.norm(ways, axis=1) - radii[pairs].sum(axis=1))
    forms = [[(part, *_normals_and_edges(part)) for part in parts] for parts in prepared.part_vertices]
    turns = Rotation.from_quat(particles.orientations, scalar_first=True).as_matrix()
    scales = prepared.scales

    def placed(k: int) -> list[_Form]:
        return [
            (scales[k] * part @ turns[k].T + particles.points[k], normals @ turns[k].T, edges @ turns[k].T)
            for part, normals, edges in forms[int(prepared.class_index[k])]
        ]

    found = (
        _min_separation(placed(a), placed(b), limit + radii[a] + radii[b]) - radii[a] - radii[b]
        for a, b in pairs.tolist()
    )
    return np.fromiter(found, dtype=np.float64, count=len(pairs))


def lowest_corners(prepared: PreparedCase, particles: ParticleState) -> FloatArray:
    """Height of the lowest corner of every particle above the plate, in metres, shape (n,)."""
    downwards = Rotation.from_quat(particles.orientations, scalar_first=True).as_matrix()[:, 2]
    lowest = [
        (prepared.shapes[kind] @ way).min() for kind, way in zip(prepared.class_index, downwards, strict=True)
    ]
    return np.asarray(particles.points[:, 2] + prepared.scales * np.array(lowest))


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


def _min_separation(one: list[_Form], other: list[_Form], limit: float) -> float:
    """Of two particles of one or more convex parts."""
    return min(_separation(mine, yours, limit) for mine in one for yours in other)


def _separation(one: _Form, other: _Form, limit: float) -> float:
    """Of two polyhedra, negative where they overlap; a lower bound if it is above `limit`."""
    rough = -_min_overlap(one[0], other[0], np.vstack([one[1], other[1]]))
    if rough > limit:
        return rough
    crossed = np.cross(one[2][:, None, :], other[2][None, :, :]).reshape(-1, 3)
    length = np.linalg.norm(crossed, axis=1)
    crossed = crossed[length > PARALLEL] / length[length > PARALLEL][:, None]
    return max(rough, -_min_overlap(one[0], other[0], crossed))


def _min_overlap(one: FloatArray, other: FloatArray, directions: FloatArray) -> float:
    """Of the projections on unit directions, for a translation either way."""
    a, b = one @ directions.T, other @ directions.T
    ways = np.minimum(a.max(axis=0) - b.min(axis=0), b.max(axis=0) - a.min(axis=0))
    return float(ways.min(initial=np.inf))
