"""Compounds judged by manifold3d and a brute-force box (docs/coarsening.md).

    python -m benchmarks.compounds RESULT.json [APOLLO] [N] [SEED]

40 facets, at most four parts, all six descriptors: the two agglutinates that ship, the scanned rocks in the
folder APOLLO (none with a "-"), and N synthetic agglutinates (60) by the recipe of those that ship, with 3
to 9 balls and up to 16 vesicles. Volume, surface area and overlap are those of manifold3d's booleans of the
written parts, the hull is Qhull's (that of manifold3d was .4 % too small for one rock), and the box of its
corners is searched by benchmarks.independent. Seconds are processor time of a run whose kernels are compiled.
A line a particle; those that the file holds are not made again.
"""

import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
from scipy.spatial import ConvexHull

from benchmarks.independent import least_box
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.readers.particles import read_particles, sample_particles
from tools.make_samples.grains import AgglutinateRecipe

FACETS = 40
KEYS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio", "convex_hull_volume")


def main(result: Path, apollo: str, n: int, seed: int) -> None:
    """Add a row for each particle that is missing, and print a line for each and for each group."""
    rows: dict[str, Any] = json.loads(result.read_text()).get("particles", {}) if result.exists() else {}
    coarsen(sample_particles()[0].mesh, FACETS, "compound")  # loads the kernels
    for group, name, mesh in particles(apollo, n, seed):
        if name not in rows:
            rows[name] = {"group": group, **evaluated(mesh, seed)}
            print(name, rows[name], flush=True)
            content = {"facets": FACETS, "seed": seed, "groups": summary(rows), "particles": rows}
            result.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(summary(rows), indent=1))


def particles(apollo: str, n: int, seed: int) -> Iterator[tuple[str, str, Mesh]]:
    """Group, name and mesh of each."""
    for each in sample_particles():
        if each.name.startswith("agglutinate"):
            yield "shipped", each.name, each.mesh
    if apollo != "-":
        for each in read_particles([Path(apollo)]):
            yield "apollo", each.name, each.mesh
    for k in range(n):
        rng = np.random.default_rng([seed, k])
        recipe = AgglutinateRecipe(
            60.0, n_balls=int(rng.integers(3, 10)), n_vesicles=int(rng.integers(0, 17)), n_faces=3000
        )
        yield "synthetic", f"synthetic-{k}", recipe.make(rng)


def evaluated(mesh: Mesh, seed: int) -> dict[str, Any]:
    """Numbers of the compound and of the convex polyhedron of one particle."""
    wanted = describe(mesh)
    start = time.process_time()
    found = coarsen(mesh, FACETS, "compound", seed=seed)
    seconds = time.process_time() - start
    solid, convex = found.polyhedron, coarsen(mesh, FACETS, "exact", seed=seed)
    parts = solid.part_meshes if isinstance(solid, ConvexCompound) else (solid.mesh,)
    union = manifold3d.Manifold.batch_boolean(list(map(manifold_of, parts)), manifold3d.OpType.Add)
    measured = independent(union)
    body = manifold_of(mesh.moved(shift=-found.centre))
    shells = [shell.volume() for shell in union.decompose()]  # that of a closed pore is negative
    return {
        "solidity": round(wanted["volume"] / wanted["convex_hull_volume"], 4),
        "worst_error": float(max(abs(measured[key] / wanted[key] - 1.0) for key in KEYS)),
        "reason": found.reason,
        "jaccard": round(distance(union, body), 4),
        "jaccard_stated": round(found.jaccard_distance, 4),
        "jaccard_exact": round(distance(manifold_of(convex.polyhedron.mesh), body), 4),
        "parts": found.n_parts,
        "bodies": sum(volume > 0.0 for volume in shells),
        "pores": sum(volume < 0.0 for volume in shells),
        "seconds": round(seconds, 2),
    }


def manifold_of(mesh: Mesh) -> manifold3d.Manifold:
    """A closed mesh for manifold3d."""
    return manifold3d.Manifold(manifold3d.Mesh64(np.array(mesh.vertices), mesh.faces.astype(np.uint64)))


def independent(union: manifold3d.Manifold) -> dict[str, float]:
    """The six descriptors of a union."""
    hull = ConvexHull(np.asarray(union.to_mesh64().vert_properties)[:, :3])
    extents = least_box(hull, 0.5)
    volume, area = union.volume(), union.surface_area()
    return {
        "volume": volume,
        "sphericity": float(np.pi ** (1 / 3) * (6.0 * volume) ** (2 / 3) / area),
        "min_diameter": extents.min(),
        "max_diameter": extents.max(),
        "aspect_ratio": extents.max() / extents.min(),
        "convex_hull_volume": hull.volume,
    }


def distance(one: manifold3d.Manifold, other: manifold3d.Manifold) -> float:
    """Jaccard distance by a boolean."""
    shared = (one ^ other).volume()
    return float(1.0 - shared / (one.volume() + other.volume() - shared))


def summary(rows: dict[str, Any]) -> dict[str, Any]:
    """Of each group: how many are met, and medians."""
    found = {}
    for group in dict.fromkeys(row["group"] for row in rows.values()):
        mine = [row for row in rows.values() if row["group"] == group]
        hollow = [row["jaccard"] / row["jaccard_exact"] for row in mine if row["solidity"] < 0.9]
        found[group] = {
            "n": len(mine),
            "met": sum(row["worst_error"] <= 1e-6 for row in mine),
            "one_body": sum(row["bodies"] == 1 for row in mine),
            "jaccard": spread([row["jaccard"] for row in mine]),
            "ratio_to_exact_below_0.9": spread(hollow),
            "seconds": spread([row["seconds"] for row in mine]),
        }
    return found


def spread(values: list[float]) -> list[float]:
    """Least, median and largest."""
    if not values:
        return []
    return [round(float(each), 4) for each in (min(values), np.median(values), max(values))]


if __name__ == "__main__":
    given = dict(enumerate(sys.argv))
    main(Path(sys.argv[1]), given.get(2, "-"), int(given.get(3, 60)), int(given.get(4, 0)))
