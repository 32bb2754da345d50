"""The report on a particle's mesh: what it was like, what was done, and what is coloured."""

from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.repair import repair
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.particle_jobs import find_faults, measure_particle
from regolith_studio.scene.overlays import FAULT_COLOURS, show_faults
from regolith_studio.session.results import ParticleEntry
from regolith_studio.steps import result_of
from regolith_studio.ui.pages.sample.page import KINDS, HealthPanel

BALL = icosphere(2)
SMALL = BALL.moved(shift=(5, 0, 0), scale=0.5)


def entry(mesh, mended=True):
    done = repair(mesh) if mended else None
    notes = done.health_before.problems + done.actions if done else ()
    particle = Particle("one", done.mesh if done else mesh, notes=notes, repair=done)
    known = measure_particle(particle)
    return ParticleEntry("one", particle, known.health, known.descriptors, visibility=known.visibility)


def ugly():
    """A ball inside out that lacks a triangle, with a smaller one beside it."""
    faces = np.concatenate([BALL.faces[1:, ::-1], SMALL.faces + len(BALL.vertices)])
    return Mesh(np.concatenate([BALL.vertices, SMALL.vertices]), faces)


def cells(panel):
    table = panel.table
    texts = [[table.item(row, column).text() for column in range(3)] for row in range(table.rowCount())]
    return {name: (before, now) for name, before, now in texts}


@pytest.fixture
def panel(shown):
    return shown(HealthPanel())


def test_that_the_report_tells_the_mesh_as_it_came_and_as_it_is(panel):
    panel.show_entry(entry(ugly()))
    found = cells(panel)
    assert found["Connected parts"] == ("2", "1")
    assert found["Closed"] == ("no", "yes")
    assert found["Open edges"] == ("3", "0")
    assert found["Euler number"] == ("3", "2")
    assert found["V [µm³]"][0].startswith("-")
    area = BALL.face_areas[0]
    assert found["Filled [µm²]"][1].startswith(f"{area:.2g}"[:4])
    assert found["Left out"][1] == "11\N{NO-BREAK SPACE}%"  # a ball of half the size: 1 of 9 parts
    assert found["Hidden surface"] == ("", "0 %")
    assert "Filled 1 hole" in panel.words.text()
    assert "point inwards" in panel.words.text()


def test_that_a_mesh_left_as_it_is_has_the_same_in_both_columns_and_no_inside(panel):
    panel.show_entry(entry(Mesh(BALL.vertices, BALL.faces[1:]), mended=False))
    found = cells(panel)
    assert found["Closed"] == ("no", "no")
    assert found["Hidden surface"] == ("", "–")
    assert "It is not closed" in panel.words.text()


def test_that_nothing_is_reported_before_it_is_measured(panel):
    panel.show_entry(replace(entry(BALL), health=None))
    assert cells(panel) == {}
    panel.show_entry(None)
    assert panel.words.text() == ""


def test_that_the_legend_names_what_was_found_with_its_number(panel):
    ours = entry(ugly())
    found = result_of(find_faults(ours.particle, ours.visibility))
    panel.show_legend({kind: len(triangles) for kind, triangles in found.items()})
    words = panel.legend.text().replace("&nbsp;", " ")
    assert "closed holes (1)" in words
    assert "Before the repair" not in words  # of no particle
    panel.show_entry(ours)
    panel.show_legend({kind: len(triangles) for kind, triangles in found.items()})
    assert panel.legend.text().startswith("Before the repair")
    panel.show_entry(entry(BALL, mended=False))
    panel.show_legend({"hidden": 3})
    assert "Before the repair" not in panel.legend.text()
    assert f"parts left out ({len(SMALL.faces)})" in words
    panel.show_legend({})
    assert panel.legend.text() == "Nothing to show in the view."


def test_that_the_box_asks_for_the_picture_without_faults(panel):
    asked = []
    panel.showChanged.connect(asked.append)
    QTest.keyClick(panel.where, Qt.Key.Key_Space)
    assert asked == [False]


def test_that_every_kind_of_fault_has_a_name_and_a_colour():
    assert set(KINDS) == set(FAULT_COLOURS)


def test_that_faults_are_drawn_and_vanish_again():
    plotter = pv.Plotter(off_screen=True)
    show_faults(plotter, {"open": BALL.triangles[:3], "filled": BALL.triangles[:0]})
    assert plotter.actors["fault open"].mapper.dataset.n_cells == 3
    assert "fault filled" not in plotter.actors
    show_faults(plotter, {})
    assert not plotter.actors["fault open"].GetVisibility()
    plotter.close()
