"""Numbers in narrow tables, and the table of descriptors that shows them."""

from types import SimpleNamespace

import pytest
from PySide6.QtTest import QTest

from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.messages import Message, Number
from regolith_studio.ui.pages.explore.plots import DescriptorTablePanel
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.fields import DecimalField, NumbersLine
from regolith_studio.ui.widgets.labels import grouped_number, short_number


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        *((1.0474e6, 3, "1.05e6"), (1.0474e6, 4, "1.047e6"), (-2.5e-7, 2, "-2.5e-7"), (0.77, 3, "0.770")),
        *(
            (63.0, 4, "63.00"),
            (6087.2, 4, "6087"),
            (1.0, 3, "1.00"),
            (0.0, 3, "0.00"),
            (99999.0, 4, "1.000e5"),
        ),
    ],
)
def test_that_a_number_keeps_its_digits_and_loses_idle_signs(value, digits, text):
    assert short_number(value, digits) == text
    assert float(text) == pytest.approx(value, rel=0.5 * 10.0 ** (1 - digits))


@pytest.mark.parametrize(
    ("value", "text"),
    [(9382.4, "9,382"), (12260.0, "12,260"), (1234567.0, "1,235,000"), (12.3, "12.30"), (3.0e8, "3.000e8")],
)
def test_that_numbers_of_one_legend_are_written_alike(value, text):
    assert grouped_number(value) == text


@pytest.mark.usefixtures("app")
def test_that_a_german_window_writes_commas_and_only_numbers_change(speaking):
    speaking("de")
    assert (short_number(1.0474e6, 3), short_number(63.0, 4), grouped_number(12260.0)) == (
        "1,05e6",
        "63,00",
        "12.260",
    )
    found = Message(
        "{name}: {error}, {count}", name="12.5", error=Number(0.76, ".2f", " %"), count=Number(2918, ",")
    )
    assert translate(found) == "12.5: 0,76\N{NO-BREAK SPACE}%, 2.918"
    assert str(found) == "12.5: 0.76 %, 2,918"
    assert tr("at most {reach:.3g} in {name}", reach=0.25, name="a.b") == "at most 0,25 in a.b"


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize(("typed", "value"), [("0.5", 0.5), ("0,5", 0.5), ("12,25", 12.25), ("1250", 1250.0)])
def test_that_point_and_comma_are_typed_for_the_decimal_sign(language, typed, value, speaking, shown):
    speaking(language)
    field = shown(DecimalField())
    field.setRange(0.0, 1e6)
    field.setDecimals(3)
    field.selectAll()
    QTest.keyClicks(field, typed)
    field.interpretText()
    assert field.value() == value


@pytest.mark.parametrize(
    ("language", "typed", "value"),
    [
        ("en", "0.2, 0.4", "0.2, 0.4"),
        ("en", "8,12,30", "8,12,30"),
        ("de", "0,2; 0,4", "0.2, 0.4"),
        ("de", "0,2, 0,4", "0.2, 0.4"),
        ("de", "0.2, 0.4", "0.2, 0.4"),
        ("de", "25=85,5;37=12,6", "25=85.5, 37=12.6"),
    ],
)
def test_that_a_list_of_numbers_is_read_in_either_notation(language, typed, value, speaking, shown):
    speaking(language)
    line = shown(NumbersLine("0.3, 0.8"))
    assert line.text() == {"en": "0.3, 0.8", "de": "0,3; 0,8"}[language]
    assert line.value() == "0.3, 0.8"
    line.setText(typed)
    assert line.value() == value


def cut_texts(table):
    """Heads and cells that are wider than their columns."""
    letters, found = table.fontMetrics(), []
    for column in range(table.columnCount()):
        room = table.columnWidth(column)
        cells = [table.item(row, column) for row in range(table.rowCount())]
        words = [each.text() for each in (table.horizontalHeaderItem(column), *cells) if each is not None]
        found += [word for word in words if letters.horizontalAdvance(word) + 4 > room]
    return found


@pytest.mark.usefixtures("app")
@pytest.mark.parametrize("width", [268, 360, 495, 700])
def test_that_the_table_of_descriptors_shows_every_number_whole(width, shown, wait):
    values = describe(icosphere(2).moved(scale=63.0))
    panel = shown(DescriptorTablePanel())
    panel.resize(width, 300)
    wait(lambda: panel.width() == width)
    solid = SimpleNamespace(achieved=values)
    panel.show_results(SimpleNamespace(particle_descriptors=values, fit_descriptors=values, best=solid))
    wait(lambda: panel.table.viewport().width() < width)
    assert cut_texts(panel.table) == []
    assert panel.table.item(0, 2).text().startswith("1.0")
    assert panel.table.horizontalHeaderItem(2).toolTip() == "Polyhedron"
