"""Jobs and runs that are done step by step in this thread."""

from collections.abc import Generator
from typing import Any


def played(steps: Generator[Any, None, Any]) -> tuple[list[Any], Any]:
    """What the steps of a job yield, and its result."""
    received = []
    while True:
        try:
            received.append(next(steps))
        except StopIteration as end:
            return received, end.value
