"""The inline and the thread runner tell the same story; both are tested against the same small jobs."""

import contextlib
import queue
import threading
import time
import weakref
from collections.abc import Callable, Iterator

import pytest

from regolith_studio.jobs.events import (
    Event,
    Failed,
    Finished,
    Job,
    Partial,
    Progress,
    Started,
    Steps,
    Stopped,
)
from regolith_studio.jobs.runners import InlineRunner, run_job
from regolith_studio.jobs.runners.thread import ThreadRunner

from .small_jobs import count_to, give_up, refuse, stumble, wait_forever


class Owner:
    """Stands for the thread with the event loop."""

    def __init__(self) -> None:
        self.calls: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.thread = threading.get_ident()

    def run_until(self, condition: Callable[[], bool]) -> None:
        end = time.monotonic() + 20
        while not condition():
            assert time.monotonic() < end, "nothing came"
            with contextlib.suppress(queue.Empty):
                self.calls.get(timeout=0.02)()


@pytest.fixture
def owner() -> Owner:
    return Owner()


@pytest.fixture
def threads(owner: Owner) -> Iterator[ThreadRunner]:
    runner = ThreadRunner(owner.calls.put)
    yield runner
    runner.close()
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("queue ")]


def ended(received: list[Event]) -> Callable[[], bool]:
    return lambda: bool(received) and isinstance(received[-1], Finished | Failed | Stopped)


def test_that_an_inline_job_is_heard_from_start_to_end() -> None:
    received: list[Event] = []
    handle = InlineRunner().submit(Job(count_to, (2,)), received.append)
    assert received == [Started("Counting", 2), Progress(1, 2), Progress(2, 2), Finished(2)]
    assert handle.done


def test_that_an_error_meant_for_users_arrives_as_its_sentence() -> None:
    result = run_job(Job(refuse), lambda _: None, lambda: False)
    assert isinstance(result, Failed)
    assert result.sentence == "The number is too green."
    assert "InputError" in result.details


def test_that_any_other_error_arrives_as_one_sentence_with_details() -> None:
    result = run_job(Job(stumble), lambda _: None, lambda: False)
    assert isinstance(result, Failed)
    assert "KeyError" in result.sentence
    assert "Traceback" in result.details


def test_that_a_job_that_gives_up_counts_as_stopped() -> None:
    assert run_job(Job(give_up), lambda _: None, lambda: False) == Stopped()


def test_that_cancelling_takes_effect_between_two_yields() -> None:
    received: list[Event] = []
    result = run_job(Job(count_to, (5,)), received.append, lambda: len(received) == 3)
    assert result == Stopped()
    assert received == [Started("Counting", 5), Progress(1, 5), Progress(2, 5)]


def test_that_a_thread_delivers_in_the_thread_of_the_owner(owner: Owner, threads: ThreadRunner) -> None:
    received: list[Event] = []
    where: set[int] = set()

    def listen(event: Event) -> None:
        received.append(event)
        where.add(threading.get_ident())

    threads.submit(Job(count_to, (50,)), listen, "a")
    owner.run_until(ended(received))
    assert received[0] == Started("Counting", 50)
    assert received[-1] == Finished(50)
    assert where == {owner.thread}


def test_that_unread_progress_is_replaced_and_endings_never_are(owner: Owner, threads: ThreadRunner) -> None:
    received: list[Event] = []
    handle = threads.submit(Job(count_to, (1000,)), received.append, "a")
    while not handle.done:
        time.sleep(0.001)
    owner.run_until(ended(received))
    assert received == [Started("Counting", 1000), Progress(1000, 1000), Finished(1000)]


def test_that_the_newest_job_of_a_lane_wins(owner: Owner, threads: ThreadRunner) -> None:
    stories: list[list[Event]] = [[], [], []]
    handles = [threads.submit(Job(wait_forever), stories[0].append, "a")]
    owner.run_until(lambda: bool(stories[0]))
    handles += [threads.submit(Job(wait_forever), stories[1].append, "a")]
    handles += [threads.submit(Job(count_to, (1,)), stories[2].append, "a")]
    owner.run_until(ended(stories[2]))
    owner.run_until(lambda: ended(stories[0])() and ended(stories[1])())
    assert stories[0][-1] == Stopped()
    assert stories[1][-1] == Stopped()
    assert stories[2][-1] == Finished(1)
    assert all(handle.done for handle in handles)


def test_that_lanes_do_not_disturb_each_other(owner: Owner, threads: ThreadRunner) -> None:
    slow: list[Event] = []
    quick: list[Event] = []
    handle = threads.submit(Job(wait_forever), slow.append, "slow")
    threads.submit(Job(count_to, (3,)), quick.append, "quick")
    owner.run_until(ended(quick))
    assert quick[-1] == Finished(3)
    assert not handle.done
    handle.cancel()
    owner.run_until(ended(slow))
    assert slow[-1] == Stopped()


def test_that_a_job_cancelled_at_its_last_step_is_not_finished(owner: Owner, threads: ThreadRunner) -> None:
    received: list[Event] = []
    handle = threads.submit(Job(count_to, (10**9,)), received.append, "a")
    handle.cancel()
    owner.run_until(ended(received))
    assert received[-1] == Stopped()


def test_that_closing_stops_the_threads_and_refuses_new_jobs(owner: Owner) -> None:
    runner = ThreadRunner(owner.calls.put)
    handle = runner.submit(Job(wait_forever), lambda _: None, "a")
    runner.close()
    assert handle.done
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("queue ")]
    with pytest.raises(RuntimeError, match="closed"):
        runner.submit(Job(count_to, (1,)), lambda _: None)


def test_that_a_partial_result_stands_for_all_before_it(owner: Owner, threads: ThreadRunner) -> None:
    def rows() -> Steps:
        yield Partial((1,))
        yield Partial((1, 2))
        return (1, 2)

    received: list[Event] = []
    handle = threads.submit(Job(rows), received.append)
    while not handle.done:
        time.sleep(0.001)
    owner.run_until(ended(received))
    assert received == [Partial((1, 2)), Finished((1, 2))]


class _Heap:
    """Something large that a job is given."""


def _look_at(_heap: _Heap) -> Steps:
    yield Started("Looking")
    return 1


def test_that_a_thread_that_waits_holds_nothing_of_its_last_job() -> None:
    owner, endings = Owner(), []
    runner = ThreadRunner(owner.calls.put)
    heap = _Heap()
    known = weakref.ref(heap)
    runner.submit(Job(_look_at, (heap,)), endings.append, "lane")
    del heap
    owner.run_until(lambda: Finished(1) in endings)
    owner.run_until(lambda: known() is None)
    runner.close()
