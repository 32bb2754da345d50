"""Rows of particles: Qt's own examiner of models finds nothing, whatever is sorted, filtered or learned."""

import random

import pytest
from PySide6.QtCore import QItemSelectionModel, Qt
from PySide6.QtTest import QAbstractItemModelTester

from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.particle import Particle, ScanOfGrain
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.grain_errors import intervals
from regolith_studio.session.results import ParticleEntry
from regolith_studio.ui.widgets.labels import short_number
from regolith_studio.ui.widgets.table import (
    PADDING,
    RIGHT,
    UNSORTED,
    ParticleColumn,
    ParticleTable,
    ParticleTableModel,
    particle_columns,
)

FALLING = Qt.SortOrder.DescendingOrder
MESH = icosphere(1)


COLUMNS = (
    ParticleColumn("name", "", "", lambda entry: entry.id, lambda entry: entry.id),
    *(
        ParticleColumn(key, "", "", value, lambda entry, value=value: str(value(entry)))
        for key, value in (
            ("group", lambda entry: entry.particle.group),
            ("volume", lambda entry: entry.descriptors.get("volume", 0.0)),
        )
    ),
)


def entries(groups, **volumes):
    return tuple(
        ParticleEntry(name, Particle(name, MESH, group=group), None, {"volume": volumes.get(name, 1.0)})
        for name, group in zip("edcba", groups, strict=True)
    )


@pytest.fixture
def rows(app):
    made = ParticleTableModel(COLUMNS, app)
    examiner = QAbstractItemModelTester(made, QAbstractItemModelTester.FailureReportingMode.Fatal)
    made.set_entries(entries("xyxyx"))
    yield made
    examiner.deleteLater()
    made.deleteLater()


def listed(rows):
    return "".join(rows.index(row, 0).data() for row in range(rows.rowCount()))


def test_that_equal_rows_stay_as_they_were_given_in_both_orders(rows):
    rows.sort(1)
    assert listed(rows) == "ecadb"
    rows.sort(1, FALLING)
    assert listed(rows) == "dbeca"
    rows.sort(UNSORTED)
    assert listed(rows) == "edcba"


def test_that_numbered_names_are_sorted_by_their_numbers(rows):
    names = ("rock11", "rock3", "rock1")
    rows.set_entries(tuple(ParticleEntry(name, Particle(name, MESH), None, {}) for name in names))
    rows.sort(0)
    assert listed(rows) == "rock1rock3rock11"


def test_that_what_is_chosen_stays_chosen_when_rows_move(rows):
    chosen = QItemSelectionModel(rows)
    chosen.select(rows.index(0, 0), QItemSelectionModel.SelectionFlag.Select)
    rows.sort(0)
    assert [index.data() for index in chosen.selectedIndexes()] == ["e"]
    assert chosen.selectedIndexes()[0].row() == 4
    rows.sort(2, FALLING)
    rows.set_entries(entries("xyxyx", e=2.0, b=3.0))
    assert listed(rows) == "bedca"
    assert [index.data() for index in chosen.selectedIndexes()] == ["e"]


def test_that_a_filter_follows_what_becomes_known(rows):
    rows.set_filter(lambda entry: entry.descriptors["volume"] > 1.0)
    assert listed(rows) == ""
    rows.set_entries(entries("xyxyx", c=2.0, a=3.0))
    assert listed(rows) == "ca"
    rows.set_filter(None)
    assert listed(rows) == "edcba"


def test_that_a_thousand_changes_leave_a_sound_model(rows):
    draw = random.Random(1)
    for _ in range(1000):
        match draw.randrange(3):
            case 0:
                rows.sort(draw.randrange(-1, 3), draw.choice(list(Qt.SortOrder)))
            case 1:
                least = draw.random()
                rows.set_filter(lambda entry, least=least: entry.descriptors["volume"] > least)
            case 2:
                volumes = {name: draw.random() for name in "abcde"}
                rows.set_entries(entries("xyxyx", **volumes)[: draw.randrange(6)])
        assert set(listed(rows)) <= {entry.id for entry in rows.entries}


def test_that_numbers_that_are_not_known_yet_stand_below_all_others(app):
    made = ParticleTableModel(particle_columns("name", "volume"), app)
    unknown = ParticleEntry("u", Particle("u", MESH), None, {})
    made.set_entries((unknown, *entries("xyxyx", e=2.0)))
    made.sort(1)
    assert listed(made) == "udcbae"
    assert made.index(0, 1).data() == "…"
    assert made.index(0, 1).data(Qt.ItemDataRole.TextAlignmentRole) == RIGHT
    made.deleteLater()


def test_that_the_tool_tip_of_a_number_states_the_interval_of_a_grain_of_a_scan(app):
    scan = ScanOfGrain(18.0, 0.1, follows_grey=True)
    facts = describe(MESH)
    low, high = map(short_number, intervals(facts, scan)["volume"])
    made = ParticleTableModel(particle_columns("name", "volume", "aspect_ratio"), app)
    grain = ParticleEntry("a", Particle("a", MESH, scan=scan), None, facts)
    made.set_entries([grain, ParticleEntry("b", Particle("b", MESH), None, facts)])
    role = Qt.ItemDataRole.ToolTipRole
    of_scan, of_mesh = ([made.index(row, column).data(role) for column in (1, 2)] for row in (0, 1))
    value, ratio = (short_number(facts[key]) for key in ("volume", "aspect_ratio"))
    assert of_scan == [f"{value}; {low} to {high} in 90 % of grains of this size and noise", ratio]
    assert of_mesh == [value, ratio]
    made.deleteLater()


@pytest.mark.parametrize("width", [140, 260, 700])
def test_that_names_take_the_room_that_is_left_and_numbers_stand_apart(shown, width):
    table = ParticleTable(particle_columns("name", "volume", "sphericity", "aspect_ratio"), scrolls=False)
    table.set_entries([ParticleEntry(name, Particle(name, MESH), None, describe(MESH)) for name in "ab"])
    table.resize(width, 200)
    shown(table)
    listed = [number for number in range(4) if not table.isColumnHidden(number)]
    assert sum(map(table.columnWidth, listed)) == table.viewport().width()
    assert all(table.columnWidth(n) >= table.sizeHintForColumn(n) + PADDING for n in listed[1:])
