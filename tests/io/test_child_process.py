"""A program that writes files is followed to its end, and ended with its block."""

import os
import subprocess
import sys
import time

import pytest

from regolith_studio.io.child_process import printed_lines, running_program, written_files

WRITER = """
import time
for number in range(3, 6):
    with open(f"state.{number}", "w") as file:
        file.write("half,")
        file.flush()
        time.sleep(0.25)
        file.write("whole")
print("told")
raise SystemExit(7)
"""


def test_that_files_come_in_order_and_only_when_they_are_whole(tmp_path) -> None:
    with running_program([sys.executable, "-c", WRITER], os.environ, tmp_path) as child:
        files = written_files(child, lambda number: tmp_path / f"state.{number}", first=3)
        found = [(number, path.read_text()) for number, path in files]
    assert found == [(3, "half,whole"), (4, "half,whole"), (5, "half,whole")]
    assert child.returncode == 7
    assert printed_lines(tmp_path) == ["told"]


def test_that_a_program_ends_with_the_block_that_was_left_by_an_error(tmp_path) -> None:
    begun = time.monotonic()
    with (
        pytest.raises(KeyError),
        running_program([sys.executable, "-c", "import time; time.sleep(60)"], os.environ, tmp_path) as child,
    ):
        raise KeyError
    assert child.returncode is not None
    assert time.monotonic() - begun < 30


@pytest.mark.parametrize(("parent_ends", "code"), [(False, 0), (True, 1)])
def test_that_a_child_ends_cleanly_by_itself_and_with_its_parent(parent_ends, code) -> None:
    script = (
        "import sys, time; from regolith_studio.io.child_process import end_with_parent;"
        "end_with_parent(sys.stdin.buffer); time.sleep(float(sys.argv[1]))"
    )
    command = [sys.executable, "-c", script, "60" if parent_ends else "0.2"]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as child:
        if parent_ends and child.stdin:
            child.stdin.close()
        assert child.wait() == code
