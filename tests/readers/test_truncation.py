"""Files that a broken transfer has cut short, at a dozen places each."""

import re
from fractions import Fraction

import pytest
import trimesh

KIND = {
    "binary.stl": "too short for an STL|is cut short|is empty",
    "ascii.stl": "is empty|broken ASCII STL|too short for an STL|without a single triangle|open sheet",
    "cube.off": "counts of vertices and faces|is cut short|declares 4 corners|vertex|is empty|whole numbers",
    "ascii.ply": "does not begin with|its header|is cut short|ends before|is empty",
    "little.ply": "does not begin with|its header|is cut short|is empty",
    "big.ply": "does not begin with|its header|is cut short|is empty",
    "ball.glb": "of no kind|is cut short|is empty|description is broken",
    "cut.3mf": "archive is damaged|is empty",
}
CUTS = [Fraction(k, 13) for k in range(13)]


def whole(name, cube):
    ball = trimesh.creation.icosphere(subdivisions=1)
    if name == "ball.glb":
        return ball.export(file_type="glb")
    if name == "cut.3mf":
        return cube.three_mf()
    return cube.files()[name]


@pytest.mark.parametrize("cut", CUTS, ids=str)
@pytest.mark.parametrize("name", KIND)
def test_that_a_file_that_was_cut_short_is_refused(name, cut, cube, refusal):
    data = whole(name, cube)
    assert re.search(KIND[name], refusal(name, data[: int(len(data) * cut)]))
