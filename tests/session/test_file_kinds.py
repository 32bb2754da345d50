"""What a path leads to: told without opening it."""

import json

import pytest

from regolith_studio.errors import InputError
from regolith_studio.resources import resource
from regolith_studio.session.file_kinds import FileKind, kind_of, kind_of_all
from regolith_studio.session.project import Project
from regolith_studio.session.recipe import Recipe

NAMES = {
    "grain.STL": FileKind.PARTICLES,
    "grain.anm": FileKind.PARTICLES,
    "table.csv": FileKind.PARTICLES,
    "heap.lammpstrj": FileKind.POSITIONS,
    "scan.tif": FileKind.VOLUME,
    "scan.nii.gz": FileKind.VOLUME,
    "scan.raw": FileKind.VOLUME,
    "work.regolith": FileKind.PROJECT,
    "thesis.docx": FileKind.UNKNOWN,
    "no_suffix": FileKind.UNKNOWN,
}


@pytest.mark.parametrize("name", NAMES)
def test_that_files_are_told_by_their_names(tmp_path, name):
    assert kind_of(tmp_path / name) == NAMES[name]


@pytest.mark.parametrize(
    ("head", "kind"),
    [
        ("x,y,z", FileKind.POSITIONS),
        ("id;x [mm];y [mm];z [mm]", FileKind.POSITIONS),
        ("#format x_y_z_r", FileKind.POSITIONS),
        ('"x_mm" "y_mm" "z_mm"', FileKind.POSITIONS),
        ("l m re im", FileKind.PARTICLES),
        ("0.1 0.2 0.3", FileKind.PARTICLES),
    ],
)
def test_that_a_table_with_columns_x_y_z_holds_positions(tmp_path, head, kind):
    (tmp_path / "table.txt").write_text(head + "\n1 2 3\n")
    assert kind_of(tmp_path / "table.txt") == kind


def test_that_json_is_told_by_its_content(tmp_path):
    path = tmp_path / "some.json"
    path.write_text(Recipe().to_json())
    assert kind_of(path) == FileKind.RECIPE
    path.write_text(Project().model_dump_json())
    assert kind_of(path) == FileKind.PROJECT
    path.write_text(json.dumps({"a": 1, "format": "regolith-studio fit"}))
    assert kind_of(path) == FileKind.SHAPES
    path.write_text(json.dumps({"format": "somebody else's"}))
    assert kind_of(path) == FileKind.UNKNOWN
    assert kind_of(resource("materials", "ma165.json")) == FileKind.SHAPES


def test_that_folders_are_told_by_what_is_in_them(tmp_path):
    assert kind_of(tmp_path) == FileKind.PARTICLES
    for number in range(3):
        (tmp_path / f"{number}.tif").touch()
    assert kind_of(tmp_path) == FileKind.VOLUME
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.ply").touch()
    assert kind_of(tmp_path) == FileKind.PARTICLES, "pictures lie beside meshes"
    (tmp_path / "dataset.json").touch()
    assert kind_of(tmp_path) == FileKind.DATASET


def test_that_what_cannot_be_opened_together_is_refused_in_one_sentence(tmp_path):
    mesh, scan, text = tmp_path / "a.stl", tmp_path / "b.tif", tmp_path / "c.docx"
    assert kind_of_all([mesh, mesh]) == FileKind.PARTICLES
    for paths, words in (
        ([mesh, scan], "several kinds"),
        ([scan, scan], "2 files"),
        ([mesh, text], "c.docx"),
    ):
        with pytest.raises(InputError, match=words) as caught:
            kind_of_all(paths)
        assert str(caught.value).count(". ") == 0
