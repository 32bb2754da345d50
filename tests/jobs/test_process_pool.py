"""The pool of processes and the executors on it: order, failures, deaths and stops."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from regolith_studio.jobs.events import Event, Failed, Finished, Job, Progress, Stopped
from regolith_studio.jobs.executor import Executor, in_order, open_executor
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.jobs.runners.process_pool import ProcessPoolRunner

from .small_jobs import (
    count_until,
    die,
    hold,
    process_id,
    refuse,
    sleep_without_steps,
    square,
    stumble,
    wait_for,
    wait_forever,
    with_a_lambda,
)


@pytest.fixture(scope="module")
def pool() -> Iterator[ProcessPoolRunner]:
    runner = ProcessPoolRunner(2)
    yield runner
    runner.close()


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_that_a_batch_answers_in_the_order_of_the_questions(workers: int) -> None:
    with open_executor(workers) as executor:
        results = [e for e in executor.results(Job(square, (x,)) for x in range(7)) if e]
        again = list(executor.map(abs, [-1, 2, -3]))
    assert results == [Finished(x * x) for x in range(7)]
    assert again == [1, 2, 3]


@pytest.mark.slow
def test_that_a_script_without_a_guarded_part_ends_with_a_sentence(tmp_path: Path) -> None:
    script = tmp_path / "unguarded.py"
    script.write_text(
        "from regolith_studio.jobs.executor import Executor\nprint(list(Executor(2).map(abs, [-1, 2])))\n"
    )
    ended = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60, check=False)
    assert ended.returncode == 1
    assert (
        ended.stderr.rstrip()
        .splitlines()[-1]
        .endswith(
            "A worker process died at its start. Worker processes import the script that starts them: "
            'what it does must stand below `if __name__ == "__main__":`.'
        )
    )


def test_that_one_worker_can_be_stopped_within_a_job() -> None:
    results = Executor(1).results([Job(wait_forever)])
    assert [next(results) for _ in range(3)] == [None] * 3
    results.close()


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


def test_that_a_job_in_a_process_stops_between_two_yields(pool: ProcessPoolRunner) -> None:
    received: list[Event] = []
    handle = pool.submit(Job(wait_forever), received.append)
    time.sleep(0.2)
    handle.cancel()
    end = time.monotonic() + 20
    while not handle.done and time.monotonic() < end:
        time.sleep(0.01)
    assert [each for each in received if not isinstance(each, Progress)] == [Stopped()]


@pytest.mark.parametrize("workers", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_that_the_progress_of_jobs_reaches_who_waits_for_them(workers: int, tmp_path: Path) -> None:
    """Each of two jobs counts on until a file is there, which is written once both have been heard of."""
    heard: dict[int, int] = {}
    files = [tmp_path / "0", tmp_path / "1"]

    def follow(number: int, step: Progress) -> None:
        heard[number] = step.done
        if workers == 1 or len(heard) == 2:
            for path in files:
                path.touch()

    with open_executor(workers) as executor:
        jobs = [Job(count_until, (str(path),)) for path in files]
        answers = [answer for answer in executor.as_completed(jobs, follow) if answer is not None]
    assert sorted(number for number, _ in answers) == [0, 1]
    assert min(heard[0], heard[1]) > 0


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_that_parts_of_long_jobs_are_named_and_results_come_in_order(workers: int, tmp_path: Path) -> None:
    story: list[tuple[int, str]] = []
    with open_executor(workers) as executor:
        jobs = [Job(count_until, (str(tmp_path / "file"),)), Job(square, (3,))]
        steps = executor.run_all(jobs, ["long", "short"])
        try:
            while True:
                step = next(steps)
                assert isinstance(step, Progress)
                story.append((step.done, step.message))
                if step.message.startswith("long (") and (workers == 1 or step.done == 1):
                    (tmp_path / "file").touch()
        except StopIteration as end:
            results = end.value
    assert any(message.startswith("long (") and message.endswith(": counting)") for _, message in story)
    assert story[-1][0] == 2
    assert isinstance(results[0], Finished)
    assert results[1] == Finished(9)


def test_that_workers_without_a_job_are_threads_of_the_others() -> None:
    assert [Executor(8).threads_for(n) for n in (0, 1, 3, 8, 20)] == [8, 8, 2, 1, 1]
    assert Executor(1).threads_for(3) is None


def test_that_leaving_a_batch_early_stops_its_jobs(pool: ProcessPoolRunner) -> None:
    batch = in_order(pool, [Job(square, (3,)), Job(wait_forever), Job(wait_forever)], window=3)
    while next(batch) != Finished(9):
        pass
    batch.close()
    answer = [e for e in in_order(pool, [Job(square, (4,))], window=1) if e]
    assert answer == [Finished(16)]


def test_that_a_worker_that_dies_costs_its_particle_and_no_other(pool: ProcessPoolRunner) -> None:
    jobs = [Job(square, (1,)), Job(die), *(Job(square, (x,)) for x in range(2, 6))]
    results = [e for e in in_order(pool, jobs, window=3) if e]
    assert isinstance(results[1], Failed)
    assert "died" in results[1].sentence
    assert [e for i, e in enumerate(results) if i != 1] == [Finished(x * x) for x in (1, 2, 3, 4, 5)]


def test_that_what_cannot_be_sent_or_answered_fails_with_a_sentence(pool: ProcessPoolRunner) -> None:
    jobs = [Job(with_a_lambda), Job(square, (lambda: None,)), Job(square, (3,))]
    sent, refused, good = [e for e in in_order(pool, jobs, 3) if e]
    assert isinstance(sent, Failed)
    assert isinstance(refused, Failed)
    assert "cannot be sent" in refused.sentence
    assert good == Finished(9)


@pytest.mark.skipif(os.name == "nt", reason="memory is told by POSIX systems")
@pytest.mark.slow
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
@pytest.mark.slow
def test_that_a_process_killed_from_outside_is_replaced_and_its_job_done(tmp_path: Path) -> None:
    runner = ProcessPoolRunner(2)
    received: list[Event] = []
    other: list[Event] = []
    try:
        (first,) = [e for e in in_order(runner, [Job(process_id)], 1) if e]
        runner.submit(Job(wait_for, (str(tmp_path / "go"),)), received.append)
        assert isinstance(first, Finished)
        os.kill(first.value, signal.SIGKILL)
        runner.submit(Job(square, (5,)), other.append)
        (tmp_path / "go").write_text("")
        end = time.monotonic() + 60
        while not (received and other) and time.monotonic() < end:
            time.sleep(0.01)
    finally:
        runner.close()
    assert received == [Finished(str(tmp_path / "go"))]
    assert other == [Finished(25)]


@pytest.mark.slow
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


@pytest.mark.slow
def test_that_a_process_that_cannot_start_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    runner = ProcessPoolRunner(1)

    def refuse_to_start() -> None:
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(runner, "_start_worker", refuse_to_start)
    (result,) = [e for e in in_order(runner, [Job(square, (2,))], 1) if e]
    runner.close()
    assert isinstance(result, Failed)
    assert "could not be started" in result.sentence


@pytest.mark.slow
def test_that_closing_waits_for_no_step_that_takes_long(tmp_path: Path) -> None:
    runner, received = ProcessPoolRunner(2), list[Event]()
    for name in ("one", "two"):
        runner.submit(Job(sleep_without_steps, (str(tmp_path / name),)), received.append)
    end = time.monotonic() + 60
    while len(list(tmp_path.iterdir())) < 2 and time.monotonic() < end:
        time.sleep(0.01)
    processes = [worker.process for worker in runner._workers]
    begun = time.monotonic()
    runner.close()
    assert time.monotonic() - begun < 10  # 1 s where the machine is not busy
    assert received == [Stopped(), Stopped()]
    assert len(processes) == 2
    assert not any(process.is_alive() for process in processes)
