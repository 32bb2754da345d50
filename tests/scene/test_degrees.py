"""Pictures of one particle at several degrees."""

import numpy as np
from PIL import Image

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.scene.animation import CELL_SIZE, degree_animation, degree_picture


def spheroid(ball: Mesh) -> Mesh:
    return Mesh(ball.vertices * [1.0, 0.6, 0.4], ball.faces)


def silhouettes(picture: np.ndarray, columns: int) -> list[int]:
    """Number of pixels of each cell of the first row that are not paper."""
    width, height = CELL_SIZE
    cells = [picture[40:height, k * width : (k + 1) * width] for k in range(columns)]
    return [int((np.ptp(cell.astype(int), axis=2) > 12).sum()) for cell in cells]


def test_that_the_picture_shows_the_particle_and_then_each_degree(ball, tmp_path):
    flat = spheroid(ball)
    picture = degree_picture(flat, fit_harmonics(flat, 8), (0, 8), tmp_path / "degrees.png", level=3)
    assert picture.shape == (CELL_SIZE[1], 3 * CELL_SIZE[0], 3)
    _, round_one, flat_one = silhouettes(picture, 3)
    assert round_one > 100
    assert abs(flat_one - round_one) > 0.03 * round_one
    with Image.open(tmp_path / "degrees.png") as file:
        assert file.size == (3 * CELL_SIZE[0], CELL_SIZE[1])


def test_that_an_animation_has_a_frame_a_degree_and_rests_on_the_last(ball, tmp_path):
    flat = spheroid(ball)
    degree_animation(flat, fit_harmonics(flat, 4), range(5), tmp_path / "degrees.gif", level=2)
    with Image.open(tmp_path / "degrees.gif") as animation:
        durations = []
        for frame in range(animation.n_frames):
            animation.seek(frame)
            durations.append(animation.info["duration"])
    assert durations == [250, 250, 250, 250, 1500]


def test_that_a_degree_with_a_negative_radius_keeps_its_place(ball):
    values = np.zeros(9)
    values[0], values[6] = 90.0, 1800.0
    broken = HarmonicFit(ShCoefficients(values), np.zeros(3))
    picture = degree_picture(ball, broken, (0, 2), level=2)
    _, whole, empty = silhouettes(picture, 3)
    assert whole > 100
    assert empty == 0
