"""Read and write a dataset as a folder: ``dataset.json``, ``meshes/*.stl`` and a README (section 2.5).

Sizes, links and foreign files are checked before anything is read. A dataset is written shape by shape, with
one in memory at a time; each particle can be reduced to a :class:`StoredShape` earlier, in any process.
"""

import hashlib
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from regolith_studio.dataset.build import (
    CoarsenedShape,
    representative_of,
    singleton_class,
    software_versions,
)
from regolith_studio.dataset.dataset import Dataset, Provenance, Representative
from regolith_studio.dataset.schema import SCHEMA_VERSION, DatasetDocument, RepresentativeRecord
from regolith_studio.dataset.serialization import (
    dataset_of,
    head_document,
    mesh_header,
    mesh_path,
    parsed_document,
    record_of,
    shape_bytes,
)
from regolith_studio.dataset.size_distributions import normalised_shares
from regolith_studio.errors import DatasetError, InputError, os_error_reason
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import Content, recover_folder, replace_folder
from regolith_studio.io.file_names import unique_name
from regolith_studio.io.own_files import canonical_json
from regolith_studio.io.triangles import HEADER_SIZE

DOCUMENT, README = "dataset.json", "README.txt"
IGNORED_FILES = {".DS_Store", "Thumbs.db", "desktop.ini"}
"""Files of file managers, which may be deleted with the folder."""

MAX_DOCUMENT_BYTES = 320_000_000
"""Enough for 100,000 shapes of 20 facets; reading them takes half a minute and 3 GB."""
MAX_MESH_BYTES = 50_000_000


def read_document(folder: Path) -> DatasetDocument:
    """The checked ``dataset.json`` of a folder.

    Raises DatasetError if it is missing, too large or violates the schema.
    """
    path = folder / DOCUMENT
    try:
        text = _read(path, MAX_DOCUMENT_BYTES).decode("utf-8")
    except UnicodeDecodeError as error:
        raise DatasetError(f"{path} is not UTF-8 text.") from error
    return parsed_document(text, str(path))


def dataset_hash(folder: Path | str) -> str:
    """SHA-256 of ``dataset.json``, which contains those of the meshes; results of DEM refer to it.

    Raises DatasetError if the folder holds no dataset.
    """
    path = Path(folder) / DOCUMENT
    return hashlib.sha256(_read(path, MAX_DOCUMENT_BYTES)).hexdigest()


def read_mesh_bytes(folder: Path, file: str) -> bytes:
    """Content of a mesh file by its relative path, which the schema has checked.

    Raises DatasetError if it is missing, too large, or is a link to a file outside the folder.
    """
    path = folder.joinpath(*file.split("/"))
    if not real_path(path).is_relative_to(real_path(folder)):
        raise DatasetError(f"{path} is a link to a file outside the dataset's folder.")
    return _read(path, MAX_MESH_BYTES)


def foreign_files(folder: Path, document: DatasetDocument) -> list[str]:
    """Files and folders below `folder` that do not belong to its dataset, as relative POSIX paths."""
    meshes = {mesh.file for record in document.representatives for mesh in record.mesh_records}
    own = {DOCUMENT, README, "meshes", *meshes}
    present = {
        path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.name not in IGNORED_FILES
    }
    return sorted(present - own)


def real_path(path: Path | str) -> Path:
    """The path without links; unlike `Path.resolve` it does not fail for circular links."""
    return Path(os.path.realpath(path))


def _read(path: Path, largest: int) -> bytes:
    try:
        if path.exists() and not path.is_file():
            raise DatasetError(f"{path} is not a regular file.")
        if path.stat().st_size > largest:
            raise DatasetError(f"{path} is larger than {largest // 1_000_000} MB.")
        return path.read_bytes()
    except OSError as error:
        raise DatasetError(f"{path} cannot be read: {os_error_reason(error)}.") from error


def read_dataset(folder: Path | str) -> Dataset:
    """Read a dataset folder: shapes from their exact half-spaces; hashes of the meshes are checked.

    Raises
    ------
    DatasetError
        If the folder holds no dataset or an invalid one; the message names the entry.
    """
    target = recover_folder(real_path(folder))
    document = read_document(target)
    for mesh in (each for record in document.representatives for each in record.mesh_records):
        if hashlib.sha256(read_mesh_bytes(target, mesh.file)).hexdigest() != mesh.sha256:
            raise DatasetError(f"{target / mesh.file} is not the file that dataset.json describes.")
    return dataset_of(document, str(target / DOCUMENT))


def check_replaceable(target: Path, overwrite: bool) -> None:
    """Check that a folder may be replaced by a dataset.

    Raises DatasetError if it holds anything else than a dataset, or a dataset that must not be replaced.
    """
    if not target.exists():
        return
    if not target.is_dir():
        raise DatasetError(f"{target} is a file; a dataset is written into a folder.")
    if not any(target.iterdir()):
        return
    try:
        foreign = foreign_files(target, read_document(target))
    except DatasetError as error:
        raise DatasetError(
            f"{target} is not empty and contains no dataset; choose another folder."
        ) from error
    if foreign:
        raise DatasetError(
            f"{target} also holds files that are not the dataset's ({foreign[0]}); nothing was overwritten."
        )
    if not overwrite:
        raise DatasetError(f"{target} holds a dataset already; nothing was overwritten.")


README_TEMPLATE = """\
{name}

A dataset of {count} representative particle shapes for the discrete element method (DEM),
written by Regolith Studio.

dataset.json   weights, size distributions, exact half-spaces, provenance.
               Its fields are described by the JSON Schema of the program
               (resources/schema/dataset.schema.json), schema version {version}.
meshes/        one binary STL a shape, named after its particle: closed, outward normals, volume 1,
               centroid at the origin, longest principal axis along x, shortest along z. The
               coordinates have no unit.
               Of a compound, which is the union of convex parts, it is the surface of the
               union, and each part has a file besides (.part1, .part2, ...) in the same frame.

To make a particle: choose a class by the weights (they count {counted}), draw an equivalent
diameter d (in micrometres) from the sizes of the class, and scale the shape by
d * (pi / 6)^(1/3) = 0.80600 d, so that its volume is that of a sphere of diameter d. Then rotate it at
random. If a program asks for a size, choose the equivalent (volume) diameter.

"n_facets" counts polygonal facets; the STL file divides them into triangles. The half-spaces in
dataset.json are the exact shape: all x with <normal_i, x> <= offset_i, of a part all x with
<normal_i, x - origin> <= offset_i. Volume, centre of mass, inertia and descriptors of a compound are
those of the union; what parts share counts once.
Coordinates in the original particle: x_particle = scale rotation^T x_shape + centroid.

To check the folder:   regolith-studio dataset validate .
In Python:             import regolith_studio; regolith_studio.read_dataset(".")
""".replace("{version}", str(SCHEMA_VERSION))


_PLACE = "representatives"
_RECORD_BYTES, _FACET_BYTES = 1_150, 95
"""Measured size of a particle and of each of its facets in ``dataset.json``."""


@dataclass(frozen=True)
class StoredShape:
    """One representative as it is stored in a dataset.

    ``record``: its entry in ``dataset.json``, without its weight, and paths and hashes of its files.
    ``meshes``: binary STL of the shape, then of each part of a compound.
    """

    record: Mapping[str, Any]
    meshes: tuple[bytes, ...]


def stored_shape(particle: Particle, coarsened: CoarsenedShape) -> StoredShape:
    """The shape of a particle that represents only itself, aligned and at unit volume."""
    return _stored(representative_of(particle.name, particle, coarsened, singleton_class(particle)))


def _stored(representative: Representative) -> StoredShape:
    return StoredShape(record_of(representative), shape_bytes(representative.shape, 0, 1))


def check_count(count: int, n_facets: int) -> None:
    """Check, before hours of work, that a dataset would not be too large to be read.

    Raises InputError if it would, with the maximum number of particles.
    """
    most = MAX_DOCUMENT_BYTES // (_RECORD_BYTES + _FACET_BYTES * n_facets)
    if count > most:
        raise InputError(
            f"A dataset of {count:,} particles of {n_facets} facets is larger than can be read again; make "
            f"several of at most {most:,}, or leave the dataset out."
        )


def write_dataset(folder: Path | str, dataset: Dataset, *, overwrite: bool = True) -> Path:
    """Write the dataset; the folder then holds nothing else, or is unchanged if an error occurs.

    Parameters
    ----------
    folder
        New, empty, or holding a dataset of this program and nothing else.
    overwrite
        Whether an existing dataset may be replaced.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    DatasetError
        If the folder holds anything else, or something cannot be written.
    """
    return _write(folder, _files_of(dataset), overwrite)


def dataset_files(dataset: Dataset) -> dict[str, bytes]:
    """Content of every file by its relative path; equal datasets give equal bytes."""
    return {
        name: content if isinstance(content, bytes) else b"".join(content)
        for name, content in _files_of(dataset)
    }


def write_stored(
    folder: Path | str,
    shapes: Callable[[], Iterable[StoredShape]],
    count: int,
    *,
    name: str,
    provenance: Provenance,
) -> Path:
    """Write a dataset in which each of `count` shapes has the same weight.

    ``shapes``: returns a new iterator over all shapes in order; their names must differ.

    Raises DatasetError if there is no shape, one violates the schema, the folder holds anything else than a
    dataset, or something cannot be written.
    """
    if count < 1:
        raise DatasetError("A dataset needs at least one particle.")
    origin = provenance if provenance.software else replace(provenance, software=software_versions())
    files = _files(shapes, normalised_shares([1.0] * count), head_document(name, "number", origin))
    return _write(folder, files, overwrite=True)


def _write(folder: Path | str, files: Iterable[tuple[str, Content]], overwrite: bool) -> Path:
    target = Path(folder).resolve()
    try:
        recover_folder(target)
        check_replaceable(target, overwrite)
        replace_folder(target, files)
    except OSError as error:
        raise DatasetError(f"The dataset {target} cannot be written ({os_error_reason(error)}).") from error
    return target


def _files_of(dataset: Dataset) -> Iterator[tuple[str, Content]]:
    shapes = [_stored(representative) for representative in dataset.representatives]
    head = head_document(dataset.name, dataset.weighting, dataset.provenance)
    return _files(lambda: shapes, dataset.weights.tolist(), head)


def _files(
    shapes: Callable[[], Iterable[StoredShape]], weights: Sequence[float], head: dict[str, Any]
) -> Iterator[tuple[str, Content]]:
    count = len(weights)
    files: list[list[dict[str, Any]]] = []
    used: dict[str, int] = {}
    for index, shape in enumerate(shapes()):
        files.append([])
        name = unique_name(shape.record["name"], shape.record["group"], used)
        for part, mesh in enumerate(shape.meshes):
            # The process that stored the shape knew neither its number nor how many there are.
            header = mesh_header(index, count, part).encode("ascii").ljust(HEADER_SIZE)
            file, content = mesh_path(name, part), header + mesh[HEADER_SIZE:]
            files[-1].append({"file": file, "sha256": hashlib.sha256(content).hexdigest()})
            yield file, content
    # Last, with the hashes of all files; the shapes come a second time, so that one is in memory at a time.
    yield DOCUMENT, _document(_records(shapes(), weights, files), head)
    counted = "particles" if head["weighting"] == "number" else "volume, not particles"
    yield README, README_TEMPLATE.format(name=head["name"], count=count, counted=counted).encode("utf-8")


def _records(
    shapes: Iterable[StoredShape], weights: Sequence[float], files: list[list[dict[str, Any]]]
) -> Iterator[dict[str, Any]]:
    """The entries with weight, and with path and hash of each file."""
    for shape, weight, (whole, *others) in zip(shapes, weights, files, strict=True):
        record = {**shape.record, "weight": weight, "mesh": {**shape.record["mesh"], **whole}}
        if compound := shape.record["compound"]:
            pairs = zip(compound["parts"], others, strict=True)
            parts = [{**part, "mesh": {**part["mesh"], **file}} for part, file in pairs]
            record["compound"] = {**compound, "parts": parts}
        yield record


def _document(records: Iterable[dict[str, Any]], head: dict[str, Any]) -> Iterator[bytes]:
    """``dataset.json`` piece by piece; the rest of the document is checked together with the first record."""
    # Written about an empty entry, so that the bytes are those of the whole document at once.
    before, after = _strict_json(head | {_PLACE: ""}).split(f'\n  "{_PLACE}": ""')
    yield f'{before}\n  "{_PLACE}": ['.encode()
    size = 0
    for index, record in enumerate(records):
        text = _checked_record(record)
        if index == 0:
            alone = head | {_PLACE: [{**record, "weight": 1.0}]}
            parsed_document(_strict_json(alone), "The new dataset.json")
        text = text.rstrip("\n").replace("\n", "\n    ")
        piece = f"{',' if index else ''}\n    {text}".encode()
        size += len(piece)
        if size > MAX_DOCUMENT_BYTES:
            raise DatasetError(
                f"A dataset of more than {index:,} such particles is too large to be read; write "
                "several, or choose representatives."
            )
        yield piece
    yield f"\n  ]{after}".encode()


def _checked_record(record: dict[str, Any]) -> str:
    text = _strict_json(record)
    try:
        RepresentativeRecord.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise DatasetError(
            f"The dataset cannot be written: {record['name']}, {place}: {first['msg']}."
        ) from error
    return text


def _strict_json(content: dict[str, Any]) -> str:
    try:
        return canonical_json(content)
    except ValueError as error:  # NaN or an infinity
        raise DatasetError(f"The dataset cannot be written: {error}.") from error
