"""Box and star point: drawn once, moved afterwards, taken away."""

import numpy as np
import pytest
import pyvista as pv

from regolith_studio.geometry.oriented_box import OrientedBox
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.scene import overlays, surfaces


@pytest.fixture
def plotter():
    made = pv.Plotter(off_screen=True, window_size=[120, 120])
    yield made
    made.close()


def test_that_the_edges_of_a_box_are_as_long_as_its_extents(plotter) -> None:
    box = OrientedBox(np.array([1.0, 2.0, 3.0]), np.eye(3), np.array([6.0, 4.0, 2.0]))
    overlays.show_box(plotter, box.corners)
    lines = plotter.actors[overlays.BOX].mapper.dataset
    ends = lines.points[lines.lines.reshape(-1, 3)[:, 1:]]
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    assert sorted(np.round(lengths, 6)) == [2.0] * 4 + [4.0] * 4 + [6.0] * 4


def test_that_extras_come_once_and_go(plotter) -> None:
    for shift in (0.0, 1.0):
        overlays.show_star_point(plotter, (shift, 0, 0), 2.0)
        overlays.show_box(plotter, np.eye(8, 3))
    assert set(plotter.actors) == {overlays.STAR_POINT, overlays.BOX}
    assert plotter.actors[overlays.STAR_POINT].mapper.dataset.center[0] == pytest.approx(1.0, abs=1e-6)
    overlays.show_star_point(plotter, None)
    overlays.show_box(plotter, None)
    assert not any(actor.GetVisibility() for actor in plotter.actors.values())


def test_that_the_star_point_is_seen_through_the_surface(plotter) -> None:
    surfaces.show_particle(plotter, icosphere(3))
    plotter.camera_position = "xy"
    plain = plotter.screenshot(return_img=True).astype(int)
    overlays.show_star_point(plotter, (0, 0, 0), 4.0)
    plotter.render()
    marked = plotter.screenshot(return_img=True).astype(int)
    assert np.abs(marked - plain).max() > 25
    overlays.show_star_point(plotter, None)
    plotter.render()
    assert np.abs(plotter.screenshot(return_img=True).astype(int) - plain).max() < 3


def test_that_only_the_hidden_faces_are_coloured_and_go_again(plotter) -> None:
    ball = icosphere(1)
    hidden = ball.triangles[:, :, 2].min(axis=1) > 0.0
    overlays.show_hidden(plotter, ball, hidden)
    shown = plotter.actors[overlays.HIDDEN]
    assert shown.mapper.dataset.n_cells == hidden.sum() > 0
    assert shown.mapper.dataset.points[np.unique(shown.mapper.dataset.regular_faces)][:, 2].min() > 0.0
    overlays.show_hidden(plotter, ball, np.zeros_like(hidden))
    assert not shown.GetVisibility()
