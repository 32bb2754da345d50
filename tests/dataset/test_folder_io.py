"""The dataset folder: what is written is read back exactly, and nothing foreign is overwritten."""

import hashlib
import itertools
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from regolith_studio.dataset import folder_io
from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Provenance
from regolith_studio.dataset.folder_io import (
    StoredShape,
    dataset_hash,
    read_dataset,
    read_document,
    stored_shape,
    write_dataset,
    write_stored,
)
from regolith_studio.dataset.schema import CoarseningRecord
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.particle import Particle
from tests.files import contents

from .example import Coarse, entry


def test_that_a_dataset_comes_back_as_it_was(tmp_path: Path, make_dataset) -> None:
    dataset = make_dataset()
    back = read_dataset(write_dataset(tmp_path / "set", dataset))
    assert (back.name, back.weighting, back.provenance) == (
        dataset.name,
        dataset.weighting,
        dataset.provenance,
    )
    for one, other in zip(dataset.representatives, back.representatives, strict=True):
        assert np.array_equal(one.shape.half_spaces.normals, other.shape.half_spaces.normals)
        assert np.array_equal(one.shape.half_spaces.offsets, other.shape.half_spaces.offsets)
        assert np.array_equal(one.shape.vertices, other.shape.vertices)
        assert one.shape.facets == other.shape.facets
        assert np.array_equal(one.frame.rotation, other.frame.rotation)
        assert (one.weight, one.sizes, one.approximation, one.source) == (
            other.weight,
            other.sizes,
            other.approximation,
            other.source,
        )


def test_that_the_same_dataset_gives_the_same_bytes_and_so_does_the_one_read_back(
    tmp_path, make_dataset
) -> None:
    write_dataset(tmp_path / "a", make_dataset())
    write_dataset(tmp_path / "b", make_dataset())
    write_dataset(tmp_path / "c", read_dataset(tmp_path / "a"))
    assert contents(tmp_path / "a") == contents(tmp_path / "b") == contents(tmp_path / "c")


def test_that_the_folder_holds_the_promised_files(tmp_path: Path, make_dataset) -> None:
    folder = write_dataset(tmp_path / "set", make_dataset())
    assert list(contents(folder)) == [
        "README.txt",
        "dataset.json",
        "meshes/grain-0.stl",
        "meshes/grain-1.stl",
        "meshes/grain-2.stl",
    ]
    document = json.loads((folder / "dataset.json").read_text(encoding="utf-8"))
    assert document["schema_version"] == 4
    assert document["length_unit"] == "um"
    for record in document["representatives"]:
        content = (folder / record["mesh"]["file"]).read_bytes()
        assert hashlib.sha256(content).hexdigest() == record["mesh"]["sha256"]
    assert "volume 1" in (folder / "README.txt").read_text(encoding="utf-8")


def test_that_files_are_named_after_particles_whatever_their_names_hold(tmp_path: Path) -> None:
    names = ["Körnung 3/a", "grain", "GRAIN", "con", "..", "one.part1", "a\nb:c", "x" * 300]
    pairs = [(Particle(name, entry(0)[0].mesh), entry(0)[1]) for name in names]
    folder = write_dataset(tmp_path / "set", build_dataset(pairs))
    found = [record.mesh.file for record in read_document(folder).representatives]
    assert found == [
        f"meshes/{name}.stl"
        for name in ("Körnung 3_a", "grain", "GRAIN_2", "con_", "_", "one_part1", "a_b_c", "x" * 100)
    ]
    assert validate_dataset(folder) == []
    assert len(read_dataset(folder)) == len(names)
    write_dataset(folder, build_dataset(pairs[:1]))
    assert [path.name for path in (folder / "meshes").iterdir()] == ["Körnung 3_a.stl"]


def test_that_a_stranger_reads_closed_convex_meshes_of_unit_volume(tmp_path: Path, make_dataset) -> None:
    dataset = make_dataset()
    folder = write_dataset(tmp_path / "set", dataset)
    for representative in dataset.representatives:
        mesh = trimesh.load_mesh(folder / "meshes" / f"{representative.name}.stl")
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.volume == pytest.approx(1.0, abs=1e-6)
        assert mesh.convex_hull.volume == pytest.approx(1.0, abs=1e-6)
        assert np.abs(mesh.center_mass).max() < 1e-6
        assert len(mesh.faces) == representative.shape.n_triangles


def test_that_an_edge_shorter_than_float32_resolves_is_no_problem(tmp_path: Path) -> None:
    octahedron = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    offsets = np.ones(8)
    offsets[0] += 1e-9
    solid = ConvexPolyhedron.from_half_spaces(HalfSpaces(octahedron, offsets))
    assert solid.n_vertices > 6
    particle = Particle("octahedron", solid.mesh)
    folder = write_dataset(tmp_path / "set", build_dataset([(particle, Coarse(solid, np.zeros(3)))]))
    assert not validate_dataset(folder)


def test_that_a_dataset_can_be_kept_from_being_replaced(tmp_path: Path, make_dataset) -> None:
    folder = write_dataset(tmp_path / "set", make_dataset())
    before = contents(folder)
    with pytest.raises(DatasetError, match="holds a dataset already"):
        write_dataset(folder, make_dataset(first=10), overwrite=False)
    assert contents(folder) == before


def test_that_an_empty_folder_is_used_and_missing_parents_are_made(tmp_path: Path, make_dataset) -> None:
    (tmp_path / "empty").mkdir()
    write_dataset(tmp_path / "empty", make_dataset())
    write_dataset(tmp_path / "a" / "b" / "c", make_dataset())
    assert validate_dataset(tmp_path / "empty") == validate_dataset(tmp_path / "a" / "b" / "c") == []


@pytest.mark.parametrize("name", ["notes.txt", "meshes/other.stl", ".hidden", "meshes/sub/x"])
def test_that_a_folder_with_foreign_files_is_not_overwritten(tmp_path: Path, make_dataset, name: str) -> None:
    folder = write_dataset(tmp_path / "set", make_dataset())
    (folder / name).parent.mkdir(exist_ok=True)
    (folder / name).write_text("mine")
    before = contents(folder)
    with pytest.raises(DatasetError, match="not the dataset's"):
        write_dataset(folder, make_dataset(first=10))
    assert contents(folder) == before
    assert any(name.split("/")[-1] in problem for problem in validate_dataset(folder))


def test_that_the_hash_of_a_dataset_is_that_of_its_document(tmp_path: Path, make_dataset) -> None:
    one, same, other = (
        dataset_hash(write_dataset(tmp_path / name, make_dataset(first=first)))
        for name, first in (("a", 0), ("b", 0), ("c", 10))
    )
    assert one == same != other
    assert one == hashlib.sha256((tmp_path / "a" / "dataset.json").read_bytes()).hexdigest()


def test_that_what_file_managers_leave_behind_is_no_hindrance(tmp_path: Path, make_dataset) -> None:
    folder = write_dataset(tmp_path / "set", make_dataset())
    (folder / ".DS_Store").write_text("x")
    assert validate_dataset(folder) == []
    write_dataset(folder, make_dataset(first=10))
    assert not (folder / ".DS_Store").exists()


def test_that_a_folder_of_something_else_and_a_file_are_not_overwritten(tmp_path: Path, make_dataset) -> None:
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "moon.png").write_bytes(b"x")
    (tmp_path / "file").write_text("x")
    with pytest.raises(DatasetError, match="choose another folder"):
        write_dataset(tmp_path / "photos", make_dataset())
    with pytest.raises(DatasetError, match="is a file"):
        write_dataset(tmp_path / "file", make_dataset())
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "photos"]


def test_that_a_link_to_a_folder_is_followed(tmp_path: Path, make_dataset) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    write_dataset(tmp_path / "link", make_dataset())
    assert validate_dataset(tmp_path / "real") == []
    assert (tmp_path / "link").is_symlink()


def test_that_errors_which_are_not_finite_are_not_written(tmp_path: Path, make_dataset) -> None:
    dataset = make_dataset()
    dataset.representatives[0].approximation.errors["volume"] = float("nan")
    with pytest.raises(DatasetError, match="cannot be written"):
        write_dataset(tmp_path / "set", dataset)
    assert not (tmp_path / "set").exists()


STORY = Provenance(
    description='A set with "quotes" and a µ.',
    coarsening=CoarseningRecord(
        method="exact",
        n_facets=20,
        seed=3,
        target="particle",
        preset=None,
        weights={"volume": 1.0},
        settings={},
    ),
)
PAIRS = [entry(seed) for seed in range(3)]


def shapes() -> Iterator[StoredShape]:
    return (stored_shape(*pair) for pair in PAIRS)


def test_that_both_ways_of_writing_leave_the_same_bytes(tmp_path: Path) -> None:
    write_dataset(tmp_path / "whole", build_dataset(PAIRS, name="a set", provenance=STORY))
    write_stored(tmp_path / "stream", shapes, 3, name="a set", provenance=STORY)
    assert contents(tmp_path / "stream") == contents(tmp_path / "whole")
    assert validate_dataset(tmp_path / "stream") == []
    assert len(read_dataset(tmp_path / "stream")) == 3


def test_that_a_shape_that_breaks_the_schema_leaves_the_folder_as_it_was(tmp_path: Path) -> None:
    write_stored(tmp_path / "set", shapes, 3, name="a set", provenance=STORY)
    before = contents(tmp_path / "set")

    def broken() -> Iterator[StoredShape]:
        for shape in shapes():
            yield replace(shape, record={**shape.record, "n_members": 0})

    with pytest.raises(DatasetError, match=r"grain-0, n_members"):
        write_stored(tmp_path / "set", broken, 3, name="a set", provenance=STORY)
    assert contents(tmp_path / "set") == before
    assert [path.name for path in tmp_path.iterdir()] == ["set"]


def test_that_a_dataset_that_could_not_be_read_again_is_not_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(folder_io, "MAX_DOCUMENT_BYTES", 5_000)
    with pytest.raises(DatasetError, match="too large to be read"):
        write_stored(tmp_path / "set", shapes, 3, name="a set", provenance=STORY)
    assert not (tmp_path / "set").exists()
