"""The page of the studies: figures 3, 7 and 8, live, and as files."""

import csv
import errno
import json
import re
from types import SimpleNamespace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from regolith_studio.errors import FileError
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.jobs.uncertainty_chain import Chain
from regolith_studio.session.choices import Choices
from regolith_studio.session.outputs.studies import write_studies
from regolith_studio.session.session import Session
from regolith_studio.session.study_requests import varied_rows
from regolith_studio.studies.loss_variants import PAPER_LOSSES, losses, paper_variants
from regolith_studio.studies.sweeps import best_row, sufficient_facets
from regolith_studio.studies.uncertainty import OUTPUTS, AngleBudget, ChainStep
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.pages.studies.budget import _angle_rows
from regolith_studio.ui.pages.studies.sweep import ROW_COLOURS, LossSelector
from regolith_studio.ui.result_card import ResultRecord, ResultState
from regolith_studio.ui.startup import MainThreadInvoker
from regolith_studio.ui.theme import DARK
from tests.jobs.test_uncertainty import ellipsoids

SECONDS = 170.0
ASKED = "regolith_studio.ui.dialogs.files.FolderDialog.ask"


def paper_names():
    """Those of Fig. 8, in the order of the menu."""
    return tuple(name for name in losses() if name in PAPER_LOSSES)


@pytest.fixture
def window(shown, preferences, settled, pictures_on_request):  # noqa: ARG001
    """A window on two ellipsoids, coarsened fast."""
    poster = MainThreadInvoker()
    choices = Choices(target="fit", method="quadric", n_facets=12, level=2, l_max=4)
    session = Session(ThreadRunner(poster.post), choices)
    session.adopt(ellipsoids(2))
    made = MainWindow(session, preferences, "image")
    poster.setParent(made)
    made.resize(1100, 720)
    settled(shown(made), SECONDS)
    return made


def test_that_the_gallery_fills_row_by_row_and_can_be_stopped(window, wait):
    page = window.go("studies")
    page.tabs.setCurrentWidget(page.gallery)
    window.menus.by_name["studies.run_shown"].trigger()
    wait(lambda: len(page.gallery.value()) == 2 * len(paper_variants()) and not window.session.tasks, SECONDS)
    table = page.gallery.table
    assert (table.rowCount(), table.columnCount()) == (1 + len(paper_variants()), 2)
    assert table.verticalHeaderItem(0).text() == "Particle"
    wait(lambda: table.item(0, 1) is not None and not table.item(0, 1).icon().isNull())
    for row in range(1, table.rowCount()):
        assert re.fullmatch(r"Jaccard \d+\.\d\s%", table.item(row, 0).text())
        assert not table.item(row, 0).icon().isNull()
    page.gallery.card.button.click()
    page.gallery.card.button.click()
    wait(lambda: not window.session.tasks, SECONDS)
    assert page.gallery.card.record.state is ResultState.STOPPED
    window.session.adopt([window.session.particles[0].particle])
    wait(lambda: page.gallery.card.record == ResultRecord())
    assert not page.gallery.value()


@pytest.mark.slow
def test_that_the_gallery_has_a_row_for_each_loss_that_is_chosen(window, wait, settled):
    page = window.go("studies")
    window.session.choose(method="annealing", settings=(("iterations", 2),))
    settled(window)
    menu = page.bar.menu
    page.bar.rows.click()
    wait(menu.isVisible)
    wait(menu.isVisible)
    for name in ("Quadric decimation (no loss)", "All descriptors", "Sphericity only"):
        action = next(each for each in menu.actions() if each.text() == name)
        QTest.mouseClick(menu, Qt.MouseButton.LeftButton, pos=menu.actionGeometry(action).center())
        assert menu.isVisible()  # more can be chosen
    menu.close()
    page.gallery.card.button.click()
    labels = [losses()[name].label for name in page.bar.names()]
    wait(lambda: len(page.gallery.value()) == 2 * len(labels), SECONDS)
    settled(window)
    shown_rows = [page.gallery.table.verticalHeaderItem(1 + r).text() for r in range(len(labels))]
    assert shown_rows == labels
    assert "Sphericity only" in labels
    assert "All descriptors" not in labels
    before = page.gallery.table.item(1, 0).icon().cacheKey()
    page.gallery.set_theme(DARK)
    assert page.gallery.table.item(1, 0).icon().cacheKey() != before


def test_that_one_loss_always_stays(shown):
    bar = shown(LossSelector())
    bar.set_names(["only_volume"])
    assert bar.rows.text().startswith("Volume only")
    bar._actions["only_volume"].trigger()
    assert bar.names() == ("only_volume",)
    bar.set_names(["no such loss"])
    assert bar.names() == paper_names()


def test_that_errors_against_facets_are_drawn_told_and_saved(window, wait, settled, tmp_path, monkeypatch):
    page = window.go("studies")
    page.tabs.setCurrentIndex(1)
    panel = page.variations["facets"]
    panel.values.setText("8, 12, 30")
    QTest.keyClick(panel.values, Qt.Key.Key_Return)
    wait(lambda: "facets" in page.sweeps.results and not window.session.tasks, SECONDS)
    settled(window)
    study = page.sweeps.results["facets"]
    volume = panel.part.series[0]
    assert volume.x == (8.0, 12.0, 30.0)
    assert volume.y == pytest.approx(100 * study.rmsre[:, 0])
    told = panel.part.value_at(panel.part.scene_position(12.0, volume.y[1]))
    assert told.startswith("V\nFacets: 12\n")
    enough = sufficient_facets(study)
    card = panel.card
    assert card.record.values == (str(enough) if enough < 30 else "–",)
    assert card.record.made_from == "2 particles"
    assert card.record.made_with == "Quadric decimation, n = 8 – 30, target: fit of degree 4, seed 0"
    panel.take.click()
    assert window.session.choices.n_facets == enough
    assert f"({volume.low[1]:.4g} to {volume.high[1]:.4g})" in told
    header, rows = panel.part.numbers()
    assert len(header) == len(rows[0]) == 7
    window.session.choose(seed=5)
    settled(window)
    assert card.record.state is ResultState.STALE
    assert card.button.text() == "Recompute"
    monkeypatch.setattr(ASKED, lambda *_: str(tmp_path))
    page.save()
    settled(window)
    assert {path.name for path in tmp_path.iterdir()} >= {
        "facets.csv",
        "facets.json",
        "facets.png",
        "facets.svg",
    }


@pytest.mark.slow
def test_that_the_gallery_is_saved_as_a_picture_and_as_numbers(window, wait, settled, monkeypatch, tmp_path):
    page = window.go("studies")
    page.gallery.card.button.click()
    wait(lambda: len(page.gallery.value()) == 2 * len(paper_variants()) and not window.session.tasks, SECONDS)
    monkeypatch.setattr(ASKED, lambda *_: str(tmp_path))
    page.save()
    settled(window)
    assert {f"solids.{end}" for end in ("csv", "json", "png", "svg")} <= {p.name for p in tmp_path.iterdir()}
    with (tmp_path / "solids.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert sorted(row["row"] for row in rows[::2]) == sorted(row.label for row in paper_variants())
    shown = next(each for each in page.gallery.value() if (each.row, each.column) == (0, 1))
    assert float(rows[1]["volume [%]"]) == pytest.approx(100 * shown.outcome.coarsened.errors["volume"])


def test_that_a_variation_can_be_stopped_and_another_is_refused_with_a_reason(window, settled):
    page = window.go("studies")
    page.variations["tradeoff"].card.button.click()
    assert "A baseline has no loss" in window.toast.sentence.text()
    page.variations["facets"].values.setText("12, many")
    page.sweeps.start("facets")
    assert "numbers with commas" in window.toast.sentence.text()
    page.variations["facets"].values.setText("12, 20")
    page.sweeps.start("facets")
    button = page.variations["facets"].card.button
    assert button.text() == "Stop"
    button.click()
    settled(window)
    assert button.text() in ("Compute", "Recompute")


def test_that_no_two_rows_of_the_trade_off_share_a_colour():
    rows = varied_rows("tradeoff", Choices(method="exact"), "1", with_compound=True)
    assert rows[-1].label == "Compound of convex parts"
    assert len(rows) <= len(set(ROW_COLOURS)) == len(ROW_COLOURS)


@pytest.mark.slow
def test_that_trade_and_sensitivity_follow_the_method(window, wait, settled):
    page = window.go("studies")
    window.session.choose(method="annealing", settings=(("iterations", 2),))
    settled(window)
    trade, change = page.variations["tradeoff"], page.variations["sensitivity"]
    assert trade.values.isVisibleTo(trade)
    page.bar.set_names(["all", "compound"])
    trade.values.setText("0, 2")
    change.values.setText("3")
    page.sweeps.start("tradeoff")
    page.sweeps.start("sensitivity")
    wait(
        lambda: set(page.sweeps.results) == {"tradeoff", "sensitivity"} and not window.session.tasks, SECONDS
    )
    settled(window)
    labels = ["Overlap × 0", "Overlap × 2", "Overlap only", "Compound of convex parts"]
    assert [series.label for series in trade.part.series] == labels
    table = change.part.table
    assert (table.rowCount(), table.columnCount()) == (7, 7)
    assert "percentage points" in table.item(0, 0).toolTip()
    window.session.choose(method="exact")
    settled(window)
    assert not trade.values.isVisibleTo(trade)
    window.session.adopt([window.session.particles[0].particle])
    settled(window)
    assert not page.sweeps.results
    assert table.rowCount() == 0


@pytest.mark.slow
def test_that_the_page_is_kept_with_the_project(window):
    page = window.go("studies")
    page.bar.set_names(["only_volume", "overlap"])
    page.bar.box.setCurrentIndex(1)
    page.variations["sensitivity"].values.setText("0, 9")
    kept = json.loads(json.dumps(page.state()))
    page.restore({"rows": "all", "box": 3, "values": {"facets": 8, "beauty": "1"}})  # of another version
    assert page.state() == kept
    page.bar.set_names([])
    page.bar.box.setCurrentIndex(0)
    page.variations["sensitivity"].values.setText("")
    page.restore(kept)
    assert page.state() == kept


@pytest.mark.slow
def test_that_both_studies_are_computed_and_saved(window, wait, settled, tmp_path, monkeypatch):
    page = window.go("studies")
    window.menus.by_name["studies.run_all"].trigger()
    wait(lambda: window.session.results.coarsening_study, SECONDS)
    settled(window, SECONDS)
    assert not page.lmax_study.plot.is_empty()
    assert len(page.coarsening_study.table.values()) == len(paper_variants())
    heads = page.coarsening_study.table.table.verticalHeaderItem
    marked = [row for row in range(len(paper_variants())) if heads(row).text().startswith("★")]
    assert marked == [best_row(window.session.results.coarsening_study)]
    folder = tmp_path / "files"
    folder.mkdir()
    monkeypatch.setattr(ASKED, lambda *_: str(folder))
    window.menus.by_name["studies.save"].trigger()
    wait(
        lambda: not window.session.tasks and "Tables and figures are in" in window.toast.sentence.text(),
        SECONDS,
    )
    suffixes = {path.suffix for path in folder.iterdir()}
    assert suffixes == {".csv", ".json", ".png", ".svg", ".txt", ".sha256"}
    card = page.coarsening_study.card.record
    title, origin, *_ = (folder / "coarsening_study.txt").read_text().splitlines()
    assert (title, origin) == ("Losses (Fig. 8)", f"{card.made_from}, {card.made_with}")
    assert "seed 0" in origin
    window.session.choose(n_facets=10)
    wait(lambda: page.coarsening_study.card.record.state is ResultState.STALE)
    window.menus.by_name["studies.save"].trigger()
    wait(
        lambda: not window.session.tasks and "Outdated: Losses (Fig. 8)" in window.toast.sentence.text(),
        SECONDS,
    )
    assert (folder / "coarsening_study.txt").read_text().splitlines()[1].startswith("Outdated: ")


def test_that_a_study_that_cannot_be_written_leaves_the_earlier_files(tmp_path, monkeypatch):
    def write(study, folder):
        (folder / "table.csv").write_text(study)
        if study == "new":
            raise OSError(errno.ENOSPC, "No space left on device")
        return (folder / "table.csv",)

    kind = SimpleNamespace(title="A study", write=write)
    monkeypatch.setattr("regolith_studio.session.outputs.studies.STUDIES", {"study": kind})
    list(write_studies((("study", "old"),), tmp_path / "out", {"study": "15 particles"}))
    with pytest.raises(FileError, match="the disk is full"):
        list(write_studies((("study", "new"),), tmp_path / "out"))
    assert (tmp_path / "out" / "table.csv").read_text() == "old"
    assert (tmp_path / "out" / "study.txt").read_text() == "15 particles"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


@pytest.mark.slow
def test_that_a_budget_of_uncertainty_is_made_in_a_folder_and_marked_when_choices_change(
    window, wait, tmp_path, monkeypatch
):
    panel = window.go("studies").budget
    monkeypatch.setattr(ASKED, lambda *_: str(tmp_path / "budget"))
    panel.card.button.click()
    wait(lambda: panel.card.record.state is ResultState.FAILED, SECONDS)
    assert panel.card.record.note.startswith("An interval needs 20 grains or more")
    window.session.adopt(ellipsoids(24))
    window.session.choose(target="particle")
    usual, quick = Chain._coarsening_choices, {"method": (("quadric", "quadric"), ("again", "quadric"))}
    monkeypatch.setattr(Chain, "_coarsening_choices", lambda chain: usual(chain) | quick)
    panel.points.setCurrentIndex(0)
    wait(lambda: not window.session.tasks, SECONDS)
    panel.card.button.click()
    wait(lambda: panel.card.record.state is ResultState.CURRENT, SECONDS)
    assert {each.suffix for each in (tmp_path / "budget").iterdir()} >= {".csv", ".json", ".png"}
    assert panel.card.record.made_from == "24 particles"
    panel.quantity.setCurrentIndex(OUTPUTS.index(("grains", "volume")))
    volume = np.mean([entry.particle.mesh.volume for entry in window.session.particles])
    assert float(panel.card.record.values[0].replace(",", "")) == pytest.approx(volume, rel=0.005)
    share = float(panel.table.rows.item(1, 3).text().split()[0])
    assert (panel.table.rows.item(1, 0).text(), share) == ("Number of facets", 0.0)
    window.session.choose(n_facets=20)
    wait(lambda: panel.card.record.state is ResultState.STALE)


def test_that_a_row_says_how_many_heaps_would_decide_a_change():
    nominal, shifts = np.array([30.0, 31.0, 29.0, 30.5]), np.array([1.0, -1.0, 1.0, -1.0])
    changed = {
        "large": nominal + 9.0 + 0.1 * shifts,
        "same": nominal,
        "no change": nominal + shifts,
        "small": nominal + 0.05 + shifts,
    }
    said = []
    for level, angles in changed.items():
        step = ChainStep("kept", "Kept", ("as set", level))
        said.append(_angle_rows(AngleBudget((step,), nominal, {("kept", level): angles}))[0][-1])
    assert said[:3] == ["99", "the same heaps", "more than 10,000 heaps would decide"]
    assert re.fullmatch(r"2,[01]\d\d heaps would decide", said[3])


def test_that_a_project_names_no_folder_in_which_a_budget_is_written(window, tmp_path):
    page, place = window.go("studies"), tmp_path / "elsewhere"
    state = {"budget": {"points": 4, "heaps": "many", "folder": str(place)}, "made": ["budget"]}
    page.restore(state)
    page.resume(state)
    assert not window.session.tasks
    assert page.budget.value() == {"points": 4, "heaps": 0}
    assert not place.exists()
