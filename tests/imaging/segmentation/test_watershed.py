"""One pass of flooding against skimage's reconstruction and watershed, which take many."""

import numpy as np
import pytest
from scipy import ndimage
from skimage.measure import label
from skimage.morphology import local_maxima, reconstruction
from skimage.segmentation import watershed as skimage_watershed

from regolith_studio.imaging.segmentation.splitting import (
    distance_map,
    find_basins,
    in_mean_edges,
    joined,
    split,
)
from regolith_studio.imaging.settings import SplittingSettings

EVERY = np.ones((3, 3, 3), dtype=bool)
CUBE = np.ones(3)


def blobs(seed: int, size: int = 40) -> np.ndarray:
    """A random mask of touching lumps."""
    noise = ndimage.gaussian_filter(np.random.default_rng(seed).standard_normal((size, size, size)), 3.0)
    return noise > 0.3 * noise.std()


def ball(shape: int, centre, radius: float) -> np.ndarray:
    grid = np.stack(np.meshgrid(*[np.arange(shape)] * 3, indexing="ij"), axis=-1)
    return np.linalg.norm(grid - np.array(centre), axis=-1) <= radius


@pytest.mark.parametrize("h", [0.3, 0.8, 1.7])
@pytest.mark.parametrize("seed", range(3))
def test_that_grains_are_as_many_as_h_maxima(seed: int, h: float) -> None:
    """Domes of the distance map that stand out by more than h, by morphological reconstruction."""
    distance = distance_map(blobs(seed), CUBE).astype(np.float64)
    filled = reconstruction(distance - h, distance, footprint=EVERY)
    domes = label(local_maxima(filled, connectivity=3) & (distance > 0), connectivity=3).max()
    bodies, count = ndimage.label(distance > 0, EVERY)
    flat = np.count_nonzero(ndimage.maximum(distance, bodies, np.arange(1, count + 1)) <= h)
    grains = joined(
        find_basins(distance.astype(np.float32), CUBE), SplittingSettings(h_maxima=h, relative=0.0)
    )
    assert grains.max() == domes + flat  # a flat body has no dome, but is a grain


def test_that_the_parts_are_those_of_a_watershed_from_the_same_markers() -> None:
    distance = distance_map(blobs(5), CUBE)
    flooded = find_basins(distance, CUBE)
    grain_of_basin = joined(flooded, SplittingSettings())
    markers = np.zeros(distance.shape, dtype=int)
    markers[tuple(flooded.sites.T)] = grain_of_basin[1:]
    other = skimage_watershed(-distance, markers, connectivity=3, mask=distance > 0)
    assert np.mean(grain_of_basin[flooded.basins][distance > 0] == other[distance > 0]) > 0.95
    assert np.array_equal(flooded.basins > 0, distance > 0)
    assert (np.diff(flooded.peaks) <= 0).all()
    assert np.array_equal(distance[tuple(flooded.sites.T)], flooded.peaks.astype(np.float32))


def test_that_the_pass_between_two_hills_is_where_they_meet() -> None:
    hills = np.zeros((11, 3, 3), dtype=np.float32)
    hills[:, 1, 1] = [1, 3, 5, 4, 2, 3, 7, 6, 1, 2, 1]
    flooded = find_basins(hills, CUBE)
    assert flooded.peaks.tolist() == [7.0, 5.0, 2.0]
    assert sorted(zip(flooded.summits, flooded.passes, strict=True)) == [(2.0, 1.0), (5.0, 2.0)]
    assert joined(flooded, SplittingSettings(h_maxima=0.9, relative=0.0)).max() == 3
    assert joined(flooded, SplittingSettings(h_maxima=1.0, relative=0.0)).max() == 2
    assert joined(flooded, SplittingSettings(h_maxima=0.0, relative=0.5)).max() == 2
    assert joined(flooded, SplittingSettings(h_maxima=0.0, relative=0.6)).max() == 1
    assert joined(flooded, SplittingSettings(enabled=False)).max() == 1


@pytest.mark.parametrize("gap", [1.3, 1.6, 1.9])
def test_that_overlapping_balls_are_parted_at_the_plane_between_them(gap: float) -> None:
    radius = 10.0
    first, second = ball(44, (13, 21, 22), radius), ball(44, (13 + gap * radius, 22, 21), radius)
    grains, sites = split(first | second, CUBE, SplittingSettings())
    sizes = np.bincount(grains.ravel())[1:]
    cap = np.pi * (radius - gap * radius / 2) ** 2 * (2 * radius + gap * radius / 2) / 3
    assert len(sizes) == len(sites) == 2
    assert sizes == pytest.approx(4 / 3 * np.pi * radius**3 - cap, rel=0.02)


@pytest.mark.parametrize("edges", [(1.0, 1.0, 1.0), (1.0, 1.0, 2.0), (2.0, 1.0, 1.0)])
def test_that_voxels_that_are_not_cubes_part_the_same_balls(edges: tuple[float, float, float]) -> None:
    axes = [np.arange(0.0, 48.0, edge) for edge in edges]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    mask = np.zeros(points.shape[:3], dtype=bool)
    for centre in ((13, 24, 24), (33, 24, 24)):
        mask |= np.linalg.norm(points - centre, axis=-1) <= 11.0
    grains, _ = split(mask, np.array(edges), SplittingSettings())
    sizes = np.bincount(grains.ravel())[1:] * np.prod(edges)
    assert len(sizes) == 2
    assert sizes == pytest.approx(4 / 3 * np.pi * 11.0**3, rel=0.03)


def test_that_the_distance_map_knows_the_border_of_the_scan() -> None:
    mask = np.ones((9, 9, 9), dtype=bool)
    closed = distance_map(mask, CUBE)
    assert closed[4, 4, 4] == 5.0
    assert distance_map(mask, CUBE, ((True, True), (True, True), (False, True)))[4, 4, 4] == 5.0
    assert distance_map(mask, CUBE, ((True, True), (True, True), (False, True)))[4, 4, 8] == 9.0
    assert in_mean_edges(np.array([1.0, 2.0, 4.0])) == pytest.approx([0.5, 1.0, 2.0])
