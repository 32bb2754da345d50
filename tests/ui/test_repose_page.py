"""The page "Angle of repose": set up, preview, run, replay, sections with cuts, runs, refusals."""

import json
import time
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QFileDialog, QInputDialog, QWidget

from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import check_number
from regolith_studio.dem.evaluation.profile import Discs
from regolith_studio.dem.evaluation.settings import EvaluationSettings
from regolith_studio.dem.run_checks import check_run
from regolith_studio.dem.run_io import FORMAT, RunSummary, read_run, save_result
from regolith_studio.dem.snapshot import ParticleState, Snapshot, particle_state_bytes
from regolith_studio.errors import JobCancelled, RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.events import Partial, Progress
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.messages import to_json
from regolith_studio.scene import instancing
from regolith_studio.scene.cameras import orbited
from regolith_studio.session.session import Session
from regolith_studio.studies.calibration import CalibrationParameter
from regolith_studio.studies.repose import runs_from
from regolith_studio.studies.repose_calibration import CalibrationRun, ReposeCalibration, angle_target
from regolith_studio.ui.app import MainThreadInvoker
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.repose import PAGE
from regolith_studio.ui.pages.repose.player import RunPlayer
from regolith_studio.ui.pages.repose.runs import checks_text
from regolith_studio.ui.pages.repose.section_plot import MANY_DISCS, drawn_discs, particle_text
from regolith_studio.ui.pages.repose.setup import SetupPanel
from regolith_studio.ui.widgets.forms import ParameterForm
from regolith_studio.ui.widgets.toast import Toast
from tests.dem.conftest import box_dataset
from tests.dem.packings import cone

QUICK = {"time_step": 0.04, "iterations": 15, "rest_energy": 2e-3, "rest_time": 1.0, "snapshots": 12}


@pytest.fixture
def threads(app):  # noqa: ARG001
    """A runner whose jobs run beside the window; pages that are made without it have one that waits."""
    poster = MainThreadInvoker()
    yield ThreadRunner(poster.post)
    poster.deleteLater()


@pytest.fixture
def page(shown, preferences, tmp_path, request):
    threaded = "threads" in request.fixturenames
    session = Session(request.getfixturevalue("threads") if threaded else InlineRunner())
    window = shown(QWidget())
    toast = Toast(window)
    bindings = Bindings(session, toast.problem, window)
    commands = Commands(session, preferences, toast, window)
    context = PageContext(
        "repose", session, bindings, preferences, toast, commands, "image", lambda _key: None
    )
    made = shown(PAGE.build(context))
    made.resize(1200, 800)
    made.set_runs_folder(tmp_path / "runs")
    yield made
    bindings.disconnect_all()
    made.on_close()
    session.close()


@pytest.fixture
def dataset(tmp_path):
    return write_dataset(tmp_path / "boxes", box_dataset())


def small(page, dataset):
    page.setup.set_dataset(dataset)
    page.setup.test.setValue(LiftingCylinderTest(mass=0.003, lift_speed=0.15))
    page.setup.numerics.setValue(QUICK)
    page.setup.set_evaluation(min_particles=40)
    page.setup.particles.setValue(40)


def pile_of(angle, n=700):
    points = 2e-3 * cone(angle, n, 1)
    turns = np.tile([1.0, 0, 0, 0], (n, 1))
    return ParticleState(points, np.full(n, 2e-3), turns, np.zeros(n, dtype=int), 1.0, float("inf"), "rest")


def import_positions(page, monkeypatch, tmp_path, pile):
    path = tmp_path / "pile.npz"
    path.write_bytes(particle_state_bytes(pile))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    page.open_positions()


def watch_moments(page, monkeypatch):
    """Title of each picture, whether it shows spheres, and the corners of its first shape."""
    drawn, show = [], page.player.show_moment

    def watch(pile, title, detail=""):
        drawn.append((title, page.player._spheres, len(page.player._shapes[0][0])))
        show(pile, title, detail)

    monkeypatch.setattr(page.player, "show_moment", watch)
    return drawn


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
    assert "on one core" in page.setup.scaling_report.text()
    picture = page.player.frame.view.picture()
    assert picture.std() > 5.0
    page.setup.test.setValue(LiftingCylinderTest(diameter=0.004))
    page.setup.valueChanged.emit()
    wait(lambda: page.setup.problem.text() != "")
    assert "wider cylinder" in page.setup.problem.text()
    assert not page.setup.run.isEnabled()


def test_that_a_hundred_thousand_particles_may_be_simulated_and_are_not_placed_before(page, dataset, wait):
    page.setup.set_dataset(dataset)
    wait(lambda: page.player.pile is not None)
    filled = page.player.frame.view.picture()
    page.setup.particles.setValue(100_000)
    wait(lambda: "100,000 particles" in page.setup.scaling_report.text())
    assert page.setup.run.isEnabled()
    assert len(page.player.pile) == 0
    assert np.abs(page.player.frame.view.picture().astype(int) - filled).max() > 50


def test_that_a_test_is_run_listed_and_replayed(page, dataset, wait, monkeypatch, tmp_path):
    small(page, dataset)
    import_positions(page, monkeypatch, tmp_path, pile_of(30.0))
    wait(lambda: page._measured is not None)
    drawn = watch_moments(page, monkeypatch)
    page.run_test()
    wait(lambda: page.runs.table.rowCount() == 1)
    running = [scene for title, *scene in drawn if title == "Running"]
    assert running
    assert all(
        scene == [False, 8] for scene in running
    )  # the boxes of the dataset, not the spheres of the file
    run = page.runs.current()
    assert run.document["state"] == "finished"
    assert run.document["case"]["n_particles"] == 40
    assert "no angle" in page.verdict.text()
    assert page.player.slider.maximum() >= 4
    last = page.player.pile.points.copy()
    page.player.slider.setValue(0)
    assert page.player.pile.phase == "fill"
    page.player.toggle()
    wait(lambda: page.player.slider.value() >= 2)
    page.player.stop()
    page.player.slider.setValue(page.player.slider.maximum())
    np.testing.assert_array_equal(page.player.pile.points, last)
    assert not page.busy()


def test_that_a_stopped_run_and_changed_values_leave_no_earlier_angle(
    page, dataset, wait, monkeypatch, tmp_path
):
    small(page, dataset)
    import_positions(page, monkeypatch, tmp_path, pile_of(30.0))
    wait(lambda: page._measured is not None)
    assert "°" in page.angle.figures[0].text()

    def stopped(*_):
        yield Partial(Snapshot(pile_of(20.0, 40), 0.5, "lift"))
        raise JobCancelled("stopped")

    monkeypatch.setattr("regolith_studio.ui.pages.repose.page.repose_steps", stopped)
    page.run_test()
    wait(lambda: not page.busy())
    assert "stopped" in page.verdict.text()
    assert "°" not in page.angle.figures[0].text()
    assert page.x_z.is_empty()
    assert "Stopped" in page.player.frame.title
    assert page.setup.run.isEnabled()
    page.setup.particles.setValue(60)
    wait(lambda: len(page.player.pile) == 60)
    assert "Not run yet" in page.verdict.text()


def test_that_values_that_cannot_be_run_are_refused_in_the_form(page, dataset, wait):
    page.setup.set_dataset(dataset)
    page.setup.set_evaluation(median_window=4)
    page.setup.particles.setValue(301)
    wait(lambda: page.setup.problem.text() != "")
    assert not page.setup.run.isEnabled()
    assert page.setup.run.toolTip() == page.setup.problem.text()
    page.setup.set_evaluation(median_window=5)
    page.setup.particles.setValue(300)
    wait(lambda: page.setup.problem.text() == "")
    assert page.setup.run.isEnabled()


def test_that_the_discs_drawn_of_a_large_heap_have_nearly_the_outline_of_all():
    rng = np.random.default_rng(1)
    u = rng.uniform(-20.0, 20.0, 40_000)
    discs = Discs(u, rng.uniform(0.0, 1.0, len(u)) * (12.0 - 0.6 * np.abs(u)), rng.uniform(0.1, 0.3, len(u)))
    drawn, missing = drawn_discs(discs), []
    assert MANY_DISCS < len(drawn) < 15_000
    for at in np.linspace(-19.0, 19.0, 400):
        rise = np.sqrt(np.maximum(discs.radius**2 - (discs.u - at) ** 2, 0.0))
        tops = np.where(rise > 0.0, discs.z + rise, 0.0)
        missing.append((tops.max() - tops[drawn].max()) / discs.radius.mean())
    assert np.mean(missing) < 0.05
    assert max(missing) < 1.5
    few = Discs(discs.u[:100], discs.z[:100], discs.radius[:100])
    assert drawn_discs(few).tolist() == list(range(100))


def test_that_positions_are_measured_and_a_dragged_cut_changes_the_angle(page, tmp_path, monkeypatch, wait):
    path = tmp_path / "pile.npz"
    path.write_bytes(particle_state_bytes(pile_of(30.0)))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    page.open_positions()
    wait(lambda: page.x_z.section is not None)
    assert page._measured.angle == pytest.approx(30.0, abs=2.0)
    before = page._measured
    assert page.angle.figures[0].text() == f"{page._measured.angle:.1f}°"
    cut = page.x_z.cut("high")
    cut.setValue(0.7 * 1e3 * page.x_z.section.profile.top)
    cut.sigPositionChangeFinished.emit(cut)
    wait(lambda: page._measured is not before)
    assert page._measured.settings.cut_top == pytest.approx(0.3, abs=0.002)
    assert page.setup.evaluation.value()["cut_top"] == pytest.approx(0.3, abs=0.002)
    out = tmp_path / "out"
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(out))
    page.export_run()
    assert json.loads((out / "repose.json").read_text("utf-8"))["angle_deg"] == page._measured.angle
    assert (out / "sections.svg").exists()


def test_that_a_section_tells_surface_models_and_grains_under_the_mouse(page, tmp_path, monkeypatch, wait):
    pile = pile_of(30.0)
    path = tmp_path / "pile.npz"
    path.write_bytes(particle_state_bytes(pile))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    page.open_positions()
    wait(lambda: page.x_z.section is not None)
    plot, section = page.x_z, page.x_z.section
    at = np.flatnonzero(section.used & (section.profile.u < section.asymmetric.apex[0]))[3]
    u, z = section.profile.u[at], section.profile.height[at]
    words = plot.value_at(plot.canvas.getViewBox().mapViewToScene(QPointF(1e3 * u, 1e3 * z)))
    left = section.asymmetric.left
    assert words.splitlines()[0] == f"surface at {1e3 * u:.3g} mm: {1e3 * z:.3g} mm (between the cuts)"
    assert words.splitlines()[1] == (
        f"left flank: {1e3 * (left.slope * u + left.intercept):.3g} mm, {left.angle:.1f}°"
    )
    middle = pile.points[:, :2] - np.median(pile.points[:, :2], axis=0)
    deep = np.argmin(np.hypot(middle[:, 0], pile.points[:, 2] - 0.3 * section.profile.top))
    x, high = middle[deep, 0], pile.points[deep, 2]
    assert particle_text(
        Discs(middle[deep : deep + 1, 0], pile.points[deep : deep + 1, 2], np.array([1e-3])), x, high
    ) == (f"grain 1: 2 mm at {1e3 * x:.3g}, {1e3 * high:.3g} mm")
    assert plot.value_at(plot.canvas.getViewBox().mapViewToScene(QPointF(1e3 * x, 1e3 * high))).startswith(
        "grain "
    )
    assert plot.value_at(plot.canvas.getViewBox().mapViewToScene(QPointF(0.0, 1e6))) == ""
    columns, rows = plot.numbers()
    assert columns[0] == "x [mm]"
    assert sum(row[2] == "yes" for row in rows) == section.used.sum()


def test_that_a_table_of_another_program_asks_for_its_unit(page, tmp_path, monkeypatch, wait):
    pile = pile_of(35.0)
    path = tmp_path / "rocky.csv"
    np.savetxt(
        path, 1e3 * np.column_stack([pile.points, pile.diameters]), delimiter=",", header="x,y,z,diameter"
    )
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    monkeypatch.setattr(QInputDialog, "getItem", lambda *_: ("mm", True))
    page.open_positions()
    wait(lambda: page._measured is not None)
    assert page._measured.angle == pytest.approx(35.0, abs=2.0)
    assert page._pile.diameters == pytest.approx(2e-3)


def test_that_what_is_no_pile_says_so(page, tmp_path, monkeypatch, wait):
    flat = pile_of(30.0)
    path = tmp_path / "flat.npz"
    path.write_bytes(particle_state_bytes(replace(flat, points=flat.points * [3.0, 3.0, 0.0] + [0, 0, 1e-3])))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    page.open_positions()
    wait(lambda: "no angle" in page.verdict.text())
    assert page.x_z.is_empty()
    page.export_run()
    assert "no measured pile" in page._context.toast.sentence.text()


def test_that_the_player_refuses_the_final_state_of_another_run(page, tmp_path):
    save_result(tmp_path, {"format": FORMAT}, pile_of(30.0), 1.0)
    page.player.show_run([tmp_path / "final.npz"], "run")
    assert len(page.player.pile) == 700
    (tmp_path / "final.npz").write_bytes(particle_state_bytes(pile_of(20.0)))
    page.player.show_run([tmp_path / "final.npz"], "run")
    assert "not the final state of the run" in page.player.clock.text()


def test_that_a_large_heap_is_drawn_coarsely_while_the_view_turns(page, monkeypatch, wait):
    def drawn():
        actors = page.player.frame.view._plotter.actors
        return [name for name in ("heap", "coarse_heap") if name in actors and actors[name].GetVisibility()]

    ball = ((page.player_ball(),),)
    page.player.set_scene(ball, False, LiftingCylinderTest())
    page.player.show_moment(pile_of(30.0), "heap")
    turned = orbited(page.player.frame.view.pose, 0.1, 0.0)
    page.player.frame.view._move(turned)
    assert drawn() == ["heap"], "700 particles turn as they are"
    monkeypatch.setattr(instancing, "MANY_TRIANGLES", 10_000)
    page.player.frame.view._move(turned)
    assert drawn() == ["coarse_heap"]
    wait(lambda: drawn() == ["heap"])


def test_that_the_shown_run_is_exported_for_other_programs(page, tmp_path, monkeypatch, wait):
    out = tmp_path / "out"
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(out))
    page.export_heap()
    assert "no run to export" in page._context.toast.sentence.text()
    run = tmp_path / "run"
    run.mkdir()
    case = {"shapes": "spheres", "test": {}}
    save_result(run, {"format": FORMAT, "state": "stopped", "case": case}, pile_of(30.0), 1.0)
    np.savez(run / "shapes.npz", **{"shape_00000.part_00": np.eye(3)})
    page._show_run(read_run(run))
    page.export_heap()
    wait((out / "export.json").is_file)
    wait(lambda: str(out) in page._context.toast.sentence.text())
    assert {"particles.pvd", "heap.glb", "README.txt"} <= {path.name for path in out.iterdir()}


def test_that_wishes_without_a_dataset_are_one_sentence(page):
    page.run_test()
    assert "no dataset yet" in page._context.toast.sentence.text()
    page.make_dataset()
    assert "No particles are open" in page._context.toast.sentence.text()


def test_that_gravity_can_be_chosen_by_name_and_the_state_comes_back(page, dataset):
    page.setup.gravity.setCurrentIndex(1)
    assert page.setup.request().case.test.gravity == 1.62
    page.setup.test.setValue(replace(page.setup.test.value(), gravity=5.0))
    page.setup.test.valueChanged.emit({})
    assert page.setup.gravity.currentText() == "Other"
    page.setup.set_dataset(dataset)
    page.setup.seed.setValue(7)
    kept = json.loads(json.dumps(page.state()))
    page.setup.seed.setValue(0)
    page.setup.test.setValue(LiftingCylinderTest())
    page.restore(kept)
    request = page.setup.request()
    assert (request.case.seed, request.case.test.gravity) == (7, 5.0)
    page.restore({"setup": {"test": {"gravity": "heavy"}, "unknown": 1}})
    page.restore({"setup": 3})


@pytest.mark.slow
def test_that_runs_are_compared(page, dataset, wait):
    small(page, dataset)
    page.run_test()
    wait(lambda: page.runs.table.rowCount() == 1)
    run = read_run(page.runs.current().folder)
    for value, angle in ((0.2, 18.0), (0.8, 26.0)):
        document = json.loads(json.dumps(run.document))
        document["case"]["contact"]["static_friction"] = value
        document["measurement"] = {
            "status": "pile",
            "angle_deg": angle,
            "interval_deg": [angle - 1, angle + 1],
        }
        folder = run.folder.with_name(f"friction-{value}")
        folder.mkdir()
        (folder / "repose.json").write_text(json.dumps(document))
    page.set_runs_folder(run.folder.parent)
    (curve,) = page.runs.plot.curves
    assert (curve.x, curve.y) == ((0.2, 0.8), (18.0, 26.0))


def test_that_each_engine_has_its_own_numerics(page):
    page.setup.numerics.setValue({"time_step": 0.01})
    page.setup.engine.setCurrentIndex(page.setup.engine.findData("lammps"))
    assert page.setup.request().engine == "lammps"
    page.setup.numerics.setValue({"spheres": 3})
    assert page.setup.request().settings.spheres == 3
    kept = page.state()
    page.setup.engine.setCurrentIndex(page.setup.engine.findData("mujoco"))
    page.setup.numerics.setValue({})
    page.restore(kept)
    assert page.setup.request().settings.spheres == 3
    page.setup.engine.setCurrentIndex(page.setup.engine.findData("mujoco"))
    assert page.setup.request().settings.time_step == 0.01


def test_that_the_open_particles_become_a_dataset(page, wait):
    session = page._context.session
    session.choose(method="quadric", target="particle")
    session.adopt([Particle("ball", Mesh(40.0 * icosphere(2).vertices, icosphere(2).faces))])
    page.make_dataset()
    wait(lambda: page.setup.dataset is not None)
    assert page.setup.dataset.name == "open-particles"
    wait(lambda: page.player.pile is not None)
    assert page.setup.run.isEnabled()
    assert not page._context.toast.sentence.text()


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_that_a_study_grows_is_stopped_and_goes_on(page, dataset, wait, workers):
    small(page, dataset)
    panel = page.study
    panel.workers.setMaximum(2)  # also on a machine of one core
    panel.restore({"key": "static_friction", "values": "0.2, 0.8", "repeats": 1, "workers": workers})
    page.start_study()
    wait(lambda: panel.table.rowCount() == 2)
    wait(lambda: "tables and figure" in panel.status.text())
    assert [panel.table.item(row, 0).text() for row in (0, 1)] == ["0.2", "0.8"]
    folder = page._folder / "studies" / f"static_friction-{dataset.name}"
    assert (folder / "repose_study.csv").exists()
    assert not page.busy()
    before = {path: path.stat().st_mtime_ns for path in folder.glob("*/repose.json")}
    assert len(before) == 2
    page.start_study()
    wait(lambda: "tables and figure" in panel.status.text())
    assert {path: path.stat().st_mtime_ns for path in before} == before
    panel.table.selectRow(1)
    wait(lambda: page.player.slider.maximum() >= 4)
    assert "no angle" in page.verdict.text()
    assert page.state()["study"]["values"] == "0.2, 0.8"
    assert page.state()["study"]["workers"] == workers


def test_that_a_study_of_names_and_piles_is_drawn(page):
    document = {"state": "finished", "case": {"seed": 0}, "problem": None}
    runs = [
        ("cohesion", name, name, document | {"measurement": {"angle_deg": angle, "interval_deg": [20, 30]}})
        for name, angle in (("none", 22.0), ("scaled", 30.0))
    ]
    page.study.show_study(runs_from(runs))
    mean, dots = page.study.plot.curves
    assert (dots.x, dots.y) == ((1.0, 2.0), (22.0, 30.0))
    assert mean.y == dots.y
    assert not mean.line


def test_that_a_study_says_what_it_lacks(page, dataset):
    page.start_study()
    assert "no dataset yet" in page._context.toast.sentence.text()
    page.study.key.setCurrentIndex(page.study.key.findData("n_facets"))
    assert page.study.values.text() == "8, 20, 60"
    page.start_study()
    assert "open particles" in page._context.toast.sentence.text()
    small(page, dataset)
    page.study.restore({"key": "gravity", "values": "moon", "repeats": 2})
    page.start_study()
    assert "numbers with commas" in page._context.toast.sentence.text()


def test_that_a_calibration_shows_runs_density_and_the_next_run(page):
    """Heaps on the line 10 + 20 x; the wanted angle is that of a friction of 0.6."""
    calibration = ReposeCalibration.begin(
        [CalibrationParameter("static_friction", 0.05, 1.2)], [angle_target(22.0, 0.5)]
    )
    page.calibration.show_calibration(calibration)
    assert page.calibration.prediction.curves == ()
    for number, friction in enumerate((0.2, 0.6, 1.0, 0.5), 1):
        measured = {"status": "pile", "angle_deg": 10 + 20 * friction, "interval_deg": None}
        document = {"state": "finished", "measurement": measured}
        calibration = calibration.with_run(CalibrationRun(f"run_{number:02d}", (friction,), document))
    page.calibration.show_calibration(calibration)
    *_, wanted, runs = page.calibration.prediction.curves
    assert set(wanted.y) == {22.0}
    assert (runs.x, runs.y) == ((0.2, 0.6, 1.0, 0.5), (14.0, 22.0, 30.0, 20.0))
    last, half = page.calibration.posterior.curves
    assert (last.label, half.label) == ("runs: 4", "runs: 2")
    assert last.x[int(np.argmax(last.y))] == pytest.approx(0.6, abs=0.1)
    assert "after 4 runs; next run at" in page.calibration.status.text()


def test_that_a_calibration_without_a_usable_run_shows_no_value(page):
    """Without a result the posterior is the prior, whose middle is no measurement of the friction."""
    calibration = ReposeCalibration.begin(
        [CalibrationParameter("static_friction", 0.3, 0.9)], [angle_target(30.0, 1.0)]
    )
    for friction in (0.6, 0.4):
        document = {"state": "finished", "measurement": {"status": "no flanks"}}
        calibration = calibration.with_run(CalibrationRun("run", (friction,), document))
    page.calibration.show_calibration(calibration)
    text = page.calibration.status.text()
    assert "2 of 2 runs formed a heap without a measurable angle" in text
    assert "interval" not in text
    assert page.calibration.posterior.curves == ()


@pytest.mark.parametrize(
    ("name", "job"), [("study", "run_repose_study"), ("calibration", "locked_calibration")]
)
@pytest.mark.usefixtures("threads")
def test_that_its_button_stops_a_study_and_frees_the_form(page, dataset, wait, monkeypatch, name, job):
    def endless(*_):
        while True:
            time.sleep(0.01)
            yield Progress(1, 2)

    monkeypatch.setattr(f"regolith_studio.ui.pages.repose.{name}_controller.{job}", endless)
    small(page, dataset)
    panel = getattr(page, name)
    getattr(page, f"start_{name}")()
    assert page.busy()
    panel.stop.click()
    wait(lambda: not page.busy(), 5.0)
    assert not panel.start.isHidden()
    assert panel.stop.isHidden()
    assert panel.status.text().startswith("Stopped")


@pytest.mark.slow
def test_that_a_calibration_runs_and_goes_on_in_its_folder(page, dataset, wait):
    small(page, dataset)
    page.calibration.restore({"angle": 25.0, "runs": 2})
    page.start_calibration()
    wait(lambda: "after 2 runs" in page.calibration.status.text() and not page.busy())
    (folder,) = (page._folder / "studies").iterdir()
    before = (folder / "run_01" / "repose.json").stat().st_mtime_ns
    page.calibration.restore(page.state()["calibration"] | {"angle": 27.0})
    page.start_calibration()
    wait(lambda: "after 2 runs" in page.calibration.status.text() and not page.busy())
    assert (folder / "run_01" / "repose.json").stat().st_mtime_ns == before
    assert json.loads((folder / "calibration.json").read_text())["targets"][0]["value"] == 27.0


def test_that_a_calibration_says_what_it_lacks(page, dataset):
    page.start_calibration()
    assert "no dataset yet" in page._context.toast.sentence.text()
    small(page, dataset)
    for words, sentence in (
        ("0.2", "lowest and highest value"),
        ("1, 0.2", "from a lower to a higher value"),
    ):
        page.calibration.restore({"key": "static_friction", "range": words})
        page.start_calibration()
        assert sentence in page._context.toast.sentence.text()


def test_that_the_whole_column_of_particles_is_in_the_picture_before_the_lift(shown, app):
    player = shown(RunPlayer("image"))
    player.resize(800, 400)
    app.processEvents()
    test = LiftingCylinderTest()
    player.set_scene(((icosphere(1).vertices * 1e-3,),), True, test)
    n = 40
    points = np.zeros((n, 3))
    points[:, 2] = np.linspace(0.001, 2.0 * test.height, n)
    orientations = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    pile = ParticleState(points, np.full(n, 2e-3), orientations, np.zeros(n, dtype=np.int64))
    player.show_moment(pile, "Before")
    assert player.frame.view.pose.parallel_scale >= 0.5 * 2.0 * test.height
    player.release()


def test_that_the_problems_of_a_saved_run_are_shown_in_the_language_of_the_window(speaking, tmp_path):
    checks = check_run(
        np.array([-5.0, 1.0]),
        np.array([0.134]),
        energy_gain=0.0,
        kinetic_energy=0.0,
        at_rest=True,
        filling=(0, 0),
    )
    document = {"checks": {"problems": [str(each) for each in checks.problems], "passed": False}}
    document["messages"] = [to_json(each) for each in checks.problems]
    run = RunSummary(tmp_path, json.loads(json.dumps(document)))
    assert checks_text(run) == " ".join(checks.problems)
    speaking("de")
    assert checks_text(run) == (
        "1 von 2 Partikeln fielen durch die Platte. "
        "100,0 % der Kontakte sind tiefer als 2 % des mittleren Durchmessers. "
        "Partikel überlappen um bis zu 13,4 % des mittleren Durchmessers."
    )


def test_that_a_number_too_small_for_a_pile_is_refused_in_german(shown, speaking):
    speaking("de")
    with pytest.raises(RegolithError) as caught:
        check_number(120, EvaluationSettings())
    panel = shown(SetupPanel())
    panel.show_consequences([], str(caught.value))
    assert panel.problem.text().startswith("120 Partikel")
    assert "150" in panel.problem.text()


def test_that_no_run_can_be_set_up_with_fewer_particles_than_its_evaluation_accepts(page):
    assert page.setup.particles.minimum() == EvaluationSettings().min_particles
    page.setup.set_evaluation(min_particles=60)
    page.setup.particles.setValue(10)
    assert page.setup.request().case.n_particles == 60
