"""Small inputs for every command: meshes, labels, fits, a recipe, a dataset, a heap."""

import json
from pathlib import Path

import numpy as np

from regolith_studio.cli.entry import run
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes


def write_inputs(folder: Path) -> None:
    """Fill a folder."""
    rng = np.random.default_rng(0)
    _write_ellipsoids(folder / "meshes", 3, rng)
    _write_ellipsoids(folder / "many", 20, rng)  # as few as models are judged by
    np.save(folder / "labels.npy", _labels())
    recipe = {"inputs": ["meshes"], "method": "quadric", "n_facets": 12, "outputs": {"summary": True}}
    (folder / "recipe.json").write_text(json.dumps(recipe))
    (folder / "heap.csv").write_text(_heap(rng))
    meshes = str(folder / "meshes")
    for words in (
        ["fit", meshes, "-o", str(folder / "fit.json"), "--l-max", "6"],
        ["fit", str(folder / "many"), "-o", str(folder / "many.json"), "--l-max", "3"],
        ["dataset", "build", meshes, "-o", str(folder / "dataset"), "--method", "quadric", "--facets", "8"],
    ):
        if run(words):
            raise SystemExit(f"{' '.join(words)} failed")


def _write_ellipsoids(folder: Path, count: int, rng: np.random.Generator) -> None:
    folder.mkdir()
    ball = icosphere(2)
    for k in range(count):
        mesh = Mesh(ball.vertices * rng.uniform(10.0, 40.0, 3), ball.faces)
        (folder / f"grain-{k}.stl").write_bytes(stl_bytes(mesh.triangles, "grain"))


def _labels() -> np.ndarray:
    """Balls of 16 voxels in a grid."""
    z, y, x = np.indices((20, 40, 40))
    inside = (z % 20 - 10) ** 2 + (y % 20 - 10) ** 2 + (x % 20 - 10) ** 2 < 64
    number = 1 + z // 20 + 3 * (y // 20) + 9 * (x // 20)
    return (inside * number).astype(np.uint8)


def _heap(rng: np.random.Generator) -> str:
    """Centres of 3,000 particles in a cone of 30 degrees, metres."""
    points = rng.uniform([-0.02, -0.02, 0.0], [0.02, 0.02, 0.0116], (60_000, 3))
    radius = np.hypot(points[:, 0], points[:, 1])
    points = points[points[:, 2] < np.tan(np.radians(30.0)) * (0.02 - radius)][:3000]
    lines = [f"{x:.6f},{y:.6f},{z:.6f},0.0006" for x, y, z in points]
    return "\n".join(["x,y,z,diameter", *lines]) + "\n"
