"""The certificate of an engine: which measured lines it passes, and what is said of it beside its angles."""

from collections.abc import Generator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from regolith_studio.dem.engines import ENGINES
from regolith_studio.dem.verification import MeasuredLine, Measurement, VerifiableEngine, heaps, scenes
from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.steps import as_events

SCENES: Mapping[str, Measurement] = {
    "incline": scenes.incline,
    "sliding": scenes.sliding,
    "fall": scenes.fall,
    "stack": scenes.stack,
    "loose_dice": heaps.loose_dice,
    "tapped_dice": heaps.tapped_dice,
}
HEAPS: Mapping[str, Measurement] = {
    "rest": heaps.settled_heap,
    "contacts": heaps.contacts,
    "repeats": heaps.repeats,
    "half_step": heaps.half_step,
    "gravity": heaps.gravities,
}
"""Measurements by key: of the engine alone, and of heaps that several lines share."""
QUICK = ("incline", "sliding", "fall", "stack", "rest", "contacts", "repeats", "half_step")
MEASUREMENTS = (*QUICK, "gravity", "loose_dice", "tapped_dice")
"""Keys in the order of a certificate; those of a quick verification come first."""


@dataclass(frozen=True)
class Certificate:
    """What was measured of one version of an engine.

    - ``engine``, ``version``: key, and version that was installed.
    - ``lines``: in the order in which they were measured.
    - ``left_out``: keys of lines that were not measured.
    """

    engine: str
    version: str
    lines: tuple[MeasuredLine, ...]
    left_out: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether the engine passes all lines that were measured."""
        return all(line.passed for line in self.lines)

    @property
    def failed(self) -> tuple[MeasuredLine, ...]:
        """Lines that it does not pass."""
        return tuple(line for line in self.lines if not line.passed)


def verifiable_engine(key: str) -> VerifiableEngine:
    """The engine of this key, if it can be verified.

    Raises InputError if there is none, or bodies cannot be placed in it one by one. Raises
    MissingRequirement if it is not installed.
    """
    stepped = [each.key for each in ENGINES.values() if isinstance(each, VerifiableEngine)]
    engine = ENGINES.get(key)
    if not isinstance(engine, VerifiableEngine):
        raise InputError(
            f"The engine {key!r} cannot be verified; engines that are stepped from here can: "
            f"{', '.join(stepped)}."
        )
    if problem := engine.find().problem:
        raise MissingRequirement(problem)
    return engine


Turn = tuple[str, MeasuredLine | None]
"""Key of a line, and the line when it is done."""


def measure_lines(runs: heaps.HeapRuns, keys: tuple[str, ...]) -> Generator[Turn, None, Certificate]:
    """Measure lines; yields the key of the line at each turn, and the line as it is done."""
    lines = []
    for key in keys:
        lines.append((yield from _measure_line(runs, key)))
    left_out = tuple(key for key in MEASUREMENTS if key not in keys)
    return Certificate(runs.engine.key, runs.engine.find().version, tuple(lines), left_out)


def _measure_line(runs: heaps.HeapRuns, key: str) -> Generator[Turn, None, MeasuredLine]:
    steps = HEAPS[key](runs) if key in HEAPS else SCENES[key](runs.engine)
    line = yield from as_events(steps, lambda _step: ((key, None),))
    yield key, line
    return line


def certificate_document(certificate: Certificate) -> dict[str, Any]:
    """As JSON."""
    return {
        "engine": certificate.engine,
        "version": certificate.version,
        "passed": certificate.passed,
        "lines": [
            {**asdict(line), "band": str(line.band), "note": str(line.note)} for line in certificate.lines
        ],
        "failed": ", ".join(line.key for line in certificate.failed) or "none",
        "left_out": list(certificate.left_out),
    }
