"""Only what triangles use counts: a point without a face changes nothing, in every format."""

import struct

import numpy as np
import pytest

from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.readers.particles import read_mesh
from tests.readers import test_gltf
from tests.readers.test_gltf import DOCUMENT, changed

BOX = (2.0, 3.0, 4.0)
STRAY = (1e6, -1e6, 5.0)


def with_a_stray(name, cube):
    """The bytes of a file whose body is the box of 2 x 3 x 4, with one point more that no face uses."""
    points = [*(cube.vertices * BOX), STRAY]
    faces = cube.faces
    if name == "box.obj":
        lines = ["v {:g} {:g} {:g}".format(*point) for point in points]
        return "\n".join([*lines, *("f {} {} {}".format(*(face + 1)) for face in faces)]).encode()
    rows = ["{:g} {:g} {:g}".format(*point) for point in points]
    rows += ["3 {} {} {}".format(*face) for face in faces]
    if name == "box.off":
        return "\n".join(["OFF", f"{len(points)} {len(faces)} 0", *rows, ""]).encode()
    if name == "box.ply":
        head = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
        head += "".join(f"property float {axis}\n" for axis in "xyz")
        head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        return (head + "\n".join([*rows, ""])).encode()
    body = b"".join(struct.pack("<3f", *point) for point in points) + faces.astype("<u4").tobytes()
    return glb(body, len(points), faces.size)


def glb(body, n_points, n_corners):
    """The GLB of test_gltf with other points and triangles, whose indices have 32 bits."""
    corners = 12 * n_points
    accessors = [
        {**DOCUMENT["accessors"][0], "count": n_points},
        {**DOCUMENT["accessors"][1], "componentType": 5125, "count": n_corners},
    ]
    views = [
        {"buffer": 0, "byteLength": corners},
        {"buffer": 0, "byteOffset": corners, "byteLength": len(body) - corners},
    ]
    document = changed(accessors=accessors, bufferViews=views, buffers=[{"byteLength": len(body)}])
    return test_gltf.glb(document, body)


@pytest.mark.parametrize("name", ["box.obj", "box.off", "box.ply", "box.glb"])
def test_that_a_point_without_a_triangle_changes_nothing(name, cube, tmp_path):
    (tmp_path / name).write_bytes(with_a_stray(name, cube))
    particle = read_mesh(tmp_path / name)
    assert "Left out 1 point that no triangle uses." in particle.notes
    size = particle.mesh.bounds[1] - particle.mesh.bounds[0]
    assert sorted(size / size.min()) == pytest.approx([1.0, 1.5, 2.0])
    found = describe(particle)
    assert found["aspect_ratio"] == pytest.approx(2.0)
    assert found["convex_hull_volume"] == pytest.approx(found["volume"])


def test_that_a_mesh_made_in_python_is_that_of_its_triangles(cube):
    points = np.vstack([[9.0, 9.0, 9.0], cube.vertices * BOX])
    mesh = Mesh(points, cube.faces + 1)
    np.testing.assert_array_equal(mesh.vertices, cube.vertices * BOX)
    np.testing.assert_array_equal(mesh.faces, cube.faces)
    assert mesh.hull.volume == pytest.approx(24.0)


def test_that_points_without_any_faces_are_kept(cube):
    assert len(Mesh(cube.vertices, np.empty((0, 3), dtype=np.int64)).vertices) == 8
