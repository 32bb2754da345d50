"""The table of errors: percentages, and below them the ends of their intervals."""

import pytest

from regolith_studio.ui.widgets.heat_table import HeatTable

pytestmark = pytest.mark.usefixtures("app")


def texts(table: HeatTable) -> list[list[str]]:
    inner = table.table
    return [[inner.item(r, c).text() for c in range(inner.columnCount())] for r in range(inner.rowCount())]


def test_that_shares_are_shown_in_per_cent_with_the_ends_of_their_intervals():
    table = HeatTable("nothing yet")
    bands = ([[0.01, 0.0]], [[0.131, 0.00001]])
    table.set_values(["all"], ["V", "S"], [[0.0204, 0.0]], bands)
    assert texts(table) == [["2.0\n1.0–13", "0"]]


def test_that_rows_with_intervals_are_a_line_higher_and_become_low_again():
    table = HeatTable("nothing yet")
    table.set_values(["all"], ["V"], [[0.02]])
    low = table.table.rowHeight(0)
    table.set_values(["all"], ["V"], [[0.02]], ([[0.01]], [[0.03]]))
    assert table.table.rowHeight(0) == low + table.table.fontMetrics().height()
    table.set_values(["all"], ["V"], [[0.02]])
    assert (table.table.rowHeight(0), texts(table)) == (low, [["2.0"]])
