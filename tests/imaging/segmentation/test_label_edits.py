"""Corrections of labels by hand, against what they say."""

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.imaging.segmentation.label_edits import (
    LabelEdit,
    apply_edits,
    edits_document,
    edits_from,
)

EDGES = np.ones(3)


def two_balls(radius=8.0, apart=14.0):
    """One label of two balls that overlap in a neck, and the ball that each voxel is nearer to."""
    x, y, z = np.mgrid[:44, :24, :24]
    first = (x - 14) ** 2 + (y - 12) ** 2 + (z - 12) ** 2 <= radius**2
    second = (x - 14 - apart) ** 2 + (y - 12) ** 2 + (z - 12) ** 2 <= radius**2
    return (first | second).astype(np.int32), np.where(x < 14 + apart / 2, 1, 2)


def edited(labels, *edits):
    changed = labels.copy()
    for _ in apply_edits(changed, edits, EDGES):
        pass
    return changed


def test_that_seeds_part_two_balls_at_their_neck():
    labels, nearer = two_balls()
    found = edited(labels, LabelEdit("seeds", ((14, 12, 12), (28, 12, 12))))
    assert np.array_equal(found > 0, labels > 0)
    assert np.mean(found[labels > 0] == nearer[labels > 0]) > 0.98


def test_that_a_line_cuts_along_the_plane_through_it_and_the_direction_of_view():
    labels, _ = two_balls()
    found = edited(labels, LabelEdit("cut", ((20, 2, 9), (20, 22, 9)), axis=2))
    x = np.arange(44)[:, None, None]
    parts = [found[(labels > 0) & side] for side in (x < 20, x > 20)]
    assert [len(np.unique(part)) for part in parts] == [1, 1]
    assert np.unique(found[labels > 0]).tolist() == [1, 2]
    along_x = edited(labels, LabelEdit("cut", ((9, 2, 12), (9, 22, 12)), axis=0))
    assert np.array_equal(along_x == 2, (labels > 0) & (np.arange(24) > 12)) or np.array_equal(
        along_x == 2, (labels > 0) & (np.arange(24) < 12)
    )


def test_that_merging_undoes_a_split_and_deleting_leaves_the_others():
    labels, _ = two_balls()
    seeds = LabelEdit("seeds", ((14, 12, 12), (28, 12, 12)))
    merge = LabelEdit("merge", ((14, 12, 12), (28, 12, 12)))
    assert np.array_equal(edited(labels, seeds, merge), labels)
    split = edited(labels, seeds)
    assert np.array_equal(
        edited(labels, seeds, LabelEdit("delete", ((28, 12, 12),))), np.where(split == 2, 0, split)
    )


def test_that_a_grain_merged_into_a_distant_one_can_be_cut_as_a_whole():
    labels = np.zeros((30, 10, 10), dtype=np.int32)
    labels[2:6, 2:8, 2:8], labels[20:26, 2:8, 2:8] = 1, 5
    merge = LabelEdit("merge", ((3, 5, 5), (22, 5, 5)))
    found = edited(labels, merge, LabelEdit("cut", ((0, 5, 5), (29, 5, 5)), axis=2))
    assert np.unique(found).tolist() == [0, 1, 6]
    assert set(np.unique(found[20:26, :5])) != set(np.unique(found[20:26, 6:]))


def test_that_filling_closes_what_a_grain_encloses_in_the_slices_that_are_seen():
    labels = np.zeros((20, 20, 20), dtype=np.int32)
    labels[4:16, 4:16, 4:16] = 1
    labels[8:11, 8:11, :] = 0  # a hole along z, open at both ends
    labels[9, 9, 9] = 2  # another grain in it
    hole = np.zeros(labels.shape, dtype=bool)
    hole[8:11, 8:11, 4:16] = True
    found = edited(labels, LabelEdit("fill", ((5, 5, 5),), axis=2))
    assert (found[hole & (labels == 0)] == 1).all()
    assert found[9, 9, 9] == 2
    assert np.array_equal(found[~hole], labels[~hole])
    with pytest.raises(InputError, match="encloses no free voxel"):
        edited(labels, LabelEdit("fill", ((5, 5, 5),), axis=0))


def test_that_paint_is_a_ball_drawn_along_a_line_with_the_label_of_its_beginning():
    labels = np.zeros((40, 24, 24), dtype=np.int32)
    labels[2:8, 8:16, 8:16], labels[30:36, 8:16, 8:16] = 1, 2
    line = LabelEdit("paint", ((5, 12, 12), (30, 12, 12)), radius=3.0)
    x, y, z = np.mgrid[:40, :24, :24]
    beyond = np.maximum(np.maximum(5 - x, x - 30), 0)
    capsule = np.sqrt(beyond**2 + (y - 12) ** 2 + (z - 12) ** 2) <= 3.0
    found = edited(labels, line)
    assert np.array_equal(found, np.where(capsule, 1, labels))
    erased = edited(labels, LabelEdit("erase", line.points, radius=3.0))
    assert np.array_equal(erased, np.where(capsule, 0, labels))
    new = edited(labels, LabelEdit("paint", ((20, 12, 12),), radius=2.0))
    assert np.unique(new).tolist() == [0, 1, 2, 3]
    assert np.count_nonzero(new == 3) == 33  # voxels within 2 of a voxel
    joined = edited(labels, line, LabelEdit("delete", ((20, 12, 12),)))
    assert np.unique(joined).tolist() == [0, 2]


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (LabelEdit("paint", ((14, 12, 12), (99, 12, 12)), radius=2.0), "its line leaves the volume"),
        (LabelEdit("delete", ((0, 0, 0),)), "there is no grain at voxel"),
        (LabelEdit("delete", ((99, 0, 0),)), "lies outside of the volume"),
        (LabelEdit("merge", ((14, 12, 12), (15, 12, 12))), "all its voxels lie in one grain"),
        (LabelEdit("cut", ((0, 0, 0), (5, 0, 0))), "crosses no grain"),
        (LabelEdit("cut", ((6, 12, 12), (6, 13, 12))), "does not divide the grain"),
    ],
)
def test_that_an_edit_which_does_not_fit_the_labels_is_named(edit, words):
    labels, _ = two_balls()
    with pytest.raises(InputError, match=f"Edit 1 of the labels.*{words}"):
        edited(labels, edit)


@pytest.mark.parametrize(
    "document",
    [
        [{"kind": "smear", "points": [[1, 2, 3]]}],
        [{"kind": "paint", "points": []}],
        [{"kind": "paint", "points": [[1, 2, 3]], "radius": 0.1}],
        [{"kind": "erase", "points": [[1, 2, 3]], "radius": "wide"}],
        [{"kind": "erase", "points": [[1, 2, 3]], "radius": float("nan")}],
        [{"kind": "merge", "points": [[1, 2, 3], [1, 2, 3]]}],
        [{"kind": "delete", "points": [[1, 2.5, 3]]}],
        [{"kind": "delete", "points": [[1, 2]]}],
        [{"points": [[1, 2, 3]]}],
        {"kind": "delete"},
        7,
    ],
)
def test_that_a_recipe_with_damaged_edits_is_refused(document):
    with pytest.raises(InputError):
        edits_from(document)


def test_that_edits_come_back_from_their_document():
    edits = (LabelEdit("cut", ((1, 2, 3), (4, 5, 6)), axis=1), LabelEdit("delete", ((1, 2, 3),)))
    edits += (LabelEdit("fill", ((1, 2, 3),), axis=0), LabelEdit("paint", ((1, 2, 3),), radius=2.5))
    assert edits_from(edits_document(edits)) == edits
