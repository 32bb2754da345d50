"""What is measured of a mesh is kept, but not of hundreds."""

import gc
import weakref

import numpy as np
import pytest

from regolith_studio.geometry import mesh as cached_arrays
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere


@pytest.fixture
def a_megabyte(monkeypatch):
    """Room for what two spheres of 1,280 triangles are measured by."""
    monkeypatch.setattr(cached_arrays, "MAX_CACHED_BYTES", 1_000_000)
    monkeypatch.setattr(cached_arrays, "_ledger", cached_arrays._CacheLedger())


def spheres(count):
    base = icosphere(3)
    return [Mesh(base.vertices * (1 + number), base.faces) for number in range(count)]


@pytest.mark.usefixtures("a_megabyte")
def test_that_many_meshes_hold_no_more_than_there_is_room_for():
    many = spheres(40)
    for sphere in many:
        sphere.face_area_vectors  # noqa: B018
    held = sum(v.nbytes for sphere in many for k, v in vars(sphere).items() if k not in ("vertices", "faces"))
    assert 0 < held <= 1_000_000
    assert "triangles" in vars(many[-1])
    assert "triangles" not in vars(many[0])


def test_that_nothing_keeps_a_mesh_alive():
    (sphere,) = spheres(1)
    sphere.hull.triangles  # noqa: B018
    known, hull = weakref.ref(sphere), weakref.ref(sphere.hull)
    del sphere
    gc.collect()
    assert known() is None
    assert hull() is None


def test_that_a_callers_array_is_neither_locked_nor_shared():
    vertices, faces = icosphere(1).vertices.copy(), icosphere(1).faces.copy()
    mesh = Mesh(vertices, faces)
    vertices[0] = 7.0
    faces[0] = 0
    assert mesh.vertices[0, 0] != 7.0
    assert mesh.faces[0].max() > 0
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 9.0
    window = np.zeros((4, 3))[:3]
    window.flags.writeable = False  # its owner can still write
    assert not np.shares_memory(Mesh(window, [[0, 1, 2]]).vertices, window)
