"""An engine of heaps that needs no time, and what tests of studies share with it."""

import hashlib
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.dem.run_io import save_snapshot
from regolith_studio.dem.snapshot import Snapshot

SMALL = "-n 40 --measure min_particles=40 --test mass=0.003"


def instant_engine(
    _key: str, prepared: PreparedCase, _settings: Any, folder: Path, _threads: int
) -> Generator[Snapshot | None, None, SimulationResult]:
    """A run whose particles stay where they begin, on one level."""
    column = loose_column(prepared)
    flat = replace(column, points=column.points * [1.0, 1.0, 0.0] + [0.0, 0.0, column.diameters.max() / 2])
    save_snapshot(folder, 0, flat)
    yield Snapshot(flat, 0.5, "half")
    yield None
    n = len(flat.points)
    return SimulationResult(flat, RunChecks(n, n, 0.0, 0.0, 0.0, 0.0, 0.0, True, 0.02, 0.55, 0.0), 1, 1.0)


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
