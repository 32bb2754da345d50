"""OFF files as they are met, good and bad."""

import re

import pytest

V = "0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n"
F = "4 0 1 3 2\n4 4 6 7 5\n4 0 4 5 1\n4 2 3 7 6\n4 0 2 6 4\n4 1 5 7 3\n"
CUBE = "OFF\n8 6 12\n" + V + F
COUNTS, CUT, VERTEX, FACE = (
    "counts of vertices and faces",
    "is cut short: it declares",
    "OFF: vertex",
    "OFF: face",
)
POINTS, SHEET, NOT_FINITE = "point cloud", "open sheet", "all finite numbers"

BAD = {
    "nothing": ("", "is empty"),
    "the keyword": ("OFF", COUNTS),
    "the keyword and a comment": ("OFF\n# nothing\n", COUNTS),
    "negative counts": (CUBE.replace("8 6 12", "-8 6 12"), "counts -8 vertices"),
    "no vertices": ("OFF\n0 0 0\n", "empty mesh"),
    "faces without vertices": ("OFF\n0 6 0\n" + F, FACE),
    "points": ("OFF\n8 0 0\n" + V, POINTS),
    "too many vertices": (CUBE.replace("8 6 12", "99 6 12"), CUT),
    "billions of vertices": (CUBE.replace("8 6 12", "353535235358 6 12"), CUT),
    "an integer that does not end": (CUBE.replace("8 6 12", "9" * 200 + " 6 12"), "counts 1e\\+200 vertices"),
    "half the faces missing": (CUBE[:-30], "(is cut short|declares 4 corners)"),
    "too few vertices plural": (CUBE.replace("8 6 12", "7 6 12"), FACE),
    "a vertex of two numbers": (CUBE.replace("0 1 1\n", "0 1\n", 1), VERTEX),
    "a vertex of words": (CUBE.replace("0 1 1\n", "a b c\n", 1), "has “a”"),
    "decimal commas": (CUBE.replace("0 1 1\n", "0,5 1 1\n", 1), VERTEX),
    "a face that is a word": (CUBE.replace("4 0 1 3 2", "four 0 1 3 2"), "whole numbers"),
    "an index that is a word": (CUBE.replace("4 0 1 3 2", "4 0 x 3 2"), "whole numbers"),
    "an index too high": (CUBE.replace("4 0 1 3 2", "4 0 1 8 2"), "points to vertex 8"),
    "counted from one": (re.sub(r"(?<= )7", "8", CUBE), "points to vertex 8"),
    "a face of no corners": (CUBE.replace("4 0 1 3 2", "0"), "declares 0 corners"),
    "a face of minus one corner": (CUBE.replace("4 0 1 3 2", "-1 0 1 3 2"), "declares -1 corners"),
    "a face of too many corners": (CUBE.replace("4 1 5 7 3", "5 1 5 7 3"), "declares 5 corners"),
    "a face of a billion corners": (
        CUBE.replace("4 1 5 7 3", "1000000000 1 5 7 3"),
        "declares 1000000000 corners",
    ),
    "only lines": ("OFF\n8 1 0\n" + V + "2 0 1\n", POINTS),
    "one triangle": ("OFF\n8 1 0\n" + V + "3 0 1 2\n", SHEET),
    "two sides of a cube": ("OFF\n8 2 0\n" + V + "4 0 1 3 2\n4 0 4 5 1\n", SHEET),
    "a flattened cube": (CUBE.replace(" 1\n", " 0\n"), "(flat|sheet)"),
    "all corners in one point": ("OFF\n8 6 12\n" + "0 0 0\n" * 8 + F, "point or a line"),
    "not a number everywhere": ("OFF\n8 6 12\n" + "nan nan nan\n" * 8 + F, NOT_FINITE),
    "infinite coordinates": ("OFF\n8 6 12\n" + "inf inf -inf\n" * 8 + F, NOT_FINITE),
    "4OFF of three coordinates": (CUBE.replace("OFF", "4OFF"), "have 3 coordinates, not 4"),
    "any dimension": ("nOFF\n5\n8 6 12\n" + V + F, "any dimension"),
    "binary": ("OFF BINARY\n\0\0\0\x08", "binary OFF"),
}


@pytest.mark.parametrize("kind", BAD)
def test_that_a_bad_off_is_refused_with_one_sentence_that_says_why(kind, refusal):
    text, expected = BAD[kind]
    assert re.search(expected, refusal("bad.off", text.encode()))


GOOD = {
    "plain": CUBE,
    "counts in the first line": CUBE.replace("OFF\n", "OFF "),
    "counts glued to the keyword": CUBE.replace("OFF\n", "OFF"),
    "each count in its line": CUBE.replace("8 6 12", "8\n6\n12"),
    "no count of edges": CUBE.replace("8 6 12", "8 6"),
    "no keyword": CUBE.replace("OFF\n", ""),
    "comments": CUBE.replace("\n", " # remark 1 2 3\n"),
    "comments before the counts": CUBE.replace("OFF\n", "OFF\n# a cube\n#\n\n"),
    "colours of faces": F and "OFF\n8 6 12\n" + V + F.replace("\n", " 255 0 0\n"),
    "colours of some faces": CUBE.replace("4 0 1 3 2", "4 0 1 3 2 0.1 0.2 0.3 0.4"),
    "colours of vertices": "COFF\n8 6 12\n" + V.replace("\n", " 255 0 0 255\n") + F,
    "normals": "NOFF\n8 6 12\n" + V.replace("\n", " 0 0 1\n") + F,
    "normals and colours": "CNOFF\n8 6 12\n" + V.replace("\n", " 0 0 1 1 1 1 1\n") + F,
    "texture coordinates": "STOFF\n8 6 12\n" + V.replace("\n", " 0.5 0.5\n") + F,
    "homogeneous coordinates": "4OFF\n8 6 12\n" + V.replace("1", "2").replace("\n", " 2\n") + F,
    "line ends of Windows": CUBE.replace("\n", "\r\n"),
    "blank lines": CUBE.replace("\n", "\n\n \t\n"),
    "white space before the keyword": "\n  \t" + CUBE,
    "a face over two lines": CUBE.replace("4 0 1 3 2", "4 0 1\n3 2"),
    "a byte order mark": "\ufeff" + CUBE,
    "points among the faces": CUBE.replace("8 6 12", "8 8 12") + "1 0\n2 0 1\n",
    "more lines than promised": CUBE + "4 0 1 3 2\n",
}


@pytest.mark.parametrize("kind", GOOD)
def test_that_a_cube_in_any_proper_off_has_volume_one_and_area_six(kind, accepted):
    mesh = accepted("cube.off", GOOD[kind].encode()).mesh
    assert mesh.volume == pytest.approx(1.0, abs=1e-12)
    assert mesh.surface_area == pytest.approx(6.0, abs=1e-12)


def test_that_facets_of_six_corners_are_read_convex_or_not(accepted):
    """A prism one high over an L of three squares: its two hexagons have a corner that turns inwards."""
    outline = [(1, 1), (1, 2), (0, 2), (0, 0), (2, 0), (2, 1)]
    vertices = "".join(f"{x} {y} {z}\n" for z in (0, 1) for x, y in outline)
    sides = "".join(f"4 {i} {(i + 1) % 6} {6 + (i + 1) % 6} {6 + i}\n" for i in range(6))
    text = f"OFF\n12 8 0\n{vertices}6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n{sides}"
    mesh = accepted("prism.off", text.encode()).mesh
    assert mesh.volume == pytest.approx(3.0, abs=1e-12)
    assert mesh.surface_area == pytest.approx(14.0, abs=1e-12)
