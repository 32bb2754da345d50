"""Regions of interest: cropped and binned volumes are read slab by slab and keep their place."""

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.imaging import volume_slabs as volume_region
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.settings import DenoiseSettings, ExtractionSettings
from regolith_studio.imaging.volume import Volume, box_between
from regolith_studio.imaging.volume_slabs import VolumeRegion
from regolith_studio.readers.volumes.region import RegionSettings, crop_of_rectangle

RNG = np.random.default_rng(4)
EDGES = np.array([2.0, 2.0, 5.0])


def volume_of(array: np.ndarray, kind: str = "grey", edges: np.ndarray = EDGES) -> Volume:
    return Volume(array, edges, kind, "scan.tif")


def ball(shape: tuple[int, int, int], centre: tuple[float, float, float], radius: float) -> np.ndarray:
    """Share of the ball in each voxel, by a linear edge of one voxel."""
    x, y, z = np.mgrid[: shape[0], : shape[1], : shape[2]]
    distance = np.sqrt((x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2)
    return np.clip(radius - distance + 0.5, 0.0, 1.0)


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint16, np.float32])
@pytest.mark.parametrize("edge", [1, 2, 3])
def test_that_a_region_holds_the_means_of_cubes_of_its_box(dtype: type, edge: int) -> None:
    array = (RNG.random((13, 14, 17)) * 250).astype(dtype)
    region = VolumeRegion(volume_of(array), box_between((1, 2, 3), (12, 14, 16)), edge)
    nx, ny, nz = 11 // edge, 12 // edge, 13 // edge
    box = array[1 : 1 + nx * edge, 2 : 2 + ny * edge, 3 : 3 + nz * edge].astype(float)
    means = box.reshape(nx, edge, ny, edge, nz, edge).mean(axis=(1, 3, 5))
    assert region.shape == (nx, ny, nz)
    assert region.dtype == dtype
    assert region.voxel_size.tolist() == [2.0 * edge, 2.0 * edge, 5.0 * edge]
    near = 0.5 if np.dtype(dtype).kind in "ui" else 1e-4
    assert np.abs(region.read(0, nz) - means).max() <= near + 1e-9
    assert np.array_equal(region.read(2, 4), region.read(0, nz)[:, :, 2:4])


def test_that_no_more_than_a_slab_of_the_whole_volume_is_read_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = []

    class Listening(Volume):
        def read(self, z0: int, z1: int, /) -> np.ndarray:
            asked.append((z0, z1))
            return super().read(z0, z1)

    monkeypatch.setattr(volume_region, "SLAB_VOXELS", 10 * 10 * 8)
    whole = Listening(RNG.random((10, 10, 40)), EDGES, "grey", "scan.tif")
    region = VolumeRegion(whole, box_between((0, 0, 3), (10, 10, 40)), 4)
    region.read(0, 9)
    assert asked == [(3, 11), (11, 19), (19, 27), (27, 35), (35, 39)]


def test_that_the_mean_with_an_infinity_is_not_finite() -> None:
    array = np.ones((4, 4, 4), dtype=np.float32)
    array[0, 0, 0], array[1, 0, 0] = np.inf, -np.inf
    mean = VolumeRegion(volume_of(array), box_between((0, 0, 0), (4, 4, 4)), 2).read(0, 2)
    assert np.isnan(mean[0, 0, 0])
    assert (mean.ravel(order="F")[1:] == 1.0).all()


def test_that_a_grain_of_a_region_is_where_it_is_in_the_whole_scan() -> None:
    """To the bit: the same vertices, whatever is cropped around the grain."""
    labels = np.zeros((40, 30, 50), dtype=np.uint8)
    labels[ball(labels.shape, (22, 14, 31), 7) > 0.5] = 3
    settings = ExtractionSettings(min_voxels=1)
    whole = extract_particles(volume_of(labels, "labels"), settings).particles[0]
    region = RegionSettings("12:34,0:25,40:230um").of(volume_of(labels, "labels"))
    assert region.shape == (22, 25, 38)
    cut = Volume(region.read(0, region.shape[2]), region.voxel_size, "labels", "cut", region.origin)
    cropped = extract_particles(cut, settings).particles[0]
    assert np.array_equal(cropped.mesh.vertices, whole.mesh.vertices)
    assert np.array_equal(cropped.mesh.faces, whole.mesh.faces)


def test_that_a_grain_of_binned_grey_values_keeps_centre_and_volume() -> None:
    centre, radius = np.array([31.3, 27.6, 35.1]), 14.0
    grey = (40 + 160 * ball((64, 60, 70), tuple(centre), radius)).astype(np.uint8)
    region = RegionSettings("5:,3:,2:", 2).of(volume_of(grey, edges=np.array([3.0, 3.0, 3.0])))
    binned = Volume(region.read(0, region.shape[2]), region.voxel_size, "grey", "binned", region.origin)
    found = segment(binned, SegmentationSettings(DenoiseSettings("none")))
    mesh = extract_particles(found.labels, grey=binned).particles[0].mesh
    assert mesh.vertices.mean(axis=0) == pytest.approx(3.0 * centre, abs=0.4)
    triangles = mesh.triangles - mesh.vertices.mean(axis=0)
    volume = np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6
    assert volume == pytest.approx(4 / 3 * np.pi * (3.0 * radius) ** 3, rel=0.01)


@pytest.mark.parametrize(
    ("crop", "box"),
    [
        ("", ((0, 100), (0, 80), (0, 60))),
        (":,:,:", ((0, 100), (0, 80), (0, 60))),
        ("3:5,:7,9:", ((3, 5), (0, 7), (9, 60))),
        (" 10 : 20um , 0.02mm:60 µm, 0.1mm: ", ((5, 10), (10, 30), (20, 60))),
        (".01:.1mm,3:9,:101um", ((5, 50), (3, 9), (0, 20))),
    ],
)
def test_that_ranges_are_voxels_or_lengths_from_the_outer_faces(crop: str, box: tuple) -> None:
    volume = volume_of(np.zeros((100, 80, 60), dtype=np.uint8))
    region = VolumeRegion(volume, box_between(*zip(*box, strict=True)))
    chosen = RegionSettings(crop).of(volume)
    assert chosen.shape == region.shape
    assert tuple(chosen.origin) == region.origin


@pytest.mark.parametrize(
    ("crop", "edge", "sentence"),
    [
        ("0:5", 1, "A crop is X0:X1,Y0:Y1,Z0:Z1"),
        ("0-5,:,:", 1, "A crop is X0:X1"),
        ("-1:5,:,:", 1, "A crop is X0:X1"),
        ("0:5.5,:,:", 1, "whole numbers"),
        ("0:5ft,:,:", 1, "no unit “ft”"),
        (":,5:5,:", 1, "5:5 along y does not lie within the 8 voxels of scan.tif"),
        (":,:,0:1mm", 1, "0:200 along z does not lie within the 9 voxels"),
        ("2:5,:,:", 4, "3 voxels along x is thinner than 4"),
        ("", 0, "bin must be a whole number from 1 to 64"),
    ],
)
def test_that_a_region_that_is_none_is_one_sentence(crop: str, edge: int, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        RegionSettings(crop, edge).of(volume_of(np.zeros((7, 8, 9), dtype=np.uint8)))


def test_that_labels_are_not_averaged() -> None:
    with pytest.raises(InputError, match="labels, which have no mean"):
        RegionSettings(bin=2).of(volume_of(np.ones((8, 8, 8), dtype=np.uint8), "labels"))


@pytest.mark.parametrize("bin_", [1, 2, 3])
@pytest.mark.parametrize("crop", ["", "3:27,2:20,:"])
def test_that_a_rectangle_in_a_slice_of_a_region_is_cut_out_of_the_whole_volume(crop: str, bin_: int) -> None:
    array = np.random.default_rng(1).integers(0, 255, (30, 24, 18)).astype(np.uint8)
    source = Volume(array, np.ones(3), "grey", "scan")
    settings = RegionSettings(crop, bin=bin_)
    region = settings.of(source)
    drawn = crop_of_rectangle(settings, region.origin, 1, (2, 1), (6, 4))
    found = RegionSettings(drawn, bin=bin_).of(source)
    assert np.array_equal(found.read(0, 3), region.read(1, 4)[2:6])
    assert found.origin[0] == pytest.approx(region.origin[0] + 2)


@pytest.mark.parametrize(("crop", "bin"), [("", 3), (":,:,5:29", 1), (":,:,5:30", 4), (":,:,31:33", 1)])
def test_that_parts_of_a_region_are_those_of_its_volume_and_cover_it(crop: str, bin: int) -> None:
    class Parted(Volume):
        def parts(self) -> list[tuple[int, int]]:
            return [(0, 8), (8, 16), (16, 24), (24, 32), (32, 40)]

    source = Parted(np.zeros((8, 8, 40), np.uint8), np.ones(3), "grey", "parted")
    region = RegionSettings(crop, bin).of(source)
    parts = region.parts()
    assert [z for first, stop in parts for z in range(first, stop)] == list(range(region.shape[2]))
    start = region.box[2].start
    assert all((start + stop * bin) % 8 < bin for _, stop in parts[:-1])  # where a part ends, or in that cube
    assert RegionSettings(":,:,1:9").of(Volume(source.array, np.ones(3), "grey", "whole")).parts() == []
