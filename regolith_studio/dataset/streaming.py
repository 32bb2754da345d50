"""Write large datasets shape by shape, with the same bytes as :func:`~.folder_io.write_dataset`.

Each particle is first reduced to a :class:`StoredShape`, in any process; the folder is then assembled from
them, with one shape in memory at a time.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
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
from regolith_studio.dataset.dataset import Provenance, Representative
from regolith_studio.dataset.folder_io import (
    DOCUMENT,
    MAX_DOCUMENT_BYTES,
    README,
    README_TEMPLATE,
    check_replaceable,
)
from regolith_studio.dataset.schema import RepresentativeRecord
from regolith_studio.dataset.serialization import (
    frame_of,
    mesh_header,
    mesh_path,
    mesh_record,
    parsed_document,
    record_of,
    shape_bytes,
)
from regolith_studio.dataset.size_distributions import normalised_shares
from regolith_studio.errors import DatasetError, InputError, os_error_reason
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import recover_folder, replace_folder
from regolith_studio.io.json_text import canonical_json

_HEADER = 80
_PLACE = "representatives"
_RECORD_BYTES, _FACET_BYTES = 1_150, 95
"""Measured size of a particle and of each of its facets in ``dataset.json``."""


@dataclass(frozen=True)
class StoredShape:
    """One particle that represents only itself, as it is stored in a dataset.

    Parameters
    ----------
    record
        Its entry in ``dataset.json``; weight, file and hash are filled in later.
    meshes
        Binary STL of the shape, then of each part of a compound.
    """

    record: Mapping[str, Any]
    meshes: tuple[bytes, ...]


def stored_shape(particle: Particle, coarsened: CoarsenedShape) -> StoredShape:
    """The shape that represents `particle`, aligned and at unit volume."""
    representative: Representative = representative_of(
        particle.name, particle, coarsened, singleton_class(particle)
    )
    meshes = shape_bytes(representative.shape, 0, 1)
    files = {mesh_path(0, 1, part): content for part, content in enumerate(meshes)}
    return StoredShape(record_of(representative, files), meshes)


def check_count(count: int, n_facets: int) -> None:
    """Check, before hours of work, that a dataset would not be too large to be read.

    Raises
    ------
    InputError
        If it would, with the maximum number of particles.
    """
    most = MAX_DOCUMENT_BYTES // (_RECORD_BYTES + _FACET_BYTES * n_facets)
    if count > most:
        raise InputError(
            f"A dataset of {count:,} particles of {n_facets} facets is larger than can be read again; make "
            f"several of at most {most:,}, or leave the dataset out."
        )


def write_stored(
    folder: Path | str,
    shapes: Callable[[], Iterable[StoredShape]],
    count: int,
    *,
    name: str,
    provenance: Provenance,
) -> Path:
    """Write a dataset in which each of `count` shapes has the same weight.

    Parameters
    ----------
    shapes
        Returns a new iterator over all shapes in order; their names must differ.

    Raises
    ------
    DatasetError
        If there is no shape, one violates the schema, the folder holds anything else than a dataset, or
        something cannot be written.
    """
    if count < 1:
        raise DatasetError("A dataset needs at least one particle.")
    target = Path(folder).resolve()
    origin = provenance if provenance.software else _with_software(provenance)
    try:
        recover_folder(target)
        check_replaceable(target, overwrite=True)
        replace_folder(target, _files(shapes, count, name, origin))
    except OSError as error:
        raise DatasetError(f"The dataset {target} cannot be written ({os_error_reason(error)}).") from error
    return target


def _files(
    shapes: Callable[[], Iterable[StoredShape]], count: int, name: str, provenance: Provenance
) -> Iterator[tuple[str, bytes | Iterable[bytes]]]:
    files: list[list[dict[str, Any]]] = []
    for index, shape in enumerate(shapes()):
        files.append([])
        for part, mesh in enumerate(shape.meshes):
            header = mesh_header(index, count, part).encode("ascii").ljust(_HEADER)
            file, content = mesh_path(index, count, part), header + mesh[_HEADER:]
            files[-1].append(mesh_record(file, content))
            yield file, content
    records = _records(shapes(), files)
    yield DOCUMENT, _document(records, name, provenance)
    yield README, README_TEMPLATE.format(name=name, count=count, counted="particles").encode("utf-8")


def _records(shapes: Iterable[StoredShape], files: list[list[dict[str, Any]]]) -> Iterator[dict[str, Any]]:
    """Checked records with weight, and with path and hash of each file."""
    weights = normalised_shares([1.0] * len(files))
    for shape, weight, (whole, *others) in zip(shapes, weights, files, strict=True):
        record = {**shape.record, "weight": weight, "mesh": {**shape.record["mesh"], **whole}}
        if compound := shape.record["compound"]:
            pairs = zip(compound["parts"], others, strict=True)
            parts = [{**part, "mesh": {**part["mesh"], **file}} for part, file in pairs]
            record["compound"] = {**compound, "parts": parts}
        try:
            RepresentativeRecord.model_validate_json(json.dumps(record))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(map(str, first["loc"]))
            raise DatasetError(
                f"The dataset cannot be written: {record['name']}, {place}: {first['msg']}."
            ) from error
        yield record


def _document(records: Iterable[dict[str, Any]], name: str, provenance: Provenance) -> Iterator[bytes]:
    """``dataset.json`` piece by piece; the rest of the document is checked together with the first record."""
    frame = frame_of(name, "number", provenance)
    try:
        before, after = canonical_json(frame | {_PLACE: ""}).split(f'\n  "{_PLACE}": ""')
    except ValueError as error:
        raise DatasetError(f"The dataset cannot be written: {error}.") from error
    yield f'{before}\n  "{_PLACE}": ['.encode()
    size = 0
    for index, record in enumerate(records):
        if index == 0:
            alone = frame | {_PLACE: [{**record, "weight": 1.0}]}
            parsed_document(canonical_json(alone), "The new dataset.json")
        text = canonical_json(record).rstrip("\n").replace("\n", "\n    ")
        piece = f"{',' if index else ''}\n    {text}".encode()
        size += len(piece)
        if size > MAX_DOCUMENT_BYTES:
            raise DatasetError(
                f"A dataset of more than {index:,} such particles is too large to be read; write "
                "several, or choose representatives."
            )
        yield piece
    yield f"\n  ]{after}".encode()


def _with_software(provenance: Provenance) -> Provenance:
    return replace(provenance, software=software_versions())
