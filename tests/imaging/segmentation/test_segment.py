"""The whole way from grey values to labels, on scans whose truth is known."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from regolith_studio.errors import InputError
from regolith_studio.imaging import volume_slabs
from regolith_studio.imaging.connected_components import (
    ComponentJoiner,
    components_of_slab,
    largest_component,
    pores_filled,
)
from regolith_studio.imaging.segmentation.segment import (
    SegmentationSettings,
    grains_over_heights,
    heights_table,
    preview,
    segment,
    segmentation_steps,
)
from regolith_studio.imaging.settings import (
    DENOISE_METHODS,
    CleaningSettings,
    DenoiseSettings,
    SplittingSettings,
    ThresholdSettings,
    TileSettings,
)
from regolith_studio.imaging.volume import Volume, sample_volume
from regolith_studio.imaging.volume_slabs import ScratchArrays
from regolith_studio.steps import result_of

PLAIN = SegmentationSettings(
    DenoiseSettings("none"), cleaning=CleaningSettings(min_voxels=1, fill_pores=False)
)


def overlaps(truth: np.ndarray, found: np.ndarray) -> np.ndarray:
    """Intersection over union of each true grain with the grain found that shares most with it."""
    table = np.zeros((truth.max() + 1, found.max() + 1), dtype=np.int64)
    np.add.at(table, (truth.ravel(), found.ravel()), 1)
    shared = table[1:, 1:]
    union = table[1:].sum(axis=1)[:, None] + table[:, 1:].sum(axis=0)[None] - shared
    return (shared / union).max(axis=1)


def grey(mask: np.ndarray, name: str = "test") -> Volume:
    return Volume(np.where(mask, 180, 40).astype(np.uint8), (1.0, 1.0, 1.0), "grey", name)


@pytest.mark.parametrize(
    "method",
    [
        pytest.param(method, marks=[] if method == "median" else pytest.mark.slow)
        for method in DENOISE_METHODS
    ],
)
def test_that_the_shipped_scan_gives_all_its_60_grains(method) -> None:
    truth = sample_volume("labels").array
    found = segment(sample_volume("grey"), SegmentationSettings(DenoiseSettings(method)))
    scores = overlaps(truth, found.labels.array)
    assert found.n_grains == 60
    assert scores.min() > 0.7
    assert scores.mean() > 0.9
    assert found.sizes.sum() == pytest.approx(np.count_nonzero(truth), rel=0.02)
    assert np.array_equal(np.bincount(found.labels.array.ravel())[1:], found.sizes)
    assert "60 grains" in found.summary


def dense_balls(shape: int = 96, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Balls that touch and overlap a little; each voxel belongs to the ball it is deepest in."""
    generator = np.random.default_rng(seed)
    points = np.stack(np.meshgrid(*[np.arange(shape)] * 3, indexing="ij"), axis=-1)
    centres, radii = np.empty((0, 3)), np.empty(0)
    for radius in np.sort(generator.uniform(6.0, 15.0, 4000))[::-1]:
        centre = generator.uniform(0, shape, 3)
        gaps = np.linalg.norm(centres - centre, axis=1) - radii - radius
        if (gaps > -1.5).all():
            centres, radii = np.vstack([centres, centre]), np.append(radii, radius)
    deepest = np.full(points.shape[:3], 0.0)
    truth = np.zeros(points.shape[:3], dtype=int)
    for number, (centre, radius) in enumerate(zip(centres, radii, strict=True), start=1):
        depth = radius - np.linalg.norm(points - centre, axis=-1)
        truth[depth > deepest] = number
        deepest = np.maximum(deepest, depth)
    return truth, radii


@pytest.mark.slow
def test_that_touching_balls_of_many_sizes_are_parted_whether_in_tiles_or_not() -> None:
    truth, radii = dense_balls()
    assert ndimage.label(truth > 0)[1] < len(radii) / 4
    whole = segment(grey(truth > 0), PLAIN)
    tiled = segment(
        grey(truth > 0),
        SegmentationSettings(
            PLAIN.denoise, PLAIN.threshold, PLAIN.cleaning, tiles=TileSettings(1000, core=40, margin=16)
        ),
    )
    for found in (whole, tiled):
        large = np.bincount(truth.ravel())[1:] > 500
        scores = overlaps(truth, found.labels.array)
        assert (scores[large] > 0.8).mean() > 0.97
        assert found.sizes.sum() == np.count_nonzero(truth)
    assert overlaps(whole.labels.array, tiled.labels.array).mean() > 0.99


def test_that_one_rough_grain_is_not_split() -> None:
    labels = sample_volume("labels").array
    inner = [box for box in ndimage.find_objects(labels) if min(side.start for side in box) > 0][:20]
    for box in inner:
        crop = np.pad(labels[box], 3)
        number = np.bincount(crop[crop > 0]).argmax()
        assert segment(grey(crop == number), PLAIN).n_grains == 1


@pytest.mark.slow
def test_that_h_trades_grains_apart_for_grains_together() -> None:
    volume = sample_volume("grey")
    counts = [
        segment(
            volume, SegmentationSettings(DenoiseSettings("none"), splitting=SplittingSettings(True, h, 0.0))
        ).n_grains
        for h in (0.2, 0.8, 30.0)
    ]
    assert counts[0] > counts[1] > counts[2]


def test_that_two_balls_are_one_grain_from_the_h_on_by_which_their_peaks_stand_out() -> None:
    """The distance is 12 in each centre and sqrt(12^2 - 9^2) in the circle in which the balls meet."""
    x, y, z = np.mgrid[-24:25, -15:16, -15:16]
    balls = np.minimum((x - 9) ** 2, (x + 9) ** 2) + y**2 + z**2 <= 12**2
    persistence = 12 - np.sqrt(12**2 - 9**2)
    plain = replace(PLAIN, splitting=SplittingSettings(relative=0.0))
    found = result_of(grains_over_heights(grey(balls), (0.5, persistence - 1, persistence + 1), plain))
    assert [each.n_grains for each in found] == [2, 2, 1]
    assert [each.sizes.sum() for each in found] == [np.count_nonzero(balls)] * 3
    assert found[0].sizes.tolist() == segment(grey(balls), plain).sizes.tolist()
    median = (6 * np.count_nonzero(balls) / 2 / np.pi) ** (1 / 3)
    assert heights_table(found).rows[0] == pytest.approx((0.5, 2, median, median), rel=0.01)


@pytest.fixture
def thin_slabs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(volume_slabs.slab_ranges, "__defaults__", (1,))


@pytest.mark.usefixtures("thin_slabs")
@pytest.mark.slow
def test_that_slabs_on_disk_give_the_same_grains_as_memory(tmp_path) -> None:
    volume = sample_volume("grey")
    settings = SegmentationSettings(DenoiseSettings("gaussian"), cleaning=CleaningSettings(1, 1))
    stages = []
    with ScratchArrays(tmp_path) as scratch:
        steps = segmentation_steps(volume, settings, scratch)
        while True:
            try:
                stages.append(next(steps))
            except StopIteration as end:
                found = end.value
                break
        assert isinstance(found.labels.array.base, np.ndarray)
        assert len(list(tmp_path.rglob("*.raw"))) == 1  # what is not needed any more is gone
        counts = np.array(found.labels.array)
    assert not list(tmp_path.iterdir())
    assert len([stage for stage in stages if stage.stage == "Denoising"]) == 18
    volume_slabs.slab_ranges.__defaults__ = (volume_slabs.SLAB_VOXELS,)
    whole = segment(volume, settings)
    assert whole.level == found.level
    assert overlaps(whole.labels.array, counts).min() == 1.0


def test_that_bodies_are_those_of_scipy_whatever_the_slabs() -> None:
    noise = ndimage.gaussian_filter(np.random.default_rng(1).standard_normal((30, 31, 32)), 1.2)
    mask = noise > 0
    expected, count = ndimage.label(mask)
    for thickness in (1, 5, 32):
        joiner, parts, below = ComponentJoiner(), [], None
        for z in range(0, mask.shape[2], thickness):
            numbers, slab = components_of_slab(mask[:, :, z : z + thickness], z)
            shift = joiner.add(slab, below, numbers[:, :, 0])
            parts.append(np.where(numbers > 0, numbers + shift, 0))
            below = numbers[:, :, -1]
        body_of, bodies = joiner.finish()
        found = body_of[np.concatenate(parts, axis=2)]
        assert len(bodies.sizes) == count
        pairs = np.unique(np.column_stack([expected.ravel(), found.ravel()]), axis=0)
        assert len(pairs) == count + 1
        for body in range(1, count + 1):
            (box,) = ndimage.find_objects((found == body).astype(int))
            assert bodies.box(body) == box
        assert np.array_equal(bodies.sizes, np.bincount(found.ravel())[1:])


def test_that_anisotropic_voxels_find_the_same_grains() -> None:
    volume = sample_volume("grey")
    flat = Volume(volume.array[:, :, ::2], (2.3, 2.3, 4.6), "grey", "flat")
    found = segment(flat, SegmentationSettings(DenoiseSettings("gaussian")))
    assert found.n_grains == pytest.approx(60, abs=2)
    assert overlaps(sample_volume("labels").array[:, :, ::2], found.labels.array).mean() > 0.85


def test_that_a_probability_map_takes_the_place_of_the_threshold() -> None:
    truth = sample_volume("labels").array > 0
    likely = np.where(truth, 0.9, 0.2).astype(np.float32)
    settings = SegmentationSettings(threshold=ThresholdSettings("probability", 0.5))
    found = segment(Volume(likely, (1, 1, 1), "grey", "p"), settings)
    assert found.n_grains == 60
    assert np.array_equal(found.labels.array > 0, truth)
    assert "connected bodies at probability 0.5; " in found.summary
    by_bytes = segment(Volume((likely * 255).astype(np.uint8), (1, 1, 1), "grey", "p"), settings)
    assert np.array_equal(by_bytes.labels.array, found.labels.array)


def test_that_dark_grains_are_found_too() -> None:
    volume = sample_volume("grey")
    negative = Volume(255 - volume.array, volume.voxel_size, "grey", "negative")
    found = segment(negative, SegmentationSettings(DenoiseSettings("gaussian"), ThresholdSettings(dark=True)))
    assert found.n_grains == 60


def test_that_pores_are_filled_or_left_and_small_bodies_dropped() -> None:
    mask = np.zeros((30, 30, 30), dtype=bool)
    mask[5:20, 5:20, 5:20] = True
    mask[11:14, 11:14, 11:14] = False
    mask[24:26, 24:26, 24:26] = True
    found = segment(grey(mask), SegmentationSettings(DenoiseSettings("none")))
    assert (found.sizes.tolist(), found.n_small) == ([15**3], 1)
    left = SegmentationSettings(
        DenoiseSettings("none"),
        cleaning=CleaningSettings(fill_pores=False, min_voxels=1),
        splitting=SplittingSettings(enabled=False),
    )
    assert segment(grey(mask), left).sizes.tolist() == [15**3 - 27, 8]


def test_that_values_that_are_not_finite_are_counted_and_in_no_grain() -> None:
    mask = np.zeros((30, 30, 30), dtype=bool)
    mask[5:20, 5:20, 5:20] = True
    values = np.where(mask, 1.0, 0.0).astype(np.float32)
    values[5, 5, 5], values[25, 25, 25], values[26, 26, 26] = np.nan, np.inf, -np.inf
    volume = Volume(values, (1, 1, 1), "grey", "floats")
    settings = SegmentationSettings(
        DenoiseSettings("none"), cleaning=CleaningSettings(fill_pores=False, min_voxels=1)
    )
    found = segment(volume, settings)
    assert found.sizes.tolist() == [15**3 - 1]
    assert found.n_not_finite == 3
    assert "3 voxels hold no finite number" in str(found.summary)


def test_that_a_volume_without_grains_is_refused_with_a_hint() -> None:
    mask = np.zeros((20, 20, 20), dtype=bool)
    mask[3:5, 3:5, 3:5] = True
    with pytest.raises(InputError, match="No grain of 64 voxels"):
        segment(grey(mask), SegmentationSettings(DenoiseSettings("none")))


def test_that_a_preview_agrees_with_the_whole_at_the_same_level() -> None:
    volume = sample_volume("grey")
    whole = segment(volume, SegmentationSettings(DenoiseSettings("gaussian")))
    box = (slice(20, 100), slice(30, 110), slice(25, 105))
    part = preview(volume, box, SegmentationSettings(DenoiseSettings("gaussian")), whole.level)
    core = tuple(slice(2, -2) for _ in range(3))
    same = (part.labels.array > 0)[core] == (whole.labels.array[box] > 0)[core]
    assert same.mean() > 0.999
    assert part.labels.shape == (80, 80, 80)


def test_that_the_largest_body_and_closed_pores_are_those_of_scipy() -> None:
    noise = ndimage.gaussian_filter(np.random.default_rng(4).standard_normal((24, 25, 26)), 1.5)
    mask = noise > -0.02
    body, count = largest_component(mask)
    bodies, expected = ndimage.label(mask)
    assert count == expected
    assert np.array_equal(body, bodies == np.bincount(bodies.ravel())[1:].argmax() + 1)
    assert np.array_equal(pores_filled(body), ndimage.binary_fill_holes(body))
    full = np.ones((3, 3, 3), dtype=bool)
    assert pores_filled(full) is full


@pytest.mark.usefixtures("thin_slabs")
def test_that_hysteresis_keeps_the_weak_voxels_that_strong_ones_are_connected_to() -> None:
    """Against bodies of the whole volume at once by scipy; they reach over several slabs."""
    noise = ndimage.gaussian_filter(np.random.default_rng(3).standard_normal((40, 41, 42)), 1.5)
    chances = np.clip(128 + 600 * noise, 0, 255).astype(np.uint8)
    settings = SegmentationSettings(
        threshold=ThresholdSettings("probability", 0.9, low=0.75),
        cleaning=CleaningSettings(fill_pores=False, min_voxels=0),
        splitting=SplittingSettings(enabled=False),
    )
    found = segment(Volume(chances, np.ones(3), "grey", "chances"), settings)
    bodies, count = ndimage.label(chances >= 0.75 * 255)
    kept = np.unique(bodies[chances >= 0.9 * 255])
    assert 10 < len(kept) < count
    assert np.array_equal(found.labels.array > 0, np.isin(bodies, kept[kept > 0]))
    assert found.n_bodies == found.n_grains == np.count_nonzero(kept)


@pytest.mark.parametrize(
    ("method", "value", "low", "dark"),
    [("otsu", 0.5, 0.2, False), ("probability", 0.5, 0.5, False), ("probability", 0.5, 0.2, True)],
)
def test_that_a_hysteresis_needs_a_probability_and_a_lower_one(
    method: str, value: float, low: float, dark: bool
) -> None:
    with pytest.raises(InputError, match=r"lower threshold of a hysteresis lies between 0 and the threshold"):
        ThresholdSettings(method, value, low=low, dark=dark)  # type: ignore[arg-type]
