"""Classifiers of voxels: their features, their training, and the map of probabilities."""

import json
import sys

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.errors import FileError, InputError, MissingRequirement
from regolith_studio.imaging.segmentation import pixel_classifier
from regolith_studio.imaging.segmentation.classifier_document import training_document, training_from
from regolith_studio.imaging.segmentation.pixel_classifier import (
    USUAL_CLASSES,
    ClassifierSettings,
    PixelClass,
    TrainingSet,
    paint_from_labels,
    probability_map,
    slab_probability,
    train,
)
from regolith_studio.imaging.segmentation.pixel_features import FeatureSettings, features_at, features_in
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, preview, segment
from regolith_studio.imaging.settings import CleaningSettings, DenoiseSettings, ThresholdSettings
from regolith_studio.imaging.volume import Volume, box_between
from regolith_studio.imaging.volume_slabs import ScratchArrays, SharedArray
from regolith_studio.steps import result_of

PROBABLE = ThresholdSettings("probability", 0.5)
THREE = (PixelClass("resin", False), PixelClass("bright mineral", True), PixelClass("dark mineral", True))


def grey(values: NDArray[np.generic], edge: float = 1.0) -> Volume:
    return Volume(values, np.full(3, edge), "grey", "scan")


def noise(shape: tuple[int, int, int] = (40, 36, 30)) -> Volume:
    return grey(np.random.default_rng(0).normal(100, 20, shape).astype(np.float32))


def two_minerals() -> tuple[Volume, NDArray[np.int64]]:
    """A bright and a dark ball in resin between them in brightness, and which is which (1, 2)."""
    x, y, z = np.mgrid[:56, :32, :32]
    balls = np.zeros(x.shape, dtype=np.int64)
    balls[(x - 16) ** 2 + (y - 16) ** 2 + (z - 16) ** 2 <= 10**2] = 1
    balls[(x - 40) ** 2 + (y - 16) ** 2 + (z - 16) ** 2 <= 10**2] = 2
    values = np.array([100.0, 140.0, 60.0])[balls] + np.random.default_rng(1).normal(0, 12, x.shape)
    return grey(np.clip(np.rint(values), 0, 255).astype(np.uint8)), balls


def painted_middle(balls: NDArray[np.int64]) -> Volume:
    """Every voxel of the middle slice is painted: 1 resin, 2 and 3 the minerals."""
    labels = np.zeros(balls.shape, dtype=np.uint8)
    labels[:, :, 16] = balls[:, :, 16] + 1
    return Volume(labels, np.ones(3), "labels", "strokes")


def predicted(training: TrainingSet, volume: Volume) -> NDArray[np.uint8]:
    return np.asarray(result_of(probability_map(train(training), volume, ScratchArrays())).array)


def test_that_features_are_the_filters_of_scipy() -> None:
    volume, settings = noise(), FeatureSettings((1.0, 2.0))
    whole = features_in(volume, box_between((0, 0, 0), volume.shape), settings)
    fine, coarse = (
        ndimage.gaussian_filter(volume.array, s, mode="nearest", radius=int(3 * s)) for s in (1.0, 2.0)
    )
    assert settings.names[:2] == ("gaussian 2", "gaussian 1 - gaussian 2")
    np.testing.assert_allclose(whole[..., 0], coarse, atol=1e-3)
    np.testing.assert_allclose(whole[..., 1], fine - coarse, atol=1e-3)


def test_that_the_gradient_of_a_ramp_is_its_slope() -> None:
    x, y, z = np.mgrid[:40, :40, :40]
    volume = grey((2.0 * x + 3.0 * y - 6.0 * z).astype(np.float32))
    features = features_in(volume, box_between((15, 15, 15), (25, 25, 25)), FeatureSettings((1.0, 3.0)))
    np.testing.assert_allclose(features[..., 2:4], 7.0, atol=1e-3)
    np.testing.assert_allclose(features[..., 4:], 0.0, atol=1e-4)


@pytest.mark.parametrize("planar", [False, True])
def test_that_the_curvatures_of_a_quadratic_form_are_the_eigenvalues_of_its_matrix(planar: bool) -> None:
    matrix = np.array([[0.5, 0.2, -0.1], [0.2, -0.3, 0.15], [-0.1, 0.15, 0.1]])
    places = np.stack(np.mgrid[:40, :40, :40], axis=-1) - 20.0
    volume = grey((0.5 * np.einsum("...i,ij,...j", places, matrix, places)).astype(np.float32))
    settings = FeatureSettings((1.0, 2.0), planar)
    found = features_in(volume, box_between((17, 17, 17), (23, 23, 23)), settings)
    expected = np.linalg.eigvalsh(matrix[:2, :2] if planar else matrix)[::-1]
    assert [name.split()[0] for name in settings.names[4:]] == ["hessian"] * 2 * len(expected)
    np.testing.assert_allclose(
        found[..., 4:], np.broadcast_to([*expected, *expected], found[..., 4:].shape), atol=1e-3
    )
    flat = grey(np.full((30, 30, 30), 7.0, np.float32))
    assert np.isfinite(features_in(flat, box_between((0, 0, 0), flat.shape), settings)).all()


def test_that_planar_features_do_not_look_at_other_slices() -> None:
    volume, settings = noise(), FeatureSettings(planar=True)
    box = box_between((0, 0, 12), (40, 36, 13))
    alone = grey(volume.array[:, :, 12:13])
    expected = features_in(alone, box_between((0, 0, 0), (40, 36, 1)), settings)
    np.testing.assert_allclose(features_in(volume, box, settings), expected, atol=1e-4)


def test_that_parts_and_single_voxels_have_the_features_of_the_whole() -> None:
    volume, settings = noise(), FeatureSettings()
    whole = features_in(volume, box_between((0, 0, 0), volume.shape), settings)
    part = features_in(volume, box_between((5, 0, 7), (25, 36, 8)), settings, (2, 3, 1))
    np.testing.assert_allclose(part, whole[5:25:2, ::3, 7:8], atol=1e-3)
    voxels = np.random.default_rng(2).integers(0, volume.shape, (50, 3))
    np.testing.assert_allclose(features_at(volume, voxels, settings), whole[tuple(voxels.T)], atol=1e-3)


def test_that_voxels_far_from_the_first_slice_have_the_features_of_their_place() -> None:
    volume, settings = noise((12, 12, 90)), FeatureSettings()
    voxels = np.array([[3, 4, 60], [9, 2, 61], [5, 5, 88]])
    whole = features_in(volume, box_between((0, 0, 0), volume.shape), settings)
    np.testing.assert_allclose(features_at(volume, voxels, settings), whole[tuple(voxels.T)], atol=1e-3)


def test_that_a_classifier_finds_two_minerals_that_no_threshold_finds() -> None:
    volume, balls = two_minerals()
    grains = predicted(paint_from_labels(volume, painted_middle(balls), THREE), volume) >= 128
    truth = balls > 0
    best = max(
        (chosen & truth).sum() / (chosen | truth).sum()
        for level in range(256)
        for chosen in (volume.array >= level, volume.array < level)
    )
    assert best < 0.6
    assert (grains & truth).sum() / (grains | truth).sum() > 0.9


def test_that_grains_come_from_the_probabilities() -> None:
    volume, balls = two_minerals()
    training = paint_from_labels(volume, painted_middle(balls), THREE)
    settings = SegmentationSettings(
        DenoiseSettings("none"), PROBABLE, CleaningSettings(min_voxels=200), classifier=training
    )
    found = segment(volume, settings)
    assert found.n_grains == 2
    assert abs(found.sizes - np.bincount(balls.ravel())[1:]).max() < 420  # of 4,169
    box = box_between((4, 4, 4), (28, 28, 28))
    inside = np.asarray(preview(volume, box, settings).labels.array) > 0
    assert (inside == (np.asarray(found.labels.array)[box] > 0)).mean() > 0.99


def test_that_a_classifier_takes_a_probability_as_threshold() -> None:
    volume, balls = two_minerals()
    training = paint_from_labels(volume, painted_middle(balls), THREE)
    with pytest.raises(InputError, match="the threshold is a probability from 0 to 1, not 'otsu'"):
        SegmentationSettings(classifier=training)


def test_that_the_map_does_not_depend_on_how_the_volume_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pixel_classifier, "_SLAB_VOXELS", 1)  # slabs of eight slices
    volume, balls = two_minerals()
    training = paint_from_labels(volume, painted_middle(balls), THREE)
    classifier = train(training)
    alone = []
    for first in range(24, -1, -8):  # each slab by itself, the last one first
        slab = SharedArray(volume.array).thick(first, first + 8, classifier.features.margin)
        alone.insert(0, slab_probability(classifier, slab, volume.shape))
    assert np.array_equal(np.concatenate(alone, axis=2), predicted(training, volume))


def test_that_voxels_without_a_number_are_no_grain_and_harm_no_other() -> None:
    volume, balls = two_minerals()
    training = paint_from_labels(volume, painted_middle(balls), THREE)
    values = volume.array.astype(np.float32)
    values[16, 16, 16], values[17, 16, 16] = np.nan, np.inf
    found = predicted(training, grey(values))
    assert found[16, 16, 16] == found[17, 16, 16] == 0
    far = np.s_[44:]
    assert np.array_equal(found[far], predicted(training, volume)[far])


def test_that_a_classifier_comes_back_from_its_document_to_the_last_bit() -> None:
    volume, balls = two_minerals()
    settings = ClassifierSettings(FeatureSettings((1.0, 2.5)), hidden=8, seed=3)
    training = paint_from_labels(volume, painted_middle(balls), THREE, settings, scan="ab12")
    back = training_from(json.loads(json.dumps(training_document(training))), "strokes.json")
    assert (back.settings, back.classes, back.scan) == (settings, THREE, "ab12")
    assert np.array_equal(back.vectors, training.vectors)
    assert np.array_equal(predicted(back, volume), predicted(training, volume))


def test_that_how_much_of_a_class_is_painted_does_not_make_it_likelier() -> None:
    rng = np.random.default_rng(0)
    rows = np.concatenate([rng.normal(-1, 1, (2000, 2)), rng.normal(1, 1, (100, 2))]).astype(np.float32)
    labels = np.repeat([0, 1], [2000, 100])
    settings = ClassifierSettings(FeatureSettings((1.0,), hessian=False), "logistic")
    training = TrainingSet(np.zeros((2100, 3), int), labels, rows, USUAL_CLASSES, np.ones(3), "", settings)
    (between,) = train(training).probabilities(np.zeros((1, 2), dtype=np.float32))
    assert between[1] == pytest.approx(0.5, abs=0.1)  # by symmetry; 1 : 20 of the voxels are grain


@pytest.mark.parametrize(
    ("labels", "sentence"),
    [
        ([], "Nothing is painted yet"),
        ([0, 0], "No grain is painted"),
        ([1, 1], "Only grains are painted"),
        ([0, 2], "classes 0 to 1"),
    ],
)
def test_that_what_is_not_painted_is_named(labels: list[int], sentence: str) -> None:
    vectors = np.zeros((len(labels), len(FeatureSettings().names)), dtype=np.float32)
    with pytest.raises(InputError, match=sentence):
        TrainingSet(
            np.zeros((len(labels), 3), int), np.array(labels, int), vectors, USUAL_CLASSES, np.ones(3)
        )


def test_that_other_voxel_sizes_and_scans_of_other_size_are_refused() -> None:
    volume, balls = two_minerals()
    training = paint_from_labels(volume, painted_middle(balls), THREE)
    with pytest.raises(
        InputError, match="trained on voxels of 1 x 1 x 1 µm, scan has voxels of 2 x 2 x 2 µm"
    ):
        predicted(training, grey(volume.array, 2.0))
    with pytest.raises(InputError, match="paint on this scan"):
        paint_from_labels(noise(), painted_middle(balls), THREE)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"format": "something"}, "is no classifier"),
        ({"classes": 3}, "damaged classifier"),
        ({"voxels": [[1, 2, 3]]}, "for other features"),
        ({"features": ["hessian 1"]}, "for other features than this program computes; train it again"),
    ],
)
def test_that_a_wrong_document_gets_one_sentence(change: dict[str, object], sentence: str) -> None:
    volume, balls = two_minerals()
    document = training_document(paint_from_labels(volume, painted_middle(balls), THREE))
    with pytest.raises(FileError, match=sentence):
        training_from(document | change, "strokes.json")


def test_that_a_file_whose_voxels_are_of_one_kind_is_named() -> None:
    volume, balls = two_minerals()
    document = training_document(paint_from_labels(volume, painted_middle(balls), THREE))
    document["voxels"] = [each for each in document["voxels"] if each[3] == 0]
    with pytest.raises(
        InputError, match=r"strokes\.json is no classifier that can be used: No grain is painted"
    ):
        training_from(document, "strokes.json")


def test_that_scikit_learn_is_asked_for_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    volume, balls = two_minerals()
    training = paint_from_labels(volume, painted_middle(balls), THREE)
    monkeypatch.setitem(sys.modules, "sklearn.pipeline", None)
    with pytest.raises(MissingRequirement, match=r"pip install regolith-studio\[classifier\]"):
        train(training)


@pytest.mark.parametrize("sigmas", [(), (2.0, 1.0), (0.1,), (64.0,)])
def test_that_sigmas_ascend_within_limits(sigmas: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="ascend"):
        FeatureSettings(sigmas)
