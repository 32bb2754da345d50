"""Descriptors, the exact box and ray casting against the plain trimesh program, interleaved.

Run as ``python -m benchmarks.descriptors``. Both sides of a pair run one after the other, many times;
the ratio of each round is taken, so that a busy machine slows both alike. Printed are the median ratio
and the range that holds the middle 80 % of the rounds.
"""

import time
from collections.abc import Callable

import numpy as np
import trimesh

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces, Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere

KEYS = tuple(CATALOGUE)[:8]


def stone(level: int, seed: int = 0) -> Mesh:
    """An angular star-shaped particle: a ball with bumps, cut by random planes; level 4 has 5,120 faces."""
    rng = np.random.default_rng(seed)
    sphere = icosphere(level)
    u = sphere.vertices
    bumps = sum(0.04 * np.sin(u @ rng.normal(size=3) * k + rng.uniform(0, 6)) for k in range(2, 9))
    cuts = HalfSpaces(rng.normal(size=(18, 3)), rng.uniform(0.7, 1.1, 18))
    radius = np.minimum(1.0 + bumps, cuts.radii(u))
    return Mesh(u * radius[:, None] * [1.2, 1.0, 0.8], sphere.faces)


def polyhedron(n_facets: int, seed: int = 0) -> ConvexPolyhedron:
    """A random polyhedron of the kind that coarsening returns."""
    directions = fibonacci_directions(n_facets) + 0.1 * np.random.default_rng(seed).normal(size=(n_facets, 3))
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(directions, np.linspace(0.8, 1.2, n_facets)))


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


def seconds(work: Callable[[], object]) -> float:
    """Processor seconds of one call."""
    start = time.process_time()
    work()
    return time.process_time() - start


def compare(name: str, ours: Callable[[], object], theirs: Callable[[], object], rounds: int = 15) -> None:
    """Print times and ratios of two pieces of work that run in turns."""
    ours(), theirs()
    pairs = np.array([(seconds(ours), seconds(theirs)) for _ in range(rounds)])
    ratio = pairs[:, 1] / np.maximum(pairs[:, 0], 1e-7)
    low, middle, high = np.quantile(ratio, [0.1, 0.5, 0.9])
    mine, other = np.median(pairs, axis=0) * 1e3
    print(f"{name:<52}{mine:>10.2f} ms{other:>10.2f} ms{middle:>8.1f} x   ({low:.1f} to {high:.1f})")


def rays_by_trimesh(mesh: Mesh, directions: np.ndarray) -> object:
    """All crossings by trimesh's own caster (needs rtree)."""
    other = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    return other.ray.intersects_location(np.zeros_like(directions), directions, multiple_hits=True)


def fresh(mesh: Mesh) -> Mesh:
    """A copy without cached results."""
    return Mesh(mesh.vertices, mesh.faces)


def main() -> None:
    """Print the table."""
    print(f"{'':<52}{'here':>13}{'trimesh':>13}{'ratio':>10}   (80 % of rounds)")
    fine, coarse = stone(4), polyhedron(20)
    print(f"particle: {len(fine.faces):,} faces, hull of {len(fine.hull.faces):,} faces")
    compare(
        "describe, eight descriptors, particle",
        lambda: describe(fresh(fine), KEYS),
        lambda: by_trimesh(fine.vertices, fine.faces),
    )
    compare(
        "describe, all quick ones, particle",
        lambda: describe(fresh(fine)),
        lambda: by_trimesh(fine.vertices, fine.faces),
    )
    solid = coarse.mesh
    compare(
        "describe, eight descriptors, 20 facets",
        lambda: describe(ConvexPolyhedron(coarse.half_spaces, coarse.vertices, coarse.facets), KEYS),
        lambda: by_trimesh(solid.vertices, solid.faces),
    )
    fine_hull = fine.hull
    compare(
        "bounding box, hull of the particle (exact | heuristic)",
        lambda: minimum_volume_box(fresh(fine_hull)),
        lambda: trimesh.bounds.oriented_bounds(fine_hull.vertices),
    )
    compare(
        "bounding box, 20 facets (exact | heuristic)",
        lambda: minimum_volume_box(coarse),
        lambda: trimesh.bounds.oriented_bounds(solid.vertices),
    )
    directions = fibonacci_directions(7381)
    compare(
        "7,381 rays, particle",
        lambda: radial_hits(fine, np.zeros(3), directions),
        lambda: rays_by_trimesh(fine, directions),
        rounds=3,
    )
    large = stone(6)
    took = seconds(lambda: radial_hits(large, np.zeros(3), directions))
    print(f"7,381 rays on {len(large.faces):,} faces: {1e3 * took:.1f} ms")


if __name__ == "__main__":
    main()
