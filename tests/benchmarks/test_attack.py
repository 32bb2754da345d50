"""A sample of the attack on every command that writes."""

import random
import sys
from pathlib import Path

import pytest

from benchmarks.attack import (
    COMMANDS,
    Arena,
    Ended,
    Prepared,
    Row,
    Rows,
    attack,
    evaluate,
    lines,
    tree,
)


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.skipif(sys.platform != "linux", reason="processes are found in /proc")
def test_that_an_attack_leaves_an_earlier_result_or_a_new_one(tmp_path: Path) -> None:
    """A sample of all commands, of which less is done in the time on a machine that is busy.

    The demo is last: before its first attack it runs twice, which took minutes where 20 processes waited.
    """
    rows: Rows = {}
    names = [
        *random.Random(1).sample([name for name in COMMANDS if name != "demo"], len(COMMANDS) - 1),
        "demo",
    ]
    commands = list(attack(tmp_path, names, 0.06, 1, rows, seconds=300.0))
    assert rows
    bad = {key for key, row in rows.items() if row.lost or row.mixed or row.left or row.unclear}
    assert not bad, [line for name in commands for line in lines(rows, name)]


@pytest.mark.parametrize(
    ("files", "ended", "counted"),
    [
        (("old", "grain"), Ended(1, "The disk is full.", 0), (1, 0, 0, 0, 0)),
        (("old", "grain"), Ended(1, "Traceback\nOSError", 0), (0, 1, 0, 0, 0)),
        (("old", "grain"), Ended(1, "A remark.\nThe disk is full.", 0), (1, 0, 0, 0, 0)),
        (("old", "grain"), Ended(1, "Particles: 1 of 3, 29 s each\nThe disk is full.", 0), (1, 0, 0, 0, 0)),
        (("old", "grain"), Ended(0, "", 0), (0, 0, 1, 0, 0)),
        (("new", "grain"), Ended(0, "", 0), (0, 0, 0, 0, 0)),
        (("half", "grain"), Ended(0, "", 0), (0, 0, 0, 1, 0)),
        (("new", ".hidden"), Ended(0, "", 0), (0, 0, 1, 0, 1)),
        (("new", "grain"), Ended(0, "", 2), (0, 0, 0, 0, 1)),
    ],
)
def test_that_what_a_run_leaves_is_judged(
    tmp_path: Path, files: tuple[str, str], ended: Ended, counted: tuple[int, ...]
) -> None:
    arena = Arena(tmp_path)
    trees = {}
    for content in ("old", "new"):
        (arena.place / "grain").write_text(content)
        trees[content] = tree(arena.place)
    arena.reset(None)
    (arena.place / files[1]).write_text(files[0])
    row, case = Row(), Prepared("fit", (), tmp_path, trees["old"], trees["new"], 1.0, 1, ("A remark.",))
    evaluate(arena, case, ended, row)
    assert (row.sentences, row.unclear, row.lost, row.mixed, row.left) == counted
