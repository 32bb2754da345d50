"""All runners tell the same story; each is tested against the same small jobs."""

import contextlib
import os
import queue
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from regolith_studio.errors import Cancelled, InputError
from regolith_studio.jobs.batch import in_order
from regolith_studio.jobs.crew import Crew, hired
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
from regolith_studio.jobs.runners.drive import drive
from regolith_studio.jobs.runners.inline import InlineRunner
from regolith_studio.jobs.runners.process_pool import ProcessPoolRunner
from regolith_studio.jobs.runners.thread import ThreadRunner


def count_to(n: int) -> Steps:
    yield Started("Counting", n)
    for i in range(1, n + 1):
        yield Progress(i, n)
    return n


def square(x: int) -> Steps:
    yield Started("Squaring")
    return x * x


def refuse() -> Steps:
    yield Started("Refusing")
    raise InputError("The number is too green.")


def stumble() -> Steps:
    yield Started("Stumbling")
    raise KeyError("oops")


def give_up() -> Steps:
    yield Started("Giving up")
    raise Cancelled("enough")


def die() -> Steps:
    yield Started("Dying")
    os._exit(3)


def process_id() -> Steps:
    yield Started("Asking")
    return os.getpid()


def wait_forever() -> Steps:
    yield Started("Waiting")
    while True:
        time.sleep(0.005)
        yield Progress(0, 0)


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
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("lane ")]


@pytest.fixture(scope="module")
def pool() -> Iterator[ProcessPoolRunner]:
    runner = ProcessPoolRunner(2)
    yield runner
    runner.close()


def ended(heard: list[Event]) -> Callable[[], bool]:
    return lambda: bool(heard) and isinstance(heard[-1], Finished | Failed | Stopped)


def test_that_an_inline_job_is_heard_from_start_to_end() -> None:
    heard: list[Event] = []
    handle = InlineRunner().submit(Job(count_to, (2,)), heard.append)
    assert heard == [Started("Counting", 2), Progress(1, 2), Progress(2, 2), Finished(2)]
    assert handle.done


def test_that_an_error_meant_for_users_arrives_as_its_sentence() -> None:
    ending = drive(Job(refuse), lambda _: None, lambda: False)
    assert isinstance(ending, Failed)
    assert ending.sentence == "The number is too green."
    assert "InputError" in ending.details


def test_that_any_other_error_arrives_as_one_sentence_with_details() -> None:
    ending = drive(Job(stumble), lambda _: None, lambda: False)
    assert isinstance(ending, Failed)
    assert "KeyError" in ending.sentence
    assert "Traceback" in ending.details


def test_that_a_job_that_gives_up_counts_as_stopped() -> None:
    assert drive(Job(give_up), lambda _: None, lambda: False) == Stopped()


def test_that_cancelling_takes_effect_between_two_yields() -> None:
    heard: list[Event] = []
    ending = drive(Job(count_to, (5,)), heard.append, lambda: len(heard) == 3)
    assert ending == Stopped()
    assert heard == [Started("Counting", 5), Progress(1, 5), Progress(2, 5)]


def test_that_a_thread_delivers_in_the_thread_of_the_owner(owner: Owner, threads: ThreadRunner) -> None:
    heard: list[Event] = []
    where: set[int] = set()

    def listen(event: Event) -> None:
        heard.append(event)
        where.add(threading.get_ident())

    threads.submit(Job(count_to, (50,)), listen, "a")
    owner.run_until(ended(heard))
    assert heard[0] == Started("Counting", 50)
    assert heard[-1] == Finished(50)
    assert where == {owner.thread}


def test_that_unread_progress_is_replaced_and_endings_never_are(owner: Owner, threads: ThreadRunner) -> None:
    heard: list[Event] = []
    handle = threads.submit(Job(count_to, (1000,)), heard.append, "a")
    while not handle.done:
        time.sleep(0.001)
    owner.run_until(ended(heard))
    assert heard == [Started("Counting", 1000), Progress(1000, 1000), Finished(1000)]


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
    heard: list[Event] = []
    handle = threads.submit(Job(count_to, (10**9,)), heard.append, "a")
    handle.cancel()
    owner.run_until(ended(heard))
    assert heard[-1] == Stopped()


def test_that_closing_stops_the_threads_and_refuses_new_jobs(owner: Owner) -> None:
    runner = ThreadRunner(owner.calls.put)
    handle = runner.submit(Job(wait_forever), lambda _: None, "a")
    runner.close()
    assert handle.done
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("lane ")]
    with pytest.raises(RuntimeError, match="closed"):
        runner.submit(Job(count_to, (1,)), lambda _: None)


@pytest.mark.parametrize("workers", [1, 2])
def test_that_a_batch_answers_in_the_order_of_the_questions(workers: int) -> None:
    with hired(workers) as crew:
        endings = [e for e in crew.endings(Job(square, (x,)) for x in range(7)) if e]
        again = list(crew.map(abs, [-1, 2, -3]))
    assert endings == [Finished(x * x) for x in range(7)]
    assert again == [1, 2, 3]


def test_that_a_crew_that_was_lent_is_not_dismissed(pool: ProcessPoolRunner) -> None:
    crew = Crew(2)
    crew._runner = pool
    with hired(crew) as lent:
        assert lent is crew
    assert list(crew.map(abs, [-5])) == [5]


def test_that_one_worker_can_be_stopped_within_a_job() -> None:
    endings = Crew(1).endings([Job(wait_forever)])
    assert [next(endings) for _ in range(3)] == [None] * 3
    endings.close()


def test_that_a_batch_asks_for_no_more_than_its_window() -> None:
    asked: list[int] = []

    def jobs() -> Iterator[Job]:
        for x in range(10):
            asked.append(x)
            yield Job(square, (x,))

    answers = in_order(InlineRunner(), jobs(), window=3)
    next(answers)
    assert asked == [0, 1, 2]


def test_that_one_failure_does_not_stop_a_batch(pool: ProcessPoolRunner) -> None:
    jobs = [Job(square, (1,)), Job(refuse), Job(stumble), Job(square, (2,))]
    first, second, third, fourth = [e for e in in_order(pool, jobs, window=4) if e]
    assert first == Finished(1)
    assert isinstance(second, Failed)
    assert second.sentence == "The number is too green."
    assert isinstance(third, Failed)
    assert fourth == Finished(4)


def test_that_the_processes_stay_warm(pool: ProcessPoolRunner) -> None:
    ids = {e.value for e in in_order(pool, [Job(process_id)] * 12, 2) if isinstance(e, Finished)}
    assert 1 <= len(ids) <= 2
    assert os.getpid() not in ids


def test_that_a_job_in_a_process_stops_between_two_yields(pool: ProcessPoolRunner) -> None:
    heard: list[Event] = []
    handle = pool.submit(Job(wait_forever), heard.append)
    time.sleep(0.2)
    handle.cancel()
    end = time.monotonic() + 20
    while not handle.done and time.monotonic() < end:
        time.sleep(0.01)
    assert heard == [Stopped()]


def test_that_leaving_a_batch_early_stops_its_jobs(pool: ProcessPoolRunner) -> None:
    batch = in_order(pool, [Job(square, (3,)), Job(wait_forever), Job(wait_forever)], window=3)
    while next(batch) != Finished(9):
        pass
    batch.close()
    answer = [e for e in in_order(pool, [Job(square, (4,))], window=1) if e]
    assert answer == [Finished(16)]


def test_that_a_worker_that_dies_costs_its_particle_and_no_other() -> None:
    runner = ProcessPoolRunner(2)
    try:
        jobs = [Job(square, (1,)), Job(die), *(Job(square, (x,)) for x in range(2, 6))]
        endings = [e for e in in_order(runner, jobs, window=3) if e]
    finally:
        runner.close()
    assert isinstance(endings[1], Failed)
    assert "died" in endings[1].sentence
    assert [e for i, e in enumerate(endings) if i != 1] == [Finished(x * x) for x in (1, 2, 3, 4, 5)]


def test_that_a_partial_result_stands_for_all_before_it(owner: Owner, threads: ThreadRunner) -> None:
    def rows() -> Steps:
        yield Partial((1,))
        yield Partial((1, 2))
        return (1, 2)

    heard: list[Event] = []
    handle = threads.submit(Job(rows), heard.append)
    while not handle.done:
        time.sleep(0.001)
    owner.run_until(ended(heard))
    assert heard == [Partial((1, 2)), Finished((1, 2))]


def with_a_lambda() -> Steps:
    yield Started("Hiding")
    return lambda: None


def hold(megabytes: int) -> Steps:
    yield Started("Holding")
    HELD.append(b"x" * (megabytes * 2**20))
    return os.getpid()


HELD: list[bytes] = []


def wait_for(path: str) -> Steps:
    yield Started("Waiting")
    while not os.path.exists(path):  # noqa: PTH110
        yield Progress(0, 0)
        time.sleep(0.005)
    return path


def test_that_what_cannot_be_sent_or_answered_fails_with_a_sentence(pool: ProcessPoolRunner) -> None:
    jobs = [Job(with_a_lambda), Job(square, (lambda: None,)), Job(square, (3,))]
    sent, refused, good = [e for e in in_order(pool, jobs, 3) if e]
    assert isinstance(sent, Failed)
    assert isinstance(refused, Failed)
    assert "cannot be sent" in refused.sentence
    assert good == Finished(9)


@pytest.mark.skipif(os.name == "nt", reason="memory is told by POSIX systems")
def test_that_a_process_that_holds_too_much_memory_is_replaced() -> None:
    runner = ProcessPoolRunner(1, memory=200 * 2**20)
    try:
        first, second, third = [
            e for e in in_order(runner, [Job(hold, (1,)), Job(hold, (300,)), Job(process_id)], 1) if e
        ]
    finally:
        runner.close()
    assert isinstance(first, Finished)
    assert first == second
    assert isinstance(third, Finished)
    assert third.value != second.value


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
def test_that_a_process_killed_from_outside_is_replaced_and_its_job_done(tmp_path: Path) -> None:
    runner = ProcessPoolRunner(2)
    heard: list[Event] = []
    other: list[Event] = []
    try:
        (first,) = [e for e in in_order(runner, [Job(process_id)], 1) if e]
        runner.submit(Job(wait_for, (str(tmp_path / "go"),)), heard.append)
        assert isinstance(first, Finished)
        os.kill(first.value, signal.SIGKILL)
        runner.submit(Job(square, (5,)), other.append)
        (tmp_path / "go").write_text("")
        end = time.monotonic() + 60
        while not (heard and other) and time.monotonic() < end:
            time.sleep(0.01)
    finally:
        runner.close()
    assert heard == [Finished(str(tmp_path / "go"))]
    assert other == [Finished(25)]


def test_that_a_waiting_job_can_be_cancelled_while_all_processes_are_busy() -> None:
    runner = ProcessPoolRunner(1)
    busy: list[Event] = []
    idle: list[Event] = []
    try:
        runner.submit(Job(wait_forever), busy.append)
        runner.submit(Job(square, (2,)), idle.append).cancel()
        end = time.monotonic() + 20
        while not idle and time.monotonic() < end:
            time.sleep(0.01)
        assert idle == [Stopped()]
        assert busy == []
    finally:
        runner.close()
    assert busy == [Stopped()]


def test_that_a_listener_that_stumbles_does_not_stop_the_pool(
    pool: ProcessPoolRunner, caplog: pytest.LogCaptureFixture
) -> None:
    def stumbling(_event: Event) -> None:
        raise KeyError("oops")

    pool.submit(Job(square, (1,)), stumbling)
    assert [e for e in in_order(pool, [Job(square, (2,))], 1) if e] == [Finished(4)]
    assert "A listener" in caplog.text


def test_that_a_process_that_cannot_start_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    runner = ProcessPoolRunner(1)

    def refuse_to_start() -> None:
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(runner, "_hire", refuse_to_start)
    (ending,) = [e for e in in_order(runner, [Job(square, (2,))], 1) if e]
    runner.close()
    assert isinstance(ending, Failed)
    assert "could not be started" in ending.sentence
