"""Verification of an engine: which can be, and lines with bands that were set before the first run."""

import functools
import time
from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import Any, Protocol, runtime_checkable

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import Engine
from regolith_studio.dem.lifting_cylinder import Solver


@dataclass(frozen=True)
class MeasuredLine:
    """One measured line.

    - ``key``, ``what``: what is measured, for programs and in words.
    - ``value``, ``unit``: the measured value; ``None`` where nothing could be measured.
    - ``band``: where the value passes, in words.
    - ``passed``: whether it lies there.
    - ``note``: what else the value needs to be understood.
    - ``seconds``: by the clock.
    """

    key: str
    what: str
    value: float | None
    unit: str
    band: str
    passed: bool
    note: str = ""
    seconds: float = 0.0


@runtime_checkable
class VerifiableEngine(Engine, Protocol):
    """An engine with a solver, in which bodies can be placed one by one."""

    def solver(self, prepared: PreparedCase, settings: Any) -> Solver:
        """The solver of a case."""
        ...


Measurement = Callable[..., Generator[None, None, MeasuredLine]]


def timed(measure: Measurement) -> Measurement:
    """The measurement, with the time that it took in its line."""

    @functools.wraps(measure)
    def with_time(*arguments: Any) -> Generator[None, None, MeasuredLine]:
        began = time.monotonic()
        line = yield from measure(*arguments)
        return replace(line, seconds=time.monotonic() - began)

    return with_time
