"""Work that is held back waits between two of its steps, and goes on or ends from there."""

import queue
import threading
from collections.abc import Iterator

import pytest

from regolith_studio.jobs.events import Event, Finished, Job, Progress, Steps, Stopped
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.runners import Pausable
from regolith_studio.jobs.runners.thread import PauseToken, ThreadRunner
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


def started(token: PauseToken, answers: list[bool]) -> threading.Thread:
    thread = threading.Thread(target=lambda: answers.append(token.wait_while_paused()))
    thread.start()
    return thread


def test_that_a_paused_token_blocks_until_it_is_resumed() -> None:
    token, answers = PauseToken(), list[bool]()
    assert token.wait_while_paused()
    token.pause()
    assert token.paused
    thread = started(token, answers)
    thread.join(HELD)
    assert thread.is_alive()
    token.resume()
    thread.join(SECONDS)
    assert answers == [True]


def test_that_who_is_stopped_waits_no_longer() -> None:
    token, answers = PauseToken(), list[bool]()
    token.pause()
    thread = started(token, answers)
    token.stop()
    thread.join(SECONDS)
    assert answers == [False]
    token.pause()
    assert not token.paused
    assert not token.wait_while_paused()


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


def item(number: int) -> Steps:
    yield Progress(0, 1)
    return number


def test_that_a_batch_is_held_back_between_two_particles(bench: Bench) -> None:
    def batch(n: int) -> Steps:
        with_one = Executor(1)
        for result in with_one.results(Job(item, (number,)) for number in range(n)):
            if result is not None:
                yield from bench.count(1)
        return "all"

    handle = bench.runner.submit(Job(batch, (6,)), bench.listen)
    bench.allowed.release()
    bench.reached.get(timeout=SECONDS)
    handle.pause()
    bench.allowed.release(5)
    assert not bench.over.wait(HELD)
    assert bench.reached.qsize() <= 1
    handle.resume()
    assert bench.over.wait(SECONDS)
    assert bench.received[-1] == Finished("all")


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
