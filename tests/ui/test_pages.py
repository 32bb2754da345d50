"""The sidebar and its pages: found by themselves, built when visited, quiet while hidden."""

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QVBoxLayout, QWidget

from regolith_studio.errors import InputError
from regolith_studio.jobs.events import Job, Partial, Progress, Started
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.resources import resource
from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.page import ActionSpec, Page, PageContext, PageStack, PageWidget
from regolith_studio.ui.pages import PAGES
from regolith_studio.ui.theme import DARK
from regolith_studio.ui.widgets.toast import Toast


class _Counter(PageWidget):
    """A page that counts how often it is refreshed, and the numbers of a job."""

    def __init__(self, context):
        super().__init__()
        self.context, self.refreshed, self.heard, self.entries = context, 0, [], 0
        QVBoxLayout(self).addWidget(QLabel(context.key))
        context.bindings.refresh("dataset_folder", self._refresh)

    def _refresh(self):
        self.refreshed += 1

    def commands(self):
        return {"count": self.count}

    def count(self):
        job = Job(_numbers, (3,))
        self.context.start("Counting", job, self.heard.append, partial=self.heard.append)

    def on_show(self):
        self.entries += 1

    def set_theme(self, theme):
        self.theme = theme

    def busy(self):
        return "Something is written." if self.heard else ""


def _refused():
    yield Started("Fitting", 1)
    raise InputError("There is no fit.")


def _numbers(total):
    yield Started("Counting", total)
    for number in range(total):
        yield Partial(number)
        yield Progress(number + 1, total)
    return "done"


def _page(key, order):
    action = ActionSpec("count", "&Count")
    return Page(key, key.title(), "sample", order, "A page.", f"{__name__}:_Counter", (action,))


@pytest.fixture
def stack(shown, preferences):
    session = Session(InlineRunner())
    window = shown(QWidget())
    toast = Toast(window)
    toast.follow(session, Bindings(session, toast.problem, window))
    commands = Commands(session, preferences, toast, window)

    def context(key):
        bindings = Bindings(session, toast.problem, window)
        return PageContext(key, session, bindings, preferences, toast, commands, "image", lambda _key: window)

    made = PageStack((_page("one", 1), _page("two", 2)), context)
    made.setParent(window)
    made.session = session
    yield made
    made.close_pages()
    session.close()


def test_that_every_page_has_an_icon_a_tip_and_a_key_of_its_own():
    found = tuple(PAGES.values())
    assert found[0].key == "explore"
    assert len({page.key for page in found}) == len(found) == len({page.title for page in found})
    for page in found:
        assert resource("icons", f"{page.icon}.svg").exists()
        assert page.tip
        names = [each.name for each in page.actions if each.text]
        assert len(set(names)) == len(names)


def test_that_a_page_is_built_at_its_first_visit_and_kept(stack):
    assert not stack.widgets
    first = stack.go("one")
    assert list(stack.widgets) == ["one"]
    QTest.mouseClick(stack.buttons["two"], Qt.MouseButton.LeftButton)
    assert stack.current == "two"
    assert stack.go("one") is first
    assert first.entries == 2


def test_that_a_hidden_page_is_refreshed_when_it_is_seen_again(stack, wait):
    one = stack.go("one")
    assert one.refreshed == 1
    stack.go("two")
    for number in range(5):
        stack.session.dataset_folder = Path(str(number))
    QTest.qWait(100)
    assert one.refreshed == 1
    stack.go("one")
    wait(lambda: one.refreshed == 2)
    QTest.qWait(60)
    assert one.refreshed == 2


class _Holder(PageWidget):
    """A page that keeps what the session holds."""

    def __init__(self, context):
        super().__init__()
        self.context, self.held = context, None
        context.bindings.refresh("dataset_folder", self._hold, keeps_particles=True)

    def _hold(self):
        self.held = self.context.session.dataset_folder


@pytest.mark.parametrize("slow", [False, True])
def test_that_a_hidden_page_lets_go_what_is_not_open_any_more(stack, slow):
    stack.pages["one"] = replace(stack.pages["one"], make=f"{__name__}:_Holder")
    one = stack.go("one")
    one.context.bindings.refresh("dataset_folder", one._hold, slow=slow, keeps_particles=True)
    stack.session.dataset_folder = Path("old")
    stack.go("two")
    stack.go("one")
    stack.go("two")
    stack.session.dataset_folder = Path("new")
    assert one.held != Path("new")
    stack.refresh_hidden()
    assert one.held == Path("new")
    one.held = "untouched"
    stack.refresh_hidden()
    assert one.held == "untouched"


def test_that_a_command_of_a_hidden_page_shows_it_first(stack):
    stack.go("two")
    stack.run("one", "count")
    assert stack.current == "one"
    assert stack.widgets["one"].heard == [0, 1, 2, "done"]
    assert stack.busy() == ["Something is written."]


def test_that_the_neighbours_of_a_page_go_round(stack):
    stack.go("one")
    stack.neighbour(1)
    assert stack.current == "two"
    stack.neighbour(1)
    assert stack.current == "one"


def test_that_hidden_pages_take_a_theme_when_they_are_seen(stack, monkeypatch):
    one, two = stack.go("one"), stack.go("two")
    monkeypatch.setattr("regolith_studio.ui.page.current_theme", lambda: DARK)
    before = one.theme
    stack.set_theme(DARK)
    assert two.theme is DARK
    assert one.theme is before
    stack.go("one")
    assert one.theme is DARK


class _Broken(PageWidget):
    """A page that cannot be built at first."""

    def __init__(self, context):  # noqa: ARG002
        super().__init__()

    def build(self):
        raise OSError("nothing there")


def test_that_a_page_that_cannot_be_built_is_built_at_the_next_visit(stack):
    page = stack.pages["two"]
    stack.pages["two"] = replace(page, make=f"{__name__}:_Broken")
    stack.go("one")
    with pytest.raises(OSError, match="nothing there"):
        stack.go("two")
    assert stack.current == "one"
    stack.pages["two"] = page
    assert stack.go("two").entries == 1


def test_that_what_a_page_remembers_is_kept_apart_from_the_others(stack, preferences):
    one, two = stack.go("one").context, stack.go("two").context
    one.remember("split", [1, 2])
    assert two.recall("split", "nothing") == "nothing"
    assert one.recall("split") == [1, 2]
    assert preferences.window == {"page.one": {"split": [1, 2]}}


def test_that_the_message_of_a_failure_goes_when_the_next_run_of_its_kind_begins(stack):
    context = stack.go("one").context
    fail = Job(_refused)
    context.start(
        "Fitting", fail, print, failed=lambda failure: context.toast.problem(failure.sentence), queue="fit"
    )
    assert context.toast.isVisible()
    context.start("Drawing", Job(_numbers, (3,)), print, queue="draw")
    assert context.toast.isVisible(), "it is about something else"
    seen = []
    context.start(
        "Fitting",
        Job(_numbers, (1,)),
        print,
        lambda _part: seen.append(context.toast.isVisible()),
        queue="fit",
    )
    assert seen == [False]
    context.toast.problem("There are no particles.")
    context.start("Fitting", Job(_numbers, (1,)), print, queue="fit")
    assert context.toast.isVisible(), "not of a task"
