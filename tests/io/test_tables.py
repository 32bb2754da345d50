"""Tables and progress: what is written can be read back by csv and json."""

import csv
import json

import numpy as np
import pytest

from regolith_studio.io.tables import Column, Table, csv_text, rows_as_text, write_table
from regolith_studio.studies import StudyProgress


@pytest.fixture
def table() -> Table:
    rows = (("cement, no. 1", np.int64(20), np.float64(0.125)), ("snow", 12, float("nan")))
    return Table("Errors", (Column("group"), Column("n_facets"), Column("error", "%")), rows, ("A note.",))


def test_that_the_csv_module_reads_the_cells_back(table, tmp_path):
    path, _ = write_table(table, tmp_path / "new", "errors")
    with path.open(newline="") as lines:
        assert list(csv.reader(lines)) == [
            ["group", "n_facets", "error [%]"],
            ["cement, no. 1", "20", "0.125"],
            ["snow", "12", ""],
        ]


def test_that_json_holds_units_and_writes_missing_values_as_null(table, tmp_path):
    _, path = write_table(table, tmp_path, "errors")
    document = json.loads(path.read_text())
    assert document["columns"][2] == {"name": "error", "unit": "%"}
    assert document["rows"][1] == {"group": "snow", "n_facets": 12, "error": None}
    assert document["notes"] == ["A note."]


def test_that_a_column_is_found_by_its_name(table):
    assert table.column("n_facets") == (20, 12)
    with pytest.raises(KeyError):
        table.column("mass")


def test_that_numbers_are_printed_short(table):
    assert rows_as_text(table)[1] == ["cement, no. 1", "20", "0.125"]


def test_that_only_very_large_numbers_have_an_exponent():
    numbers = Table("volumes", (Column("a"), Column("b"), Column("c")), ((26_994.4, -1.5e4, 2.5e9),))
    assert rows_as_text(numbers, digits=4)[1] == ["26990", "-15000", "2.5e+09"]


@pytest.mark.parametrize(
    ("columns", "rows"),
    [("aa", ()), ("ab", ((1,),)), ("a", (([1],),))],
)
def test_that_a_table_checks_itself(columns, rows):
    with pytest.raises(ValueError, match=r"must|holds"):
        Table("", tuple(Column(name) for name in columns), rows)


def test_that_progress_counts_up_to_its_total():
    assert StudyProgress(1, 4).share == 0.25
    assert StudyProgress(0, 0).share == 1.0
    with pytest.raises(ValueError, match="between"):
        StudyProgress(5, 4)


def test_that_a_table_for_the_clipboard_keeps_the_commas_within_its_cells():
    table = Table("Particles", (Column("name"), Column("volume", "um^3")), (("a, b", 1.5), ("c\td", 2.0)))
    rows = list(csv.reader(csv_text(table, "\t").splitlines(), delimiter="\t"))
    assert rows == [["name", "volume [um^3]"], ["a, b", "1.5"], ["c\td", "2.0"]]
    assert '"a, b"' not in csv_text(table, "\t")
