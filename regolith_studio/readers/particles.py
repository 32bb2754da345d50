"""Read particles from files and folders: meshes, tables of coefficients, and the shipped sample."""

import csv
import logging
import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

from regolith_studio.errors import FileError, GeometryError, MissingRequirement
from regolith_studio.geometry import repair as mesh_repair
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import inspect
from regolith_studio.geometry.particle import Particle, Source
from regolith_studio.geometry.topology import merged_vertices
from regolith_studio.io.atomic import check_listed, listed_hashes
from regolith_studio.io.file_names import file_stem, name_key, natural_key, unique_name
from regolith_studio.io.tables import read_csv
from regolith_studio.messages import N_, Message, count_message
from regolith_studio.readers.archives import (
    WEIGHTS_FILE,
    ArchiveMember,
    archive_content,
    archive_of,
    is_archive,
)
from regolith_studio.readers.coefficient_tables import (
    DEFAULT_TABLE_READING,
    TABLE_SUFFIXES,
    TEXT_SUFFIXES,
    TableConvention,
    TableReading,
    read_table_particle,
)
from regolith_studio.readers.error_messages import (
    display_name,
    lower_first,
    message_about,
    plural,
    printable,
)
from regolith_studio.readers.formats import MESH_FORMATS, mesh_suffixes
from regolith_studio.readers.sandbox.parent import sha256_of, shared_sandbox
from regolith_studio.readers.settings import AS_USUAL, ReadingSettings, unit_factor
from regolith_studio.readers.zip_members import SUFFIX
from regolith_studio.resources import resource

ProblemListener = Callable[[Path, str], None]
"""Called for each file that could not be read, with its path and one sentence."""

_log = logging.getLogger(__name__)

_COMPANIONS = (
    ".json", ".csv", ".md", ".rst", ".html", ".pdf", ".png", ".jpg", ".svg", ".gif", ".log", ".sha256",
    ".mtl", ".bin",
)  # fmt: skip
"""Suffixes of what lies beside meshes: documents, pictures, and parts of OBJ and glTF."""


_UNLISTED: Mapping[str, str] = {}


@dataclass(frozen=True)
class MeshFile:
    """A file to be read, the group that its place in a folder puts it in, and its particle's weight.

    `listed` holds the SHA-256 of files by their names, as the list of its folder has them. Tables of
    coefficients are read as `tables` says. A `member` of an archive has a path as if that were a folder.
    """

    path: Path
    group: str = ""
    weight: float = 1.0
    listed: Mapping[str, str] = field(default_factory=dict)
    tables: TableReading = DEFAULT_TABLE_READING
    member: ArchiveMember | None = None


@dataclass(frozen=True)
class FileProblem:
    """A file that could not be read, and why, in one sentence."""

    path: str
    sentence: str

    @property
    def with_path(self) -> str:
        """The sentence with the whole path, where the file's name alone may be ambiguous."""
        name = display_name(Path(self.path))
        if self.sentence.startswith(f"{name} "):
            return self.path + self.sentence.removeprefix(name)
        return f"{self.path}: {self.sentence}"


@dataclass(frozen=True)
class LoadedParticles:
    """Particles with unique names, files that could not be read, and sentences about others in folders."""

    particles: tuple[Particle, ...]
    problems: tuple[FileProblem, ...] = ()
    left_out: tuple[str, ...] = ()


def read_mesh(
    path: str | Path,
    unit: str = "um",
    *,
    repair: bool = True,
    l_max: int | None = None,
    convention: TableConvention = "auto",
) -> Particle:
    """The particle in one file.

    Parameters
    ----------
    path
        STL, PLY, OBJ, OFF, GLB, glTF or 3MF, or a table of coefficients (``l m Re Im``), of which the
        surface is made.
    unit
        Unit of the file's numbers, a key of `UNITS`, where the file states none itself (3MF and glTF do), or
        ``voxel:SIZE``: its micrometres, which count more than the file's own unit.
    repair
        Whether to make one sound body of it; if not, what is wrong stands in the notes only.
    l_max
        Degree above which coefficients of a table are left out; by default none are.
    convention
        Of a table of coefficients, as `read_coefficients` takes it.

    Raises
    ------
    FileError
        With one sentence if the file cannot be read.
    GeometryError
        With one sentence if it holds nothing that encloses a volume.
    """
    file = MeshFile(Path(path), tables=TableReading(l_max, convention))
    if archive_of(file.path) is not None:
        file = mesh_files([path])[0]
    return read_file(file, ReadingSettings(unit, repair))


def read_particles(
    paths: Sequence[str | Path],
    unit: str = "um",
    repair: bool = True,
    on_problem: ProblemListener | None = None,
    l_max: int | None = None,
    convention: TableConvention = "auto",
) -> list[Particle]:
    """The particles in mesh files and in folders of them, in the order of their names.

    The files of a folder's sub-folders get the sub-folder's path as their group, those of the
    folder itself its name. Names are made unique.

    Parameters
    ----------
    paths, unit, repair, l_max, convention
        As for `read_mesh`; folders are searched to any depth.
    on_problem
        Called for each file that could not be read; by default it is written to the program's log.

    Raises
    ------
    FileError
        If no file could be read at all: the first file's message.
    """
    problems: list[FileProblem] = []
    files = find_files(paths, problems, TableReading(l_max, convention))
    results = [result for _, result in read_each(files, ReadingSettings(unit, repair))]
    loaded = collect_particles(results, problems)
    for problem in loaded.problems:
        (on_problem or _log_problem)(Path(problem.path), problem.sentence)
    return list(loaded.particles)


def read_each(
    files: Sequence[MeshFile], reading: ReadingSettings = AS_USUAL
) -> Iterator[tuple[MeshFile, "Particle | FileProblem"]]:
    """Read one file after the other; a file that cannot be read gives a `FileProblem`."""
    for file in files:
        try:
            yield file, read_file(file, reading)
        except (FileError, GeometryError) as error:
            yield file, FileProblem(str(file.path), str(error))


def collect_particles(
    results: Iterable["Particle | FileProblem"], problems: Sequence[FileProblem] = ()
) -> LoadedParticles:
    """The results of `read_each` under unique names.

    ``problems``: of folders, which come before those of files.

    Raises FileError if there is no particle: the first problem's message, and the number of the others.
    """
    results = list(results)
    particles = [result for result in results if isinstance(result, Particle)]
    problems = (*problems, *(result for result in results if isinstance(result, FileProblem)))
    if particles:
        return LoadedParticles(unique_names(particles), problems)
    if not problems:
        raise FileError("There is no file to read.")
    more = f" ({plural(len(problems) - 1, 'more file')} could not be read either.)" if problems[1:] else ""
    raise FileError(problems[0].sentence + more)


def unique_names(particles: Sequence[Particle], taken: Sequence[str] = ()) -> tuple[Particle, ...]:
    """The particles; a name that is `taken`, or came before, gets the group, then a number."""
    used = dict.fromkeys(map(name_key, taken), 1)
    return tuple(
        replace(particle, name=unique_name(particle.name, particle.group, used)) for particle in particles
    )


def read_file(file: MeshFile, reading: ReadingSettings = AS_USUAL) -> Particle:
    """As `read_mesh`, for one of `mesh_files`: the particle gets its group and its weight."""
    particle = _read_file(file, reading)
    if particle.source is not None:
        check_listed(file.path.name, particle.source.sha256, file.listed)
    return particle


def _read_file(file: MeshFile, reading: ReadingSettings) -> Particle:
    suffix = file.path.suffix.lower()
    if suffix in TABLE_SUFFIXES:
        return _read_table(file, reading.unit)
    if suffix in TEXT_SUFFIXES:
        return _mesh_or_table(file, reading)
    return _read_mesh(file, reading)


def _read_table(file: MeshFile, unit: str) -> Particle:
    particle = read_table_particle(file.path, unit, file.group, file.tables)
    return replace(particle, weight=file.weight)


def _mesh_or_table(file: MeshFile, reading: ReadingSettings) -> Particle:
    """The particle in a text file whose content decides between table and mesh."""
    try:
        return _read_table(file, reading.unit)
    except FileError as no_table:
        try:
            return _read_mesh(file, reading)
        except FileError:
            reason = str(no_table).removeprefix(f"{display_name(file.path)} ")
            sentence = f"is not a mesh, and as a table of coefficients it {reason}"
            raise FileError(message_about(file.path, sentence)) from None


def _read_mesh(file: MeshFile, reading: ReadingSettings) -> Particle:
    unit, path = reading.unit, file.path
    factor = unit_factor(unit)
    answer = shared_sandbox().request("mesh", path) if file.member is None else file.member.request()
    own_unit: str | None = answer.header["unit"]
    overruled = own_unit is not None and unit.startswith("voxel")
    if own_unit is not None and not overruled:
        unit, factor = own_unit, unit_factor(own_unit)
    vertices, faces = answer.arrays
    if not answer.header["shares_vertices"]:
        vertices, faces = merged_vertices(vertices, faces)
    mesh = Mesh(vertices * factor, faces)
    notes = tuple(answer.header["notes"])
    if overruled:
        notes += (f"Its numbers were multiplied by {factor:g} µm instead, as was asked.",)
    repaired = None
    try:
        if reading.repair:
            repaired = mesh_repair.repair(mesh)
            mesh, notes = repaired.mesh, notes + repaired.health_before.problems + repaired.actions
        else:
            notes += inspect(mesh).problems
    except GeometryError as error:
        left_out = "".join(f" {note}" for note in answer.header["notes"] if note.startswith("Left out"))
        reason = f"holds no particle: {lower_first(str(error))}{left_out}"
        raise GeometryError(message_about(path, reason)) from None
    source = Source(str(path), answer.header["sha256"], unit, reading.repair)
    return Particle(path.stem, mesh, file.group, source, notes, file.weight, repaired)


def find_files(
    paths: Sequence[str | Path],
    problems: list[FileProblem],
    tables: TableReading = DEFAULT_TABLE_READING,
) -> list[MeshFile]:
    """As `mesh_files`, but folders and archives without meshes are added to `problems`."""
    try:
        return mesh_files(paths, tables, problems)
    except FileError as error:
        if len(paths) == 1:
            problems.append(FileProblem(str(paths[0]), str(error)))
            return []
    return [file for path in paths for file in find_files([path], problems, tables)]


def mesh_files(
    paths: Sequence[str | Path],
    tables: TableReading = DEFAULT_TABLE_READING,
    problems: list[FileProblem] | None = None,
) -> list[MeshFile]:
    """The files that `read_particles` would read, in its order: those given, in folders and in archives.

    A path may lead into an archive as if that were a folder. Weights come from the ``particles.csv`` that
    ``extract`` writes beside its meshes; members of archives that are refused are added to `problems`.

    Raises FileError if a folder holds no mesh file, or its table of weights is not that of its list.
    """
    given = [Path(path) for path in paths]
    several = sum(path.is_dir() or is_archive(path) for path in given) > 1
    files: list[MeshFile] = []
    for path in given:
        in_folder = list(_in_folder(path, several)) if path.is_dir() else [MeshFile(path)]
        refused: list[FileProblem] = []
        in_folder = [each for file in in_folder for each in _with_members(file, refused, several)]
        if not in_folder and len(refused) == 1:
            raise FileError(refused[0].sentence)
        if problems is not None:
            problems += refused
        if not in_folder:
            above = archive_of(path)
            inside = f" at {printable(path.relative_to(above).as_posix())[-60:]}" if above else ""
            place = f"{'folder' if path.is_dir() else 'archive'} {display_name(above or path)}"
            endings = ", ".join(sorted(mesh_suffixes()))
            raise FileError(
                f"The {place} holds no mesh file{inside}; meshes end in {endings}, tables of coefficients in "
                f"{', '.join(TABLE_SUFFIXES)}."
            )
        files += in_folder
    folders = {file.path.parent for file in files if file.member is None}
    lists = {folder: listed_hashes(folder) for folder in folders}
    weights = {folder: read_weights(folder, lists[folder]) for folder in folders}
    return [
        file
        if file.member is not None
        else replace(
            file,
            weight=weights[file.path.parent].get(file_stem(file.path.stem), 1.0),
            listed=lists[file.path.parent],
            tables=tables,
        )
        for file in files
    ]


def _with_members(file: MeshFile, problems: list[FileProblem], several: bool) -> list[MeshFile]:
    """The file itself, or the meshes of the archive that it is or leads into.

    Where there are `several`, or the archive lies in a folder, groups begin with the name of the archive.
    """
    archive = archive_of(file.path)
    whole = archive is None
    if archive is None:
        if not is_archive(file.path):
            return [file]
        archive = file.path
    try:
        content = archive_content(archive)
    except FileError as error:
        problems.append(FileProblem(str(archive), str(error)))
        return []
    problems += [FileProblem(*problem) for problem in content.problems if whole]
    name = printable(archive.stem)
    prefix = (file.group, name) if several or file.group else ()
    chosen = (each for each in content.members if whole or file.path in (each.path, *each.path.parents))
    return [
        MeshFile(
            each.path, "/".join(filter(None, (*prefix, each.group))) or name, listed=_UNLISTED, member=each
        )
        for each in chosen
    ]


def has_tables(paths: Sequence[Path]) -> bool:
    """Whether there are files among them that may be tables of coefficients."""
    suffixes = {*TABLE_SUFFIXES, *TEXT_SUFFIXES}
    return any(file.path.suffix.lower() in suffixes for file in _all_files(paths))


def all_state_unit(paths: Sequence[Path]) -> bool:
    """Whether there are files, all of formats in which a file states the unit of its lengths."""
    suffixes = {suffix for row in MESH_FORMATS.values() if row.states_unit for suffix in row.suffixes}
    stated = [file.path.suffix.lower() in suffixes for file in _all_files(paths)]
    return bool(stated) and all(stated)


def _all_files(paths: Sequence[Path]) -> Iterator[MeshFile]:
    for path in paths:
        yield from _in_folder(path, False) if path.is_dir() else (MeshFile(path),)


def left_out(paths: Sequence[str | Path]) -> list[str]:
    """For each folder a sentence about the files in it that are no meshes by their names; none without such.

    Documents, pictures and tables that lie beside meshes are not mentioned, but tables of weights that give
    none are.
    """
    sentences: list[str] = list(_tables_without_weights([Path(path) for path in paths]))
    for folder in (Path(path) for path in paths if Path(path).is_dir()):
        read = {file.path for file in _in_folder(folder, False)}
        names = [
            display_name(Path(where) / file)
            for where, folders, files in os.walk(folder)
            if not _hide(folders)
            for file in sorted(files, key=natural_key)
            if Path(where) / file not in read and not _is_companion(file)
        ]
        if names and read:
            shown = ", ".join(names[:3]) + (", …" if len(names) > 3 else "")
            sentences.append(
                count_message(
                    N_("{folder}: left out 1 file that no reader of meshes takes: {names}."),
                    N_("{folder}: left out {count} files that no reader of meshes takes: {names}."),
                    len(names),
                    folder=display_name(folder),
                    names=shown,
                )
            )
    return sentences


def _tables_without_weights(paths: Sequence[Path]) -> Iterator[str]:
    """A sentence for each table that has the name of one of weights, and whose weights do not count."""
    files = [file for path in paths if not archive_of(path) for file in _all_files([path])]
    for folder in dict.fromkeys(file.path.parent for file in files):
        if (folder / WEIGHTS_FILE).is_file() and not read_weights(folder):
            sentence = N_(
                "{folder}: {table} has no columns name and weight with positive numbers, so every particle "
                "counts once."
            )
            yield Message(sentence, folder=display_name(folder), table=WEIGHTS_FILE)
    for archive in dict.fromkeys(file.path for file in files if is_archive(file.path)):
        try:
            tables = archive_content(archive).tables
        except FileError:
            continue  # it is reported when the archive is read
        if tables:
            sentence = N_(
                "{archive}: {table} is not read from an archive, so every particle counts once; unpack it to "
                "use its weights."
            )
            yield Message(sentence, archive=display_name(archive), table=printable(tables[0]))


def _hide(folders: list[str]) -> bool:
    """Keep hidden folders out of a walk."""
    folders[:] = [inner for inner in folders if not inner.startswith(".")]
    return False


def _is_companion(name: str) -> bool:
    path = Path(name.lower())
    return name.startswith(".") or path.suffix in _COMPANIONS or path.stem in ("readme", "license", "licence")


def _in_folder(folder: Path, several: bool) -> Iterator[MeshFile]:
    name = folder.name or folder.resolve().name
    suffixes = mesh_suffixes() | {*TABLE_SUFFIXES, SUFFIX}
    for where, folders, files in os.walk(folder):
        folders[:] = sorted((inner for inner in folders if not inner.startswith(".")), key=natural_key)
        inside = Path(where).relative_to(folder).as_posix()
        group = printable(name if inside == "." else f"{name}/{inside}" if several else inside)
        for file in sorted(files, key=natural_key):
            if not file.startswith(".") and Path(file).suffix.lower() in suffixes:
                yield MeshFile(Path(where) / file, group)


def _log_problem(path: Path, sentence: str) -> None:
    _log.warning("%s: %s", path, sentence)


MAX_TABLE_BYTES = 256 * 1024**2


def read_weights(folder: Path, listed: Mapping[str, str] | None = None) -> dict[str, float]:
    """Weight of each particle by the name of its file; empty where the folder has no such table.

    A table that somebody else wrote, with no columns ``name`` and ``weight``, or without a positive
    number in the second, gives no weights: they are an addition to the meshes, not a part of them.

    Raises FileError if the SHA-256 of the table is `listed` and another.
    """
    path = folder / WEIGHTS_FILE
    weights: dict[str, float] = {}
    try:
        if not path.is_file() or path.stat().st_size > MAX_TABLE_BYTES:
            return weights
        check_listed(path.name, sha256_of(path), listed or {})
        with path.open(encoding="utf-8-sig", newline="") as file:
            for row in read_csv(file):
                weight = float(row["weight"] or 1.0)
                if row["name"] and 0.0 < weight < math.inf:
                    weights[file_stem(row["name"])] = weight
    except (OSError, ValueError, TypeError, KeyError, csv.Error):
        return {}
    return weights


def sample_particles() -> list[Particle]:
    """The shipped particles, in micrometres; an empty list in an installation without them."""
    return list(_read())


@cache
def _read() -> tuple[Particle, ...]:
    try:
        folder = resource("samples", "particles")
    except MissingRequirement:
        return ()
    files = sorted(folder.glob("*.stl"))
    if not files:
        return ()
    return tuple(_named(particle) for particle in read_particles(files, unit="um"))


def _named(particle: Particle) -> Particle:
    assert particle.source is not None
    source = Source(f"sample:{particle.name}", particle.source.sha256, "um")
    return replace(particle, group="synthetic", source=source)
