"""HDF5 files as ilastik's export writes them: its names, tags, chunks, compression and types.

What the files hold follows ilastik's writer (``lazyflow``: ``OpH5N5WriterBigDataset``) and vigra's
``AxisTags.toJSON``: one dataset ``exported_data``, chunks of about 300 kB that hold all channels,
gzip of level 1, ``axistags`` as indented JSON, ``drange`` where the values have been renormalised.
"""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy import ndimage

from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.settings import DenoiseSettings, ThresholdSettings
from regolith_studio.readers.volumes.read import describe_volume, read_volume

RADII = (9.0, 8.0, 7.0, 9.5)
CENTRES = ((13, 14, 15), (14, 36, 40), (35, 15, 38), (36, 38, 14))
FLAGS = {"x": 2, "y": 2, "z": 2, "c": 1, "t": 8}


def balls() -> np.ndarray:
    """0 between four balls and 1 to 4 in them, slices first."""
    points = np.moveaxis(np.indices((50, 52, 54)), 0, -1)
    labels = np.zeros(points.shape[:3], dtype=np.uint32)
    for number, (centre, radius) in enumerate(zip(CENTRES, RADII, strict=True), start=1):
        labels[np.linalg.norm(points - centre, axis=-1) <= radius] = number
    return labels


def probabilities() -> np.ndarray:
    """Of grain and of background, shape (z, y, x, 2), float32."""
    grain = ndimage.gaussian_filter((balls() > 0).astype(np.float32), 0.7)
    return np.stack([grain, 1 - grain], axis=-1).astype(np.float32)


def axistags(axes: str, edge: float = 0) -> str:
    """As vigra writes them."""
    tags = [
        {
            "key": key,
            "typeFlags": FLAGS[key],
            "resolution": edge if key in "xyz" else 0,
            "description": "",
        }
        for key in axes
    ]
    return json.dumps({"axes": tags}, indent=2)


def exported(
    path: Path, data: np.ndarray, axes: str, drange: tuple[float, float] | None = None, edge: float = 0
) -> Path:
    """What ilastik leaves behind."""
    channels = data.shape[axes.index("c")] if "c" in axes else 1
    cube = int((300_000 / (channels * data.dtype.itemsize)) ** (1 / 3))
    most = {"t": 1, "c": channels}
    chunks = tuple(min(most.get(axis, cube), n) for axis, n in zip(axes, data.shape, strict=True))
    with h5py.File(path, "w") as file:
        dataset = file.create_dataset(
            "exported_data", data=data, chunks=chunks, compression="gzip", compression_opts=1
        )
        dataset.attrs["axistags"] = axistags(axes, edge)
        if drange is not None:
            dataset.attrs["drange"] = drange
        if edge:
            dataset.attrs["axis_units"] = json.dumps({"x": "µm", "y": "µm", "z": "µm", "t": "sec"})
    return path


@pytest.mark.parametrize(
    ("axes", "dtype"),
    [("zyxc", np.float32), ("tzyxc", np.uint8), ("xyzc", np.uint16), ("czyx", np.float32)],
)
def test_that_a_probability_map_gives_the_grains(axes: str, dtype: type, tmp_path: Path) -> None:
    maps = probabilities()
    if dtype is not np.float32:
        maps = np.rint(maps * np.iinfo(dtype).max).astype(dtype)
    order = ["zyxc".index(axis) for axis in axes if axis != "t"]
    data = maps.transpose(order)[None] if "t" in axes else maps.transpose(order)
    drange = None if dtype is np.float32 else (0, int(np.iinfo(dtype).max))
    path = exported(tmp_path / "scan_Probabilities.h5", data, axes, drange)
    names = [entry.name for entry in describe_volume(path).datasets]
    assert names == ["exported_data[0]", "exported_data[1]"]
    volume = read_volume(path, dataset="exported_data[0]", voxel_size=2.0)
    assert volume.kind == "grey"
    assert np.array_equal(volume.array.T, maps[..., 0])
    settings = SegmentationSettings(DenoiseSettings("none"), ThresholdSettings("probability", 0.5))
    found = segment(volume, settings)
    sizes = [4 / 3 * np.pi * radius**3 for radius in RADII]
    assert sorted(found.sizes) == pytest.approx(sorted(sizes), rel=0.05)
    grains = extract_particles(found.labels, grey=volume)
    volumes = sorted(each.mesh.volume / 8 for each in grains.particles)
    assert volumes == pytest.approx(sorted(np.bincount(balls().ravel())[1:]), rel=0.02)


@pytest.mark.parametrize("axes", ["zyxc", "zyx", "tzyxc"])
def test_that_a_simple_segmentation_is_parted_into_grains(axes: str, tmp_path: Path) -> None:
    """Each voxel holds the number of its class from 1: here 1 is the background and 2 is grain."""
    classes = np.where(balls() > 0, 2, 1).astype(np.uint8)
    shape = tuple({"c": 1, "t": 1}.get(axis, classes.shape["zyx".find(axis)]) for axis in axes)
    path = exported(tmp_path / "scan_Simple Segmentation.h5", classes.reshape(shape), axes)
    volume = read_volume(path, voxel_size=1.0, kind="grey")
    found = segment(volume, SegmentationSettings(DenoiseSettings("none")))
    assert sorted(found.sizes) == sorted(np.bincount(balls().ravel())[1:])


def test_that_a_simple_segmentation_whose_grains_come_first_is_parted_as_dark_grains(tmp_path: Path) -> None:
    classes = np.where(balls() > 0, 1, 2).astype(np.uint8)[..., None]
    path = exported(tmp_path / "scan_Simple Segmentation.h5", classes, "zyxc")
    volume = read_volume(path, voxel_size=1.0, kind="grey")
    settings = SegmentationSettings(DenoiseSettings("none"), ThresholdSettings("manual", 1.5, dark=True))
    assert segment(volume, settings).n_grains == 4


def test_that_a_simple_segmentation_of_few_grains_is_not_taken_for_labels(tmp_path: Path) -> None:
    """Its classes fill the volume, as no numbers of grains do."""
    classes = np.where(balls() > 0, 2, 1).astype(np.uint8)[..., None]
    path = exported(tmp_path / "scan_Simple Segmentation.h5", classes, "zyxc")
    assert describe_volume(path).kind == "grey"


def test_that_object_identities_are_labels(tmp_path: Path) -> None:
    path = exported(tmp_path / "scan_Object Identities.h5", balls()[..., None], "zyxc")
    volume = read_volume(path, voxel_size=1.0)
    assert volume.kind == "labels"
    assert extract_particles(volume).labels == (1, 2, 3, 4)


def test_that_the_resolution_of_the_axes_is_the_voxel_size(tmp_path: Path) -> None:
    path = exported(tmp_path / "scan.h5", probabilities(), "zyxc", edge=2.5)
    header = describe_volume(path)
    assert (header.voxel_size, header.unit) == ((2.5, 2.5, 2.5), "um")


@pytest.mark.parametrize("units", [None, "{", '{"x": "µm"}', '{"x": "px", "y": "px", "z": "px"}', "[]"])
def test_that_resolutions_without_a_unit_of_length_are_asked_for(units: str | None, tmp_path: Path) -> None:
    path = exported(tmp_path / "scan.h5", probabilities(), "zyxc", edge=2.5)
    with h5py.File(path, "a") as file:
        del file["exported_data"].attrs["axis_units"]
        if units is not None:
            file["exported_data"].attrs["axis_units"] = units
    assert describe_volume(path).voxel_size is None
