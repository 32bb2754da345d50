"""Convert a dataset to ``dataset.json`` and back."""

import hashlib
from typing import Any

import numpy as np
from pydantic import ValidationError

from regolith_studio.dataset.alignment import Frame
from regolith_studio.dataset.dataset import (
    Approximation,
    CoarseningRecord,
    Dataset,
    Provenance,
    Representation,
    Representative,
)
from regolith_studio.dataset.schema import FORMAT, SCHEMA_VERSION, DatasetDocument, RepresentativeRecord
from regolith_studio.dataset.size_distributions import Weighting
from regolith_studio.errors import DatasetError, FileError, RegolithError, format_validation_error
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.particle import Source
from regolith_studio.io.json_text import canonical_json, parse_strict_json
from regolith_studio.io.stl import stl_bytes


def mesh_files(dataset: Dataset) -> dict[str, bytes]:
    """Relative path and content of the STL file of each representative, in order."""
    return {
        mesh_path(index, len(dataset)): stl_bytes(
            representative.shape.mesh.triangles, mesh_header(index, len(dataset))
        )
        for index, representative in enumerate(dataset.representatives)
    }


def mesh_path(index: int, count: int) -> str:
    """Relative path of the STL file of one of `count` representatives."""
    return f"meshes/particle_{_numbered(index, count)}.stl"


def mesh_header(index: int, count: int) -> str:
    """Header of that file."""
    return f"regolith-studio unit-volume shape {_numbered(index, count)}"


def _numbered(index: int, count: int) -> str:
    return f"{index:0{max(4, len(str(count - 1)))}d}"


def document_text(dataset: Dataset, files: dict[str, bytes]) -> str:
    """The content of ``dataset.json``; equal datasets give equal text.

    Raises
    ------
    DatasetError
        If the dataset violates the schema, for example by an error that is not finite.
    """
    records = [
        record_of(representative, file, content)
        for representative, (file, content) in zip(dataset.representatives, files.items(), strict=True)
    ]
    content = frame_of(dataset.name, dataset.weighting, dataset.provenance) | {"representatives": records}
    try:
        text = canonical_json(content)
    except ValueError as error:
        raise DatasetError(f"The dataset cannot be written: {error}.") from error
    parsed_document(text, "The new dataset.json")
    return text


def frame_of(name: str, weighting: Weighting, provenance: Provenance) -> dict[str, Any]:
    """The entries of ``dataset.json`` without the representatives."""
    return {
        "format": FORMAT,
        "schema_version": SCHEMA_VERSION,
        "name": name,
        "length_unit": "um",
        "shape_unit": "unit volume",
        "size_measure": "equivalent diameter",
        "vertical_axis": "z",
        "weighting": weighting,
        "metadata": _metadata(provenance),
    }


def parsed_document(text: str, where: str) -> DatasetDocument:
    """The checked content of a ``dataset.json``.

    Raises
    ------
    DatasetError
        Naming the first entry that violates the schema.
    """
    try:
        content = parse_strict_json(text, where)
    except FileError as error:
        raise DatasetError(str(error)) from error
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise DatasetError(f"{where} is not a dataset of Regolith Studio: its format is not {FORMAT!r}.")
    if content.get("schema_version") != SCHEMA_VERSION:
        raise DatasetError(
            f"{where} has the schema version {content.get('schema_version')!r}, but this program reads only "
            f"version {SCHEMA_VERSION}; build the dataset again."
        )
    try:
        return DatasetDocument.model_validate_json(text)
    except ValidationError as error:
        raise DatasetError(
            f"{where} violates the schema: {format_validation_error(error.errors(include_url=False))}."
        ) from error


def dataset_of(document: DatasetDocument, where: str) -> Dataset:
    """The dataset that a document describes.

    Raises
    ------
    DatasetError
        If half-spaces bound no unit volume or a frame is invalid.
    """
    return Dataset(
        name=document.name,
        representatives=tuple(_representative(record, where) for record in document.representatives),
        weighting=document.weighting,
        provenance=_provenance(document),
    )


def shape_of(record: RepresentativeRecord) -> ConvexPolyhedron:
    """The polyhedron of the record's half-spaces.

    Raises
    ------
    GeometryError
        If they bound no volume.
    """
    planes = HalfSpaces(np.array(record.half_spaces.normals), np.array(record.half_spaces.offsets))
    return ConvexPolyhedron.from_half_spaces(planes)


def _representative(record: RepresentativeRecord, where: str) -> Representative:
    try:
        return Representative(
            name=record.name,
            shape=shape_of(record),
            weight=record.weight,
            sizes=record.sizes,
            frame=Frame(
                np.array(record.frame.rotation), np.array(record.frame.centroid_um), record.frame.scale_um
            ),
            n_members=record.n_members,
            approximation=None
            if record.approximation is None
            else Approximation(**record.approximation.model_dump()),
            group=record.group,
            source=None if record.source is None else Source(**record.source.model_dump()),
        )
    except (RegolithError, ValueError) as error:
        reason = str(error).rstrip(".")
        raise DatasetError(f"{where}: the representative {record.name} cannot be used: {reason}.") from error


def _provenance(document: DatasetDocument) -> Provenance:
    fields = document.metadata.model_dump()
    coarsening, representation = fields.pop("coarsening"), fields.pop("representation")
    return Provenance(
        angular_power_spectrum=fields.pop("angular_power_spectrum_um2"),
        coarsening=None if coarsening is None else CoarseningRecord(**coarsening),
        representation=None if representation is None else Representation(**representation),
        **fields,
    )


def record_of(representative: Representative, file: str, content: bytes) -> dict[str, Any]:
    """The entry of one representative in ``dataset.json``; `content` are the bytes of its STL file."""
    shape, frame = representative.shape, representative.frame
    approximation, source = representative.approximation, representative.source
    return {
        "name": representative.name,
        "group": representative.group,
        "weight": representative.weight,
        "n_members": representative.n_members,
        "sizes": representative.sizes.model_dump(mode="json"),
        "mesh": {
            "file": file,
            "sha256": hashlib.sha256(content).hexdigest(),
            "n_facets": shape.n_facets,
            "n_vertices": shape.n_vertices,
            "n_triangles": shape.n_triangles,
        },
        "half_spaces": {
            "normals": shape.half_spaces.normals.tolist(),
            "offsets": shape.half_spaces.offsets.tolist(),
        },
        "frame": {
            "rotation": frame.rotation.tolist(),
            "centroid_um": frame.centroid.tolist(),
            "scale_um": frame.scale,
        },
        "approximation": None if approximation is None else _plain(vars(approximation)),
        "source": source and {"path": source.path, "sha256": source.sha256, "unit": source.unit},
    }


def _metadata(provenance: Provenance) -> dict[str, Any]:
    fields = _plain(vars(provenance))
    fields["angular_power_spectrum_um2"] = fields.pop("angular_power_spectrum")
    if provenance.coarsening is not None:
        fields["coarsening"] = _plain(vars(provenance.coarsening))
    if provenance.representation is not None:
        fields["representation"] = _plain(vars(provenance.representation))
    return fields


def _plain(fields: dict[str, Any]) -> dict[str, Any]:
    """Mappings as dictionaries, numpy scalars as Python numbers."""
    plain: dict[str, Any] = {}
    for key, value in fields.items():
        if hasattr(value, "items"):
            plain[key] = {name: _number(inner) for name, inner in value.items()}
        elif isinstance(value, tuple):
            plain[key] = [_number(inner) for inner in value]
        else:
            plain[key] = _number(value)
    return plain


def _number(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value
