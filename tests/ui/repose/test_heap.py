"""The heap of the page "Angle of repose": its angle, its sections and its three-dimensional view."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QDialog, QFileDialog, QWidget

from benchmarks.heaps import surface_of_revolution
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.evaluation.profile import Discs
from regolith_studio.dem.snapshot import ParticleState, particle_state_bytes
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.scene import instancing
from regolith_studio.scene.cameras import orbited
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.pages.repose.heap import MANY_DISCS, drawn_discs, particle_text
from regolith_studio.ui.pages.repose.player import BALLS, PositionsDialog, RunPlayer, read_pile, restored_heap
from tests.ui.repose.conftest import import_positions, pile_of


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
    wait(lambda: page.sections.plot.section is not None)
    assert page._measured.angle == pytest.approx(30.0, abs=2.0)
    assert page.angle.button.text() == "Use the open particles"  # the heap of a file cannot run again
    before = page._measured
    assert page.angle.figures[0].text() == f"{page._measured.angle:.1f}°"
    cut = page.sections.plot.cut("high")
    cut.setValue(0.7 * 1e3 * page.sections.plot.section.profile.top)
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
    wait(lambda: page.sections.plot.section is not None)
    plot, section = page.sections.plot, page.sections.plot.section
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
    ) == (f"particle 1: 2 mm at {1e3 * x:.3g}, {1e3 * high:.3g} mm")
    assert plot.value_at(plot.canvas.getViewBox().mapViewToScene(QPointF(1e3 * x, 1e3 * high))).startswith(
        "particle "
    )
    assert plot.value_at(plot.canvas.getViewBox().mapViewToScene(QPointF(0.0, 1e6))) == ""
    columns, rows = plot.numbers()
    assert columns[0] == "x [mm]"
    assert sum(row[2] == "yes" for row in rows) == section.used.sum()


@pytest.mark.parametrize(
    ("head", "columns", "fields"),
    [
        ("x,y,z,diameter", 4, {"positions_unit": "mm"}),
        ("x_mm,y_mm,z_mm,r_mm", 4, {}),
        ("x_mm,y_mm,z_mm", 3, {"positions_diameter": 2.0}),
        ("a,b,c,d", 4, {"positions_columns": "x y z d", "positions_unit": "mm"}),
    ],
    ids=str,
)
def test_that_one_dialog_asks_only_what_a_table_does_not_state(
    shown, tmp_path, monkeypatch, head, columns, fields
):
    pile = pile_of(35.0)
    path = tmp_path / "pile.csv"
    sizes = pile.diameters * (0.5 if "r_mm" in head else 1.0)
    table = 1e3 * np.column_stack([pile.points, sizes])[:, :columns]
    np.savetxt(path, table, delimiter=",", header=head, comments="")
    asked = []

    def answer(dialog):
        names = ("positions_unit", "positions_columns", "positions_diameter")
        asked.append({name for name in names if dialog.findChild(QWidget, name).isVisibleTo(dialog)})
        if "positions_columns" in fields:
            dialog.columns.setText(fields["positions_columns"])
            dialog.unit.choose("mm")
            assert not dialog.diameter.isEnabled(), "a column is the diameter"
        elif "positions_unit" in fields:
            assert "would extend over" in dialog.size_note.text(), "millimetres are suggested by the width"
        dialog.diameter.setValue(fields.get("positions_diameter", 1.0))
        return QDialog.DialogCode.Accepted

    monkeypatch.setattr(PositionsDialog, "exec", answer)
    heap, read, _ = read_pile(shown(QWidget()), path)
    extra = {"positions_diameter"} if "positions_columns" in fields else set()
    assert asked == ([set(fields) | extra] if fields else [])
    _, again = restored_heap(json.loads(json.dumps(asdict(heap))))
    for found in (read, again):  # what was answered is kept with the project
        np.testing.assert_allclose(found.points, pile.points, atol=1e-9)
        assert found.diameters == pytest.approx(2e-3)


def test_that_a_project_says_when_its_positions_have_changed_or_moved(page, tmp_path, wait, monkeypatch):
    path, notes = tmp_path / "pile.npz", []
    path.write_bytes(particle_state_bytes(pile_of(35.0)))
    page.open_path(path)
    wait(lambda: page._measured is not None)
    state = page.state()
    path.write_bytes(particle_state_bytes(pile_of(30.0)))
    monkeypatch.setattr(page._context.toast, "problem", notes.append)
    page.restore(state)
    wait(lambda: page._measured is not None)
    assert notes == [f"{path} is not the file that was shown when the project was saved."]
    path.unlink()
    page.restore(state)
    assert page.state()["imported"] is None
    assert str(path) in page.angle.sentence.text()
    page.restore(state | {"imported": {"file": 3}})
    assert "file" in page.angle.sentence.text()


def test_that_a_pending_preview_does_not_take_the_place_of_an_opened_heap(page, tmp_path, wait):
    path = tmp_path / "pile.npz"
    path.write_bytes(particle_state_bytes(pile_of(35.0)))
    page._later.start()
    page.open_path(path)
    assert not page._later.isActive()
    wait(lambda: page._measured is not None)
    assert page._measured.angle == pytest.approx(35.0, abs=2.0)


def test_that_what_is_no_pile_says_so(page, tmp_path, monkeypatch, wait):
    flat = pile_of(30.0)
    path = tmp_path / "flat.npz"
    path.write_bytes(particle_state_bytes(replace(flat, points=flat.points * [3.0, 3.0, 0.0] + [0, 0, 1e-3])))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    page.open_positions()
    wait(lambda: "No angle" in page.angle.sentence.text())
    assert page.sections.plot.section is None
    assert max(height for _, height, _ in page.sections.plot.numbers()[1]) == pytest.approx(2.0, rel=0.2)
    page.export_run()
    assert "no measured heap" in page._context.toast.sentence.text()


def test_that_a_large_heap_is_drawn_coarsely_while_the_view_turns(page, monkeypatch, wait):
    def drawn():
        actors = page.player.frame.view._plotter.actors
        return [name for name in ("heap", "coarse_heap") if name in actors and actors[name].GetVisibility()]

    page.player.set_scene(BALLS, False, LiftingCylinderTest())
    page.player.show_moment(pile_of(30.0), "heap")
    turned = orbited(page.player.frame.view.pose, 0.1, 0.0)
    page.player.frame.view._move(turned)
    assert drawn() == ["heap"], "700 particles turn as they are"
    monkeypatch.setattr(instancing, "MANY_TRIANGLES", 10_000)
    page.player.frame.view._move(turned)
    assert drawn() == ["coarse_heap"]
    wait(lambda: drawn() == ["heap"])


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


def test_that_a_concave_heap_keeps_its_section_and_both_angles(page, tmp_path, monkeypatch, wait):
    points, sizes = surface_of_revolution(1500, 3, 10.0, 10.0, "exponential")
    still, zeros = np.tile([1.0, 0, 0, 0], (len(points), 1)), np.zeros(len(points), dtype=int)
    pile = ParticleState(1e-3 * points, 1e-3 * np.broadcast_to(sizes, len(points)), still, zeros)
    import_positions(page, monkeypatch, tmp_path, pile)
    wait(lambda: page.angle.captions[1].text() == "Flanks: top | toe")
    assert page.angle.figures[0].text() == "–"
    top, toe = (float(each.strip("° ")) for each in page.angle.figures[1].text().split("|"))
    assert top > 45.0 > toe
    assert "no single angle" in page.angle.sentence.text()
    assert page.sections.azimuth.count() == 12
    assert page.sections.plot.section is not None
    page.sections.azimuth.setCurrentIndex(1)
    assert page.sections.plot.numbers()[0][0] == "y [mm]"


@pytest.mark.slow
def test_that_the_plate_is_at_the_bottom_of_a_section_of_any_size(page, tmp_path, monkeypatch, wait, app):
    import_positions(page, monkeypatch, tmp_path, pile_of(30.0))
    wait(lambda: page._measured is not None)
    for size in ((1200, 800), (900, 1000), (1600, 700)):
        page.resize(*size)
        app.processEvents()
        (left, right), (low, high) = page.sections.plot.canvas.getViewBox().viewRange()
        box = page.sections.plot.canvas.getViewBox()
        assert -0.05 * (high - low) < low < 0.0
        assert (right - left) / box.width() == pytest.approx((high - low) / box.height(), rel=1e-3)
