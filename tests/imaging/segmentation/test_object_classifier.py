"""The object step on scenes whose objects are known."""

import json

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.imaging.segmentation.classifier_document import objects_document, objects_from
from regolith_studio.imaging.segmentation.object_classifier import (
    OBJECT_FEATURES,
    classify_objects,
    describe_objects,
    split_again,
    suspect_objects,
    train_on_examples,
)
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment, segmentation_steps
from regolith_studio.imaging.settings import SplittingSettings
from regolith_studio.imaging.volume import Volume
from regolith_studio.steps import result_of

GRAIN, SEVERAL, ARTEFACT = range(3)
CELL, ACROSS = 34, 3
STICKY = SplittingSettings(h_maxima=20.0, relative=0.9)
"""An h at which touching grains are not parted."""


def scene(seed=3):
    """27 objects on a lattice: balls, pairs with a neck, and thin bright plates; their kinds and centres."""
    rng, n = np.random.default_rng(seed), CELL * ACROSS
    values = rng.normal(60, 6, (n, n, n)).astype(np.float32)
    offsets = np.stack(np.meshgrid(*[np.arange(CELL)] * 3, indexing="ij"), axis=-1) - CELL / 2
    kinds, centres = [], []
    for cell in np.ndindex(ACROSS, ACROSS, ACROSS):
        kind = int(rng.choice(3, p=(0.55, 0.25, 0.2)))
        axis, radius = rng.normal(size=3), rng.uniform(7, 9)
        axis /= np.linalg.norm(axis)
        along = offsets @ axis
        if kind == GRAIN:
            inside = np.linalg.norm(offsets, axis=-1) <= radius
        elif kind == SEVERAL:
            ends = [np.linalg.norm(offsets - s * 6.5 * axis, axis=-1) <= 7.5 for s in (-1, 1)]
            inside = ends[0] | ends[1]
        else:
            inside = (np.abs(along) <= 2.5) & (np.linalg.norm(offsets, axis=-1) <= 11)
        place = tuple(slice(CELL * k, CELL * k + CELL) for k in cell)
        values[place][inside] += 80 if kind != ARTEFACT else 110
        kinds.append(kind)
        centres.append(tuple(CELL * k + CELL // 2 for k in cell))
    return Volume(np.clip(values, 0, 255).astype(np.uint8), np.ones(3), "grey", "scene"), kinds, centres


@pytest.fixture(scope="module")
def found():
    volume, kinds, centres = scene()
    labels = segment(volume, SegmentationSettings(splitting=STICKY)).labels
    return volume, kinds, centres, labels, result_of(describe_objects(labels, volume))


def examples_of(kinds, centres, count):
    """The first `count` objects of each kind."""
    return [
        (centres[row], kind) for kind in range(3) for row in np.flatnonzero(np.equal(kinds, kind))[:count]
    ]


def test_that_two_examples_of_each_class_classify_all_objects(found):
    _, kinds, centres, labels, table = found
    assert len(table.table.labels) == len(kinds)
    training = train_on_examples(table, labels, examples_of(kinds, centres, 2))
    classes = classify_objects(training, table.vectors)
    rows = table.rows_of([labels.array[centre] for centre in centres])
    assert classes[rows].tolist() == kinds


def test_that_the_objects_are_kept_parted_and_dropped_by_their_class(found):
    volume, kinds, centres, labels, table = found
    training = train_on_examples(table, labels, examples_of(kinds, centres, 2))
    settings = SegmentationSettings(splitting=STICKY, objects=training)
    made = segment(volume, settings)
    expected = kinds.count(GRAIN) + 2 * kinds.count(SEVERAL)
    assert made.n_grains == expected == len(np.unique(made.labels.array)) - 1
    assert all(made.labels.array[centres[row]] == 0 for row in np.flatnonzero(np.equal(kinds, ARTEFACT)))
    balls = 4 / 3 * np.pi * 7.5**3
    pairs = np.flatnonzero(np.equal(kinds, SEVERAL))
    old = labels.array[centres[pairs[0]]]
    parts = np.unique(made.labels.array[labels.array == old], return_counts=True)[1]
    assert len(parts) == 2
    assert np.allclose(parts, balls, rtol=0.15)
    assert {step.stage for step in segmentation_steps(volume, settings)} >= {
        "Describing objects",
        "Classifying objects",
    }


def test_that_a_class_can_be_kept_instead(found):
    volume, kinds, centres, labels, table = found
    training = train_on_examples(
        table, labels, examples_of(kinds, centres, 2), actions=("keep", "keep", "keep")
    )
    made = segment(volume, SegmentationSettings(splitting=STICKY, objects=training))
    assert np.array_equal(made.labels.array, labels.array)


def test_that_a_classifier_from_its_file_gives_the_same_classes(found):
    _, kinds, centres, labels, table = found
    training = train_on_examples(table, labels, examples_of(kinds, centres, 1), scan="ab")
    back = objects_from(json.loads(json.dumps(objects_document(training))), "objects.json")
    assert np.array_equal(back.vectors, training.vectors)
    classes = [classify_objects(each, table.vectors).tolist() for each in (training, back)]
    assert classes[0] == classes[1]


def test_that_the_descriptors_of_a_ball_are_those_of_geometry():
    x, y, z = np.mgrid[:50, :50, :50]
    ball = ((x - 25) ** 2 + (y - 25) ** 2 + (z - 25) ** 2 <= 20**2).astype(np.int32)
    labels = Volume(ball, np.full(3, 2.0), "labels", "ball")
    grey = Volume(np.where(ball, 130, 20).astype(np.uint8), np.full(3, 2.0), "grey", "ball")
    found = dict(zip(OBJECT_FEATURES, result_of(describe_objects(labels, grey)).vectors[0], strict=True))
    assert found["log of the equivalent diameter"] == pytest.approx(np.log(80), abs=0.01)
    assert 0.9 < found["sphericity"] < 1.0
    assert found["mean grey value"] == 130
    assert found["standard deviation of the grey values"] == 0
    assert found["volume of the contour over that of its convex hull"] == pytest.approx(1.0, abs=0.05)
    assert found["short over intermediate axis"] == pytest.approx(1.0, abs=0.01)
    assert found["inscribed over equivalent radius"] == pytest.approx(1.0, abs=0.05)
    assert found["share of the surface in contact"] == 0


def test_that_no_object_fills_more_than_its_convex_hull_however_few_voxels_it_has():
    """The contour of a voxel is an octahedron, which is convex; that of five in a cross or an L is not."""
    labels = np.zeros((60, 9, 9), dtype=np.int32)
    shapes = {
        1: [(0, 0, 0)],
        2: [(0, 0, 0), (1, 0, 0)],
        3: [(1, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0), (1, 2, 0)],
        4: [(0, 0, 0), (0, 1, 0), (0, 2, 0), (1, 0, 0), (2, 0, 0)],
        5: [(0, 0, 0), (1, 1, 1)],
    }
    for label, places in shapes.items():
        for x, y, z in places:
            labels[10 * label + x, 3 + y, 3 + z] = label
    volume = Volume(labels, np.ones(3), "labels", "specks")
    vectors = result_of(describe_objects(volume, Volume(labels, np.ones(3), "grey", "specks"))).vectors
    solidity = dict(zip(shapes, vectors[:, 4], strict=True))
    assert solidity[1] == pytest.approx(1.0)
    assert max(solidity.values()) <= 1.0 + 1e-9
    assert solidity[4] < 0.9


def test_that_half_of_a_cut_cube_touches_with_a_sixth_of_its_surface():
    labels = np.zeros((20, 12, 12), dtype=np.int32)
    labels[2:10, 2:10, 2:10], labels[10:18, 2:10, 2:10] = 1, 2
    volume = Volume(labels, np.ones(3), "labels", "cubes")
    vectors = result_of(describe_objects(volume, Volume(labels, np.ones(3), "grey", "cubes"))).vectors
    assert np.allclose(vectors[:, -1], 1 / 6)


def test_that_an_object_without_a_neck_stays_whole():
    cube = np.ones((12, 12, 12), dtype=bool)
    box = (slice(4, 16),) * 3
    parts = split_again(cube, box, (20, 20, 20), np.ones(3), SplittingSettings(), 64)
    assert np.unique(parts).tolist() == [1]


def test_that_wrong_examples_get_one_sentence(found):
    _, kinds, centres, labels, table = found
    with pytest.raises(InputError, match="examples of two classes"):
        train_on_examples(table, labels, [(centres[0], kinds[0])])
    with pytest.raises(InputError, match="examples of two classes"):
        train_on_examples(table, labels, [])
    with pytest.raises(InputError, match="no object at voxel"):
        train_on_examples(table, labels, [((0, 0, 0), GRAIN)])
    with pytest.raises(InputError, match="no object at voxel"):
        train_on_examples(table, labels, [((900, 0, 0), GRAIN)])


def test_that_voxels_of_another_size_are_refused(found):
    volume, kinds, centres, labels, table = found
    training = train_on_examples(table, labels, examples_of(kinds, centres, 1))
    coarser = Volume(volume.array, np.full(3, 2.0), "grey", "scene")
    with pytest.raises(InputError, match=r"trained on voxels of 1 x 1 x 1 µm.*2 x 2 x 2 µm"):
        segment(coarser, SegmentationSettings(splitting=STICKY, objects=training))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"format": "x"}, "is no object classifier"),
        ({"descriptors": ["size"]}, "other descriptors"),
        ({"examples": [{"voxel": [1, 2, 3], "class": "stone", "descriptors": [0] * 9}]}, "damaged"),
        ({"examples": 3}, "damaged"),
        ({"median": [0] * 3}, "damaged"),
        ({"actions": {"grain": "eat", "several grains": "split", "artefact": "drop"}}, "keep, split, drop"),
        ({"examples": []}, "two classes"),
    ],
)
def test_that_a_damaged_file_gets_one_sentence(found, change, words):
    _, kinds, centres, labels, table = found
    document = objects_document(train_on_examples(table, labels, examples_of(kinds, centres, 1)))
    with pytest.raises((FileError, InputError), match=words):
        objects_from(document | change, "objects.json")


def test_that_an_l_and_a_speck_among_cubes_are_suspect():
    labels = np.zeros((60, 60, 14), dtype=np.int32)
    for number in range(16):
        x, y = 2 + 14 * (number % 4), 2 + 14 * (number // 4)
        edge = {5: 2, 15: 10}.get(number, 7 + number % 3)
        labels[x : x + edge, y : y + edge, 2 : 2 + edge] = number + 1
        if number == 15:
            labels[x + 3 :, y + 3 :] = 0
    volume = Volume(labels, np.ones(3), "labels", "cubes")
    found = suspect_objects(result_of(describe_objects(volume, Volume(labels, np.ones(3), "grey", "cubes"))))
    assert {(each.label, each.by_size) for each in found[:2]} == {(6, True), (16, False)}
    assert {each.n_voxels for each in found[:2]} == {8, 510}
    assert all((labels[each.box] == each.label).any() for each in found)
