"""Work that follows the hand: nothing that is under way is thrown away, and the newest wish comes last."""

import pytest

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.ui.latest_job import LatestJob


class Bench:
    """Stands for the context of a page: keeps what was started until somebody ends it."""

    def __init__(self):
        self.under_way = []

    def start(self, title, job, finished, failed, stopped, lane):
        assert (title, lane) == ("Work", "hand")
        self.under_way.append((job.arguments[0], finished, failed, stopped))

    def end(self, how="finished", value=None):
        number, finished, failed, stopped = self.under_way.pop(0)
        {"finished": lambda: finished(number), "failed": lambda: failed(value), "stopped": stopped}[how]()


@pytest.fixture
def bench():
    return Bench()


@pytest.fixture
def told():
    return []


@pytest.fixture
def drag(bench, told):
    following = LatestJob(bench, "Work", "hand")

    def submit(number):
        following.submit(Job(lambda: None, (number,)), told.append, told.append)

    return submit


def test_that_the_first_and_the_last_of_a_drag_are_shown_and_nothing_in_between(bench, drag, told):
    for number in range(5):
        drag(number)
    assert [number for number, *_ in bench.under_way] == [0]
    bench.end()
    assert told == [0]
    bench.end()
    assert told == [0, 4]
    assert not bench.under_way


@pytest.mark.parametrize(("how", "said"), [("failed", ["too large"]), ("stopped", [])])
def test_that_the_newest_wish_follows_what_has_failed_or_was_stopped(bench, drag, told, how, said):
    drag(1)
    drag(2)
    bench.end(how, Failed("too large", ""))
    assert told == said
    bench.end()
    assert told == [*said, 2]


def test_that_a_wish_made_while_a_result_is_shown_is_done_once(bench):
    following, shown = LatestJob(bench, "Work", "hand"), []

    def show(number):
        shown.append(number)
        if number == 1:
            following.submit(Job(lambda: None, (2,)), show, shown.append)

    following.submit(Job(lambda: None, (1,)), show, shown.append)
    bench.end()
    assert len(bench.under_way) == 1
    bench.end()
    assert shown == [1, 2]


def test_that_an_error_while_showing_does_not_end_the_following(bench, told):
    following = LatestJob(bench, "Work", "hand")
    following.submit(Job(lambda: None, (1,)), lambda _: 1 / 0, told.append)
    following.submit(Job(lambda: None, (2,)), told.append, told.append)
    with pytest.raises(ZeroDivisionError):
        bench.end()
    bench.end()
    assert told == [2]
