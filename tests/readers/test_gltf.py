"""glTF and GLB: scenes with transformations, strips and broken descriptions."""

import base64
import copy
import json
import re
import struct

import numpy as np
import pytest
import trimesh

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype="<f4")
QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
FACES = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]]).astype("<u2")
BINARY = CORNERS.tobytes() + FACES.tobytes()
DOCUMENT = {
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
    ],
    "bufferViews": [
        {"buffer": 0, "byteLength": 96},
        {"buffer": 0, "byteOffset": 96, "byteLength": 72},
    ],
    "buffers": [{"byteLength": 168}],
}


def changed(**tables):
    return {**copy.deepcopy(DOCUMENT), **tables}


def glb(document=DOCUMENT, binary=BINARY):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    length = 12 + 8 + len(text) + 8 + len(binary)
    head = b"glTF" + struct.pack("<II", 2, length)
    return (
        head
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(binary), b"BIN\0")
        + binary
    )


EMBEDDED = "data:application/octet-stream;base64," + base64.b64encode(BINARY).decode()


def gltf(document=DOCUMENT, uri=EMBEDDED):
    return json.dumps({**document, "buffers": [{"byteLength": 168, "uri": uri}]}).encode()


def test_that_a_cube_in_a_glb_or_gltf_has_volume_one(accepted):
    assert accepted("cube.glb", glb(), unit="voxel:1").mesh.volume == pytest.approx(1.0)
    assert accepted("cube.gltf", gltf(), unit="voxel:1").mesh.volume == pytest.approx(1.0)


def test_that_a_buffer_beside_the_file_is_read(accepted, tmp_path):
    (tmp_path / "cube.bin").write_bytes(BINARY)
    assert accepted("cube.gltf", gltf(uri="cube.bin"), unit="voxel:1").mesh.volume == pytest.approx(1.0)


def test_that_nodes_are_transformed(accepted):
    """A quarter turn about z, twice the size in x, and a parent of thrice the size."""
    nodes = [
        {"children": [1], "scale": [3, 3, 3]},
        {"mesh": 0, "rotation": [0, 0, 0.5**0.5, 0.5**0.5], "scale": [2, 1, 1], "translation": [5, 0, 0]},
    ]
    mesh = accepted("cube.glb", glb(changed(nodes=nodes)), unit="voxel:1").mesh
    assert mesh.volume == pytest.approx(54.0)
    assert np.allclose(mesh.bounds, [[12, 0, 0], [15, 6, 3]], atol=1e-6)


def test_that_a_mirrored_node_still_faces_outwards(accepted):
    particle = accepted("cube.glb", glb(changed(nodes=[{"mesh": 0, "scale": [-1, 1, 1]}])), unit="voxel:1")
    assert particle.mesh.volume == pytest.approx(1.0)
    assert particle.notes[0] == "The unit of glTF is the metre."
    assert particle.notes[1:] == ("Its numbers were multiplied by 1 µm instead, as was asked.",)


def test_that_normalised_bytes_are_coordinates_between_zero_and_one(accepted):
    """As compressing programs write positions: bytes in steps of four, 255 for one."""
    corners = np.zeros((8, 4), dtype="u1")
    corners[:, :3] = 255 * CORNERS
    accessors = [
        {**DOCUMENT["accessors"][0], "componentType": 5121, "normalized": True},
        DOCUMENT["accessors"][1],
    ]
    views = [
        {"buffer": 0, "byteLength": 32, "byteStride": 4},
        {"buffer": 0, "byteOffset": 32, "byteLength": 72},
    ]
    data = glb(changed(accessors=accessors, bufferViews=views), corners.tobytes() + FACES.tobytes())
    assert accepted("cube.glb", data, unit="voxel:1").mesh.volume == pytest.approx(1.0)


def test_that_a_file_of_trimesh_is_read(accepted):
    solid = trimesh.creation.icosphere(subdivisions=2)
    mesh = accepted("ball.glb", solid.export(file_type="glb"), unit="voxel:1").mesh
    assert mesh.volume == pytest.approx(solid.volume, rel=1e-5)
    assert mesh.surface_area == pytest.approx(solid.area, rel=1e-5)


BAD = {
    "cut short": (glb()[:-8], "is cut short"),
    "a header alone": (b"glTF\2\0\0\0", "is cut short"),
    "version 1": (glb().replace(b"glTF\2", b"glTF\1"), "of version 1"),
    "no JSON": (glb().replace(b"JSON", b"JSOM"), "no JSON chunk"),
    "broken JSON": (glb().replace(b'{"asset"', b'{{asset"'), "its JSON breaks in line 1, column 2"),
    "deep JSON": (b"[" * 200_000, "its JSON nests too deeply"),
    "JSON of something else": (b'{"a": 1}', "has no “asset”"),
    "no nodes": (glb(changed(nodes=[], scenes=[{"nodes": []}])), "without triangles"),
    "points only": (
        glb(changed(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}])),
        "without triangles",
    ),
    "a circle of nodes": (glb(changed(nodes=[{"mesh": 0, "children": [0]}])), "form a cycle"),
    "a node that is not there": (glb(changed(scenes=[{"nodes": [7]}])), r"points to nodes\[7\]"),
    "an accessor that is not there": (glb(changed(accessors=[])), r"points to accessors\[0\]"),
    "an index too high": (glb(binary=BINARY[:96] + b"\x63\0" + BINARY[98:]), "points to vertex 99 of 8"),
    "a count beyond the buffer": (
        glb(changed(accessors=[{**DOCUMENT["accessors"][0], "count": 10**9}, DOCUMENT["accessors"][1]])),
        "needs 12,000,000,000 bytes",
    ),
    "compression": (glb(changed(extensionsRequired=["KHR_draco_mesh_compression"])), "without compression"),
    "a file elsewhere": (gltf(uri="../../etc/passwd"), "only files in its own folder"),
    "an address": (gltf(uri="http://example.org/cube.bin"), "only files in its own folder"),
    "a file that is not there": (gltf(uri="cube.bin"), "needs the file cube.bin"),
    "base64 that is none": (gltf(uri="data:;base64,****"), "is not base64"),
    "a matrix of nine numbers": (
        glb(changed(nodes=[{"mesh": 0, "matrix": [1] * 9}])),
        "an entry of its description is of a wrong type or length",
    ),
}


@pytest.mark.parametrize("kind", BAD)
def test_that_a_bad_gltf_is_refused_with_one_sentence_that_says_why(kind, refusal):
    data, expected = BAD[kind]
    name = "bad.glb" if data.startswith(b"glTF") else "bad.gltf"
    assert re.search(expected, refusal(name, data))
