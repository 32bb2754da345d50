"""Validate a dataset folder: each problem is one sentence that names its place."""

import hashlib
from pathlib import Path

import numpy as np

from regolith_studio.dataset.dataset import SHAPE_TOLERANCE, Dataset
from regolith_studio.dataset.folder_io import (
    DOCUMENT,
    README,
    foreign_files,
    read_document,
    read_mesh_bytes,
    real_path,
)
from regolith_studio.dataset.representation import polyhedra_errors
from regolith_studio.dataset.schema import RepresentativeRecord
from regolith_studio.dataset.serialization import dataset_of, shape_of
from regolith_studio.errors import DatasetError, RegolithError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.topology import edge_table
from regolith_studio.io.atomic import recover_folder
from regolith_studio.io.stl import stl_triangles

REPRESENTATION_TOLERANCE = 1e-4
"""Of the errors of the shapes, in standard deviations of the population."""
FLOAT32_TOLERANCE = 1e-6
"""Tolerance of the STL's float32 coordinates at a size of about 1."""


def validate_dataset(folder: Path | str) -> list[str]:
    """Problems of a dataset folder, one sentence each; empty if it is valid.

    Checked are the schema (weights, size distributions, unknown fields, paths), the list of files,
    every hash, and every shape: closed, convex, as many facets as stated, unit volume, centroid at
    the origin, and the same shape in the STL file as in the half-spaces. How well the shapes stand for their
    population is computed again.
    """
    target = recover_folder(real_path(folder))
    try:
        document = read_document(target)
        problems = [f"{name} does not belong to the dataset." for name in foreign_files(target, document)]
        for record in document.representatives:
            problems += _record_problems(target, record)
        if not (target / README).is_file():
            problems.append(f"{README} is missing.")
        if not problems:
            problems += _representation_problems(dataset_of(document, DOCUMENT))
    except RegolithError as error:
        return [str(error)]
    return problems


def _representation_problems(dataset: Dataset) -> list[str]:
    """What the document says of the shapes and they do not have."""
    stated = dataset.provenance.representation
    if stated is None:
        return []
    found = polyhedra_errors(dataset, stated)
    return [
        f"{DOCUMENT} states an error of {error:.4g} in {key}, the shapes have {found[key]:.4g}."
        for key, error in stated.errors.items()
        if not abs(error - found[key]) <= REPRESENTATION_TOLERANCE
    ]


def _record_problems(folder: Path, record: RepresentativeRecord) -> list[str]:
    """Problems of one representative."""
    file = record.mesh.file
    try:
        content = read_mesh_bytes(folder, file)
        if hashlib.sha256(content).hexdigest() != record.mesh.sha256:
            return [f"{file} is not the file that {DOCUMENT} describes: its SHA-256 differs."]
        mesh, shape = mesh_of_stl(content, file), shape_of(record)
    except (RegolithError, ValueError) as error:
        return [f"{file}: {error}"]
    return [f"{file}: {problem}" for problem in _shape_problems(shape, record) + _mesh_problems(mesh, shape)]


def _shape_problems(shape: ConvexPolyhedron, record: RepresentativeRecord) -> list[str]:
    problems = []
    if abs(shape.volume - 1.0) > SHAPE_TOLERANCE:
        problems.append(f"the half-spaces enclose a volume of {shape.volume!r}, not 1.")
    if np.abs(shape.centroid).max() > SHAPE_TOLERANCE:
        problems.append(f"the centroid lies at {shape.centroid.tolist()}, not at the origin.")
    stated = (record.mesh.n_facets, record.mesh.n_vertices, record.mesh.n_triangles)
    found = (shape.n_facets, shape.n_vertices, shape.n_triangles)
    for what, is_stated, is_found in zip(("facets", "vertices", "triangles"), stated, found, strict=True):
        if is_stated != is_found:
            problems.append(f"{is_stated} {what} are stated, the half-spaces have {is_found}.")
    if len(record.half_spaces.offsets) != shape.n_facets:
        problems.append(f"{len(record.half_spaces.offsets) - shape.n_facets} half-spaces bound no facet.")
    return problems


def _mesh_problems(mesh: Mesh, shape: ConvexPolyhedron) -> list[str]:
    problems = []
    table = edge_table(mesh.faces, len(mesh.vertices))
    balance = np.bincount(table.edge, weights=np.where(table.forward, 1, -1))
    if not (table.uses == 2).all() or balance.any():
        problems.append("the surface is not closed, or its triangles do not run the same way round.")
    if abs(mesh.volume - 1.0) > 10 * FLOAT32_TOLERANCE:
        problems.append(f"the mesh encloses a volume of {mesh.volume:.7g}, not 1.")
    planes = shape.half_spaces
    outside = (mesh.vertices @ planes.normals.T - planes.offsets).max()
    if outside > FLOAT32_TOLERANCE * max(1.0, float(np.abs(mesh.vertices).max())):
        problems.append(f"the mesh reaches {outside:.3g} beyond the half-spaces, so it is another shape.")
    if len(mesh.faces) != shape.n_triangles:
        problems.append(f"the mesh has {len(mesh.faces)} triangles, its facets need {shape.n_triangles}.")
    return problems


def mesh_of_stl(content: bytes, where: str) -> Mesh:
    """The mesh of binary STL bytes, equal corners joined.

    Raises
    ------
    DatasetError
        If the bytes are no binary STL, or a coordinate is not finite.
    """
    try:
        corners = stl_triangles(content).reshape(-1, 3)
    except ValueError as error:
        raise DatasetError(f"{where} {error}.") from error
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(vertices, index.reshape(-1, 3))
