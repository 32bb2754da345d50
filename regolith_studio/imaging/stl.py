"""Binary STL bytes of a mesh: the form in which single particles are kept on disk."""

import numpy as np

from regolith_studio.geometry.mesh import Mesh

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def stl_bytes(mesh: Mesh, header: str) -> bytes:
    """The mesh as binary STL with unit normals, float32 coordinates and `header` (ASCII, 80 bytes at most).

    Raises
    ------
    ValueError
        If the header is too long or begins with ``solid``, which readers take for the ASCII form.
    """
    if len(header) > 80 or not header.isascii() or header.startswith("solid"):
        raise ValueError(
            f"an STL header has at most 80 ASCII characters, not beginning with solid: {header!r}"
        )
    records = np.zeros(len(mesh.faces), dtype=RECORD)
    areas = mesh.face_areas[:, None]
    records["normal"] = np.divide(
        mesh.face_area_vectors, areas, out=np.zeros((len(areas), 3)), where=areas > 0
    )
    records["corners"] = mesh.triangles
    count = np.array(len(records), dtype="<u4")
    return header.encode("ascii").ljust(80) + count.tobytes() + records.tobytes()
