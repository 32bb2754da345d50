"""What the views can show besides the surfaces, and their way into files."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from PySide6.QtWidgets import QApplication

from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.scene import overlays
from regolith_studio.scene.comparison import OTHER
from regolith_studio.scene.surfaces import SURFACE
from regolith_studio.session.session import Session
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.pages.explore.page import PictureDialog

SECONDS = 120.0
VEIL = OTHER + SURFACE
ASKED = "regolith_studio.ui.pages.explore.page.QFileDialog.getSaveFileName"


def seen(window, view, name):
    actor = window.page.three_views.views[view]._plotter.actors.get(name)
    return actor if actor is not None and actor.GetVisibility() else None


def test_that_box_star_point_and_overlay_come_and_go(window):
    for name in ("box", "star_point", "overlay"):
        window.menus.by_name[f"explore.{name}"].trigger()
    corners = minimum_volume_box(window.session.selected.particle.mesh).corners
    drawn = seen(window, "particle", overlays.BOX).mapper.dataset.points
    assert np.allclose(drawn, corners, rtol=1e-4)
    results = window.session.results
    solid = results.coarsened
    inside = minimum_volume_box(solid.polyhedron).corners + solid.centre
    assert np.allclose(seen(window, "polyhedron", overlays.BOX).mapper.dataset.points, inside, rtol=1e-3)
    star = seen(window, "fit", overlays.STAR_POINT).mapper.dataset.center
    assert np.allclose(star, results.fit.star_point, rtol=1e-3, atol=1e-2)
    assert seen(window, "polyhedron", overlays.STAR_POINT) is None
    assert seen(window, "particle", VEIL) is None
    assert seen(window, "polyhedron", VEIL) is not None
    for name in ("box", "star_point", "overlay"):
        window.menus.by_name[f"explore.{name}"].trigger()
    for view in ("particle", "fit", "polyhedron"):
        assert not any(seen(window, view, each) for each in (overlays.BOX, overlays.STAR_POINT, VEIL))


def test_that_the_overlap_that_descriptors_cost_is_told_beside_the_choices(window, settled):
    coarse = window.session.results.coarsened
    window.session.update("coarsening", coarsened=replace(coarse, free_jaccard_distance=None))
    settled(window)
    assert not window.page.outcome.words.text()
    free = coarse.jaccard_distance / 2
    window.session.update("coarsening", coarsened=replace(coarse, free_jaccard_distance=free))
    settled(window)
    assert f"with the overlap alone it would be {free:.3f}" in window.page.outcome.words.text()


@pytest.mark.slow
def test_that_a_fit_far_from_its_particle_says_so_and_no_longer_once_another_is_shown(window, wait):
    window.session.choose(l_max=2)
    warnings = window.page.fit.warnings
    wait(lambda: "At l = 2 off by more than 5 %: " in warnings.text(), SECONDS)
    assert "would do." in warnings.text()
    window.session.choose(l_max=3)
    wait(lambda: "up to l = 2" not in warnings.text(), SECONDS)


@pytest.mark.slow
def test_that_the_picture_is_written_at_its_scale_and_without_background(window, tmp_path, monkeypatch, wait):
    target = tmp_path / "views"
    monkeypatch.setattr(ASKED, lambda *_: (str(target), ""))
    monkeypatch.setattr(PictureDialog, "exec", lambda _self: 1)
    monkeypatch.setattr(PictureDialog, "value", lambda _self: ("figure", 1, True))
    window.menus.by_name["explore.save_picture"].trigger()
    wait(lambda: not window.session.tasks and target.with_suffix(".png").exists(), 100.0)
    with Image.open(target.with_suffix(".png")) as file:
        picture = np.array(file)
    assert picture.shape == (560, 1860, 4)
    assert 0.02 < (picture[..., 3] > 0).mean() < 0.8
    assert window.page.pictures._context.recall("pictures") == str(tmp_path)


def test_that_the_picture_dialog_keeps_what_is_written_into_it(shown):
    dialog = shown(PictureDialog())
    dialog.scale.setValue(4)
    dialog.transparent.setChecked(True)
    assert dialog.value() == ("screenshot", 4, True)
    dialog.kind.setCurrentIndex(1)
    assert dialog.value() == ("figure", 4, True)


@pytest.mark.slow
def test_that_the_animation_runs_through_all_degrees(window, tmp_path, monkeypatch, wait):
    target = tmp_path / "grain.gif"
    monkeypatch.setattr(ASKED, lambda *_: (str(target), ""))
    window.session.select("angular-1")
    wait(lambda: window.session.results.coarsened is not None and not window.session.tasks, SECONDS)
    window.menus.by_name["explore.save_animation"].trigger()
    wait(lambda: target.exists() and not window.session.tasks, 170.0)
    with Image.open(target) as file:
        assert file.n_frames > 20
    assert "animation" in window.toast.sentence.text()
    QApplication.processEvents()


@pytest.mark.slow
def test_that_annealing_is_shown_step_by_step(window, wait):
    """At least 20 pictures of a run, in order, and in the end the polyhedron that has its errors."""
    page, seen_steps = window.page, []
    page.replay.shown.connect(lambda step: seen_steps.append(step.step))
    window.session.choose(method="annealing")
    wait(lambda: window.session.results.coarsened is not None and not page.replay.playing, SECONDS)
    wait(lambda: seen_steps[-1:] == [100])
    assert len(seen_steps) >= 20
    assert seen_steps == sorted(set(seen_steps))
    drawn = page.three_views.shapes[-1].polyhedron
    assert drawn is window.session.results.coarsened.polyhedron


@pytest.mark.slow
def test_that_explore_finds_and_takes_the_number_of_facets_from_which_on_nothing_is_gained(window, settled):
    window.session.choose(selected="bead-2", method="quadric", target="particle")
    settled(window, SECONDS)
    button = window.page.coarsening.enough
    button.click()
    settled(window, SECONDS)
    offered = window.page.coarsening._sufficient
    assert str(offered) in button.text()
    if button.isEnabled():
        button.click()
        settled(window, SECONDS)
        assert window.session.choices.n_facets == offered
    window.session.choose(seed=3)
    settled(window, SECONDS)
    assert button.text() == "Suggest n"


def test_that_a_number_of_facets_found_by_its_loss_is_explained_by_the_loss(window, settled, wait):
    settled(window, SECONDS)
    window.session.update("coarsening", fewer_facets=(12, 0.1))
    button = window.page.coarsening.enough
    wait(lambda: button.text() == "Use 12 facets")  # refreshed at its next refresh
    assert window.page.coarsening.finding.text() == "Nothing is gained beyond 12 facets."
    assert button.toolTip() == "With these facets the loss was no larger."


def test_that_nothing_is_being_computed_while_nothing_is_open(shown, preferences):
    page = shown(MainWindow(Session(InlineRunner()), preferences, "image")).page
    assert [frame.detail.text() for frame in page.three_views.frames.values()] == ["", "", ""]
    assert page.assessment.sentence.text() == "Open a particle first."
