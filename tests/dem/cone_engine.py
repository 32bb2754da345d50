"""Engines that need no time: heaps of a known angle; and what compares the folders of their studies."""

import hashlib
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.dem.run_io import save_snapshot
from regolith_studio.dem.snapshot import ParticleState, Snapshot
from tests.dem.packings import cone

RunEngine = Callable[..., Generator[Snapshot, None, SimulationResult]]


def true_angle(friction: float) -> float:
    """Degrees of the heaps of :data:`cone_engine`."""
    return 16.0 + 15.0 * friction


def engine_of_cones(angle: Callable[[PreparedCase], float]) -> RunEngine:
    """Cones whose angle follows from the case; the filling is the denser the smaller the friction."""

    def engine(
        _key: str, prepared: PreparedCase, _settings: Any, folder: Path, _threads: int
    ) -> Generator[Snapshot, None, SimulationResult]:
        column, count = loose_column(prepared), len(prepared)
        points = prepared.mean_diameter * cone(angle(prepared), count, prepared.case.seed)
        heap = ParticleState(points, column.diameters, column.orientations, column.class_index)
        save_snapshot(folder, 0, heap)
        yield Snapshot(heap, 0.5, "half")
        solid = 0.60 - 0.1 * prepared.case.contact.static_friction
        checks = RunChecks(count, count, 0.0, 0.0, 0.0, 0.0, 0.0, True, 0.02, solid, 0.0)
        return SimulationResult(heap, checks, 1, 1.0)

    return engine


cone_engine = engine_of_cones(lambda prepared: true_angle(prepared.case.contact.static_friction))


def write_figure(figure: Any, folder: Path, stem: str) -> tuple[Path, Path]:
    """Files in place of figures, which take long."""
    content = repr(np.array([line.get_xydata() for line in figure.axes[0].lines], dtype=object)).encode()
    paths = folder / f"{stem}.png", folder / f"{stem}.svg"
    for path in paths:
        path.write_bytes(content)
    return paths


def tree(folder: Path) -> dict[str, str]:
    """SHA-256 of the files of a study, but for the journal, durations and lists of hashes with durations."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
        and path.relative_to(folder).parts[0] != "journal"
        and path.name != "times.json"
        and path.suffix != ".sha256"
    }
