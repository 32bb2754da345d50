"""Some 300 volumes that are broken in ways we made: each is refused with the sentence of its kind.

A corpus is a list of name, bytes and pattern. The sentences are written down by hand here, from what is
wrong with the file, not from what a parser says.
"""

import gzip
import io
import re
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.readers.volumes.read import describe_volume, open_slabs

FOREIGN = Path(__file__).with_name("foreign_volumes")
SLICES = np.arange(120, dtype="<i2").reshape(4, 5, 6)
CUT = r"is cut short|is broken|is a broken|is no |is empty|is damaged"
Bad = tuple[str, bytes, str]

CUTS = (0, 1, 3, 5, 9, 15, 22, 30, 40, 60, 80, 99)
"""Per cent of a file that are left of it."""


def cut(name: str, data: bytes, kind: str = CUT) -> Iterator[Bad]:
    """A file that ends too early, at a dozen places."""
    stem, _, suffix = name.partition(".")
    for share in CUTS:
        yield f"{stem}-cut-at-{share}.{suffix}", data[: len(data) * share // 100], kind


def strangers(suffix: str, kind: str) -> Iterator[Bad]:
    """Files of quite another kind under a wrong name."""
    others = {
        "text": b"dear diary\n" * 40,
        "html": b"<!DOCTYPE html><html><body>404 not found</body></html>",
        "zip": b"PK\3\4" + bytes(400),
        "pdf": b"%PDF-1.4\n" + bytes(400),
        "zeros": bytes(600),
        "ones": b"\xff" * 600,
        "newlines": b"\n" * 600,
        "noise": np.random.default_rng(3).integers(0, 256, 600, dtype=np.uint8).tobytes(),
    }
    for name, data in others.items():
        yield f"{name}{suffix}", data, kind


def npy(header: str | bytes, data: bytes = SLICES.tobytes(), version: bytes = b"\1\0") -> bytes:
    text = header if isinstance(header, bytes) else header.encode()
    return b"\x93NUMPY" + version + struct.pack("<H", len(text)) + text + data


def npys() -> Iterator[Bad]:
    good = "{'descr': '<i2', 'fortran_order': False, 'shape': (4, 5, 6), }\n"
    yield from cut("a.npy", npy(good), CUT)
    yield from strangers(".npy", "is a broken NPY file")
    for number, shape in enumerate(("(4, 5)", "(120,)", "()", "(2, 2, 5, 6)", "(2,2,2,3,5)")):
        yield f"dimensions-{number}.npy", npy(good.replace("(4, 5, 6)", shape)), "is not a volume: its shape"
    for number, shape in enumerate(("(0, 5, 6)", "(4, 0, 6)", "(4, -5, 6)")):
        yield f"nothing-{number}.npy", npy(good.replace("(4, 5, 6)", shape)), "holds no voxels"
    for number, shape in enumerate(("(4, 5, 6000)", "(400, 500, 600)")):
        yield f"promise-{number}.npy", npy(good.replace("(4, 5, 6)", shape)), "is cut short"
    for number, shape in enumerate(
        ("(4, 5, 6000000)", "(10**9,5,6)", "(4.0, 5, 6)", "'456'", "(4,,5)", "[4,5,6]")
    ):
        pattern = "is damaged|is a broken NPY file"
        yield f"shape-{number}.npy", npy(good.replace("(4, 5, 6)", shape)), pattern
    for kind in ("|O", "O"):
        yield f"object-{len(kind)}.npy", npy(good.replace("<i2", kind)), "holds Python objects"
    for kind, sentence in (
        ("<c8", "complex"),
        ("|S4", "values"),
        ("<U2", "values"),
        ("<M8[s]", "values"),
        ("|V4", "values"),
    ):
        yield f"type-{kind[1]}.npy", npy(good.replace("<i2", kind)), f"holds .*{sentence}"
    structured = good.replace("'<i2'", "[('a', '<i2'), ('b', '<f4')]")
    yield "structured.npy", npy(structured), "holds structured values"
    for number, text in enumerate(
        ("{}\n", "[]\n", "{'descr': '<i2'}\n", "__import__('os').getpid()\n", "{" * 5000)
    ):
        yield f"header-{number}.npy", npy(text), "is a broken NPY file"
    yield "long.npy", npy(good[:-1] + " " * 20000 + "\n"), "is a broken NPY file"
    yield "version.npy", npy(good, version=b"\x09\0"), "version 9.0"
    yield "slice.npy", npy(good.replace("(4, 5, 6)", "(1, 1000000, 1000000)")), "is cut short|has slices of"


def with_field(text: str, name: str, value: str | None) -> str:
    """A header with one field changed, or without it."""
    lines = [line for line in text.splitlines() if not line.startswith(name)]
    if value is not None:
        lines.insert(1, f"{name}{value}")
    return "\n".join(lines)


NRRD = "NRRD0004\ntype: short\ndimension: 3\nsizes: 6 5 4\nendian: little\nencoding: raw"


def nrrd(name: str, value: str | None, data: bytes = SLICES.tobytes()) -> bytes:
    return with_field(NRRD, f"{name}:", None if value is None else f" {value}").encode() + b"\n\n" + data


def nrrds() -> Iterator[Bad]:
    yield from cut("a.nrrd", nrrd("x", None), "is cut short|is a broken NRRD|is not an NRRD|is empty")
    yield from strangers(".nrrd", "is not an NRRD")
    for field in ("type", "dimension", "sizes", "endian", "encoding"):
        yield f"without-{field}.nrrd", nrrd(field, None), "is a broken NRRD|is an NRRD in no encoding"
    for kind in ("block", "float16", "string", "complex", "short short"):
        yield f"type-{kind}.nrrd", nrrd("type", kind), "holds “.*” values"
    for number, sizes in enumerate(
        ("6 5", "6 5 4 1 1", "6 5 x", "6 5 -4", "6.0 5 4", "6 5 99999999999999999999")
    ):
        yield f"sizes-{number}.nrrd", nrrd("sizes", sizes), "is a broken NRRD"
    yield "empty.nrrd", nrrd("sizes", "6 0 4"), "holds no voxels"
    for number, sizes in enumerate(("6 5 5", "6 50 4", "600 500 400")):
        yield f"promise-{number}.nrrd", nrrd("sizes", sizes), "is cut short"
    yield "enormous.nrrd", nrrd("sizes", "6 5 4000000000"), "is damaged: no volume can have"
    for encoding in ("hex", "ascii", "bzip2", "zstd"):
        yield f"encoding-{encoding}.nrrd", nrrd("encoding", encoding), "is an NRRD in "
    for number, data in enumerate((b"", b"\x1f\x8b", b"x" * 50, gzip.compress(SLICES.tobytes())[:40])):
        yield f"gzip-{number}.nrrd", nrrd("encoding", "gzip", data), "is damaged|is cut short"
    packed = gzip.compress(SLICES.tobytes() + bytes(1_000_000))
    yield "gzip-long.nrrd", nrrd("encoding", "gzip", packed[:-8] + bytes(8)), "is damaged"
    yield "gzip-short.nrrd", nrrd("encoding", "gz", gzip.compress(bytes(9))), "is cut short"
    for number, target in enumerate(("/etc/passwd", "../a.raw", "sub/a.raw", "..", "C:\\a.raw")):
        yield f"elsewhere-{number}.nhdr", nrrd("data file", target), "only a file in the same folder is read"
    yield "absent.nhdr", nrrd("data file", "absent.raw"), "needs the file “absent.raw”"
    yield "itself.nhdr", nrrd("data file", "itself.nhdr"), "points to itself"
    for target in ("LIST", "slice%03d.raw 1 4 1"):
        yield f"several-{target[:4]}.nhdr", nrrd("data file", target), "over several files"
    yield "lines.nrrd", nrrd("line skip", "3"), "skips lines or bytes"
    yield "bytes.nrrd", nrrd("byte skip", "-5"), "skips lines or bytes"
    yield "twice.nrrd", b"NRRD0004\ntype: short\ntype: short\n\n", "has the field “type” twice"
    yield "word.nrrd", b"NRRD0004\nhello\n\n", "line 2 of its header is not a field"
    yield "endless.nrrd", b"NRRD0004\n" + b"# comment\n" * 9000, "its header does not end"
    yield "version.nrrd", nrrd("x", None).replace(b"0004", b"0009"), "is not an NRRD of versions 1 to 5"


MHA = "ObjectType = Image\nNDims = 3\nDimSize = 6 5 4\nElementType = MET_SHORT\nElementDataFile = LOCAL"


def mha(name: str, value: str | None, data: bytes = SLICES.tobytes()) -> bytes:
    lines = [line for line in MHA.splitlines() if not line.startswith(f"{name} ")]
    if value is not None:
        lines.insert(len(lines) if name == "ElementDataFile" else 1, f"{name} = {value}")
    return "\n".join(lines).encode() + b"\n" + data


def metaimages() -> Iterator[Bad]:
    yield from cut("a.mha", mha("x", None), "is cut short|is a broken MetaImage|is empty")
    yield from strangers(".mha", "is a broken MetaImage")
    for field in ("NDims", "DimSize", "ElementType", "ElementDataFile"):
        yield f"without-{field}.mha", mha(field, None), "is a broken MetaImage|holds “” values"
    for kind in ("MET_STRING", "MET_HALF", "int", "MET_FLOAT_ARRAY"):
        yield f"type-{kind}.mha", mha("ElementType", kind), "holds “.*” values|holds several channels"
    yield "channels.mha", mha("ElementNumberOfChannels", "3"), "holds several channels"
    for number, sizes in enumerate(("6 5", "6 5 x", "6 5 -4", "6.0 5 4", "", "6 5 4 1", "9" * 30)):
        yield f"sizes-{number}.mha", mha("DimSize", sizes), "is a broken MetaImage"
    yield "empty.mha", mha("DimSize", "6 0 4"), "holds no voxels"
    for number, sizes in enumerate(("6 5 5", "6 50 4", "600 500 400")):
        yield f"promise-{number}.mha", mha("DimSize", sizes), "is cut short"
    yield "enormous.mha", mha("DimSize", "6 5 4000000000"), "is damaged: no volume can have"
    for number, dimensions in enumerate(("2", "4", "x", "-3")):
        yield f"dimensions-{number}.mha", mha("NDims", dimensions), "NDims and its DimSize do not agree"
    packed = zlib.compress(SLICES.tobytes())
    for number, data in enumerate((b"", b"x" * 50, packed[:20], zlib.compress(bytes(9)))):
        yield f"packed-{number}.mha", mha("CompressedData", "True", data), "is damaged|is cut short"
    for number, target in enumerate(("/etc/passwd", "../a.raw", "sub/a.raw", "..", "n" * 300)):
        yield (
            f"elsewhere-{number}.mhd",
            mha("ElementDataFile", target),
            "only a file in the same folder is read",
        )
    yield "absent.mhd", mha("ElementDataFile", "absent.raw"), "needs the file “absent.raw”"
    yield "itself.mhd", mha("ElementDataFile", "itself.mhd"), "points to itself"
    for target in ("LIST", "slice%03d.raw 1 4 1"):
        yield f"several-{target[:4]}.mhd", mha("ElementDataFile", target), "over several files"
    yield "text.mha", mha("BinaryData", "False"), "holds its voxels as text"
    for number, size in enumerate(("x", "-2", "99999999")):
        yield f"header-{number}.mha", mha("HeaderSize", size), "cannot have the size|is cut short"
    yield (
        "twice.mha",
        mha("x", None).replace(b"NDims = 3", b"NDims = 3\nNDims = 3"),
        "has the field “ndims” twice",
    )


def patched(name: str, place: int, kind: str, *values: float) -> bytes:
    data = bytearray((FOREIGN / name).read_bytes())
    struct.pack_into("<" + kind, data, place, *values)
    return bytes(data)


def niftis() -> Iterator[Bad]:
    one, two = (FOREIGN / "nib1.nii").read_bytes(), (FOREIGN / "nib2.nii").read_bytes()
    yield from cut("one.nii", one, "is not a NIfTI|is cut short|is empty")
    yield from cut(
        "one.nii.gz", gzip.compress(one, mtime=0), "is not a NIfTI|is cut short|is damaged|is empty"
    )
    yield from strangers(".nii", "is not a NIfTI file")
    for code, sentence in (
        (32, "complex"),
        (128, "colours"),
        (1536, "128 bits"),
        (1792, "complex"),
        (2304, "colours"),
        (1, "bits"),
    ):
        yield f"type-{code}.nii", patched("nib1.nii", 70, "h", code), f"holds .*{sentence}"
    for code in (0, 3, -1, 999):
        yield f"type-{code}.nii", patched("nib1.nii", 70, "h", code), "there is no type of number"
    for dimensions in (0, -3, 8, 32000):
        yield f"dimensions-{dimensions}.nii", patched("nib1.nii", 40, "h", dimensions), "it cannot have"
    yield "flat.nii", patched("nib1.nii", 40, "h", 2), "is not a volume: its shape"
    yield "times.nii", patched("nib1.nii", 40, "5h", 4, 6, 5, 2, 2), "is not a volume: its shape"
    for axis in (1, 2, 3):
        yield f"empty-{axis}.nii", patched("nib1.nii", 40 + 2 * axis, "h", 0), "holds no voxels"
        yield f"negative-{axis}.nii", patched("nib1.nii", 40 + 2 * axis, "h", -7), "holds no voxels"
        yield f"promise-{axis}.nii", patched("nib1.nii", 40 + 2 * axis, "h", 30000), "is cut short"
        yield (
            f"enormous-{axis}.nii",
            patched("nib2.nii", 16 + 8 * axis, "q", 2**40),
            "is damaged: no volume can have",
        )
    for number, offset in enumerate((-352.0, 12.0, 352.5, 1e30, float("nan"), float("inf"))):
        yield f"offset-{number}.nii", patched("nib1.nii", 108, "f", offset), "voxels cannot begin at byte"
    yield "beyond.nii", patched("nib1.nii", 108, "f", 5000.0), "is cut short"
    yield "pair.nii", one[:344] + b"ni1\0" + one[348:], "keeps its voxels in a second file"
    yield "analyze.nii", one[:344] + bytes(4) + one[348:], "its signature is missing"
    yield "pair2.nii", two[:4] + b"ni2" + two[7:], "keeps its voxels in a second file"
    yield "mangled.nii", two[:8] + b"\n\n\n\n" + two[12:], "signature is missing or damaged"


CORPORA = {"npy": npys, "nrrd": nrrds, "metaimage": metaimages, "nifti": niftis}


def refusal(path: Path, raw: RawLayout | None = None) -> str:
    """The sentence that a volume is refused with when its header is read, or its first slice."""

    def read() -> None:
        describe_volume(path, raw=raw)
        source = open_slabs(path, voxel_size=1.0, kind="grey", raw=raw)
        source.read(0, source.shape[2])

    with pytest.raises(FileError) as caught:
        read()
    sentence = str(caught.value)
    assert sentence.startswith(path.name), sentence
    assert sentence.endswith("."), sentence
    assert "\n" not in sentence, sentence
    assert len(sentence) < 250, sentence
    return sentence.removeprefix(path.name).strip()


@pytest.mark.parametrize("key", CORPORA)
def test_that_each_broken_volume_is_refused_with_the_sentence_of_its_kind(key, tmp_path) -> None:
    corpus = list(CORPORA[key]())
    assert len(corpus) >= 40
    for name, data, pattern in corpus:
        (tmp_path / name).write_bytes(data)
        sentence = refusal(tmp_path / name)
        assert re.search(pattern, sentence), (name, sentence)


@pytest.mark.parametrize("kind", ["uint8", "int16", "float32", "float64"])
@pytest.mark.parametrize("shape", [(6, 5, 4), (600, 5, 4), (1, 1, 1)])
@pytest.mark.parametrize("surplus", [-1, 1, 7, 100000])
def test_that_a_raw_file_of_another_length_is_refused(kind, shape, surplus, tmp_path) -> None:
    """48 files: one byte too many is as wrong as one too few, for then the shape is not what it is."""
    path = tmp_path / "a.raw"
    path.write_bytes(bytes(max(0, int(np.prod(shape)) * np.dtype(kind).itemsize + surplus)))
    if path.stat().st_size:
        assert "voxels of" in refusal(path, RawLayout(shape, kind))
    else:
        assert "is empty" in refusal(path, RawLayout(shape, kind))


def test_that_a_slice_larger_than_a_gibibyte_is_refused(tmp_path) -> None:
    path = tmp_path / "wide.raw"
    with path.open("wb") as file:
        file.truncate(40000 * 40000)
    assert "has slices of 1.49 GiB" in refusal(path, RawLayout((40000, 40000, 1), "uint8"))


def test_that_the_good_files_behind_the_broken_ones_are_read(tmp_path) -> None:
    """Else every refusal above would prove nothing."""
    good = {"a.npy": npy("{'descr': '<i2', 'fortran_order': False, 'shape': (4, 5, 6), }\n")}
    good |= {"a.nrrd": nrrd("x", None), "a.mha": mha("x", None)}
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
    assert "is damaged: its compressed voxels" in refusal(tmp_path / name)
