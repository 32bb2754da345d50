"""Processor time of pictures of a large heap: ``python -m benchmarks.heap_pictures [PARTICLES]``.

A cone of particles of 20 facets, as the page *Angle of repose* draws it, off-screen at 1180 x 440: all
particles; those that are not hidden, as at rest; and octahedra for the outermost, as while the view turns.
"""

import sys
import time
from itertools import repeat

import numpy as np
import pyvista as pv
from scipy.spatial.transform import Rotation

from benchmarks.heaps import KINDS, heap
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.scene import cameras, instancing, plotter_setup
from tests.dataset.example import polyhedron

SIZE = (1180, 440)
N_SHAPES, N_PICTURES = 12, 5
MEAN_DIAMETER = 4.4e-4


def main(n: int) -> None:
    """Print milliseconds of processor time a picture, and of the clock."""
    centres, diameters = (each[:n] for each in heap(30.0, n, 1, KINDS["equal, noise and loose grains"]))
    turns = Rotation.random(n, random_state=1).as_quat(scalar_first=True)
    kinds = np.random.default_rng(1).integers(0, N_SHAPES, n)
    pile = ParticleState(MEAN_DIAMETER * centres, MEAN_DIAMETER * diameters, turns, kinds)
    bodies = map(polyhedron, range(N_SHAPES), repeat(20))
    shapes = [((each.vertices - each.mesh.centroid) / each.volume ** (1 / 3),) for each in bodies]
    reach, top = (float(pile.points[:, axis].max()) for axis in (0, 2))
    few = instancing.MANY_TRIANGLES
    for name, limit, coarse in (("all", 10**12, False), ("at rest", few, False), ("turning", few, True)):
        instancing.MANY_TRIANGLES = limit
        plotter_setup.choose_off_screen_window()
        plotter = pv.Plotter(off_screen=True, window_size=list(SIZE))
        plotter_setup.set_stage(plotter)
        instancing.show_heap(plotter, shapes, pile, coarse=coarse)
        low_side = cameras.Direction("", (0.35, -1.0, 0.22), (0.0, 0.0, 1.0))
        pose = cameras.framing_pose(instancing.box_corners(reach, top), low_side, SIZE[0] / SIZE[1])
        cameras.apply_pose(plotter, pose)
        plotter.render_window.Render()
        plotter_setup.smooth_edges(plotter)
        plotter.render_window.Render()
        clock, processor = time.perf_counter(), time.process_time()
        for _ in range(N_PICTURES):
            pose = cameras.orbited(pose, 0.02, 0.0)
            cameras.apply_pose(plotter, pose)
            plotter.render_window.Render()
        spent = [
            1e3 / N_PICTURES * each for each in (time.process_time() - processor, time.perf_counter() - clock)
        ]
        print(f"{name:8} {spent[0]:6.0f} ms of processor time, {spent[1]:6.0f} ms of the clock")
        plotter.close()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000)
