"""HDF5 as ilastik and others write it, in any order of axes; nothing outside the file is read."""

import io
import json
from collections import Counter

import h5py
import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_formats.hdf5 import open_hdf5
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume

SLICES = np.random.default_rng(8).integers(0, 60_000, (9, 11, 13)).astype(np.uint16)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "volume.h5"


def tags(axes):
    """Axis tags as vigra writes them."""
    return json.dumps({"axes": [{"key": key, "typeFlags": 2, "resolution": 0} for key in axes]})


def arranged(axes):
    """The slices with their axes in another order, and axes of one element for time and channel."""
    kept = [axis for axis in axes if axis in "zyx"]
    array = SLICES.transpose(["zyx".index(axis) for axis in kept])
    for place, axis in enumerate(axes):
        if axis in "tc":
            array = np.expand_dims(array, place)
    return array


@pytest.mark.parametrize("axes", ["zyx", "xyz", "yzx", "tzyxc", "zyxc", "cxzy", "txyzc"])
@pytest.mark.parametrize("stated", ["axistags", "axes", "labels"])
def test_that_axes_come_from_what_the_file_says(axes, stated, path) -> None:
    with h5py.File(path, "w") as file:
        data = file.create_dataset("exported_data", data=arranged(axes), chunks=True, compression="gzip")
        if stated == "axistags":
            data.attrs["axistags"] = tags(axes)
        elif stated == "axes":
            data.attrs["axes"] = axes
        else:
            for dimension, axis in zip(data.dims, axes, strict=True):
                dimension.label = axis
    assert np.array_equal(read_volume(path, voxel_size=1.0).array.T, SLICES)
    assert np.array_equal(open_slabs(path, voxel_size=1.0).read(4, 6).T, SLICES[4:6])


@pytest.mark.parametrize("shape", [(9, 11, 13), (9, 11, 13, 1), (1, 9, 11, 13, 1)])
def test_that_untagged_axes_are_slices_first_and_channels_last(shape, path) -> None:
    with h5py.File(path, "w") as file:
        file["data"] = SLICES.reshape(shape)
    assert np.array_equal(read_volume(path, voxel_size=1.0).array.T, SLICES)


@pytest.mark.parametrize("dtype", ["u1", ">u2", "<i4", ">f4", "f8", "?"])
def test_that_types_and_byte_orders_are_kept(dtype, path) -> None:
    with h5py.File(path, "w") as file:
        file["data"] = (SLICES % 100).astype(dtype)
    assert np.array_equal(
        read_volume(path, voxel_size=1.0, kind="grey").array.T, (SLICES % 100).astype(dtype)
    )


@pytest.mark.parametrize(
    "options", [{"shuffle": True}, {"fletcher32": True}, {"compression": "lzf"}, {"scaleoffset": 0}]
)
def test_that_filters_of_the_library_are_undone(options, path) -> None:
    with h5py.File(path, "w") as file:
        file.create_dataset("data", data=SLICES, chunks=(4, 5, 6), **options)
    assert np.array_equal(read_volume(path, voxel_size=1.0).array.T, SLICES)


def test_that_several_volumes_are_offered_and_the_likeliest_read(path) -> None:
    with h5py.File(path, "w") as file:
        file["large"] = np.zeros((20, 20, 20), np.uint8)
        file["exported_data"] = SLICES
        file["deep/er/labels"] = SLICES.astype(np.uint8)
        file["table"] = np.zeros((5, 2))
        file["text"] = "no volume"
    names = [entry.name for entry in describe_volume(path).datasets]
    assert names == ["exported_data", "large", "deep/er/labels"]
    shapes = [entry.shape for entry in describe_volume(path).datasets]
    assert shapes == [(13, 11, 9), (20, 20, 20), (13, 11, 9)]
    header = describe_volume(path)
    assert header.dataset == "exported_data"
    assert header.notes == ("The file holds 3 volumes; exported_data was read.",)
    other = read_volume(path, dataset="/deep/er/labels", voxel_size=1.0, kind="labels")
    assert other.name == "volume.h5/deep/er/labels"
    assert np.array_equal(other.array.T, SLICES.astype(np.uint8))


def test_that_the_channels_of_a_probability_map_are_volumes_each(path) -> None:
    """ilastik's pixel classification exports one channel a class."""
    maps = np.random.default_rng(1).random((9, 11, 13, 2)).astype(np.float32)
    with h5py.File(path, "w") as file:
        file.create_dataset("exported_data", data=maps).attrs["axistags"] = tags("zyxc")
    names = [entry.name for entry in describe_volume(path).datasets]
    assert names == ["exported_data[0]", "exported_data[1]"]
    found = read_volume(path, dataset="exported_data[1]", voxel_size=1.0)
    assert found.kind == "grey"
    assert np.array_equal(found.array.T, maps[..., 1])


def test_that_the_element_size_of_fiji_is_the_voxel_size(path) -> None:
    with h5py.File(path, "w") as file:
        file.create_dataset("data", data=SLICES).attrs["element_size_um"] = (3.0, 2.0, 1.0)
    assert describe_volume(path).voxel_size == (1.0, 2.0, 3.0)
    assert read_volume(path).voxel_size == pytest.approx([1.0, 2.0, 3.0])


def test_that_an_unknown_volume_is_refused_with_the_names_there_are(path) -> None:
    with h5py.File(path, "w") as file:
        file["one"], file["two"] = SLICES, SLICES
    with pytest.raises(FileError, match="has no volume “three”; it holds one, two"):
        read_volume(path, dataset="three", voxel_size=1.0)


def secret(folder):
    """A file beside it that must never be read."""
    with h5py.File(folder / "secret.h5", "w") as file:
        file["data"] = SLICES
    SLICES.tofile(folder / "secret.raw")


def test_that_external_and_soft_links_are_not_followed(path, tmp_path) -> None:
    secret(tmp_path)
    with h5py.File(path, "w") as file:
        file["outside"] = h5py.ExternalLink(str(tmp_path / "secret.h5"), "/data")
        file["soft"] = h5py.SoftLink("/outside")
    with pytest.raises(FileError, match="holds no volume"):
        read_volume(path, voxel_size=1.0)
    with h5py.File(path, "a") as file:
        file["inside"] = SLICES + 1
    assert [entry.name for entry in describe_volume(path).datasets] == ["inside"]
    with pytest.raises(FileError, match="has no volume “outside”"):
        read_volume(path, dataset="outside", voxel_size=1.0)


def test_that_external_storage_is_refused(path, tmp_path) -> None:
    secret(tmp_path)
    with h5py.File(path, "w") as file:
        parts = [(str(tmp_path / "secret.raw"), 0, SLICES.nbytes)]
        file.create_dataset("data", SLICES.shape, SLICES.dtype, external=parts)
    with pytest.raises(FileError, match="keeps these voxels in another file"):
        read_volume(path, voxel_size=1.0)


def test_that_a_virtual_dataset_is_refused(path, tmp_path) -> None:
    secret(tmp_path)
    layout = h5py.VirtualLayout(SLICES.shape, SLICES.dtype)
    layout[:] = h5py.VirtualSource(tmp_path / "secret.h5", "data", SLICES.shape)
    with h5py.File(path, "w") as file:
        file.create_virtual_dataset("data", layout)
    with pytest.raises(FileError, match="maps these voxels from other files"):
        read_volume(path, voxel_size=1.0)


def test_that_a_group_inside_itself_is_visited_once(path) -> None:
    with h5py.File(path, "w") as file:
        group = file.create_group("a/b")
        group["loop"] = file["a"]
        group["data"] = SLICES
    assert [entry.name for entry in describe_volume(path).datasets] == ["a/b/data"]


def test_that_chunks_too_large_for_the_memory_are_refused(path) -> None:
    with h5py.File(path, "w") as file:
        file.create_dataset("data", (1024, 1024, 1024), "u1", chunks=(1024, 1024, 1024))
    with pytest.raises(FileError, match="chunks of more than"):
        read_volume(path, voxel_size=1.0)


def test_that_slabs_end_where_chunks_do(path, monkeypatch) -> None:
    """A chunk is unpacked once if no slab ends inside it."""
    from regolith_studio.readers.volumes import read as slabs

    with h5py.File(path, "w") as file:
        file.create_dataset("data", data=SLICES, chunks=(4, 11, 13), compression="gzip")
    opened = slabs.open_slab_reader(path)
    monkeypatch.setattr(slabs, "SLAB_BYTES", 5 * opened.header.slice_bytes)
    assert list(opened.pieces(0, 9)) == [(0, 4), (4, 8), (8, 9)]
    assert list(opened.pieces(2, 9)) == [(2, 4), (4, 8), (8, 9)]
    monkeypatch.setattr(slabs, "SLAB_BYTES", opened.header.slice_bytes)
    assert list(opened.pieces(0, 9)) == [(0, 4), (4, 8), (8, 9)]


class Watched(io.FileIO):
    """A file that remembers where it was read from; HDF5 reads each chunk by one call at its place."""

    def __init__(self, path) -> None:
        super().__init__(path)
        self.places: Counter = Counter()

    def readinto(self, view) -> int:
        self.places[self.tell()] += 1
        return super().readinto(view)


def unpackings(path, monkeypatch, use) -> set[int]:
    """How often each chunk is unpacked while `use` has the file."""
    with h5py.File(path) as file:
        stored = file["data"].id
        offsets = [stored.get_chunk_info(k).byte_offset for k in range(stored.get_num_chunks())]
    opened = h5py.File
    with Watched(path) as raw, monkeypatch.context() as patch:
        patch.setattr(
            h5py,
            "File",
            lambda *_, **options: opened(raw, "r", **{k: options[k] for k in options if "rdcc" in k}),
        )
        use()
        return {raw.places[offset] for offset in offsets}


DEEP = np.random.default_rng(9).integers(0, 250, (20, 24, 18)).astype(np.uint8)


@pytest.mark.parametrize("axes", ["zyx", "xyz", "czyx"])
@pytest.mark.parametrize("depth", [1, 4, 8, 20])
def test_that_each_chunk_is_unpacked_once_however_thin_the_slabs(axes, depth, path, monkeypatch) -> None:
    """Six slices a chunk, which some of the slabs share and some do not."""
    array = np.stack([DEEP + 1, DEEP]) if "c" in axes else DEEP
    array = array.transpose(["czyx".index(axis) - ("c" not in axes) for axis in axes])
    with h5py.File(path, "w") as file:
        chunks = tuple({"z": 6, "y": 5, "x": 7, "c": 2}[axis] for axis in axes)
        file.create_dataset("data", data=array, chunks=chunks, compression="gzip")

    def read() -> None:
        volume = open_hdf5(path, {"axes": axes, "dataset": "data[1]" if "c" in axes else "data"})
        parts = [volume.read(z, min(z + depth, 20)) for z in range(0, 20, depth)]
        volume.close()
        assert np.array_equal(np.concatenate(parts), DEEP)

    assert unpackings(path, monkeypatch, read) == {1}
