"""Undo is checked against a plain list of everything that happened."""

from hypothesis import given
from hypothesis import strategies as some

from regolith_studio.session.history import History


def test_that_a_dragged_slider_is_one_step() -> None:
    history = History(0)
    for value in (1, 2, 3):
        history.push(value, "slider")
    assert history.undo() == 0
    assert history.redo() == 3


def test_that_two_drags_are_two_steps() -> None:
    history = History(0)
    history.push(1, "slider")
    history.push(2, "slider")
    history.end_step()
    history.push(3, "slider")
    assert [history.undo(), history.undo()] == [2, 0]


def test_that_another_control_ends_the_step() -> None:
    history = History((0, 0))
    history.push((1, 0), "l_max")
    history.push((1, 1), "faces")
    assert history.undo() == (1, 0)


def test_that_old_steps_are_forgotten() -> None:
    history = History(0, limit=3)
    for value in range(1, 10):
        history.push(value)
    assert [history.undo() for _ in range(5)] == [8, 7, 6, 6, 6]


@given(some.lists(some.one_of(some.integers(0, 9), some.sampled_from(["undo", "redo"])), max_size=40))
def test_that_history_agrees_with_a_list_and_a_position(acts: list[int | str]) -> None:
    history = History(0)
    line, at = [0], 0
    for act in acts:
        if act == "undo":
            at = max(0, at - 1)
            history.undo()
        elif act == "redo":
            at = min(len(line) - 1, at + 1)
            history.redo()
        elif act != line[at]:
            line, at = [*line[: at + 1], int(act)], at + 1
            history.push(int(act))
        assert history.value == line[at]
        assert history.can_undo == (at > 0)
        assert history.can_redo == (at < len(line) - 1)
