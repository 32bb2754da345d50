"""Stacks and HDF5 files that are broken in ways we made: each is refused with the sentence of its kind."""

import io
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import tifffile

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.read import describe_volume, read_volume
from tests.readers.mutations import check_refused

SLICES = np.arange(90, dtype="<u2").reshape(3, 5, 6)
Bad = dict[str, tuple[bytes, str]]
"""By name, one file for each sentence: its bytes, and what the sentence says."""
Tags = dict[int, tuple[int, list[int] | bytes]]

BROKEN = "is a broken TIFF file, or is cut short"
BYTE, ASCII, SHORT, LONG = 1, 2, 3, 4
LETTER = {BYTE: "B", ASCII: "B", SHORT: "H", LONG: "I"}


def page(**changes: tuple[int, list[int] | bytes] | None) -> Tags:
    """Tags of one page of 6 x 5 voxels of 16 bits whose pixels lie at byte 8."""
    tags: Tags = {
        256: (SHORT, [6]), 257: (SHORT, [5]), 258: (SHORT, [16]), 259: (SHORT, [1]), 262: (SHORT, [1]),
        273: (LONG, [8]), 277: (SHORT, [1]), 278: (SHORT, [5]), 279: (LONG, [60]),
    }  # fmt: skip
    for name, change in changes.items():
        tags.pop(int(name[1:]), None)
        if change is not None:
            tags[int(name[1:])] = change
    return tags


def tiff(pages: list[Tags], after: list[int] | None = None, pixels: bytes = SLICES[0].tobytes()) -> bytes:
    """A little-endian TIFF of these pages; `after` gives the page that follows each, else the next one."""
    data = bytearray(b"II*\0\0\0\0\0" + pixels)
    places = []
    for tags in pages:
        rows = []
        for tag, (kind, values) in sorted(tags.items()):
            raw = (
                values if isinstance(values, bytes) else struct.pack(f"<{len(values)}{LETTER[kind]}", *values)
            )
            count = len(raw) // struct.calcsize(LETTER[kind])
            if len(raw) > 4:
                rows.append(struct.pack("<HHII", tag, kind, count, len(data)))
                data += raw
            else:
                rows.append(struct.pack("<HHI4s", tag, kind, count, raw))
        places.append(len(data))
        data += struct.pack("<H", len(rows)) + b"".join(rows) + bytes(4)
    ends = [*places[1:], len(data)]
    for number, end in enumerate(ends):
        following = number + 1 if after is None else after[number]
        target = places[following] if following < len(places) else 0
        struct.pack_into(
            "<I", data, end - 4 if number == len(ends) - 1 else _end_of(data, places[number]), target
        )
    struct.pack_into("<I", data, 4, places[0] if places else 0)
    return bytes(data)


def _end_of(data: bytearray, place: int) -> int:
    return place + 2 + 12 * struct.unpack_from("<H", data, place)[0]


def three(**changes: tuple[int, list[int] | bytes] | None) -> bytes:
    return tiff([page(**changes) for _ in range(3)])


def stack(**options: Any) -> bytes:
    file = io.BytesIO()
    tifffile.imwrite(file, SLICES, photometric="minisblack", **options)
    return file.getvalue()


def cut(name: str, data: bytes, sentence: str) -> Bad:
    """A file that ends too early, in its head and in its voxels."""
    stem, _, suffix = name.partition(".")
    ends = {share: len(data) * share // 100 for share in (0, 1, 20, 60, 99)}
    return {f"{stem}-{share}.{suffix}": (data[:end], sentence) for share, end in ends.items()}


def pointing_beyond() -> bytes:
    data = bytearray(three())
    struct.pack_into("<HI", data, data.index(struct.pack("<HH", 273, LONG)) + 2, LONG, 10**8)
    return bytes(data)


def compressed(codec: int) -> bytes:
    return tiff([page(t259=(SHORT, [codec]))] * 3, pixels=b"\xf0\x9f\xaa\x55" * 15)


PACKED = stack(compression="zlib")
TILES = {"t322": (SHORT, [0]), "t323": (SHORT, [16]), "t324": (LONG, [8]), "t325": (LONG, [60])}
COLOURS = {"t258": (SHORT, [8] * 3), "t262": (SHORT, [2]), "t277": (SHORT, [3]), "t257": (SHORT, [3])}
BOMB = {"t256": (LONG, [2**20]), "t257": (LONG, [2**20]), "t278": (LONG, [2**20]), "t259": (SHORT, [8])}
COMPLEX = {"t258": (SHORT, [64]), "t339": (SHORT, [6]), "t256": (SHORT, [1])}
COMPLEX |= {"t257": (SHORT, [7]), "t278": (SHORT, [7])}
OME = b'<?xml version="1.0"?><OME><Image><Pixels SizeC="3" SizeX="6"/></Image></OME>\0'
UNEQUAL = [page(), page(t257=(SHORT, [4]), t278=(SHORT, [4]), t279=(LONG, [48])), page()]
TIFFS: Bad = cut("cut.tif", PACKED, "cut short|is not a TIFF|is empty|is broken") | {
    "magic.tif": (b"\x89PNG" + PACKED[4:], "is not a TIFF file"),
    "big.tif": (b"II+\0\7\0\0\0" + bytes(40), BROKEN),
    "beyond.tif": (b"II*\0\xff\xff\xff\x7f", BROKEN),
    "circle.tif": (tiff([page()] * 3, [1, 2, 0]), BROKEN),
    "itself.tif": (tiff([page()], [0]), BROKEN),
    "no-tags.tif": (tiff([{}]), "its pixels have no size"),
    "tags.tif": (tiff([{tag: (BYTE, [1]) for tag in range(256, 900)}]), BROKEN),
    "flat.tif": (three(t256=(LONG, [0])), "holds no voxels"),
    "high.tif": (three(t257=(LONG, [2**31 - 1])), f"no volume can have the shape|{BROKEN}"),
    "no-width.tif": (three(t256=None), "holds no voxels"),
    "bits.tif": (three(t258=(SHORT, [65])), "its pixels have no size"),
    "samples.tif": (three(t277=(SHORT, [5000])), "holds 5000 colours"),
    "pixels-beyond.tif": (three(t273=(LONG, [10**6])), "is cut short: the pixels of page 1"),
    "pixels-long.tif": (three(t279=(LONG, [10**6])), "is cut short: the pixels of page 1"),
    "pixels-absent.tif": (three(t273=None), BROKEN),
    "strips-few.tif": (three(t278=(SHORT, [1])), BROKEN),
    "strips-many.tif": (three(t279=(LONG, [20, 20, 20])), BROKEN),
    "tiles.tif": (three(**TILES), "is a broken TIFF file|cannot be decoded"),
    "colours.tif": (three(**COLOURS), "colours"),
    "single.tif": (tiff([page()]), "is not a volume: its shape is 5 × 6"),
    "sizes.tif": (tiff(UNEQUAL), "among its pages are some of another size"),
    "lzw.tif": (compressed(5), "cannot be decoded"),
    "deflate.tif": (compressed(8), "cannot be decoded"),
    "zstd.tif": (compressed(50000), "cannot be decoded"),
    "codec.tif": (compressed(4242), "cannot be decoded|is a broken TIFF file"),
    "bomb.tif": (three(**BOMB), "has slices of 2,048 GiB"),
    "complex.tif": (three(**COMPLEX), "complex"),
    "channels.tif": (three(t270=(ASCII, OME)), "holds 3 channels or times"),
    "pointer.tif": (pointing_beyond(), BROKEN),
}


def hdf5(make: Callable[[h5py.File], object]) -> bytes:
    file = io.BytesIO()
    with h5py.File(file, "w") as stored:
        make(stored)
    return file.getvalue()


def tagged(axes: str, shape: tuple[int, ...]) -> bytes:
    def make(file: h5py.File) -> None:
        data = file.create_dataset("exported_data", data=np.zeros(shape, "u1"))
        data.attrs["axistags"] = json.dumps({"axes": [{"key": key} for key in axes]})

    return hdf5(make)


def filled(shape: tuple[int, ...], kind: object = "u1", **options: Any) -> bytes:
    """A file with one dataset of zeros."""
    return hdf5(lambda file: file.create_dataset("a", shape, kind, **options))


def linked(link: object) -> bytes:
    return hdf5(lambda file: file.__setitem__("a", link))


def virtual() -> bytes:
    layout = h5py.VirtualLayout((4, 4, 4), "u1")
    layout[:] = h5py.VirtualSource("other.h5", "a", (4, 4, 4))
    return hdf5(lambda file: file.create_virtual_dataset("a", layout))


def unpackable(whole: bytes) -> bytes:
    packed = bytearray(whole)
    place = whole.index(b"\x78\x5e") if b"\x78\x5e" in whole else whole.index(b"\x78\x9c")
    packed[place : place + 20] = bytes(20)
    return bytes(packed)


NOTHING = "holds no volume"
GZIPPED = hdf5(lambda file: file.create_dataset("data", data=SLICES, chunks=(1, 5, 6), compression="gzip"))
HDF5S: Bad = cut("cut.h5", GZIPPED, "is a broken HDF5|is empty") | {
    "head.h5": (GZIPPED[:9] + bytes([GZIPPED[9] ^ 0x5A]) + GZIPPED[10:], "is a broken HDF5"),
    "text.h5": (b"text\n" * 90, "is a broken HDF5"),
    "magic.h5": (b"\x89HDF\r\n\x1a\n" + b"\xff" * 900, "is a broken HDF5"),
    "nothing.h5": (hdf5(lambda file: file.create_group("a/b/c")), NOTHING),
    "words.h5": (hdf5(lambda file: file.create_dataset("a", data="words")), NOTHING),
    "empty.h5": (hdf5(lambda file: file.create_dataset("a", data=h5py.Empty("f4"))), NOTHING),
    "complex.h5": (filled((4, 4, 4), "c8"), NOTHING),
    "record.h5": (filled((4, 4, 4), [("a", "f4"), ("b", "i2")]), NOTHING),
    "flat.h5": (filled((9, 9)), NOTHING),
    "hollow.h5": (filled((3, 0, 3)), NOTHING),
    "colours.h5": (filled((4, 4, 4, 99)), NOTHING),
    "times.h5": (tagged("tzyx", (5, 4, 4, 4)), f"{NOTHING}|is not a volume"),
    "channels.h5": (tagged("zyc", (4, 4, 3)), f"{NOTHING}|is not a volume"),
    "external.h5": (linked(h5py.ExternalLink("other.h5", "/a")), NOTHING),
    "self.h5": (linked(h5py.SoftLink("/a")), NOTHING),
    "storage.h5": (filled((4, 4, 4), external=[("/etc/passwd", 0, 64)]), "in another file"),
    "virtual.h5": (virtual(), "from other files"),
    "chunks.h5": (filled((2**10,) * 3, chunks=(2**10,) * 3), "in chunks of more than"),
    "wide.h5": (filled((2, 2**17, 2**17), chunks=(1, 64, 64)), "has slices of 16 GiB"),
    "packed.h5": (unpackable(GZIPPED), "cannot be unpacked"),
}
CORPORA = {"tiff": TIFFS, "hdf5": HDF5S}


@pytest.mark.parametrize("key", CORPORA)
def test_that_each_broken_file_is_refused_with_the_sentence_of_its_kind(key, tmp_path) -> None:
    for name, (data, pattern) in CORPORA[key].items():
        (tmp_path / name).write_bytes(data)
        check_refused(tmp_path / name, pattern)


def test_that_the_good_files_behind_the_broken_ones_are_read(tmp_path) -> None:
    """Three pages that share their pixels, as the writer of these tests makes them."""
    (tmp_path / "a.tif").write_bytes(three())
    found = read_volume(tmp_path / "a.tif", voxel_size=1.0).array.T
    assert np.array_equal(found, np.stack([SLICES[0]] * 3))
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), found)


@pytest.fixture
def folder(tmp_path) -> Path:
    """A folder of five sound slices."""
    for number in range(5):
        tifffile.imwrite(tmp_path / f"s{number}.tif", SLICES[0])
    return tmp_path


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "its slice s3.tif is empty"),
        (b"text" * 50, "its slice s3.tif is not a TIFF file"),
        (stack()[:100], "its slice s3.tif is a broken TIFF file, or is cut short"),
        (stack(), "its slice s3.tif has 3 pages"),
        (tiff([page(t257=(SHORT, [4]))]), "its slice s3.tif has 6 × 4 pixels"),
        (tiff([page(t258=(SHORT, [8]))]), "its slice s3.tif has 6 × 5 pixels of uint8"),
        (tiff([page(t259=(SHORT, [5]))], pixels=b"\xf0" * 60), "its slice s3.tif is damaged"),
        (three(t256=(LONG, [2**20]), t257=(LONG, [2**20]), t278=(LONG, [2**20]))[:300], "its slice s3.tif "),
    ],
)
def test_that_a_broken_slice_is_named(data, sentence, folder) -> None:
    (folder / "s3.tif").write_bytes(data)
    with pytest.raises(FileError) as caught:
        read_volume(folder, voxel_size=1.0)
    assert sentence in str(caught.value)
    assert str(caught.value).startswith(folder.name)


@pytest.mark.parametrize(
    "head", [b"", b"text", b"\x89PNG\r\n\x1a\n" + bytes(30), b"BM" + b"\xff" * 60, b"BM" + bytes(60)]
)
def test_that_broken_pictures_are_refused(head, tmp_path) -> None:
    for number in range(3):
        (tmp_path / f"s{number}.png").write_bytes(head)
    with pytest.raises(FileError, match=r"its slice s0\.png "):
        describe_volume(tmp_path)
