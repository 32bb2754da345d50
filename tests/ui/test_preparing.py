"""Pages are prepared in the background: one when it may be wanted next, all when one has been visited."""

import threading
import time
from functools import partial
from unittest.mock import Mock

import pytest
from PySide6.QtCore import QPointF
from PySide6.QtGui import QEnterEvent
from PySide6.QtWidgets import QApplication

from regolith_studio.jobs.runners.inline import InlineRunner
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.ui.page import Page, PageWidget
from regolith_studio.ui.page_stack import PageStack
from regolith_studio.ui.pages import PAGES
from regolith_studio.ui.posting import Poster
from regolith_studio.ui.preparing import PAUSE, Preparing


def build(_context):
    return PageWidget()


@pytest.fixture
def prepared():
    """Keys of pages, in the order in which they have been prepared."""
    return []


@pytest.fixture
def stack(shown, prepared):
    def page(key):
        return Page(key, key, "sample", 1, key, build, prepare=lambda: prepared.append(key))

    made = PageStack(tuple(page(key) for key in "abcd"), lambda _key: Mock())
    made.go("a")
    Preparing(made, InlineRunner())
    return shown(made)


def test_that_nothing_is_prepared_until_somebody_comes_near(stack, prepared):
    assert prepared == []
    place = QPointF(4, 4)
    QApplication.sendEvent(stack.buttons["c"], QEnterEvent(place, place, place))
    assert prepared == ["c"]


def test_that_the_page_that_somebody_comes_near_is_built_but_not_shown(stack, wait):
    stack.approached.emit("c")
    wait(lambda: "c" in stack.widgets)
    assert set(stack.widgets) == {"a", "c"}
    assert stack.current == "a"


def test_that_a_page_that_nobody_came_near_is_loaded_in_the_background_before_it_is_built(shown, wait):
    """As by its keys. The mouse may come to another button meanwhile."""
    threads, here = {}, threading.get_ident()
    go_on = threading.Event()

    def load(key):
        go_on.wait(20.0)
        threads[key] = threading.get_ident()

    made = PageStack(
        tuple(Page(key, key, "sample", 1, key, build, prepare=partial(load, key)) for key in "abc"),
        lambda _key: Mock(),
    )
    made.go("a")
    runner = ThreadRunner(Poster(made).post)
    Preparing(made, runner)
    shown(made)
    made.visit("b")
    made.approached.emit("c")
    QApplication.processEvents()
    assert made.current == "a"
    go_on.set()
    wait(lambda: made.current == "b" and "c" in made.widgets)
    assert here not in threads.values()
    runner.close()


def test_that_a_page_that_cannot_be_loaded_says_why_when_it_is_visited(shown):
    def fail():
        raise OSError("nothing there")

    def broken(_context):
        raise OSError("nothing there")

    page = Page("b", "b", "sample", 1, "b", broken, prepare=fail)
    made = PageStack((Page("a", "a", "sample", 1, "a", build), page), lambda _key: Mock())
    made.go("a")
    Preparing(made, InlineRunner())
    shown(made)
    made.visit("b")
    with pytest.raises(OSError, match="nothing there"):
        made._builder.finish("b")


def test_that_a_visit_prepares_the_others_once_and_none_that_is_built(stack, prepared, wait):
    stack.go("b")
    assert prepared == []  # the page that is visited is painted first
    wait(lambda: prepared)
    assert prepared == ["c", "d"]
    stack.approached.emit("d")
    stack.go("a")
    assert prepared == ["c", "d"]


def test_that_it_waits_while_somebody_is_at_work(stack, prepared, wait):
    preparing = stack.findChild(Preparing)
    preparing.put_off()
    stack.go("b")
    began = time.monotonic()
    while time.monotonic() < began + 2.5 * PAUSE / 1000:
        preparing.put_off()
        QApplication.processEvents()
    assert prepared == []
    wait(lambda: prepared)


def test_that_nothing_is_wanted_any_more_when_the_window_closes(stack, prepared):
    stack.go("b")
    stack.finish()
    stack.release()
    began = time.monotonic()
    while time.monotonic() < began + 1.5 * PAUSE / 1000:
        QApplication.processEvents()
    stack.approached.emit("d")
    assert prepared == []


@pytest.mark.usefixtures("app")
def test_that_every_page_can_be_prepared():
    for page in PAGES.values():
        page.load()
