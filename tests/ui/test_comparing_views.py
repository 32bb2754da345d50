"""Wipe, overlay, section and facets as a user meets them: by command, by mouse, in the drawing."""

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from regolith_studio.geometry.cross_section import cross_section
from regolith_studio.scene import clipping, facets
from regolith_studio.scene.cameras import Projection
from regolith_studio.scene.comparison import OTHER
from regolith_studio.scene.surfaces import SURFACE
from regolith_studio.ui.widgets.labels import grouped_number


def actor(window, view, name):
    found = window.page.three_views.views[view]._plotter.actors.get(name)
    return found if found is not None and found.GetVisibility() else None


def switch(window, name):
    window.menus.by_name[f"explore.{name}"].trigger()


def pull(widget, start, end):
    QTest.mousePress(widget, Qt.MouseButton.LeftButton, pos=QPoint(*start))
    QTest.mouseMove(widget, QPoint(*end))
    QTest.mouseRelease(widget, Qt.MouseButton.LeftButton, pos=QPoint(*end))


def hover(widget, x, y):
    """As the mouse does that rests; where the real one is does not matter."""
    none = Qt.MouseButton.NoButton
    here = QPointF(x, y)
    event = QMouseEvent(
        QEvent.Type.MouseMove, here, widget.mapToGlobal(here), none, none, Qt.KeyboardModifier.NoModifier
    )
    QApplication.sendEvent(widget, event)


def test_that_any_two_bodies_are_wiped_along_one_line_that_is_dragged(window):
    views = window.page.three_views
    switch(window, "wipe")
    pose = views.views["fit"].pose
    for name, frame in views.frames.items():
        others = [key for key in ("particle", "fit", "polyhedron") if key != name]
        for other in others:
            frame.partner.setCurrentIndex(frame.partner.findData(other))
            shape = views._shapes[other].mesh
            drawn = actor(window, name, OTHER + SURFACE).mapper.dataset.points
            assert np.allclose(np.ptp(drawn, axis=0), np.ptp(shape.vertices, axis=0), rtol=1e-4)
    widget = views.views["fit"].widget
    middle = widget.width() // 2
    pull(widget, (middle, 40), (middle - 60, 50))
    shares = [divider.share for divider in views.comparison.dividers.values()]
    assert shares == [pytest.approx(0.5 - 60 / widget.width(), abs=0.01)] * 3
    assert views.views["fit"].pose == pose  # the line moved, not the camera
    pull(widget, (middle - 60, 40), (-500, 40))
    assert views.comparison.dividers["fit"].share == pytest.approx(0.02)
    switch(window, "wipe")
    assert actor(window, "fit", OTHER + SURFACE) is None
    assert views.frames["fit"].partner.isHidden()


def test_that_the_section_draws_and_measures_what_the_plane_cuts(window):
    views, panel = window.page.three_views, window.page.plots.section
    switch(window, "section")
    assert window.page.plots.left.currentWidget() is panel
    panel.direction.setCurrentIndex(panel.direction.findData("z"))
    panel.place.field.setValue(5.0)
    plane = views.sections.plane
    mesh = window.session.selected.particle.mesh
    middle = mesh.bounds[:, 2].mean()
    assert plane.normal == (0.0, 0.0, 1.0)  # the eye is above: the upper half is taken away
    assert plane.offset == pytest.approx(middle + 5.0, abs=0.05)
    labels = [curve.label for curve in panel.plot.curves]
    area = cross_section(mesh, (0, 0, 1), plane.offset).area
    assert labels[0] == f"Particle {grouped_number(area)} µm²"
    assert [label.split()[0] for label in labels] == ["Particle", "Fit", "Polyhedron"]
    for name in ("particle", "fit", "polyhedron"):
        assert actor(window, name, clipping.CAP) is not None
        assert actor(window, name, clipping.CUT + "polyhedron") is not None
    switch(window, "section")
    assert actor(window, "fit", clipping.CAP) is None
    assert panel.plot.is_empty()
    assert window.page.plots.left.currentIndex() == 0, "what was in front before is in front again"


@pytest.mark.slow
def test_that_the_place_of_the_section_can_be_read_in_a_narrow_panel(window):
    field = window.page.plots.section.place.field
    line = field.lineEdit()
    room = line.width() - line.textMargins().left() - line.textMargins().right()
    assert line.fontMetrics().horizontalAdvance("-100.0 µm") <= room
    switch(window, "section")
    assert window.page.plots.section.width() < 450
    assert window.page.plots.section.rect().contains(
        field.mapTo(window.page.plots.section, field.rect().bottomRight())
    )


@pytest.mark.slow
def test_that_the_frame_of_the_section_is_dragged_in_a_view(window):
    views = window.page.three_views
    switch(window, "section")
    views.sections.set_direction("z", np.array([0.0, 0.0, 1.0]))
    view = views.views["particle"]
    sight = Projection(view.pose, view.widget.width(), view.widget.height())
    corners = sight.seen(views.sections.framed[1])
    edges = (corners + np.roll(corners, -1, axis=0)) / 2
    inside = [(x, y) for x, y in edges if 12 < x < sight.width - 12 and 12 < y < sight.height - 12]
    x, y = (round(float(each)) for each in inside[0])
    before, pose = views.sections.position, view.pose
    pull(view.widget, (x, y), (x, y - 10))
    steepness = np.linalg.norm(sight.seen([np.zeros(3), [0.0, 0.0, 1.0]])[0] - sight.seen([[0, 0, 1.0]])[0])
    assert views.sections.position - before == pytest.approx(10 / steepness, rel=0.15)
    assert window.page.plots.section.place.value() == pytest.approx(views.sections.position, abs=0.06)
    assert view.pose == pose
    pull(view.widget, (3, 3), (40, 30))
    assert view.pose != pose


def test_that_the_facet_under_the_mouse_is_outlined_numbered_and_told(window):
    views = window.page.three_views
    widget = views.views["polyhedron"].widget
    hover(widget, widget.width() // 2, widget.height() // 2)
    solid = window.session.results.coarsened.polyhedron
    number = int(actor(window, "polyhedron", facets.NUMBER).GetInput())
    facet = facets.facet_of(solid, number - 1)
    words = views.frames["polyhedron"].detail.text()
    assert words.startswith(
        f"facet {number} of 20: {facet.area:,.4g} µm² ({100 * facet.share:.1f}\xa0%), normal"
    )
    assert window.statusBar().currentMessage() == words
    towards = -Projection(views.views["polyhedron"].pose, 1, 1).axes[2]
    assert solid.half_spaces.normals[number - 1] @ towards > 0.0
    hover(widget, 2, 2)
    assert actor(window, "polyhedron", facets.FACET) is None
    assert "vertices" in views.frames["polyhedron"].detail.text()
    assert window.statusBar().currentMessage() == ""


@pytest.mark.slow
def test_that_the_facet_under_the_mouse_of_a_compound_is_told_with_its_part(window, settled):
    window.session.choose(method="compound", n_facets=40)
    settled(window)
    views = window.page.three_views
    solid = window.session.results.coarsened.polyhedron
    assert views.frames["polyhedron"].title.startswith(f"Compound, {solid.n_parts} parts, ")
    widget = views.views["polyhedron"].widget
    hover(widget, widget.width() // 2, widget.height() // 2)
    number = int(actor(window, "polyhedron", facets.NUMBER).GetInput())
    part = solid.facet_parts[number - 1] + 1
    area = solid.exposed_areas[number - 1]
    words = window.statusBar().currentMessage()
    assert words.startswith(f"part {part}, facet {number} of {solid.n_facets}: {area:,.4g} µm² exposed")
    towards = -Projection(views.views["polyhedron"].pose, 1, 1).axes[2]
    assert solid.facet_normals[number - 1] @ towards > 0.0


@pytest.mark.slow
def test_that_one_view_after_the_other_gets_all_the_room(window):
    frames = window.page.three_views.frames
    for seen in (["particle"], ["fit"], ["polyhedron"], ["particle", "fit", "polyhedron"]):
        switch(window, "enlarge")
        assert [name for name, frame in frames.items() if not frame.isHidden()] == seen
    title = QPoint(40, 12)
    QTest.mouseDClick(frames["fit"], Qt.MouseButton.LeftButton, pos=title)
    assert [name for name, frame in frames.items() if not frame.isHidden()] == ["fit"]
    QTest.mouseDClick(frames["fit"], Qt.MouseButton.LeftButton, pos=title)
    assert not any(frame.isHidden() for frame in frames.values())


@pytest.mark.slow
def test_that_the_picture_of_what_is_seen_has_bar_line_and_titles_at_any_scale(window):
    views = window.page.three_views
    switch(window, "wipe")
    one, two = views.snapshot(1, False), views.snapshot(2, False)
    assert (two.width(), two.height()) == (2 * one.width(), 2 * one.height())
    assert all(divider.shown for divider in list(views.comparison.dividers.values())[1:])
    first = views.views["particle"]
    left, width = first.widget.width() + 8, views.views["fit"].widget.width()
    line = one.pixelColor(left + width // 2, one.height() - 40)
    assert line.lightness() < 90
    bare = views.snapshot(1, True)
    assert bare.pixelColor(5, bare.height() // 2).alpha() == 0
    inked = [bare.pixelColor(x, y).alpha() for x in range(4, 120) for y in range(4, 22)]
    assert max(inked) == 255  # the title
