"""Files with bytes changed at random: every parser gives triangles or one sentence, nothing else."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.repair import repair
from regolith_studio.geometry.topology import merged_vertices
from regolith_studio.readers.sandbox.tasks import parse_mesh
from tests.readers.mutations import check_sentence, mutated

NAMES = [
    "binary.stl",
    "ascii.stl",
    "cube.obj",
    "cube.off",
    "ascii.ply",
    "little.ply",
    "big.ply",
    "cube.gltf",
    "cube.3mf",
    "cube.glb",
]


def seeds(cube):
    """The well-formed files, with a glTF made here and a 3MF."""
    document = {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0, "scale": [1, 1, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:;base64," + "AAAA" * 12}],
    }
    text = json.dumps({**document, "buffers": [{"byteLength": 36}]}).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", 36, b"BIN\0") + bytes(36)
    binary = b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks
    return {
        **cube.files(),
        "cube.gltf": json.dumps(document).encode(),
        "cube.3mf": cube.three_mf(),
        "cube.glb": binary,
    }


def nudged(data, rng):
    """`data` with one bit changed."""
    place = int(rng.integers(0, len(data)))
    return data[:place] + bytes([data[place] ^ (1 << int(rng.integers(0, 8)))]) + data[place + 1 :]


def survives(name, data):
    """Whether triangles came out; anything but the two errors of a bad file is let through."""
    try:
        parsed, _ = parse_mesh(data, Path(name))
    except (FileError, GeometryError) as error:
        sentence = str(error)
        assert sentence.startswith(name), sentence
        check_sentence(sentence, 400)
        return False
    assert parsed.vertices.shape[1:] == parsed.faces.shape[1:] == (3,)
    assert np.isfinite(parsed.vertices).all()
    assert 0 <= parsed.faces.min() <= parsed.faces.max() < len(parsed.vertices)
    return True


@pytest.mark.parametrize("name", NAMES)
def test_that_three_hundred_mutations_give_triangles_or_a_sentence(name, cube):
    rng = np.random.default_rng(11)
    data = seeds(cube)[name]
    assert survives(name, data)
    for _ in range(300):
        survives(name, mutated(data, rng))


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_that_forty_thousand_mutations_give_triangles_or_a_sentence(name, cube):
    rng = np.random.default_rng(12)
    data = seeds(cube)[name]
    for _ in range(40_000):
        survives(name, mutated(data, rng))


@pytest.mark.parametrize("name", NAMES[:7])
def test_that_mutated_cubes_are_repaired_or_refused(name, cube):
    rng = np.random.default_rng(13)
    repaired = 0
    for _ in range(60):
        data = nudged(seeds(cube)[name], rng)
        try:
            parsed, _ = parse_mesh(data, Path(name))
            result = repair(Mesh(*merged_vertices(parsed.vertices, parsed.faces)))
        except (FileError, GeometryError):
            continue
        assert result.health_after.sound
        repaired += 1
    assert repaired > 5
