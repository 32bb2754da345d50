"""Positions and tables that are broken in ways we made: each is refused with the sentence of its kind."""

import base64
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.coefficient_tables import read_coefficients
from regolith_studio.readers.positions import read_positions
from regolith_studio.readers.sandbox.tasks import parse_positions
from tests.readers.mutations import mutated

Bad = tuple[str, bytes | str, str]
WORDS = ("one", "1,5x", "0x1F", "--1", "1e", "1.2.3", "∞", "\x1b[31m", "None", "1 e5", "$1", "#")
NOISE = np.random.default_rng(3).integers(128, 256, 600, dtype=np.uint8).tobytes()


def strangers(suffix: str, pattern: str) -> Iterator[Bad]:
    """Files of quite another kind under a wrong name."""
    others = {
        "diary": b"dear diary,\n" * 40,
        "page": b"<!DOCTYPE html><html><body>404 not found</body></html>",
        "zip": b"PK\3\4" + bytes(400),
        "zeros": bytes(600),
        "noise": NOISE,
        "blank": b"\n \n\t\n" * 100,
    }
    for name, data in others.items():
        yield f"{name}{suffix}", data, pattern
    yield f"empty{suffix}", b"", "is empty: it has no bytes at all"


NO_TABLE = "is not a table of numbers|is not a text of numbers|holds no row of numbers|has “"


def tables() -> Iterator[Bad]:
    yield from strangers(".csv", NO_TABLE)
    rows = "0,0,0,1\n1,1,1,1\n"
    for number, word in enumerate(WORDS[:-1]):
        yield (
            f"word-{number}.csv",
            f"x,y,z,d\n{rows}{word},2,2,2\n",
            "has “.*” where a number belongs|columns in line",
        )
    for number, row in enumerate(("1,2,3", "1,2,3,4,5", "1", "1,2,3,4;5", "1 2 3")):
        yield (
            f"ragged-{number}.csv",
            f"x,y,z,d\n{rows}{row}\n",
            "columns in line 4 and 4 in the first row|has “",
        )
    for number, row in enumerate(("1", "1,2", "1,2,3,4,5", "1,2,3,4,5,6,7")):
        yield (
            f"width-{number}.csv",
            f"{row}\n{row}\n",
            "positions need three|columns without names|cut short: it declares 1",
        )
    for number, names in enumerate(("a,b,c", "x,y,w", "lat,lon,height", "xx,yy,zz")):
        yield f"names-{number}.csv", f"{names}\n1,2,3\n", "has no columns x, y and z; they are called"
    for number, point in enumerate(("nan,0,0", "0,inf,0", "0,0,-inf", "1e300,0,0", "0,1e31,0")):
        yield f"infinite-{number}.csv", f"x,y,z\n{point}\n", "no particle whose position and size are valid"
    for number, size in enumerate(("0", "-1", "nan", "inf", "1e40")):
        yield (
            f"size-{number}.csv",
            f"x,y,z,d\n1,2,3,{size}\n",
            "no particle whose position and size are valid",
        )
    for number, text in enumerate(("x,y,z\n", "# a\n# b\n", "x,y,z\nx,y,z\n", "title\nunits\n1,2,3\n")):
        yield f"header-{number}.csv", text, "holds no row of numbers|is not a table of numbers: line 2"


def xyzs() -> Iterator[Bad]:
    yield from strangers(".xyz", NO_TABLE + "|columns")
    for count in (3, 5, 1000, 999999999999):
        yield (
            f"count-{count}.xyz",
            f"{count}\ncomment\nA 0 0 0\nA 1 1 1\n",
            "is cut short: it declares|is a broken XYZ",
        )
    yield "zero.xyz", "0\ncomment\n", "is cut short: it declares 0"
    for number, word in enumerate(WORDS[:9]):
        yield (
            f"word-{number}.xyz",
            f"2\nc\nA 0 0 0\nA 1 {word.replace(' ', '')} 1\n",
            "is a broken XYZ file: not all its rows",
        )
    for number, row in enumerate(("A", "A 1", "A 1 2")):
        yield f"short-{number}.xyz", f"2\nc\nA 0 0 0\n{row}\n", "is a broken XYZ file: not all its rows"
    for number, second in enumerate(("two", "-2", "2.5", "A 1 1 1")):
        yield f"frame-{number}.xyz", f"1\nc\nA 0 0 0\n{second}\nc\nA 1 1 1\n", "line 4 should count particles"
    for number, names in enumerate(
        ("species:S:1", "species:S:1:vel:R:3", "pos:R:2", "pos", "pos:R:x", "::::", "radius:R:1")
    ):
        yield f"properties-{number}.xyz", f"1\nProperties={names}\nA 0 0 0\n", "its properties name no pos"
    for number, names in enumerate(("id:I:9:pos:R:3", "pos:R:3:radius:R:1")):
        yield f"columns-{number}.xyz", f"1\nProperties={names}\n0 0 0\n", "not all its rows are"
    for number, row in enumerate(("nan 0 0", "0 inf 0", "1e40 0 0")):
        yield f"infinite-{number}.xyz", f"1\nc\nA {row}\n", "no particle whose position and size"
    for number, row in enumerate(("1 2", "1 2 3 4 5", "1 2 3 4 5 6")):
        yield f"table-{number}.xyz", f"{row}\n{row}\n", "columns; positions need three|columns without names"


DUMP = (
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
    "ITEM: ATOMS id x y z\n1 0 0 0\n2 1 1 1\n"
)


def dumps() -> Iterator[Bad]:
    yield from strangers(".dump", "is not a LAMMPS dump")
    for share in range(5, 95, 10):
        yield (
            f"cut-{share}.dump",
            DUMP[: len(DUMP) * share // 100],
            "is cut short|is a broken LAMMPS dump|is not a LAMMPS dump",
        )
    for count in ("3", "1", "0", "1000000"):
        yield (
            f"count-{count}.dump",
            DUMP.replace("ATOMS\n2", f"ATOMS\n{count}"),
            "is cut short: its last step declares",
        )
    for number, count in enumerate(("x", "-2", "2.5", "", "2\n2")):
        yield (
            f"number-{number}.dump",
            DUMP.replace("ATOMS\n2", f"ATOMS\n{count}"),
            "does not state its number of particles",
        )
    for number, names in enumerate(("id vx vy vz", "id x y q", "a b c d")):
        yield f"names-{number}.dump", DUMP.replace("id x y z", names), "has no columns x, y and z"
    for number, names in enumerate(("id x y z r", "x y z", "", "x y")):
        yield f"width-{number}.dump", DUMP.replace("id x y z", names), "particle 1 has 4 columns"
    for number, row in enumerate(("2 1 1", "2 1 1 1 1", "2")):
        yield f"row-{number}.dump", DUMP.replace("2 1 1 1", row), "particle 2 has"
    for number, word in enumerate(("nan", "inf", "word", "1e50")):
        text = DUMP.replace("1 0 0 0", f"1 {word} 0 0").replace("2 1 1 1", f"2 0 {word} 1")
        yield f"infinite-{number}.dump", text, "no particle whose position and size"
    scaled = DUMP.replace("id x y z", "id xs ys zs")
    yield (
        "tilted.dump",
        scaled.replace("BOUNDS pp", "BOUNDS xy xz yz pp"),
        "a box that is tilted or not stated",
    )
    yield (
        "no-box.dump",
        scaled.replace("ITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n", ""),
        "tilted or not stated",
    )
    yield "flat-box.dump", scaled.replace("0 1\n0 1\n0 1", "0 1\n0 1"), "tilted or not stated"


VTK = (
    "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 1 1\n"
    "POINT_DATA 2\nSCALARS radius float\nLOOKUP_TABLE default\n1 1\n"
)
BINARY = VTK.split("0 0 0")[0].replace("ASCII", "BINARY").encode()


def vtks() -> Iterator[Bad]:
    yield from strangers(".vtk", "is not a legacy VTK file")
    for share in (10, 15, 20, 30, 40, 50):
        yield (
            f"cut-{share}.vtk",
            VTK[: len(VTK) * share // 100],
            "is not a legacy|is a broken VTK|holds no points|is cut short",
        )
    for number, kind in enumerate(("", "ascii?", "XML", "3")):
        yield f"form-{number}.vtk", VTK.replace("ASCII", kind), "neither ASCII nor BINARY"
    for number, kind in enumerate(("STRUCTURED_POINTS", "FIELD")):
        yield f"kind-{number}.vtk", VTK.replace("POLYDATA\nPOINTS 2 float", kind), "holds no points"
    for count in (3, 100, 999999999999):
        yield (
            f"count-{count}.vtk",
            VTK.split("POINT_DATA")[0].replace("POINTS 2", f"POINTS {count}"),
            "is cut short: it declares",
        )
    for number, count in enumerate(("-2", "two", "2.0", "")):
        yield f"number-{number}.vtk", VTK.replace("POINTS 2", f"POINTS {count}"), "holds no points"
    for number, kind in enumerate(("bit", "string", "half", "Float32")):
        yield f"type-{number}.vtk", VTK.replace("POINTS 2 float", f"POINTS 2 {kind}"), "there is no type"
    for number, word in enumerate(("one", "--1", "0x1F", "1,5")):
        yield (
            f"word-{number}.vtk",
            VTK.replace("0 0 0 1", f"0 0 0 {word}"),
            "a word stands where a number belongs",
        )
    for number, word in enumerate(("nan", "inf", "1e35")):
        yield (
            f"infinite-{number}.vtk",
            VTK.replace("0 0 0 1 1 1", f"0 0 {word} 1 1 {word}"),
            "no particle whose position",
        )
    for size in (0, 1, 12, 23):
        yield f"binary-{size}.vtk", BINARY + bytes(size), "is cut short: it declares 6"
    yield "binary-nan.vtk", BINARY + struct.pack(">6f", *[np.nan] * 6), "no particle whose position"
    for number, size in enumerate(("0 0", "-1 -1", "nan nan")):
        yield (
            f"size-{number}.vtk",
            VTK.replace("default\n1 1", f"default\n{size}"),
            "no particle whose position and size",
        )


def vtp(array: str, head: str = "", tail: str = "", count: int | str = 2, kind: str = "PolyData") -> str:
    return (
        f'<?xml version="1.0"?><VTKFile type="{kind}" byte_order="LittleEndian" {head}><{kind}>'
        f'<Piece NumberOfPoints="{count}"><Points>{array}</Points></Piece></{kind}>{tail}</VTKFile>'
    )


def array(content: str, form: str = "ascii", kind: str = "Float32", more: str = "") -> str:
    return f'<DataArray type="{kind}" NumberOfComponents="3" format="{form}" {more}>{content}</DataArray>'


def encoded(*parts: bytes) -> str:
    return "".join(base64.b64encode(part).decode() for part in parts)


POINTS = struct.pack("<6f", 0, 0, 0, 1, 1, 1)
PACKED = zlib.compress(POINTS)
ZLIB = 'compressor="vtkZLibDataCompressor"'
SHORT = "is cut short"


def vtps() -> Iterator[Bad]:
    yield from strangers(".vtp", "its XML is malformed|defines entities")
    good = vtp(array("0 0 0 1 1 1"))
    for share in (10, 30, 50, 70, 90, 98):
        yield f"cut-{share}.vtp", good[: len(good) * share // 100], "its XML is malformed"
    for kind in ("ImageData", "RectilinearGrid", "Table"):
        yield f"kind-{kind}.vtp", vtp(array("0 0 0"), kind=kind), "neither poly data nor an unstructured grid"
    for number, kind in enumerate(("", "Float16", "String", "float")):
        yield f"type-{number}.vtp", vtp(array("0 0 0 1 1 1", kind=kind)), "an array has no type that is known"
    for number, content in enumerate(("0 0 0 1 1", "0", "0 0 0 1 1 1 2")):
        yield f"odd-{number}.vtp", vtp(array(content)), "its points are not three numbers each"
    for count in (0, 1, 3, 10**12):
        yield f"count-{count}.vtp", vtp(array("0 0 0 1 1 1"), count=count), f"{SHORT}: it declares"
    yield "none.vtp", vtp(array(""), count=0), "holds no points"
    for number, word in enumerate(("one", "--1", "0x1F", "1,5")):
        yield f"word-{number}.vtp", vtp(array(f"0 0 0 1 1 {word}")), "a word stands where a number belongs"
    for number, content in enumerate(
        ("", "AAA", "!!!!", encoded(struct.pack("<I", 24)), encoded(struct.pack("<I", 24) + POINTS[:9]))
    ):
        yield f"binary-{number}.vtp", vtp(array(content, "binary")), f"{SHORT}|its base64 cannot be decoded"
    for number, content in enumerate(
        ("", encoded(struct.pack("<I", 1)), encoded(struct.pack("<4I", 1, 24, 24, len(PACKED)), PACKED[:5]))
    ):
        yield f"packed-{number}.vtp", vtp(array(content, "binary"), ZLIB), SHORT
    noise = encoded(struct.pack("<4I", 1, 24, 24, 20), b"\xff" * 20)
    yield "garbled.vtp", vtp(array(noise, "binary"), ZLIB), "its compressed points cannot be unpacked"
    yield (
        "blocks.vtp",
        vtp(array(encoded(struct.pack("<3I", 2**31, 24, 24)), "binary"), ZLIB),
        "more blocks than can be",
    )
    yield (
        "lz4.vtp",
        vtp(array("", "binary"), 'compressor="vtkLZ4DataCompressor"'),
        "by a compressor that is not read",
    )
    for number, offset in enumerate(("999", "-1", "x", "")):
        tail = '<AppendedData encoding="raw">_' + "abc</AppendedData>"
        yield (
            f"appended-{number}.vtp",
            vtp(array("", "appended", more=f'offset="{offset}"'), tail=tail),
            SHORT,
        )
    laughs = '<!DOCTYPE a [<!ENTITY b "ha"><!ENTITY c "&b;&b;">]>' + vtp(array("&c;"))[21:]
    yield "laughs.vtp", laughs, "defines entities of its own"
    for number, word in enumerate(("nan", "inf", "1e35")):
        yield f"infinite-{number}.vtp", vtp(array(f"{word} 0 0 0 0 {word}")), "no particle whose position"


COMPLEX = "0 0 10 0\n1 -1 1 0.5\n1 0 0.1 0\n1 1 -1 0.5\n"


def coefficients() -> Iterator[Bad]:
    yield from strangers(".anm", NO_TABLE + "|has \\d columns|is empty|holds no row")
    for number, word in enumerate(WORDS):
        yield (
            f"word-{number}.anm",
            COMPLEX + f"2 0 {word} 0\n",
            "has “.*” where a number belongs|columns in line",
        )
    for number, word in enumerate(("nan", "inf", "-inf", "1e999")):
        yield (
            f"infinite-{number}.anm",
            COMPLEX + f"2 0 {word} 0\n",
            "1 of 5 rows hold a number that is not finite",
        )
    for number, row in enumerate(
        ("2 3 0 0", "2 -3 0 0", "1.5 0 0 0", "2 0.5 0 0", "-1 0 0 0", "201 0 0 0", "1e9 0 0 0")
    ):
        yield f"order-{number}.anm", COMPLEX + row + "\n", "begins with .*expected a degree l"
    for number, row in enumerate(("0 0 10 0", "1 0 0.1 0", "1 1 -1 0.5")):
        yield f"twice-{number}.anm", COMPLEX + row + "\n", "comes more than once"
    for number, row in enumerate(("1 -1 -1 0.5", "1 -1 1 -0.5", "1 -1 9 9")):
        yield f"contradict-{number}.anm", COMPLEX.replace("1 -1 1 0.5", row), "contradict each other"
    for number, first in enumerate(("0 0 0 0", "0 0 -10 0", "1 -1 1 0.5")):
        yield (
            f"mean-{number}.anm",
            COMPLEX.replace("0 0 10 0", first if number < 2 else ""),
            "no positive mean radius",
        )
    for number, text in enumerate(("0 0 10\n1 0 1\n", "0 0\n", "0\n1\n")):
        yield f"width-{number}.anm", text, "columns?; a table of coefficients has four"
    for number, text in enumerate(("0 0 10 0\n1 0 1 0\n", "0 0 10 0\n", "0 0 10 0\n1 0 1 0\n1 1 1 1\n")):
        yield f"convention-{number}.anm", text, "does not show its convention"


CORPORA: dict[str, Callable[[], Iterator[Bad]]] = {
    "tables": tables, "xyz": xyzs, "lammps": dumps, "vtk": vtks, "vtp": vtps, "coefficients": coefficients,
}  # fmt: skip


@pytest.mark.parametrize("key", CORPORA)
def test_that_each_broken_file_is_refused_with_the_sentence_of_its_kind(key, tmp_path) -> None:
    corpus = list(CORPORA[key]())
    assert len({name for name, _, _ in corpus}) == len(corpus) >= 40
    read = read_coefficients if key == "coefficients" else read_positions
    for name, data, pattern in corpus:
        (tmp_path / name).write_bytes(data if isinstance(data, bytes) else data.encode())
        try:
            found = read(tmp_path / name)
        except FileError as error:
            sentence = str(error)
        else:
            sentence = f"was read as {found}"
        assert re.search(pattern, sentence), (name, sentence)
        assert re.fullmatch(re.escape(name) + r" [^\n]{1,240}\.", sentence), (name, sentence)


SEEDS = {
    "a.csv": b"x,y,z,diameter\n" + b"1.5,2,3,0.1\n" * 5,
    "b.csv": b"1;2;3;4\n5;6;7;8\n",
    "a.xyz": b"2\nProperties=species:S:1:pos:R:3:radius:R:1\nA 1 2 3 4\nB 1 2 3 4\n",
    "a.dump": DUMP.replace("id x y z", "id xs ys zs").encode(),
    "a.vtk": VTK.encode(),
    "b.vtk": BINARY + POINTS + b"\nPOINT_DATA 2\nSCALARS radius float 1\nLOOKUP_TABLE default\n"
    + struct.pack(">2f", 1, 2),
    "a.vtp": vtp(array("0 0 0 1 1 1")).encode(),
    "b.vtp": vtp(array(encoded(struct.pack("<4I", 1, 24, 24, len(PACKED)), PACKED), "binary"), ZLIB).encode(),
    "c.vtp": vtp(array("", "appended", more='offset="0"'), tail='<AppendedData encoding="raw">_').encode()[
        :-10
    ] + struct.pack("<I", 24) + POINTS + b"</AppendedData></VTKFile>",
}  # fmt: skip


def survive(name: str, count: int, seed: int) -> None:
    """Particles or a sentence for so many changed files, and nothing else."""
    rng = np.random.default_rng(seed)
    assert len(parse_positions(SEEDS[name], Path(name))[0].points)
    for _ in range(count):
        try:
            parsed, _ = parse_positions(mutated(SEEDS[name], rng), Path(name))
        except FileError as error:
            sentence = str(error)
        else:
            assert np.isfinite(parsed.points).all()
            continue
        assert re.fullmatch(re.escape(name) + r" [^\n]{1,240}\.", sentence), sentence


@pytest.mark.parametrize("name", SEEDS)
def test_that_four_hundred_mutations_give_particles_or_a_sentence(name) -> None:
    survive(name, 400, 31)


@pytest.mark.slow
@pytest.mark.parametrize("name", SEEDS)
def test_that_forty_thousand_mutations_give_particles_or_a_sentence(name) -> None:
    survive(name, 40_000, 32)
