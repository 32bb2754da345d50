"""How well overlapping spheres stand for the polyhedra of a dataset, as a table of docs/exporters.md.

    python -m benchmarks.clumps DATASET [COUNT ...]

Where the package multisphere is there (MSS, arXiv 2603.05877, GPL-3), its spheres are measured the same way.
"""

import sys
import time
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import trimesh

from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.dataset.multisphere import fit_spheres, sphere_fit_errors
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron

VOXELS_ACROSS = 100
"""Of the grid of MSS, its default."""


def main(folder: Path, counts: list[int]) -> None:
    """Print one row a shape and number of spheres."""
    print("| shape | spheres | Jaccard distance | volume, % | inertia, % | area, % | s | MSS |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for one in read_dataset(folder).representatives:
        for count in counts:
            begun = time.process_time()
            spheres = fit_spheres(one.shape, count)
            taken = time.process_time() - begun
            errors = sphere_fit_errors(one.shape, spheres)
            print(
                f"| {one.name} | {len(spheres)} | {errors.jaccard:.3f} | {100 * errors.volume:+.2f} "
                f"| {100 * errors.inertia:.2f} | {100 * errors.area:+.1f} | {taken:.1f} "
                f"| {other_program(one.shape, count)} |",
                flush=True,
            )


def other_program(shape: ConvexPolyhedron, count: int) -> str:
    """Jaccard distance and number of the spheres of MSS, or a dash."""
    if find_spec("multisphere") is None:
        return "-"
    import multisphere

    mesh = trimesh.Trimesh(shape.mesh.vertices, shape.mesh.faces)
    pack = multisphere.multisphere_from_mesh(mesh, div=VOXELS_ACROSS, max_spheres=count)
    spheres: FloatArray = np.column_stack([pack.centers, pack.radii])
    return f"{sphere_fit_errors(shape, spheres).jaccard:.3f} ({len(spheres)})"


if __name__ == "__main__":
    main(Path(sys.argv[1]), [int(word) for word in sys.argv[2:]] or [8, 12, 20, 50])
