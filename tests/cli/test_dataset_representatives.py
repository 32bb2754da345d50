"""``dataset build --representatives``."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.io.triangles import stl_bytes

from .conftest import ellipsoid


@pytest.fixture(scope="module")
def crowd(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six balls and three needles."""
    folder = tmp_path_factory.mktemp("crowd")
    for index in range(9):
        long = 1.0 if index < 6 else 3.0
        size = 10.0 + index
        (folder / f"grain-{index}.stl").write_bytes(
            stl_bytes(ellipsoid(size * long, size * (1.02 + index / 100), size).triangles, "test")
        )
    return folder


def build(command, crowd: Path, folder: Path, *more: object):
    return command(
        "dataset", "build", crowd, "-o", folder, "--method", "quadric", "--target", "particle", *more
    )


def test_that_two_representatives_stand_for_balls_and_needles(command, crowd: Path, tmp_path: Path) -> None:
    curve = tmp_path / "curve.csv"
    result = build(command, crowd, tmp_path / "set", "--representatives", 2, "--quality-curve", curve)
    assert result.code == 0
    assert "2 of 9 particles" in result.out
    dataset = read_dataset(tmp_path / "set")
    assert sorted(one.n_members for one in dataset.representatives) == [3, 6]
    assert sorted(dataset.weights) == pytest.approx([1 / 3, 2 / 3])
    needles = min(dataset.representatives, key=lambda one: one.n_members)
    assert int(needles.name[-1]) >= 6
    assert len(needles.sizes.diameters_um) == 3
    assert "2 representatives of 9 particles" in dataset.provenance.processing_steps[1]
    assert "Coarsened to 20 facets by the method quadric." in dataset.provenance.processing_steps
    assert dataset.provenance.representation.n_particles == 9
    assert 0 < dataset.provenance.representation.source_errors["aspect_ratio"] < 1
    assert dataset.provenance.representation.errors["sphericity"] > 1  # the polyhedra of balls are no balls
    assert validate_dataset(tmp_path / "set") == []
    text = (tmp_path / "set" / "dataset.json").read_text(encoding="utf-8")
    document = json.loads(text)
    document["metadata"]["representation"]["errors"]["sphericity"] = 0.2
    (tmp_path / "set" / "dataset.json").write_text(json.dumps(document), encoding="utf-8")
    assert "states an error of 0.2 in sphericity, the shapes have" in validate_dataset(tmp_path / "set")[0]
    with curve.open(newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    errors = [float(row["mean"]) for row in rows[:-1]]
    assert errors[1] < 0.7 * errors[0]


@pytest.mark.slow
def test_that_a_shape_does_not_depend_on_how_many_are_chosen(command, crowd: Path, tmp_path: Path) -> None:
    build(command, crowd, tmp_path / "all")
    build(command, crowd, tmp_path / "two", "--representatives", 2)
    every = {one.name: one.shape for one in read_dataset(tmp_path / "all").representatives}
    for one in read_dataset(tmp_path / "two").representatives:
        assert np.array_equal(one.shape.half_spaces.normals, every[one.name].half_spaces.normals)


def test_that_sizes_can_be_given(command, crowd: Path, tmp_path: Path) -> None:
    result = build(
        command, crowd, tmp_path / "set", "--representatives", 2, "--sizes", "log-normal:50,0.3",
        "--weighting", "volume",
    )  # fmt: skip
    assert result.code == 0
    dataset = read_dataset(tmp_path / "set")
    assert dataset.weighting == "volume"
    assert all(one.sizes.median_um == 50.0 for one in dataset.representatives)


@pytest.mark.parametrize(
    ("more", "code", "word"),
    [
        (("--sizes", "gauss:3"), 2, "is not a size distribution"),
        (("--weighting", "mass"), 2, "must be one of number, volume"),
        (("--representatives", 10), 1, "Between 1 and 9"),
    ],
)
def test_that_what_makes_no_sense_is_one_sentence(command, crowd, tmp_path: Path, more, code, word) -> None:
    result = build(command, crowd, tmp_path / "set", *more)
    assert result.code == code
    assert word in " ".join(result.err.replace("│", " ").split())
    assert not (tmp_path / "set").exists()
