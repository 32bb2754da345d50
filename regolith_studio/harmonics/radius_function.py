"""The radius function of a particle about its star point (section 2.3), sampled by ray casting.

Scanned particles are hardly ever star-shaped: some rays cross the surface three times or more. The
radius is then defined by one of the rules below. The default keeps the particle's volume.

Reference surfaces, by whose radius that of the particle is divided before it is expanded.

About a sphere, a flat or elongated particle needs high degrees for its overall form alone, and a short series
oscillates. Divided by the radius of the best-fit ellipsoid, the function is nearly constant and oscillates
less at the same l_max.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats, locked_integers
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """An ellipsoid about the star point.

    ``axes``: unit axes as rows, shape (3, 3). ``semi_axes``: half lengths along them, shape (3,), in the
    unit of the particle.
    """

    axes: FloatArray
    semi_axes: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "axes", locked_floats(self.axes, (3, 3), "axes"))
        object.__setattr__(self, "semi_axes", locked_floats(self.semi_axes, (3,), "semi_axes"))
        if not (self.semi_axes > 0).all():
            raise ValueError(f"semi_axes must be positive, got {self.semi_axes}")

    def __reduce__(self) -> tuple[Callable[..., "Ellipsoid"], tuple[ArrayLike, ArrayLike]]:
        return Ellipsoid, (self.axes, self.semi_axes)

    def radii(self, directions: FloatArray) -> FloatArray:
        """Radius along unit `directions` (n, 3), shape (n,)."""
        return np.asarray(np.linalg.norm(directions @ self.axes.T / self.semi_axes, axis=1) ** -1)


def best_fit_ellipsoid(mesh: Mesh) -> Ellipsoid:
    """The ellipsoid with the volume and the principal moments of inertia of a closed mesh."""
    moments, axes = np.linalg.eigh(mesh.inertia)
    # The second moments, which go with the squares of the semi-axes; of a thin mesh rounding may make one
    # negative.
    second = moments.sum() / 2 - moments
    lengths = np.sqrt(np.maximum(second, 1e-12 * second.max()))
    volume = 4 / 3 * np.pi * lengths.prod()
    return Ellipsoid(axes.T, lengths * np.cbrt(mesh.volume / volume))


REFERENCES: dict[str, Callable[[Mesh], Ellipsoid | None]] = {
    "sphere": lambda _mesh: None,
    "ellipsoid": best_fit_ellipsoid,
}
"""Reference surface of a mesh, by key; ``None`` is the unit sphere: no division."""


DEFAULT_RULE = "volume"
RULES: Mapping[str, str] = MappingProxyType(
    {
        "volume": "radius that keeps the volume: cube root of the signed sum of r^3",
        "outermost": "last crossing",
        "first": "first crossing",
    }
)
"""Rules for rays that cross the surface more than once, with a label for each."""

N_RECASTS = 4
RECAST_ANGLE = 1e-7
"""A ray through an edge may miss or count it twice; it is cast again this much (radians) beside."""


@dataclass(frozen=True, eq=False)
class RadiusFunction:
    """Distances from the star point to the surface along given directions.

    - ``star_point``: shape (3,).
    - ``directions``: unit vectors, shape (n, 3).
    - ``first``, ``outermost``, ``volume``: radius by each rule, shape (n,), in the unit of the mesh; equal
      where a ray crosses once.
    - ``n_crossings``: crossings of each ray, shape (n,).
    - ``rule``: key of :data:`RULES` that :attr:`radii` follows.
    """

    star_point: FloatArray
    directions: FloatArray
    first: FloatArray
    outermost: FloatArray
    volume: FloatArray
    n_crossings: IntArray
    rule: str = DEFAULT_RULE

    def __post_init__(self) -> None:
        if self.rule not in RULES:
            raise InputError(f"The radius rule must be one of {', '.join(RULES)}, got {self.rule!r}.")
        object.__setattr__(self, "star_point", locked_floats(self.star_point, (3,), "star_point"))
        object.__setattr__(self, "directions", locked_floats(self.directions, (None, 3), "directions"))
        shape = (len(self.directions),)
        for name in ("first", "outermost", "volume"):
            object.__setattr__(self, name, locked_floats(getattr(self, name), shape, name))
        object.__setattr__(self, "n_crossings", locked_integers(self.n_crossings, shape, "n_crossings"))

    def __reduce__(self) -> tuple[Callable[..., "RadiusFunction"], tuple[ArrayLike | str, ...]]:
        fields = (self.star_point, self.directions, self.first, self.outermost, self.volume)
        return RadiusFunction, (*fields, self.n_crossings, self.rule)

    @property
    def radii(self) -> FloatArray:
        """Radius by the chosen rule, shape (n,)."""
        chosen: FloatArray = getattr(self, self.rule)
        return chosen

    @property
    def hidden_cubes(self) -> FloatArray:
        """Three times the volume per solid angle behind the first crossing, shape (n,)."""
        return np.maximum(self.volume**3 - self.first**3, 0.0)


def sample_radius(
    mesh: Mesh, star_point: ArrayLike, directions: ArrayLike, rule: str = DEFAULT_RULE
) -> RadiusFunction:
    """Cast rays from `star_point` along `directions` (n, 3) at a closed mesh.

    Raises GeometryError if the star point lies outside, or the mesh is open. Raises InputError if the rule
    is unknown.
    """
    centre = locked_floats(star_point, (3,), "star_point")
    rays = locked_floats(directions, (None, 3), "directions")
    table = _crossings(mesh, centre, rays)
    inside = _winding_number(table, centre)
    for attempt in range(N_RECASTS):
        doubtful = np.flatnonzero((table[:, 4] != inside) | ~(table[:, 2] > 0))
        if not len(doubtful):
            break
        table[doubtful] = _crossings(mesh, centre, _beside(rays[doubtful], attempt))
    else:
        raise GeometryError("Some rays do not leave the particle: the mesh is open, repair it first.")
    first, outermost, cubes, crossings, _ = table.T
    # cbrt(r^3) differs from r by rounding, and not by the same on all processors
    volume = np.where(crossings == 1, first, np.cbrt(cubes))
    return RadiusFunction(centre, rays, first, outermost, volume, crossings.astype(np.int64), rule)


def _crossings(mesh: Mesh, centre: FloatArray, rays: FloatArray) -> FloatArray:
    """One row a ray, shape (n, 5): first, last, signed sum of r^3, number and sum of signs of crossings."""
    hits = radial_hits(mesh, centre, rays)
    table = np.zeros((len(rays), 5))
    _sum_crossings(hits.ray, hits.distance, hits.sign, table)
    return table


@kernel
def _sum_crossings(ray: IntArray, distance: FloatArray, sign: IntArray, table: FloatArray) -> None:
    for k in range(len(ray)):
        row = table[ray[k]]
        if row[3] == 0.0:
            row[0] = distance[k]
        row[1] = distance[k]
        row[2] += sign[k] * distance[k] ** 3
        row[3] += 1.0
        row[4] += sign[k]


def _winding_number(table: FloatArray, centre: FloatArray) -> int:
    """How often the surface winds round the star point, by the majority of rays; 1 inside a solid."""
    sums, counts = np.unique(table[:, 4], return_counts=True)
    winding = int(sums[counts.argmax()])
    if winding < 1:
        where = ", ".join(f"{x:.4g}" for x in centre)
        raise GeometryError(f"The star point ({where}) lies outside the particle.")
    return winding


def _beside(rays: FloatArray, attempt: int) -> FloatArray:
    """The rays turned by a tiny angle, another one each attempt."""
    angle = RECAST_ANGLE * (attempt + 1)
    # Another axis each time, as a ray along the axis would stay where it is.
    axis = np.roll(np.array([0.37, -0.61, 0.70]), attempt)
    beside = rays + angle * np.cross(axis, rays)
    return np.asarray(beside / np.linalg.norm(beside, axis=1, keepdims=True))


def is_closed(mesh: Mesh) -> bool:
    """Whether each edge occurs as often in one direction as in the other.

    Only then are volume, inside and outside defined. Corners at equal coordinates count as one, so that seams
    do not matter. Hashes of the edges, with the sign of their direction, are summed modulo 2^64: an open mesh
    passes with a probability of 5e-20.
    """
    corner = _vertex_words(mesh)[mesh.faces]
    start, end = corner, np.roll(corner, -1, axis=1)
    forward = start < end
    low, high = np.where(forward, start, end), np.where(forward, end, start)
    word = _mixed(low + _mixed(high))
    # An edge between equal corners has no direction, so that both of its sides would count alike.
    word[start == end] = 0
    total = np.where(forward, word, ~word + np.uint64(1)).sum(dtype=np.uint64)
    return bool(total == 0)


def require_solid(mesh: Mesh) -> Mesh:
    """The mesh itself, if it is closed and encloses a positive volume.

    Raises GeometryError if it is open, flat or inside out.
    """
    if len(mesh.faces) < 4:
        raise GeometryError(f"A particle needs at least four triangles, this mesh has {len(mesh.faces)}.")
    if not is_closed(mesh):
        raise GeometryError(
            "The mesh is open or its triangles are not oriented consistently: repair it first."
        )
    size = float(np.ptp(mesh.bounds, axis=0).max())
    # The volume of a flat mesh is rounding, of either sign.
    if not mesh.volume > 1e-12 * size**3:
        state = "is inside out" if mesh.volume < -1e-12 * size**3 else "encloses no volume"
        raise GeometryError(f"The mesh {state}: its signed volume is {mesh.volume:.3g}.")
    return mesh


def _vertex_words(mesh: Mesh) -> NDArray[np.uint64]:
    """A word for each vertex, equal for equal coordinates, shape (n,)."""
    # Adding 0 makes -0, whose bits differ, to 0.
    bits = (mesh.vertices + 0.0).view(np.uint64)
    return _mixed(bits[:, 0] + _mixed(bits[:, 1] + _mixed(bits[:, 2])))


def _mixed(words: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The finaliser of SplitMix64 (Steele, Lea and Flood 2014): a bijection that scatters all bits."""
    mixed = words + np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return mixed ^ (mixed >> np.uint64(31))
