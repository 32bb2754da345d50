"""Files and folders to particles: the front door for meshes."""

import logging
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.geometry import repair as mending
from regolith_studio.geometry.health import inspect
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle, Source
from regolith_studio.geometry.welding import welded
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.guard import Guard, shared_guard
from regolith_studio.readers.units import UNITS, unit_factor

__all__ = ["UNITS", "ProblemListener", "read_mesh", "read_particles"]

ProblemListener = Callable[[Path, str], None]
"""Told of each file that could not be read: its path, and one sentence."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class _Candidate:
    """A file to be read, and the group that its place in a folder puts it in."""

    path: Path
    group: str


def read_mesh(
    path: str | Path, unit: str = "um", *, repair: bool = True, guard: Guard | None = None
) -> Particle:
    """The particle in one mesh file.

    Parameters
    ----------
    path
        STL, PLY, OBJ, OFF, GLB, glTF or 3MF.
    unit
        Unit of the file's numbers, a key of `UNITS`, or ``voxel:SIZE`` in micrometres.
    repair
        Whether to make one sound body of it; if not, what is wrong stands in the notes only.
    guard
        The child process that parses the file; by default the one of this process.

    Raises
    ------
    FileError
        With one sentence if the file cannot be read.
    GeometryError
        With one sentence if it holds nothing that encloses a volume.
    """
    return _read(_Candidate(Path(path), ""), unit, repair, guard or shared_guard())


def read_particles(
    paths: Sequence[str | Path],
    unit: str = "um",
    repair: bool = True,
    on_problem: ProblemListener | None = None,
) -> list[Particle]:
    """The particles in mesh files and in folders of them, in the order of their names.

    The files of a folder's sub-folders get the sub-folder's path as their group, those of the
    folder itself its name. Names are made unique.

    Parameters
    ----------
    paths, unit, repair
        As for `read_mesh`; folders are searched to any depth.
    on_problem
        Told of each file that could not be read; by default a line of the program's log.

    Raises
    ------
    FileError
        If no file could be read at all: the first file's sentence.
    """
    tell = on_problem or _to_log
    guard = shared_guard()
    read: list[tuple[_Candidate, Particle]] = []
    problems: list[str] = []
    for candidate in _candidates([Path(path) for path in paths]):
        try:
            read.append((candidate, _read(candidate, unit, repair, guard)))
        except (FileError, GeometryError) as error:
            problems.append(str(error))
            tell(candidate.path, str(error))
    if not read:
        more = f" ({len(problems) - 1:,} more files could not be read either.)" if len(problems) > 1 else ""
        raise FileError((problems[0] if problems else "There is no file to read.") + more)
    return _uniquely_named(read)


def _read(candidate: _Candidate, unit: str, repair: bool, guard: Guard) -> Particle:
    factor = unit_factor(unit)
    path = candidate.path
    answer = guard.request("mesh", path)
    vertices, faces = answer.arrays
    if not answer.header["shares_vertices"]:
        vertices, faces = welded(vertices, faces)
    mesh = Mesh(vertices * factor, faces)
    notes = tuple(answer.header["notes"])
    try:
        if repair:
            mended = mending.repair(mesh)
            mesh, notes = mended.mesh, notes + mended.health_before.problems + mended.actions
        else:
            notes += inspect(mesh).problems
    except GeometryError as error:
        raise GeometryError(f"{path.name} holds no particle: {_lower(str(error))}") from None
    source = Source(str(path), answer.header["sha256"], unit)
    return Particle(path.stem, mesh, candidate.group, source, notes)


def _candidates(paths: Sequence[Path]) -> Iterator[_Candidate]:
    several = sum(path.is_dir() for path in paths) > 1
    for path in paths:
        if not path.is_dir():
            yield _Candidate(path, "")
            continue
        found = list(_in_folder(path, several))
        if not found:
            raise FileError(
                f"The folder {path.name or path} holds no mesh file; "
                f"meshes end in {', '.join(sorted(mesh_suffixes()))}."
            )
        yield from found


def _in_folder(folder: Path, several: bool) -> Iterator[_Candidate]:
    name = folder.name or folder.resolve().name
    suffixes = mesh_suffixes()
    for where, folders, files in os.walk(folder):
        folders[:] = sorted(inner for inner in folders if not inner.startswith("."))
        inside = Path(where).relative_to(folder).as_posix()
        group = name if inside == "." else f"{name}/{inside}" if several else inside
        for file in sorted(files):
            if not file.startswith(".") and Path(file).suffix.lower() in suffixes:
                yield _Candidate(Path(where) / file, group)


def _uniquely_named(read: Sequence[tuple[_Candidate, Particle]]) -> list[Particle]:
    """The particles, with those of the same name told apart by their group, then by a number."""
    taken: set[str] = set()
    particles = []
    for candidate, particle in read:
        name = particle.name
        if name in taken and candidate.group:
            name = f"{candidate.group.replace('/', '_')}_{particle.name}"
        base, number = name, 2
        while name in taken:
            name, number = f"{base}_{number}", number + 1
        taken.add(name)
        particles.append(Particle(name, particle.mesh, particle.group, particle.source, particle.notes))
    return particles


def _to_log(path: Path, sentence: str) -> None:
    _log.warning("%s: %s", path, sentence)


def _lower(sentence: str) -> str:
    return sentence[0].lower() + sentence[1:]
