"""The plain programs: what one writes first with trimesh, scipy, scikit-image and pyshtools.

Those of descriptors, harmonics and coarsening stand in the modules of these names. None of them imports
anything of the program.
"""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyshtools
import trimesh
from numpy.typing import NDArray
from scipy import stats
from skimage import measure

Array = NDArray[np.float64]


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
