"""Brush strokes as voxels."""

import numpy as np

from regolith_studio.imaging.segmentation.strokes import ERASER, Stroke, draw_stroke, painted_rows


def test_that_a_dot_paints_the_voxels_whose_centres_lie_within_its_radius() -> None:
    stroke = draw_stroke(2, 7, np.array([[10.5, 20.5]]), 1.0, (40, 40, 40), 1)
    expected = [(9, 20, 7), (10, 19, 7), (10, 20, 7), (10, 21, 7), (11, 20, 7)]
    assert sorted(map(tuple, stroke.positions.tolist())) == expected


def test_that_a_line_paints_a_band_along_the_axes_of_its_slice() -> None:
    stroke = draw_stroke(1, 5, np.array([[3.0, 8.5], [23.0, 8.5]]), 1.4, (40, 40, 40), 0)
    x, y, z = stroke.positions.T
    assert set(y) == {5}
    assert set(z) == {7, 8, 9}
    assert np.count_nonzero(z == 8) == 22  # 20 voxels and one at each end
    assert (x.min(), x.max()) == (2, 23)


def test_that_a_stroke_ends_at_the_border_of_the_volume() -> None:
    outside = draw_stroke(0, 3, np.array([[-5.0, -5.0], [50.0, 50.0]]), 2.0, (8, 20, 30), 0)
    assert (outside.positions >= 0).all()
    assert (outside.positions < (8, 20, 30)).all()
    assert len(draw_stroke(0, 3, np.array([[-9.0, -9.0]]), 2.0, (8, 20, 30), 0).positions) == 0


def test_that_later_strokes_cover_earlier_ones_and_the_eraser_takes_paint_away() -> None:
    below = Stroke(np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]]), 0)
    above = Stroke(np.array([[2, 0, 0], [3, 0, 0]]), 1)
    eraser = Stroke(np.array([[1, 0, 0], [9, 9, 9]]), ERASER)
    positions, labels, rows = painted_rows([below, above, eraser])
    assert positions.tolist() == [[0, 0, 0], [2, 0, 0], [3, 0, 0]]
    assert labels.tolist() == [0, 1, 1]
    assert rows.tolist() == [0, 3, 4]
