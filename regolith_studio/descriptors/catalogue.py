"""The catalogue of descriptors (section 2.2 and what users of shape analysis expect).

A descriptor is one function of :class:`ShapeCache` and one row of `CATALOGUE`; sliders, loss terms,
table columns and invariance tests follow from the row. S, I and L stand for the edges
D_min <= D_int <= D_max of the minimum-volume bounding box.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.feret import feret_max, feret_min, length_width_thickness
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.geometry.mesh import Mesh, ellipsoid_area, equal_ellipsoid, volume_and_area
from regolith_studio.geometry.oriented_box import OrientedBox, heuristic_box, minimum_volume_box
from regolith_studio.geometry.vectors import cross, dot, length, mixed, row
from regolith_studio.messages import N_

FLAT = 1e-9
"""A mesh whose volume is below this share of its size cubed encloses nothing."""

BOX_METRICS: dict[str, Callable[[Mesh | ConvexPolyhedron], OrientedBox]] = {
    "exact": minimum_volume_box,
    "trimesh": heuristic_box,
}
"""Bounding boxes to take D_min and D_max from; ``trimesh`` only for comparison with the paper's program."""


class ShapeCache:
    """Lazily computed facts about one particle, read by the functions of the catalogue.

    ``solid``: closed and outward-oriented. ``box_metric``: a key of `BOX_METRICS`.

    Raises GeometryError if the solid has no faces, is flat or is inside out.
    """

    def __init__(self, solid: Mesh | ConvexPolyhedron, box_metric: str = "exact") -> None:
        if box_metric not in BOX_METRICS:
            raise ValueError(f"box_metric must be one of {sorted(BOX_METRICS)}, got {box_metric!r}")
        self._solid = solid
        self.box_metric = box_metric
        self.mesh = solid.mesh if isinstance(solid, ConvexPolyhedron) else solid
        self.volume, self.surface_area = volume_and_area(self.mesh.vertices, self.mesh.faces)
        _check_volume(self.mesh, self.volume)

    @cached_property
    def hull(self) -> Mesh:
        """Convex hull, triangulated."""
        return self.mesh if isinstance(self._solid, ConvexPolyhedron) else self.mesh.hull

    @cached_property
    def box(self) -> OrientedBox:
        """Oriented bounding box by `box_metric`."""
        _ = self.hull  # held here: a large mesh does not keep it for long, and it would be built again
        return BOX_METRICS[self.box_metric](self._solid)

    @cached_property
    def three_chords(self) -> tuple[float, float, float]:
        """Length, width and thickness of the hull by chords."""
        return length_width_thickness(self.hull)

    @cached_property
    def principal_moments(self) -> FloatArray:
        """Principal moments of inertia at density 1, rising, shape (3,)."""
        moments = np.linalg.eigvalsh(self.mesh.normalised().inertia)
        return np.asarray(moments * self.volume ** (5 / 3))

    @cached_property
    def hull_ellipsoid_area(self) -> float:
        """Surface area of the ellipsoid with the volume and the ratios of second moments of the hull."""
        return ellipsoid_area(equal_ellipsoid(self.hull.normalised().inertia, self.hull.volume))


def _check_volume(mesh: Mesh, volume: float) -> None:
    if len(mesh.faces) < 4:
        raise GeometryError(f"The mesh has {len(mesh.faces)} faces; a solid needs at least 4.")
    low, high = mesh.bounds
    size = float((high - low).max())
    if not abs(volume) > FLAT * size**3:
        raise GeometryError(
            f"The mesh is flat: it encloses a volume of {abs(volume):.3g} at a size of {size:.3g}."
        )
    if volume < 0.0:
        raise GeometryError(f"The mesh is inside out: its signed volume is {volume:.3g}.")


_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Descriptor:
    """One row of the catalogue.

    - ``key``: name in files and tables.
    - ``symbol``: as in the paper or the literature.
    - ``label``: for people, in sentence case.
    - ``dimension``: power of length in the unit; 0 where the descriptor is a pure number.
    - ``formula``: shown in the window, with whose definition it is.
    - ``compute``: value from the shared facts.
    - ``in_loss``: whether it is one of the paper's set D of Eq. 8 and 9.
    - ``costly``: whether it is worked out only when asked for by key.
    """

    key: str
    symbol: str
    label: str
    dimension: int
    formula: str
    compute: Callable[[ShapeCache], float]
    in_loss: bool = False
    costly: bool = False

    @property
    def unit(self) -> str:
        """In files: ``um``, ``um^2`` ...; empty for a pure number."""
        power = f"^{self.dimension}" if self.dimension > 1 else ""
        return f"um{power}" if self.dimension else ""

    @property
    def unit_symbol(self) -> str:
        """On screen and paper: µm, µm² ...; empty for a pure number."""
        return f"µm{powers(self.dimension)}" if self.dimension else ""

    @property
    def unit_suffix(self) -> str:
        """Behind a label: " [µm²]"; empty for a pure number."""
        return f" [{self.unit_symbol}]" if self.dimension else ""


def powers(exponent: int) -> str:
    """A positive exponent as raised digits; empty for 1."""
    return "" if exponent == 1 else str(exponent).translate(_RAISED)


def volume(facts: ShapeCache) -> float:
    """Volume enclosed by the surface."""
    return facts.volume


def equivalent_radius(facts: ShapeCache) -> float:
    """Radius of the sphere with the same volume."""
    return float((3.0 * facts.volume / (4.0 * np.pi)) ** (1 / 3))


def surface_area(facts: ShapeCache) -> float:
    """Area of the surface."""
    return facts.surface_area


def sphericity(facts: ShapeCache) -> float:
    """Wadell's true sphericity, 1 for a sphere; the printed Eq. 1 has a 3 too many in its denominator."""
    return float(np.cbrt(np.pi) * (6.0 * facts.volume) ** (2 / 3) / facts.surface_area)


def min_diameter(facts: ShapeCache) -> float:
    """Shortest edge of the minimum-volume bounding box."""
    return facts.box.min_diameter


def intermediate_diameter(facts: ShapeCache) -> float:
    """Middle edge of the minimum-volume bounding box."""
    return facts.box.intermediate_diameter


def max_diameter(facts: ShapeCache) -> float:
    """Longest edge of the minimum-volume bounding box."""
    return facts.box.max_diameter


def aspect_ratio(facts: ShapeCache) -> float:
    """D_max / D_min (Eq. 2)."""
    return facts.box.max_diameter / facts.box.min_diameter


def convex_hull_volume(facts: ShapeCache) -> float:
    """Volume of the convex hull."""
    return facts.hull.volume


def convexity(facts: ShapeCache) -> float:
    """Share of the convex hull that the particle fills, also called solidity."""
    return facts.volume / facts.hull.volume


def elongation(facts: ShapeCache) -> float:
    """Zingg's I / L (1935): 1 for no elongation, towards 0 for needles."""
    return facts.box.intermediate_diameter / facts.box.max_diameter


def flatness(facts: ShapeCache) -> float:
    """Zingg's S / I (1935): 1 for no flatness, towards 0 for flakes."""
    return facts.box.min_diameter / facts.box.intermediate_diameter


def corey_shape_factor(facts: ShapeCache) -> float:
    """S / sqrt(L I), Corey (1949)."""
    return float(facts.box.min_diameter / np.sqrt(facts.box.max_diameter * facts.box.intermediate_diameter))


def krumbein_sphericity(facts: ShapeCache) -> float:
    """Intercept sphericity (S I / L^2)^(1/3), Krumbein (1941)."""
    return float(np.cbrt(facts.box.min_diameter * facts.box.intermediate_diameter)) / float(
        np.cbrt(facts.box.max_diameter**2)
    )


def max_feret_diameter(facts: ShapeCache) -> float:
    """Largest distance between two points of the particle."""
    return feret_max(facts.hull)


def min_feret_diameter(facts: ShapeCache) -> float:
    """Smallest distance between two parallel planes that hold the particle."""
    return feret_min(facts.hull)


def width(facts: ShapeCache) -> float:
    """Longest chord of the hull perpendicular to its longest one, which is the largest Feret diameter L."""
    return facts.three_chords[1]


def thickness(facts: ShapeCache) -> float:
    """Longest chord of the hull perpendicular to both L and W."""
    return facts.three_chords[2]


def width_over_length(facts: ShapeCache) -> float:
    """Zingg's ratio of elongation from chords."""
    return facts.three_chords[1] / facts.three_chords[0]


def thickness_over_width(facts: ShapeCache) -> float:
    """Zingg's ratio of flatness from chords."""
    return facts.three_chords[2] / facts.three_chords[1]


def roundness(facts: ShapeCache) -> float:
    """Mean over the surface of |n . x| / |x| about the centroid, after Bullard and Garboczi (2013)."""
    return mean_incidence(facts.mesh, facts.mesh.centroid)


def angularity(facts: ShapeCache) -> float:
    """Area of the hull over that of its ellipsoid: Kuo and Freeman's (2000) index, areas for perimeters."""
    return facts.hull.surface_area / facts.hull_ellipsoid_area


def roughness(facts: ShapeCache) -> float:
    """Area of the surface over that of the hull: Kuo and Freeman's (2000) index, areas for perimeters."""
    return facts.surface_area / facts.hull.surface_area


def principal_moment_min(facts: ShapeCache) -> float:
    """Smallest principal moment of inertia at density 1."""
    return float(facts.principal_moments[0])


def principal_moment_mid(facts: ShapeCache) -> float:
    """Middle principal moment of inertia at density 1."""
    return float(facts.principal_moments[1])


def principal_moment_max(facts: ShapeCache) -> float:
    """Largest principal moment of inertia at density 1."""
    return float(facts.principal_moments[2])


_ROWS = (
    Descriptor("volume", "V", N_("Volume"), 3, "V", volume, in_loss=True),
    Descriptor(
        "equivalent_radius", "r_eq", N_("Equivalent radius"), 1, N_("(3 V / 4π)^(1/3)"), equivalent_radius
    ),
    Descriptor("surface_area", "A", N_("Surface area"), 2, "A", surface_area),
    Descriptor(
        "sphericity",
        "S",
        N_("Sphericity"),
        0,
        N_("π^(1/3) (6V)^(2/3) / A (Wadell, true sphericity)"),
        sphericity,
        True,
    ),
    Descriptor(
        "min_diameter",
        "D_min",
        N_("Minimum diameter"),
        1,
        N_("shortest edge of the bounding box"),
        min_diameter,
        True,
    ),
    Descriptor(
        "max_diameter",
        "D_max",
        N_("Maximum diameter"),
        1,
        N_("longest edge of the bounding box"),
        max_diameter,
        True,
    ),
    Descriptor("aspect_ratio", "AR", N_("Aspect ratio"), 0, N_("D_max / D_min"), aspect_ratio, in_loss=True),
    Descriptor(
        "convex_hull_volume",
        "CH",
        N_("Convex hull volume"),
        3,
        N_("V of the hull"),
        convex_hull_volume,
        in_loss=True,
    ),
    Descriptor(
        "intermediate_diameter",
        "D_int",
        N_("Intermediate diameter"),
        1,
        N_("middle edge of the bounding box"),
        intermediate_diameter,
    ),
    Descriptor("convexity", "V/CH", N_("Convexity"), 0, N_("V / CH"), convexity),
    Descriptor("elongation", "I/L", N_("Elongation"), 0, N_("D_int / D_max (Zingg)"), elongation),
    Descriptor("flatness", "S/I", N_("Flatness"), 0, N_("D_min / D_int (Zingg)"), flatness),
    Descriptor(
        "corey_shape_factor",
        "CSF",
        N_("Corey shape factor"),
        0,
        N_("D_min / √(D_max D_int) (Corey)"),
        corey_shape_factor,
    ),
    Descriptor(
        "krumbein_sphericity",
        "Ψ_K",
        N_("Krumbein sphericity"),
        0,
        N_("(D_min D_int / D_max²)^(1/3) (Krumbein)"),
        krumbein_sphericity,
    ),
    Descriptor(
        "max_feret_diameter",
        "F_max",
        N_("Largest Feret diameter"),
        1,
        N_("greatest distance of two points"),
        max_feret_diameter,
    ),
    Descriptor(
        "min_feret_diameter",
        "F_min",
        N_("Smallest Feret diameter"),
        1,
        N_("least distance of two parallel tangent planes"),
        min_feret_diameter,
        costly=True,
    ),
    Descriptor("width", "W", N_("Width"), 1, N_("longest chord across F_max"), width, costly=True),
    Descriptor(
        "thickness", "T", N_("Thickness"), 1, N_("longest chord across F_max and W"), thickness, costly=True
    ),
    Descriptor(
        "width_over_length", "W/L", N_("Width to length"), 0, N_("W / F_max"), width_over_length, costly=True
    ),
    Descriptor(
        "thickness_over_width",
        "T/W",
        N_("Thickness to width"),
        0,
        N_("T / W"),
        thickness_over_width,
        costly=True,
    ),
    Descriptor(
        "roundness",
        "R",
        N_("Roundness"),
        0,
        N_("mean of |n·x|/|x| over the surface (Bullard and Garboczi)"),
        roundness,
    ),
    Descriptor(
        "angularity",
        "AI",
        N_("Angularity"),
        0,
        N_("A of the hull / A of its ellipsoid (after Kuo and Freeman)"),
        angularity,
    ),
    Descriptor(
        "roughness", "RI", N_("Roughness"), 0, N_("A / A of the hull (after Kuo and Freeman)"), roughness
    ),
    Descriptor(
        "principal_moment_min",
        "I_1",
        N_("Smallest moment of inertia"),
        5,
        N_("about the centroid"),
        principal_moment_min,
    ),
    Descriptor(
        "principal_moment_mid",
        "I_2",
        N_("Middle moment of inertia"),
        5,
        N_("about the centroid"),
        principal_moment_mid,
    ),
    Descriptor(
        "principal_moment_max",
        "I_3",
        N_("Largest moment of inertia"),
        5,
        N_("about the centroid"),
        principal_moment_max,
    ),
)

CATALOGUE: dict[str, Descriptor] = {each.key: each for each in _ROWS}
"""Every descriptor by its key, in the order of tables."""

LOSS_KEYS: tuple[str, ...] = tuple(each.key for each in _ROWS if each.in_loss)
"""The paper's set D of Eq. 8 and 9: V, S, D_min, D_max, AR, CH."""

CHORD_KEYS = ("width", "thickness", "width_over_length", "thickness_over_width")
"""Costly descriptors by chords, beside the length, which is the largest Feret diameter."""

DEFAULT_KEYS: tuple[str, ...] = tuple(each.key for each in _ROWS if not each.costly)
"""What :func:`describe` works out unless told."""


def mean_incidence(mesh: Mesh, centre: ArrayLike) -> float:
    """Mean over the surface of |n . x| / |x|, x from `centre` and n the unit normal; 1 for a sphere.

    Exact for triangles: the distance of a triangle's plane times the integral of 1 / |x| over it, which
    has a closed form (Wilton et al. 1984), so that cutting a facet in triangles changes nothing.
    """
    origin = locked_floats(centre, (3,), "centre")
    size = float(np.ptp(mesh.bounds, axis=0).max())
    return _incidence((mesh.vertices - origin) / size, mesh.faces) * size**2 / mesh.surface_area


@kernel
def _incidence(points: FloatArray, faces: IntArray) -> float:
    """Integral of |n . x| / |x| over the triangles."""
    total = 0.0
    for f in range(len(faces)):
        corners = row(points, faces[f, 0]), row(points, faces[f, 1]), row(points, faces[f, 2])
        normal = cross(mixed(corners[1], 1.0, corners[0], -1.0), mixed(corners[2], 1.0, corners[0], -1.0))
        doubled = length(normal)
        if doubled == 0.0:
            continue
        normal = mixed(normal, 1.0 / doubled, normal, 0.0)
        height = dot(normal, corners[0])
        total += abs(height) * _potential(corners[0], corners[1], corners[2], normal, height)
    return total


@inner_kernel
def _potential(
    a: tuple[float, float, float],
    b: tuple[float, float, float],
    c: tuple[float, float, float],
    normal: tuple[float, float, float],
    height: float,
) -> float:
    """Integral of 1 / |x| over a triangle with unit `normal` at the signed distance `height` of its plane."""
    total = 0.0
    for k in range(3):
        start, end = (a, b) if k == 0 else ((b, c) if k == 1 else (c, a))
        edge = mixed(end, 1.0, start, -1.0)
        size = length(edge)
        if size == 0.0:
            continue
        edge = mixed(edge, 1.0 / size, edge, 0.0)
        outward = dot(start, cross(edge, normal))
        before, behind = dot(start, edge), dot(end, edge)
        far, near = length(end) + behind, length(start) + before
        if before < 0.0 and behind < 0.0:
            # The same quotient, as length^2 - projection^2 is the same for both ends; here the sums would
            # cancel.
            far, near = length(start) - before, length(end) - behind
        # In line with the edge the logarithm diverges, but its factor vanishes.
        if outward != 0.0 and near > 0.0 and far > 0.0:
            total += outward * np.log(far / near)
    volume = dot(a, cross(b, c))
    la, lb, lc = length(a), length(b), length(c)
    angle = 2.0 * np.arctan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    return float(total - height * angle)
