"""Meshes that are broken in ways we made: each is refused with the sentence of its kind."""

import base64
import io
import json
import re
import struct
import zipfile
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.readers.particles import read_mesh

Bad = tuple[str, bytes | str, str]
WORDS = ("one", "1,5", "0x1F", "--1", "1e", "1.2.3", "$", "None")
ENDS = (0, 1, 3, 8, 15, 25, 40, 55, 70, 85, 95)
"""Per cent of a file that are left of it."""


def cut(name: str, data: bytes, pattern: str) -> Iterator[Bad]:
    """A file that ends too early."""
    stem, _, suffix = name.partition(".")
    for share in ENDS:
        yield f"{stem}-cut-at-{share}.{suffix}", data[: len(data) * share // 100], f"is empty|{pattern}"


def strangers(suffix: str, pattern: str) -> Iterator[Bad]:
    """Files of quite another kind under a wrong name."""
    others = {
        "diary": b"dear diary,\n" * 40,
        "page": b"<!DOCTYPE html><html><body>404 not found</body></html>",
        "zeros": bytes(600),
        "noise": np.random.default_rng(3).integers(128, 256, 600, dtype=np.uint8).tobytes(),
        "blank": b"\n \n\t\n" * 100,
        "picture": b"\x89PNG\r\n\x1a\n" + bytes(300),
    }
    for name, data in others.items():
        yield f"{name}{suffix}", data, pattern


def stls(cube: Any) -> Iterator[Bad]:
    binary, text = cube.binary_stl(), cube.ascii_stl().decode()
    yield from cut("binary.stl", binary, "is too short for an STL|is cut short or not an STL")
    yield from cut(
        "ascii.stl", text.encode(), "is too short for an STL|is a broken ASCII STL|without a single"
    )
    yield from strangers(".stl", "is cut short or not an STL|is an STL without|is too short for an STL")
    for count in (13, 100, 2**31, 2**32 - 1):
        yield (
            f"count-{count}.stl",
            binary[:80] + struct.pack("<I", count) + binary[84:],
            "it declares .* triangles",
        )
    yield "none.stl", bytes(84), "is an STL without a single triangle"
    yield "solid.stl", "solid a\nendsolid a\n", "without a single triangle|is too short for an STL"
    for number, word in enumerate(WORDS):
        broken = text.replace("vertex 0", f"vertex {word}", 1)
        yield f"word-{number}.stl", broken, "is a broken ASCII STL: line 4 has “"
    for name in ("outer loop", "endloop", "endfacet", "facet normal"):
        yield f"without-{name[:5]}{len(name)}.stl", text.replace(name, "", 1), "is a broken ASCII STL"
    for name, other in (("vertex", "vertx"), ("endfacet", "endface"), ("outer", "inner"), ("normal", "norm")):
        yield f"typo-{name}.stl", text.replace(name, other, 1), "is a broken ASCII STL: line .* has “"
    for number, value in enumerate((np.nan, np.inf, -np.inf)):
        corners = struct.pack("<12fH", *[value] * 12, 0) * 12
        yield f"infinite-{number}.stl", binary[:84] + corners, "no face whose corners are all finite"
    flat = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    for count in (1, 2, 5):
        yield f"sheet-{count}.stl", bytes(80) + struct.pack("<I", count) + flat * count, "holds no particle"
    point = struct.pack("<12fH", *[1.0] * 12, 0)
    yield "point.stl", bytes(80) + struct.pack("<I", 4) + point * 4, "holds no particle"


def plys(cube: Any) -> Iterator[Bad]:
    text, little = cube.ascii_ply().decode(), cube.binary_ply("<")
    body = little.index(b"end_header\n") + 11
    yield from cut(
        "ascii.ply", text.encode(), "is not a PLY|is not a valid PLY|is cut short|is a point cloud"
    )
    yield from cut("little.ply", little, "is not a PLY|is not a valid PLY|is cut short|is a point cloud")
    yield from strangers(".ply", "is not a PLY: it does not begin with the word “ply”")
    for number, line in enumerate(("format ascii 2.0", "format text 1.0", "format", "")):
        yield (
            f"format-{number}.ply",
            text.replace("format ascii 1.0", line),
            "its header (has|names no format)",
        )
    for count in ("-8", "8.0", "eight", "", "9" * 20):
        yield (
            f"count-{count[:3]}.ply",
            text.replace("vertex 8", f"vertex {count}"),
            "its header has “element vertex",
        )
    for count in (9, 1000, 10**12):
        pattern = "is cut short|is not a valid PLY|points to vertex|declares"
        yield f"many-{count}.ply", little.replace(b"vertex 8", b"vertex %d" % count), pattern
    for number, line in enumerate(
        ("property half x", "property float", "property x float", "property list float int x")
    ):
        yield f"property-{number}.ply", text.replace("property float x", line), "its header has the property"
    yield "early.ply", text.replace("element vertex 8\n", ""), "its header has “property float x"
    yield "endless.ply", text.replace("end_header", "end header"), "no line “end_header”|its header has"
    for axis in "xyz":
        yield (
            f"without-{axis}.ply",
            text.replace(f"float {axis}", "float w"),
            "no element “vertex” with the properties",
        )
    for number, index in enumerate(("8", "-1", "99", "0.5", "nan")):
        yield (
            f"index-{number}.ply",
            text.replace("4 0 1 3 2", f"4 0 1 3 {index}"),
            "a face points to vertex|numbers",
        )
    for number, word in enumerate(WORDS[:5]):
        pattern = "holds something else than numbers"
        yield f"word-{number}.ply", text.replace("end_header\n0", f"end_header\n{word}"), pattern
    yield "cloud.ply", text.split("element face")[0] + "end_header\n" + "0 0 0\n" * 8, "is a point cloud"
    yield "no-faces.ply", text.replace("face 6", "face 0"), "is a point cloud"
    yield (
        "no-vertices.ply",
        text.replace("vertex 8", "vertex 0"),
        "points to vertex|holds an empty mesh|is not a proper",
    )
    yield (
        "infinite.ply",
        little[:body] + struct.pack("<24f", *[np.nan] * 24) + little[body + 96 :],
        "all finite numbers",
    )


def objs(cube: Any) -> Iterator[Bad]:
    text = cube.obj().decode()
    first = "v 0 0 0"
    yield from cut(
        "cube.obj", text[: text.index("f ")].encode() + b"f 1 2 99\n", "OBJ|is a point cloud|of .* vertices"
    )
    yield from strangers(".obj", "is not an OBJ")
    for number, word in enumerate(WORDS):
        yield (
            f"word-{number}.obj",
            text.replace(first, f"v {word} 0 0"),
            "vertex 1 has “.*” where a number belongs",
        )
    for number, line in enumerate(("v", "v 1", "v 1 2")):
        yield f"short-{number}.obj", text.replace(first, line), "vertex 1 has . coordinates, not three"
    for number, index in enumerate(("0", "9", "-9", "99999999999999999999", "-1000000")):
        yield f"index-{number}.obj", text.replace("f 1 ", f"f {index} "), "face 1 points to vertex"
    for number, index in enumerate(("a", "1.5", "/2/3", "1;2", "#", "½")):
        yield f"face-{number}.obj", text.replace("f 1 ", f"f {index} "), "face 1 is “"
    yield "cloud.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", "is a point cloud"
    yield "no-faces.obj", text.replace("f ", "l "), "is a point cloud"
    yield "no-vertices.obj", "f 1 2 3\n", "points to vertex 1 of 0"
    yield "nothing.obj", "# only a comment\n", "is not an OBJ: it has no line that begins with “v”"
    yield "curves.obj", "v 0 0 0\ncstype bezier\ndeg 3\ncurv 0 1 1 1\n", "free-form curves or surfaces only"
    for number, word in enumerate(("nan", "inf", "-inf", "1e300")):
        lines = [re.sub(r"^v .*", f"v {word} 0 0", line) for line in text.splitlines()]
        yield f"infinite-{number}.obj", "\n".join(lines), "no face whose corners are all finite"
    yield "sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "holds no particle"
    yield "flat.obj", re.sub(r"(?m)^v (\S+) (\S+) \S+", r"v \1 \2 0", text), "holds no particle"


def offs(cube: Any) -> Iterator[Bad]:
    text = cube.off().decode()
    yield from cut(
        "cube.off", text.encode()[:-6], "is not an? |is not a valid OFF|is cut short|is a point cloud"
    )
    yield from strangers(".off", "is not an OFF|is cut short|is not a valid OFF")
    for number, line in enumerate(("8", "", "eight six", "-8 6 0", "8 -6 0", "8.0 6 0", "9999999999999 6 0")):
        pattern = "is not an OFF|is cut short|is not a valid OFF|is a point cloud|an empty mesh"
        yield f"counts-{number}.off", text.replace("8 6 0", line), pattern
    for count in (100, 1000, 10**9):
        yield (
            f"vertices-{count}.off",
            text.replace("8 6 0", f"{count} 6 0"),
            "is cut short: it declares .* vertices",
        )
    for count in (7, 100, 10**9):
        yield (
            f"faces-{count}.off",
            text.replace("8 6 0", f"8 {count} 0"),
            "is cut short: it declares .* faces",
        )
    for number, word in enumerate(WORDS):
        yield (
            f"word-{number}.off",
            text.replace("0 0 0\n", f"{word} 0 0\n", 1),
            "vertex 0 has “.*” where a number",
        )
    for number, row in enumerate(("1", "1 2")):
        yield (
            f"short-{number}.off",
            text.replace("0 0 0\n", f"{row}\n", 1),
            "vertex 0 has . coordinates|not a valid OFF",
        )
    for number, index in enumerate(("8", "-1", "99")):
        yield f"index-{number}.off", text.replace("4 0 1 3 2", f"4 0 1 3 {index}"), "face 0 points to vertex"
    for number, index in enumerate(("a", "1.5", "nan")):
        yield (
            f"face-{number}.off",
            text.replace("4 0 1 3 2", f"4 0 1 3 {index}"),
            "face 0 is not made of whole numbers",
        )
    for number, size in enumerate(("0", "-4", "400")):
        yield (
            f"size-{number}.off",
            text.replace("4 0 1 3 2", f"{size} 0 1 3 2"),
            "face 0 declares|whole numbers",
        )
    for kind in ("nOFF", "4nOFF", "CnOFF"):
        yield f"kind-{kind}.off", text.replace("OFF", kind), rf"file of any dimension \({kind}\)"
    yield "binary.off", "OFF BINARY\n" + text, "is a binary OFF"
    yield "cloud.off", text.replace("8 6 0", "8 0 0"), "is a point cloud"
    yield "none.off", "OFF\n0 0 0\n", "holds an empty mesh"


GLTF: dict[str, Any] = {
    "asset": {"version": "2.0"},
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [
        {
            "byteLength": 36,
            "uri": "data:;base64," + base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode(),
        }
    ],
}


def changed(path: str, value: Any) -> str:
    """The glTF with one value changed, or left out for None."""
    document = json.loads(json.dumps(GLTF))
    place: Any = document
    *steps, last = [int(step) if step.isdigit() else step for step in path.split("/")]
    for step in steps:
        place = place[step]
    if value is None:
        del place[last]
    else:
        place[last] = value
    return json.dumps(document)


def glb(document: str, version: int = 2, length: int | None = None, kind: bytes = b"JSON") -> bytes:
    data = document.encode() + b" " * (-len(document) % 4)
    size = 20 + len(data) if length is None else length
    return b"glTF" + struct.pack("<III", version, size, len(data)) + kind + data


def gltfs(_cube: Any) -> Iterator[Bad]:
    whole = glb(json.dumps(GLTF))
    yield from cut("a.glb", whole, "is cut short|is not a|is no ")
    yield from strangers(
        ".gltf", "its JSON breaks in line (1|301), sign 1|its JSON is not text|is not a glTF"
    )
    for field in ("asset", "nodes", "meshes", "accessors", "bufferViews", "buffers"):
        yield (
            f"without-{field}.gltf",
            changed(field, None),
            "is not a glTF|is not a valid glTF|without triangles",
        )
        for number, value in enumerate((0, "text", [], [5])):
            pattern = (
                "is not a|without triangles|is cut short|holds no particle"
                if field != "asset"
                else "is not a|holds no"
            )
            yield f"{field}-{number}.gltf", changed(field, value), pattern
    for number, value in enumerate((7, -1, "0", 1.5, {})):
        yield f"buffer-{number}.gltf", changed("bufferViews/0/buffer", value), "is not a valid glTF"
        yield f"view-{number}.gltf", changed("accessors/0/bufferView", value), "is not a valid glTF"
    for number, kind in enumerate(("VEC2", "MAT4", "", "vec3")):
        yield f"type-{number}.gltf", changed("accessors/0/type", kind), "accessor 0 is of type"
    for number, kind in enumerate((0, 5124, 9999)):
        yield (
            f"component-{number}.gltf",
            changed("accessors/0/componentType", kind),
            "accessor 0 is of type|is not a proper",
        )
    for number, count in enumerate((4, 1000, 10**12)):
        yield f"count-{number}.gltf", changed("accessors/0/count", count), "is cut short: accessor 0 needs"
    for number, uri in enumerate(("/etc/passwd", "../a.bin", "http://a/b.bin", "sub/a.bin")):
        yield f"uri-{number}.gltf", changed("buffers/0/uri", uri), "only files in its own folder are read"
    yield "absent.gltf", changed("buffers/0/uri", "absent.bin"), "needs the file absent.bin"
    yield "base64.gltf", changed("buffers/0/uri", "data:;base64,!!!"), "is not base64|is cut short"
    circle = changed("nodes", [{"mesh": 0, "children": [0]}])
    yield "circle.gltf", circle, "its nodes form a cycle"
    for name in ("KHR_draco_mesh_compression", "EXT_meshopt_compression"):
        yield f"{name}.gltf", changed("extensionsRequired", [name]), f"is compressed with {name}"
    for version in (0, 1, 3):
        yield f"version-{version}.glb", glb(json.dumps(GLTF), version), f"is a GLB of version {version}"
    yield "chunk.glb", glb(json.dumps(GLTF), kind=b"BLOB"), "it has no JSON chunk"
    yield "sheet.gltf", json.dumps(GLTF), "holds no particle"


MODEL = (
    '<model unit="micron"><resources><object id="1"><mesh><vertices>'
    '<vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>'
    '<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/>'
    '</vertices><triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>'
    '<triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3"/></triangles></mesh>'
    '</object></resources><build><item objectid="1"/></build></model>'
)


def archive(model: str | bytes, name: str = "3D/3dmodel.model", **options: Any) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", **options) as made:
        made.writestr(name, model)
    return file.getvalue()


def three_mfs(_cube: Any) -> Iterator[Bad]:
    whole = archive(MODEL, compression=zipfile.ZIP_DEFLATED)
    yield from cut("a.3mf", whole, "is not a valid 3MF")
    yield from strangers(".3mf", "is not a valid 3MF: its archive is damaged|is no ")
    for share in (1, 10, 30, 60, 90, 99):
        yield (
            f"xml-{share}.3mf",
            archive(MODEL[: len(MODEL) * share // 100]),
            "the XML of its model is broken",
        )
    yield "nothing.3mf", archive("text", "readme.txt"), "its archive holds no model"
    yield "lzma.3mf", archive(MODEL, compression=zipfile.ZIP_LZMA), "compressed in another way than deflate"
    laughs = '<!DOCTYPE a [<!ENTITY b "ha">]>' + MODEL
    yield "laughs.3mf", archive(laughs), "its XML defines entities"
    for number, word in enumerate(WORDS):
        yield (
            f"word-{number}.3mf",
            archive(MODEL.replace('x="1"', f'x="{word}"')),
            "its model has “.*” where a number",
        )
        yield (
            f"index-{number}.3mf",
            archive(MODEL.replace('v1="1"', f'v1="{word}"')),
            "its model has “.*” where a number belongs",
        )
    for number, index in enumerate(("4", "-1", "99", "9" * 30)):
        yield (
            f"beyond-{number}.3mf",
            archive(MODEL.replace('v1="1"', f'v1="{index}"')),
            "beyond the 4 vertices|a number or a matrix",
        )
    for name in (' x="1"', ' v1="1"'):
        yield (
            f"without-{name[1:3]}.3mf",
            archive(MODEL.replace(name, "")),
            "its model lacks the attribute “",
        )
    for number, key in enumerate(("2", "", "one")):
        yield (
            f"item-{number}.3mf",
            archive(MODEL.replace('objectid="1"', f'objectid="{key}"')),
            "which is not there",
        )
    yield "no-build.3mf", archive(MODEL.replace('<item objectid="1"/>', "")), "builds no triangles"
    yield (
        "no-resources.3mf",
        archive("<model><build><item objectid='1'/></build></model>"),
        "which is not there",
    )
    circle = MODEL.replace("<mesh>", '<components><component objectid="1"/></components><mesh>')
    yield "circle.3mf", archive(circle), "form a cycle"
    for number, matrix in enumerate(("1 2 3", "a b c", "1 " * 13)):
        yield (
            f"matrix-{number}.3mf",
            archive(MODEL.replace('"1"/></build', f'"1" transform="{matrix}"/></build')),
            "is not what it should be|has “a” where a number belongs",
        )
    flat = MODEL.replace('z="1"', 'z="0"')
    yield "flat.3mf", archive(flat), "holds no particle"


CORPORA = {"stl": stls, "ply": plys, "obj": objs, "off": offs, "gltf": gltfs, "3mf": three_mfs}


@pytest.mark.parametrize("key", CORPORA)
def test_that_each_broken_mesh_is_refused_with_the_sentence_of_its_kind(key, cube, tmp_path) -> None:
    corpus = list(CORPORA[key](cube))
    assert len({name for name, _, _ in corpus}) == len(corpus) >= 40
    for name, data, pattern in corpus:
        (tmp_path / name).write_bytes(data if isinstance(data, bytes) else data.encode())
        try:
            found = read_mesh(tmp_path / name)
        except (FileError, GeometryError) as error:
            sentence = str(error)
        else:
            sentence = f"was read as {found}"
        assert re.search(pattern, sentence), (name, sentence)
        assert re.fullmatch(re.escape(name) + r" [^\n]{1,240}\.", sentence), (name, sentence)


def test_that_the_good_archive_behind_the_broken_ones_is_read(tmp_path) -> None:
    (tmp_path / "a.3mf").write_bytes(archive(MODEL))
    assert read_mesh(tmp_path / "a.3mf").mesh.volume == pytest.approx(1 / 6)
