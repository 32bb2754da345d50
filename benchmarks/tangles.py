"""Seconds that reading and measuring take with meshes that nothing sound can be made of.

Run with ``python -m benchmarks.tangles``; each mesh is repaired, and measured as it is, in a process of its
own. A kind whose seconds grow much faster than its faces has a step that is worse than n log n.
"""

import multiprocessing
import sys
import time
from collections.abc import Callable

import numpy as np

from regolith_studio.errors import RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.repair import repair
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.particle_jobs import measure_particle

SIZES = (1_000, 10_000, 100_000, 300_000)


def few_points(n: int, points: int = 300) -> Mesh:
    """Random faces on a few hundred points: nearly all edges have more than two faces."""
    rng = np.random.default_rng(0)
    return Mesh(rng.normal(size=(points, 3)), rng.integers(0, points, (n, 3)))


def soup(n: int) -> Mesh:
    """Triangles with corners of their own, a tenth as large as the whole."""
    rng = np.random.default_rng(0)
    corners = rng.random((n, 1, 3)) + 0.1 * rng.normal(size=(n, 3, 3))
    return Mesh(corners.reshape(-1, 3), np.arange(3 * n).reshape(-1, 3))


def shells(n: int) -> Mesh:
    """A hundred spheres that cross each other."""
    rng = np.random.default_rng(0)
    level = max(0, round(np.log(n / 100 / 20) / np.log(4)))
    ball = icosphere(level)
    vertices = [ball.vertices + 0.3 * rng.normal(size=3) for _ in range(100)]
    faces = [ball.faces + k * len(ball.vertices) for k in range(100)]
    return Mesh(np.concatenate(vertices), np.concatenate(faces))


def book(n: int) -> Mesh:
    """All faces at one edge, as the pages of a book."""
    angle = np.random.default_rng(0).random(n) * 2 * np.pi
    edge = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    pages = np.column_stack([np.cos(angle), np.sin(angle), np.full(n, 0.5)])
    turn = np.random.default_rng(1).random(n) < 0.5
    start, stop = np.where(turn, 0, 1), np.where(turn, 1, 0)
    return Mesh(np.concatenate([edge, pages]), np.column_stack([start, stop, np.arange(n) + 2]))


def torn(n: int) -> Mesh:
    """A sphere without a random half of its faces: holes of all lengths."""
    ball = icosphere(max(1, round(np.log(n / 10) / np.log(4))))
    keep = np.random.default_rng(0).random(len(ball.faces)) < 0.5
    return Mesh(ball.vertices, ball.faces[keep])


def shuffled(n: int) -> Mesh:
    """A closed sphere whose vertices have changed places at random: all faces cross."""
    ball = icosphere(max(1, round(np.log(n / 20) / np.log(4))))
    return Mesh(np.random.default_rng(0).permutation(ball.vertices), ball.faces)


def glued(n: int) -> Mesh:
    """A soup of small triangles whose corners are rounded to a coarse grid: walls of all kinds."""
    rng = np.random.default_rng(0)
    side = max(3, round((n / 4) ** (1 / 3)))
    corners = rng.integers(0, side, (n, 1, 3)) + rng.integers(0, 2, (n, 3, 3))
    points, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return Mesh(points.astype(np.float64), index.reshape(-1, 3))


TANGLES: dict[str, Callable[[int], Mesh]] = {
    each.__name__: each for each in (few_points, soup, shells, book, torn, shuffled, glued)
}


def repaired(mesh: Mesh) -> str:
    """What the repair says."""
    try:
        return "; ".join(repair(mesh).actions)
    except RegolithError as error:
        return str(error)


def measured(mesh: Mesh) -> str:
    """What the measuring of the mesh as it is says."""
    try:
        return measure_particle(Particle("tangle", mesh)).problem
    except RegolithError as error:
        return str(error)


def _timed(kind: str, n: int, act: Callable[[Mesh], str], answer: "multiprocessing.Queue[object]") -> None:
    act(TANGLES[kind](1_000))  # compiles
    mesh = TANGLES[kind](n)
    begun = time.process_time()
    said = act(mesh)
    import resource

    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    answer.put((len(mesh.faces), time.process_time() - begun, memory, said))


def main(sizes: tuple[int, ...], limit: float = 60.0) -> None:
    """Print a table: processor seconds, memory and what was said."""
    sys.stdout.write("| kind | work | faces | s | MB | sentence |\n| --- | --- | --- | --- | --- | --- |\n")
    for kind in TANGLES:
        for act in (repaired, measured):
            for n in sizes:
                answer: multiprocessing.Queue[object] = multiprocessing.Queue()
                child = multiprocessing.Process(target=_timed, args=(kind, n, act, answer))
                child.start()
                try:
                    faces, seconds, memory, said = answer.get(timeout=limit)  # type: ignore[misc]
                    row = f"{faces:,} | {seconds:.2f} | {memory} | {said[:90]}"
                except Exception:  # noqa: BLE001 - an empty queue: too slow, or dead
                    row = f"{n:,} | over {limit:g} | | "
                child.kill()
                child.join()
                sys.stdout.write(f"| {kind} | {act.__name__} | {row} |\n")
                sys.stdout.flush()


if __name__ == "__main__":
    main(tuple(map(int, sys.argv[1:])) or SIZES)
