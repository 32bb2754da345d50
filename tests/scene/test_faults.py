"""Where a mesh is wrong, drawn on the mesh."""

import numpy as np
import pytest
import pyvista as pv

from regolith_studio.scene.overlays import FAULT_COLOURS, show_faults, show_hidden
from regolith_studio.scene.surfaces import show_particle


def picture(*draw):
    plotter = pv.Plotter(off_screen=True, window_size=(300, 300))
    for each in draw:
        each(plotter)
    plotter.camera_position = "iso"
    plotter.reset_camera()
    image = plotter.screenshot(None, return_img=True).astype(int)
    plotter.close()
    return image


def hidden_faces(ball):
    return lambda plotter: show_hidden(plotter, ball, np.ones(len(ball.faces), dtype=bool))


def faults(kind, ball):
    return lambda plotter: show_faults(plotter, {kind: ball.triangles})


@pytest.mark.parametrize("kind", [*list(FAULT_COLOURS)[:2], None])
def test_that_the_particle_does_not_show_through_what_is_marked_on_it(ball, kind):
    marks = hidden_faces(ball) if kind is None else faults(kind, ball)
    alone, on_the_particle = picture(marks), picture(lambda plotter: show_particle(plotter, ball), marks)
    assert np.abs(on_the_particle - alone).max(axis=2).mean() < 0.2
    assert np.abs(alone - alone[0, 0]).max(axis=2).mean() > 20.0
