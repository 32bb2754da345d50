"""Work that is held back waits between two of its steps, and goes on or ends from there."""

import queue
import threading
from collections.abc import Iterator

import pytest

from regolith_studio.jobs.events import Event, Finished, Job, Progress, Steps, Stopped
from regolith_studio.jobs.runners import Pausable
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.session.tasks import Reactions, TaskBoard

HELD = 0.1
"""Seconds after which something that is held back is still there; however slow the machine."""
SECONDS = 30.0


class Bench:
    """A job whose every step is allowed by the test, and what was heard of it."""

    def __init__(self) -> None:
        self.allowed = threading.Semaphore(0)
        self.reached: queue.SimpleQueue[int] = queue.SimpleQueue()
        self.received: list[Event] = []
        self.over = threading.Event()
        self.runner = ThreadRunner(lambda call: call())

    def count(self, n: int) -> Steps:
        for number in range(1, n + 1):
            assert self.allowed.acquire(timeout=SECONDS)
            self.reached.put(number)
            yield Progress(number, n)
        return "counted"

    def listen(self, event: Event) -> None:
        self.received.append(event)
        if isinstance(event, Finished | Stopped):
            self.over.set()


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench()
    yield made
    made.runner.close()


def test_that_a_job_in_a_thread_waits_between_two_steps_and_goes_on(bench: Bench) -> None:
    handle = bench.runner.submit(Job(bench.count, (5,)), bench.listen)
    assert isinstance(handle, Pausable)
    bench.allowed.release()
    assert bench.reached.get(timeout=SECONDS) == 1
    handle.pause()
    bench.allowed.release(4)
    assert not bench.over.wait(HELD)
    assert bench.reached.qsize() <= 1, "one step may have been under way when the job was paused"
    handle.resume()
    assert bench.over.wait(SECONDS)
    assert bench.received[-1] == Finished("counted")


@pytest.mark.parametrize("closing", [False, True])
def test_that_a_job_that_waits_can_be_stopped(bench: Bench, closing: bool) -> None:
    handle = bench.runner.submit(Job(bench.count, (5,)), bench.listen)
    bench.allowed.release()
    bench.reached.get(timeout=SECONDS)
    handle.pause()
    bench.allowed.release(4)
    if closing:
        bench.runner.close()
    else:
        handle.cancel()
    assert bench.over.wait(SECONDS)
    assert bench.received[-1] == Stopped()


def test_that_a_newer_job_of_the_lane_does_not_wait_for_one_that_is_held_back(bench: Bench) -> None:
    first = bench.runner.submit(Job(bench.count, (5,)), lambda _event: None, "a")
    bench.allowed.release()
    bench.reached.get(timeout=SECONDS)
    first.pause()
    bench.allowed.release(9)
    bench.runner.submit(Job(bench.count, (2,)), bench.listen, "a")
    assert bench.over.wait(SECONDS)
    assert bench.received[-1] == Finished("counted")


def test_that_the_list_of_tasks_tells_what_is_held_back(bench: Bench) -> None:
    board = TaskBoard(bench.runner, lambda: None)
    number = board.start("a", "Counting", Job(bench.count, (3,)), Reactions(lambda _: bench.over.set()))
    assert board.running[0].pausable
    board.pause(number)
    board.pause(number)
    assert board.running[0].paused
    bench.allowed.release(3)
    assert not bench.over.wait(HELD)
    board.resume(number)
    assert not any(task.paused for task in board.running)
    assert bench.over.wait(SECONDS)
    board.pause(number)  # has ended: nothing happens
    board.resume(number + 1)
