"""The page of the studies: figures 3, 7 and 8, live, and as files."""

import pytest

from regolith_studio.session.solids import row_labels
from regolith_studio.ui.app import open_window

SECONDS = 170.0
ASKED = "regolith_studio.ui.pages.studies.page.QFileDialog.getExistingDirectory"


@pytest.fixture
def window(shown, preferences, wait):
    made = open_window(views="image", preferences=preferences)
    made.resize(1100, 720)
    shown(made)
    wait(lambda: made.session.results.coarsened is not None and not made.session.tasks, SECONDS)
    made.session.adopt([entry.particle for entry in made.session.particles[:2]])
    made.session.choose(method="quadric", n_faces=12, level=2, l_max=4)
    wait(lambda: not made.session.tasks, SECONDS)
    return made


def test_that_the_gallery_fills_row_by_row_and_can_be_stopped(window, wait):
    page = window.go("studies")
    page.gallery.frame.start.click()
    wait(lambda: len(page.gallery.value()) == 2 * len(row_labels()) and not window.session.tasks, SECONDS)
    table = page.gallery.table
    assert (table.rowCount(), table.columnCount()) == (len(row_labels()), 2)
    for row in range(table.rowCount()):
        assert table.item(row, 0).text().startswith("J 0.")
        assert not table.item(row, 0).icon().isNull()
    page.gallery.frame.start.click()
    window.session.cancel(window.session.tasks[-1].id)
    wait(lambda: not window.session.tasks, SECONDS)


@pytest.mark.slow
def test_that_both_studies_are_computed_and_saved(window, wait, settled, tmp_path, monkeypatch):
    page = window.go("studies")
    window.menus.by_name["studies.run_all"].trigger()
    wait(lambda: window.session.results.coarsening_study, SECONDS)
    settled(window)
    assert not page.lmax_study.plot.is_empty()
    assert len(page.coarsening_study.table.values()) == len(row_labels())
    monkeypatch.setattr(ASKED, lambda *_: str(tmp_path))
    window.menus.by_name["studies.save"].trigger()
    wait(lambda: not window.session.tasks and "files were written" in window.toast.sentence.text(), SECONDS)
    assert {path.suffix for path in tmp_path.iterdir()} == {".csv", ".json", ".png", ".svg"}


def test_that_saving_before_computing_is_told(window):
    window.go("studies").save()
    assert window.toast.sentence.text() == "Compute a study first."
