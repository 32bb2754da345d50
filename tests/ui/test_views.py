"""Both backends keep the same promise; the live one only where there is a display."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QGuiApplication, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.scene import instancing, surfaces
from regolith_studio.scene.cameras import CameraPose, framing_pose
from regolith_studio.scene.palette import DARK
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink

BALL = icosphere(3).moved(scale=20.0)
EGG = BALL.moved(rotation=np.diag([1.0, 0.5, 1.6]))


@pytest.fixture(params=["image", pytest.param("live", marks=pytest.mark.window)])
def kind(request, app):  # noqa: ARG001
    if request.param == "live" and QGuiApplication.platformName() == "offscreen":
        pytest.skip("a live view needs a display")
    return request.param


@pytest.fixture
def make(kind, shown):
    made = []

    def view():
        made.append(make_view(kind))
        made[-1].widget.resize(200, 160)
        return shown_view(made[-1])

    def shown_view(each):
        shown(each.widget)
        return each

    yield view
    for each in made:
        each.release()
    made.clear()


def drag(view, start, end, button=Qt.MouseButton.LeftButton):
    target = view.widget.childAt(*start) or view.widget
    QTest.mousePress(target, button, pos=QPoint(*start))
    QTest.mouseMove(target, QPoint(*end))
    QApplication.processEvents()
    QTest.mouseRelease(target, button, pos=QPoint(*end))


def differs(one, other):
    return float(np.abs(one.astype(int) - other.astype(int)).mean())


def alike(one, other):
    """VTK normalises view-up when it is set: the last digit may differ."""
    return np.allclose(np.hstack(list(vars(one).values())), np.hstack(list(vars(other).values())), rtol=1e-12)


def test_that_a_view_shows_what_is_drawn_and_forgets_what_is_cleared(make):
    view = make()
    empty = view.picture()
    view.draw(lambda plotter: surfaces.show_particle(plotter, BALL))
    view.set_pose(framing_pose(BALL.vertices))
    full = view.picture()
    assert full.shape == (160, 200, 3)
    assert differs(empty, full) > 5
    view.draw(lambda plotter: surfaces.show_fit(plotter, EGG))
    assert differs(full, view.picture()) > 5
    view.draw(surfaces.clear)
    assert differs(empty, view.picture()) < 1


def test_that_a_heap_is_drawn_coarsely_while_it_turns_and_as_before_when_it_rests(make):
    view, shapes = make(), [[BALL.vertices / 20.0 / (4 * np.pi / 3) ** (1 / 3)]]
    places = 30e-6 * np.stack(np.meshgrid(*[np.arange(3.0)] * 3), axis=-1).reshape(-1, 3)
    turns, kinds = np.tile([1.0, 0, 0, 0], (27, 1)), np.zeros(27, dtype=int)
    heap = ParticleState(places, np.full(27, 30e-6), turns, kinds)
    view.set_pose(framing_pose(1e6 * places))
    pictures = []
    for coarse in (False, True, False):
        view.draw(partial(instancing.show_heap, shapes=shapes, pile=heap, coarse=coarse))
        pictures.append(view.picture())
    assert differs(pictures[0], pictures[1]) > 5
    assert differs(pictures[0], pictures[2]) == 0


def test_that_a_hidden_view_holds_no_graphics_memory_and_shows_the_same_picture_again(make, kind):
    view = make()
    view.draw(lambda plotter: surfaces.show_particle(plotter, BALL))
    view.set_pose(framing_pose(BALL.vertices))
    before = view.picture()
    view.widget.hide()
    if kind == "live":
        assert not view._plotter.render_window.GetInitialized()
    view.draw(lambda plotter: surfaces.show_fit(plotter, EGG))
    view.widget.show()
    assert differs(before, view.picture()) > 5
    view.draw(lambda plotter: surfaces.show_particle(plotter, BALL))
    assert differs(before, view.picture()) == 0


def test_that_dragging_turns_the_camera_and_tells_it(make):
    view, heard = make(), []
    view.draw(lambda plotter: surfaces.show_particle(plotter, EGG))
    view.set_pose(framing_pose(EGG.vertices, "front"))
    view.when_moved(heard.append)
    before, picture = view.pose, view.picture()
    drag(view, (100, 80), (150, 80))
    assert heard
    assert heard[-1] == view.pose != before
    assert view.pose.parallel_scale == before.parallel_scale
    assert differs(picture, view.picture()) > 0.5


def test_that_the_right_button_shifts_and_the_wheel_zooms(make):
    view = make()
    view.set_pose(CameraPose((0.0, -100.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 40.0))
    drag(view, (100, 80), (120, 80), button=Qt.MouseButton.RightButton)
    assert view.pose.focal_point == pytest.approx((-10.0, 0.0, 0.0))  # 20 of 160 pixels, 80 um high
    target = view.widget.childAt(100, 80) or view.widget
    here = QPointF(100, 80)
    event = QWheelEvent(
        here,
        target.mapToGlobal(here),
        QPoint(),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(target, event)
    assert view.pose.parallel_scale < 40.0


def resized(view, width, height):
    view.widget.resize(width, height)
    QApplication.processEvents()
    assert (view.widget.width(), view.widget.height()) == (width, height)


def test_that_a_view_that_is_resized_frames_its_body_again(make):
    view = make()
    view.set_pose(framing_pose(EGG.vertices, "front", 200 / 160))
    for width, height in ((120, 300), (400, 150), (90, 90), (200, 160)):
        resized(view, width, height)
        assert alike(view.pose, framing_pose(EGG.vertices, "front", width / height))


def test_that_a_view_that_is_resized_stays_as_the_user_turned_it(make):
    view = make()
    view.draw(lambda plotter: surfaces.show_particle(plotter, EGG))
    view.set_pose(framing_pose(EGG.vertices, "front", 200 / 160))
    drag(view, (100, 80), (150, 80))
    turned_by_hand = view.pose
    resized(view, 80, 160)
    assert alike(view.pose, replace(turned_by_hand, parallel_scale=2 * turned_by_hand.parallel_scale))
    resized(view, 300, 160)
    assert alike(view.pose, turned_by_hand)


def test_that_a_pose_that_is_set_tells_nobody(make):
    view, heard = make(), []
    view.when_moved(heard.append)
    view.set_pose(framing_pose(BALL.vertices))
    assert heard == []


def test_that_the_ground_takes_the_colours_of_the_theme(make):
    view = make()
    light = view.picture().mean()
    view.set_surroundings(DARK)
    assert view.picture().mean() < light - 100


def test_that_linked_cameras_move_together_until_they_are_let_go(make):
    one, two = make(), make()
    link = CameraLink([one, two])
    link.frame(EGG.vertices)
    drag(one, (100, 80), (130, 60))
    assert alike(one.pose, two.pose)
    link.set_linked(False)
    drag(one, (100, 80), (130, 60))
    assert not alike(one.pose, two.pose)
    link.set_linked(True)
    assert alike(one.pose, two.pose)
    link.look_from("top")
    assert alike(one.pose, two.pose)
    assert one.pose.view_up == (0.0, 1.0, 0.0)
