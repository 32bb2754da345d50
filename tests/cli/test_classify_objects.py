"""``classify objects`` and ``extract --objects``, as a user would call them."""

import json
from pathlib import Path

import numpy as np
import pytest

OPTIONS = ["--voxel-size", 2, "--h-maxima", 20, "--min-voxels", 100]
CENTRES = ((16, 16), (16, 48), (48, 16), (48, 48), (80, 16), (80, 48))
KINDS = ("grain", "several grains", "artefact", "several grains", "grain", "artefact")


def scan_of_balls_pairs_and_plates(folder: Path) -> Path:
    """A file of two balls, two pairs of them with a neck, and two bright plates, slices first."""
    z, y, x = np.mgrid[:32, :64, :96]
    values = np.full(x.shape, 60.0)
    for (cx, cy), kind in zip(CENTRES, KINDS, strict=True):
        near = {
            "grain": (x - cx) ** 2 + (y - cy) ** 2 + (z - 16) ** 2 <= 9**2,
            "several grains": np.minimum((x - cx - 7) ** 2, (x - cx + 7) ** 2) + (y - cy) ** 2 + (z - 16) ** 2
            <= 8**2,
            "artefact": (np.abs(x - cx) <= 2) & ((y - cy) ** 2 + (z - 16) ** 2 <= 9**2),
        }[kind]
        values[near] = 190 if kind == "artefact" else 140
    values += np.random.default_rng(1).normal(0, 5, x.shape)
    np.save(folder / "scan.npy", np.clip(np.rint(values), 0, 255).astype(np.uint8))
    return folder / "scan.npy"


def examples(folder: Path) -> Path:
    """One example of each class."""
    rows = [f"{x},{y},16,{kind}" for (x, y), kind in list(zip(CENTRES, KINDS, strict=True))[:3]]
    path = folder / "examples.csv"
    path.write_text("\n".join(["x,y,z,class", *rows]) + "\n", encoding="utf-8")
    return path


def test_that_three_examples_part_pairs_and_drop_plates_and_the_recipe_does_so_again(
    command, tmp_path: Path
) -> None:
    scan = scan_of_balls_pairs_and_plates(tmp_path)
    trained = command(
        "classify", "objects", scan, examples(tmp_path), "-o", tmp_path / "objects", "--json", *OPTIONS
    )
    assert trained.code == 0, trained.err
    assert trained.json["classified"] == {"grain": 2, "several grains": 2, "artefact": 2}
    file = tmp_path / "objects.json"
    found = command("extract", scan, "-o", tmp_path / "x", "--objects", file, "--json", *OPTIONS)
    assert found.code == 0, found.err
    voxels = sorted(particle["voxels"] for particle in found.json["particles"])
    balls = [4 / 3 * np.pi * radius**3 for radius in (8, 8, 8, 8, 9, 9)]
    assert np.allclose(voxels, balls, rtol=0.15)
    recipe = tmp_path / "x" / "extraction.json"
    again = command("extract", scan, "-o", tmp_path / "y", "--recipe", recipe, "--voxel-size", 2)
    assert again.code == 0, again.err
    names = sorted(path.name for path in (tmp_path / "x").glob("*.stl"))
    assert len(names) == 6
    assert all((tmp_path / "x" / n).read_bytes() == (tmp_path / "y" / n).read_bytes() for n in names)


def test_that_edits_in_a_recipe_are_made_again(command, tmp_path: Path) -> None:
    scan = scan_of_balls_pairs_and_plates(tmp_path)
    plain = command("extract", scan, "-o", tmp_path / "x", "--json", *OPTIONS)
    document = json.loads((tmp_path / "x" / "extraction.json").read_text(encoding="utf-8"))
    document["segmentation"]["edits"] = [
        {"kind": "delete", "points": [[48, 16, 16]]},
        {"kind": "seeds", "points": [[9, 48, 16], [23, 48, 16]]},
    ]
    recipe = tmp_path / "recipe.json"
    recipe.write_text(json.dumps(document), encoding="utf-8")
    made = command("extract", scan, "-o", tmp_path / "y", "--recipe", recipe, "--voxel-size", 2, "--json")
    assert made.code == 0, made.err
    assert made.json["segmentation"]["edits"] == document["segmentation"]["edits"]
    assert len(made.json["particles"]) == len(plain.json["particles"])
    labels = {each["label"] for each in made.json["particles"]}
    assert labels ^ {each["label"] for each in plain.json["particles"]} >= {7}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("a,b\n1,2\n", "its first line names the columns x, y, z and class"),
        ("x,y,z,class\n1,2,three,grain\n", "line 2 is no example"),
        ("x,y,z,class\n1,2,3,stone\n", "one of grain, several grains, artefact"),
        ("x,y,z,class\n0,0,0,grain\n", "There is no object at voxel (0, 0, 0)"),
        ("x,y,z,class\n16,16,16,grain\n", "Choose examples of two classes at least"),
        ("", "is no table of examples"),
    ],
)
def test_that_a_wrong_table_of_examples_gets_one_sentence(
    command, tmp_path: Path, text: str, sentence: str
) -> None:
    scan = scan_of_balls_pairs_and_plates(tmp_path)
    (tmp_path / "examples.csv").write_text(text, encoding="utf-8")
    result = command(
        "classify", "objects", scan, tmp_path / "examples.csv", "-o", tmp_path / "o", "--voxel-size", 2
    )
    assert result.code == 1
    assert sentence in result.err
    assert not (tmp_path / "o.json").exists()


def test_that_a_file_that_is_no_object_classifier_gets_one_sentence(command, tmp_path: Path) -> None:
    scan = scan_of_balls_pairs_and_plates(tmp_path)
    (tmp_path / "o.json").write_text("{}", encoding="utf-8")
    result = command("extract", scan, "-o", tmp_path / "x", "--objects", tmp_path / "o.json", *OPTIONS)
    assert result.code in (1, 2)
    assert "o.json is no object classifier" in result.err
    assert not (tmp_path / "x").exists()
