"""Maps of a classifier that were interrupted: the next run predicts only the slabs that are missing."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from regolith_studio.imaging.segmentation import pixel_classifier
from regolith_studio.imaging.segmentation.pixel_classifier import ClassifierSettings, PixelClass, TrainingSet
from regolith_studio.imaging.segmentation.segment import SegmentationSettings
from regolith_studio.imaging.settings import ThresholdSettings
from regolith_studio.jobs import extraction_jobs
from regolith_studio.jobs.classifier_jobs import map_probabilities, train_on_labels
from regolith_studio.jobs.events import Steps
from regolith_studio.jobs.extraction_jobs import extract_measured, unfinished_file
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from tests.cli.test_classify import scan_of_two_minerals
from tests.jobs.small_jobs import name_and_numbers
from tests.jobs.test_extraction_jobs import played

CLASSES = (PixelClass("resin", False), PixelClass("bright", True), PixelClass("dark", True))
N_SLABS = 4
Case = tuple[VolumeInput, TrainingSet, list[int]]


@pytest.fixture
def case(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Case:
    """A scan of four slabs, what a classifier of it is trained on, and the slabs that are predicted."""
    scan, painted, _ = scan_of_two_minerals(tmp_path)
    given = VolumeInput(scan, 2.0, kind="grey")
    _, training = played(train_on_labels(given, VolumeInput(painted, 2.0), CLASSES, ClassifierSettings()))
    predicted: list[int] = []
    predict = pixel_classifier.slab_probability
    monkeypatch.setattr(
        pixel_classifier,
        "slab_probability",
        lambda *given: predicted.append(given[1].first) or predict(*given),
    )
    monkeypatch.setattr(pixel_classifier, "_SLAB_VOXELS", 1)
    monkeypatch.setattr(extraction_jobs, "RESUMABLE_VOXELS", 1)
    return given, training, predicted


def interrupt(steps: Steps, predicted: list[int], count: int) -> None:
    """End the steps once so many slabs have been predicted and kept."""
    while len(predicted) <= count:
        next(steps)
    steps.close()
    predicted.clear()


def mapped(case: Case, path: Path) -> Steps:
    given, training, _ = case
    return map_probabilities(given, training, path, path.parent)


def test_that_an_interrupted_map_goes_on_and_has_the_bytes_of_one_that_was_not(
    case: Case, tmp_path: Path
) -> None:
    predicted = case[2]
    played(mapped(case, tmp_path / "whole.h5"))
    assert len(predicted) == N_SLABS
    predicted.clear()
    interrupt(mapped(case, tmp_path / "map.h5"), predicted, 2)
    assert not (tmp_path / "map.h5").exists()
    assert unfinished_file(tmp_path / "map.h5").exists()
    played(mapped(case, tmp_path / "map.h5"))
    assert predicted == [24]  # the third had been predicted when the steps were ended
    assert (tmp_path / "map.h5").read_bytes() == (tmp_path / "whole.h5").read_bytes()
    assert not unfinished_file(tmp_path / "map.h5").parent.exists()


def other_classifier(case: Case, path: Path) -> Steps:
    given, training, _ = case
    return map_probabilities(given, replace(training, settings=ClassifierSettings(seed=7)), path, path.parent)


def other_scan(case: Case, path: Path) -> Steps:
    given, training, _ = case
    data = bytearray(given.path.read_bytes())
    data[-1] ^= 1
    given.path.write_bytes(data)
    return map_probabilities(given, training, path, path.parent)


def damaged(case: Case, path: Path) -> Steps:
    unfinished_file(path).write_bytes(b"no database")
    return mapped(case, path)


@pytest.mark.slow
@pytest.mark.parametrize("change", [other_classifier, other_scan, damaged])
def test_that_what_belongs_to_something_else_is_begun_anew(
    change: Callable[[Case, Path], Steps], case: Case, tmp_path: Path
) -> None:
    interrupt(mapped(case, tmp_path / "map.h5"), case[2], 2)
    played(change(case, tmp_path / "map.h5"))
    assert len(case[2]) == N_SLABS


def extracted(case: Case, found: list[object], workers: int = 1) -> Steps:
    given, training, _ = case
    threshold = ThresholdSettings("probability")
    settings = GrainSettings(SegmentationSettings(threshold=threshold, classifier=training))
    folder = given.path.parent
    return extract_measured(
        given, settings, folder, name_and_numbers, found.append, workers, None, unfinished_file(folder / "x")
    )


@pytest.mark.slow
def test_that_an_interrupted_extraction_goes_on_with_the_map_of_its_classifier(
    case: Case, tmp_path: Path
) -> None:
    whole: list[object] = []
    again: list[object] = []
    played(extracted(case, whole))
    case[2].clear()
    interrupt(extracted(case, []), case[2], 1)
    played(extracted(case, again))
    assert len(case[2]) == N_SLABS - 2
    assert again == whole
    assert len(whole) == 2
    assert not list(tmp_path.glob("*.unfinished"))


@pytest.mark.slow
def test_that_two_processes_predict_what_one_does(case: Case) -> None:
    found: dict[int, list[object]] = {1: [], 2: []}
    for workers, particles in found.items():
        played(extracted(case, particles, workers))
    assert len(found[1]) == 2
    assert found[1] == found[2]
