"""What kernels return: a signal that comes meanwhile raises its exception, and the process lives on."""

import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel


class Sums(NamedTuple):
    """What was added up."""

    sums: FloatArray
    total: float


class Answer(NamedTuple):
    """A named tuple in a named tuple."""

    inner: Sums
    pair: tuple[int, bool]


@kernel
def added(n: int) -> Answer:
    """Work for some time."""
    total = 0.0
    for i in range(n):
        total += np.sin(float(i))
    return Answer(Sums(np.full(3, total), total), (n, n > 1))


def test_that_a_named_tuple_from_a_kernel_is_that_of_python() -> None:
    found, same = added(5), added.py_func(5)  # type: ignore[attr-defined]
    assert type(found) is Answer
    assert type(found.inner) is Sums
    assert type(found.inner.sums) is np.ndarray
    assert found.inner.sums == pytest.approx(same.inner.sums)
    assert found.pair == (5, True)
    assert found._replace(pair=(6, False)).pair == (6, False)


INTERRUPTED = """
import signal
from tests.geometry.test_quiet_results import added

def late(*_):
    raise TimeoutError

added(1)
signal.signal(signal.SIGALRM, late)
for _ in range(10):
    signal.setitimer(signal.ITIMER_REAL, 0.01)
    try:
        added(5_000_000)
    except TimeoutError:
        print("told")
"""


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="this system has no such signal")
def test_that_a_signal_during_a_kernel_raises_where_it_was_called() -> None:
    """In its own process: by numba's own code it ends in a segmentation fault."""
    root = Path(__file__).parents[2]
    command = [sys.executable, "-c", INTERRUPTED]
    found = subprocess.run(command, cwd=root, capture_output=True, text=True, timeout=200)
    assert found.returncode == 0, found.stderr
    assert found.stdout.split() == ["told"] * 10
