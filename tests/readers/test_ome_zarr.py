"""OME-Zarr as zarr writes it: voxels, edges and levels right, 40 and more broken ones refused."""

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr
from zarr.codecs import BloscCodec, GzipCodec, ZstdCodec

from regolith_studio.jobs.extraction_jobs import volume_sha256
from regolith_studio.readers.volume_formats.ome_zarr import FORMAT
from regolith_studio.readers.volumes import read as slabs
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume
from regolith_studio.readers.voxels.header import VoxelHeader
from regolith_studio.session.file_kinds import FileKind, kind_of
from tests.readers.mutations import check_answers, check_refused
from tests.readers.test_txm import marked
from tests.readers.test_volume_mutations import answer_of, sandboxed_answer_of

SHAPE = (9, 10, 11)
EDGES = {"z": 5.0, "y": 2.0, "x": 1.5, "c": 1.0, "t": 1.0}
VERSIONS = {"0.4": 2, "0.5": 3}
Document = dict[str, Any]
Write = Callable[[Path, dict[str, Path]], None]
"""Writes a broken image to a path, from the whole ones of each version."""


def multiscales(axes: str, levels: int, unit: str | None = "micrometer") -> list[Document]:
    """The metadata of an image, as the specification writes them."""
    kinds = {"c": "channel", "t": "time"}
    entries = [{"name": axis, "type": kinds.get(axis, "space")} for axis in axes]
    for entry in entries:
        if unit and entry["type"] == "space":
            entry["unit"] = unit
    datasets = [
        {"path": f"s{k}", "coordinateTransformations": [
            {"type": "scale", "scale": [EDGES[a] * (2**k if a in "zyx" else 1) for a in axes]},
            {"type": "translation", "translation": [0.0 for _ in axes]},
        ]}
        for k in range(levels)
    ]  # fmt: skip
    return [{"name": "scan", "axes": entries, "datasets": datasets}]


def ome_zarr(
    path: Path, version: str = "0.4", array: np.ndarray | None = None, axes: str = "zyx", **options: Any
) -> Path:
    """An image of two levels, the second of every other voxel."""
    array = marked(SHAPE) if array is None else array
    unit = options.pop("unit", "micrometer")
    group = zarr.create_group(path, zarr_format=VERSIONS[version])
    image = multiscales(axes, 2, unit)
    group.attrs.update(
        {"multiscales": image} if version == "0.4" else {"ome": {"version": version, "multiscales": image}}
    )
    step = tuple(slice(None, None, 2 if axis in "zyx" else None) for axis in axes)
    for name, level in (("s0", array), ("s1", array[step])):
        chunks = options.get("chunks") or tuple(min(4, edge) for edge in level.shape)
        group.create_array(name, data=level, **{**options, "chunks": chunks})
    return path


@pytest.mark.parametrize(
    ("version", "options"),
    [
        ("0.4", {}),
        ("0.4", {"compressors": None}),
        ("0.4", {"chunks": (1, 10, 11)}),
        ("0.5", {}),
        ("0.5", {"compressors": [BloscCodec(cname="lz4")]}),
        ("0.5", {"compressors": [GzipCodec(level=5)], "chunks": (9, 10, 11)}),
        ("0.5", {"compressors": [ZstdCodec(checksum=True)]}),
        ("0.5", {"chunks": (2, 3, 4), "shards": (4, 6, 8)}),
    ],
)
@pytest.mark.parametrize("dtype", ["uint8", "uint16", "float32"])
def test_that_every_voxel_is_in_its_place_with_its_edges(
    version: str, options: Document, dtype: str, tmp_path: Path
) -> None:
    slices = marked(SHAPE, dtype)
    path = ome_zarr(tmp_path / "scan.zarr", version, slices, **options)
    header = describe_volume(path)
    assert (header.shape, header.dtype, header.unit) == (SHAPE[::-1], np.dtype(dtype), "um")
    assert header.voxel_size == (1.5, 2.0, 5.0)
    assert np.array_equal(read_volume(path, kind="grey").array.T, slices)
    assert np.array_equal(open_slabs(path, kind="grey").read(3, 7).T, slices[3:7])


@pytest.mark.parametrize("version", VERSIONS)
def test_that_a_coarser_level_can_be_chosen(version: str, tmp_path: Path) -> None:
    path = ome_zarr(tmp_path / "scan.zarr", version)
    header = describe_volume(path)
    assert [(each.name, each.shape) for each in header.datasets] == [("s0", (11, 10, 9)), ("s1", (6, 5, 5))]
    coarse = read_volume(path, dataset="s1", kind="grey")
    assert np.array_equal(coarse.array.T, marked(SHAPE)[::2, ::2, ::2])
    assert coarse.voxel_size.tolist() == [3.0, 4.0, 10.0]


@pytest.mark.parametrize("axes", ["tczyx", "czyx", "zyxc", "xyz", "tzyx"])
def test_that_axes_are_told_by_their_names_and_channels_are_volumes(axes: str, tmp_path: Path) -> None:
    edges = dict(zip("zyx", SHAPE, strict=True)) | {"c": 2, "t": 1}
    array = np.zeros([edges[axis] for axis in axes], np.uint16)
    for channel in range(2 if "c" in axes else 1):
        picked = tuple({"c": channel, "t": 0}.get(axis, slice(None)) for axis in axes)
        order = [axis for axis in axes if axis in "zyx"]
        array[picked] = (marked(SHAPE) + 100 * channel).transpose(["zyx".index(axis) for axis in order])
    path = ome_zarr(tmp_path / "scan.zarr", array=array, axes=axes)
    last = 1 if "c" in axes else 0
    volume = read_volume(path, dataset=f"s0[{last}]" if last else "s0", kind="grey")
    assert np.array_equal(volume.array.T, marked(SHAPE) + 100 * last)
    assert volume.voxel_size.tolist() == [1.5, 2.0, 5.0]


def test_that_units_scales_and_labels_are_those_of_the_file(tmp_path: Path) -> None:
    path = ome_zarr(tmp_path / "mm.zarr", unit="millimeter")
    attributes = json.loads((path / ".zattrs").read_text())
    attributes["multiscales"][0]["coordinateTransformations"] = [{"type": "scale", "scale": [0.5, 0.5, 2]}]
    attributes["image-label"] = {"version": "0.4"}
    (path / ".zattrs").write_text(json.dumps(attributes))
    header = describe_volume(path)
    assert (header.voxel_size, header.unit, header.kind) == ((3.0, 1.0, 2.5), "mm", "labels")
    bare = describe_volume(ome_zarr(tmp_path / "bare.zarr", "0.5", unit=None))
    assert (bare.voxel_size, bare.unit) == ((1.5, 2.0, 5.0), None)


def test_that_a_folder_of_zarr_is_a_volume_with_one_fingerprint(tmp_path: Path) -> None:
    path = ome_zarr(tmp_path / "scan.zarr")
    assert volume_files(path) == volume_files(tmp_path) == (path,)
    assert kind_of(path) is FileKind.VOLUME
    before = volume_sha256(path)
    zarr.open_array(path / "s0", mode="r+")[0, 0, 0] = 77
    assert volume_sha256(path) != before


def test_that_absent_chunks_hold_the_fill_value(tmp_path: Path) -> None:
    path = ome_zarr(tmp_path / "scan.zarr", "0.5", fill_value=7)
    (path / "s0" / "c" / "0" / "0" / "0").unlink()
    expected = marked(SHAPE)
    expected[:4, :4, :4] = 7
    assert np.array_equal(read_volume(path, kind="grey").array.T, expected)


@pytest.mark.parametrize("axes", ["zyx", "xyz"])
def test_that_a_layer_of_chunks_is_unpacked_once_for_all_its_slices(
    axes: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    slices = marked(SHAPE)
    stored = slices if axes == "zyx" else slices.T
    volume = FORMAT.open(ome_zarr(tmp_path / "scan.zarr", array=stored, axes=axes, chunks=(4, 4, 4)), {})
    unpacked: list[tuple[int, int]] = []
    unpack = volume._unpacked
    monkeypatch.setattr(volume, "_unpacked", lambda *part: unpacked.append(part) or unpack(*part))
    for z in range(SHAPE[0]):
        assert np.array_equal(volume.read(z, z + 1), slices[z : z + 1])
    assert np.array_equal(volume.read(1, 6), slices[1:6])  # of two layers: not kept
    assert np.array_equal(volume.read(4, 8), slices[4:8])
    assert unpacked == [(0, 4), (4, 8), (8, 9), (1, 6), (4, 8)]


def test_that_pieces_end_where_deep_layers_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(slabs, "SLAB_BYTES", 30)
    monkeypatch.setattr(slabs, "MAX_LAYER_BYTES", 60)
    header = VoxelHeader((16, 2, 5), np.dtype(np.uint8))
    deep = slabs.SlabReader(Path("a"), {}, header, "ome_zarr", False, 7)
    assert list(deep.pieces(0, 16)) == [(0, 3), (3, 6), (6, 7), (7, 10), (10, 13), (13, 14), (14, 16)]


def changed(version: str, file: str, change: Callable[[Any], object]) -> Write:
    """An image with other metadata."""

    def write(path: Path, whole: dict[str, Path]) -> None:
        document = json.loads((Path(shutil.copytree(whole[version], path)) / file).read_text())
        change(document)
        (path / file).write_text(json.dumps(document))

    return write


def replaced(version: str, file: str, data: bytes | None) -> Write:
    """An image of which one file holds something else, or is not there."""

    def write(path: Path, whole: dict[str, Path]) -> None:
        (Path(shutil.copytree(whole[version], path)) / file).unlink()
        if data is not None:
            (path / file).write_bytes(data)

    return write


def linked(file: str) -> Write:
    def write(path: Path, whole: dict[str, Path]) -> None:
        target = path.with_name("elsewhere")
        target.write_bytes((Path(shutil.copytree(whole["0.4"], path)) / file).read_bytes())
        (path / file).unlink()
        (path / file).symlink_to(target)

    return write


def bad_images() -> Iterator[tuple[Write, str]]:
    for version, file in (("0.4", ".zattrs"), ("0.5", "zarr.json")):
        for data in (b"", b"{", b"[]", b"\xff" * 9, b"[" * 100_000):
            yield replaced(version, file, data), "holds no metadata"
    for version, file in (("0.4", "s0/.zarray"), ("0.5", "s0/zarr.json")):
        for data in (b"", b"7", b'{"shape": 1}', b"{}"):
            yield replaced(version, file, data), "holds no metadata|incomplete or wrong"
        yield replaced(version, file, None), "is not there"
    yield replaced("0.4", ".zattrs", b"{}"), "describes no image"
    yield replaced("0.4", ".zattrs", b'{"bioformats2raw.layout": 3}'), "holds several images"
    chunk04, chunk05 = "s0/0.0.0", "s0/c/0/0/0"
    for version, chunk in (("0.4", chunk04), ("0.5", chunk05)):
        for data in (b"", b"\0", b"\xff" * 300, bytes(2000)):
            yield replaced(version, chunk, data), "cannot be unpacked"
    for file in (".zattrs", "s0/.zarray", chunk04):
        yield linked(file), "link out of its folder"

    def image(document: Document) -> Document:
        return document["multiscales"][0]

    def scale(document: Document) -> Document:
        return image(document)["datasets"][0]["coordinateTransformations"][0]

    for change, pattern in (
        (lambda d: image(d).update(axes=[]), "has the axes"),
        (lambda d: image(d).update(axes=["z", "y"]), "has the axes"),
        (lambda d: image(d).update(axes=["z", "y", "y"]), "has the axes"),
        (lambda d: image(d).update(axes=["t", "z", "y", "x"]), "has not the axes"),
        (lambda d: image(d).update(datasets=[]), "describes no image"),
        (lambda d: image(d).update(datasets=7), "describes no image"),
        (lambda d: image(d)["datasets"][0].update(path="../s0"), "place of one of its levels"),
        (lambda d: image(d)["datasets"][0].update(path="/etc"), "place of one of its levels"),
        (lambda d: image(d)["datasets"][0].update(path="s7"), "is not there"),
        (lambda d: scale(d).update(scale=[1, 2]), "scales are not"),
        (lambda d: scale(d).update(scale=["a"] * 3), "scales are not"),
        (lambda d: d.update(multiscales={}), "describes no image"),
    ):  # fmt: skip
        yield changed("0.4", ".zattrs", change), pattern
    for change, pattern in (
        (lambda d: d.update(filters=[{"id": "pickle"}]), "packed by “pickle”"),
        (lambda d: d["compressor"].update(id="jpeg2k"), "packed by “jpeg2k”"),
        (lambda d: d.update(dtype="|O"), "Python objects|incomplete or wrong"),
        (lambda d: d.update(dtype="<c8"), "complex numbers"),
        (lambda d: d.update(dtype="<f4"), "cannot be unpacked|contradict"),
        (lambda d: d.update(dtype=[["a", "<i4"]]), "incomplete or wrong"),
        (lambda d: d.update(shape=[9, 10]), "incomplete or wrong"),
        (lambda d: d.update(shape=[9, 10, -1]), "incomplete or wrong"),
        (lambda d: d.update(shape=[9, 10, 2**40]), "no volume can have"),
        (lambda d: d.update(chunks=[0, 4, 4]), "incomplete or wrong"),
        (lambda d: d.update(chunks=[2000, 2000, 2000]), "more than 0.5 GiB"),
        (lambda d: d.update(order="Q"), "metadata are invalid"),
    ):  # fmt: skip
        yield changed("0.4", "s0/.zarray", change), pattern
    yield changed("0.5", "s0/zarr.json", lambda d: d.update(codecs=[{"name": "vlen-utf8"}])), "packed by"


def test_that_each_broken_image_is_refused_with_the_sentence_of_its_kind(tmp_path: Path) -> None:
    whole = {version: ome_zarr(tmp_path / f"whole-{version}.zarr", version) for version in VERSIONS}
    corpus = list(bad_images())
    assert len(corpus) >= 40
    for number, (write, pattern) in enumerate(corpus):
        path = tmp_path / f"{number}.zarr"
        write(path, whole)
        check_refused(path, pattern)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("version", "file"),
    [("0.4", ".zattrs"), ("0.4", "s0/.zarray"), ("0.4", "s0/0.0.0"), ("0.5", "zarr.json"),
     ("0.5", "s0/zarr.json"), ("0.5", "s0/c/0/0/0")],
)  # fmt: skip
def test_that_mutations_give_voxels_or_a_sentence(version: str, file: str, tmp_path: Path) -> None:
    """Through the sandbox: codecs are compiled, and some read beyond the end of a broken chunk."""
    path = ome_zarr(tmp_path / "scan.zarr", version)
    check_answers(path / file, lambda: sandboxed_answer_of(path), count=60)


def test_that_a_missing_library_is_named_with_its_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = ome_zarr(tmp_path / "scan.zarr")
    monkeypatch.setitem(__import__("sys").modules, "zarr", None)
    assert answer_of(path) == 'is Zarr, which needs zarr, an extra: pip install "regolith-studio[zarr]".'


@pytest.mark.parametrize("version", ["0.4", "0.5"])
def test_that_the_coarser_level_of_a_volume_is_found_and_lies_where_it_does(
    tmp_path: Path, version: str
) -> None:
    volume = open_slabs(ome_zarr(tmp_path / "scan.zarr", version))
    level = volume.coarser(most_voxels=10**6)
    assert level is not None
    assert level.shape == (6, 5, 5)
    assert np.array(level.voxel_size) * level.shape == pytest.approx(
        np.array(volume.voxel_size) * volume.shape
    )
    assert volume.coarser(most_voxels=10) is None
    assert level.coarser(most_voxels=10**6) is None
