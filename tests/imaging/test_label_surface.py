"""Coarse surfaces of labels, against their boxes."""

import numpy as np
import pytest

from regolith_studio.imaging.label_surface import label_surface


def test_that_surfaces_lie_at_the_faces_of_their_labels_also_at_the_border():
    labels = np.zeros((40, 30, 30), dtype=np.int32)
    labels[10:30, 10:20, 8:25], labels[:5, :5, :5] = 7, 3
    found = label_surface(labels, np.array([1.0, 2.0, 3.0]))
    assert set(found.labels) == {3, 7}
    block = found.vertices[np.unique(found.faces[found.labels == 7])]
    assert np.allclose(block.min(axis=0), (10, 20, 24), atol=0.3)
    assert np.allclose(block.max(axis=0), (30, 40, 75), atol=0.3)
    corner = found.vertices[np.unique(found.faces[found.labels == 3])]
    assert (np.abs(corner.max(axis=0) - (5, 10, 15)) < (0.5, 1.0, 1.5)).all()  # half a voxel: it is smoothed


def test_that_large_volumes_are_contoured_coarsely_and_empty_ones_not_at_all():
    labels = np.zeros((200, 20, 20), dtype=np.int32)
    labels[40:160, 4:16, 4:16] = 900
    found = label_surface(labels, np.ones(3), max_edge=50)
    assert set(found.labels) == {900}
    assert np.allclose(found.vertices.min(axis=0), (40, 4, 4), atol=4.0)  # a coarse voxel
    assert len(found.faces) < len(label_surface(labels, np.ones(3), max_edge=200).faces) / 4
    assert len(label_surface(np.zeros((5, 5, 5), dtype=np.int32), np.ones(3)).faces) == 0


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_that_a_volume_of_one_slice_has_a_surface_around_its_labels(axis: int) -> None:
    labels = np.zeros((12, 12), dtype=np.int64)
    labels[3:8, 4:9] = 7
    found = label_surface(np.expand_dims(labels, axis), np.full(3, 2.0))
    assert set(found.labels) == {7}
    low, high = found.vertices.min(axis=0), found.vertices.max(axis=0)
    inside = np.insert([6.0, 8.0], axis, 0.0), np.insert([16.0, 18.0], axis, 2.0)
    assert (low > inside[0] - 0.1).all()
    assert (high < inside[1] + 0.1).all()
    assert (np.delete(high - low, axis) > 4.0).all()  # it is smoothed
