"""A unit cube, files of it in every format, and a check that a refusal is one plain sentence."""

import io
import struct
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.readers.particles import read_mesh

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
TRIANGLES = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])


@dataclass(frozen=True)
class Cube:
    """The unit cube as arrays and as the bytes of well-formed files."""

    vertices = CORNERS
    faces = TRIANGLES
    quads = QUADS

    def binary_stl(self) -> bytes:
        records = b"".join(struct.pack("<12fH", 0, 0, 0, *CORNERS[face].ravel(), 0) for face in TRIANGLES)
        return bytes(80) + struct.pack("<I", len(TRIANGLES)) + records

    def ascii_stl(self) -> bytes:
        lines = ["solid cube"]
        for face in TRIANGLES:
            lines += ["facet normal 0 0 0", " outer loop"]
            lines += ["  vertex {:g} {:g} {:g}".format(*CORNERS[corner]) for corner in face]
            lines += [" endloop", "endfacet"]
        return "\n".join([*lines, "endsolid cube", ""]).encode()

    def obj(self) -> bytes:
        lines = ["v {:g} {:g} {:g}".format(*corner) for corner in CORNERS]
        lines += ["f " + " ".join(str(index + 1) for index in quad) for quad in QUADS]
        return "\n".join([*lines, ""]).encode()

    def off(self) -> bytes:
        lines = ["OFF", "8 6 0", *("{:g} {:g} {:g}".format(*corner) for corner in CORNERS)]
        lines += ["4 " + " ".join(map(str, quad)) for quad in QUADS]
        return "\n".join([*lines, ""]).encode()

    def ascii_ply(self) -> bytes:
        lines = ["{:g} {:g} {:g}".format(*corner) for corner in CORNERS]
        lines += ["4 " + " ".join(map(str, quad)) for quad in QUADS]
        return self._ply_header("ascii") + "\n".join([*lines, ""]).encode()

    def binary_ply(self, order: str = "<") -> bytes:
        kind = "binary_little_endian" if order == "<" else "binary_big_endian"
        rows = [struct.pack(order + "3f", *corner) for corner in CORNERS]
        rows += [struct.pack(order + "B4i", 4, *quad) for quad in QUADS]
        return self._ply_header(kind) + b"".join(rows)

    def _ply_header(self, encoding: str) -> bytes:
        return (
            f"ply\nformat {encoding} 1.0\nelement vertex 8\n"
            "property float x\nproperty float y\nproperty float z\n"
            "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
        ).encode()

    def three_mf(self, unit: str = "", scale: Sequence[float] = (1.0, 1.0, 1.0)) -> bytes:
        points = "".join('<vertex x="{:g}" y="{:g}" z="{:g}"/>'.format(*corner) for corner in CORNERS * scale)
        faces = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in TRIANGLES)
        model = f"<vertices>{points}</vertices><triangles>{faces}</triangles>"
        model = f'<resources><object id="1"><mesh>{model}</mesh></object></resources>'
        head = f'<model unit="{unit}">' if unit else "<model>"
        data = io.BytesIO()
        with zipfile.ZipFile(data, "w") as archive:
            archive.writestr("3D/3dmodel.model", f'{head}{model}<build><item objectid="1"/></build></model>')
        return data.getvalue()

    def files(self) -> dict[str, bytes]:
        """One well-formed file for each way of writing, by its name."""
        return {
            "binary.stl": self.binary_stl(),
            "ascii.stl": self.ascii_stl(),
            "cube.obj": self.obj(),
            "cube.off": self.off(),
            "ascii.ply": self.ascii_ply(),
            "little.ply": self.binary_ply("<"),
            "big.ply": self.binary_ply(">"),
        }


@pytest.fixture(scope="session")
def cube() -> Cube:
    return Cube()


@pytest.fixture
def refusal(tmp_path: Path) -> Callable[[str, bytes], str]:
    """Writes bytes into a file and returns the one sentence that it is refused with."""

    def refuse(name: str, data: bytes) -> str:
        path = tmp_path / name
        path.write_bytes(data)
        with pytest.raises((FileError, GeometryError)) as caught:
            read_mesh(path)
        sentence = str(caught.value)
        assert sentence.startswith(name)
        assert sentence.endswith(".")
        assert "\n" not in sentence
        assert len(sentence) < 250
        return sentence

    return refuse


@pytest.fixture
def accepted(tmp_path: Path) -> Callable[..., object]:
    """Writes bytes into a file and returns the particle that comes out."""

    def accept(name: str, data: bytes, **options: object) -> object:
        path = tmp_path / name
        path.write_bytes(data)
        return read_mesh(path, **options)  # type: ignore[arg-type]

    return accept
