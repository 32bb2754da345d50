"""STL files as they are met, good and bad."""

import re
import struct

import numpy as np
import pytest

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
SOUP = CORNERS[np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])]


def binary(triangles, count=None, header=b"", order="<"):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *np.ravel(t), 0) for t in triangles)
    return (
        header.ljust(80, b"\0")[:80]
        + struct.pack(order + "I", len(body) // 50 if count is None else count)
        + body
    )


def ascii_text(triangles=SOUP, number="{:g}"):
    lines = ["solid thing"]
    for t in np.asarray(triangles):
        lines += ["facet normal 0 0 1", "outer loop"]
        lines += ["vertex " + " ".join(number.format(x) for x in corner) for corner in t]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid thing", ""])


TEXT = ascii_text()
EMPTY, SHORT, CUT = "is empty", "too short for an STL", "cut short or not an STL: it declares"
NONE, BROKEN, NUMBER = "without a single triangle", "broken ASCII STL", "where a number belongs"
SHEET, FLATNESS = (
    "holds no particle: the mesh is (an open sheet|flat|a sheet)",
    "(flat|a point or a line|sheet)",
)
NOT_FINITE = "no face whose corners are all finite"

BAD = {
    "nothing": (b"", EMPTY),
    "one byte": (b"x", SHORT),
    "79 bytes": (bytes(79), SHORT),
    "the word solid": (b"solid", NONE),
    "a count of none": (bytes(84), NONE),
    "one byte missing": (binary(SOUP)[:-1], CUT),
    "half the bytes missing": (binary(SOUP)[:384], CUT),
    "not a number everywhere": (binary(SOUP * np.nan), NOT_FINITE),
    "infinite coordinates": (binary(np.where(SOUP > 0, np.inf, -np.inf)), NOT_FINITE),
    "one triangle": (binary(SOUP[:1]), SHEET),
    "a square": (binary(SOUP[[0, 6]]), SHEET),
    "all corners in one point": (binary(SOUP * 0), FLATNESS),
    "all corners in a line": (binary(SOUP * (1, 0, 0)), FLATNESS),
    "ends inside a vertex": (TEXT[: TEXT.index("vertex", 300) + 9].encode(), BROKEN),
    "ends inside a facet": (TEXT[: TEXT.index("endloop", 400)].encode(), "ends in the middle of a facet"),
    "decimal commas": (ascii_text(SOUP + 0.5).replace(".", ",").encode(), "decimal points, not commas"),
    "a word for a number": (TEXT.replace("vertex 1 0 0", "vertex 1 zero 0", 1).encode(), NUMBER),
    "a vertex of two numbers": (TEXT.replace("vertex 1 0 0", "vertex 1 0", 1).encode(), NUMBER),
    "a vertex of four numbers": (TEXT.replace("vertex 1 0 0", "vertex 1 0 0 0", 1).encode(), BROKEN),
    "a facet of four corners": (
        TEXT.replace("endloop", "vertex 0 0 0\nendloop", 1).encode(),
        "endloop” belongs",
    ),
    "a facet of two corners": (
        TEXT.replace("vertex 0 0 0\n", "", 1).encode(),
        "has “endloop” where “vertex”",
    ),
    "no endloop": (TEXT.replace("endloop\n", "", 1).encode(), "endloop” belongs"),
    "no outer": (TEXT.replace("outer ", "", 1).encode(), "outer” belongs"),
    "no normal": (TEXT.replace(" normal 0 0 1", "", 1).encode(), "normal” belongs"),
    "a misspelt vertex": (TEXT.replace("vertex", "vertx", 1).encode(), "vertex” belongs"),
    "a solid inside a facet": (TEXT.replace("endloop", "solid b", 1).encode(), "inside a facet"),
    "words after a facet": (TEXT.replace("endfacet", "endfacet and more", 1).encode(), "facet” belongs"),
}


@pytest.mark.parametrize("kind", BAD)
def test_that_a_bad_stl_is_refused_with_one_sentence_that_says_why(kind, refusal):
    data, expected = BAD[kind]
    assert re.search(expected, refusal("bad.stl", data))


GOOD = {
    "binary": binary(SOUP),
    "binary with a header that says solid": binary(SOUP, header=b"solid cube facet normal outer loop vertex"),
    "binary with bytes after the end": binary(SOUP) + b"colour table",
    "binary with attributes": binary(SOUP).replace(b"\0\0", b"\0\0"),
    "ASCII": TEXT.encode(),
    "upper case": TEXT.upper().encode(),
    "line ends of Windows": TEXT.replace("\n", "\r\n").encode(),
    "line ends of old Macs": TEXT.replace("\n", "\r").encode(),
    "two solids": (ascii_text(SOUP[:5]) + ascii_text(SOUP[5:])).encode(),
    "no last line": TEXT.replace("endsolid thing\n", "").encode(),
    "no first line": TEXT.replace("solid thing\n", "", 1).encode(),
    "a name of keywords": TEXT.replace("solid thing", "solid facet normal vertex 1 2 3").encode(),
    "exponents": ascii_text(SOUP, "{:.6E}").encode(),
    "normals that are no numbers": TEXT.replace("normal 0 0 1", "normal nan nan nan").encode(),
    "everything in one line": (
        TEXT.split("\n", 1)[0]
        + "\n"
        + TEXT.split("\n", 1)[1].replace("\nendsolid", "#").split("#")[0].replace("\n", " ")
    ).encode(),
    "a byte order mark": b"\xef\xbb\xbf" + TEXT.encode(),
    "UTF-16": TEXT.encode("utf-16"),
    "blank lines": TEXT.replace("\n", "\n\n\t \n").encode(),
}


@pytest.mark.parametrize("kind", GOOD)
def test_that_a_cube_in_any_proper_stl_has_volume_one_and_area_six(kind, accepted):
    mesh = accepted("cube.stl", GOOD[kind]).mesh
    assert mesh.volume == pytest.approx(1.0, abs=1e-12)
    assert mesh.surface_area == pytest.approx(6.0, abs=1e-12)
    assert len(mesh.vertices) == 8


def test_that_the_winding_decides_and_not_the_stated_normal(accepted):
    reversed_normals = TEXT.replace("normal 0 0 1", "normal 0 0 -1").encode()
    assert accepted("cube.stl", reversed_normals).mesh.volume == pytest.approx(1.0)


def test_that_bytes_after_the_last_triangle_are_noted(accepted):
    assert any(
        "12 bytes after" in note for note in accepted("cube.stl", binary(SOUP) + b"colour table").notes
    )


def test_that_a_header_that_counts_otherwise_than_the_file_is_named(refusal, accepted):
    none = refusal("none.stl", binary(SOUP, 0))
    assert none.endswith("without a single triangle: its header counts 0, its length is that of 12.")
    doubled = accepted("doubled.stl", binary(np.concatenate([SOUP, SOUP + 5.0]), 12))
    assert doubled.notes[0].startswith("The header counts 12 triangles, and the file's length is that of 24")


def test_that_a_refusal_names_the_corners_that_are_no_numbers(refusal):
    broken = SOUP.copy()
    broken[2:9, 1] = np.nan
    sentence = refusal("broken.stl", binary(broken))
    assert sentence.endswith(
        "Left out 7 faces with a corner that is not a finite number, face 3 the first of 12."
    )
