"""Files and folders to particles: the front door for meshes and for tables of coefficients."""

import logging
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.geometry import repair as mending
from regolith_studio.geometry.health import inspect
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle, Source
from regolith_studio.geometry.welding import welded
from regolith_studio.readers.border_weights import weights_in
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.guard import Guard, shared_guard
from regolith_studio.readers.sentences import counted, sentence_about, shown_name
from regolith_studio.readers.table_particles import TABLE_SUFFIXES, TEXT_SUFFIXES, particle_of_table
from regolith_studio.readers.units import UNITS, unit_factor

__all__ = ["UNITS", "MeshFile", "ProblemListener", "mesh_files", "read_file", "read_mesh", "read_particles"]

ProblemListener = Callable[[Path, str], None]
"""Told of each file that could not be read: its path, and one sentence."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class MeshFile:
    """A file to be read, the group that its place in a folder puts it in, and its particle's weight."""

    path: Path
    group: str = ""
    weight: float = 1.0


def read_mesh(
    path: str | Path, unit: str = "um", *, repair: bool = True, guard: Guard | None = None
) -> Particle:
    """The particle in one file.

    Parameters
    ----------
    path
        STL, PLY, OBJ, OFF, GLB, glTF or 3MF, or a table of coefficients (``l m Re Im``), of which the
        surface is made.
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
    return read_file(MeshFile(Path(path)), unit, repair, guard)


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
    read: list[tuple[MeshFile, Particle]] = []
    problems: list[str] = []
    for file in mesh_files(paths):
        try:
            read.append((file, read_file(file, unit, repair)))
        except (FileError, GeometryError) as error:
            problems.append(str(error))
            tell(file.path, str(error))
    if not read:
        more = (
            f" ({counted(len(problems) - 1, 'more file')} could not be read either.)" if problems[1:] else ""
        )
        raise FileError((problems[0] if problems else "There is no file to read.") + more)
    return _uniquely_named(read)


def read_file(file: MeshFile, unit: str = "um", repair: bool = True, guard: Guard | None = None) -> Particle:
    """As `read_mesh`, for one of `mesh_files`: the particle gets its group and its weight."""
    suffix = file.path.suffix.lower()
    if suffix in TABLE_SUFFIXES:
        return replace(particle_of_table(file.path, unit, file.group, guard), weight=file.weight)
    if suffix in TEXT_SUFFIXES:
        return _mesh_or_table(file, unit, repair, guard)
    return _read_mesh(file, unit, repair, guard)


def _mesh_or_table(file: MeshFile, unit: str, repair: bool, guard: Guard | None) -> Particle:
    """The particle in a text file that says by its content what it is."""
    try:
        return replace(particle_of_table(file.path, unit, file.group, guard), weight=file.weight)
    except FileError as no_table:
        try:
            return _read_mesh(file, unit, repair, guard)
        except FileError:
            said = str(no_table).removeprefix(f"{shown_name(file.path)} ")
            sentence = f"is no mesh, and as a table of coefficients it {said}"
            raise FileError(sentence_about(file.path, sentence)) from None


def _read_mesh(file: MeshFile, unit: str, repair: bool, guard: Guard | None) -> Particle:
    factor = unit_factor(unit)
    path = file.path
    answer = (guard or shared_guard()).request("mesh", path)
    vertices, faces = answer.arrays
    if not answer.header["shares_vertices"]:
        vertices, faces = welded(vertices, faces)
    mesh = Mesh(vertices * factor, faces)
    notes = tuple(answer.header["notes"])
    mended = None
    try:
        if repair:
            mended = mending.repair(mesh)
            mesh, notes = mended.mesh, notes + mended.health_before.problems + mended.actions
        else:
            notes += inspect(mesh).problems
    except GeometryError as error:
        raise GeometryError(sentence_about(path, f"holds no particle: {_lower(str(error))}")) from None
    source = Source(str(path), answer.header["sha256"], unit, repair)
    return Particle(path.stem, mesh, file.group, source, notes, file.weight, mended)


def mesh_files(paths: Sequence[str | Path]) -> list[MeshFile]:
    """The files that `read_particles` would read, in its order: those given, and those in folders.

    Weights come from the ``particles.csv`` that ``extract`` writes beside its meshes.

    Raises
    ------
    FileError
        If a folder holds no mesh file.
    """
    given = [Path(path) for path in paths]
    several = sum(path.is_dir() for path in given) > 1
    files: list[MeshFile] = []
    for path in given:
        found = list(_in_folder(path, several)) if path.is_dir() else [MeshFile(path)]
        if not found:
            raise FileError(
                f"The folder {shown_name(path)} holds no mesh file; "
                f"meshes end in {', '.join(sorted(mesh_suffixes()))}, tables of coefficients in "
                f"{', '.join(TABLE_SUFFIXES)}."
            )
        files += found
    weights = {folder: weights_in(folder) for folder in {file.path.parent for file in files}}
    return [replace(file, weight=weights[file.path.parent].get(file.path.stem, 1.0)) for file in files]


def _in_folder(folder: Path, several: bool) -> Iterator[MeshFile]:
    name = folder.name or folder.resolve().name
    suffixes = mesh_suffixes() | set(TABLE_SUFFIXES)
    for where, folders, files in os.walk(folder):
        folders[:] = sorted(inner for inner in folders if not inner.startswith("."))
        inside = Path(where).relative_to(folder).as_posix()
        group = name if inside == "." else f"{name}/{inside}" if several else inside
        for file in sorted(files):
            if not file.startswith(".") and Path(file).suffix.lower() in suffixes:
                yield MeshFile(Path(where) / file, group)


def _uniquely_named(read: Sequence[tuple[MeshFile, Particle]]) -> list[Particle]:
    """The particles, with those of the same name told apart by their group, then by a number."""
    taken: set[str] = set()
    particles = []
    for file, particle in read:
        name = particle.name
        if name in taken and file.group:
            name = f"{file.group.replace('/', '_')}_{particle.name}"
        base, number = name, 2
        while name in taken:
            name, number = f"{base}_{number}", number + 1
        taken.add(name)
        particles.append(replace(particle, name=name))
    return particles


def _to_log(path: Path, sentence: str) -> None:
    _log.warning("%s: %s", path, sentence)


def _lower(sentence: str) -> str:
    return sentence[0].lower() + sentence[1:]
