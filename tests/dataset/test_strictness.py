"""Broken datasets: each is refused with one sentence that names the place."""

import hashlib
import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.dataset.folder_io import read_dataset, write_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.triangles import stl_bytes


@pytest.fixture(scope="module")
def sound(tmp_path_factory) -> Path:
    from regolith_studio.dataset.build import build_dataset

    from .example import entry

    folder = tmp_path_factory.mktemp("sound") / "set"
    return write_dataset(folder, build_dataset([entry(0), entry(1)], name="sound"))


@pytest.fixture
def folder(sound: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(sound, tmp_path / "set"))


def edit(folder: Path, change) -> None:
    path = folder / "dataset.json"
    document = json.loads(path.read_text(encoding="utf-8"))
    change(document)
    path.write_text(json.dumps(document), encoding="utf-8")


def refused(folder: Path) -> str:
    with pytest.raises(DatasetError) as caught:
        read_dataset(folder)
    problems = validate_dataset(folder)
    assert problems
    return str(caught.value)


def set_at(*path):
    *outer, last, value = path

    def change(document) -> None:
        for key in outer:
            document = document[key]
        document[last] = value

    return change


FIRST = ("representatives", 0)

BROKEN = {
    "unknown field": (set_at(*FIRST, "colour", "red"), "representatives[0].colour is not known here"),
    "unknown field at the top": (set_at("extra", 1), "extra is not known here"),
    "weights": (set_at(*FIRST, "weight", 0.6), "weights must add up to 1"),
    "negative weight": (set_at(*FIRST, "weight", -0.5), "representatives[0].weight"),
    "weight as text": (set_at(*FIRST, "weight", "0.5"), "representatives[0].weight"),
    "weight just off": (set_at(*FIRST, "weight", 0.5 + 1e-11), "weights must add up to 1"),
    "falling sizes": (
        set_at(
            *FIRST,
            "sizes",
            {"type": "discrete", "weighting": "number", "diameters_um": [2, 1], "shares": [0.5, 0.5]},
        ),
        "strictly ascending",
    ),
    "negative share": (
        set_at(
            *FIRST,
            "sizes",
            {"type": "sieve", "weighting": "number", "openings_um": [1, 2, 3], "shares": [1.5, -0.5]},
        ),
        "representatives[0].sizes.sieve.shares[0]",
    ),
    "unknown kind of sizes": (set_at(*FIRST, "sizes", {"type": "gamma"}), "representatives[0].sizes"),
    "absolute path": (set_at(*FIRST, "mesh", "file", "/etc/passwd"), "representatives[0].mesh.file"),
    "drive": (set_at(*FIRST, "mesh", "file", "C:\\a.stl"), "representatives[0].mesh.file"),
    "path out of the folder": (
        set_at(*FIRST, "mesh", "file", "meshes/../../x.stl"),
        "representatives[0].mesh.file",
    ),
    "hidden path": (set_at(*FIRST, "mesh", "file", "meshes/..stl"), "representatives[0].mesh.file"),
    "line break in a path": (
        set_at(*FIRST, "mesh", "file", "meshes/a.stl\n"),
        "representatives[0].mesh.file",
    ),
    "same mesh twice": (set_at(*FIRST, "mesh", "file", "meshes/GRAIN-1.stl"), "mesh files"),
    "wrong hash": (set_at(*FIRST, "mesh", "sha256", "0" * 64), "is not the file that dataset.json describes"),
    "no hash": (set_at(*FIRST, "mesh", "sha256", "abc"), "representatives[0].mesh.sha256"),
    "other version": (set_at("schema_version", 2), "schema version 2"),
    "other format": (set_at("format", "something"), "not a dataset of Regolith Studio"),
    "other unit": (set_at("length_unit", "mm"), "length_unit"),
    "no representatives": (set_at("representatives", []), "representatives"),
    "same name twice": (set_at(*FIRST, "name", "grain-1"), "names"),
    "unbounded": (
        set_at(
            *FIRST,
            "half_spaces",
            {"normals": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 1, 1]], "offsets": [1, 1, 1, 1]},
        ),
        "grain-0 cannot be used",
    ),
    "unequal lengths": (set_at(*FIRST, "half_spaces", "offsets", [1.0] * 5), "as many offsets"),
    "vanishing normal": (set_at(*FIRST, "half_spaces", "normals", 0, [0, 0, 0]), "grain-0 cannot be used"),
    "not unit volume": (set_at(*FIRST, "half_spaces", "offsets", 0, 0.3), "unit volume"),
    "no rotation": (
        set_at(*FIRST, "frame", "rotation", [[1, 0, 0], [0, 1, 0], [0, 0, -1]]),
        "proper rotation",
    ),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_that_a_broken_document_is_refused_and_the_place_named(folder: Path, kind: str) -> None:
    change, place = BROKEN[kind]
    edit(folder, change)
    assert place in refused(folder)


TEXTS = {
    "NaN": (
        lambda text: text.replace('"weight": 0.5', '"weight": NaN', 1),
        "NaN at representatives[0].weight",
    ),
    "too large": (
        lambda text: text.replace('"weight": 0.5', '"weight": 1e999', 1),
        "inf at representatives[0].weight",
    ),
    "infinity": (lambda text: text.replace('"weight": 0.5', '"weight": -Infinity', 1), "-Infinity at"),
    "duplicate key": (
        lambda text: text.replace('"weight": 0.5', '"weight": 0.5, "weight": 0.5', 1),
        "the key 'weight' twice at representatives[0]",
    ),
    "half of it": (lambda text: text[: len(text) // 2], "is not JSON"),
    "empty": (lambda _: "", "is not JSON"),
    "a list": (lambda _: "[]", "not a dataset"),
    "deep": (lambda _: "[" * 100_000, "nests too deeply"),
    "long number": (lambda _: "1" * 10_000, "cannot be read|is not JSON"),
    "trailing text": (lambda text: text + "x", "is not JSON"),
}


@pytest.mark.parametrize("kind", TEXTS)
def test_that_broken_text_is_refused_in_one_sentence(folder: Path, kind: str) -> None:
    change, place = TEXTS[kind]
    path = folder / "dataset.json"
    path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
    message = refused(folder)
    assert any(part in message for part in place.split("|"))
    assert "\n" not in message


def test_that_bytes_which_are_no_text_are_refused(folder: Path) -> None:
    (folder / "dataset.json").write_bytes(b"\xff\xfe{}")
    assert "UTF-8" in refused(folder)


def test_that_a_missing_folder_and_missing_files_are_named(folder: Path, tmp_path: Path) -> None:
    assert "nowhere" in refused(tmp_path / "nowhere")
    (folder / "meshes" / "grain-1.stl").unlink()
    assert "grain-1.stl cannot be read" in refused(folder)


def test_that_a_mesh_behind_a_link_out_of_the_folder_is_refused(folder: Path, tmp_path: Path) -> None:
    mesh = folder / "meshes" / "grain-0.stl"
    mesh.rename(tmp_path / "outside.stl")
    mesh.symlink_to(tmp_path / "outside.stl")
    assert "outside the dataset's folder" in refused(folder)


def test_that_huge_files_are_not_read(folder: Path) -> None:
    os.truncate(folder / "dataset.json", 400_000_000)
    assert "larger than 320 MB" in refused(folder)


def put_mesh(folder: Path, mesh: Mesh) -> None:
    content = stl_bytes(mesh.triangles, "test")
    (folder / "meshes" / "grain-0.stl").write_bytes(content)
    edit(folder, set_at(*FIRST, "mesh", "sha256", hashlib.sha256(content).hexdigest()))


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda mesh: Mesh(mesh.vertices, mesh.faces[:-1]), "not closed"),
        (lambda mesh: Mesh(mesh.vertices, mesh.faces[:, ::-1]), "volume of -1"),
        (lambda mesh: mesh.moved(scale=1.001), "volume of 1.003"),
        (lambda mesh: mesh.moved(shift=(0.01, 0, 0)), "beyond the half-spaces"),
        (
            lambda mesh: Mesh(mesh.vertices, np.vstack([mesh.faces[:1, [0, 2, 1]], mesh.faces[1:]])),
            "same way round",
        ),
    ],
)
def test_that_validation_finds_what_is_wrong_with_a_mesh(folder: Path, change, problem: str) -> None:
    put_mesh(folder, change(read_dataset(folder).representatives[0].shape.mesh))
    assert any(problem in sentence for sentence in validate_dataset(folder))


def test_that_validation_finds_stl_that_is_none(folder: Path) -> None:
    content = b"solid x\nendsolid x\n"
    (folder / "meshes" / "grain-0.stl").write_bytes(content)
    edit(folder, set_at(*FIRST, "mesh", "sha256", hashlib.sha256(content).hexdigest()))
    assert any("no complete binary STL" in sentence for sentence in validate_dataset(folder))


def test_that_validation_counts_facets(folder: Path) -> None:
    edit(folder, set_at(*FIRST, "mesh", "n_facets", 12))
    assert any("12 facets are stated" in sentence for sentence in validate_dataset(folder))


def test_that_validation_misses_a_readme(folder: Path) -> None:
    (folder / "README.txt").unlink()
    assert validate_dataset(folder) == ["README.txt is missing."]
