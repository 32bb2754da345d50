"""Binary STL, the format in which single particles are stored.

Files from elsewhere go through the strict reader in :mod:`regolith_studio.readers.formats.stl`.
"""

import numpy as np
from numpy.typing import NDArray

HEADER_SIZE = 80
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""One triangle of a binary STL file."""

_FIRST_RECORD = HEADER_SIZE + 4  # the number of triangles, uint32, follows the header


def stl_bytes(triangles: NDArray[np.float64], header: str) -> bytes:
    """Triangles as binary STL with unit normals and float32 coordinates.

    ``triangles``: corner coordinates, shape (m, 3, 3): triangle, corner, axis. ``header``: at most 80 ASCII
    characters.

    Raises ValueError if the header is too long or begins with ``solid``, which readers take for the ASCII
    form.
    """
    if len(header) > HEADER_SIZE or not header.isascii() or header.startswith("solid"):
        raise ValueError(
            f"an STL header has at most {HEADER_SIZE} ASCII characters, not beginning with solid: {header!r}"
        )
    a, b, c = np.moveaxis(triangles, 1, 0)
    normals = np.cross(b - a, c - a) / 2
    areas = np.linalg.norm(normals, axis=1)[:, None]
    records = np.zeros(len(triangles), dtype=RECORD)
    records["normal"] = np.divide(normals, areas, out=np.zeros((len(areas), 3)), where=areas > 0)
    records["corners"] = triangles
    count = np.array(len(records), dtype="<u4")
    return header.encode("ascii").ljust(HEADER_SIZE) + count.tobytes() + records.tobytes()


def stl_triangles(content: bytes) -> NDArray[np.float64]:
    """Corner coordinates of the triangles in binary STL, shape (m, 3, 3).

    Raises ValueError if the length is not the one that the number of triangles requires, or a coordinate is
    not finite.
    """
    count = int.from_bytes(content[HEADER_SIZE:_FIRST_RECORD], "little")
    if len(content) < _FIRST_RECORD or len(content) != _FIRST_RECORD + RECORD.itemsize * count:
        raise ValueError("is no complete binary STL")
    corners = np.frombuffer(content, dtype=RECORD, offset=_FIRST_RECORD)["corners"].astype(np.float64)
    if not np.isfinite(corners).all():
        raise ValueError("holds a coordinate that is not finite")
    return corners
