"""Avizo and Amira fields in all encodings that are read: voxels and edges right, broken ones refused."""

import zlib
from collections.abc import Iterator
from itertools import groupby

import numpy as np
import pytest

from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume
from tests.readers.mutations import check_answers, check_refused
from tests.readers.test_txm import marked
from tests.readers.test_volume_mutations import answer_of

SHAPE = (4, 5, 6)
TYPES = {"byte": "u1", "short": "i2", "ushort": "u2", "int": "i4", "float": "f4", "double": "f8"}
LITTLE, BIG, TEXT = "BINARY-LITTLE-ENDIAN 2.1", "3D BINARY 2.0", "3D ASCII 2.0"


def run_lengths(data: bytes) -> bytes:
    """Runs of up to 127 equal bytes, and pairs of different ones as they are."""
    out = bytearray()
    single = bytearray()
    for value, run in groupby(data):
        left = len(list(run))
        if left == 1 and len(single) < 127:
            single.append(value)
            continue
        if single:
            out += bytes([128 + len(single)]) + single
            single.clear()
        while left:
            out += bytes([min(left, 127), value])
            left -= min(left, 127)
    return bytes(out + (bytes([128 + len(single)]) + single if single else b""))


def amira(
    kind: str = "ushort", form: str = LITTLE, encoding: str = "", slices: np.ndarray | None = None
) -> bytes:
    slices = marked(SHAPE) if slices is None else slices
    stored = slices.astype(np.dtype(TYPES[kind]).newbyteorder(">" if form == BIG else "<"))
    data = stored.tobytes()
    if form == TEXT:
        data = (
            "\n".join(" ".join(map(str, row)) for row in stored.reshape(-1, slices.shape[2])).encode() + b"\n"
        )
    data = {"HxZip": zlib.compress, "HxByteRLE": run_lengths}.get(encoding, bytes)(data)
    nz, ny, nx = slices.shape
    place = f"@1({encoding},{len(data)})" if encoding else "@1"
    head = f"""# AmiraMesh {form}


define Lattice {nx} {ny} {nz}

Parameters {{
    Units {{
        Coordinates "µm"
    }}
    Content "{nx}x{ny}x{nz} {kind}, uniform coordinates",
    BoundingBox 10 {10 + 0.5 * (nx - 1)} 0 {ny - 1} -3 {2 * (nz - 1) - 3},
    CoordType "uniform"
}}

Lattice {{ {kind} Data }} {place}

# Data section follows
@1
"""
    return head.encode() + data + b"\n"


@pytest.mark.parametrize(
    ("kind", "form", "encoding"),
    [(kind, form, encoding) for kind in TYPES for form, encoding in
     ((LITTLE, ""), (BIG, ""), (TEXT, ""), (LITTLE, "HxZip"))] + [("byte", LITTLE, "HxByteRLE")],
)  # fmt: skip
def test_that_every_voxel_is_in_its_place_with_its_edges(kind, form, encoding, tmp_path) -> None:
    path = tmp_path / "a.am"
    path.write_bytes(amira(kind, form, encoding))
    header = describe_volume(path)
    assert (header.shape, header.dtype, header.unit) == (SHAPE[::-1], np.dtype(TYPES[kind]), "um")
    assert header.voxel_size == pytest.approx((0.5, 1.0, 2.0))
    assert np.array_equal(read_volume(path, kind="grey").array.T, marked(SHAPE))
    source = open_slabs(path, kind="grey")
    for z0, z1 in ((2, 4), (0, 1), (1, 3)):
        assert np.array_equal(source.read(z0, z1).T, marked(SHAPE)[z0:z1])


@pytest.mark.parametrize(("form", "encoding"), [(LITTLE, "HxByteRLE"), (TEXT, "")])
def test_that_streams_longer_than_what_is_read_at_a_time_are_joined(form, encoding, tmp_path) -> None:
    rng = np.random.default_rng(2)
    slices = np.repeat(rng.integers(0, 250, (20, 130, 20)), rng.integers(1, 9, 20), axis=2).astype(np.uint8)
    slices[:3] = 7
    (tmp_path / "a.am").write_bytes(amira("byte", form, encoding, slices))
    assert (tmp_path / "a.am").stat().st_size > 1 << 16
    assert np.array_equal(read_volume(tmp_path / "a.am", kind="grey").array.T, slices)


def bad_files() -> Iterator[tuple[bytes, str]]:
    good, packed, runs = amira(), amira(encoding="HxZip"), amira("byte", encoding="HxByteRLE")
    text = amira(form=TEXT)
    for data in (good, packed, runs, text):
        for share in (0, 2, 10, 30, 60, 80, 90):
            yield data[: len(data) * share // 100], "is cut short|is no Avizo|is empty|is a broken"
    for data in (
        b"dear diary\n" * 40,
        bytes(600),
        b"# AmiraMesh 3D ASCII 2.0\n",
        b"# HyperSurface 0.1 ASCII\n",
    ):
        yield data, "is no Avizo or Amira file"
    for old, new, pattern in (
        (b"ushort Data", b"ushort[3] Data", "several numbers a voxel"),
        (b"ushort Data", b"complex Data", "holds “complex” values"),
        (b"define Lattice 6 5 4", b"define Lattice 6 5", "is not a volume"),
        (b"define Lattice 6 5 4", b"define Lattice 6 0 4", "holds no voxels"),
        (b"define Lattice 6 5 4", b"define Lattice 6 5 -4", "is not stated in whole numbers"),
        (b"define Lattice 6 5 4", b"define Lattice 6 5 400", "is cut short"),
        (b"define Lattice 6 5 4", b"define Lattice 6 5 4000000", "no volume can have"),
        (b"define Lattice", b"define Grid", "is not stated in whole numbers"),
        (b'"uniform"', b'"curvilinear"', "a lattice of curvilinear coordinates"),
        (b"} @1", b"} @1(HxWavelet,9)", "packed as “HxWavelet”"),
        (b"} @1", b"} @1(HxByteRLE,9)", "packed as “HxByteRLE”"),
        (b"} @1", b"} @2", "is not followed by the voxels @2"),
        (b"} @1", b"} @1(HxZip,9)", "is damaged"),
        (b"} @1", b"} @1(HxZip,99999)", "is cut short"),
    ):
        assert old in good
        yield good.replace(old, new), pattern
    for word in (b"x", b"-1", b"1.5", b"70000", b"nan", b"9" * 400):
        yield text.replace(b"follows\n@1\n", b"follows\n@1\n" + word + b" "), "its voxels are"
    start = runs.index(b"follows\n@1\n") + len(b"follows\n@1\n")
    for control in (0, 128):
        yield runs[:start] + bytes([control]) + runs[start + 1 :], "its packed voxels are invalid"


def test_that_each_broken_file_is_refused_with_the_sentence_of_its_kind(tmp_path) -> None:
    corpus = list(bad_files())
    assert len(corpus) >= 40
    for number, (data, pattern) in enumerate(corpus):
        path = tmp_path / f"{number}.am"
        path.write_bytes(data)
        check_refused(path, pattern)


@pytest.mark.parametrize(
    ("kind", "form", "encoding"),
    [("ushort", LITTLE, ""), ("ushort", LITTLE, "HxZip"), ("byte", LITTLE, "HxByteRLE"), ("int", TEXT, "")],
)
def test_that_four_hundred_mutations_give_voxels_or_a_sentence(kind, form, encoding, tmp_path) -> None:
    path = tmp_path / "a.am"
    path.write_bytes(amira(kind, form, encoding))
    check_answers(path, lambda: answer_of(path))
