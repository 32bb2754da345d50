"""``extract`` from grey and label volumes of several formats, as a user would call it."""

import csv
import hashlib
import json
import re
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
import tifffile
import trimesh

from regolith_studio.imaging.volume import sample_volume
from regolith_studio.resources import resource
from regolith_studio.session.outputs import particles
from regolith_studio.session.outputs.particles import ExtractionFolder

GREY = resource("samples", "ct", "synthetic-grey.tif")
PART = (slice(0, 80), slice(0, 80), slice(0, 80))


def part_of_scan(folder: Path, kind: str) -> Path:
    """A corner of the shipped scan, slices first."""
    np.save(folder / f"{kind}.npy", np.ascontiguousarray(sample_volume(kind).array[PART].T))
    return folder / f"{kind}.npy"


def two_balls() -> np.ndarray:
    """Slices first: balls of radius 9 and 12 voxels."""
    z, y, x = np.mgrid[:40, :44, :60]
    volume = np.full(z.shape, 40, dtype=np.uint8)
    volume[(x - 15) ** 2 + (y - 21) ** 2 + (z - 20) ** 2 <= 9**2] = 180
    volume[(x - 42) ** 2 + (y - 21) ** 2 + (z - 20) ** 2 <= 12**2] = 180
    noise = np.random.default_rng(0).integers(0, 20, volume.shape)
    return (volume + noise).astype(np.uint8)


def rows_of(folder: Path) -> list[dict[str, str]]:
    return list(csv.DictReader((folder / "particles.csv").read_text(encoding="utf-8").splitlines()))


def test_that_voxels_without_a_finite_number_are_reported(command, tmp_path: Path) -> None:
    balls = two_balls().astype(np.float32)
    balls[0, 0, 0], balls[0, 0, 1] = np.inf, np.nan
    np.save(tmp_path / "balls.npy", balls)
    result = command("extract", tmp_path / "balls.npy", "-o", tmp_path / "x", "--voxel-size", 1)
    assert result.code == 0
    assert result.err == "balls.npy: 2 voxels hold no finite number (NaN or infinity) and are in no grain.\n"
    assert len(rows_of(tmp_path / "x")) == 2


def test_that_what_a_reader_notes_is_printed_and_listed(command, tmp_path: Path) -> None:
    """Without it, a choice between two volumes, sheared axes and a mirror image were silent."""
    note = "The file holds 2 volumes; a was read."
    for name in ("one", "two"):
        with h5py.File(tmp_path / f"{name}.h5", "w") as file:
            file["a"] = file["b"] = two_balls()
    scans, size = [tmp_path / "one.h5", tmp_path / "two.h5"], ["--voxel-size", 1, "--surface", "mask"]
    assert command("extract", scans[0], "-o", tmp_path / "x", *size).err == f"one.h5: {note}\n"
    assert json.loads((tmp_path / "x" / "extraction.json").read_text("utf-8"))["notes"] == [note]
    several = command("extract", *scans, "-o", tmp_path / "y", *size)
    assert several.code == 0
    assert f"one: {note}\ntwo: {note}\n" in several.err


@pytest.mark.parametrize("surface", ["grey", "mask"])
@pytest.mark.slow
def test_that_a_grey_scan_becomes_particles_with_a_recipe(command, tmp_path: Path, surface: str) -> None:
    scan, x = part_of_scan(tmp_path, "grey"), tmp_path / "x"
    asked = ["--denoise", "gaussian", "--voxel-size", 2.3, "--surface", surface, "--json"]
    result = command("extract", scan, "-o", x, *asked)
    assert result.code == 0
    rows, recipe = rows_of(x), json.loads((x / "extraction.json").read_text())
    assert recipe["volume"]["sha256"] == hashlib.sha256(scan.read_bytes()).hexdigest()
    assert recipe["segmentation"]["denoise"]["method"] == "gaussian"
    assert len(rows) == recipe["n_particles"] == len(result.json["particles"]) > 3
    assert len(rows) + len(recipe["border"]) + len(recipe["small"]) == recipe["segmented"]["n_grains"]
    assert len(list(x.glob("*.stl"))) == len(rows)
    for row in rows:
        mesh = trimesh.load_mesh(x / f"{row['name']}.stl")
        assert mesh.is_volume
        assert mesh.volume == pytest.approx(float(row["volume [um^3]"]), rel=1e-4)
        assert row["surface"] == surface
        near = 0.02 if surface == "mask" else 0.5
        assert float(row["volume [um^3]"]) == pytest.approx(int(row["voxels"]) * 2.3**3, rel=near)
        assert float(row["weight"]) > 1.0
    assert recipe["extraction"]["surface"] == surface


def test_that_the_recipe_of_one_scan_serves_the_next(command, tmp_path: Path) -> None:
    np.save(tmp_path / "scan.npy", two_balls())
    call = ("extract", tmp_path / "scan.npy", "--kind", "grey", "--voxel-size", 1)
    first = command(*call, "-o", tmp_path / "a", "--denoise", "none", "--threshold", 111, "--min-voxels", 99)
    second = command(*call, "-o", tmp_path / "b", "--recipe", tmp_path / "a" / "extraction.json")
    assert (first.code, second.code) == (0, 0)
    files = [{each.name: each.read_bytes() for each in (tmp_path / name).iterdir()} for name in "ab"]
    assert files[0] == files[1]


def test_that_a_cropped_scan_gives_its_grains_in_their_places_and_the_recipe_too(
    command, tmp_path: Path
) -> None:
    np.save(tmp_path / "scan.npy", two_balls())
    call = ("extract", tmp_path / "scan.npy", "--kind", "grey", "--voxel-size", 2)
    asked = ("--denoise", "none", "--threshold", 111, "--crop", "50:120um,:,:")
    whole = command(*call, "-o", tmp_path / "whole", *asked[:4])
    first = command(*call, "-o", tmp_path / "a", *asked)
    second = command(*call, "-o", tmp_path / "b", "--recipe", tmp_path / "a" / "extraction.json")
    assert (whole.code, first.code, second.code) == (0, 0, 0)
    files = [{each.name: each.read_bytes() for each in (tmp_path / name).iterdir()} for name in "ab"]
    assert files[0] == files[1]
    recipe = json.loads(files[0]["extraction.json"])
    assert recipe["region"] == {"crop": "50:120um,:,:", "bin": 1, "outside": "auto"}
    assert recipe["volume"]["shape_xyz"] == [35, 44, 40]
    (row,), (larger, _) = rows_of(tmp_path / "a"), rows_of(tmp_path / "whole")
    files = (tmp_path / "a" / f"{row['name']}.stl", tmp_path / "whole" / f"{larger['name']}.stl")
    bounds = [trimesh.load_mesh(file).bounds for file in files]
    assert bounds[0] == pytest.approx(bounds[1], abs=0.005)
    assert bounds[0][0] == pytest.approx([60, 18, 16], abs=1)


def test_that_a_binned_scan_gives_balls_of_the_right_size(command, tmp_path: Path) -> None:
    np.save(tmp_path / "scan.npy", two_balls())
    call = ("extract", tmp_path / "scan.npy", "-o", tmp_path / "x", "--voxel-size", 2, "--bin", 2)
    result = command(*call, "--kind", "grey", "--min-voxels", 100, "--json")
    assert result.code == 0, result.err
    assert result.json["volume"]["voxel_size_um"] == [4.0, 4.0, 4.0]
    radii = sorted(float(row["equivalent_radius [um]"]) for row in rows_of(tmp_path / "x"))
    assert radii == pytest.approx([18.0, 24.0], rel=0.03)


def test_that_labels_that_are_written_give_the_same_grains_again(command, tmp_path: Path) -> None:
    balls = two_balls()
    balls[18:22, 19:23, :5] = 180
    np.save(tmp_path / "scan.npy", balls)
    asked = (
        "--surface",
        "mask",
        "--min-voxels",
        100,
        "--denoise",
        "none",
        "--threshold",
        111,
        "--closing",
        1,
    )
    call = (
        "extract",
        tmp_path / "scan.npy",
        "--kind",
        "grey",
        "--voxel-size",
        "1,1,1.5",
        "-o",
        tmp_path / "a",
    )
    assert command(*call, *asked, "--labels", tmp_path / "grains.tif").code == 0
    assert command("extract", tmp_path / "grains.tif", "-o", tmp_path / "b", "--min-voxels", 100).code == 0
    meshes = [{each.name: each.read_bytes() for each in (tmp_path / name).glob("*.stl")} for name in "ab"]
    assert len(meshes[0]) == 2
    assert meshes[0] == meshes[1]
    table = list(csv.DictReader((tmp_path / "grains.csv").read_text(encoding="utf-8").splitlines()))
    found = {row["name"]: (row["label"], row["voxels"]) for row in rows_of(tmp_path / "a")}
    assert {row["particle"]: (row["label"], row["voxels"]) for row in table if row["particle"]} == found
    assert [row["left_out"] for row in table if not row["particle"]] == ["border"]


def test_that_labels_of_an_unknown_format_are_bad_use(command, tmp_path: Path) -> None:
    result = command("extract", GREY, "-o", tmp_path / "x", "--labels", tmp_path / "labels.png")
    assert result.code == 2
    assert "Labels are written as .tif" in " ".join(result.err.split())
    nowhere = command("extract", GREY, "-o", tmp_path / "x", "--labels", tmp_path / "x" / "labels.tif")
    assert nowhere.code == 1
    assert nowhere.err.startswith("There is no folder")
    assert not list(tmp_path.iterdir())


def test_that_keeping_the_border_of_labels_gives_all_grains(command, tmp_path: Path) -> None:
    scan, x = part_of_scan(tmp_path, "labels"), tmp_path / "x"
    result = command("extract", scan, "-o", x, "--keep-border", "--voxel-size", 1, "--min-voxels", 600)
    assert result.code == 0
    sizes = np.bincount(sample_volume("labels").array[PART].ravel())[1:]
    assert [int(row["voxels"]) for row in rows_of(x)] == sizes[sizes >= 600].tolist()
    assert {row["weight"] for row in rows_of(x)} == {"1.0"}
    assert "segmentation" not in json.loads((x / "extraction.json").read_text())


def test_that_a_raw_file_needs_its_shape_and_gives_balls_of_the_right_size(command, tmp_path: Path) -> None:
    two_balls().tofile(tmp_path / "scan.raw")
    call = ("extract", tmp_path / "scan.raw", "-o", tmp_path / "x", "--voxel-size", 0.002, "--unit", "mm")
    assert command(*call).code == 1
    result = command(*call, "--shape", "60,44,40", "--kind", "grey")
    assert result.code == 0
    radii = sorted(float(row["equivalent_radius [um]"]) for row in rows_of(tmp_path / "x"))
    assert radii == pytest.approx([18.0, 24.0], rel=0.02)


def test_that_voxels_may_be_longer_one_way(command, tmp_path: Path) -> None:
    np.save(tmp_path / "scan.npy", two_balls()[::2])
    result = command(
        "extract", tmp_path / "scan.npy", "-o", tmp_path / "x", "--kind", "grey", "--voxel-size", "1,1,2",
        "--threshold", 110, "--min-voxels", 100,
    )  # fmt: skip
    assert result.code == 0
    radii = sorted(float(row["equivalent_radius [um]"]) for row in rows_of(tmp_path / "x"))
    assert radii == pytest.approx([9.0, 12.0], rel=0.03)


def test_that_a_probability_map_of_an_hdf5_file_is_taken(command, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "scan.h5", "w") as file:
        file["raw"] = two_balls()
        file["likely"] = (two_balls() > 100).astype(np.float32)
    result = command(
        "extract", tmp_path / "scan.h5", "-o", tmp_path / "x", "--dataset", "likely", "--kind", "grey",
        "--threshold", "probability:0.5", "--voxel-size", 1,
    )  # fmt: skip
    assert result.code == 0, result.err
    assert "2 particles" in result.out


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--threshold", "bright"), "A threshold is otsu"),
        (("--denoise", "wavelets"), "method must be one of"),
        (("--kind", "colour"), "labels or grey values"),
        (("--voxel-size", "1,2"), "three as X,Y,Z"),
        (("--shape", "3x4"), "NX,NY,NZ"),
        (("--recipe", "nowhere.json"), "cannot be opened"),
        (("--crop", "1:2"), "A crop is X0:X1,Y0:Y1,Z0:Z1"),
    ],
)
def test_that_bad_options_are_bad_use(command, tmp_path: Path, options, sentence: str) -> None:
    result = command("extract", GREY, "-o", tmp_path / "x", *options)
    assert result.code == 2
    assert sentence in " ".join(result.err.split())


def test_that_grey_values_without_grains_are_one_sentence(command, tmp_path: Path) -> None:
    noise = np.random.default_rng(0).integers(0, 255, (20, 20, 20)).astype(np.uint8)
    tifffile.imwrite(tmp_path / "noise.tif", noise)
    result = command(
        "extract", tmp_path / "noise.tif", "-o", tmp_path / "x", "--voxel-size", 1, "--kind", "grey"
    )
    assert result.code == 1
    assert len(result.err.strip().splitlines()) == 1
    assert not (tmp_path / "x").exists()


def test_that_the_preview_of_h_prints_counts_and_writes_nothing(command, tmp_path: Path) -> None:
    np.save(tmp_path / "balls.npy", two_balls())
    asked = ("extract", tmp_path / "balls.npy", "--voxel-size", 1, "--preview-h", "0.8,1e3")
    result = command(*asked, "--json")
    assert [(row["h_maxima"], row["grains"]) for row in result.json["rows"]] == [(0.8, 2), (1000, 2)]
    assert command(*asked).out.splitlines()[1].split()[:2] == ["0.8", "2"]
    assert [path.name for path in tmp_path.iterdir()] == ["balls.npy"]


def test_that_extract_wants_a_folder_or_values_of_h(command, tmp_path: Path) -> None:
    np.save(tmp_path / "balls.npy", two_balls())
    nothing = command("extract", tmp_path / "balls.npy")
    assert nothing.code == 2
    assert "Name a folder to write with -o" in nothing.err
    wrong = command("extract", tmp_path / "balls.npy", "--preview-h", "0.8,-1")
    assert wrong.code == 2
    assert "Values of h are numbers from 0" in wrong.err
    labels = command("extract", GREY.with_name("synthetic-labels.tif"), "--preview-h", "0.8")
    assert labels.code == 1
    assert "holds labels" in labels.err


@pytest.mark.parametrize("moment", ["the first particle", "the last particle", "the tables"])
def test_that_a_folder_that_is_removed_while_it_is_written_to_is_not_made_again(
    command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moment: str
) -> None:
    parent = tmp_path / "parent"
    parent.mkdir()
    np.save(tmp_path / "balls.npy", two_balls())
    owner, step = (ExtractionFolder, "finish") if moment == "the tables" else (particles, "write_particle")
    complete, left = getattr(owner, step), ["the first particle", "the last particle"]

    def remove(*arguments: object) -> object:
        if moment not in left[1:]:
            shutil.rmtree(parent, ignore_errors=True)
        left.pop(0)
        return complete(*arguments)

    monkeypatch.setattr(owner, step, remove)
    result = command("extract", tmp_path / "balls.npy", "-o", parent / "x", "--voxel-size", 1)
    assert (result.code, result.out) == (1, "")
    sentence = r"The file .*/parent/x/[^/]+ cannot be written \(there is no such file\)\.\n"
    assert re.fullmatch(sentence, result.err)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["balls.npy"]
