"""OBJ files as they are met, good and bad."""

import re

import pytest

V = "v 0 0 0\nv 0 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nv 1 1 0\nv 1 1 1\n"
F = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
NO_V, POINTS, FACE = "no vertices", "is a point cloud", "not a valid OBJ: face"
VERTEX, SHEET, NOT_FINITE = "not a valid OBJ: vertex", "open sheet", "all finite numbers"

BAD = {
    "nothing": (b"", "is empty"),
    "white space": (b" \n\n\t\n", NO_V),
    "comments": (b"# a cube\n# nothing\n", NO_V),
    "faces alone": (F.encode(), "points to vertex 1 of 0"),
    "binary data": (b"v 0 0 0\n\0\0\0\0", "binary data"),
    "a picture": (b"\x89PNG\r\n\x1a\n\0\0\0", "binary data"),
    "points": (V.encode(), POINTS),
    "points and p": ((V + "p 1 2 3\n").encode(), POINTS),
    "an index of zero": ((V + F + "f 0 1 2\n").encode(), "points to vertex 0"),
    "an index too high": ((V + F + "f 1 2 9\n").encode(), "points to vertex 9 of 8"),
    "an enormous index": ((V + F + f"f 1 2 {10**30}\n").encode(), FACE),
    "a negative index too low": ((V + F + "f -1 -2 -9\n").encode(), "points to vertex -9"),
    "an index that is a word": ((V + F + "f a b c\n").encode(), FACE),
    "negative indices before the vertices": (
        (F.replace("f 1 2 4 3", "f -1 -2 -3") + V).encode(),
        "vertex -1",
    ),
    "a vertex of two numbers": (("v 1 2\n" + V + F).encode(), "has 2 coordinates"),
    "a vertex of none": (("v\n" + V + F).encode(), "has 0 coordinates"),
    "a vertex of words": (("v a b c\n" + V + F).encode(), "has “a”"),
    "decimal commas": (V.replace("1", "1,5").encode() + F.encode(), VERTEX),
    "a hexadecimal number": (("v 0x1 0 0\n" + V + F).encode(), VERTEX),
    "not a number everywhere": (V.replace("0", "nan").replace("1", "nan").encode() + F.encode(), NOT_FINITE),
    "infinite coordinates": (V.replace("0", "inf").replace("1", "-inf").encode() + F.encode(), NOT_FINITE),
    "one triangle": ((V + "f 1 2 3\n").encode(), SHEET),
    "a concave polygon alone": (b"v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 .5 0\nf 1 2 3 4\n", SHEET),
    "a flattened cube": (V.replace(" 1\n", " 0\n").encode() + F.encode(), "(flat|sheet)"),
    "all corners in one point": (V.replace("1", "0").encode() + F.encode(), "point or a line"),
    "faces on one vertex": ((V + "f 1 1 1\nf 2 2 2\n").encode(), "point or a line"),
    "a face and its back": ((V + "f 1 2 3\nf 3 2 1\n").encode(), "(flat|sheet)"),
    "free-form surfaces": ((V + "deg 3\ncstype bspline\nsurf 0 1 0 1 1 2 3 4\nend\n").encode(), "free-form"),
}


@pytest.mark.parametrize("kind", BAD)
def test_that_a_bad_obj_is_refused_with_one_sentence_that_says_why(kind, refusal):
    data, expected = BAD[kind]
    assert re.search(expected, refusal("bad.obj", data))


def negative(text):
    return re.sub(r"\b(\d)\b", lambda found: str(int(found[1]) - 9), text)


def seamed():
    """Every face with its own four vertices, as exporters of textures write it."""
    corners = V.strip().split("\n")
    lines = [corners[int(index) - 1] for face in F.strip().split("\n") for index in face.split()[1:]]
    return (
        "\n".join(lines)
        + "\n"
        + "".join(f"f -{4 * k} -{4 * k - 1} -{4 * k - 2} -{4 * k - 3}\n" for k in range(6, 0, -1))
    )


GOOD = {
    "polygons": V + F,
    "texture coordinates": V + "vt 0 0\n" + re.sub(r"(\d)", r"\1/1", F),
    "normals": V + "vn 0 0 1\n" + re.sub(r"(\d)", r"\1//1", F),
    "texture coordinates and normals": V + "vt 0 0\nvn 0 0 1\n" + re.sub(r"(\d)", r"\1/1/1", F),
    "negative indices": V + negative(F),
    "continued lines": V + F.replace(" 4", " \\\n4"),
    "line ends of Windows": (V + F).replace("\n", "\r\n"),
    "colours of vertices": V.replace("\n", " 0.5 0.5 0.5\n") + F,
    "weights of vertices": V.replace("\n", " 1.0\n") + F,
    "faces before vertices": F + V,
    "groups, objects and materials": "mtllib a b.mtl\no cube\n" + V + "g side\nusemtl red\ns off\n" + F,
    "comments": "# cube\n" + V.replace("\n", " # corner\n") + F,
    "points and lines beside the faces": V + F + "p 1\nl 1 2 3\n",
    "tabs": (V + F).replace(" ", "\t"),
    "no last line end": (V + F).rstrip(),
    "seams": seamed(),
}


@pytest.mark.parametrize("kind", GOOD)
def test_that_a_cube_in_any_proper_obj_has_volume_one_and_area_six(kind, accepted):
    mesh = accepted("cube.obj", GOOD[kind].encode()).mesh
    assert mesh.volume == pytest.approx(1.0, abs=1e-12)
    assert mesh.surface_area == pytest.approx(6.0, abs=1e-12)
    assert len(mesh.vertices) == 8


def test_that_joined_seams_are_told(accepted):
    assert (
        "Joined 16 vertices with another at the same place." in accepted("cube.obj", seamed().encode()).notes
    )


def test_that_lines_that_are_no_obj_are_counted(accepted):
    notes = accepted("cube.obj", (V + "hello world\n" + F + "what is this\n").encode()).notes
    assert "2 lines of the file that are not OBJ were ignored." in notes


def test_that_concave_polygons_are_cut_inside_their_outline(accepted):
    """A prism over an L: base area 3, height 1, so volume 3 and area 2 * 3 + 8."""
    base = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    lines = [f"v {x} {y} {z}" for z in (0, 1) for x, y in base]
    lines += ["f 6 5 4 3 2 1", "f 7 8 9 10 11 12"]
    lines += [f"f {k + 1} {(k + 1) % 6 + 1} {(k + 1) % 6 + 7} {k + 7}" for k in range(6)]
    mesh = accepted("prism.obj", "\n".join(lines).encode()).mesh
    assert mesh.volume == pytest.approx(3.0, abs=1e-12)
    assert mesh.surface_area == pytest.approx(14.0, abs=1e-12)
