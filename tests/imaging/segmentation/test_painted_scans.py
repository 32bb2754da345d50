"""Scans that no threshold segments, from ten brush strokes in a file: voxels and grains against the truth.

Each stroke goes back and forth in a grain or between grains of one slice, 150 voxels long, and was placed
where the prediction after the strokes before was most wrong, among 60 places drawn at random.
"""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.imaging.segmentation.pixel_classifier import PixelClass, TrainingSet
from regolith_studio.imaging.segmentation.pixel_features import FeatureSettings, features_at
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.segmentation.strokes import draw_stroke, painted_rows
from regolith_studio.imaging.settings import ThresholdSettings
from regolith_studio.imaging.volume import Volume

STROKES = Path(__file__).with_name("strokes.json")
N, PITCH = 80, 26
CLASSES = (PixelClass("background", False), PixelClass("grain", True), PixelClass("second mineral", True))
Labels = NDArray[np.int64]
Values = NDArray[np.float64]


def ellipsoids(semi_axes: tuple[float, float, float], seed: int) -> Labels:
    """27 of them on a lattice, each turned at random; 0 between them."""
    rng, labels = np.random.default_rng(seed), np.zeros((N, N, N), dtype=np.int64)
    points = np.stack(np.meshgrid(*[np.arange(N)] * 3, indexing="ij"), axis=-1)
    for number, cell in enumerate(np.ndindex(3, 3, 3), start=1):
        axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        centre = np.array(cell) * PITCH + 14 + rng.uniform(-1, 1, 3)
        inside = np.linalg.norm((points - centre) @ axes / semi_axes, axis=-1) <= 1.0
        labels[inside & (labels == 0)] = number
    return labels


def two_minerals() -> tuple[Values, Labels]:
    """Every second grain is darker than the resin, every other one brighter; noise is 0.4 of the contrast."""
    labels = ellipsoids((11.0, 9.5, 8.5), 1)
    bright = np.r_[0, np.where(np.arange(1, 28) % 2, 40.0, -40.0)]
    return bright[labels], labels


def gradient_and_rings() -> tuple[Values, Labels]:
    """A gradient of 1.8 times the contrast along z, cupping of as much as the contrast, and rings."""
    labels = ellipsoids((11.0, 9.5, 8.5), 2)
    x, y, z = np.meshgrid(*[np.linspace(-1, 1, N)] * 3, indexing="ij")
    radius = np.hypot(x, y)
    rings = 6.0 * np.sin(35 * radius) * (np.abs(np.sin(11 * radius)) > 0.7)
    return np.where(labels > 0, 45.0, 0.0) + 40 * z + 25 * radius**2 + rings, labels


def touching_plates() -> tuple[Values, Labels]:
    """Stacks of plates of six voxels with gaps of two, which blur and noise close."""
    labels = np.zeros((N, N, N), dtype=np.int64)
    number = 0
    for x, y in np.ndindex(3, 3):
        for first in range(6 + (x + y) % 3, N - 8, 8):
            number += 1
            labels[x * 26 + 4 : x * 26 + 24, y * 26 + 4 : y * 26 + 24, first : first + 6] = number
    return np.where(labels > 0, 60.0, 0.0), labels


SCANS: dict[str, tuple[Callable[[], tuple[Values, Labels]], float, float]] = {
    "two_minerals": (two_minerals, 0.8, 16.0),
    "gradient_and_rings": (gradient_and_rings, 0.8, 13.0),
    "touching_plates": (touching_plates, 0.9, 22.0),
}


def scan_of(kind: str) -> tuple[Volume, Labels]:
    """Grey values in 8 bits after blur and noise, and the truth."""
    make, blur, noise = SCANS[kind]
    values, labels = make()
    noisy = ndimage.gaussian_filter(values, blur) + np.random.default_rng(5).normal(110, noise, labels.shape)
    return Volume(np.clip(np.rint(noisy), 0, 255).astype(np.uint8), np.ones(3), "grey", kind), labels


def training_of(kind: str, volume: Volume) -> TrainingSet:
    """What the strokes of the file teach."""
    strokes = [
        draw_stroke(
            each["axis"],
            each["slice"],
            np.array(each["line"], float),
            each["radius"],
            volume.shape,
            each["class"],
        )
        for each in json.loads(STROKES.read_text(encoding="utf-8"))[kind]
    ]
    assert len(strokes) <= 10
    positions, labels, _ = painted_rows(strokes)
    return TrainingSet(
        positions, labels, features_at(volume, positions, FeatureSettings()), CLASSES, np.ones(3)
    )


def overlap(found: NDArray[np.bool_], truth: NDArray[np.bool_]) -> float:
    return float((found & truth).sum() / (found | truth).sum())


def best_threshold(volume: Volume, truth: NDArray[np.bool_]) -> float:
    """The highest IoU of any threshold, bright or dark, on the scan or on its median."""
    images = (volume.array, ndimage.median_filter(volume.array, 3))
    return max(
        overlap(chosen, truth)
        for image in images
        for level in range(10, 250, 3)
        for chosen in (image >= level, image < level)
    )


def share_matched(found: Labels, truth: Labels) -> float:
    """Share of the true grains that one found grain covers with an IoU above one half."""
    matched = 0
    for number in range(1, truth.max() + 1):
        own = truth == number
        candidate = np.bincount(found[own]).argmax()
        matched += candidate > 0 and overlap(found == candidate, own) > 0.5
    return matched / truth.max()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "threshold_at_most", "at_least"),
    [("two_minerals", 0.8, 0.95), ("gradient_and_rings", 0.8, 0.95), ("touching_plates", 0.9, 0.95)],
)
def test_that_ten_strokes_segment_what_no_threshold_does(
    kind: str, threshold_at_most: float, at_least: float
) -> None:
    volume, labels = scan_of(kind)
    training = training_of(kind, volume)
    found = segment(
        volume, SegmentationSettings(threshold=ThresholdSettings("probability"), classifier=training)
    )
    grains = np.asarray(found.labels.array, dtype=np.int64)
    reached, threshold = overlap(grains > 0, labels > 0), best_threshold(volume, labels > 0)
    matched = share_matched(grains, labels)
    assert threshold < threshold_at_most
    assert reached > at_least
    assert matched >= 0.95
