"""Volumes that are broken in ways we made: each is refused with the sentence of its kind.

The sentences are written down by hand here, from what is
wrong with the file, not from what a parser says.
"""

import gzip
import io
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.readers.volumes.read import open_slabs
from tests.readers.mutations import check_refused

FOREIGN = Path(__file__).with_name("foreign_volumes")
SLICES = np.arange(120, dtype="<i2").reshape(4, 5, 6)
Bad = dict[str, tuple[bytes, str]]
"""By name, one file for each sentence: its bytes, and what the sentence says."""


def spoilt(name: str, data: bytes, short: str, kind: str) -> Bad:
    """A file that ends too early, in its head and in its voxels, and files of quite another kind."""
    stem, _, suffix = name.partition(".")
    cuts = {
        f"{stem}-cut-at-{share}.{suffix}": data[: len(data) * share // 100] for share in (0, 3, 15, 60, 99)
    }
    noise = np.random.default_rng(3).integers(0, 256, 600, dtype=np.uint8).tobytes()
    page = b"<!DOCTYPE html><html><body>404 not found</body></html>"
    others = {"html": page, "zip": b"PK\3\4" + bytes(400), "noise": noise}
    return {key: (cut, short) for key, cut in cuts.items()} | {
        f"{key}.{suffix}": (other, kind) for key, other in others.items()
    }


def npy(header: str | bytes, data: bytes = SLICES.tobytes(), version: bytes = b"\1\0") -> bytes:
    text = header if isinstance(header, bytes) else header.encode()
    return b"\x93NUMPY" + version + struct.pack("<H", len(text)) + text + data


NPY = "{'descr': '<i2', 'fortran_order': False, 'shape': (4, 5, 6), }\n"


def of_shape(shape: str) -> bytes:
    return npy(NPY.replace("(4, 5, 6)", shape))


def of_type(kind: str) -> bytes:
    return npy(NPY.replace("'<i2'", kind))


NPYS: Bad = spoilt(
    "a.npy", npy(NPY), "is cut short|is a broken NPY file|is empty", "is a broken NPY file"
) | {
    "dimensions.npy": (of_shape("(4, 5)"), "is not a volume: its shape"),
    "nothing.npy": (of_shape("(4, -5, 6)"), "holds no voxels"),
    "promise.npy": (of_shape("(4, 5, 6000)"), "is cut short"),
    "enormous.npy": (of_shape("(4, 5, 6000000000)"), "is damaged|is a broken NPY file"),
    "shape.npy": (of_shape("(4,,5)"), "is a broken NPY file"),
    "object.npy": (of_type("'|O'"), "holds Python objects"),
    "complex.npy": (of_type("'<c8'"), "holds .*complex"),
    "text.npy": (of_type("'<U2'"), "holds .*values"),
    "structured.npy": (of_type("[('a', '<i2'), ('b', '<f4')]"), "holds structured values"),
    "code.npy": (npy("__import__('os').getpid()\n"), "is a broken NPY file"),
    "deep.npy": (npy("{" * 5000), "is a broken NPY file"),
    "long.npy": (npy(NPY[:-1] + " " * 20000 + "\n"), "is a broken NPY file"),
    "version.npy": (npy(NPY, version=b"\x09\0"), "version 9.0"),
}
NRRD = "NRRD0004\ntype: short\ndimension: 3\nsizes: 6 5 4\nendian: little\nencoding: raw"


def nrrd(name: str, value: str | None, data: bytes = SLICES.tobytes()) -> bytes:
    lines = [line for line in NRRD.splitlines() if not line.startswith(f"{name}:")]
    if value is not None:
        lines.insert(1, f"{name}: {value}")
    return "\n".join(lines).encode() + b"\n\n" + data


LONG_STREAM = gzip.compress(SLICES.tobytes() + bytes(1_000_000))[:-8] + bytes(8)
NRRDS: Bad = spoilt(
    "a.nrrd", nrrd("x", None), "is cut short|is a broken NRRD|is not an NRRD|is empty", "is not an NRRD"
) | {
    "without-type.nrrd": (nrrd("type", None), "is a broken NRRD"),
    "without-encoding.nrrd": (nrrd("encoding", None), "is an NRRD in no encoding|is a broken NRRD"),
    "type.nrrd": (nrrd("type", "block"), "holds “.*” values"),
    "sizes.nrrd": (nrrd("sizes", "6 5 -4"), "is a broken NRRD"),
    "empty.nrrd": (nrrd("sizes", "6 0 4"), "holds no voxels"),
    "promise.nrrd": (nrrd("sizes", "6 50 4"), "is cut short"),
    "enormous.nrrd": (nrrd("sizes", "6 5 4000000000"), "is damaged: no volume can have"),
    "encoding.nrrd": (nrrd("encoding", "bzip2"), "is an NRRD in "),
    "gzip.nrrd": (nrrd("encoding", "gzip", b"x" * 50), "is damaged|is cut short"),
    "gzip-long.nrrd": (nrrd("encoding", "gzip", LONG_STREAM), "is damaged"),
    "gzip-short.nrrd": (nrrd("encoding", "gz", gzip.compress(bytes(9))), "is cut short"),
    "above.nhdr": (nrrd("data file", "../a.raw"), "only a file in the same folder is read"),
    "elsewhere.nhdr": (nrrd("data file", "/etc/passwd"), "only a file in the same folder is read"),
    "absent.nhdr": (nrrd("data file", "absent.raw"), "needs the file “absent.raw”"),
    "itself.nhdr": (nrrd("data file", "itself.nhdr"), "points to itself"),
    "several.nhdr": (nrrd("data file", "slice%03d.raw 1 4 1"), "over several files"),
    "bytes.nrrd": (nrrd("byte skip", "-5"), "skips lines or bytes"),
    "twice.nrrd": (b"NRRD0004\ntype: short\ntype: short\n\n", "has the field “type” twice"),
    "word.nrrd": (b"NRRD0004\nhello\n\n", "line 2 of its header is not a field"),
    "endless.nrrd": (b"NRRD0004\n" + b"# comment\n" * 9000, "its header does not end"),
    "version.nrrd": (nrrd("x", None).replace(b"0004", b"0009"), "is not an NRRD of versions 1 to 5"),
}
MHA = "ObjectType = Image\nNDims = 3\nDimSize = 6 5 4\nElementType = MET_SHORT\nElementDataFile = LOCAL"


def mha(name: str, value: str | None, data: bytes = SLICES.tobytes()) -> bytes:
    lines = [line for line in MHA.splitlines() if not line.startswith(f"{name} ")]
    if value is not None:
        lines.insert(len(lines) if name == "ElementDataFile" else 1, f"{name} = {value}")
    return "\n".join(lines).encode() + b"\n" + data


TWICE = mha("x", None).replace(b"NDims = 3", b"NDims = 3\nNDims = 3")
METAIMAGES: Bad = spoilt(
    "a.mha", mha("x", None), "is cut short|is a broken MetaImage|is empty", "is a broken MetaImage"
) | {
    "without-size.mha": (mha("DimSize", None), "is a broken MetaImage"),
    "without-file.mha": (mha("ElementDataFile", None), "is a broken MetaImage"),
    "type.mha": (mha("ElementType", "MET_STRING"), "holds “.*” values"),
    "channels.mha": (mha("ElementNumberOfChannels", "3"), "holds several channels"),
    "sizes.mha": (mha("DimSize", "6 5 x"), "is a broken MetaImage"),
    "empty.mha": (mha("DimSize", "6 0 4"), "holds no voxels"),
    "promise.mha": (mha("DimSize", "6 50 4"), "is cut short"),
    "enormous.mha": (mha("DimSize", "6 5 4000000000"), "is damaged: no volume can have"),
    "dimensions.mha": (mha("NDims", "2"), "NDims and its DimSize do not agree"),
    "packed.mha": (mha("CompressedData", "True", b"x" * 50), "is damaged|is cut short"),
    "packed-short.mha": (mha("CompressedData", "True", zlib.compress(bytes(9))), "is damaged|is cut short"),
    "elsewhere.mhd": (mha("ElementDataFile", "../a.raw"), "only a file in the same folder is read"),
    "endless.mhd": (mha("ElementDataFile", "n" * 300), "only a file in the same folder is read"),
    "absent.mhd": (mha("ElementDataFile", "absent.raw"), "needs the file “absent.raw”"),
    "itself.mhd": (mha("ElementDataFile", "itself.mhd"), "points to itself"),
    "several.mhd": (mha("ElementDataFile", "LIST"), "over several files"),
    "text.mha": (mha("BinaryData", "False"), "holds its voxels as text"),
    "header.mha": (mha("HeaderSize", "-2"), "cannot have the size|is cut short"),
    "twice.mha": (TWICE, "has the field “ndims” twice"),
}


def patched(name: str, place: int, kind: str, *values: float) -> bytes:
    data = bytearray((FOREIGN / name).read_bytes())
    struct.pack_into("<" + kind, data, place, *values)
    return bytes(data)


ONE, TWO = (FOREIGN / "nib1.nii").read_bytes(), (FOREIGN / "nib2.nii").read_bytes()
NIFTI_SHORT = "is not a NIfTI|is cut short|is damaged|is empty"
NIFTIS: Bad = (
    spoilt("one.nii", ONE, NIFTI_SHORT, "is not a NIfTI file")
    | spoilt("one.nii.gz", gzip.compress(ONE, mtime=0), NIFTI_SHORT, "is not a NIfTI|is damaged")
    | {
        "complex.nii": (patched("nib1.nii", 70, "h", 32), "holds .*complex"),
        "colours.nii": (patched("nib1.nii", 70, "h", 128), "holds .*colours"),
        "long.nii": (patched("nib1.nii", 70, "h", 1536), "holds .*128 bits"),
        "type.nii": (patched("nib1.nii", 70, "h", 999), "there is no type of number"),
        "dimensions.nii": (patched("nib1.nii", 40, "h", -3), "it cannot have"),
        "flat.nii": (patched("nib1.nii", 40, "h", 2), "is not a volume: its shape"),
        "times.nii": (patched("nib1.nii", 40, "5h", 4, 6, 5, 2, 2), "is not a volume: its shape"),
        "negative.nii": (patched("nib1.nii", 42, "h", -7), "holds no voxels"),
        "promise.nii": (patched("nib1.nii", 46, "h", 30000), "is cut short"),
        "enormous.nii": (patched("nib2.nii", 24, "q", 2**40), "is damaged: no volume can have"),
        "offset.nii": (patched("nib1.nii", 108, "f", float("nan")), "voxels cannot begin at byte"),
        "beyond.nii": (patched("nib1.nii", 108, "f", 5000.0), "is cut short"),
        "pair.nii": (ONE[:344] + b"ni1\0" + ONE[348:], "keeps its voxels in a second file"),
        "analyze.nii": (ONE[:344] + bytes(4) + ONE[348:], "its signature is missing"),
        "mangled.nii": (TWO[:8] + b"\n\n\n\n" + TWO[12:], "signature is missing or damaged"),
    }
)
CORPORA = {"npy": NPYS, "nrrd": NRRDS, "metaimage": METAIMAGES, "nifti": NIFTIS}


@pytest.mark.parametrize("key", CORPORA)
def test_that_each_broken_volume_is_refused_with_the_sentence_of_its_kind(key, tmp_path) -> None:
    for name, (data, pattern) in CORPORA[key].items():
        (tmp_path / name).write_bytes(data)
        check_refused(tmp_path / name, pattern)


@pytest.mark.parametrize("surplus", [-1, 1, 100000])
def test_that_a_raw_file_of_another_length_is_refused(surplus, tmp_path) -> None:
    """One byte too many is as wrong as one too few, for then the shape is not what it is."""
    path = tmp_path / "a.raw"
    path.write_bytes(bytes(6 * 5 * 4 * 2 + surplus))
    check_refused(path, "voxels of", raw=RawLayout((6, 5, 4), "int16"))


def test_that_a_slice_larger_than_a_gibibyte_is_refused(tmp_path) -> None:
    path = tmp_path / "wide.raw"
    with path.open("wb") as file:
        file.truncate(40000 * 40000)
    check_refused(path, "has slices of 1.49 GiB", raw=RawLayout((40000, 40000, 1), "uint8"))


def test_that_the_good_files_behind_the_broken_ones_are_read(tmp_path) -> None:
    """Else every refusal above would prove nothing."""
    good = {"a.npy": npy(NPY), "a.nrrd": nrrd("x", None), "a.mha": mha("x", None)}
    for name, data in good.items():
        (tmp_path / name).write_bytes(data)
        found = open_slabs(tmp_path / name, voxel_size=1.0, kind="grey").read(0, 4)
        assert np.array_equal(found.T, SLICES)


def test_that_a_stream_that_unpacks_to_far_more_than_it_promises_is_read_as_promised(tmp_path) -> None:
    """A hundred megabytes of zeros behind the last voxel are never unpacked."""
    bomb = io.BytesIO()
    with gzip.open(bomb, "wb") as file:
        file.write(SLICES.tobytes() + bytes(100_000_000))
    (tmp_path / "bomb.nrrd").write_bytes(nrrd("encoding", "gzip", bomb.getvalue()))
    found = open_slabs(tmp_path / "bomb.nrrd", voxel_size=1.0, kind="grey").read(0, 4)
    assert np.array_equal(found.T, SLICES)


@pytest.mark.parametrize("name", ["gzip.nrrd", "one.nii.gz"])
def test_that_a_wrong_checksum_behind_the_last_voxel_is_noticed(name, tmp_path) -> None:
    """The voxels can be unpacked all the same, and some of them may be wrong."""
    packed = bytearray(
        gzip.compress(SLICES.tobytes() if "nrrd" in name else (FOREIGN / "nib1.nii").read_bytes())
    )
    packed[-6] ^= 1
    (tmp_path / name).write_bytes(nrrd("encoding", "gzip", bytes(packed)) if "nrrd" in name else packed)
    check_refused(tmp_path / name, "is damaged: its compressed voxels")
