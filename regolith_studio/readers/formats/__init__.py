"""Mesh formats; each module of this folder defines one as ``FORMAT``."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from regolith_studio.registry import Registry


@dataclass(frozen=True)
class ParsedMesh:
    """Triangles as a file states them, unchecked.

    - ``vertices``: shape (n, 3), float64; may hold values that are not finite.
    - ``faces``: shape (m, 3), int64; may point outside the vertices.
    - ``notes``: sentences about parts of the file that were ignored.
    - ``unit``: a key of ``readers.settings.FILE_UNITS``, where the file or its standard states the unit of
      lengths.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    notes: tuple[str, ...] = ()
    unit: str | None = None


@dataclass(frozen=True)
class MeshFormat:
    """A mesh format.

    - ``key``: short name, ``stl``.
    - ``label``: as in a sentence, ``STL``.
    - ``suffixes``: lower case, with the dot.
    - ``recognises``: whether the first 1,024 bytes can only be this format.
    - ``parse``: bytes and path to triangles; the path serves to find buffers beside the file. Raises
      ``FileError`` with the end of a sentence that begins with the file's name.
    - ``shares_vertices``: False where each triangle brings its own three vertices, to be joined after
      reading.
    - ``states_unit``: whether the file or its standard states the unit of lengths.
    """

    key: str
    label: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    parse: Callable[[bytes, Path], ParsedMesh]
    shares_vertices: bool = True
    states_unit: bool = False


MESH_FORMATS: Registry[MeshFormat] = Registry(__name__, "FORMAT", "readers")


def mesh_suffixes() -> frozenset[str]:
    """The suffixes of all mesh formats, lower case, with the dot."""
    return frozenset(suffix for row in MESH_FORMATS.values() for suffix in row.suffixes)
