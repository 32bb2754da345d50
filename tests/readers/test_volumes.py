"""Volumes come in voxel for voxel, whatever they were written as; other programs wrote the files."""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
import tifffile
from scipy import ndimage

from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.particles import read_mesh
from regolith_studio.readers.volume_formats import volume_suffixes
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.readers.volumes.header import RawLayout, guess_kind, layout_from_name
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume

SLICES = np.random.default_rng(5).integers(0, 60_000, (7, 11, 13)).astype(np.uint16)
"""Indexed [z, y, x]."""

TYPES = ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8", "b1"]


def typed(kind: str, order: str = "<") -> np.ndarray:
    """The slices as another type."""
    return (SLICES % 100).astype(np.dtype(kind).newbyteorder(order))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind", TYPES)
def test_that_an_npy_of_any_type_and_byte_order_keeps_its_values(kind, order, tmp_path) -> None:
    path = tmp_path / "a.npy"
    np.save(path, typed(kind, order))
    volume = read_volume(path, voxel_size=2.0, kind="grey")
    assert volume.shape == (13, 11, 7)
    assert volume.array.dtype == np.dtype(kind)
    assert np.array_equal(volume.array.T, typed(kind))


def test_that_an_npy_in_fortran_order_is_read_by_its_indices(tmp_path) -> None:
    np.save(tmp_path / "f.npy", np.asfortranarray(SLICES))
    assert np.array_equal(read_volume(tmp_path / "f.npy", voxel_size=1.0).array.T, SLICES)
    assert np.array_equal(open_slabs(tmp_path / "f.npy", voxel_size=1.0).read(2, 5).T, SLICES[2:5])


@pytest.mark.parametrize("order", ["little", "big"])
@pytest.mark.parametrize("kind", ["uint8", "int16", "uint16", "float32"])
def test_that_a_raw_file_is_read_as_the_caller_says(kind, order, tmp_path) -> None:
    path = tmp_path / "a.raw"
    slices = (SLICES % 100).astype(np.dtype(kind).newbyteorder("<" if order == "little" else ">"))
    path.write_bytes(b"header" + slices.tobytes())
    layout = RawLayout((13, 11, 7), kind, order, offset=6)
    assert np.array_equal(read_volume(path, voxel_size=1.0, raw=layout).array.T, SLICES % 100)


@pytest.mark.parametrize(
    "options",
    [
        {"shape": (3, 4)},
        {"shape": (3, 4, 0)},
        {"shape": (3, 4, 5), "dtype": "uint7"},
        {"shape": (3, 4, 5), "dtype": "object"},
        {"shape": (3, 4, 5), "byte_order": "middle"},
        {"shape": (3, 4, 5), "offset": -1},
    ],
)
def test_that_a_raw_layout_that_no_file_can_have_is_refused(options) -> None:
    with pytest.raises(InputError):
        RawLayout(**options)


CODECS = [None, "lzw", "zlib", "packbits", "zstd", "lzma"]


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize("options", [{}, {"bigtiff": True}, {"byteorder": ">"}, {"tile": (16, 16)}], ids=str)
def test_that_a_tiff_stack_of_any_codec_comes_in(codec, options, tmp_path) -> None:
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, SLICES, compression=codec, photometric="minisblack", **options)
    assert np.array_equal(read_volume(path, voxel_size=1.0).array.T, SLICES)


@pytest.mark.parametrize("kind", ["u1", "i2", "u4", "f4", "f8"])
@pytest.mark.parametrize("predictor", [False, True])
def test_that_a_compressed_tiff_of_any_type_comes_in(kind, predictor, tmp_path) -> None:
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, typed(kind), compression="zlib", predictor=predictor, photometric="minisblack")
    assert np.array_equal(read_volume(path, voxel_size=1.0, kind="grey").array.T, typed(kind))


def test_that_imagej_states_the_voxel_size(tmp_path) -> None:
    path = tmp_path / "a.tif"
    metadata = {"axes": "ZYX", "spacing": 3.0, "unit": "um"}
    tifffile.imwrite(path, SLICES, imagej=True, resolution=(1 / 1.5, 1 / 2.0), metadata=metadata)
    header = describe_volume(path)
    assert header.voxel_size == pytest.approx((1.5, 2.0, 3.0))
    assert header.unit == "um"
    assert read_volume(path).voxel_size == pytest.approx([1.5, 2.0, 3.0])


def test_that_ome_states_the_voxel_size(tmp_path) -> None:
    path = tmp_path / "a.ome.tif"
    metadata = {
        "axes": "ZYX",
        "PhysicalSizeX": 450.0,
        "PhysicalSizeXUnit": "nm",
        "PhysicalSizeY": 450.0,
        "PhysicalSizeYUnit": "nm",
        "PhysicalSizeZ": 900.0,
        "PhysicalSizeZUnit": "nm",
    }
    tifffile.imwrite(path, SLICES, metadata=metadata)
    assert read_volume(path).voxel_size == pytest.approx([0.45, 0.45, 0.9])


def test_that_resolution_tags_count_unless_a_printer_would_want_them(tmp_path) -> None:
    fine, printer = tmp_path / "fine.tif", tmp_path / "printer.tif"
    options = {"photometric": "minisblack", "metadata": None, "resolutionunit": "CENTIMETER"}
    tifffile.imwrite(fine, SLICES, resolution=(4000, 4000), **options)
    tifffile.imwrite(printer, SLICES, resolution=(300 / 2.54, 300 / 2.54), **options)
    assert describe_volume(fine).micrometres() == pytest.approx((2.5, 2.5, 2.5))
    assert describe_volume(printer).voxel_size is None


@pytest.mark.parametrize("suffix", ["tif", "png", "bmp"])
def test_that_a_folder_of_numbered_slices_is_one_volume(suffix, tmp_path) -> None:
    import imagecodecs

    slices = (SLICES % 256).astype(np.uint8)
    for z, image in enumerate(slices):
        path = tmp_path / f"scan_{z + 5}_rec.{suffix}"
        if suffix == "tif":
            tifffile.imwrite(path, image, compression="lzw")
        else:
            path.write_bytes(getattr(imagecodecs, f"{suffix}_encode")(image))
    (tmp_path / "log.txt").write_text("not a slice")
    assert volume_files(tmp_path) == (tmp_path,)
    assert describe_volume(tmp_path).format == "slices"
    assert np.array_equal(read_volume(tmp_path, voxel_size=1.0).array.T, slices)


def test_that_any_other_folder_stands_for_the_volumes_in_it(tmp_path) -> None:
    for name in ("b.npy", "a10.npy", "a9.npy", "c.txt"):
        np.save(tmp_path / "x.npy", SLICES)
        (tmp_path / "x.npy").rename(tmp_path / name)
    assert [path.name for path in volume_files(tmp_path)] == ["a9.npy", "a10.npy", "b.npy"]


def test_that_an_empty_folder_is_refused(tmp_path) -> None:
    with pytest.raises(FileError, match="holds no volume"):
        volume_files(tmp_path)


def test_that_a_slice_of_another_size_is_named(tmp_path) -> None:
    for z in range(4):
        tifffile.imwrite(tmp_path / f"s{z}.tif", SLICES[0] if z != 2 else SLICES[0, :5])
    with pytest.raises(FileError, match=r"its slice s2\.tif has 13 × 5 pixels"):
        read_volume(tmp_path, voxel_size=1.0)


@pytest.fixture
def stack(tmp_path) -> Path:
    path = tmp_path / "stack.tif"
    tifffile.imwrite(path, SLICES, compression="zlib", photometric="minisblack")
    return path


def test_that_a_box_is_the_same_voxels_as_a_part_of_the_whole(stack) -> None:
    part = read_volume(stack, voxel_size=1.0, bounds=((2, 9), (1, 4), (3, 6)))
    assert np.array_equal(part.array, SLICES.T[2:9, 1:4, 3:6])


@pytest.mark.parametrize(
    "bounds", [((0, 14), (0, 1), (0, 1)), ((3, 3), (0, 1), (0, 1)), ((-1, 3), (0, 1), (0, 1))]
)
def test_that_a_box_outside_the_volume_is_refused(stack, bounds) -> None:
    with pytest.raises(InputError, match="does not lie within"):
        read_volume(stack, voxel_size=1.0, bounds=bounds)


def test_that_slabs_are_the_slices_in_turn(stack) -> None:
    source = open_slabs(stack, voxel_size=(1.0, 2.0, 3.0), kind="grey")
    assert (source.shape, source.dtype, source.voxel_size) == ((13, 11, 7), np.uint16, (1.0, 2.0, 3.0))
    assert np.array_equal(np.concatenate([slab for _, slab in source.slabs(3)], axis=2), SLICES.T)
    assert [(z0, slab.shape[2]) for z0, slab in source.slabs(3)] == [(0, 3), (3, 3), (6, 1)]


def test_that_an_opened_volume_can_go_to_the_workers_of_a_pool(stack) -> None:
    source = open_slabs(stack, voxel_size=1.0, kind="grey")
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert np.array_equal(pool.submit(source.read, 2, 5).result(), SLICES.T[:, :, 2:5])


def test_that_progress_is_told_and_may_stop(stack) -> None:
    told = []
    read_volume(stack, voxel_size=1.0, on_progress=lambda done, total: told.append((done, total)))
    assert told == [(7, 7)]

    def stop(_done: int, _total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        read_volume(stack, voxel_size=1.0, on_progress=stop)


def test_that_a_volume_without_a_voxel_size_asks_for_one(stack) -> None:
    with pytest.raises(InputError, match=r"stack\.tif does not state the size of a voxel"):
        read_volume(stack)
    assert read_volume(stack, unit="voxel:2.5").voxel_size == pytest.approx([2.5] * 3)
    assert read_volume(stack, voxel_size=2.0, unit="mm").voxel_size == pytest.approx([2e3] * 3)


@pytest.mark.parametrize("size", [0.0, -1.0, float("nan"), (1.0, 2.0), (1.0, 2.0, 0.0)])
def test_that_a_voxel_size_that_is_none_is_refused(stack, size) -> None:
    with pytest.raises(InputError, match="A voxel has one edge"):
        read_volume(stack, voxel_size=size)


def test_that_a_wrong_suffix_is_told(stack) -> None:
    renamed = stack.with_suffix(".npy")
    stack.rename(renamed)
    assert describe_volume(renamed).notes[0] == "The file is named .npy but is a TIFF stack."


def balls(n: int, grey: bool) -> np.ndarray:
    """A grid of touching balls, each with its number, or as blurred noisy greys."""
    z, y, x = np.mgrid[:48, :48, :48]
    step = 48 // n
    near = (x % step - step / 2) ** 2 + (y % step - step / 2) ** 2 + (z % step - step / 2) ** 2 < (
        step / 2
    ) ** 2
    if not grey:
        return np.where(near, 1 + x // step + n * (y // step) + n * n * (z // step), 0).astype(np.int32)
    noise = np.random.default_rng(2).normal(0.0, 8.0, near.shape)
    return (ndimage.gaussian_filter(np.where(near, 180.0, 60.0), 0.8) + noise).clip(0, 255).astype(np.uint8)


def test_that_labels_and_greys_are_told_apart() -> None:
    assert guess_kind(balls(4, grey=False)) == "labels"
    assert guess_kind(balls(1, grey=False)) == "labels"
    assert guess_kind(balls(4, grey=True)) == "grey"
    assert guess_kind(np.where(balls(4, grey=False) > 0, 255, 0).astype(np.uint8)) == "grey"
    assert guess_kind(balls(4, grey=False).astype(np.float32)) == "labels"
    assert guess_kind(balls(4, grey=True) / 7.0) == "grey"
    assert guess_kind(np.zeros((4, 4, 4), np.uint8)) == "grey"
    without_noise = 1000 + 4000 * ndimage.gaussian_filter((balls(2, grey=False) > 0).astype(float), 0.8)
    assert guess_kind(np.pad(without_noise, 24, constant_values=1000).astype(np.uint16)) == "grey"


def test_that_labels_written_as_floats_become_whole_numbers(tmp_path) -> None:
    np.save(tmp_path / "a.npy", balls(4, grey=False).astype(np.float32))
    volume = read_volume(tmp_path / "a.npy", voxel_size=1.0)
    assert (volume.kind, volume.array.dtype) == ("labels", np.int64)


@pytest.mark.parametrize("dtype", [np.int16, np.int32, np.int64, np.float32])
def test_that_negative_labels_are_refused(dtype, tmp_path) -> None:
    labels = np.zeros((12, 20, 20), dtype=dtype)
    labels[:, 2:8, 2:8], labels[:, 10:16, 10:16] = 7, -5
    np.save(tmp_path / "a.npy", labels)
    assert describe_volume(tmp_path / "a.npy").kind == "labels"
    with pytest.raises(FileError, match=r"holds the label -5; labels are not negative"):
        read_volume(tmp_path / "a.npy", voxel_size=1.0)
    with pytest.raises(FileError, match=r"holds the label -5; labels are not negative"):
        open_slabs(tmp_path / "a.npy", voxel_size=1.0).read(0, 2)
    assert read_volume(tmp_path / "a.npy", voxel_size=1.0, kind="grey").array.min() == -5


def test_that_a_label_volume_with_fractions_is_refused(tmp_path) -> None:
    np.save(tmp_path / "a.npy", SLICES + 0.5)
    with pytest.raises(FileError, match="labels are whole numbers"):
        read_volume(tmp_path / "a.npy", voxel_size=1.0, kind="labels")


def test_that_a_file_that_becomes_another_one_is_read_anew(stack) -> None:
    read_volume(stack, voxel_size=1.0)
    tifffile.imwrite(stack, SLICES[:3] + 1, compression="lzw", photometric="minisblack")
    assert np.array_equal(read_volume(stack, voxel_size=1.0).array.T, SLICES[:3] + 1)


@pytest.mark.real_data
@pytest.mark.parametrize(
    ("name", "shape", "kind"),
    [
        ("cement140/labels_256.tif", (256, 256, 256), "labels"),
        ("volumes/cement_128x128x128.tif", (128, 128, 128), "grey"),
        ("volumes/shell_225x128x128.tif", (128, 128, 225), "grey"),
    ],
)
def test_that_real_volumes_come_in_as_what_they_are(name, shape, kind, real_data) -> None:
    header = describe_volume(real_data(name))
    assert (header.shape, header.kind) == (shape, kind)
    volume = read_volume(real_data(name), voxel_size=1.0)
    assert np.array_equal(volume.array.T, tifffile.imread(real_data(name)))


def test_that_imagej_slices_that_are_called_channels_come_in_with_a_note(tmp_path) -> None:
    many, few = np.repeat(SLICES, 2, axis=0), SLICES[:3]
    tifffile.imwrite(tmp_path / "many.tif", many, imagej=True, metadata={"axes": "CYX"})
    tifffile.imwrite(tmp_path / "few.tif", few, imagej=True, metadata={"axes": "CYX"})
    tifffile.imwrite(tmp_path / "times.tif", few, imagej=True, metadata={"axes": "TYX"})
    assert describe_volume(tmp_path / "many.tif").notes == (
        "The file calls its 14 images channels; they were interpreted as slices.",
    )
    assert np.array_equal(read_volume(tmp_path / "many.tif", voxel_size=1.0).array.T, many)
    assert np.array_equal(read_volume(tmp_path / "times.tif", voxel_size=1.0).array.T, few)
    with pytest.raises(FileError, match="holds 3 colours or channels"):
        read_volume(tmp_path / "few.tif", voxel_size=1.0)


@pytest.mark.parametrize(
    ("name", "nbytes", "expected"),
    [
        ("scan_13x11x7_uint16.raw", 2002, RawLayout((13, 11, 7), "uint16")),
        ("scan_13x11x7.raw", 1001, RawLayout((13, 11, 7), "uint8")),
        ("scan_13x11x7.raw", 2002, RawLayout((13, 11, 7), "uint16")),
        ("uint8-13x11x7.vol", 1001, RawLayout((13, 11, 7), "uint8")),
        ("a 16bit be 13×11×7.raw", 2002, RawLayout((13, 11, 7), "uint16", "big")),
        ("13_11_7_f32.raw", 4004, RawLayout((13, 11, 7), "float32")),
        ("int16_13x11x7_head.raw", 2002 + 512, RawLayout((13, 11, 7), "int16", offset=512)),
        ("scan_13x11x7_uint16.raw", 1001, None),
        ("scan_13x11x7.raw", 1001 + 100000, None),
        ("scan_13x0x7.raw", 1001, None),
        ("scan.raw", 1001, None),
        ("2026_11_21.raw", 5, None),
    ],
)
def test_that_the_name_of_a_raw_file_tells_its_layout_if_its_size_agrees(
    name, nbytes, expected, tmp_path
) -> None:
    (tmp_path / name).write_bytes(bytes(nbytes))
    assert layout_from_name(tmp_path / name) == expected


def test_that_a_mesh_among_volumes_and_a_volume_among_meshes_are_told_where_they_belong(tmp_path):
    (tmp_path / "grain.ply").write_text("ply\nformat ascii 1.0\n")
    with pytest.raises(FileError, match=r"grain\.ply is a mesh, not a volume"):
        describe_volume(tmp_path / "grain.ply")
    (tmp_path / "scan.nii.gz").write_bytes(b"\x1f\x8b")
    with pytest.raises(FileError, match=r"scan\.nii\.gz is a volume of voxels, not a mesh"):
        read_mesh(tmp_path / "scan.nii.gz")


def test_that_the_guide_lists_every_ending_of_a_volume() -> None:
    page = (Path(__file__).parents[2] / "docs" / "reading.md").read_text(encoding="utf-8")
    table = page.partition("## Volumes")[2].partition("A volume is indexed")[0]
    assert [suffix for suffix in sorted(volume_suffixes()) if f"`{suffix}`" not in table] == []
