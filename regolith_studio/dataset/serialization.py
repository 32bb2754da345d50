"""Convert a dataset to ``dataset.json`` and back."""

from typing import Any

import numpy as np
from pydantic import ValidationError

from regolith_studio.dataset.dataset import Dataset, Frame, Provenance, Representative
from regolith_studio.dataset.schema import (
    FORMAT,
    SCHEMA_VERSION,
    DatasetDocument,
    HalfSpacesRecord,
    RepresentativeRecord,
)
from regolith_studio.dataset.size_distributions import Weighting
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import (
    DatasetError,
    FileError,
    RegolithError,
    format_validation_error,
)
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Source
from regolith_studio.io.file_names import file_stem
from regolith_studio.io.own_files import parse_strict_json
from regolith_studio.io.triangles import stl_bytes


def shape_bytes(shape: Polyhedron, index: int, count: int) -> tuple[bytes, ...]:
    """STL of a shape, one of `count`, and of each part of a compound."""
    parts = shape.part_meshes if isinstance(shape, ConvexCompound) else ()
    return tuple(
        stl_bytes(stored_triangles(mesh), mesh_header(index, count, part))
        for part, mesh in enumerate((shape.mesh, *parts))
    )


def stored_triangles(mesh: Mesh) -> FloatArray:
    """Without those with two corners that float32 does not tell apart: the surface stays closed.

    Where facets of two parts, or four planes, nearly meet, there are edges that short.
    """
    a, b, c = np.moveaxis(mesh.triangles.astype(np.float32), 1, 0)
    kept = (a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)
    return np.asarray(mesh.triangles[kept])


def mesh_path(name: str, part: int = 0) -> str:
    """Relative path of the STL file of a representative by its unique name, or of a part, counted from 1."""
    return f"meshes/{file_stem(name)}{f'.part{part}' if part else ''}.stl"


def mesh_header(index: int, count: int, part: int = 0) -> str:
    """Header of that file."""
    of = f"part {part} of " if part else ""
    return f"regolith-studio {of}unit-volume shape {index:0{max(4, len(str(count - 1)))}d}"


def head_document(name: str, weighting: Weighting, provenance: Provenance) -> dict[str, Any]:
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

    Raises DatasetError if it is of another version of the schema, or naming the first entry that violates it.
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

    Raises DatasetError if half-spaces bound no unit volume or a frame is invalid.
    """
    return Dataset(
        name=document.name,
        representatives=tuple(_representative(record, where) for record in document.representatives),
        weighting=document.weighting,
        provenance=Provenance(**dict(document.metadata)),
    )


def shape_of(record: RepresentativeRecord) -> Polyhedron:
    """The polyhedron of the record's half-spaces, or the compound of its parts.

    Raises GeometryError if they bound no volume.
    """
    if record.compound is None:
        assert record.half_spaces is not None
        return polyhedron_of(record.half_spaces)
    parts = record.compound.parts
    return ConvexCompound(
        tuple(polyhedron_of(part.half_spaces) for part in parts), np.array([part.origin for part in parts])
    )


def polyhedron_of(record: HalfSpacesRecord) -> ConvexPolyhedron:
    """The polyhedron of half-spaces about their origin.

    Raises GeometryError if they bound no volume.
    """
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(np.array(record.normals), np.array(record.offsets)))


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
            approximation=record.approximation,
            group=record.group,
            source=None if record.source is None else Source(**record.source.model_dump()),
        )
    except (RegolithError, ValueError) as error:
        reason = str(error).rstrip(".")
        raise DatasetError(f"{where}: the representative {record.name} cannot be used: {reason}.") from error


def record_of(representative: Representative) -> dict[str, Any]:
    """The entry of one representative in ``dataset.json``, without its weight and its files."""
    shape, frame = representative.shape, representative.frame
    approximation, source = representative.approximation, representative.source
    return {
        "name": representative.name,
        "group": representative.group,
        "n_members": representative.n_members,
        "sizes": representative.sizes.model_dump(mode="json"),
        "mesh": _counts(shape),
        "half_spaces": None if isinstance(shape, ConvexCompound) else _half_spaces(shape),
        "compound": _compound(shape) if isinstance(shape, ConvexCompound) else None,
        "frame": {
            "rotation": frame.rotation.tolist(),
            "centroid_um": frame.centroid.tolist(),
            "scale_um": frame.scale,
        },
        "approximation": approximation and approximation.model_dump(),
        "source": source and {"path": source.path, "sha256": source.sha256, "unit": source.unit},
    }


def _counts(shape: Polyhedron) -> dict[str, int]:
    """Facets; vertices and triangles of the surface, of a compound those of its file."""
    if isinstance(shape, ConvexPolyhedron):
        n_vertices, n_triangles = shape.n_vertices, shape.n_triangles
    else:
        corners = stored_triangles(shape.mesh).reshape(-1, 3).astype(np.float32)
        n_vertices, n_triangles = len(np.unique(corners, axis=0)), len(corners) // 3
    return {"n_facets": shape.n_facets, "n_vertices": n_vertices, "n_triangles": n_triangles}


def _half_spaces(shape: ConvexPolyhedron) -> dict[str, Any]:
    planes = shape.half_spaces
    return {"normals": planes.normals.tolist(), "offsets": planes.offsets.tolist()}


def _compound(shape: ConvexCompound) -> dict[str, Any]:
    """Parts and properties of the union."""
    return {
        "parts": [
            {"origin": place, "half_spaces": _half_spaces(part), "mesh": _counts(part)}
            for part, place in zip(shape.parts, shape.places.tolist(), strict=True)
        ],
        **union_properties(shape),
    }


def union_properties(shape: ConvexCompound) -> dict[str, Any]:
    """Volume, centre of mass, inertia and descriptors of a compound, as its record has them."""
    return {
        "volume": shape.volume,
        "centre_of_mass": shape.centroid.tolist(),
        "inertia": shape.inertia.tolist(),
        "descriptors": dict(describe(shape)),
    }


def _metadata(provenance: Provenance) -> dict[str, Any]:
    coarsening, representation = provenance.coarsening, provenance.representation
    return vars(provenance) | {
        "coarsening": coarsening and coarsening.model_dump(),
        "representation": representation and representation.model_dump(),
        "software": dict(provenance.software),
    }
