"""Tables of length, width and thickness: columns by name, units, and what is refused."""

import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.shape_tables import read_shape_table


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("Particle,Length (um),Width (um),Thickness (um)\np1,30,20,10\np2,60,20,5\n", "mm"),
        ("thickness [mm];id;width [mm];LENGTH [mm]\n0,01;a;0,02;0,03\n0,005;b;0,02;0,06\n", "um"),
        ("L\tW\tT\tnote\n0.03\t0.02\t0.01\tgood, whole\n0.06\t0.02\t0.005\t\n", "mm"),
    ],
)
def test_that_columns_are_found_by_their_names_and_units(tmp_path, text, unit):
    path = tmp_path / "75m.csv"
    path.write_text(text)
    table = read_shape_table(path, unit)
    expected = {
        "max_feret_diameter": [30, 60],
        "width": [20, 20],
        "thickness": [10, 5],
        "width_over_length": [2 / 3, 1 / 3],
        "thickness_over_width": [1 / 2, 1 / 4],
        "volume": [np.pi / 6 * 6000, np.pi / 6 * 6000],
    }
    assert table.name == "75m"
    assert set(table.columns) == set(expected)
    for key, values in expected.items():
        assert table.columns[key] == pytest.approx(values)


def test_that_rows_without_numbers_are_left_out_with_a_note(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("volume [um^3],equivalent_radius [um],group\n8,2,a\n,,b\n-1,1,c\n")
    table = read_shape_table(path)
    assert table.columns["volume"] == pytest.approx([8])
    assert table.notes == ("Left out 2 rows without positive numbers in volume, equivalent_radius.",)


@pytest.mark.parametrize(
    ("header", "row", "reason"),
    [
        ("Length (furlong),Width,Thickness", "3,2,1", "“Length (furlong)” names no known unit of length"),
        ("L (um),L (mm),W,T", "3,9,2,1", "Left out the column “L (mm)”: an earlier one has max_feret"),
        ("Length,Width,Thickness", "1,2,3", "In 1 row the width exceeds the length, or the thickness"),
    ],
)
def test_that_columns_that_may_mean_something_else_are_noted(tmp_path, header, row, reason):
    path = tmp_path / "table.csv"
    path.write_text(f"{header}\n{row}\n")
    (note,) = read_shape_table(path).notes
    assert reason in note


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "is empty"),
        (b"name,mass\na,1\n", "has no column of length, width and thickness; its columns are name, mass."),
        (b"Length,Width\na,b\n", "has no row with positive numbers in max_feret_diameter, width"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\0", "table.csv"),
    ],
)
def test_that_another_table_is_one_sentence(tmp_path, content, reason):
    path = tmp_path / "table.csv"
    path.write_bytes(content)
    with pytest.raises(FileError, match=reason):
        read_shape_table(path)
