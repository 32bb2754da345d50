"""Numbers in narrow tables, and the table of descriptors that shows them."""

from types import SimpleNamespace

import pytest

from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.ui.panels.descriptor_table import DescriptorTablePanel
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
    panel.show_results(SimpleNamespace(particle_descriptors=values, fit_descriptors=values, coarsened=solid))
    wait(lambda: panel.table.viewport().width() < width)
    assert cut_texts(panel.table) == []
    assert panel.table.item(0, 2).text().startswith("1.0")
    assert panel.table.horizontalHeaderItem(2).toolTip() == "Polyhedron"
