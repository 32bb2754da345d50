import numpy as np
import pytest
import pyvista as pv

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.scene import plotter_setup
from regolith_studio.scene.cameras import apply_pose
from regolith_studio.scene.figure import gallery_pose, show_gallery


def ball(radius: float) -> Mesh:
    return Mesh(icosphere(2).vertices * radius + [5.0, -3.0, 40.0], icosphere(2).faces)


@pytest.fixture
def plotter():
    plotter_setup.choose_off_screen_window()
    made = pv.Plotter(off_screen=True, window_size=[600, 400])
    plotter_setup.set_stage(made)
    yield made
    made.close()


def coloured_halves(plotter) -> tuple[float, float]:
    """Mean of red minus blue in the upper and in the lower half: measured is warm, drawn is blue."""
    picture = plotter.screenshot(return_img=True).astype(float)
    warm = picture[..., 0] - picture[..., 2]
    return float(warm[:200].max()), float(warm[200:].min())


def test_that_measured_particles_stand_above_drawn_ones(plotter):
    measured, drawn = [ball(1.0), ball(2.0), ball(1.5)], [ball(2.0), ball(1.0)]
    show_gallery(plotter, measured, drawn)
    apply_pose(plotter, gallery_pose(measured, drawn, 1.5))
    above, below = coloured_halves(plotter)
    assert above > 3
    assert below < -30


@pytest.mark.parametrize("aspect", [0.5, 1.0, 3.0])
def test_that_all_particles_are_in_the_picture(aspect):
    """Six of diameter 2 with gaps of an eighth of it in a row of about 13.4; two rows."""
    meshes = [ball(1.0)] * 6
    pose = gallery_pose(meshes, meshes, aspect)
    assert pose.parallel_scale * 2 >= 2 * 2 * 1.1
    assert pose.parallel_scale * 2 * aspect >= 6 * 2 * 1.1
    assert np.asarray(pose.focal_point)[1] == pytest.approx(0.0)


@pytest.mark.parametrize("aspect", [0.5, 1.0, 3.0])
def test_that_the_foot_of_a_gallery_stays_free_for_the_scale_bar(aspect):
    meshes = [ball(1.0)] * 6
    pose = gallery_pose(meshes, meshes, aspect, 0.2)
    height = 2 * pose.parallel_scale
    lower_edge = pose.focal_point[2] - pose.parallel_scale
    lowest = -2 * 1.12 - 1.0
    assert lowest - lower_edge >= 0.2 * height - 1e-9
    assert pose.focal_point[2] + pose.parallel_scale >= 1.0, "the upper row is whole"
