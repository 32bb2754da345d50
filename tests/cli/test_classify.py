"""``classify`` and ``extract --classifier``, as a user would call them."""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
from numpy.typing import NDArray

from regolith_studio.readers.volumes.read import read_volume


def scan_of_two_minerals(folder: Path) -> tuple[Path, Path, NDArray[np.int64]]:
    """Files of a scan and of its painted middle slice, and the balls, all slices first: 1 bright, 2 dark."""
    z, y, x = np.mgrid[:32, :32, :56]
    balls = np.zeros(x.shape, dtype=np.int64)
    balls[(x - 16) ** 2 + (y - 16) ** 2 + (z - 16) ** 2 <= 10**2] = 1
    balls[(x - 40) ** 2 + (y - 16) ** 2 + (z - 16) ** 2 <= 10**2] = 2
    values = np.array([100.0, 140.0, 60.0])[balls] + np.random.default_rng(1).normal(0, 8, x.shape)
    painted = np.zeros(x.shape, dtype=np.uint8)
    painted[16] = balls[16] + 1
    np.save(folder / "scan.npy", np.clip(np.rint(values), 0, 255).astype(np.uint8))
    with h5py.File(folder / "painted.h5", "w") as file:  # as ilastik's export of labels
        tags = {"axes": [{"key": key, "typeFlags": 2, "resolution": 0, "description": ""} for key in "zyx"]}
        file["exported_data"] = painted
        file["exported_data"].attrs["axistags"] = json.dumps(tags)
    return folder / "scan.npy", folder / "painted.h5", balls


def test_that_a_painted_slice_gives_the_grains_of_the_scan_and_of_the_recipe(command, tmp_path: Path) -> None:
    scan, painted, balls = scan_of_two_minerals(tmp_path)
    trained = command(
        "classify", "train", scan, painted, "-o", tmp_path / "strokes", "--grain", "2,3", "--voxel-size", 2
    )
    assert trained.code == 0, trained.err
    assert trained.out.startswith("Trained on 1,")
    asked = ["--voxel-size", 2, "--min-voxels", 100, "--json"]
    found = command("extract", scan, "-o", tmp_path / "x", "--classifier", tmp_path / "strokes.json", *asked)
    assert found.code == 0, found.err
    voxels = [particle["voxels"] for particle in found.json["particles"]]
    assert np.allclose(sorted(voxels), sorted(np.bincount(balls.ravel())[1:]), rtol=0.1)
    recipe = tmp_path / "x" / "extraction.json"
    again = command("extract", scan, "-o", tmp_path / "y", "--recipe", recipe, *asked)
    first, second = ((tmp_path / name / "particle_0001.stl").read_bytes() for name in "xy")
    assert again.code == 0
    assert first == second


@pytest.mark.slow
def test_that_the_map_of_probabilities_is_taken_as_one(command, tmp_path: Path) -> None:
    scan, painted, balls = scan_of_two_minerals(tmp_path)
    strokes, probability = tmp_path / "strokes.json", tmp_path / "probability.h5"
    command("classify", "train", scan, painted, "-o", strokes, "--grain", "2,3", "--voxel-size", 2)
    assert command("classify", "map", scan, strokes, "-o", probability, "--voxel-size", 2).code == 0
    back = read_volume(probability)
    assert (back.kind, back.dtype, back.voxel_size.tolist()) == ("grey", np.uint8, [2.0, 2.0, 2.0])
    truth = balls.T > 0
    found = back.array >= 128
    assert (found & truth).sum() / (found | truth).sum() > 0.9
    result = command("extract", probability, "-o", tmp_path / "x", "--threshold", "probability:0.5", "--json")
    assert len(result.json["particles"]) == 2


def test_that_what_lies_outside_of_the_scanners_circle_is_found_or_stated(command, tmp_path: Path) -> None:
    scan, painted, _ = scan_of_two_minerals(tmp_path)
    values = np.load(scan)
    y, x = np.indices(values.shape[1:])
    values[:, np.hypot((y - 15.5) / 16, (x - 27.5) / 28) > 1.1] = 0
    np.save(scan, values)
    files = ["-o", tmp_path / "strokes.json", "--grain", "2,3", "--voxel-size", 2]
    for value, code, sentence in (
        ("5", 1, "No part of scan.npy is filled with 5"),
        ("far", 2, "is a number"),
    ):
        wrong = command("classify", "train", scan, painted, *files, "--outside", value)
        assert wrong.code == code
        assert sentence in " ".join(wrong.err.replace("│", "").split())
    assert command("classify", "train", scan, painted, *files).code == 0
    maps = {}
    for value in ("auto", "0", "none"):
        words = ("-o", tmp_path / f"{value}.tif", "--voxel-size", 2, "--outside", value)
        made = command("classify", "map", scan, tmp_path / "strokes.json", *words)
        assert made.code == 0, made.err
        maps[value] = read_volume(tmp_path / f"{value}.tif").array
    assert np.array_equal(maps["auto"], maps["0"])
    assert not np.array_equal(maps["auto"], maps["none"])


@pytest.mark.slow
def test_that_painted_voxels_go_out_as_the_labels_that_came_in(command, tmp_path: Path) -> None:
    scan, painted, balls = scan_of_two_minerals(tmp_path)
    strokes, labels = tmp_path / "strokes.json", tmp_path / "labels.h5"
    command("classify", "train", scan, painted, "-o", strokes, "--grain", "2,3", "--voxel-size", 2)
    written = command("classify", "labels", scan, strokes, "-o", labels, "--voxel-size", 2, "--json")
    assert written.code == 0, written.err
    assert written.json["classes"]["label 2"] == 2
    with h5py.File(labels) as file:
        found = file["labels"][()]
    assert np.array_equal(found[16], balls[16] + 1)
    assert np.count_nonzero(found) == found[16].size
    again = command(
        "classify", "train", scan, labels, "-o", tmp_path / "again", "--grain", "2,3", "--voxel-size", 2
    )
    assert again.code == 0, again.err
    assert (tmp_path / "again.json").read_bytes() == strokes.read_bytes()
    other = command("classify", "labels", scan, strokes, "-o", tmp_path / "x.tif", "--voxel-size", 5)
    assert "trained on voxels of 2 x 2 x 2 µm" in other.err
    np.save(tmp_path / "small.npy", np.zeros((10, 32, 56), np.uint8))
    small = command(
        "classify", "labels", tmp_path / "small.npy", strokes, "-o", tmp_path / "x.tif", "--voxel-size", 2
    )
    assert "lie outside of small.npy" in small.err
    assert not (tmp_path / "x.tif").exists()


@pytest.mark.parametrize(
    ("options", "code", "sentence"),
    [
        (["--grain", "none"], 2, "--grain takes labels from 1 to 8"),
        (["--grain", "7"], 1, "No grain is painted; paint some voxels of grains, too."),
        (["--grain", "1,2,3"], 1, "Only grains are painted; paint some of what is between them, too."),
        (["--sigmas", "4,2"], 2, "ascend"),
        (["--model", "forest"], 2, "A classifier is one of network, logistic"),
    ],
)
def test_that_bad_input_to_the_training_gets_one_sentence(
    command, tmp_path: Path, options: list[str], code: int, sentence: str
) -> None:
    scan, painted, _ = scan_of_two_minerals(tmp_path)
    result = command(
        "classify", "train", scan, painted, "-o", tmp_path / "s.json", "--voxel-size", 2, *options
    )
    assert result.code == code
    assert sentence in " ".join(result.err.replace("│", "").split())
    assert not (tmp_path / "s.json").exists()


def test_that_a_classifier_that_does_not_fit_gets_one_sentence(command, tmp_path: Path) -> None:
    scan, painted, _ = scan_of_two_minerals(tmp_path)
    strokes = tmp_path / "strokes.json"
    command("classify", "train", scan, painted, "-o", strokes, "--grain", "2,3", "--voxel-size", 2)
    other = command("extract", scan, "-o", tmp_path / "x", "--classifier", strokes, "--voxel-size", 5)
    assert other.code == 1
    assert "trained on voxels of 2 x 2 x 2 µm, scan.npy has voxels of 5 x 5 x 5 µm" in other.err
    level = command("extract", scan, "-o", tmp_path / "x", "--classifier", strokes, "--threshold", "90")
    assert level.code == 2
    assert "the threshold is a probability" in " ".join(level.err.replace("│", "").split())
    absent = command("extract", scan, "-o", tmp_path / "x", "--classifier", painted, "--voxel-size", 2)
    assert "painted.h5 is no classifier" in " ".join(absent.err.replace("│", "").split())
