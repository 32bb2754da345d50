"""How well overlapping spheres stand for the polyhedra of a dataset, as a table of docs/changed_shapes.md.

    python -m benchmarks.clumps DATASET [RESULT.json]

Where the package multisphere is there (MSS, arXiv 2603.05877, GPL-3), its spheres are measured the same way.
"""

import json
import sys
import time
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.dataset.multisphere import fit_spheres, sphere_fit_errors
from regolith_studio.dataset.sphere_masses import sphere_masses
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron

COUNTS = (8, 12, 20, 50)
VOXELS_ACROSS = 100
"""Of the grid of MSS, its default."""


def main(folder: Path, result: Path | None) -> None:
    """Print one line a shape and number of spheres, and write them all."""
    rows = []
    for one in read_dataset(folder).representatives:
        for count in COUNTS:
            rows.append({"shape": one.name, "asked": count} | measured(one.shape, count))
            print(rows[-1], flush=True)
    if result is not None:
        result.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def measured(shape: ConvexPolyhedron, count: int) -> dict[str, Any]:
    """Number of spheres, their errors and seconds of processor time; the error of MSS where it is there."""
    begun = time.process_time()
    spheres = fit_spheres(shape, count)
    seconds = round(time.process_time() - begun, 1)
    errors = {key: round(value, 5) for key, value in asdict(sphere_fit_errors(shape, spheres)).items()}
    summed = round(sphere_masses(shape, spheres).inertia_error, 5)
    return {
        "spheres": len(spheres),
        **errors,
        "summed_inertia": summed,
        "seconds": seconds,
        "mss": other_program(shape, count),
    }


def other_program(shape: ConvexPolyhedron, count: int) -> float | None:
    """Jaccard distance of the spheres of MSS."""
    if find_spec("multisphere") is None:
        return None
    import multisphere

    mesh = trimesh.Trimesh(shape.mesh.vertices, shape.mesh.faces)
    pack = multisphere.multisphere_from_mesh(mesh, div=VOXELS_ACROSS, max_spheres=count)
    spheres: FloatArray = np.column_stack([pack.centers, pack.radii])
    return round(sphere_fit_errors(shape, spheres).jaccard, 4)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
