"""The scale bar says the truth at every zoom."""

import pytest
import pyvista as pv

from regolith_studio.scene import palette
from regolith_studio.scene.annotations import ScaleBar, bar_length, length_text, show_colour_scale
from regolith_studio.scene.cameras import CameraPose, apply_pose
from regolith_studio.scene.plotter_setup import is_software


@pytest.mark.parametrize(
    ("width", "length"), [(100.0, 20.0), (1000.0, 200.0), (36.0, 10.0), (7.2, 2.0), (3.58, 1.0), (0.0, 0.0)]
)
def test_that_the_bar_is_the_longest_round_length_within_its_share(width, length):
    assert bar_length(width) == pytest.approx(length)


@pytest.mark.parametrize(
    ("micrometres", "text"),
    [(0.05, "50 nm"), (20.0, "20 µm"), (999.0, "999 µm"), (2000.0, "2 mm"), (5e6, "5 m")],
)
def test_that_a_length_is_written_with_the_unit_that_suits_it(micrometres, text):
    assert length_text(micrometres) == text


def test_that_the_bar_follows_zoom_and_stops_when_removed():
    plotter = pv.Plotter(off_screen=True, window_size=[400, 200])
    plotter.add_mesh(pv.Sphere(radius=40.0))
    bar = ScaleBar(plotter)
    apply_pose(plotter, CameraPose((0, -400, 0), (0, 0, 0), (0, 0, 1), 50.0))
    plotter.show(auto_close=False)
    assert bar.text == "50 µm"  # the picture is 200 um wide
    apply_pose(plotter, CameraPose((0, -400, 0), (0, 0, 0), (0, 0, 1), 5.0))
    plotter.render()
    assert bar.text == "5 µm"
    bar.remove()
    apply_pose(plotter, CameraPose((0, -400, 0), (0, 0, 0), (0, 0, 1), 50.0))
    plotter.render()
    assert bar.text == "5 µm"
    plotter.close()


def test_that_there_is_no_bar_where_nothing_is_shown():
    plotter = pv.Plotter(off_screen=True, window_size=[400, 200])
    bar = ScaleBar(plotter)
    plotter.show(auto_close=False)
    empty = plotter.screenshot(return_img=True)
    ball = plotter.add_mesh(pv.Sphere(radius=40.0))
    plotter.render()
    corners = [picture[-40:, :150] for picture in (empty, plotter.screenshot(return_img=True))]
    assert [int(corner.std(axis=(0, 1)).max() > 5) for corner in corners] == [0, 1]
    ball.SetVisibility(False)
    plotter.render()
    assert plotter.screenshot(return_img=True)[-40:, :150].std(axis=(0, 1)).max() < 5
    bar.remove()
    plotter.close()


def test_that_a_software_renderer_is_known_by_its_name():
    assert is_software("OpenGL renderer string:  llvmpipe (LLVM 15.0.6, 256 bits)")
    assert not is_software("OpenGL renderer string:  NVIDIA GeForce RTX 3060/PCIe/SSE2")


def test_that_the_numbers_of_a_colour_scale_have_room_in_a_narrow_view():
    plotter = pv.Plotter(off_screen=True, window_size=[180, 330])
    ball = pv.Sphere(radius=1.0)
    ball["distance"] = 15.0 * ball.points[:, 2]
    actor = plotter.add_mesh(ball, scalars="distance", show_scalar_bar=False)
    plotter.camera.zoom(0.1)
    show_colour_scale(plotter, actor.mapper, palette.PAPER)
    picture = plotter.screenshot(return_img=True).astype(int)
    dark = (picture.sum(axis=2) < 300).nonzero()
    plotter.close()
    lower = dark[1][dark[0] > 200]
    assert lower.min() < 150, "the numbers are there"
    assert lower.max() < 176, "and nothing is cut by the edge"
