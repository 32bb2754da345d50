"""Binary STL: unit normals, float32 corners, and nothing but complete files."""

import numpy as np
import pytest

from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import RECORD, stl_bytes, stl_triangles


def test_that_stl_bytes_hold_outward_unit_normals_and_the_corners() -> None:
    mesh = icosphere(2)
    content = stl_bytes(mesh.triangles, "a header")
    assert len(content) == 84 + 50 * len(mesh.faces)
    assert int.from_bytes(content[80:84], "little") == len(mesh.faces)
    records = np.frombuffer(content[84:], dtype=RECORD)
    assert np.linalg.norm(records["normal"], axis=1) == pytest.approx(1.0, abs=1e-6)
    assert np.abs(records["corners"] - mesh.triangles).max() < 1e-5


@pytest.mark.parametrize("header", ["solid body", "x" * 81, "µm"])
def test_that_headers_which_readers_would_misread_are_refused(header: str) -> None:
    with pytest.raises(ValueError, match="STL header"):
        stl_bytes(icosphere(2).triangles, header)


def test_that_triangles_are_read_back_as_float32() -> None:
    triangles = icosphere(2).triangles
    assert np.array_equal(stl_triangles(stl_bytes(triangles, "")), triangles.astype(np.float32))


@pytest.mark.parametrize("damage", [lambda data: data[:-1], lambda data: data + b"x", lambda data: data[:80]])
def test_that_an_incomplete_file_is_refused(damage) -> None:
    with pytest.raises(ValueError, match="no complete binary STL"):
        stl_triangles(damage(stl_bytes(icosphere(1).triangles, "")))


def test_that_a_coordinate_that_is_not_finite_is_refused() -> None:
    records = np.zeros(1, dtype=RECORD)
    records["corners"][0, 1, 2] = np.inf
    with pytest.raises(ValueError, match="not finite"):
        stl_triangles(bytes(80) + (1).to_bytes(4, "little") + records.tobytes())
