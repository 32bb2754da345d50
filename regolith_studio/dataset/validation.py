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
from regolith_studio.dataset.representatives import polyhedra_errors
from regolith_studio.dataset.schema import (
    CompoundRecord,
    HalfSpacesRecord,
    MeshRecord,
    RepresentativeRecord,
)
from regolith_studio.dataset.serialization import dataset_of, shape_of, stored_triangles, union_properties
from regolith_studio.errors import DatasetError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.topology import edge_table
from regolith_studio.io.atomic import recover_folder
from regolith_studio.io.triangles import stl_triangles

REPRESENTATION_TOLERANCE = 1e-4
"""Of the errors of the shapes, in standard deviations of the population."""
FLOAT32_TOLERANCE = 1e-6
"""Tolerance of the STL's float32 coordinates at a size of about 1."""
STATED_TOLERANCE = 1e-9
"""Of volume, centre of mass and inertia of compounds."""
DESCRIPTOR_TOLERANCE = 1e-7
"""Of descriptors of compounds, relative where they are above 1."""


def validate_dataset(folder: Path | str) -> list[str]:
    """Problems of a dataset folder, one sentence each; empty if it is valid.

    Checked are the schema (weights, size distributions, unknown fields, paths), the list of files,
    every hash, and every shape: closed, convex (or every part of it), as many facets as stated, unit volume,
    centroid at the origin, and the same shape in the STL file as in the half-spaces. Volume, centre of mass,
    inertia and descriptors of compounds, and how well shapes stand for their population, are computed again.
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
    errors = polyhedra_errors(dataset, stated)
    return [
        f"{DOCUMENT} states an error of {error:.4g} in {key}, the shapes have {errors[key]:.4g}."
        for key, error in stated.errors.items()
        if not abs(error - errors[key]) <= REPRESENTATION_TOLERANCE
    ]


def _record_problems(folder: Path, record: RepresentativeRecord) -> list[str]:
    """Problems of one representative."""
    try:
        shape = shape_of(record)
    except (RegolithError, ValueError) as error:
        return [f"{record.mesh.file}: {error}"]
    problems = _file_problems(folder, record.mesh, shape, record.half_spaces, np.zeros(3))
    if isinstance(shape, ConvexCompound) and record.compound is not None:
        for part, stated in zip(shape.parts, record.compound.parts, strict=True):
            origin = np.array(stated.origin)
            problems += _file_problems(folder, stated.mesh, part, stated.half_spaces, origin)
        problems += [f"{record.mesh.file}: {each}" for each in _stated_problems(shape, record.compound)]
    return [*problems, *(f"{record.mesh.file}: {each}" for each in _shape_problems(shape))]


def _shape_problems(shape: Polyhedron) -> list[str]:
    problems = []
    if abs(shape.volume - 1.0) > SHAPE_TOLERANCE:
        problems.append(f"the half-spaces enclose a volume of {shape.volume!r}, not 1.")
    if np.abs(shape.centroid).max() > SHAPE_TOLERANCE:
        problems.append(f"the centroid lies at {shape.centroid.tolist()}, not at the origin.")
    return problems


def _stated_problems(shape: ConvexCompound, record: CompoundRecord) -> list[str]:
    """What a record says of a union and its parts do not have."""
    properties = union_properties(shape)
    problems = []
    for name in ("volume", "centre_of_mass", "inertia"):
        apart = float(np.abs(np.subtract(getattr(record, name), properties[name])).max())
        if not apart <= STATED_TOLERANCE:
            words = name.replace("_", " ")
            problems.append(f"the {words} that is stated is {apart:.3g} off that of the union of the parts.")
    for key in sorted(record.descriptors.keys() ^ properties["descriptors"].keys()):
        problems.append(f"the descriptor {key} is stated or missing, and should not be.")
    for key in sorted(record.descriptors.keys() & properties["descriptors"].keys()):
        stated, real = record.descriptors[key], properties["descriptors"][key]
        if not abs(stated - real) <= DESCRIPTOR_TOLERANCE * max(1.0, abs(real)):
            problems.append(f"a {key} of {stated!r} is stated, the union of the parts has {real!r}.")
    return problems


def _file_problems(
    folder: Path, record: MeshRecord, shape: Polyhedron, planes: HalfSpacesRecord | None, origin: FloatArray
) -> list[str]:
    """Problems of an STL file and of what is stated of it; `shape` lies about `origin`."""
    file = record.file
    try:
        content = read_mesh_bytes(folder, file)
        if hashlib.sha256(content).hexdigest() != record.sha256:
            return [f"{file} is not the file that {DOCUMENT} describes: its SHA-256 differs."]
        mesh = mesh_of_stl(content, file)
    except (RegolithError, ValueError) as error:
        return [f"{file}: {error}"]
    problems = _closure_problems(mesh, shape) + _surface_problems(mesh, shape, origin)
    if isinstance(shape, ConvexCompound):
        problems += _count_problems(record, (shape.n_facets, len(mesh.vertices), len(mesh.faces)), "file has")
    else:
        counts = (shape.n_facets, shape.n_vertices, shape.n_triangles)
        problems += _count_problems(record, counts, "half-spaces have")
        if planes is not None and len(planes.offsets) != shape.n_facets:
            problems.append(f"{len(planes.offsets) - shape.n_facets} half-spaces bound no facet.")
        if len(mesh.faces) != (needed := len(stored_triangles(shape.mesh))):
            problems.append(f"the mesh has {len(mesh.faces)} triangles, its facets need {needed}.")
    return [f"{file}: {problem}" for problem in problems]


def _count_problems(record: MeshRecord, counts: tuple[int, int, int], where: str) -> list[str]:
    stated = (record.n_facets, record.n_vertices, record.n_triangles)
    return [
        f"{is_stated} {what} are stated, the {where} {is_found}."
        for what, is_stated, is_found in zip(("facets", "vertices", "triangles"), stated, counts, strict=True)
        if is_stated != is_found
    ]


def _closure_problems(mesh: Mesh, shape: Polyhedron) -> list[str]:
    """Of a surface; parts of a union may touch along an edge, which four triangles then use."""
    table = edge_table(mesh.faces, len(mesh.vertices))
    balance = np.bincount(table.edge, weights=np.where(table.forward, 1, -1))
    even = table.uses % 2 == 0 if isinstance(shape, ConvexCompound) else table.uses == 2
    if even.all() and not balance.any():
        return []
    return ["the surface is not closed, or its triangles do not run the same way round."]


def _surface_problems(mesh: Mesh, shape: Polyhedron, origin: FloatArray) -> list[str]:
    """Whether a mesh has the volume of a shape and does not reach beyond it."""
    problems = []
    size = max(1.0, float(np.abs(mesh.vertices).max()))
    if abs(mesh.volume - shape.volume) > 10 * FLOAT32_TOLERANCE:
        problems.append(f"the mesh encloses a volume of {mesh.volume:.7g}, not {shape.volume:.7g}.")
    solids = (
        [(shape, origin)]
        if isinstance(shape, ConvexPolyhedron)
        else zip(shape.parts, shape.places, strict=True)
    )
    beyond = [
        ((mesh.vertices - place) @ part.half_spaces.normals.T - part.half_spaces.offsets).max(axis=1)
        for part, place in solids
    ]
    outside = np.min(beyond, axis=0).max()
    if outside > FLOAT32_TOLERANCE * size:
        problems.append(f"the mesh reaches {outside:.3g} beyond the half-spaces, so it is another shape.")
    return problems


def mesh_of_stl(content: bytes, where: str) -> Mesh:
    """The mesh of binary STL bytes, equal corners joined.

    Raises DatasetError if the bytes are no binary STL, or a coordinate is not finite.
    """
    try:
        corners = stl_triangles(content).reshape(-1, 3)
    except ValueError as error:
        raise DatasetError(f"{where} {error}.") from error
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(vertices, index.reshape(-1, 3))
