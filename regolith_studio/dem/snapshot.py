"""State of the particles at one moment, and its ``.npz`` file."""

import io
import json
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats, locked_integers
from regolith_studio.io.own_files import read_archive, read_arrays
from regolith_studio.messages import N_, Message, Number

PHASES = (N_("fill"), N_("settle"), N_("lift"), N_("rest"))
"""Of the test, in their order."""
LEVEL, TURN = N_("level"), N_("turn")
DRUM_PHASES = (*PHASES[:2], LEVEL, TURN)
"""Of a rotating drum: it is filled standing and laid on its side before it turns."""


def progress_message(phase: str, seconds: float) -> Message:
    """How far a simulation is: its phase and the simulated time."""
    return Message(N_("{phase}, {time} s simulated"), phase=Message(phase), time=Number(seconds, ".2f"))


@dataclass(frozen=True, eq=False)
class ParticleState(LockedRecord):
    """Particles at one moment, in SI units, z up, the plate at z = 0.

    - ``points``: centres of mass in metres, shape (n, 3).
    - ``diameters``: equivalent diameters in metres, shape (n,).
    - ``orientations``: quaternions (w, x, y, z) from a shape of the dataset to the particle, shape (n, 4).
    - ``class_index``: index of each particle's shape, shape (n,).
    - ``time``: simulated seconds.
    - ``wall``: height of the cylinder's lower rim in metres; infinite after it was removed.
    - ``phase``: of the test: ``fill``, ``settle``, ``lift``, ``rest`` ...
    """

    points: FloatArray
    diameters: FloatArray
    orientations: FloatArray
    class_index: IntArray
    time: float = 0.0
    wall: float = float("inf")
    phase: str = ""

    def __post_init__(self) -> None:
        n = len(self.points)
        for name, shape in (("points", (None, 3)), ("diameters", (n,)), ("orientations", (n, 4))):
            object.__setattr__(self, name, locked_floats(getattr(self, name), shape, name))
        object.__setattr__(self, "class_index", locked_integers(self.class_index, (n,), "class_index"))

    def __len__(self) -> int:
        return len(self.points)


@dataclass(frozen=True, eq=False)
class EngineState:
    """All that an engine needs to go on from one moment.

    ``records``: of the run, as JSON. ``solver``: the solver's own state.
    """

    records: Mapping[str, Any]
    solver: bytes


@dataclass(frozen=True, eq=False)
class Snapshot:
    """One moment of a running simulation.

    - ``particles``: where they are.
    - ``share``: of the work that is done, 0 to 1.
    - ``message``: one line on the progress.
    - ``state``: gives all that is needed to go on from here, for an engine that can; called at once or
      never.
    """

    particles: ParticleState
    share: float
    message: str
    state: Callable[[], EngineState] | None = None


def engine_state_bytes(state: EngineState, key: str, number: int) -> bytes:
    """The content of a file of a state.

    ``key``: of the run that may go on from it. ``number``: of the next snapshot.
    """
    buffer = io.BytesIO()
    head = json.dumps({"key": key, "number": number, "records": dict(state.records)})
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("head.json", head)
        archive.writestr("solver.bin", state.solver)
    return buffer.getvalue()


def read_engine_state(path: Path, key: str) -> tuple[EngineState, int] | None:
    """State of a run and number of its next snapshot; ``None`` if there is none, or that of another run."""
    try:
        content = read_archive(path, "state of an engine")
        head = json.loads(content["head.json"])
        if head["key"] != key:
            return None
        return EngineState(head["records"], content["solver.bin"]), int(head["number"])
    except (FileError, KeyError, TypeError, ValueError, RecursionError):
        return None


def particle_state_bytes(pile: ParticleState) -> bytes:
    """The content of a ``.npz`` file."""
    buffer = io.BytesIO()
    np.savez_compressed(
        buffer,
        points_m=pile.points,
        diameters_m=pile.diameters,
        orientations=pile.orientations.astype(np.float32),
        class_index=pile.class_index.astype(np.int32),
        time_s=np.float64(pile.time),
        wall_m=np.float64(pile.wall),
        phase=np.array(pile.phase),
    )
    return buffer.getvalue()


def read_particle_state(path: Path) -> ParticleState:
    """The particles of a ``.npz`` file that this program wrote.

    Raises FileError if it is none.
    """
    content = read_arrays(path, "particles of a simulation")
    try:
        return ParticleState(
            content["points_m"].astype(np.float64),
            content["diameters_m"],
            content["orientations"].astype(np.float64),
            content["class_index"],
            float(content["time_s"]),
            float(content["wall_m"]),
            str(content["phase"]),
        )
    except (KeyError, ValueError, TypeError) as error:
        raise FileError(f"{path.name} holds no particles of a simulation of this program.") from error
