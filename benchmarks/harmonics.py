"""Fits and surfaces against plain trimesh and pyshtools, side by side in one process.

    python benchmarks/harmonics.py [--repeats 9]

Both sides take the same mesh, cast the same rays and expand to l = 30; rounds are interleaved, so that
what else the machine does hits both alike. Printed are medians of processor time in milliseconds, and the
ratio of each round (median, least and greatest). trimesh casts rays through embreex where that is installed,
else through rtree; without either its side is left out.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pyshtools
import trimesh

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees, to_pyshtools
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.surface import reconstruct
from regolith_studio.harmonics.synthesis import radii_on_icosphere
from regolith_studio.harmonics.transform import ray_grid
from regolith_studio.studies.lmax import lmax_study


@dataclass(frozen=True)
class Contest:
    """Two ways to do one thing; `plain` may be missing."""

    title: str
    ours: Callable[[], object]
    plain: Callable[[], object] | None


def rough_particle(seed: int, l_max: int = 30) -> ShCoefficients:
    """A star-shaped particle with the amplitudes of real cement grains, mean radius 10."""
    rng = np.random.default_rng(seed)
    degree = degrees((l_max + 1) ** 2)
    values = rng.normal(size=len(degree)) * 0.35 * (degree + 1.0) ** -2 * np.sqrt(4 * np.pi)
    values[0] = np.sqrt(4 * np.pi)
    return ShCoefficients(values * 10)


def plain_fit(mesh: trimesh.Trimesh, degree: int, l_max: int) -> pyshtools.SHCoeffs:
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


def plain_surface(coefficients: pyshtools.SHCoeffs, directions: np.ndarray) -> np.ndarray:
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


def contests() -> list[Contest]:
    """The rows of the printed table."""
    rows = []
    for level in (4, 6):
        surface = reconstruct(rough_particle(1), level=level)
        loaded = trimesh.Trimesh(surface.vertices, surface.faces, process=False)
        plain = (lambda m=loaded: plain_fit(m.copy(), 60, 30)) if can_cast(loaded) else None
        title = f"rays of degree 60 and fit to l = 30, {len(surface.faces)} faces"
        rows.append(Contest(title, lambda s=surface: fit_harmonics(Mesh(s.vertices, s.faces)), plain))
    particle = rough_particle(2)
    for level, l_max in ((4, 10), (4, 30), (5, 10), (5, 30)):
        cut, directions = particle.truncated(l_max), icosphere(level).vertices
        theirs = pyshtools.SHCoeffs.from_array(to_pyshtools(cut), normalization="ortho", csphase=1)
        title = f"synthesis at l = {l_max}, {len(directions)} vertices"
        ours = lambda c=cut, k=level: radii_on_icosphere(c, k)  # noqa: E731
        rows.append(Contest(title, ours, lambda t=theirs, d=directions: plain_surface(t, d)))
    for l_max in (10, 30):
        title = f"closed mesh at l = {l_max}, 5,120 faces, exact volume"
        rows.append(Contest(title, lambda n=l_max: reconstruct(particle, n), None))
    return rows


def seconds(action: Callable[[], object]) -> float:
    """Processor time of one call."""
    start = time.process_time()
    action()
    return time.process_time() - start


def compare(contest: Contest, repeats: int) -> str:
    """One printed row."""
    sides = [contest.ours] if contest.plain is None else [contest.ours, contest.plain]
    for side in sides:
        side()
    rounds = np.array([[seconds(side) for side in sides] for _ in range(repeats)]) * 1e3
    row = f"{contest.title:58s} {np.median(rounds[:, 0]):9.2f}"
    if contest.plain is None:
        return row
    ratio = rounds[:, 1] / rounds[:, 0]
    spread = f"{np.median(ratio):7.1f} ({ratio.min():.1f} to {ratio.max():.1f})"
    return f"{row} {np.median(rounds[:, 1]):9.2f} {spread}"


def study_seconds(n_particles: int) -> str:
    """Processor time of Fig. 3 for a particle, and what 150 particles would take on two free cores."""
    sample = [Particle(f"p{i}", reconstruct(rough_particle(i), level=4)) for i in range(n_particles)]
    start = time.process_time()
    for _ in lmax_study(sample, range(1, 21)):
        pass
    each = (time.process_time() - start) / n_particles
    return f"Fig. 3, l = 1..20: {each:.2f} s of a core a particle, {75 * each:.0f} s for 150 on two"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--particles", type=int, default=5)
    options = parser.parse_args()
    engine = type(trimesh.creation.box().ray).__module__.rsplit(".", 1)[-1]
    print(f"rays a fit: {len(ray_grid(60).directions)}; rays of trimesh by {engine}")
    print(f"{'':58s} {'ours ms':>9s} {'plain ms':>9s}   ratio")
    for contest in contests():
        print(compare(contest, options.repeats), flush=True)
    print(study_seconds(options.particles))
