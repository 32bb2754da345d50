"""The set-up of the page "Angle of repose", its preview and what limits the answer."""

import json
from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
import pytest
from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QFileDialog

from regolith_studio.dataset.folder_io import read_dataset, write_dataset
from regolith_studio.dataset.parameters import DRUM, ContactParameters, LiftingCylinderTest
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs import repose_jobs
from regolith_studio.jobs.dataset_jobs import DatasetBuildResult
from regolith_studio.jobs.events import Progress, Started
from regolith_studio.ui.layout import Collapsible, scrolled_column
from regolith_studio.ui.pages.repose import page as page_module
from regolith_studio.ui.pages.repose.setup import CaseScale, LimitsStrip, SetupPanel
from regolith_studio.ui.result_card import ResultState
from regolith_studio.ui.widgets.forms import ParameterForm
from tests.dem.conftest import box_dataset


@pytest.fixture
def setup(shown):
    return shown(SetupPanel())


def test_that_tables_are_edited_in_the_paper_s_units_and_missing_values_are_marked(shown):
    form = shown(ParameterForm(ContactParameters, "contact"))
    assert form.editors["youngs_modulus"].value() == pytest.approx(30.0)
    assert form.editors["youngs_modulus"].suffix() == " GPa"
    assert form.value() == ContactParameters()
    form.editors["surface_energy"].setValue(25.0)
    assert form.value().surface_energy == pytest.approx(0.025)
    assert set(form.changes()) == {"surface_energy"}
    assert "not given" in form.editors["restitution"].toolTip()
    assert "Table 1" in form.editors["density"].toolTip()


def test_that_a_dataset_is_previewed_with_the_consequences(page, dataset, wait):
    page.setup.set_dataset(dataset)
    wait(lambda: page.player.pile is not None)
    assert len(page.player.pile) == 300
    assert "300 particles" in page.setup.scaling_report.text()
    assert "on one core" in page.angle.sentence.text()
    picture = page.player.frame.view.picture()
    assert picture.std() > 5.0
    page.setup.test.setValue(LiftingCylinderTest(diameter=0.004))
    page.setup.valueChanged.emit()
    wait(lambda: page.setup.problem.text() != "")
    assert "wider cylinder" in page.setup.problem.text()
    assert not page.angle.button.isEnabled()


def test_that_the_page_follows_the_dataset_made_last_until_one_is_chosen_by_hand(
    page, dataset, tmp_path, monkeypatch, wait
):
    session, setup = page._context.session, page.setup

    def make(name):
        session.dataset_folder = write_dataset(tmp_path / name, box_dataset())
        wait(lambda: page._context.bindings.idle)

    make("first")
    make("second")
    assert setup.dataset == tmp_path / "second" == Path(setup.dataset_label.text())
    assert "made or opened last" in setup.dataset_note.text()
    wait(lambda: "Not run yet" in page.angle.sentence.text())
    assert str(tmp_path / "second") in page.angle.sentence.text()
    kept = json.loads(json.dumps(page.state()))
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(dataset))
    page.open_dataset()
    make("third")
    assert setup.dataset == dataset
    assert "Chosen here" in setup.dataset_note.text()
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(tmp_path / "third"))
    page.open_dataset()
    make("fourth")
    assert setup.dataset == tmp_path / "fourth"
    page.restore(kept)
    session.dataset_folder = tmp_path / "second"  # as the page Dataset restores it
    wait(lambda: page._context.bindings.idle)
    assert (setup.dataset, setup.by_hand) == (tmp_path / "second", False)


def test_that_columns_of_the_set_up_come_below_each_other_where_there_is_no_room_for_both(shown, app):
    panel = SetupPanel()
    area = shown(scrolled_column([panel]))
    for width, beside in ((1200, True), (420, False), (1200, True)):
        area.resize(width, 700)
        app.processEvents()
        parts = [each for each in panel.findChildren(Collapsible) if each.isVisible()]
        assert all(each.mapTo(area, each.rect().topRight()).x() < area.viewport().width() for each in parts)
        assert (parts[0].mapTo(panel, QPoint()).x() > panel.seed.mapTo(panel, QPoint()).x()) is beside


def test_that_limits_keep_their_texts_where_the_strip_is_narrow(shown, app):
    strip = shown(LimitsStrip())
    strip.show_scale(CaseScale(200, 5.8, 156.0), lambda _count: 3000.0)
    for width, beside in ((1500, True), (900, False), (1500, True)):
        strip.resize(width, strip.sizeHint().height())
        app.processEvents()
        text, button = strip.texts[0], strip.buttons[0]
        assert text.fontMetrics().horizontalAdvance(text.text()) <= text.width()
        assert (button.y() < text.geometry().bottom()) is beside


def test_that_a_dataset_written_again_into_its_folder_is_drawn_again(page, tmp_path, wait):
    session = page._context.session
    session.dataset_folder = write_dataset(tmp_path / "set", box_dataset())
    wait(lambda: page._prepared is not None)
    drawn = page._prepared
    session.dataset_folder = tmp_path / "set"  # nothing is new
    wait(lambda: page._context.bindings.idle)
    assert page._prepared is drawn
    session.dataset_folder = write_dataset(tmp_path / "set", box_dataset())
    wait(lambda: page._prepared not in (drawn, None))


def test_that_a_hundred_thousand_particles_may_be_simulated_and_are_not_placed_before(
    page, dataset, wait, monkeypatch
):
    placed = []
    monkeypatch.setattr(
        repose_jobs, "loose_column", lambda case: (placed.append(len(case)), loose_column(case))[1]
    )
    page.setup.set_dataset(dataset)
    wait(lambda: page.player.pile is not None)
    filled = page.player.frame.view.picture()
    page.setup.particles.setValue(100_000)
    wait(lambda: "100,000 particles" in page.setup.scaling_report.text())
    assert page.angle.button.isEnabled()
    assert len(page.player.pile) == 0
    assert placed == [300]
    empty = page.player.frame.view.picture()
    rows = min(len(empty), len(filled))  # buttons of the limits may have come below their texts
    assert np.abs(empty[:rows].astype(int) - filled[:rows]).max() > 50


def test_that_values_that_cannot_be_run_are_refused_in_the_form(page, dataset, wait):
    page.setup.set_dataset(dataset)
    page.setup.set_evaluation(median_window=4)
    page.setup.particles.setValue(301)
    wait(lambda: page.setup.problem.text() != "")
    assert not page.angle.button.isEnabled()
    assert page.angle.button.toolTip() == page.setup.problem.text()
    page.setup.set_evaluation(median_window=5)
    page.setup.particles.setValue(300)
    wait(lambda: page.setup.problem.text() == "")
    assert page.angle.button.isEnabled()


def test_that_wishes_without_a_dataset_are_one_sentence(page):
    page.run_test()
    assert "no dataset yet" in page._context.toast.sentence.text()
    page.make_dataset()
    assert "No particles are open" in page._context.toast.sentence.text()


def test_that_gravity_can_be_chosen_by_name_and_the_state_comes_back(setup, dataset):
    setup.gravity.setCurrentIndex(1)
    assert setup.request().case.test.gravity == 1.62
    setup.test.setValue(replace(setup.test.value(), gravity=5.0))
    setup.test.valueChanged.emit({})
    assert setup.gravity.currentText() == "Other"
    setup.set_dataset(dataset)
    setup.seed.setValue(7)
    kept = json.loads(json.dumps(setup.value()))
    setup.seed.setValue(0)
    setup.test.setValue(LiftingCylinderTest())
    setup.setValue(kept)
    request = setup.request()
    assert (request.case.seed, request.case.test.gravity) == (7, 5.0)
    setup.setValue({"test": {"gravity": "heavy"}, "unknown": 1})
    assert setup.request().case == request.case


def test_that_a_drum_has_its_own_cylinder_and_an_engine_that_turns_it(setup):
    setup.test.setValue(LiftingCylinderTest(mass=0.01, wall_friction=0.5))
    assert setup.request().case.drum is None
    setup.apparatus.setCurrentIndex(1)
    setup.drum.setValue({"rpm": 12.0})
    setup.measured.setValue(38.0)
    request = setup.request()
    assert (request.case.drum.rpm, request.engine) == (12.0, "rapier")
    assert request.case.test == replace(DRUM, mass=0.01, wall_friction=0.5)
    assert setup.measured_angle() == (38.0, 1.0)
    with pytest.raises(RegolithError, match="lift a cylinder"):
        setup.request_of_series()
    kept = json.loads(json.dumps(setup.value()))
    setup.apparatus.setCurrentIndex(0)
    setup.measured.setValue(0.0)
    assert setup.request().case.test == LiftingCylinderTest(mass=0.01, wall_friction=0.5)
    setup.setValue(kept)
    assert setup.request().case == request.case
    assert setup.measured_angle() == (38.0, 1.0)


def test_that_each_engine_has_its_own_numerics(setup):
    setup.numerics.setValue({"time_step": 0.01})
    setup.engine.setCurrentIndex(setup.engine.findData("lammps"))
    assert setup.request().engine == "lammps"
    setup.numerics.setValue({"spheres": 3})
    assert setup.request().settings.spheres == 3
    kept = setup.value()
    setup.engine.setCurrentIndex(setup.engine.findData("mujoco"))
    setup.numerics.setValue({})
    setup.setValue(kept)
    assert setup.request().settings.spheres == 3
    setup.engine.setCurrentIndex(setup.engine.findData("mujoco"))
    assert setup.request().settings.time_step == 0.01


def test_that_the_open_particles_become_a_dataset(page, wait):
    session = page._context.session
    session.choose(method="quadric", target="particle")
    session.adopt([Particle("ball", Mesh(40.0 * icosphere(2).vertices, icosphere(2).faces))])
    page.make_dataset()
    wait(lambda: page.setup.dataset is not None)
    assert page.setup.dataset.name == "open-particles"
    wait(lambda: page.player.pile is not None)
    assert page.angle.button.isEnabled()


@pytest.mark.usefixtures("threads")
def test_that_the_card_says_that_a_dataset_is_being_built_and_stops_it(page, wait, dataset, monkeypatch):
    """A build lasts until the test ends it, however fast the machine coarsens."""
    ended = Event()

    def build(*_):
        yield Started("Coarsening", 1)
        while not ended.wait(0.01):
            yield Progress(0, 1, "grain")
        return DatasetBuildResult(dataset, read_dataset(dataset), ())

    monkeypatch.setattr(page_module, "build_dataset_folder", build)
    monkeypatch.setattr(page._context.session._live, "follow", lambda *_: None)  # no fit, no polyhedron
    page._context.session.adopt([Particle("ball", icosphere(2).moved(scale=40.0))])
    page.make_dataset()
    assert page.angle.record.state is ResultState.RUNNING
    assert page.angle.record.note == "A dataset of the open particles is being built."
    page.angle.button.click()
    wait(lambda: page.angle.record.state is ResultState.STOPPED)
    assert page.angle.record.note == "The dataset was not built."
    assert page.setup.dataset is None
    page.make_dataset()
    page.make_dataset()
    assert page._context.toast.sentence.text() == page.angle.record.note, "it is built once"
    ended.set()
    wait(lambda: page.setup.dataset is not None)
    assert page.setup.dataset == dataset


def test_that_no_run_can_be_set_up_with_fewer_particles_than_its_evaluation_accepts(setup):
    assert setup.particles.minimum() == EvaluationSettings().min_particles
    setup.set_evaluation(min_particles=60)
    setup.particles.setValue(10)
    assert setup.request().case.n_particles == 60


def test_that_the_lights_say_how_far_a_case_is_from_what_is_recommended(page, dataset, wait, monkeypatch):
    """300 particles, 6.8 across, 137 times too large: the mass stays, so that N grows with the cube."""
    scale = CaseScale(300, 6.8, 137.0)
    assert [scale.sufficient_number(place) for place in range(3)] == [7700, 1000, 780_000]
    page.limits.show_scale(scale, lambda count: 0.6 * count)
    assert [page.limits._level(place) for place in range(3)] == [2, 2, 2]
    assert page.limits.texts[0].text() == "6.8 across the diameter (≥ 20)", "of a drum as of a cylinder"
    assert [each.text() for each in page.limits.buttons[:2]] == [
        "Run with 7,700: 77 min",
        "Run with 1,000: 10 min",
    ]
    assert not page.limits.buttons[2].isEnabled()
    page.limits.show_scale(CaseScale(1000, 20.0, 10.0), lambda _: 1.0)
    assert all(each.isHidden() for each in page.limits.buttons)
    page.limits.show_scale(CaseScale(700))
    assert page.limits.texts[0].text() == "– across the diameter (≥ 20)"
    page.setup.set_dataset(dataset)
    wait(lambda: page._prepared is not None)
    assert page._seconds(1000) > page._seconds(300)
    started = []
    monkeypatch.setattr(page, "run_test", lambda: started.append(page.setup.particles.value()))
    page.limits.buttons[1].click()
    assert started == [1000]
