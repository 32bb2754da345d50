"""Arrays whose axes are not slices, rows, columns come in as what they are when their order is stated."""

import itertools

import h5py
import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume

VOXELS = np.arange(5 * 6 * 7, dtype=np.uint16).reshape(5, 6, 7)
"""Indexed [x, y, z]."""
ORDERS = ["".join(order) for order in itertools.permutations("xyz")]


def turned(order):
    """The voxels as an array whose axes lie in this order."""
    return VOXELS.transpose(["xyz".index(axis) for axis in order])


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("layout", ["C", "F"])
def test_that_an_npy_array_comes_in_whatever_its_order_is(order, layout, tmp_path) -> None:
    np.save(tmp_path / "v.npy", np.array(turned(order), order=layout))
    volume = read_volume(tmp_path / "v.npy", axes=order, voxel_size=2.0, kind="grey")
    assert np.array_equal(volume.array, VOXELS)
    slabs = open_slabs(tmp_path / "v.npy", axes=order.upper(), voxel_size=2.0, kind="grey")
    assert np.array_equal(slabs.read(2, 5), VOXELS[:, :, 2:5])
    mapped = slabs.mapped()
    assert mapped is None or np.array_equal(mapped, VOXELS)


@pytest.mark.parametrize("order", ORDERS)
def test_that_an_hdf5_dataset_comes_in_whatever_it_says(order, tmp_path) -> None:
    with h5py.File(tmp_path / "v.h5", "w") as file:
        data = file.create_dataset("scan", data=turned(order))
        data.attrs["axes"] = "xzy"
        data.attrs["element_size_um"] = [{"x": 1.0, "y": 2.0, "z": 3.0}[axis] for axis in order]
    volume = read_volume(tmp_path / "v.h5", axes=order, kind="grey")
    assert np.array_equal(volume.array, VOXELS)
    assert volume.voxel_size.tolist() == [1.0, 2.0, 3.0]


def test_that_channels_can_be_among_the_axes(tmp_path) -> None:
    with h5py.File(tmp_path / "v.h5", "w") as file:
        file["scan"] = np.stack([turned("xyz"), turned("xyz") + 1])
    volume = read_volume(tmp_path / "v.h5", axes="cxyz", dataset="scan[1]", voxel_size=1.0, kind="grey")
    assert np.array_equal(volume.array, VOXELS + 1)


@pytest.mark.parametrize(
    ("axes", "sentence"),
    [("xy", "3 dimensions; the axes “xy” do not fit"), ("xyy", "each once"), ("xyq", "each once")],
)
@pytest.mark.parametrize("name", ["v.npy", "v.h5"])
def test_that_axes_that_do_not_fit_are_one_sentence(name, axes, sentence, tmp_path) -> None:
    np.save(tmp_path / "v.npy", VOXELS)
    with h5py.File(tmp_path / "v.h5", "w") as file:
        file["scan"] = VOXELS
    with pytest.raises(FileError, match=sentence):
        describe_volume(tmp_path / name, axes=axes)


def test_that_formats_which_know_their_axes_take_none(tmp_path) -> None:
    (tmp_path / "v.mha").write_bytes(b"ObjectType = Image\nNDims = 3\n")
    with pytest.raises(FileError, match="states its axes itself"):
        describe_volume(tmp_path / "v.mha", axes="xyz")
