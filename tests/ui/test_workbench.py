"""What makes the window a workbench: palette, projects, recovery, tasks, log, tour, layout, closing."""

import os
import threading
from datetime import datetime

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox, QPushButton, QScrollArea, QSplitter, QWidget

from regolith_studio.jobs.events import Job, Progress
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.project import Project
from regolith_studio.session.session import Session
from regolith_studio.session.tasks import Task
from regolith_studio.ui.actions import CommandPalette
from regolith_studio.ui.activity import TaskListPanel
from regolith_studio.ui.dialogs.help import TOUR_SEEN, Tour, start_tour, steps
from regolith_studio.ui.keyboard import plain
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.pages.explore.page import ParticleListPanel
from regolith_studio.ui.pages.lecture.page import LESSONS
from regolith_studio.ui.project_files import autosave_path, needs_confirmation, stale_autosaves
from regolith_studio.ui.result_card import ResultState, time_left
from regolith_studio.ui.startup import FILLED_CHECK, open_window, show_recovery_and_tour

SECONDS = 120.0


def wait_for_ever():
    while True:
        yield Progress(0, 0)


@pytest.fixture
def window(sample_window):
    return sample_window(1200, 760)


@pytest.fixture
def bare(shown, preferences):
    """A window without particles, which computes nothing."""
    return shown(MainWindow(Session(InlineRunner()), preferences, "image"))


def answer(name):
    """Press the button of this object name as soon as it is seen."""

    def look():
        for box in QApplication.topLevelWidgets():
            button = box.findChild(QPushButton, name) if box.isVisible() else None
            if button is not None:
                timer.stop()
                button.click()
                return

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(20)
    return timer


@pytest.mark.slow
def test_that_the_palette_finds_commands_of_the_window_and_of_hidden_pages(window, wait):
    window.menus.by_name["palette"].trigger()
    palette = window.findChild(CommandPalette)
    QTest.keyClicks(palette.line, "sample export")
    assert palette.list.item(0).text().startswith("Sample: Export table")
    palette.line.clear()
    QTest.keyClicks(palette.line, "theme dark")
    assert palette.list.count() == 1
    palette.line.clear()
    QTest.keyClicks(palette.line, "go sample")
    QTest.keyClick(palette.line, Qt.Key.Key_Return)
    wait(lambda: window.pages.current == "sample", 5.0)
    wait(lambda: window.findChild(CommandPalette) is None)


def test_that_every_command_has_a_tip_keys_of_its_own_and_a_row_in_the_palette(bare):
    listed = [command.title for command in bare.menus.palette(bare.pages.pages, bare.pages.run)]
    assert len(listed) == len(set(listed))
    for key, page in bare.pages.pages.items():
        for row in page.actions:
            if row.text:
                assert f"{page.title}: {plain(bare.menus.by_name[f'{key}.{row.name}'])}" in listed
    assert {"Lecture: Play or pause", "Lecture: Step forward", "Lecture: Full screen"} <= set(listed)
    owners = {}
    for name, action in bare.menus.by_name.items():
        assert action.toolTip(), name
        page = name.split(".")[0] if "." in name and not name.startswith("go.") else ""
        if keys := action.shortcut().toString():
            taken = owners.setdefault(keys, [])
            assert not ({page, ""}.intersection(taken) if page else taken), name
            taken.append(page)


def test_that_a_project_is_saved_and_brought_back(window, wait, tmp_path, monkeypatch):
    target = tmp_path / "work.regolith"
    monkeypatch.setattr(
        "regolith_studio.ui.project_files.QFileDialog.getSaveFileName", lambda *_: (str(target), "")
    )
    window.session.choose(selected="flat-1", n_facets=14, l_max=6)
    window.go("sample").filter.setText("flat")
    window.menus.by_name["save_project"].trigger()
    assert not window.projects.modified
    assert window.windowTitle().startswith("work – ")
    window.session.choose(selected="flat-2")
    for key in ("explore", "dataset", "studies"):
        window.go(key)
    assert not window.projects.modified, "looking at other pages and particles changes nothing"
    window.session.choose(selected="flat-1")
    window.go("sample")
    window.session.choose(n_facets=30)
    assert window.projects.modified
    assert window.windowTitle().startswith("work * – ")
    assert needs_confirmation((), window.projects.unsaved()) == [
        "work.regolith has changes that are not saved."
    ]
    window.go("sample").filter.clear()
    window.go("explore")
    window.commands.open_paths([target])
    wait(lambda: window.session.choices.selected == "flat-1" and not window.projects.modified, SECONDS)
    assert (window.session.choices.n_facets, window.session.choices.l_max) == (14, 6)
    assert window.pages.current == "sample"
    assert window.page.filter.text() == "flat"
    assert window.preferences.recent[0] == str(target)


@pytest.mark.slow
def test_that_results_which_a_project_makes_again_are_no_changes(window, wait, tmp_path):
    """The representatives of a dataset, which the project does not hold, are found again."""
    target = tmp_path / "work.regolith"
    window.go("dataset").find_representatives()
    wait(lambda: window.page.state()["made"] and not window.session.tasks, SECONDS)
    assert window.projects._write(target)
    window.page._survey = None
    seen = []
    window.projects.changed.connect(lambda: seen.append(window.projects.modified))
    window.commands.open_paths([target])
    wait(lambda: window.projects._remaking, SECONDS)
    wait(lambda: not window.projects._remaking, SECONDS)
    assert window.page.state()["made"]
    assert not any(seen)
    window.session.choose(n_facets=31)
    assert window.projects.modified
    wait(lambda: not window.session.tasks, SECONDS)


def test_that_what_another_window_has_saved_is_not_replaced_without_asking(bare, tmp_path, monkeypatch):
    target = tmp_path / "work.regolith"
    asked, answers = [], [QMessageBox.StandardButton.No, QMessageBox.StandardButton.Yes]

    def answer_next(box):
        asked.append(box.text())
        return answers.pop(0).value

    monkeypatch.setattr(QMessageBox, "exec", answer_next)
    monkeypatch.setattr(
        "regolith_studio.ui.project_files.QFileDialog.getSaveFileName", lambda *_: (str(target), "")
    )
    assert bare.projects.save()
    assert bare.projects.save()
    assert not asked, "nobody else has saved it"
    target.write_text("saved by another window")
    bare.session.choose(n_facets=15)
    assert not bare.projects.save()
    assert target.read_text() == "saved by another window"
    assert bare.projects.modified
    assert bare.projects.save()
    assert '"n_facets": 15' in target.read_text()
    assert asked == 2 * [
        "work.regolith has changed on the disk since this window opened or saved it. Replace it?"
    ]


@pytest.mark.skipif(os.name == "nt", reason="the limit of file sizes is one of POSIX")
def test_that_what_cannot_be_written_leaves_the_earlier_project_and_no_export(
    window, wait, tmp_path, monkeypatch
):
    import resource

    target = tmp_path / "work.regolith"
    monkeypatch.setattr(
        "regolith_studio.ui.project_files.QFileDialog.getSaveFileName", lambda *_: (str(target), "")
    )
    assert window.projects.save()
    kept, limits = target.read_bytes(), resource.getrlimit(resource.RLIMIT_FSIZE)
    window.session.choose(method="quadric", n_facets=15)
    window.menus.by_name["export"].trigger()
    window.page.representatives.which.setCurrentIndex(1)
    resource.setrlimit(resource.RLIMIT_FSIZE, (200, limits[1]))
    try:
        saved = window.projects.save()
        said = window.toast.sentence.text()
        window.page.build_in(tmp_path / "dataset")
        wait(lambda: window.page.result.record.state is ResultState.FAILED, SECONDS)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert not saved
    assert said.startswith(f"The file {target} cannot be written")
    assert f"{tmp_path / 'dataset'} cannot be written" in window.toast.sentence.text()
    left = [path for path in tmp_path.iterdir() if path.name != "config"]
    assert [(path.name, path.read_bytes()) for path in left] == [(target.name, kept)]


def test_that_a_project_whose_name_was_completed_replaces_none_without_asking(bare, tmp_path, monkeypatch):
    other = tmp_path / "sample 1.5.regolith"
    other.write_text("of yesterday")
    monkeypatch.setattr(
        "regolith_studio.ui.project_files.QFileDialog.getSaveFileName",
        lambda *_: (str(tmp_path / "sample 1.5"), ""),
    )
    monkeypatch.setattr(QMessageBox, "exec", lambda _: QMessageBox.StandardButton.No.value)
    assert not bare.projects.save_as()
    assert other.read_text() == "of yesterday"
    other.unlink()
    assert bare.projects.save_as()
    assert [path.name for path in tmp_path.glob("sample*")] == ["sample 1.5.regolith"]


def test_that_a_crash_leaves_a_state_that_can_be_brought_back(window, wait):
    window.session.choose(n_facets=13)
    window.projects._autosave()
    assert autosave_path().exists()
    assert stale_autosaves() == []  # this process lives
    left = autosave_path().with_name("autosave-999999999.regolith")
    left.write_text(Project.of(window.session).model_dump_json())
    assert stale_autosaves() == [left]
    os.utime(left, (moment := datetime(2026, 3, 9, 7, 5).astimezone().timestamp(), moment))
    window.session.choose(n_facets=40)
    window.projects.offer_recovery()
    box = window.findChild(QMessageBox, "recovery")
    assert box.informativeText() == "It was saved at 2026-03-09 07:05."
    box.button(QMessageBox.StandardButton.Yes).click()
    assert window.session.choices.n_facets == 13
    window.projects._timer.setInterval(0)
    wait(lambda: not left.exists(), SECONDS)
    wait(lambda: not window.session.tasks, SECONDS)


@pytest.mark.slow
def test_that_a_proper_close_leaves_nothing_to_bring_back(window):
    window.projects._autosave()
    window.close()
    assert not list(autosave_path().parent.glob("autosave-*"))


@pytest.mark.slow
def test_that_every_stop_of_the_tour_shows_something_that_is_there(window):
    tour = start_tour(window, window.go, window.preferences)
    for number, step in enumerate(steps()):
        assert tour.at == number
        assert window.pages.current == step.page
        target, seen = window.findChild(QWidget, step.target), tour.target()
        assert target is not None, step.target
        assert seen is not None, step.target
        assert seen is target or (seen.isAncestorOf(target) and not target.isVisible()), step.target
        assert window.rect().contains(tour._bubble.geometry()), step.title
        tour.next.click()
    assert window.preferences.window[TOUR_SEEN] is True
    assert not tour.isVisible()
    assert {step.page for step in steps()} == {"explore", "sample", "lecture"}
    assert len(steps()) == 11
    assert "the shipped ones are synthetic" in steps()[0].text


@pytest.mark.slow
def test_that_the_shipped_particles_are_called_synthetic_where_they_are_shown(window, settled):
    name = window.session.selected.id
    assert window.findChild(ParticleListPanel).title.text() == "Synthetic particles (12)"
    assert window.page.three_views.frames["particle"].title == name
    sample = window.go("sample")
    settled(window)
    assert sample.frame.title == name
    lecture = window.go("lecture")
    lecture.tabs.setCurrentIndex(LESSONS.index("degrees"))
    settled(window)
    assert lecture.degrees.frames["particle"].title == name


@pytest.mark.slow
def test_that_escape_ends_the_tour(window):
    tour = start_tour(window, window.go, window.preferences)
    QTest.keyClick(tour.next, Qt.Key.Key_Escape)
    assert not tour.isVisible()
    assert all(not each.isVisible() for each in window.findChildren(Tour))


@pytest.mark.slow
def test_that_the_log_keeps_what_was_said_with_its_details(window):
    window.menus.by_name["log"].trigger()
    assert window.activity.isVisible()
    window.toast.problem("The grain is too shy.", "because of\nstage fright")
    text = window.activity.log.text.toPlainText()
    assert "The grain is too shy." in text
    assert "stage fright" in text
    window.activity.log.copy.click()
    assert "stage fright" in QApplication.clipboard().text()
    window.menus.by_name["log"].trigger()
    assert not window.activity.isVisible()


def test_that_tasks_are_listed_and_can_be_stopped_one_by_one(shown):
    panel, asked = shown(TaskListPanel()), []
    panel.cancelRequested.connect(asked.append)
    panel.show_tasks([Task(3, "a", "Reading", 1, 4, "x.stl"), Task(5, "b", "Building", 0, 0)])
    panel.findChild(QPushButton, "stop_task_5").click()
    assert asked == [5]
    assert not panel.idle.isVisible()
    panel.show_tasks([])
    assert panel.idle.isVisible()


@pytest.mark.slow
def test_that_a_task_is_held_back_and_goes_on_from_the_list(window, wait):
    window.menus.by_name["tasks"].trigger()
    panel, session, over = window.activity.tasks, window.session, []

    def count(n):
        for number in range(n):
            allowed.acquire(timeout=SECONDS)
            yield Progress(number + 1, n)
        return n

    allowed = threading.Semaphore(1)
    number = session.run("export", "Counting", Job(count, (3,)), over.append)
    wait(lambda: any(task.done == 1 for task in session.tasks))
    wait(lambda: panel.findChild(QPushButton, f"pause_task_{number}") is not None)
    button = panel.findChild(QPushButton, f"pause_task_{number}")
    button.click()
    assert [task.paused for task in session.tasks] == [True]
    wait(lambda: button.text() == "Resume")
    allowed.release(2)
    button.click()
    wait(lambda: over == [3])
    wait(lambda: panel.findChild(QPushButton, f"pause_task_{number}") is None)


@pytest.mark.slow
def test_that_a_task_that_is_held_back_can_be_left(window):
    session = window.session
    number = session.run("export", "Counting", Job(wait_for_ever), lambda _value: None)
    session.pause(number)
    timer = answer("closing_leave")
    assert window.close()
    timer.stop()


@pytest.mark.parametrize(
    ("done", "total", "seconds", "words"),
    [(0, 10, 5.0, ""), (5, 10, 5.0, "about 5 s left"), (1, 10, 60.0, "about 9 min left"), (10, 10, 5.0, ""),
     (1, 100, 0.4, ""), (1, 101, 72.0, "about 2.0 h left")],
)  # fmt: skip
def test_that_the_time_left_follows_from_the_time_gone(done, total, seconds, words):
    assert time_left(done, total, seconds) == words


@pytest.mark.slow
def test_that_the_borders_between_parts_are_remembered(window, shown, wait):
    columns = window.page.findChild(QSplitter, "explore_columns")
    total = sum(columns.sizes())
    columns.setSizes([total * 3 // 5, total - total * 3 // 5])
    columns.splitterMoved.emit(total * 3 // 5, 1)
    wanted = columns.sizes()
    window.close()
    kept = Preferences.load()
    again = shown(open_window(views="image", preferences=kept))
    again.resize(window.size())
    wait(lambda: again.size() == window.size())
    found = again.page.findChild(QSplitter, "explore_columns").sizes()
    assert all(abs(one - other) <= 8 for one, other in zip(found, wanted, strict=True))


@pytest.mark.slow
def test_that_the_standard_layout_acts_at_once_and_stays(window, monkeypatch):
    monkeypatch.setattr(window, "resize", lambda *_: None)  # to what a screen for tests has room for
    columns = window.findChild(QSplitter, "explore_columns")
    window.window_state.restore_standard(window)
    standard = columns.sizes()
    columns.setSizes([700, 600])
    columns.splitterMoved.emit(700, 1)
    assert columns.sizes() != standard
    window.window_state.keep(window)
    window.menus.by_name["standard_layout"].trigger()
    assert columns.sizes() == standard


@pytest.mark.slow
def test_that_opened_particles_are_reached_by_the_arrows_at_once(window, wait):
    table, particles = window.page.particles.table, window.session.particles
    before = window.page.loss.sliders["min_diameter"].slider, window.pages.buttons["explore"]
    for count, part in enumerate(before, start=1):
        part.setFocus()
        window.session.adopt([entry.particle for entry in particles[:count]])
        wait(lambda: window.focusWidget() is table, SECONDS)
    assert window.session.choices.weights["min_diameter"] == 1.0


@pytest.mark.slow
def test_that_closing_asks_while_a_study_runs(window):
    window.session.start_study("lmax_study")
    assert needs_confirmation(window.session.tasks, [])
    timer = answer("closing_stay")
    assert not window.close()
    timer.stop()
    assert window.isVisible()
    assert (
        any(task.queue == "lmax_study" for task in window.session.tasks) or window.session.results.lmax_study
    )
    timer = answer("closing_leave")
    if window.session.tasks:
        assert window.close()
    timer.stop()


def test_that_closing_does_not_ask_about_work_that_repeats_itself():
    repeating = Task(1, "explore:distances", "Measuring distances", repeats=True)
    assert needs_confirmation([repeating], []) == []
    builds = [Task(number, queue, "Building the dataset") for number, queue in ((2, "export"), (3, "build"))]
    assert needs_confirmation([repeating, *builds], ["A run is not saved."]) == [
        "Building the dataset is running.",
        "A run is not saved.",
    ]


def test_that_rows_of_many_tasks_keep_their_height(shown, wait):
    panel = shown(TaskListPanel())
    panel.resize(700, 90)
    panel.show_tasks([Task(number, f"queue {number}", "Counting grains", 1, 9) for number in range(8)])
    buttons = [panel.findChild(QPushButton, f"stop_task_{number}") for number in range(8)]
    wait(lambda: panel.findChild(QScrollArea).verticalScrollBar().maximum() > 0)
    wait(lambda: all(button.height() >= button.sizeHint().height() for button in buttons))


def test_that_what_is_done_can_be_copied_as_command_and_as_python(window):
    window.menus.by_name["copy_command"].trigger()
    assert QApplication.clipboard().text().startswith("regolith-studio coarsen sample:all")
    window.menus.by_name["copy_python"].trigger()
    compile(QApplication.clipboard().text(), "copied", "exec")


@pytest.mark.slow
def test_that_the_tour_does_not_take_its_user_away_from_another_page(shown, preferences, wait, settled):
    window = shown(open_window(views="image", preferences=preferences))
    window.go("scan")
    show_recovery_and_tour(window)
    wait(lambda: window.session.results.polyhedron is not None, 120.0)
    settled(window, 120.0)
    QTest.qWait(2 * FILLED_CHECK)
    assert window.pages.current == "scan"
    assert not window.findChildren(Tour)
