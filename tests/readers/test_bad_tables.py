"""Positions and tables that are broken in ways we made: each is refused with the sentence of its kind."""

import re

import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.coefficient_tables import read_coefficients
from regolith_studio.readers.positions import read_positions

Bad = dict[str, tuple[bytes | str, str]]
"""By name, one file for each sentence: what is in it, and what the sentence says."""

ROWS = "0,0,0,1\n1,1,1,1\n"
NO_TABLE = "is not a table of numbers|is not a text of numbers|holds no row of numbers|has “"
NO_PARTICLE = "no particle whose position and size are valid"


def strangers(suffix: str, pattern: str) -> Bad:
    """Files of quite another kind under a wrong name."""
    noise = np.random.default_rng(3).integers(128, 256, 600, dtype=np.uint8).tobytes()
    page = b"<!DOCTYPE html><html><body>404 not found</body></html>"
    others = {"diary": b"dear diary,\n" * 40, "page": page, "zip": b"PK\3\4" + bytes(400), "noise": noise}
    empty = {f"empty{suffix}": (b"", "is empty: it has no bytes at all")}
    return empty | {f"{name}{suffix}": (data, pattern) for name, data in others.items()}


TABLES: Bad = strangers(".csv", NO_TABLE) | {
    "word.csv": (f"x,y,z,d\n{ROWS}1e,2,2,2\n", "has “1e” where a number belongs"),
    "ragged.csv": (f"x,y,z,d\n{ROWS}1,2,3\n", "has 3 columns in line 4 and 4 in the first row"),
    "narrow.csv": ("1,2\n1,2\n", "positions need three"),
    "wide.csv": ("1,2,3,4,5\n1,2,3,4,5\n", "columns without names"),
    "names.csv": ("lat,lon,height\n1,2,3\n", "has no columns x, y and z; they are called"),
    "infinite.csv": ("x,y,z\nnan,0,0\n", NO_PARTICLE),
    "far.csv": ("x,y,z\n0,1e31,0\n", NO_PARTICLE),
    "size.csv": ("x,y,z,d\n1,2,3,0\n", NO_PARTICLE),
    "head.csv": ("x,y,z\n", "holds no row of numbers"),
    "title.csv": ("title\nunits\n1,2,3\n", "is not a table of numbers: line 2"),
}
XYZS: Bad = strangers(".xyz", NO_TABLE + "|columns") | {
    "count.xyz": ("3\ncomment\nA 0 0 0\nA 1 1 1\n", "is cut short: it declares"),
    "zero.xyz": ("0\ncomment\n", "is cut short: it declares 0"),
    "word.xyz": ("2\nc\nA 0 0 0\nA 1 one 1\n", "is a broken XYZ file: not all its rows"),
    "short.xyz": ("2\nc\nA 0 0 0\nA 1 2\n", "is a broken XYZ file: not all its rows"),
    "frame.xyz": ("1\nc\nA 0 0 0\ntwo\nc\nA 1 1 1\n", "line 4 should count particles"),
    "properties.xyz": ("1\nProperties=species:S:1\nA 0 0 0\n", "its properties name no pos"),
    "columns.xyz": ("1\nProperties=pos:R:3:radius:R:1\n0 0 0\n", "not all its rows are"),
    "infinite.xyz": ("1\nc\nA 0 inf 0\n", "no particle whose position and size"),
}
DUMP = (
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
    "ITEM: ATOMS id x y z\n1 0 0 0\n2 1 1 1\n"
)
SCALED = DUMP.replace("id x y z", "id xs ys zs")
DUMPS: Bad = strangers(".dump", "is not a LAMMPS dump") | {
    "cut.dump": (DUMP[:60], "is cut short|is a broken LAMMPS dump"),
    "count.dump": (DUMP.replace("ATOMS\n2", "ATOMS\n3"), "is cut short: its last step declares"),
    "number.dump": (DUMP.replace("ATOMS\n2", "ATOMS\nx"), "does not state its number of particles"),
    "names.dump": (DUMP.replace("id x y z", "id vx vy vz"), "has no columns x, y and z"),
    "width.dump": (DUMP.replace("id x y z", "id x y z r"), "particle 1 has 4 columns"),
    "row.dump": (DUMP.replace("2 1 1 1", "2 1 1"), "particle 2 has"),
    "infinite.dump": (DUMP.replace(" 0 0 0", " nan 0 0").replace(" 1 1 1", " 1e50 1 1"), NO_PARTICLE),
    "tilted.dump": (SCALED.replace("BOUNDS pp", "BOUNDS xy xz yz pp"), "a box that is tilted or not stated"),
    "flat-box.dump": (SCALED.replace("0 1\n0 1\n0 1", "0 1\n0 1"), "tilted or not stated"),
}
COMPLEX = "0 0 10 0\n1 -1 1 0.5\n1 0 0.1 0\n1 1 -1 0.5\n"
COEFFICIENTS: Bad = strangers(".anm", NO_TABLE + "|has \\d columns") | {
    "word.anm": (COMPLEX + "2 0 --1 0\n", "has “--1” where a number belongs"),
    "infinite.anm": (COMPLEX + "2 0 1e999 0\n", "1 of 5 rows hold a number that is not finite"),
    "order.anm": (COMPLEX + "2 3 0 0\n", "begins with .*expected a degree l"),
    "fraction.anm": (COMPLEX + "1.5 0 0 0\n", "begins with .*expected a degree l"),
    "twice.anm": (COMPLEX + "1 0 0.1 0\n", "comes more than once"),
    "contradict.anm": (COMPLEX.replace("1 -1 1 0.5", "1 -1 9 9"), "contradict each other"),
    "mean.anm": (COMPLEX.replace("0 0 10 0", "0 0 -10 0"), "no positive mean radius"),
    "width.anm": ("0 0 10\n1 0 1\n", "columns; a table of coefficients has four"),
    "convention.anm": ("0 0 10 0\n1 0 1 0\n", "does not show its convention"),
}
CORPORA: dict[str, Bad] = {
    "tables": TABLES, "xyz": XYZS, "lammps": DUMPS, "coefficients": COEFFICIENTS,
}  # fmt: skip


@pytest.mark.parametrize("key", CORPORA)
def test_that_each_broken_file_is_refused_with_the_sentence_of_its_kind(key, tmp_path) -> None:
    read = read_coefficients if key == "coefficients" else read_positions
    for name, (data, pattern) in CORPORA[key].items():
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
}  # fmt: skip
