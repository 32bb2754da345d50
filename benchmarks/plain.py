"""The plain programs: what one writes first with trimesh, scipy, scikit-image and pyshtools.

None of them imports anything of the program. The paper's loss and its annealing are written down with
scipy and trimesh, in variants, none slow on purpose: one makes a mesh of a polyhedron and takes trimesh's
volume, area, hull and box; ``lean`` knows that it is convex, takes volume and area from scipy's hull and asks
trimesh for the box alone. The IoU is left out, or the boolean of two meshes by manifold3d (exact), or counted
in a fixed cloud of 4,000 points in the particle's bounding box (an error of some per cent). The box is
trimesh's heuristic, which is no minimum, or with ``exact`` that of O'Rourke in steps of 1 degree.
"""

import json
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pyshtools
import trimesh
from numpy.typing import NDArray
from scipy import stats
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError
from skimage import measure

from benchmarks.independent import least_box

Array = NDArray[np.float64]
KEYS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio", "convex_hull_volume")
CLOUD = 4000
HAS_BOOLEANS = find_spec("manifold3d") is not None
"""Whether trimesh can intersect two meshes."""


def read(path: Path) -> trimesh.Trimesh:
    """A mesh from its file, with a look at whether it is sound."""
    mesh = trimesh.load(path, force="mesh")
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    return mesh


def extract(labels: NDArray[np.uint16], voxel: float) -> list[trimesh.Trimesh]:
    """Marching cubes of each label that does not touch the border, smoothed by trimesh."""
    found = []
    for label in range(1, int(labels.max()) + 1):
        mask = labels == label
        places = np.argwhere(mask)
        if (
            len(places) == 0
            or (places.min(axis=0) == 0).any()
            or (places.max(axis=0) == np.array(mask.shape) - 1).any()
        ):
            continue
        low, high = places.min(axis=0) - 2, places.max(axis=0) + 3
        low = np.maximum(low, 0)
        box = mask[low[0] : high[0], low[1] : high[1], low[2] : high[2]].astype(np.float32)
        vertices, faces, _, _ = measure.marching_cubes(np.pad(box, 1), 0.5)
        mesh = trimesh.Trimesh((vertices + low) * voxel, faces)
        found.append(trimesh.smoothing.filter_taubin(mesh, iterations=20))
    return found


def fit_field(rows: Array, l_max: int) -> tuple[Array, tuple[float, ...]]:
    """Section 2.3: the mean power of each degree over the particles, and a log-normal law of sizes."""
    spectra = []
    for row in rows:
        coefficients = np.zeros((2, l_max + 1, l_max + 1))
        for degree in range(l_max + 1):
            for order in range(-degree, degree + 1):
                coefficients[int(order < 0), degree, abs(order)] = row[degree * degree + degree + order]
        clm = pyshtools.SHCoeffs.from_array(coefficients, normalization="ortho", csphase=1)
        spectra.append(clm.spectrum(convention="energy", unit="per_lm"))
    return np.mean(spectra, axis=0), stats.lognorm.fit(rows[:, 0], floc=0)


def draw_field(power: Array, mean: float, n: int, seed: int) -> list[pyshtools.SHCoeffs]:
    """Random coefficients by pyshtools, until the radius is positive on a grid."""
    drawn: list[pyshtools.SHCoeffs] = []
    while len(drawn) < n:
        degrees = np.arange(len(power))
        clm = pyshtools.SHCoeffs.from_random(
            power * (2 * degrees + 1) / (4 * np.pi), normalization="ortho", csphase=1, seed=seed + len(drawn)
        )
        clm.coeffs[0, 0, 0] = mean
        if clm.expand(grid="DH2").data.min() > 0:
            drawn.append(clm)
        else:
            seed += 1_000_003
    return drawn


def write_dataset(folder: Path, shapes: Sequence[tuple[Array, NDArray[np.int64], Array, Array]]) -> None:
    """An STL a shape and one JSON with the half-spaces, checked by nobody and not brought to the disk."""
    (folder / "meshes").mkdir(parents=True, exist_ok=True)
    entries = []
    for index, (vertices, faces, normals, offsets) in enumerate(shapes):
        mesh = trimesh.Trimesh(vertices, faces)
        mesh.apply_translation(-mesh.center_mass)
        mesh.apply_transform(mesh.principal_inertia_transform)
        mesh.apply_scale(mesh.volume ** (-1 / 3))
        mesh.export(folder / "meshes" / f"particle_{index:04d}.stl")
        entries.append({"weight": 1 / len(shapes), "normals": normals.tolist(), "offsets": offsets.tolist()})
    (folder / "dataset.json").write_text(json.dumps({"representatives": entries}, indent=2))


def repose_angle(points: Array, diameter: float, azimuths: int) -> float:
    """The angle of repose: upper profile in bins of a diameter, a line through each flank, the mean."""
    angles = []
    for turn in np.pi * np.arange(azimuths) / azimuths:
        along = points[:, 0] * np.cos(turn) + points[:, 1] * np.sin(turn)
        across = -points[:, 0] * np.sin(turn) + points[:, 1] * np.cos(turn)
        inside = np.abs(across) < 2.5 * diameter
        x, z = along[inside], points[inside, 2]
        places, heights = [], []
        for left in np.arange(x.min(), x.max(), diameter):
            chosen = (x >= left) & (x < left + diameter)
            if chosen.any():
                places.append(left + diameter / 2)
                heights.append(z[chosen].max())
        where, height = np.array(places), np.array(heights)
        kept = (height > 0.15 * height.max()) & (height < 0.85 * height.max())
        for flank in (where < 0, where > 0):
            slope = stats.linregress(where[kept & flank], height[kept & flank]).slope
            angles.append(np.degrees(np.arctan(abs(slope))))
    return float(np.mean(angles))


def by_trimesh(vertices: np.ndarray, faces: np.ndarray) -> dict[str, float]:
    """The same eight descriptors as the paper's program takes them."""
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    _, extents = trimesh.bounds.oriented_bounds(mesh)
    return {
        "volume": mesh.volume,
        "equivalent_radius": (3.0 * mesh.volume / (4.0 * np.pi)) ** (1 / 3),
        "surface_area": mesh.area,
        "sphericity": np.pi ** (1 / 3) * (6.0 * mesh.volume) ** (2 / 3) / mesh.area,
        "min_diameter": extents.min(),
        "max_diameter": extents.max(),
        "aspect_ratio": extents.max() / extents.min(),
        "convex_hull_volume": mesh.convex_hull.volume,
    }


def fit_harmonics(mesh: trimesh.Trimesh, degree: int, l_max: int) -> pyshtools.SHCoeffs:
    """What one writes first: all hits of a Gauss-Legendre grid, the last of each ray, one expansion."""
    latitude, longitude = pyshtools.expand.GLQGridCoord(degree)
    theta, phi = np.meshgrid(np.radians(90 - latitude), np.radians(longitude), indexing="ij")
    rays = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    rays = rays.reshape(-1, 3)
    origins = np.broadcast_to(mesh.center_mass, rays.shape)
    places, of_ray, _ = mesh.ray.intersects_location(origins, rays, multiple_hits=True)
    radii = np.zeros(len(rays))
    np.maximum.at(radii, of_ray, np.linalg.norm(places - mesh.center_mass, axis=1))
    grid = pyshtools.SHGrid.from_array(radii.reshape(theta.shape), grid="GLQ")
    return grid.expand(normalization="ortho", csphase=1, lmax_calc=l_max)


def radii_of(coefficients: pyshtools.SHCoeffs, directions: np.ndarray) -> np.ndarray:
    """Radii at scattered directions by pyshtools."""
    latitude = np.degrees(np.arcsin(directions[:, 2]))
    longitude = np.degrees(np.arctan2(directions[:, 1], directions[:, 0]))
    return coefficients.expand(lat=latitude, lon=longitude)


def can_cast(mesh: trimesh.Trimesh) -> bool:
    """Whether trimesh finds a library for rays."""
    try:
        mesh.ray.intersects_any([[0.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]])
    except ImportError:
        return False
    return True


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
