"""Only the newest task of a queue is heard; the test decides when each job says what."""

from typing import Any

import pytest

from regolith_studio.jobs.events import (
    Event,
    Failed,
    Finished,
    Job,
    Listener,
    Partial,
    Progress,
    Started,
    Stopped,
)
from regolith_studio.session.tasks import Reactions, Task, TaskBoard


class Puppet:
    """A runner that does nothing but keep the listeners."""

    def __init__(self) -> None:
        self.listeners: list[Listener] = []
        self.cancelled: list[int] = []

    def submit(self, job: Job, listener: Listener, queue: str = "") -> "Puppet.Handle":  # noqa: ARG002
        self.listeners.append(listener)
        return Puppet.Handle(self, len(self.listeners) - 1)

    def close(self) -> None: ...

    class Handle:
        def __init__(self, owner: "Puppet", index: int) -> None:
            self.owner, self.index = owner, index

        done = False

        def cancel(self) -> None:
            self.owner.cancelled.append(self.index)


JOB = Job(lambda: iter(()))  # type: ignore[arg-type, return-value]


def board() -> tuple[Puppet, TaskBoard, list[object]]:
    puppet = Puppet()
    return puppet, TaskBoard(puppet, lambda: None), []


def test_that_an_answer_to_an_old_request_is_dropped() -> None:
    puppet, tasks, received = board()
    tasks.start("fit", "first", JOB, Reactions(received.append, received.append))
    tasks.start("fit", "second", JOB, Reactions(received.append, received.append))
    assert puppet.cancelled == [0]
    old, new = puppet.listeners
    old(Partial("stale part"))
    old(Finished("stale"))
    new(Finished("fresh"))
    assert received == ["fresh"]
    assert tasks.running == ()


def test_that_lanes_do_not_replace_each_other() -> None:
    puppet, tasks, received = board()
    tasks.start("fit", "one", JOB, Reactions(received.append))
    tasks.start("surface", "two", JOB, Reactions(received.append))
    puppet.listeners[0](Finished(1))
    puppet.listeners[1](Finished(2))
    assert received == [1, 2]


def test_that_progress_shows_in_the_list() -> None:
    puppet, tasks, received = board()
    number = tasks.start("load", "Reading", JOB, Reactions(received.append))
    puppet.listeners[0](Started("Reading particles", 4))
    puppet.listeners[0](Progress(3, 4, "b.stl"))
    assert tasks.running == (Task(number, "load", "Reading particles", 3, 4, "b.stl"),)


def test_that_a_cancelled_task_is_listed_until_it_has_stopped() -> None:
    puppet, tasks, received = board()
    reactions = Reactions(received.append, stopped=lambda: received.append("stopped"))
    number = tasks.start("load", "Reading", JOB, reactions)
    tasks.cancel(number)
    assert puppet.cancelled == [0]
    assert tasks.is_running("load")
    assert tasks.running[0].stopping
    puppet.listeners[0](Stopped())
    assert not tasks.is_running("load")
    assert received == ["stopped"]


def test_that_a_failure_reaches_its_reaction() -> None:
    puppet, tasks, received = board()
    tasks.start("load", "Reading", JOB, Reactions(received.append, failed=received.append))
    puppet.listeners[0](Failed("Broken."))
    assert received == [Failed("Broken.")]


def drag(tasks: TaskBoard, received: list[object], number: int, **reactions: Any) -> None:
    callbacks = Reactions(
        received.append, failed=lambda failure: received.append(failure.sentence), **reactions
    )
    tasks.start("hand", str(number), JOB, callbacks, after_running=True)


def test_that_the_first_and_the_last_value_of_a_drag_are_computed_and_nothing_in_between() -> None:
    puppet, tasks, received = board()
    for number in range(5):
        drag(tasks, received, number)
    assert [task.title for task in tasks.running] == ["0"]
    assert puppet.cancelled == []
    puppet.listeners[0](Finished(0))
    assert [task.title for task in tasks.running] == ["4"]
    puppet.listeners[1](Finished(4))
    assert received == [0, 4]
    assert tasks.running == ()


@pytest.mark.parametrize(
    ("event", "expected"), [(Failed("too large", ""), ["too large", 2]), (Stopped(), [2])]
)
def test_that_the_waiting_job_follows_one_that_failed_or_was_stopped(
    event: Event, expected: list[object]
) -> None:
    puppet, tasks, received = board()
    drag(tasks, received, 1)
    drag(tasks, received, 2)
    puppet.listeners[0](event)
    puppet.listeners[1](Finished(2))
    assert received == expected


def test_that_a_job_started_while_a_result_is_shown_replaces_the_waiting_one() -> None:
    puppet, tasks, received = board()
    again = Reactions(lambda _: drag(tasks, received, 3))
    tasks.start("hand", "1", JOB, again, after_running=True)
    drag(tasks, received, 2)
    puppet.listeners[0](Finished(1))
    assert [task.title for task in tasks.running] == ["3"]
    puppet.listeners[1](Finished(3))
    assert received == [3]
    assert tasks.running == ()


def test_that_an_error_while_a_result_is_shown_does_not_keep_the_next_from_running() -> None:
    puppet, tasks, received = board()
    tasks.start("hand", "1", JOB, Reactions(lambda _: 1 / 0), after_running=True)
    drag(tasks, received, 2)
    with pytest.raises(ZeroDivisionError):
        puppet.listeners[0](Finished(1))
    puppet.listeners[1](Finished(2))
    assert received == [2]


def test_that_stopping_a_lane_drops_the_job_that_waits() -> None:
    puppet, tasks, received = board()
    drag(tasks, received, 1)
    drag(tasks, received, 2)
    tasks.stop_queue("hand")
    assert tasks.running == ()
    assert puppet.cancelled == [0]
    assert len(puppet.listeners) == 1
