"""Animated files, larger pictures whose scale bar stays true, transparency."""

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

from regolith_studio.errors import InputError
from regolith_studio.scene import plotter_setup, surfaces
from regolith_studio.scene.animation import save_animation
from regolith_studio.scene.cameras import apply_pose, framing_pose
from regolith_studio.scene.figure import VIEW_SIZE, three_views


def dark_width(picture):
    """Pixels from the first to the last column that is not white."""
    columns = np.flatnonzero((picture[..., :3] < 215).any(axis=(0, 2)))
    return int(np.ptp(columns)) + 1


def test_that_a_sequence_of_pictures_is_numbered_and_holds_every_frame(tmp_path):
    frames = [np.full((4, 6, 3), 20 * number, dtype=np.uint8) for number in range(3)]
    save_animation(frames, [0.1] * 3, tmp_path / "turn.png")
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"turn-{n:03d}.png" for n in range(3)]
    for number, frame in enumerate(frames):
        np.testing.assert_array_equal(np.array(Image.open(tmp_path / f"turn-{number:03d}.png")), frame)


def test_that_an_animation_of_an_unknown_kind_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"\.gif or \.webp"):
        save_animation([np.zeros((4, 4, 3), dtype=np.uint8)], [0.1], tmp_path / "a.avi")


@pytest.mark.parametrize("scale", [1, 3])
@pytest.mark.slow
def test_that_the_scale_bar_of_a_figure_is_true_at_any_scale(ball, cube, scale):
    picture = three_views(ball, ball, cube, ("a", "b", "c"), scale=scale, direction="front")
    width, height = (scale * each for each in VIEW_SIZE)
    assert picture.shape == (height, 3 * width, 3)
    view = picture[:, :width].astype(int).sum(axis=2)
    bar = (view[round(0.94 * height) :] < 300).sum(axis=1).max()
    wide = dark_width(picture[height // 2 - 2 : height // 2 + 2, :width])
    assert bar / wide * 60.0 == pytest.approx(20.0, rel=0.03)  # 20 um beside a ball of 60 um


@pytest.mark.parametrize("scale", [1, 2])
def test_that_a_picture_without_background_covers_the_body_only(ball, scale):
    plotter_setup.choose_off_screen_window()
    plotter = pv.Plotter(off_screen=True, window_size=[120, 100])
    plotter_setup.set_stage(plotter)
    surfaces.show_particle(plotter, ball)
    apply_pose(plotter, framing_pose(ball.vertices))
    found = plotter_setup.thumbnail(plotter, scale, transparent=True)
    plain = plotter_setup.thumbnail(plotter, scale)
    plotter.close()
    assert found.shape == (100 * scale, 120 * scale, 4)
    covered = (found[..., 3] > 128).mean()
    radius = 50 * 0.85
    assert covered == pytest.approx(np.pi * radius**2 / (120 * 100), rel=0.03)
    middle = (slice(40 * scale, 60 * scale), slice(50 * scale, 70 * scale))
    assert np.abs(found[middle][..., :3].astype(int) - plain[middle]).max() <= 2
