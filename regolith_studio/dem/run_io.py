"""The folder of a run: snapshots, ``repose.json`` with the result, and ``final.npz`` with the final state."""

import hashlib
import io
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest, missing_in_paper
from regolith_studio.dem.angle_of_repose import ReposeMeasurement, measurement_document
from regolith_studio.dem.case import PreparedCase, ReposeCase, scaling_report
from regolith_studio.dem.drum_angle import DrumMeasurement, drum_document
from regolith_studio.dem.engine import Engine, RunChecks, SimulationResult
from regolith_studio.dem.engines import engine_notes
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.heap_packing import HeapPacking, packing_document
from regolith_studio.dem.snapshot import ParticleState, particle_state_bytes, read_particle_state
from regolith_studio.errors import FileError, RegolithError, os_error_reason
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.atomic import exchange, remove_quietly
from regolith_studio.io.file_names import natural_key
from regolith_studio.io.output_lock import NEW, hidden_beside, output_lock
from regolith_studio.io.own_files import canonical_json, read_arrays, read_json
from regolith_studio.messages import N_, Message, from_json, to_json
from regolith_studio.version import __version__

Measured = ReposeMeasurement | DrumMeasurement | NotAPileError
"""What a run has found, or why it has found no angle."""
FORMAT = "regolith-studio-repose"
SCHEMA_VERSION = 1
DOCUMENT, FINAL, SHAPES, SNAPSHOTS = "repose.json", "final.npz", "shapes.npz", "snapshots"
TIMES = "times.json"
STATE = "state.zip"
"""State of the engine in an unfinished run."""
OWN = {DOCUMENT, FINAL, SHAPES, SNAPSHOTS, TIMES, STATE, "sections.png", "sections.svg"}
ENGINE_FILES = ".engine-"
"""Beginning of the name of a folder with an engine's temporary files."""
UNFINISHED = f".unfinished{NEW}"
"""End of the hidden name of a run on its way."""


@dataclass(frozen=True)
class RunSummary:
    """One line of the table of runs."""

    folder: Path
    document: dict[str, Any]

    @property
    def angle(self) -> float | None:
        """Degrees, or ``None`` where there is no pile."""
        angle = (self.document.get("measurement") or {}).get("angle_deg")
        return None if angle is None else float(angle)

    def message(self, sentence: str) -> str:
        """A sentence of the document as a message that can be translated, where it was written as one."""
        messages = map(from_json, self.document.get("messages", ()))
        return next((each for each in messages if each == sentence), sentence)


@contextmanager
def staged_run(folder: Path, overwrite: bool) -> Iterator[Path]:
    """A hidden folder to save a run in, which takes the place of `folder` in one step at the end.

    Without a document in it there is nothing to keep, and a run that did not finish replaces no finished one.
    A killed process leaves the folder; where a state of the engine is in it, or in the stopped run that
    `folder` holds, the next run begins with its content.

    Raises FileError if `folder` holds something else, or may not be replaced, or cannot be written.
    """
    try:
        _check_replaceable(folder, overwrite)
        with output_lock(folder):
            target = Path(os.path.realpath(folder))
            stage = hidden_beside(target, UNFINISHED)
            _fill_stage(stage, target)
            try:
                yield stage
            except RegolithError as error:
                error.args = tuple(str(each).replace(str(stage), str(target)) for each in error.args)
                raise
            finally:
                _end_stage(stage, target)
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be written ({os_error_reason(error)}).") from error


def _fill_stage(stage: Path, target: Path) -> None:
    """Make the hidden folder, with what an unfinished run left that can go on."""
    if not (stage / STATE).is_file():
        remove_quietly(stage)
        stage.mkdir()
        if (target / STATE).is_file() and not _is_finished(target):
            shutil.copy(target / STATE, stage / STATE)
            shutil.copytree(target / SNAPSHOTS, stage / SNAPSHOTS)
    for path in stage.iterdir():
        if path.name.startswith(ENGINE_FILES):
            remove_quietly(path)
    (stage / SNAPSHOTS).mkdir(exist_ok=True)
    (stage / DOCUMENT).unlink(missing_ok=True)


def _end_stage(stage: Path, target: Path) -> None:
    if (stage / DOCUMENT).is_file() and (_is_finished(stage) or not _is_finished(target)):
        if _is_finished(stage):
            (stage / STATE).unlink(missing_ok=True)
        exchange(stage, target)
    elif (stage / STATE).is_file():
        return
    remove_quietly(stage)


def _check_replaceable(folder: Path, overwrite: bool) -> None:
    inside = {path.name for path in folder.iterdir()} if folder.exists() else set()
    if foreign := inside - OWN:
        raise FileError(f"{folder} holds other files ({min(foreign)}); choose an empty folder.")
    if inside and not overwrite:
        raise FileError(f"{folder} holds a run already; choose another folder or allow it to be overwritten.")


def _is_finished(folder: Path) -> bool:
    try:
        return bool(read_run(folder).document.get("state") == "finished")
    except FileError:
        return False


def save_snapshot(folder: Path, number: int, particles: ParticleState) -> Path:
    """Write one snapshot in one step."""
    return _write(folder / SNAPSHOTS / f"{number:06d}.npz", particle_state_bytes(particles))


def save_engine_state(folder: Path, content: bytes) -> Path:
    """Write the state of the engine in one step."""
    return _write(folder / STATE, content)


def remove_snapshots(folder: Path, first: int) -> None:
    """Remove the snapshots from this number on, which an interrupted run wrote after its last state."""
    for path in snapshot_files(folder):
        if int(path.stem) >= first:
            path.unlink()


def run_key(prepared: PreparedCase, engine: Engine, settings: Any) -> str:
    """Hash of all that a run depends on."""
    document = {
        "case": case_document(prepared.case),
        "dataset": prepared.dataset_hash,
        "parts": [list(counts) for counts in prepared.parts],
        "engine": [engine.key, engine.find().version, asdict(settings)],
        "coarse_graining": prepared.coarse_graining,
        "filling": filling_hash(prepared.filling),
    }
    digest = hashlib.sha256(canonical_json(document).encode("utf-8"))
    for array in (prepared.diameters, prepared.class_index, *prepared.shapes):
        digest.update(array.tobytes())
    return digest.hexdigest()


def filling_hash(filling: ParticleState | None) -> str | None:
    """SHA-256 of the filling that a run begins with, as hexadecimal; ``None`` where it fills the cylinder."""
    return None if filling is None else hashlib.sha256(particle_state_bytes(filling)).hexdigest()


def settled_filling(folder: Path) -> ParticleState:
    """The settled filling of a run.

    Raises FileError if the folder holds no run that has filled its cylinder.
    """
    later = False
    for state in map(read_particle_state, reversed(snapshot_files(folder))):
        if state.phase == "settle" and later:
            return state
        later = later or state.phase not in ("fill", "settle")
    raise FileError(f"{folder.name} holds no settled filling; name the folder of a run that was lifted.")


def with_filling(prepared: PreparedCase, folder: Path) -> PreparedCase:
    """The case with the settled filling of an earlier run of the same particles in the same cylinder.

    Gravity, lift, wall and plate may be others. What else the filling remembers is a note where it differs.

    Raises FileError if the folder holds no run that has filled its cylinder, or one of other particles or
    another cylinder.
    """
    state, earlier = settled_filling(folder), read_run(folder).document
    same = (
        len(state) == len(prepared)
        and np.array_equal(state.diameters, prepared.diameters)
        and np.array_equal(state.class_index, prepared.class_index)
        and earlier["dataset"]["sha256"] == (prepared.dataset_hash or None)
        and earlier["case"]["test"]["diameter"] == prepared.case.test.diameter
        and earlier["case"]["shapes"] == prepared.case.shapes
    )
    if not same:
        raise FileError(
            f"{folder.name} was filled with other particles or has another cylinder; its filling goes with "
            f"the same dataset, number, seed, mass and diameter of the cylinder."
        )
    contact, filled = prepared.case.contact, earlier["case"]["contact"]
    remembered = (
        ("friction", filled["static_friction"], contact.static_friction),
        ("rolling resistance", filled["rolling_friction"], contact.rolling_friction),
        ("Bond number", earlier["particles"]["bond_number"][2], scaling_report(prepared).bond_number[2]),
    )
    notes = [f"{folder.name}: {note}" for note in earlier["filling"]["notes"]]
    notes += [
        f"The cylinder was filled with a {what} of {was:.3g}, not {now:.3g}."
        for what, was, now in remembered
        if not np.isclose(was, now)
    ]
    return replace(prepared, filling=state, filling_notes=tuple(notes))


def with_kept_filling(
    prepared: PreparedCase, engine: Engine, settings: Any, folders: Sequence[Path]
) -> PreparedCase:
    """The case with the first of the fillings of earlier runs that this engine would make again.

    The case itself where there is none. A run that began with a filling is passed by: its document does
    not say with which friction that was made.
    """
    version, chosen = engine.find().version, canonical_json(asdict(settings))
    for folder in folders:
        try:
            document = read_run(folder).document
            made_by = document["engine"]
            if (
                (made_by["key"], made_by["version"]) != (engine.key, version)
                or canonical_json(made_by["settings"]) != chosen
                or document["case"]["seed"] != prepared.case.seed
                or document["filling"]["sha256"] is not None
            ):
                continue
            filled = with_filling(prepared, folder)
        except (FileError, KeyError, TypeError):
            continue
        if not filled.filling_notes:
            note = Message(N_("The filled cylinder of {run} is used again."), run=folder.name)
            return replace(filled, filling_notes=(note,))
    return prepared


def save_shapes(folder: Path, prepared: PreparedCase) -> Path:
    """The unit-volume shapes of a run, so that it can be replayed without its dataset."""
    buffer = io.BytesIO()
    shapes: dict[str, Any] = {
        f"shape_{kind:05d}.part_{number:02d}": vertices
        for kind, parts in enumerate(prepared.part_vertices)
        for number, vertices in enumerate(parts)
    }
    np.savez_compressed(buffer, **shapes)
    return _write(folder / SHAPES, buffer.getvalue())


def save_result(folder: Path, document: dict[str, Any], final: ParticleState | None, seconds: float) -> None:
    """Write the result; the document is written last, when all other files exist.

    The duration is in ``times.json`` alone, so that equal runs have equal documents.

    Raises FileError if the disk is full or the folder is gone.
    """
    try:
        if final is not None:
            content = particle_state_bytes(final)
            _write(folder / FINAL, content)
            document = document | {"final_sha256": hashlib.sha256(content).hexdigest()}
        if (folder / SHAPES).is_file():
            content = (folder / SHAPES).read_bytes()
            document = document | {"shapes_sha256": hashlib.sha256(content).hexdigest()}
        _write(folder / TIMES, canonical_json({"seconds": round(seconds, 3)}).encode("utf-8"))
        _write(folder / DOCUMENT, canonical_json(document).encode("utf-8"))
    except OSError as error:
        reason = os_error_reason(error)
        raise FileError(f"The result cannot be written to {folder} ({reason}).") from error


def read_final_state(path: Path) -> ParticleState:
    """Particles of a snapshot, or of a run's final state, which must be that of the document beside it.

    Raises FileError if the file is broken, or the final state of another run.
    """
    state = read_particle_state(path)
    if path.name == FINAL:
        _check_of_run(path, "final_sha256", "is not the final state")
    return state


def snapshot_files(folder: Path) -> list[Path]:
    """Snapshots of a run in the order of time."""
    return sorted((folder / SNAPSHOTS).glob("[0-9]*.npz"))


def read_shapes(folder: Path) -> tuple[tuple[FloatArray, ...], ...]:
    """Vertices of the convex parts of the shapes of a run.

    Raises FileError if the file is missing or broken, or those of another run.
    """
    content = read_arrays(folder / SHAPES, "shapes of a run")
    _check_of_run(folder / SHAPES, "shapes_sha256", "are not the shapes")
    shapes: dict[str, list[FloatArray]] = {}
    for name in sorted(content):
        if content[name].ndim != 2 or content[name].shape[1] != 3 or content[name].dtype.kind != "f":
            raise FileError(f"{folder / SHAPES} holds no shapes of a run.")
        shapes.setdefault(name.partition(".")[0], []).append(content[name].astype(np.float64))
    return tuple(tuple(parts) for parts in shapes.values())


def _check_of_run(path: Path, key: str, problem: str) -> None:
    """Check that a file is the one whose SHA-256 the document beside it holds."""
    if (path.parent / DOCUMENT).is_file():
        expected = read_run(path.parent).document.get(key)
        if expected not in (None, hashlib.sha256(path.read_bytes()).hexdigest()):
            raise FileError(f"{path} {problem} of the run that {DOCUMENT} beside it describes.")


def read_run(folder: Path) -> RunSummary:
    """The result of a run.

    Raises FileError if the folder holds none.
    """
    path = folder / DOCUMENT
    try:
        document = read_json(path)
    except FileError as error:
        raise FileError(f"{folder} holds no result of a run.") from error
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise FileError(f"{path} is no result of a run of this program.")
    return RunSummary(folder, document)


def find_runs(folder: Path) -> list[RunSummary]:
    """Runs in a folder and directly below it, in the natural order of names; invalid ones are skipped."""
    runs = []
    below = sorted(
        (path for path in folder.iterdir() if path.is_dir()), key=lambda path: natural_key(path.name)
    )
    for place in (folder, *below):
        try:
            runs.append(read_run(place))
        except FileError:
            continue
    return runs


def _write(path: Path, content: bytes) -> Path:
    fresh = path.with_name(f".{path.name}.new")
    try:
        fresh.write_bytes(content)
        os.replace(fresh, path)  # noqa: PTH105
    except OSError:
        fresh.unlink(missing_ok=True)
        raise
    return path


def run_document(
    prepared: PreparedCase,
    engine: Engine,
    settings: Any,
    *,
    state: str,
    ending: SimulationResult | None = None,
    measured: Measured | None = None,
    packing: HeapPacking | None = None,
    problem: str | None = None,
    n_snapshots: int = 0,
) -> dict[str, Any]:
    """The document. SI units, angles in degrees.

    - ``state``: ``finished``, ``stopped`` by the user, or ``failed``.
    - ``measured``: the measurement, or why there is no angle.
    - ``packing``: of the heap.
    - ``problem``: the message of a failed run.
    """
    case, notes = prepared.case, list(prepared.filling_notes)
    notes += [*ending.notes, *engine_notes(engine)] if ending else []
    sentences = (*notes, *_sentences(ending, measured))
    return {
        "format": FORMAT,
        "schema_version": SCHEMA_VERSION,
        "state": state,
        "problem": problem,
        "dataset": {"name": prepared.dataset_name, "sha256": prepared.dataset_hash or None},
        "engine": {
            "key": engine.key,
            "label": engine.label,
            "version": engine.find().version,
            "settings": asdict(settings),
            "capabilities": asdict(engine.capabilities),
        },
        "software": {"regolith-studio": __version__},
        "length_unit": "m",
        "case": case_document(case),
        "filling": {"sha256": filling_hash(prepared.filling), "notes": list(prepared.filling_notes)},
        "not_given_in_the_paper": [
            *missing_in_paper(LiftingCylinderTest),
            *missing_in_paper(ContactParameters),
        ],
        "particles": {
            "mass": prepared.mass,
            "mean_facets": prepared.mean_facets,
            "surface_energy": prepared.surface_energy,
            **_plain(asdict(scaling_report(prepared))),
        },
        "run": {
            "steps": ending.steps if ending else None,
            "simulated_time": ending.simulated_time if ending else None,
            "n_snapshots": n_snapshots,
            "notes": notes,
        },
        "checks": _checks(ending.checks) if ending else None,
        "packing": packing_document(
            case.contact.density, ending.checks.solid_fraction if ending else None, packing
        ),
        "measurement": _measurement(measured),
        "messages": [to_json(each) for each in sentences if isinstance(each, Message)],
    }


def _sentences(ending: SimulationResult | None, measured: Measured | None) -> Sequence[str]:
    """The sentences of a document."""
    of_run = ending.checks.problems if ending else ()
    match measured:
        case ReposeMeasurement() | DrumMeasurement():
            return (*of_run, *measured.warnings)
        case NotAPileError():
            return (*of_run, measured.sentence)
        case _:
            return of_run


def case_document(case: ReposeCase) -> dict[str, Any]:
    """The parameters of the case as JSON."""
    document = {
        "test": asdict(case.test),
        "contact": asdict(case.contact),
        "n_particles": case.n_particles,
        "coarse_graining_asked": case.coarse_graining or None,
        "shapes": case.shapes,
        "cohesion": case.cohesion,
        "bond_number": case.bond_number or None,
        "seed": case.seed,
    }
    return document if case.drum is None else document | {"drum": asdict(case.drum)}


def _measurement(measured: Measured | None) -> dict[str, Any] | None:
    match measured:
        case ReposeMeasurement():
            return measurement_document(measured)
        case DrumMeasurement():
            return drum_document(measured)
        case NotAPileError():
            return {"status": measured.status, "angle_deg": None, "reason": str(measured)}
        case _:
            return None


def _checks(checks: RunChecks) -> dict[str, Any]:
    return _plain(asdict(checks)) | {"passed": not checks.problems}


def _plain(fields: dict[str, Any]) -> dict[str, Any]:
    return {name: list(value) if isinstance(value, tuple) else value for name, value in fields.items()}
