"""Files with bytes changed at random: every parser gives triangles or one sentence, nothing else."""

from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.repair import repair
from regolith_studio.geometry.topology import merged_vertices
from regolith_studio.readers.sandbox.tasks import parse_mesh
from tests.readers.mutations import check_sentence, mutated
from tests.readers.test_gltf import glb, gltf

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
    """The well-formed files, with glTF and 3MF."""
    return {**cube.files(), "cube.gltf": gltf(), "cube.3mf": cube.three_mf(), "cube.glb": glb()}


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


@pytest.mark.parametrize(("count", "seed"), [(300, 11), pytest.param(40_000, 12, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", NAMES)
def test_that_mutations_give_triangles_or_a_sentence(name, count, seed, cube):
    rng = np.random.default_rng(seed)
    data = seeds(cube)[name]
    assert survives(name, data)
    for _ in range(count):
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
