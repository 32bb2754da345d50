"""An engine that needs no time: heaps whose angle follows from the friction."""

from collections.abc import Generator
from pathlib import Path
from typing import Any

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.dem.run_io import save_snapshot
from regolith_studio.dem.snapshot import ParticleState, Snapshot
from tests.dem.packings import cone


def true_angle(friction: float) -> float:
    """Degrees of the heaps of the engine below."""
    return 16.0 + 15.0 * friction


def cone_engine(
    _key: str, prepared: PreparedCase, _settings: Any, folder: Path, _threads: int
) -> Generator[Snapshot, None, SimulationResult]:
    """A cone whose angle follows from the friction; the filling is the denser the smaller the friction."""
    friction, seed = prepared.case.contact.static_friction, prepared.case.seed
    column = loose_column(prepared)
    count = len(prepared)
    points = prepared.mean_diameter * cone(true_angle(friction), count, seed)
    heap = ParticleState(points, column.diameters, column.orientations, column.class_index)
    save_snapshot(folder, 0, heap)
    yield Snapshot(heap, 0.5, "half")
    checks = RunChecks(count, count, 0.0, 0.0, 0.0, 0.0, 0.0, True, 0.02, 0.60 - 0.1 * friction, 0.0)
    return SimulationResult(heap, checks, 1, 1.0)
