"""Whatever a thing is called, its file stays in its folder, on every system, and no two share one."""

import csv
import io
from pathlib import Path, PureWindowsPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from regolith_studio.errors import FileError
from regolith_studio.io.atomic import replace_folder, staged_folder, write_in_stage
from regolith_studio.io.file_names import MAX_NAME_BYTES, file_stem, name_key, path_inside, unique_name
from regolith_studio.io.tables import csv_bytes, read_csv

HOSTILE = (
    *(
        "../../escaped",
        "/etc/passwd",
        "..",
        ".",
        "",
        " ",
        "a/b",
        "a\\b",
        "C:\\x",
        "C:x",
        "\\\\host\\share\\x",
    ),
    *("CON", "nul.txt", "Com1", "aux .x", "lpt¹", "a\0b", "a\nb", ".hidden", "x.", "x ", "x. .", "a:stream"),
    *("=1+1", "<img src='x'>", "a" * 300, "ü" * 300, "\ud800", "-rf", "grain.part1", "con" + "." * 120),
)
names = st.text(max_size=120) | st.sampled_from(HOSTILE)


def is_safe(stem: str) -> bool:
    path = PureWindowsPath(stem + ".stl")
    printable = all(sign.isprintable() and sign not in '/\\:*?"<>|' for sign in stem)
    return printable and path.name == stem + ".stl" and not path.is_reserved() and stem[0] != "."


@given(names)
def test_that_a_file_name_is_safe_on_every_system(name: str) -> None:
    stem = file_stem(name)
    assert 0 < len(stem.encode()) <= MAX_NAME_BYTES
    assert is_safe(stem)
    assert not stem.endswith((".", " "))
    assert file_stem(stem) == stem


@pytest.mark.parametrize("name", ["bead-1", "Körnung 3, 25–50 µm", "a.b-c_d", "Ω", "=1+1", "x (2)"])
def test_that_an_ordinary_name_stays_as_it_is(name: str) -> None:
    assert file_stem(name) == name


@given(st.lists(names, max_size=12))
def test_that_no_two_names_share_a_file_on_any_system(listed: list[str]) -> None:
    used: dict[str, int] = {}
    unique = [unique_name(name, "", used) for name in listed]
    assert len({file_stem(name).casefold() for name in unique}) == len(listed)
    assert len({name_key(name) for name in unique}) == len(listed)
    assert all(len(name.encode()) <= MAX_NAME_BYTES for name in unique)


def test_that_names_differing_in_case_only_get_numbers() -> None:
    used: dict[str, int] = {}
    assert [unique_name(name, "", used) for name in ("a", "A", "a", "a/b", "a_b")] == [
        *("a", "A_2", "a_3", "a/b", "a_b_2")
    ]


@pytest.mark.parametrize(
    "name", ["../x", "/x", "a/../../x", "a//x", "./x", "", "..", "C:/x", "a\\..\\x", "a\0", "out/x"]
)
def test_that_a_path_that_leaves_its_folder_is_refused_where_files_are_written(
    tmp_path: Path, name: str
) -> None:
    folder, outside = tmp_path / "folder", tmp_path / "outside"
    folder.mkdir()
    outside.mkdir()
    (folder / "out").symlink_to(outside)
    with pytest.raises(FileError, match="would not be in the folder"):
        path_inside(folder, name)
    with pytest.raises(FileError, match="would not be in the folder"):
        write_in_stage(folder, name, b"x")
    if name != "out/x":  # a new folder has no links
        with pytest.raises(FileError, match="would not be in the folder"):
            replace_folder(tmp_path / "new", {name: b"x"})
    assert {path.name for path in tmp_path.iterdir()} == {"folder", "outside"}
    assert not list(outside.iterdir())


def test_that_a_link_in_an_earlier_output_leads_nothing_out_of_it(tmp_path: Path) -> None:
    folder, outside = tmp_path / "folder", tmp_path / "outside"
    outside.mkdir()
    folder.mkdir()
    (folder / "meshes").symlink_to(outside)
    (folder / "of-the-user.txt").write_text("kept")
    with pytest.raises(FileError, match="would not be in the folder"):
        _write_a_mesh(folder)
    assert not list(outside.iterdir())


CELLS = (
    "=1+1",
    "+x",
    "-x",
    "@sum",
    "\tx",
    "\rx",
    "\nx",
    "'=1",
    "''=1",
    "'x",
    "-",
    "=",
    "-5",
    "+.5e3",
    "-inf",
)


@given(st.lists(st.sampled_from(CELLS) | st.text(st.characters(exclude_characters="\0")), max_size=4))
def test_that_names_in_tables_are_read_back_as_they_were(cells: list[str]) -> None:
    text = csv_bytes([["a", "b"], *[["x", cell] for cell in cells]]).decode("utf-8", "surrogateescape")
    expected = [cell.encode("utf-8", "backslashreplace").decode() for cell in cells]
    assert [row["b"] for row in read_csv(io.StringIO(text, newline=""))] == expected


@pytest.mark.parametrize("cell", CELLS)
def test_that_a_spreadsheet_shows_names_as_text(cell: str) -> None:
    ((written,),) = csv.reader(io.StringIO(csv_bytes([[cell]]).decode(), newline=""))
    number = cell in ("-5", "+.5e3", "-inf")
    assert number or not written.startswith(("=", "+", "-", "@", "\t", "\r", "\n"))
    assert written == cell if number or cell == "'x" else written == f"'{cell}"


@pytest.mark.parametrize("separator", [";", ",", "\t"])
@pytest.mark.parametrize("cell", ["x;=1+1", "x,=1+1", "x\t=1+1", "x;'@a,+b", "x\n=1+1", "a;;-b\r\n=c"])
def test_that_no_formula_begins_behind_another_separator(cell: str, separator: str) -> None:
    text = csv_bytes([["a", "b"], ["x", cell]]).decode()
    for row in csv.reader(io.StringIO(text, newline=""), delimiter=separator, quoting=csv.QUOTE_NONE):
        assert not [part for part in row if part[:1] in ("=", "+", "-", "@")]
    assert [row["b"] for row in read_csv(io.StringIO(text, newline=""))] == [cell]


def _write_a_mesh(folder: Path) -> None:
    with staged_folder(folder, "run") as stage:
        (stage / "meshes").mkdir()
        write_in_stage(stage, "meshes/a.stl", b"x")


def test_that_links_to_the_folder_itself_are_no_way_out(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert path_inside(tmp_path / "link", "a/b.stl") == tmp_path / "link" / "a/b.stl"
