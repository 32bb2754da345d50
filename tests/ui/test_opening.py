"""Opening: the unit and its size, add or replace, undo of both; and the chapter of the guide on each page."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QDialogButtonBox, QWidget

from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.guide import chapter
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.model_jobs import GenerationRequest, draw_shapes, fit_shapes, make_particles
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.readers.shape_files import ShapeSource
from regolith_studio.session.file_kinds import kind_of_all
from regolith_studio.session.project import SessionRecipe
from regolith_studio.session.provenance import SampleSource, VirtualSource
from regolith_studio.session.session import Session
from regolith_studio.shape_models.sample import Sample
from regolith_studio.steps import result_of
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.dialogs.files import UnitDialog
from regolith_studio.ui.dialogs.help import PAGES, as_markdown
from regolith_studio.ui.pages import PAGES as WINDOW_PAGES
from regolith_studio.ui.widgets.toast import Toast


@pytest.mark.parametrize(("length", "unit"), [(5e-5, "m"), (0.12, "mm"), (80.0, "um")])
def test_that_the_unit_that_makes_a_grain_is_suggested_with_its_size(shown, length, unit):
    dialog = shown(UnitDialog([Path("apollo_sample1.stl")], "um"))
    assert not dialog.can_open, "the size may correct the unit"
    dialog.set_first(("apollo_sample1", length))
    assert dialog.value() == unit
    assert dialog.can_open
    size = {"m": "50.0", "mm": "120", "um": "80.0"}[unit]
    assert dialog.size_note.text().startswith(f"apollo_sample1 would be {size}")
    QTest.keyClick(dialog, Qt.Key.Key_Return)
    assert dialog.result() == UnitDialog.DialogCode.Accepted


def test_that_return_opens_once_the_size_is_known(shown, wait):
    dialog = shown(UnitDialog([Path("grain.stl")], "um"))
    dialog.activateWindow()
    wait(lambda: dialog.focusWidget() is dialog.unit)
    opened = []
    dialog.accepted.connect(lambda: opened.append(True))
    QTest.keyClick(dialog.focusWidget(), Qt.Key.Key_Return)
    assert dialog.isVisible()
    dialog.set_first(("grain", 120.0))
    QTest.keyClick(dialog.focusWidget(), Qt.Key.Key_Return)
    assert opened == [True]


def test_that_a_dialog_grows_with_its_texts_instead_of_squeezing_its_fields(shown, wait):
    dialog = shown(UnitDialog([Path("apollo_sample1.stl")], "um"))
    high = dialog.unit.sizeHint().height()
    dialog.set_first("The folder holds no mesh file that could be read. " * 8)
    wait(lambda: dialog.size_note.height() >= dialog.size_note.heightForWidth(dialog.size_note.width()))
    assert dialog.unit.height() >= high


@pytest.mark.parametrize("kind", ["folder without meshes", "mesh cut short"])
def test_that_the_unit_dialog_says_what_cannot_be_opened(opening, monkeypatch, tmp_path, kind):
    commands, *_ = opening
    path = tmp_path / "broken.stl"
    path.write_bytes(stl_bytes(icosphere(1).triangles, "ball")[:500])
    said = {"folder without meshes": "holds no mesh file", "mesh cut short": "is cut short"}[kind]
    if kind == "folder without meshes":
        path = tmp_path / "empty"
        path.mkdir()
    seen = []

    def look(dialog):
        buttons = dialog.findChild(QDialogButtonBox)
        seen.append(
            (dialog.size_note.text(), buttons.button(QDialogButtonBox.StandardButton.Open).isEnabled())
        )
        return QDialog.DialogCode.Rejected

    monkeypatch.setattr(UnitDialog, "exec", look)
    commands.open_paths([path])
    ((sentence, can_open),) = seen
    assert said in sentence
    assert not can_open


def test_that_files_of_other_kinds_state_no_unit_for_the_meshes_beside_them(opening, monkeypatch, tmp_path):
    commands = opening[0]
    path = tmp_path / "scan.npy"
    np.save(path, np.zeros((4, 4, 4), np.uint8))
    monkeypatch.setitem(commands.openers, kind_of_all([path]), lambda _path: None)
    commands.open_paths([path])
    assert commands._preferences.recent[0] == str(path.resolve())
    assert commands._preferences.unit_for(tmp_path / "grain.stl") is None


def test_that_the_convention_of_tables_of_coefficients_can_be_chosen(opening, monkeypatch, tmp_path, wait):
    commands, session, _ = opening
    path = tmp_path / "table.anm"
    path.write_text("0 0 100 0\n1 0 0 0\n1 1 0 0\n2 0 14 0\n2 1 0 0\n2 2 6 0\n")
    names_before = names(session)
    shown_rows = []

    def choose(dialog):
        shown_rows.append(not dialog.convention.isHidden())
        dialog.setValue("um")
        dialog.convention.setCurrentIndex(dialog.convention.findData("shtools-ortho"))
        return QDialog.DialogCode.Accepted

    monkeypatch.setattr(UnitDialog, "exec", choose)
    press("opening_add")
    commands.open_paths([path])
    wait(lambda: names(session) != names_before)
    assert shown_rows == [True]
    origin = session.particles[-1].ref.origin
    assert origin.convention == "shtools-ortho"
    mean_radius = np.linalg.norm(session.particles[-1].particle.mesh.vertices, axis=1).mean()
    assert mean_radius == pytest.approx(100 / np.sqrt(4 * np.pi), rel=0.01)
    recipe = SessionRecipe.of(session.particles, session.choices).recipe
    assert [each.convention for each in recipe.openings] == ["auto", "shtools-ortho"]


def test_that_files_that_state_their_unit_are_opened_without_asking_for_it(opening, monkeypatch, tmp_path):
    commands, session, _ = opening
    trimesh.creation.icosphere(radius=5e-5).export(tmp_path / "ball.glb")
    monkeypatch.setattr(UnitDialog, "exec", lambda _: pytest.fail("asked for a stated unit"))
    press("opening_add")
    commands.open_paths([tmp_path / "ball.glb"])
    assert session.particles[-1].particle.mesh.bounds[1] == pytest.approx([50.0] * 3, rel=0.001)


def test_that_files_of_a_folder_that_no_reader_takes_are_named(opening, tmp_path):
    commands, session, _ = opening
    said = []
    session.events.left_out.connect(lambda sentences: said.extend(sentences))
    write_ball(tmp_path / "c" / "ball.stl", 30.0)
    (tmp_path / "c" / "heap.vtk").write_bytes(b"# vtk DataFile Version 3.0")
    press("opening_add")
    commands.open_paths([tmp_path / "c"], "um")
    assert said == ["c: left out 1 file that no reader of meshes takes: heap.vtk."]


def test_that_every_page_has_a_chapter_of_the_guide_without_directives():
    assert set(PAGES) == set(WINDOW_PAGES)
    for name in PAGES.values():
        text = as_markdown(chapter(name))
        assert "{doc}" not in text
        assert "{results}" not in text
    assert as_markdown("see {doc}`views` and {doc}`more <harmonics>`") == (
        "see [views](views.md) and [more](harmonics.md)"
    )


def write_ball(path, radius):
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(stl_bytes(icosphere(1).moved(scale=radius).triangles, "ball"))
    return path


@pytest.fixture
def opening(shown, preferences, tmp_path, monkeypatch):
    """The commands of a session with one ball of 50 mm, and its parent of dialogs."""
    session, window = Session(InlineRunner()), shown(QWidget())
    monkeypatch.setattr(session._live, "follow", lambda *_: None)  # no fit, no polyhedron
    commands = Commands(session, preferences, Toast(window), window)
    commands.open_paths([write_ball(tmp_path / "a" / "one.stl", 25.0)], "mm")
    yield commands, session, window
    session.close()


def names(session):
    return [each.id for each in session.particles]


def size(session):
    return float(np.ptp(session.particles[0].particle.mesh.bounds, axis=0).max())


def press(name, remember=False):
    """Press a button of the question as soon as it is asked."""

    def act():
        box = next(each for each in QApplication.topLevelWidgets() if each.objectName() == "add_or_replace")
        box.checkBox().setChecked(remember)
        next(each for each in box.buttons() if each.objectName() == name).click()

    QTimer.singleShot(0, act)


def test_that_replaced_particles_come_back_by_undo_and_added_ones_go(opening, tmp_path):
    commands, session, _ = opening
    other = write_ball(tmp_path / "b" / "two.stl", 30.0)
    press("opening_cancel")
    commands.open_paths([other], "um")
    assert names(session) == ["one"]
    press("opening_replace")
    commands.open_paths([other], "um")
    assert names(session) == ["two"]
    commands.undo()
    assert names(session) == ["one"]
    press("opening_add", remember=True)
    commands.open_paths([other], "um")
    assert names(session) == ["one", "two"]
    commands.undo()
    assert names(session) == ["one"]
    commands.open_paths([other], "um")  # it is not asked again
    assert names(session) == ["one", "two"]


def test_that_an_undone_opening_is_redone_until_something_else_changes(opening, tmp_path):
    commands, session, _ = opening
    press("opening_replace")
    commands.open_paths([write_ball(tmp_path / "b" / "two.stl", 30.0)], "um")
    assert not commands.next_step("redo")
    commands.undo()
    assert commands.next_step("redo")
    commands.redo()
    assert names(session) == ["two"]
    assert not commands.next_step("redo")
    commands.undo()
    assert names(session) == ["one"]
    session.choose(l_max=5)
    assert not commands.next_step("redo")
    commands.undo()
    commands.redo()
    assert (names(session), session.choices.l_max) == (["one"], 5)


def test_that_several_openings_are_undone_and_redone_in_turn(opening, tmp_path):
    commands, session, _ = opening
    for name in ("two", "three"):
        press("opening_replace")
        commands.open_paths([write_ball(tmp_path / "b" / f"{name}.stl", 30.0)], "um")
    seen = []
    for step in (commands.undo, commands.undo, commands.redo, commands.redo):
        step()
        seen += names(session)
    assert seen == ["two", "one", "two", "three"]
    assert not commands.next_step("redo")


def test_that_particles_of_a_page_ask_before_they_replace_those_of_a_file_and_can_be_undone(opening):
    commands, session, _ = opening
    origin = SampleSource()  # any source but a file
    press("opening_cancel")
    assert not commands.adopt([Particle("drawn", icosphere(1))], origin)
    assert names(session) == ["one"]
    press("opening_replace")
    assert commands.adopt([Particle("drawn", icosphere(1))], origin)
    assert names(session) == ["drawn"]
    commands.undo()
    assert names(session) == ["one"]
    press("opening_replace")
    commands.adopt([Particle("drawn", icosphere(1))], origin)
    assert commands.adopt([Particle("again", icosphere(1))], origin)  # nothing is asked: no file is closed
    assert names(session) == ["again"]


def drawn(n=3):
    """Particles drawn from a fitted model, and their origin, as the page Shape model hands them over."""
    rng = np.random.default_rng(0)
    rows = rng.normal(size=(12, 9)) * 0.05
    rows[:, 0] = 10 * np.sqrt(4 * np.pi)
    request = GenerationRequest(n=n, l_max=2)
    fitted = result_of(fit_shapes(ShapeSource(Sample(rows), "rough", "0" * 64), request))
    found = result_of(draw_shapes(fitted.model, request))
    origin = VirtualSource.of(found, fitted, 3)
    return result_of(make_particles(found.draws, found.model, origin.population.name, 3)), origin


@pytest.mark.slow
def test_that_drawn_particles_that_were_replaced_come_back_by_undo(opening, tmp_path):
    commands, session, _ = opening
    made, origin = drawn()
    session.adopt(made, origin=origin)
    press("opening_replace")
    commands.open_paths([write_ball(tmp_path / "b" / "two.stl", 30.0)], "mm")
    assert names(session) == ["two"]
    commands.undo()
    assert names(session) == [each.name for each in made]
    for entry, particle in zip(session.particles, made, strict=True):
        np.testing.assert_array_equal(entry.particle.mesh.vertices, particle.mesh.vertices)
    commands.redo()
    assert names(session) == ["two"]


def test_that_a_unit_is_changed_afterwards_and_undo_goes_back(opening, monkeypatch, tmp_path):
    commands, session, _ = opening
    write_ball(tmp_path / "b" / "two.stl", 30.0)
    press("opening_add")
    commands.open_paths([tmp_path / "b" / "two.stl"], "um")
    session.select("two")
    before = size(session)
    assert before == pytest.approx(50_000.0, rel=0.1)
    monkeypatch.setattr(
        UnitDialog, "exec", lambda dialog: dialog.setValue("um") or QDialog.DialogCode.Accepted
    )
    commands.change_unit("one")
    assert names(session) == ["one", "two"]
    assert size(session) == pytest.approx(before / 1000.0, rel=1e-6)
    assert session.choices.selected == "two"
    commands.undo()
    assert size(session) == pytest.approx(before, rel=1e-6)
    assert session.choices.selected == "two"


def test_that_the_unit_of_a_particle_without_a_file_is_refused(opening):
    commands, session, window = opening
    session.adopt([Particle("drawn", icosphere(1))])
    commands.change_unit("drawn")
    assert "drawn was not read from a file" in window.findChild(Toast).sentence.text()


def test_that_one_dialog_lists_every_kind_of_file(opening, monkeypatch):
    asked = []
    monkeypatch.setattr(
        "regolith_studio.ui.commands.ask_for_files", lambda *given: asked.append(given[3]) or []
    )
    opening[0].open()
    first = asked[0].split(";;")[0]
    assert {"*.stl", "*.csv", "*.tif", "*.regolith", "*.json"} <= set(first.split("(")[1].rstrip(")").split())
