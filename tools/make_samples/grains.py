"""Single regolith-like grains, drawn at random: angular, elongated, flat, bead and agglutinate.

All but the agglutinate are star-shaped: plane cuts whose corners a p-norm rounds off, times the
exponential of a band-limited random field, stretched along three axes. The agglutinate is a level
set: melted-together balls with vesicles bitten out of its surface.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from regolith_studio.coarsening.decimated_hull import decimated
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.contours import contour
from tools.make_samples.random_fields import SphereField, power_law

Radius = Callable[[FloatArray], FloatArray]
"""Distance from the centre to the surface along unit directions, shape (n, 3) to (n,)."""


@dataclass(frozen=True)
class StarRecipe:
    """How a star-shaped grain is made.

    Parameters
    ----------
    diameter
        Diameter of the ball of the same volume, in micrometres.
    n_planes
        Number of plane cuts; 0 starts from a ball.
    sharpness
        Exponent p of the norm that joins the cuts: the larger, the sharper the edges.
    offset_spread
        Distances of the planes from the centre are uniform in 1 -+ this.
    stretch
        Factors along x, y, z, before the random rotation.
    roughness
        Standard deviation of a coefficient of log r at degree 2 of the field on top.
    decay
        The field falls off as l^-decay up to degree `highest`.
    highest
        Highest degree of the field.
    n_vertices
        Of the mesh; it has 2 n_vertices - 4 triangles.
    """

    diameter: float
    n_planes: int = 16
    sharpness: float = 20.0
    offset_spread: float = 0.15
    stretch: tuple[float, float, float] = (1.0, 1.0, 1.0)
    roughness: float = 0.05
    decay: float = 1.6
    highest: int = 20
    n_vertices: int = 2502

    def make(self, generator: np.random.Generator) -> Mesh:
        """A grain as a closed mesh, centred at its centroid, in micrometres."""
        return star_mesh(self, generator)


@dataclass(frozen=True)
class AgglutinateRecipe:
    """How a glass-bonded aggregate with vesicles is made; lengths in units of its largest ball.

    Parameters
    ----------
    diameter
        Diameter of the ball of the same volume, in micrometres.
    n_balls
        Number of balls melted together.
    smallest
        Radius of the smallest ball; the largest has radius 1.
    spacing
        Distance of touching balls' centres, as a share of the sum of their radii.
    melt
        Width over which neighbouring balls flow into one another.
    n_vesicles
        Number of pits bitten out of the surface.
    vesicle
        Lowest and highest radius of a pit.
    roughness
        Amplitude of the surface's noise.
    n_faces
        Number of triangles that the mesh is reduced to.
    """

    diameter: float
    n_balls: int = 9
    smallest: float = 0.4
    spacing: float = 0.7
    melt: float = 0.12
    n_vesicles: int = 16
    vesicle: tuple[float, float] = (0.14, 0.4)
    roughness: float = 0.05
    n_faces: int = 5000

    def make(self, generator: np.random.Generator) -> Mesh:
        """An agglutinate as a closed mesh, centred at its centroid, in micrometres."""
        field, spacing = _agglutinate_field(self, generator)
        return _sized(_reduced(contour(field, 0.0, (spacing,) * 3), self.n_faces), self.diameter)


Recipe = StarRecipe | AgglutinateRecipe


def star_radius(recipe: StarRecipe, generator: np.random.Generator) -> Radius:
    """Radius function of a star-shaped grain of about unit radius, randomly rotated."""
    core, turn = _core_radius(recipe, generator), random_rotation(generator)
    inverse_stretch = 1.0 / np.array(recipe.stretch)

    def radius(directions: FloatArray) -> FloatArray:
        body = (directions @ turn) * inverse_stretch
        length = np.linalg.norm(body, axis=1)
        return np.asarray(core(body / length[:, None]) / length)

    return radius


def star_mesh(recipe: StarRecipe, generator: np.random.Generator) -> Mesh:
    """The surface that :func:`star_radius` describes, its triangles even before the stretching."""
    core, turn = _core_radius(recipe, generator), random_rotation(generator)
    sphere = even_sphere(recipe.n_vertices)
    body = sphere.vertices * core(sphere.vertices)[:, None] * np.array(recipe.stretch)
    return _sized(Mesh(body @ turn.T, sphere.faces), recipe.diameter)


def _core_radius(recipe: StarRecipe, generator: np.random.Generator) -> Radius:
    normals, offsets = _plane_cuts(recipe, generator)
    field = SphereField(power_law(2, recipe.highest, recipe.roughness, recipe.decay), generator)
    return lambda unit: _cut_radius(unit, normals, offsets, recipe.sharpness) * np.exp(field(unit))


def even_sphere(n_vertices: int) -> Mesh:
    """Unit sphere of `n_vertices` points on a golden spiral and 2 n_vertices - 4 outward triangles."""
    step = np.arange(n_vertices) + 0.5
    height = 1.0 - 2.0 * step / n_vertices
    angle = step * np.pi * (3.0 - np.sqrt(5.0))
    ring = np.sqrt(1.0 - height**2)
    points = np.column_stack([ring * np.cos(angle), ring * np.sin(angle), height])
    hull = Mesh(points, np.empty((0, 3), dtype=np.int64)).hull
    first = hull.faces.argmin(axis=1)
    turned = hull.faces[np.arange(len(hull.faces))[:, None], (first[:, None] + np.arange(3)) % 3]
    return Mesh(points, turned[np.lexsort(turned.T[::-1])])


def random_rotation(generator: np.random.Generator) -> FloatArray:
    """A uniformly distributed proper rotation, shape (3, 3), from a random unit quaternion."""
    w, x, y, z = (quaternion := generator.standard_normal(4)) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _plane_cuts(recipe: StarRecipe, generator: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Normals (n, 3), roughly even so that the cuts always close, and offsets (n,)."""
    if recipe.n_planes == 0:
        return np.empty((0, 3)), np.empty(0)
    even = even_sphere(max(recipe.n_planes, 4)).vertices @ random_rotation(generator).T
    normals = even + 0.35 * generator.standard_normal(even.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    spread = recipe.offset_spread
    return normals, generator.uniform(1 - spread, 1 + spread, len(normals))


def _cut_radius(
    directions: FloatArray, normals: FloatArray, offsets: FloatArray, sharpness: float
) -> FloatArray:
    """Distance to the rounded plane cuts; a weak ball of radius 2 bounds what planes leave open."""
    closeness = np.maximum(directions @ normals.T, 0.0) / offsets
    open_end = 0.5 if len(offsets) else 1.0
    total = (closeness**sharpness).sum(axis=1) + open_end**sharpness
    return np.asarray(total ** (-1.0 / sharpness))


def _sized(mesh: Mesh, diameter: float) -> Mesh:
    """The mesh centred at its centroid with the volume of a ball of `diameter`."""
    scale = (np.pi / 6 * diameter**3 / mesh.volume) ** (1 / 3)
    return mesh.moved(shift=-mesh.centroid, scale=scale)


def _agglutinate_field(
    recipe: AgglutinateRecipe, generator: np.random.Generator, resolution: int = 72
) -> tuple[FloatArray, float]:
    """Level-set function, positive inside, on a cubic grid, and the grid's spacing."""
    centres, radii = _ball_chain(recipe, generator)
    reach = np.abs(centres).max() + 1.5
    axis = np.linspace(-reach, reach, resolution)
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    balls = [_clast_depth(points - c, r, generator) for c, r in zip(centres, radii, strict=True)]
    depth = _smooth_maximum(balls, recipe.melt)
    depth += recipe.roughness * _plane_waves(points, generator)
    for centre, radius in _vesicles(recipe, centres, radii, generator):
        depth = -_smooth_maximum([-depth, radius - np.linalg.norm(points - centre, axis=1)], 0.04)
    grid = ndimage.gaussian_filter(depth.reshape(resolution, resolution, resolution), 0.8)
    return _one_body(grid), float(axis[1] - axis[0])


def _clast_depth(offsets: FloatArray, radius: float, generator: np.random.Generator) -> FloatArray:
    """Depth below the surface of a stretched ball that a few planes cut flat, as fragments are."""
    stretch = generator.uniform(0.8, 1.25, 3)
    local = offsets @ random_rotation(generator) / stretch
    normals = generator.standard_normal((5, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cuts = generator.uniform(0.7, 1.0, 5) * radius
    return np.asarray(
        np.minimum(radius - np.linalg.norm(local, axis=1), (cuts - local @ normals.T).min(axis=1))
    )


def _ball_chain(recipe: AgglutinateRecipe, generator: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Ball centres (n, 3), each touching an earlier one, and radii (n,), falling from 1."""
    radii = np.linspace(1.0, recipe.smallest, recipe.n_balls)
    centres = np.zeros((recipe.n_balls, 3))
    for ball in range(1, recipe.n_balls):
        parent = generator.integers(ball)
        step = generator.standard_normal(3)
        gap = recipe.spacing * (radii[ball] + radii[parent])
        centres[ball] = centres[parent] + gap * step / np.linalg.norm(step)
    return centres - (centres.min(axis=0) + centres.max(axis=0)) / 2, radii


def _vesicles(
    recipe: AgglutinateRecipe, centres: FloatArray, radii: FloatArray, generator: np.random.Generator
) -> list[tuple[FloatArray, float]]:
    """Centre and radius of each pit, near the surface of a ball."""
    pits = []
    for _ in range(recipe.n_vesicles):
        ball = generator.integers(len(radii))
        step = generator.standard_normal(3)
        radius = generator.uniform(*recipe.vesicle)
        pits.append((centres[ball] + radii[ball] * step / np.linalg.norm(step), float(radius)))
    return pits


def _smooth_maximum(values: list[FloatArray], width: float) -> FloatArray:
    """Differentiable maximum: w log sum exp(v / w)."""
    stacked = np.stack(values) / width
    top = stacked.max(axis=0)
    return np.asarray(width * (top + np.log(np.exp(stacked - top).sum(axis=0))))


def _plane_waves(points: FloatArray, generator: np.random.Generator, count: int = 40) -> FloatArray:
    """Random sum of plane waves of wavelengths 0.6 to 1.6, with unit standard deviation."""
    vectors = generator.standard_normal((count, 3))
    vectors *= (2 * np.pi / generator.uniform(0.6, 1.6, count) / np.linalg.norm(vectors, axis=1))[:, None]
    phases = generator.uniform(0, 2 * np.pi, count)
    total = np.zeros(len(points))
    for vector, phase in zip(vectors, phases, strict=True):
        total += np.cos(points @ vector + phase)
    return np.asarray(total * np.sqrt(2 / count))


def _one_body(depth: FloatArray) -> FloatArray:
    """Keep the largest body and fill closed pores, by pushing their samples beyond the level."""
    bodies, _ = ndimage.label(depth > 0)
    largest = np.bincount(bodies.ravel())[1:].argmax() + 1
    outside, _ = ndimage.label(bodies != largest)
    pore = (outside != outside[0, 0, 0]) & (bodies != largest)
    crumb = (bodies != largest) & (depth > 0) & ~pore
    sized = np.where(pore, np.maximum(np.abs(depth), 0.02), depth)
    return np.asarray(np.where(crumb, -np.abs(depth) - 1e-3, sized))


def _reduced(mesh: Mesh, n_faces: int) -> Mesh:
    """The mesh with about `n_faces` triangles (quadric edge collapse), still closed and of one piece."""
    for goal in (n_faces, 1.1 * n_faces, 1.3 * n_faces):
        share = max(0.0, 1.0 - goal / len(mesh.faces))
        reduced = decimated(mesh, int((1.0 - share) * len(mesh.faces)))
        if _is_closed(reduced):
            return reduced
    return mesh


def _is_closed(mesh: Mesh) -> bool:
    """Whether each directed edge occurs once, and once the other way round."""
    edges = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    codes = edges @ np.array([len(mesh.vertices), 1])
    back = edges @ np.array([1, len(mesh.vertices)])
    return len(np.unique(codes)) == len(codes) and np.array_equal(np.sort(codes), np.sort(back))
