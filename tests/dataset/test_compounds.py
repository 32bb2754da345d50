"""Datasets of compounds: unions of convex parts, with the mass properties of the union."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset, aligned
from regolith_studio.dataset.export import write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.folder_io import read_dataset, stored_shape, write_dataset, write_stored
from regolith_studio.dataset.sampling import sample_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.convex_compound import ConvexCompound
from tests.geometry.solids import rotation

from .example import elbow, elbow_entry, elbow_moments, entry


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    return build_dataset([elbow_entry(), entry(1)], name="mixed")


@pytest.fixture
def folder(dataset: Dataset, tmp_path: Path) -> Path:
    return write_dataset(tmp_path / "set", dataset)


def record(folder: Path) -> dict[str, Any]:
    document: dict[str, Any] = json.loads((folder / "dataset.json").read_text())
    return dict(document["representatives"][0])


def test_that_the_record_of_an_elbow_has_the_mass_centre_and_inertia_of_its_union(folder: Path) -> None:
    stated = record(folder)["compound"]
    assert stated["volume"] == pytest.approx(1.0, abs=1e-12)
    assert stated["centre_of_mass"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert np.array(stated["inertia"]) == pytest.approx(np.diag(elbow_moments()), abs=1e-12)
    assert stated["descriptors"]["convexity"] == pytest.approx(20 / 28)
    assert stated["descriptors"]["surface_area"] == pytest.approx((2 * 20 + 24) / 20 ** (2 / 3))


def test_that_the_frame_of_an_elbow_leads_back_to_the_particle(dataset: Dataset) -> None:
    one = dataset.representatives[0]
    back = one.shape.vertices @ one.frame.rotation * one.frame.scale + one.frame.centroid
    assert one.frame.scale == pytest.approx(20 ** (1 / 3))
    far = np.abs(back[:, None] - elbow().vertices[None]).max(axis=2).min(axis=1)
    assert far.max() < 1e-9


def test_that_an_elbow_turned_and_scaled_becomes_the_same_shape() -> None:
    shape, _ = aligned(elbow())
    moved, _ = aligned(elbow().moved(shift=(9.0, -4.0, 2.0), rotation=rotation(7), scale=31.0))
    assert np.sort(moved.vertices, axis=0) == pytest.approx(np.sort(shape.vertices, axis=0), abs=1e-9)


def test_that_there_is_one_stl_of_the_union_and_one_a_part_which_trimesh_measures(folder: Path) -> None:
    names = sorted(path.name for path in (folder / "meshes").iterdir())
    parts = ["elbow.part1.stl", "elbow.part2.stl"]
    assert names == [*parts, "elbow.stl", "grain-1.stl"]
    union = trimesh.load_mesh(folder / "meshes" / "elbow.stl")
    assert union.is_watertight
    assert not union.is_convex
    assert union.volume == pytest.approx(1.0, rel=1e-6)
    assert union.moment_inertia == pytest.approx(np.array(record(folder)["compound"]["inertia"]), abs=1e-6)
    for name in parts:
        part = trimesh.load_mesh(folder / "meshes" / name)
        assert part.is_convex
        assert part.volume == pytest.approx(12 / 20, rel=1e-6)
        assert union.contains(part.vertices * 0.999 + 0.001 * part.center_mass).all()


def test_that_a_dataset_of_compounds_is_read_back_bit_for_bit_and_is_sound(
    folder: Path, tmp_path: Path
) -> None:
    assert validate_dataset(folder) == []
    again = write_dataset(tmp_path / "again", read_dataset(folder))
    for path in folder.rglob("*.*"):
        assert (again / path.relative_to(folder)).read_bytes() == path.read_bytes()
    shape = read_dataset(folder).representatives[0].shape
    assert isinstance(shape, ConvexCompound)
    assert shape.n_parts == 2


def test_that_compounds_written_one_by_one_give_the_same_bytes(tmp_path: Path) -> None:
    pairs = [elbow_entry("a"), entry(1), elbow_entry("b")]
    whole = build_dataset(pairs, name="set")
    write_dataset(tmp_path / "whole", whole)
    write_stored(
        tmp_path / "stream",
        lambda: (stored_shape(*pair) for pair in pairs),
        len(pairs),
        name="set",
        provenance=whole.provenance,
    )
    assert len(list((tmp_path / "whole" / "meshes").iterdir())) == 7
    for path in (tmp_path / "whole").rglob("*.*"):
        assert (tmp_path / "stream" / path.relative_to(tmp_path / "whole")).read_bytes() == path.read_bytes()


def test_that_particles_are_drawn_of_compounds_as_of_others(dataset: Dataset) -> None:
    drawn = sample_dataset(dataset, 1000, 3)
    assert np.bincount(drawn.class_index).tolist() == pytest.approx([500, 500], abs=60)
    assert drawn.diameter[drawn.class_index == 0] == pytest.approx((6 / np.pi * 20) ** (1 / 3))


def changed(*path: Any) -> Callable[[Any], None]:
    *outer, last, value = path

    def change(entry: Any) -> None:
        for key in outer:
            entry = entry[key]
        entry[last] = value

    return change


WRONG = {
    "sum of the parts": (changed("compound", "volume", 24 / 20), "the volume that is stated is 0.2 off"),
    "centre": (
        changed("compound", "centre_of_mass", 1, 0.01),
        "the centre of mass that is stated is 0.01 off",
    ),
    "inertia": (changed("compound", "inertia", 0, 0, 1.0), "the inertia that is stated is"),
    "descriptor": (changed("compound", "descriptors", "convexity", 1.0), "a convexity of 1.0 is stated"),
    "descriptor too many": (changed("compound", "descriptors", "beauty", 1.0), "the descriptor beauty"),
    "facets": (changed("mesh", "n_facets", 11), "11 facets are stated"),
    "facets of a part": (changed("compound", "parts", 1, "mesh", "n_facets", 7), "part2.stl: 7 facets"),
    "place of a part": (changed("compound", "parts", 0, "origin", 0, 0.5), "part1.stl: the mesh reaches"),
    "hash of a part": (
        changed("compound", "parts", 0, "mesh", "sha256", "0" * 64),
        "part1.stl is not the file",
    ),
    "both kinds": (
        changed("half_spaces", {"normals": [[1.0, 0.0, 0.0]] * 4, "offsets": [1.0] * 4}),
        "either half_spaces or compound",
    ),
    "neither": (changed("compound", None), "either half_spaces or compound"),
    "no parts": (changed("compound", "parts", []), "compound.parts"),
}


@pytest.mark.parametrize("kind", WRONG)
def test_that_a_wrong_number_of_a_compound_is_found_and_said(folder: Path, kind: str) -> None:
    change, sentence = WRONG[kind]
    document = json.loads((folder / "dataset.json").read_text())
    change(document["representatives"][0])
    (folder / "dataset.json").write_text(json.dumps(document))
    problems = validate_dataset(folder)
    assert any(sentence in problem for problem in problems), problems


def test_that_a_part_of_another_shape_is_found(folder: Path) -> None:
    other = (folder / "meshes" / "elbow.part1.stl").read_bytes()
    (folder / "meshes" / "elbow.part2.stl").write_bytes(other)
    with pytest.raises(DatasetError, match=r"part2\.stl is not the file"):
        read_dataset(folder)
    (folder / "meshes" / "elbow.part2.stl").unlink()
    with pytest.raises(DatasetError, match=r"part2\.stl cannot be read"):
        read_dataset(folder)


@pytest.mark.parametrize("key", [key for key in EXPORTERS if EXPORTERS[key].convex_only])
def test_that_a_format_of_convex_particles_refuses_compounds_and_says_why(
    dataset: Dataset, key: str, tmp_path: Path
) -> None:
    with pytest.raises(DatasetError, match="cannot hold elbow, a compound") as caught:
        write_export(dataset, EXPORTERS[key], tmp_path / "x", accept_loss=True)
    assert EXPORTERS[key].convex_only in str(caught.value)
    assert not (tmp_path / "x").exists()
    write_export(build_dataset([entry(1)]), EXPORTERS[key], tmp_path / "x", accept_loss=True)
