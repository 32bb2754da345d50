"""The table of errors: percentages, and below them the ends of their intervals."""

import pytest
from PySide6.QtCore import QRect, Qt

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


@pytest.mark.parametrize("width", [250, 420, 900])
@pytest.mark.parametrize("points", [9.0, 18.0])
def test_that_a_narrow_table_is_scrolled_and_cuts_neither_names_nor_numbers(shown, width, points):
    table = HeatTable("nothing yet")
    font = table.font()
    font.setPointSizeF(points)
    table.setFont(font)
    columns = ["V", "S", "Dmin", "Dmax", "AR", "CH", "Jaccard"]
    bands = ([[0.034] * 7], [[0.052] * 7])
    table.set_values(["All descriptors and overlap"], columns, [[0.0204] * 7], bands)
    table.resize(width, 200)
    shown(table)
    head = table.table.horizontalHeader()
    for at, name in enumerate(columns):
        assert head.sectionSize(at) > head.fontMetrics().horizontalAdvance(name)
        assert head.sectionSize(at) >= table.table.sizeHintForColumn(at), "the interval is elided"
    assert head.length() >= table.table.viewport().width() - 7  # of which none is left empty


@pytest.mark.parametrize("width", [420, 590])
@pytest.mark.parametrize("points", [9.0, 18.0])
def test_that_the_names_of_rows_are_wrapped_and_not_cut(shown, width, points):
    table = HeatTable("nothing yet")
    font = table.font()
    font.setPointSizeF(points)
    table.setFont(font)
    name = "Volume, surface area, aspect ratio"
    table.set_values(["all", name], ["V", "S", "Dmin", "Dmax", "AR", "CH", "J"], [[0.0204] * 7] * 2)
    table.resize(width, 300)
    shown(table)
    rows = table.table.verticalHeader()
    wrapped = Qt.TextFlag.TextWordWrap
    needed = rows.fontMetrics().boundingRect(QRect(0, 0, rows.width() - 8, 1000), wrapped, name)
    assert needed.height() <= table.table.rowHeight(1)
    assert needed.width() <= rows.width()
    assert rows.defaultAlignment() & wrapped
    assert rows.textElideMode() == Qt.TextElideMode.ElideNone
