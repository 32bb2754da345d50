"""The picture of the three views."""

from itertools import pairwise

import numpy as np
from PIL import Image

from regolith_studio.scene.figure import VIEW_SIZE, three_views, view_titles


def test_that_the_picture_shows_three_different_things(ball, cube, tmp_path):
    titles = view_titles("Particle", 10, cube)
    picture = three_views(ball, ball, cube, titles, tmp_path / "views.png")
    width, height = VIEW_SIZE
    assert picture.shape == (height, 3 * width, 3)
    middles = [picture[height // 2, (2 * column + 1) * width // 2] for column in range(3)]
    assert all(np.ptp([one, two], axis=0).max() > 20 for one, two in pairwise(middles))
    with Image.open(tmp_path / "views.png") as file:
        assert file.size == (3 * width, height)


def test_that_titles_name_facets_vertices_and_triangles(cube):
    assert view_titles("Particle", 10, cube)[2] == "Polyhedron, 6 facets (8 vertices, 12 triangles)"
