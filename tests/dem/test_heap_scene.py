"""Particles of a simulation in three dimensions: where they are, and that instances are reused."""

import numpy as np
import pytest
import pyvista as pv

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.scene import cameras, instancing, plotter_setup


def _at(points: np.ndarray, wall: float = float("inf")) -> ParticleState:
    n = len(points)
    return ParticleState(
        points, np.full(n, 2e-3), np.tile([1.0, 0, 0, 0], (n, 1)), np.zeros(n, dtype=int), wall=wall
    )


@pytest.fixture
def plotter():
    plotter_setup.choose_off_screen_window()
    made = pv.Plotter(off_screen=True, window_size=[200, 160])
    plotter_setup.set_stage(made)
    yield made
    made.close()


def _seen(plotter: pv.Plotter, half_height: float) -> tuple[float, float, float, float]:
    """Left, right, lower and upper edge of what is drawn, seen from above, in micrometres."""
    pose = cameras.CameraPose((0, 0, 1e5), (0, 0, 0), (0, 1, 0), half_height)
    cameras.apply_pose(plotter, pose)
    plotter.render()
    picture = plotter.screenshot(return_img=True).astype(int)
    drawn = picture[:, :, 0] - picture[:, :, 2] > 15  # sand is yellow, the background is not
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    pixel = 2 * half_height / picture.shape[0]
    across = pixel * (np.array([columns[0], columns[-1] + 1]) - picture.shape[1] / 2)
    up = pixel * (picture.shape[0] / 2 - np.array([rows[-1] + 1, rows[0]]))
    return (*across, *up)


def test_that_a_particle_is_drawn_where_it_is_and_as_large(boxes: Dataset, plotter: pv.Plotter) -> None:
    shapes = tuple((each.shape.vertices,) for each in boxes.representatives)
    half = 1e3 * (np.pi / 6) ** (1 / 3)
    instancing.show_heap(plotter, shapes, _at(np.array([[0.003, 0.001, 0.0]])))
    assert _seen(plotter, 6000) == pytest.approx([3e3 - half, 3e3 + half, 1e3 - half, 1e3 + half], abs=120)
    eighth = ParticleState(np.zeros((1, 3)), [2e-3], [[np.cos(np.pi / 8), 0, 0, np.sin(np.pi / 8)]], [0])
    instancing.show_heap(plotter, shapes, eighth)
    corner = half * np.sqrt(2)
    assert _seen(plotter, 6000) == pytest.approx([-corner, corner, -corner, corner], abs=120)
    instancing.show_heap(plotter, shapes, _at(np.zeros((1, 3))), spheres=True)
    assert _seen(plotter, 6000) == pytest.approx([-1e3, 1e3, -1e3, 1e3], abs=120)


def test_that_the_cylinder_rises_and_goes(plotter: pv.Plotter) -> None:
    instancing.show_apparatus(plotter, _at(np.zeros((1, 3)), wall=0.03), 0.02, 0.08, 0.05)
    tube = plotter.actors[instancing.CYLINDER]
    assert tube.GetBounds()[4:] == pytest.approx((3e4, 1.1e5))
    assert tube.GetBounds()[:2] == pytest.approx((-1e4, 1e4), rel=1e-3)
    instancing.show_apparatus(plotter, _at(np.zeros((1, 3))), 0.02, 0.08, 0.05)
    assert not tube.GetVisibility()
