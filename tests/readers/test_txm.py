"""TXM files as pyaaf2 writes compound files: every voxel in its place, and 100 broken ones refused."""

import io
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import pytest
from aaf2.cfb import CompoundFileBinary

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume
from tests.readers.mutations import check_refused

TYPES = {"uint8": 3, "uint16": 5, "float32": 10}
MAGIC_BYTES = 8
Streams = dict[str, bytes]


def marked(shape: tuple[int, int, int], dtype: str = "uint16") -> np.ndarray:
    """Grey values that no swapped or mirrored axis leaves as they are."""
    z, y, x = np.indices(shape)
    return ((3 * x + 7 * y + 11 * z + x * y * z) % 251).astype(dtype)


def streams(slices: np.ndarray, pixel: float = 1.5) -> Streams:
    nz, ny, nx = slices.shape
    numbers = {"ImageWidth": nx, "ImageHeight": ny, "NoOfImages": nz, "DataType": TYPES[slices.dtype.name]}
    found = {f"/ImageInfo/{name}": struct.pack("<I", number) for name, number in numbers.items()}
    found["/ImageInfo/PixelSize"] = struct.pack("<f", pixel)
    for number in reversed(range(1, nz + 1)):
        data = slices[number - 1].astype(slices.dtype.newbyteorder("<")).tobytes()
        found[f"/ImageData{-(-number // 100)}/Image{number}"] = data
    return found


def compound(contents: Mapping[str, bytes], sector_bytes: int = 512) -> bytes:
    """A compound file of these streams, written by pyaaf2."""
    file = io.BytesIO()
    written = CompoundFileBinary(file, "wb+", sector_bytes)
    for folder in dict.fromkeys(path.rpartition("/")[0] for path in contents):
        written.makedir(folder)
    for path, data in contents.items():
        stream = written.open(path, "w")
        stream.write(data)
    written.close()
    return file.getvalue()


def txm(shape: tuple[int, int, int] = (4, 5, 6), dtype: str = "uint16", sector_bytes: int = 512) -> bytes:
    return compound(streams(marked(shape, dtype)), sector_bytes)


@pytest.mark.parametrize("sector_bytes", [512, 4096])
@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("shape", [(3, 5, 7), (4, 71, 90), (203, 6, 5)])
def test_that_every_voxel_is_in_its_place(shape, dtype, sector_bytes, tmp_path) -> None:
    """Slices in small sectors and in large ones, and more of them than a folder holds."""
    path = tmp_path / "scan.txm"
    path.write_bytes(txm(shape, dtype, sector_bytes))
    header = describe_volume(path)
    assert (header.shape, header.dtype.name, header.notes) == (shape[::-1], dtype, ())
    assert (header.voxel_size, header.unit) == ((1.5,) * 3, "um")
    volume = read_volume(path, kind="grey")
    assert np.array_equal(volume.array.T, marked(shape, dtype))
    assert volume.voxel_size == pytest.approx([1.5] * 3)


def test_that_slabs_in_any_order_hold_their_slices(tmp_path) -> None:
    path = tmp_path / "scan.txm"
    path.write_bytes(txm((7, 50, 60)))
    source = open_slabs(path, kind="grey")
    for z0, z1 in ((5, 7), (0, 2), (3, 4)):
        assert np.array_equal(source.read(z0, z1).T, marked((7, 50, 60))[z0:z1])


def test_that_the_names_of_older_files_are_understood(tmp_path) -> None:
    """Names in other cases, and the number of images under its other name."""
    contents = streams(marked((3, 5, 6)))
    contents["/ImageInfo/pixelsize"] = contents.pop("/ImageInfo/PixelSize")
    contents["/ImageInfo/ImagesTaken"] = contents.pop("/ImageInfo/NoOfImages")
    (tmp_path / "old.txm").write_bytes(compound(contents))
    header = describe_volume(tmp_path / "old.txm")
    assert (header.shape, header.voxel_size, header.unit) == ((6, 5, 3), (1.5,) * 3, "um")


@pytest.mark.parametrize("pixel", [None, 0.0, float("nan"), float("inf")])
def test_that_a_size_that_is_none_is_asked_for(pixel, tmp_path) -> None:
    contents = streams(marked((3, 5, 6)), pixel or 0.0)
    if pixel is None:
        del contents["/ImageInfo/PixelSize"]
    (tmp_path / "a.txm").write_bytes(compound(contents))
    assert describe_volume(tmp_path / "a.txm").voxel_size is None


def test_that_a_folder_lists_the_volume_and_not_the_projections(tmp_path) -> None:
    for name in ("scan.txm", "scan.txrm"):
        (tmp_path / name).write_bytes(txm())
    assert [path.name for path in volume_files(tmp_path)] == ["scan.txm"]
    with pytest.raises(FileError, match=r"scan\.txrm holds projections, not a volume: reconstruct it"):
        describe_volume(tmp_path / "scan.txrm")


def patched(data: bytes, place: int, number: int) -> bytes:
    return data[:place] + struct.pack("<I", number) + data[place + 4 :]


def table_of(data: bytes) -> int:
    """The byte of the table's first entry in a file of sectors of 512 bytes."""
    return 512 * (1 + int.from_bytes(data[76:80], "little"))


def chains() -> Iterator[tuple[str, bytes, str]]:
    """Links of a table that lie: to themselves, to another slice, out of the file, to nowhere."""
    good = txm((4, 50, 60))
    table = table_of(good)
    numbers = np.frombuffer(good, "<u4", 128, table)
    data = [place for place in range(127) if numbers[place] == place + 1]
    assert len(data) > 20
    for place in data[4:24]:
        yield f"loop-{place}.txm", patched(good, table + 4 * place, place), "places of its streams"
    for place in data[4:8]:
        for target in (data[0] + 1, 126, 4_000_000, 0xFFFFFFFE):
            yield (
                f"link-{place}-{target}.txm",
                patched(good, table + 4 * place, target),
                "places of its streams|is cut short|is a broken",
            )


def bad_files() -> Iterator[tuple[str, bytes, str]]:
    good = txm((4, 50, 60))
    broken = "is cut short|is a broken TXM|is damaged|is no TXM|is empty"
    for share in (0, 1, 3, 5, 9, 15, 22, 30, 40, 60, 80, 95):
        yield f"cut-{share}.txm", good[: len(good) * share // 100], broken
    for name, data in {
        "text": b"dear diary\n" * 60,
        "zeros": bytes(2000),
        "signature": good[:MAGIC_BYTES] + bytes(4000),
        "noise": good[:MAGIC_BYTES] + np.random.default_rng(3).integers(0, 256, 4000, np.uint8).tobytes(),
        "other": compound({"/WordDocument/Text": b"dear diary" * 900}),
    }.items():
        yield f"{name}.txm", data, broken
    contents = streams(marked((4, 5, 6)))
    for name in ("ImageWidth", "ImageHeight", "NoOfImages", "DataType"):
        less = {path: data for path, data in contents.items() if not path.endswith(name)}
        yield f"without-{name}.txm", compound(less), "has no stream “ImageInfo/"
        for number, data in enumerate((b"", b"\1\0", bytes(5000))):
            words = "is not a number"
            yield f"{name}-{number}.txm", compound({**contents, f"/ImageInfo/{name}": data}), words
    for name in ("ImageWidth", "ImageHeight"):
        for number in (1, 4, 7, 60_000):
            changed = {**contents, f"/ImageInfo/{name}": struct.pack("<I", number)}
            yield f"{name}-of-{number}.txm", compound(changed), "its slice 1 has 60 bytes and needs"
        changed = {**contents, f"/ImageInfo/{name}": struct.pack("<I", 0)}
        yield f"{name}-of-0.txm", compound(changed), "holds no voxels"
        changed = {**contents, f"/ImageInfo/{name}": struct.pack("<I", 2**32 - 1)}
        yield f"{name}-huge.txm", compound(changed), "is damaged: no volume can have"
    for number in (5, 101, 100_000):
        changed = {**contents, "/ImageInfo/NoOfImages": struct.pack("<I", number)}
        yield f"slices-{number}.txm", compound(changed), f"states {number:,} slices and has no slice 5"
    for number in (0, 1, 4, 6, 2**31):
        changed = {**contents, "/ImageInfo/DataType": struct.pack("<I", number)}
        yield f"type-{number}.txm", compound(changed), f"holds voxels of type {number}"
    short = {**contents, "/ImageData1/Image3": bytes(59)}
    yield "short-slice.txm", compound(short), "its slice 3 has 59 bytes and needs 60"


@pytest.mark.parametrize("corpus", [chains, bad_files])
def test_that_each_broken_file_is_refused_with_the_sentence_of_its_kind(corpus, tmp_path) -> None:
    files = list(corpus())
    assert len({name for name, _, _ in files}) == len(files) >= 30
    for name, data, pattern in files:
        path = Path(tmp_path / name)
        path.write_bytes(data)
        check_refused(path, pattern)
