"""Texts that scanners write beside their voxels: sizes and places right, and lies refused."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import tifffile

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume
from tests.readers.mutations import check_answers, check_sentence
from tests.readers.test_txm import marked
from tests.readers.test_volume_mutations import answer_of

SHAPE = (4, 5, 6)
VGI = """{volume1}
[representation]
size = 6 5 4
datatype = unsigned integer
bitsperelement = 8
[file1]
FileFormat = raw
Size = 6 5 4
Name = scan.vol
Datatype = unsigned integer
BitsPerElement = 16
{volumeprimitive12}
[geometry]
resolution = 0.0005 0.001 0.002
unit = mm
"""
INFO = """! PyHST_SLAVE VOLUME INFO FILE
NUM_X =  6
NUM_Y =  5
NUM_Z =  4
voxelSize =  1.5
BYTEORDER = HIGHBYTEFIRST
"""
XTEKCT = """[XTekCT]
Name=scan
VoxelsX=6
VoxelsY=5
VoxelsZ=4
VoxelSizeX=0.0005
VoxelSizeY=0.001
VoxelSizeZ=0.002
"""
CASES = {
    "scan.vgi": (VGI, "<u2", (0.0005, 0.001, 0.002), "mm"),
    "scan.vol.info": (INFO, ">f4", (1.5, 1.5, 1.5), "um"),
    "scan.xtekct": (XTEKCT, "<f4", (0.0005, 0.001, 0.002), "mm"),
}


def written(folder: Path, name: str, text: str | None = None, surplus: int = 0) -> Path:
    data = marked(SHAPE).astype(CASES[name][1]).tobytes()
    (folder / "scan.vol").write_bytes(data + bytes(surplus) if surplus >= 0 else data[:surplus])
    (folder / name).write_text(CASES[name][0] if text is None else text)
    return folder / name


@pytest.mark.parametrize("name", CASES)
def test_that_every_voxel_is_in_its_place_with_its_edges(name, tmp_path) -> None:
    path = written(tmp_path, name)
    for opened in (path, tmp_path / "scan.vol"):
        header = describe_volume(opened)
        assert (header.shape, header.unit) == (SHAPE[::-1], CASES[name][3])
        assert header.voxel_size == pytest.approx(CASES[name][2])
        assert np.array_equal(read_volume(opened, kind="grey").array.T, marked(SHAPE))
        assert np.array_equal(open_slabs(opened, kind="grey").read(1, 3).T, marked(SHAPE)[1:3])
    assert volume_files(tmp_path) == (path,)


@pytest.mark.parametrize("dtype", ["<u1", "<u2", "<f4"])
def test_that_the_length_of_the_file_of_a_nikon_says_its_type(dtype, tmp_path) -> None:
    (tmp_path / "scan.xtekct").write_text(XTEKCT)
    (tmp_path / "scan.vol").write_bytes(marked(SHAPE).astype(dtype).tobytes())
    volume = read_volume(tmp_path / "scan.xtekct", kind="grey")
    assert volume.array.dtype == np.dtype(dtype)
    assert np.array_equal(volume.array.T, marked(SHAPE))


@pytest.mark.parametrize(
    ("bits", "kind", "dtype"),
    [
        (8, "unsigned integer", "u1"),
        (16, "signed integer", "i2"),
        (32, "float", "f4"),
        (32, "", "f4"),
        (8, "", "u1"),
    ],
)
def test_that_vgstudio_states_the_type(bits, kind, dtype, tmp_path) -> None:
    text = (
        f"{{volume1}}\n[representation]\nsize = 6 5 4\nbitsperelement = {bits}\n[file1]\nname = ./scan.vol\n"
    )
    (tmp_path / "scan.vgi").write_text(text + (f"datatype = {kind}\n" if kind else ""))
    (tmp_path / "scan.vol").write_bytes(marked(SHAPE).astype(dtype).tobytes())
    volume = read_volume(tmp_path / "scan.vgi", voxel_size=1.0, kind="grey")
    assert volume.array.dtype == np.dtype(dtype)
    assert np.array_equal(volume.array.T, marked(SHAPE))


@pytest.mark.parametrize("lines", [["[Acquisition]", "Image Pixel Size (um)=7.5"],
                                   ["[Acquisition]", "Image Pixel Size (um)=9", "[Reconstruction]",
                                    "Pixel Size (um)=7.5", "Section to Section Step=2"]])  # fmt: skip
def test_that_the_log_of_a_skyscan_gives_the_size_of_its_slices(lines, tmp_path) -> None:
    for number, image in enumerate(marked(SHAPE)):
        tifffile.imwrite(tmp_path / f"sand_rec{number:08}.tif", image)
    (tmp_path / "other_rec.log").write_text("[Reconstruction]\nPixel Size (um)=1\n")
    (tmp_path / "sand_rec.log").write_text("\n".join(lines))
    header = describe_volume(tmp_path)
    assert header.voxel_size == pytest.approx((7.5, 7.5, 15.0 if len(lines) > 2 else 7.5))
    assert header.unit == "um"
    assert np.array_equal(read_volume(tmp_path, kind="grey").array.T, marked(SHAPE))


@pytest.mark.parametrize("text", ["[Reconstruction]", "[Reconstruction]\nPixel Size (um)=none"])
def test_that_a_log_of_other_slices_or_without_a_size_leaves_it_open(text, tmp_path) -> None:
    for number, image in enumerate(marked(SHAPE)):
        tifffile.imwrite(tmp_path / f"sand_rec{number:08}.tif", image)
    (tmp_path / "other_rec.log").write_text("[Reconstruction]\nPixel Size (um)=1\n")
    (tmp_path / "sand_rec.log").write_text(text)
    assert describe_volume(tmp_path).voxel_size is None


def test_that_a_log_that_is_no_text_is_named(tmp_path) -> None:
    for number, image in enumerate(marked(SHAPE)):
        tifffile.imwrite(tmp_path / f"sand_rec{number:08}.tif", image)
    (tmp_path / "sand_rec.log").write_bytes(bytes(9))
    with pytest.raises(
        FileError, match=r"has the log sand_rec\.log beside its slices, which is not the text"
    ):
        describe_volume(tmp_path)


def without(text: str, field: str) -> str:
    return "\n".join(line for line in text.splitlines() if not line.lower().startswith(field.lower()))


def lies() -> Iterator[tuple[str, str, int, str]]:
    """Header, text, surplus bytes of the voxels, and what the sentence must say."""
    for name, (text, *_) in CASES.items():
        for surplus in (-1, 1, -100, 1000):
            yield name, text, surplus, r"describes scan\.vol, which has .* bytes, but 6 × 5 × 4 voxels"
        for wrong in ("-6", "6.0", "six", "9" * 30, "0x6"):
            changed = re.sub(r"(?im)^(size|num_x|voxelsx)(\s*=\s*)\d+", rf"\g<1>\g<2>{wrong}", text)
            yield name, changed, 0, "is not whole numbers"
        for number, pattern in ((0, "holds no voxels"), (9**9, "no volume can have"), (7, "which has")):
            changed = re.sub(r"(?im)^(size|num_x|voxelsx)(\s*=\s*)\d+", rf"\g<1>\g<2>{number}", text)
            yield name, changed, 0, pattern
        yield name, "dear diary\n" * 40, 0, "states voxels of an unknown type|has no field"
        yield name, "a\0b", 0, "is not the text of a scanner"
        yield name, "x\n" * 600_000, 0, "is not the text of a scanner"
    for field in ("num_x", "num_y", "num_z"):
        yield "scan.vol.info", without(INFO, field), 0, f"no field “{field}”"
        yield "scan.xtekct", without(XTEKCT, field.replace("num_", "voxels") + "="), 0, "no field “voxels"
    yield "scan.vol.info", INFO.replace("HIGHBYTEFIRST", "MIDDLE"), 0, "unknown byte order"
    for target in ("/etc/passwd", "../scan.vol", "sub/scan.vol", "..", r"C:\\a.vol"):
        yield "scan.vgi", VGI.replace("scan.vol", target), 0, "only a file in the same folder is read"
    yield "scan.vgi", VGI.replace("scan.vol", "absent.vol"), 0, "needs the file “absent.vol”"
    yield "scan.vgi", VGI.replace("scan.vol", "scan.vgi"), 0, "points to itself"
    for changed in (VGI + "[file2]\nName = b.vol\n", VGI + "{volume2}\n"):
        yield "scan.vgi", changed, 0, "describes several volumes"
    for bits in ("12", "0", "-16", "x"):
        yield "scan.vgi", VGI.replace("= 16", f"= {bits}"), 0, "states voxels of an unknown type"
    yield "scan.vgi", VGI.replace("unsigned integer", "colour"), 0, "unknown type: “colour”"
    yield "scan.vgi", re.sub(r"(?i)size = .*\n", "", VGI), 0, "is not a volume"
    yield "scan.vgi", re.sub(r"(?i)size = .*\n", "size = 6 5\n", VGI), 0, "is not a volume"
    yield "scan.vgi", without(VGI, "name"), 0, "no field “name”"


def test_that_each_header_that_lies_is_refused_with_the_sentence_of_its_kind(tmp_path) -> None:
    corpus = list(lies())
    assert len(corpus) > 60
    for number, (name, text, surplus, pattern) in enumerate(corpus):
        folder = tmp_path / str(number)
        folder.mkdir()
        path = written(folder, name, text, surplus)
        with pytest.raises(FileError) as caught:
            describe_volume(path)
        sentence = str(caught.value)
        check_sentence(sentence)
        assert sentence.startswith(name), sentence
        assert re.search(pattern, sentence), (text[:200], sentence)


@pytest.mark.parametrize("name", CASES)
def test_that_four_hundred_mutations_give_voxels_or_a_sentence(name, tmp_path) -> None:
    path = written(tmp_path, name)
    check_answers(path, lambda: answer_of(path))
