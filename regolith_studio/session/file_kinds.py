"""The kind of a file or folder that is opened: by its name, and of JSON by its content."""

import re
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path

from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.coefficient_tables import TABLE_SUFFIXES, TEXT_SUFFIXES
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.number_rows import utf8_text
from regolith_studio.readers.position_formats import named_columns, position_suffixes
from regolith_studio.readers.voxels.slice_series import dicom_names, is_zarr
from regolith_studio.readers.zip_members import SUFFIX as SUFFIX_OF_ARCHIVES
from regolith_studio.session.project import SUFFIX

_SNIFFED = 200_000
_MOST_LOOKED_AT = 5_000
_FORMAT = re.compile(rb'"format"\s*:\s*"([^"]{1,60})"')


class FileKind(StrEnum):
    """Kinds of input, as a sentence names them."""

    PARTICLES = "particles"
    VOLUME = "volume"
    PROJECT = "project"
    RECIPE = "recipe"
    DATASET = "dataset"
    SHAPES = "fit, model or material card"
    POSITIONS = "positions of particles"
    UNKNOWN = "unknown"


_BY_FORMAT = {
    b"regolith-studio recipe": FileKind.RECIPE,
    b"regolith-studio project": FileKind.PROJECT,
    b"regolith-studio-dataset": FileKind.DATASET,
    b"regolith-studio fit": FileKind.SHAPES,
    b"regolith-studio model": FileKind.SHAPES,
}


def volume_suffixes() -> tuple[str, ...]:
    """Endings of files that are volumes."""
    from regolith_studio.readers import volume_formats  # loads every one of them

    return tuple(volume_formats.volume_suffixes())


def openable_suffixes() -> tuple[str, ...]:
    """Endings of all files that can be opened, each once."""
    tables = (*TABLE_SUFFIXES, *TEXT_SUFFIXES, *sorted(position_suffixes()))
    others = (*volume_suffixes(), SUFFIX_OF_ARCHIVES, SUFFIX, ".json")
    return tuple(dict.fromkeys((*mesh_suffixes(), *tables, *others)))


def kind_of(path: Path) -> FileKind:
    """What a path leads to; what is not there or cannot be read has the kind of its name."""
    name = path.name.lower()
    if path.is_dir():
        return _kind_of_folder(path)
    if name.endswith(SUFFIX):
        return FileKind.PROJECT
    if name.endswith(".json"):
        return _kind_of_json(path)
    if name.endswith(TEXT_SUFFIXES) and _names_positions(path):
        return FileKind.POSITIONS
    if name.endswith((*mesh_suffixes(), SUFFIX_OF_ARCHIVES, *TABLE_SUFFIXES, *TEXT_SUFFIXES)):
        return FileKind.PARTICLES
    if name.endswith(volume_suffixes()):
        return FileKind.VOLUME
    return FileKind.POSITIONS if path.suffix.lower() in position_suffixes() else FileKind.UNKNOWN


def kind_of_all(paths: Sequence[Path]) -> FileKind:
    """The one kind that all of these are."""
    kinds = [kind_of(path) for path in paths]
    if FileKind.UNKNOWN in kinds:
        lost = paths[kinds.index(FileKind.UNKNOWN)].name
        raise InputError(f"{lost}: not a mesh, table, volume, dataset, project, recipe, fit or model.")
    if len(set(kinds)) > 1:
        raise InputError(
            f"These are of several kinds ({', '.join(sorted(set(kinds)))}): open one kind at once."
        )
    if len(paths) > 1 and kinds[0] is not FileKind.PARTICLES:
        raise InputError(f"There are {len(paths)} files of the kind {kinds[0]}: open one after the other.")
    return kinds[0]


def _names_positions(path: Path) -> bool:
    """Whether the first line of a table names columns x, y and z, where one of coefficients has l and m."""
    if not path.is_file():
        return False
    try:
        with path.open("rb") as file:
            line = utf8_text(file.readline(_SNIFFED)).decode("utf-8", "replace").strip(" #\r\n")
        line = re.sub(r"format (\w+)", lambda yade: yade[1].replace("_", " "), line)
        names = re.split(r"[,;\t]" if re.search(r"[,;\t]", line) else r"\s+", line)
        return named_columns(tuple(name.strip(" \"'") for name in names)).axes is not None
    except (OSError, FileError):
        return False  # whose reader says what is wrong


def _kind_of_folder(folder: Path) -> FileKind:
    if (folder / "dataset.json").is_file():
        return FileKind.DATASET
    from regolith_studio.readers.voxels.slice_series import SLICE_SUFFIXES

    try:
        if is_zarr(folder) or dicom_names(folder):
            return FileKind.VOLUME
        slices = [path for path in folder.iterdir() if path.suffix.lower() in SLICE_SUFFIXES]
        if len(slices) < 2:
            return FileKind.PARTICLES
        inside = (path for _, path in zip(range(_MOST_LOOKED_AT), folder.rglob("*"), strict=False))
        meshes = {*mesh_suffixes(), *TABLE_SUFFIXES}
        return FileKind.PARTICLES if any(p.suffix.lower() in meshes for p in inside) else FileKind.VOLUME
    except OSError:
        return FileKind.PARTICLES


def _kind_of_json(path: Path) -> FileKind:
    if not path.is_file():
        return FileKind.RECIPE  # a pipe would be waited for without end
    try:
        with path.open("rb") as file:
            content = file.read(_SNIFFED)
    except OSError:
        return FileKind.RECIPE  # whose reader says what is wrong
    if match := _FORMAT.search(content):
        return _BY_FORMAT.get(match[1], FileKind.UNKNOWN)
    return FileKind.SHAPES if b'"relative_amplitudes"' in content else FileKind.RECIPE
