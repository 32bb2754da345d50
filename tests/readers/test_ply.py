"""PLY files as they are met, good and bad."""

import re
import struct

import numpy as np
import pytest

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
V = "".join(f"{x} {y} {z}\n" for x, y, z in CORNERS)
F = "".join("4 " + " ".join(map(str, quad)) + "\n" for quad in QUADS)


def header(
    encoding="ascii", n_vertices=8, n_facets=6, coordinate="float", more="", corner="uchar int", more_faces=""
):
    return (
        f"ply\nformat {encoding} 1.0\ncomment made by hand\nelement vertex {n_vertices}\n"
        + "".join(f"property {coordinate} {axis}\n" for axis in "xyz")
        + more
        + f"element face {n_facets}\nproperty list {corner} vertex_indices\n{more_faces}end_header\n"
    )


def binary(order="<", coordinate="f", count="B", index="i", quads=QUADS, corners=CORNERS, **names):
    encoding = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    kinds = {
        "f": "float",
        "d": "double",
        "h": "short",
        "B": "uchar",
        "i": "int",
        "I": "uint",
        "H": "uint16",
        "b": "int8",
        "q": "int64",
    }
    head = header(encoding, coordinate=kinds[coordinate], corner=f"{kinds[count]} {kinds[index]}", **names)
    rows = [struct.pack(order + "3" + coordinate, *corner) for corner in corners]
    rows += [struct.pack(f"{order}{count}{len(quad)}{index}", len(quad), *quad) for quad in quads]
    return head.encode() + b"".join(rows)


TEXT = header() + V + F
BINARY = binary()
BODY = BINARY.index(b"end_header\n") + 11
TRIANGLES = [quad[:3] for quad in QUADS] + [(quad[0], quad[2], quad[3]) for quad in QUADS]
NOT_PLY, CUT, HEADER, POINTS = "does not begin with", "is cut short", "its header", "is a point cloud"
ROW, INDEX, SHEET, NOT_FINITE = (
    "holds something else than numbers",
    "points to vertex",
    "open sheet",
    "all finite numbers",
)


def text(old, new):
    assert old in TEXT
    return TEXT.replace(old, new, 1).encode()


BAD = {
    "nothing": (b"", "is empty"),
    "one byte": (b"p", NOT_PLY),
    "the magic alone": (b"ply\n", "no line “end_header”"),
    "the magic and more letters": (b"plywood\n", NOT_PLY),
    "noise after the magic": (b"ply\n" + np.random.default_rng(1).bytes(500), HEADER),
    "no end of the header": (TEXT.split("end_header")[0].encode(), "no line “end_header”"),
    "no format": (text("format ascii 1.0\n", ""), "names no format"),
    "an unknown format": (text("ascii", "base64"), HEADER),
    "an element without properties": (
        text("element face", "element nothing 3\nelement face"),
        "has no properties",
    ),
    "billions of vertices": (text("vertex 8", "vertex 999999999999"), CUT),
    "billions of faces": (text("face 6", "face 999999999999"), CUT),
    "no vertices": (text("vertex 8", "vertex 0"), "(points to vertex|empty mesh|else than numbers|declares)"),
    "nothing in the tables": (header(n_vertices=0, n_facets=0).encode(), "empty mesh"),
    "no element of vertices": (text("element vertex", "element corner"), "no element “vertex”"),
    "vertices without z": (text("property float z", "property float w"), "no element “vertex” with"),
    "points": (header(n_facets=0).encode() + V.encode(), POINTS),
    "points without faces in the header": (
        (header().split("element face")[0] + "end_header\n" + V).encode(),
        POINTS,
    ),
    "one word missing": (TEXT.rsplit(" ", 1)[0].encode(), "(is cut short|ends before)"),
    "half the text": (TEXT[: len(TEXT) - 40].encode(), "(is cut short|ends before)"),
    "a word for a number": (text("0 1 1\n", "0 one 1\n"), ROW),
    "decimal commas": (text("0 1 1\n", "0,5 1 1\n"), ROW),
    "a list of negative length": (text("4 0 1 3 2", "-4 0 1 3 2"), "declares"),
    "a list of a billion": (text("4 0 1 3 2", "1000000000 0 1 3 2"), "declares"),
    "an index too high": (text("4 0 1 3 2", "4 0 1 8 2"), "points to vertex 8 of 8"),
    "an index below none": (text("4 0 1 3 2", "4 0 -1 3 2"), "points to vertex -1"),
    "an index with a fraction": (text("4 0 1 3 2", "4 0 1.5 3 2"), "points to vertex 1.5"),
    "an index that is no number": (text("4 0 1 3 2", "4 0 nan 3 2"), "points to vertex nan"),
    "a binary index too high": (binary(quads=[(0, 1, 3, 99), *QUADS[1:]]), "points to vertex 99"),
    "a binary index below none": (binary(quads=[(0, 1, 3, -5), *QUADS[1:]]), "points to vertex -5"),
    "the wrong byte order": (BINARY.replace(b"little", b"big"), "(points to vertex|is cut short|list of)"),
    "a binary list of 255": (
        BINARY[:BODY] + BINARY[BODY:].replace(b"\4\0\0\0\0\1", b"\xff\0\0\0\0\1"),
        "(list of 255 values|cut short|points)",
    ),
    "a binary list of negative length": (
        binary(count="b").replace(b"\4\0\0\0\0\1", b"\xfc\0\0\0\0\1"),
        "list of -4",
    ),
    "one triangle": ((header(n_facets=1) + V + "3 0 1 2\n").encode(), SHEET),
    "two sides of a cube": ((header(n_facets=2) + V + "4 0 1 3 2\n4 0 4 5 1\n").encode(), SHEET),
    "a flattened cube": ((header() + V.replace(" 1\n", " 0\n") + F).encode(), "(flat|sheet)"),
    "all corners in one point": ((header() + "0 0 0\n" * 8 + F).encode(), "point or a line"),
    "not a number everywhere": ((header() + "nan nan nan\n" * 8 + F).encode(), NOT_FINITE),
    "infinite coordinates": (binary(corners=[(np.inf,) * 3] * 8), NOT_FINITE),
}


@pytest.mark.parametrize("kind", BAD)
def test_that_a_bad_ply_is_refused_with_one_sentence_that_says_why(kind, refusal):
    data, expected = BAD[kind]
    assert re.search(expected, refusal("bad.ply", data))


STRIP = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
STRIP += "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + V
STRIP += "29 " + " -1 ".join(f"{a} {b} {d} {c}" for a, b, c, d in QUADS) + "\n"

GOOD = {
    "ASCII": TEXT.encode(),
    "little endian": BINARY,
    "big endian": binary(">"),
    "triangles": binary(quads=TRIANGLES).replace(b"face 6", b"face 12"),
    "triangles and squares": binary(quads=[*TRIANGLES[:1], *TRIANGLES[6:7], *QUADS[1:]]).replace(
        b"face 6", b"face 7"
    ),
    "triangles and squares, big endian": binary(
        ">", quads=[*TRIANGLES[:1], *TRIANGLES[6:7], *QUADS[1:]]
    ).replace(b"face 6", b"face 7"),
    "double": binary(coordinate="d"),
    "whole numbers for coordinates": binary(coordinate="h"),
    "unsigned indices": binary(index="I"),
    "short indices": binary(index="H"),
    "byte indices": binary(index="B"),
    "long indices": binary(index="q"),
    "lists plural in 32 bits": binary(count="i"),
    "line ends of Windows": TEXT.replace("\n", "\r\n").encode(),
    "line ends of Windows in a binary header": BINARY[:BODY].replace(b"\n", b"\r\n") + BINARY[BODY:],
    "colours of vertices": (header(more="property uchar red\n") + V.replace("\n", " 255\n") + F).encode(),
    "colours of faces": (header(more_faces="property uchar red\n") + V + F.replace("\n", " 255\n")).encode(),
    "texture lists of faces": (
        header(more_faces="property list uchar float texcoord\n") + V + F.replace("\n", " 2 0.5 0.5\n")
    ).encode(),
    "other elements": text("element face", "element material 0\nproperty float shine\nelement face"),
    "another spelling": text("vertex_indices", "vertex_index"),
    "rows over several lines": (header() + V.replace(" ", "\n") + F).encode(),
    "rows with more than the header says": (header() + V.replace("\n", " 0.5 0.5\n") + F).encode(),
    "strips": STRIP.encode(),
    "bytes after the end": BINARY + b"and more",
}


@pytest.mark.parametrize("kind", GOOD)
def test_that_a_cube_in_any_proper_ply_has_volume_one_and_area_six(kind, accepted):
    mesh = accepted("cube.ply", GOOD[kind]).mesh
    assert mesh.volume == pytest.approx(1.0, abs=1e-12)
    assert mesh.surface_area == pytest.approx(6.0, abs=1e-12)
    assert len(mesh.vertices) == 8


def test_that_faces_with_a_corner_that_is_no_number_are_left_out_and_the_hole_is_filled(accepted):
    """A ninth vertex that is no number carries a pyramid on top of one side."""
    lid = "3 1 5 8\n3 5 7 8\n3 7 3 8\n3 3 1 8\n"
    broken = header(n_vertices=9, n_facets=9) + V + "nan nan nan\n" + "".join(F.splitlines(True)[:-1]) + lid
    particle = accepted("cube.ply", broken.encode())
    assert particle.mesh.volume == pytest.approx(1.0, abs=1e-12)
    assert any(
        note.startswith("Left out 4 faces with a corner that is not a finite number, face ")
        for note in particle.notes
    )
    assert any(note.startswith("Filled 1 hole with 17 %") for note in particle.notes)
