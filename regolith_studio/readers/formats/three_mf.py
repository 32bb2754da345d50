"""3MF: the objects of a print job with their components and placements."""

import io
import re
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.formats import MeshFormat, ParsedMesh
from regolith_studio.readers.settings import unit_named

MAX_PART_BYTES = 1 << 29
"""Bytes of one unpacked part; a part that unpacks to more is refused."""

MIN_SUSPICIOUS_BYTES, MAX_PACKING_RATIO = 1 << 25, 100
"""XML of real meshes packs to a fifth or a twentieth; a part above 32 MiB that packs far better is a trap."""

MAX_PLACEMENTS = 10_000
MAX_FACES = 20_000_000

_Triangles = tuple[NDArray[np.float64], NDArray[np.int64]]


def parse(data: bytes, _path: Path) -> ParsedMesh:
    """All triangles of the built objects, in the file's unit."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            package = _Package(archive)
            return _built(package)
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError, OSError) as error:
        if isinstance(error, RecursionError):
            raise FileError("is not a valid 3MF: its components form a cycle.") from None
        raise FileError("is not a valid 3MF: its archive is damaged; export it again.") from None
    except ElementTree.ParseError:
        raise FileError("is not a valid 3MF: the XML of its model is broken.") from None
    except KeyError as error:
        raise FileError(f"is not a valid 3MF: its model lacks {_lacking(error)}; export it again.") from None
    except (ValueError, OverflowError) as error:
        raise FileError(f"is not a valid 3MF: {_no_number(error)}; export it again.") from None


def _lacking(error: KeyError) -> str:
    """The attribute of a vertex or triangle, or the part of the archive, that is not there."""
    key = str(error.args[0])
    return f"the attribute “{key}” of a vertex or triangle" if len(key) <= 2 else "a part that it refers to"


def _no_number(error: Exception) -> str:
    """What stands in the model where a number belongs, if that is the reason."""
    match = re.search(r"(?:to float|with base 10): '(.*)'$", str(error))
    if match:
        return f"its model has “{match[1][:24]}” where a number belongs"
    return "a number or a matrix in its model is not what it should be"


class _Package:
    """The model parts of an archive, each read once."""

    def __init__(self, archive: zipfile.ZipFile) -> None:
        self._archive = archive
        self._models: dict[str, Element] = {}
        self._objects: dict[str, dict[str | None, Element]] = {}
        self.root_part = self._find_root()
        self.placements = 0
        self.faces = 0

    def model(self, part: str) -> Element:
        """The root element of a model part."""
        if part not in self._models:
            self._models[part] = _xml(self._read(part))
        return self._models[part]

    def object(self, part: str, key: str) -> Element:
        """The object of a model part that has this id."""
        if part not in self._objects:
            found = [
                (candidate.get("id"), candidate)
                for resources in _children(self.model(part), "resources")
                for candidate in _children(resources, "object")
            ]
            self._objects[part] = dict(reversed(found))
        if key not in self._objects[part]:
            shown = printable(key)[:20]
            raise FileError(f"is not a valid 3MF: it builds the object “{shown}”, which is not there.")
        return self._objects[part][key]

    def _find_root(self) -> str:
        if "_rels/.rels" in self._archive.namelist():
            for relation in _xml(self._read("_rels/.rels")):
                if relation.get("Type", "").endswith("/3dmodel"):
                    return relation.get("Target", "").lstrip("/")
        models = [name for name in self._archive.namelist() if name.lower().endswith(".model")]
        if not models:
            raise FileError("is not a 3MF: its archive holds no model.")
        return min(models)

    def _read(self, part: str) -> bytes:
        entry = self._archive.getinfo(part)
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise FileError("is not a valid 3MF: a part is compressed in another way than deflate.")
        if (
            entry.file_size > MIN_SUSPICIOUS_BYTES
            and entry.file_size > MAX_PACKING_RATIO * entry.compress_size
        ):
            size = entry.file_size / 1e6
            raise FileError(
                f"unpacks to {size:,.0f} MB, {MAX_PACKING_RATIO} times its size or more, which no mesh does."
            )
        with self._archive.open(part) as file:
            data = file.read(MAX_PART_BYTES + 1)
        if len(data) > MAX_PART_BYTES:
            raise FileError("unpacks to more than 512 MiB, which is more than can be read.")
        return data


def _xml(data: bytes) -> Element:
    # Entities may unfold to any size.
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise FileError("is not a valid 3MF: its XML defines entities.")
    return ElementTree.fromstring(data)


def _children(element: Element, name: str) -> Iterator[Element]:
    return (child for child in element if child.tag.rpartition("}")[2] == name)


def _built(package: _Package) -> ParsedMesh:
    model = package.model(package.root_part)
    parts: list[_Triangles] = []
    for build in _children(model, "build"):
        for item in _children(build, "item"):
            _place(package, package.root_part, item, np.eye(4), parts, 0)
    if not parts:
        raise FileError("is a 3MF that builds no triangles.")
    offsets = np.cumsum([0, *(len(points) for points, _ in parts)])
    unit, note = _unit(model.get("unit"))
    return ParsedMesh(
        np.concatenate([points for points, _ in parts]),
        np.concatenate([faces + offset for (_, faces), offset in zip(parts, offsets, strict=False)]),
        (note,),
        unit,
    )


def _unit(stated: str | None) -> tuple[str, str]:
    """The key of the unit that a model states, which is the millimetre where it states none, and a note."""
    if stated is None:
        return "mm", "The file states no unit; that of 3MF is the millimetre."
    key = unit_named(stated)
    if key is None:
        raise FileError(f"states the unit “{printable(stated)[:20]}”, which 3MF does not have.")
    return key, f"The file states its unit: {stated.strip().lower()}."


def _place(
    package: _Package,
    part: str,
    use: Element,
    above: NDArray[np.float64],
    parts: list[_Triangles],
    depth: int,
) -> None:
    """Add the triangles of the object that `use` (an item or a component) refers to."""
    package.placements += 1
    if depth > 50 or package.placements > MAX_PLACEMENTS:
        raise FileError("is not a valid 3MF: its components form a cycle, or are too many.")
    elsewhere = next((value for key, value in use.attrib.items() if key.rpartition("}")[2] == "path"), None)
    part = elsewhere.lstrip("/") if elsewhere else part
    matrix = above @ _matrix(use.get("transform"))
    thing = package.object(part, use.get("objectid", ""))
    for mesh in _children(thing, "mesh"):
        points, faces = _triangles(mesh)
        package.faces += len(faces)
        if package.faces > MAX_FACES:
            raise FileError(f"has more than {MAX_FACES:,} faces, which is more than can be read.")
        # A placement that mirrors turns faces inside out.
        faces = faces[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else faces
        parts.append((points @ matrix[:3, :3].T + matrix[:3, 3], faces))
    for components in _children(thing, "components"):
        for component in _children(components, "component"):
            _place(package, part, component, matrix, parts, depth + 1)


def _matrix(text: str | None) -> NDArray[np.float64]:
    """Transformation for column vectors from the twelve numbers of a 3MF, written for row vectors."""
    matrix = np.eye(4)
    if text:
        matrix[:3, :] = np.array([float(word) for word in text.split()]).reshape(4, 3).T
    return matrix


def _triangles(mesh: Element) -> _Triangles:
    points = [
        [float(vertex.attrib[axis]) for axis in "xyz"]
        for group in _children(mesh, "vertices")
        for vertex in _children(group, "vertex")
    ]
    faces = [
        [int(triangle.attrib[corner]) for corner in ("v1", "v2", "v3")]
        for group in _children(mesh, "triangles")
        for triangle in _children(group, "triangle")
    ]
    indices = np.array(faces, dtype=np.int64).reshape(-1, 3)
    if len(indices) and (indices.min() < 0 or indices.max() >= len(points)):
        raise FileError(f"is not a valid 3MF: a triangle points beyond the {len(points):,} vertices.")
    return np.array(points, dtype=np.float64).reshape(-1, 3), indices


def _recognises(head: bytes) -> bool:
    return head[:4] == b"PK\3\4" and b"3D/" in head


FORMAT = MeshFormat("3mf", "3MF", (".3mf",), _recognises, parse, states_unit=True)
