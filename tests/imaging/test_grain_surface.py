"""Surfaces from grey values: the volume of the grain, not of the mask that a threshold has left of it."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial import ConvexHull, HalfspaceIntersection

from regolith_studio.errors import InputError
from regolith_studio.imaging import volume_slabs
from regolith_studio.imaging.contours import MAX_DEPTH, depth
from regolith_studio.imaging.extraction import ExtractedParticle, extract_particles
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.settings import ExtractionSettings
from regolith_studio.imaging.volume import Volume, sample_volume
from tools.make_samples.grains import even_sphere, random_rotation

GREY = ExtractionSettings(exclude_border=False, min_voxels=0, surface="grey")
RESIN, GRAIN, BLUR = 62.0, 138.0, 0.8
Depth = Callable[[np.ndarray], np.ndarray]


def coverage(depth: Depth, shape: tuple[int, int, int], fine: int = 5) -> np.ndarray:
    """Share of each voxel where `depth`, near 0 a distance, is positive: by points in voxels of the rim."""
    points = np.moveaxis(np.indices(shape), 0, -1).astype(float)
    deep = depth(points)
    share = (deep > 0).astype(float)
    rim = np.abs(deep) < 1.0
    steps = (np.arange(fine) + 0.5) / fine - 0.5
    shifts = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    share[rim] = np.mean([depth(points[rim] + shift) > 0 for shift in shifts], axis=0)
    return share


def scanned(share: np.ndarray, noise: float = 0.0, seed: int = 0, grain: float = GRAIN) -> Volume:
    """What a scanner makes of it: blur, and noise as a share of the contrast."""
    blurred = ndimage.gaussian_filter(share, BLUR)
    blurred += noise * np.random.default_rng(seed).standard_normal(share.shape)
    return Volume((RESIN + (grain - RESIN) * blurred).astype(np.float32), (1, 1, 1), "grey", "scan")


def labelled(grey: Volume, level: float = (RESIN + GRAIN) / 2) -> Volume:
    bright = ndimage.median_filter(grey.array, 3) >= level
    return Volume(ndimage.label(bright)[0].astype(np.uint16), (1, 1, 1), "labels", "grains")


def only(labels: Volume, grey: Volume | None, settings: ExtractionSettings = GREY) -> ExtractedParticle:
    (found,) = extract_particles(labels, settings, grey=grey).found
    return found


def ball(centre: np.ndarray, radius: float) -> Depth:
    return lambda points: radius - np.linalg.norm(points - centre, axis=-1)


def polyhedron(seed: int, n_facets: int) -> tuple[Depth, float, float]:
    """A random one of 24 voxels in diameter about (22, 22, 22), its volume and its area."""
    generator = np.random.default_rng(seed)
    normals = even_sphere(n_facets).vertices + 0.3 * generator.standard_normal((n_facets, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals @ random_rotation(generator).T
    offsets = generator.uniform(0.85, 1.15, n_facets)
    unit = ConvexHull(HalfspaceIntersection(np.column_stack([normals, -offsets]), np.zeros(3)).intersections)
    scale = 12.0 / (3 * unit.volume / 4 / np.pi) ** (1 / 3)
    centre = 22.0 + generator.uniform(-0.5, 0.5, 3)
    return (
        lambda points: (scale * offsets - (points - centre) @ normals.T).min(axis=-1),
        unit.volume * scale**3,
        unit.area * scale**2,
    )


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_that_a_blurred_ball_of_24_voxels_has_its_volume_and_area(noise: float) -> None:
    grey = scanned(coverage(ball(np.array([20.3, 19.8, 20.45]), 12.0), (41, 41, 41)), noise)
    found = only(labelled(grey), grey)
    assert found.surface == "grey"
    assert found.particle.mesh.volume == pytest.approx(4 / 3 * np.pi * 12**3, rel=4e-3)
    assert found.particle.mesh.surface_area == pytest.approx(4 * np.pi * 12**2, rel=0.02)
    assert found.particle.mesh.centroid == pytest.approx([20.3, 19.8, 20.45], abs=0.05)


def test_that_an_ellipsoid_in_voxels_that_are_no_cubes_has_its_volume() -> None:
    edges, axes = np.array([1.0, 1.0, 1.5]), np.array([17.0, 13.0, 15.0])
    depth: Depth = lambda p: (1 - np.sqrt((((p - 24.2) * edges / axes) ** 2).sum(-1))) * 10.0  # noqa: E731
    grey = scanned(coverage(depth, (49, 49, 49)), 0.03)
    grey, labels = (
        Volume(grey.array, edges, "grey", "scan"),
        Volume(labelled(grey).array, edges, "labels", ""),
    )
    found = only(labels, grey)
    assert found.particle.mesh.volume == pytest.approx(4 / 3 * np.pi * axes.prod(), rel=4e-3)


@pytest.mark.parametrize(("seed", "n_facets"), [(0, 40), (1, 14), (2, 14), (3, 8)])
def test_that_a_blurred_polyhedron_has_its_volume_where_its_mask_lacks_two_percent(
    seed: int, n_facets: int
) -> None:
    depth, volume, area = polyhedron(seed, n_facets)
    grey = scanned(coverage(depth, (45, 45, 45)), 0.03, seed)
    labels = labelled(grey)
    by_mask, by_grey = only(labels, None).particle.mesh, only(labels, grey).particle.mesh
    assert by_mask.volume < 0.98 * volume
    assert by_grey.volume == pytest.approx(volume, rel=4e-3)
    assert abs(by_grey.surface_area - area) < abs(by_mask.surface_area - area)


@pytest.mark.parametrize("level", [85.0, 115.0])
def test_that_the_volume_does_not_depend_on_the_threshold(level: float) -> None:
    grey = scanned(coverage(ball(np.array([20.3, 19.8, 20.4]), 12.0), (41, 41, 41)))
    labels = labelled(grey, level)
    assert abs(only(labels, None).particle.mesh.volume / (4 / 3 * np.pi * 12**3) - 1) > 0.03
    assert only(labels, grey).particle.mesh.volume == pytest.approx(4 / 3 * np.pi * 12**3, rel=4e-3)


def test_that_dark_grains_are_as_good_as_bright_ones() -> None:
    share = coverage(ball(np.array([20.3, 19.8, 20.4]), 12.0), (41, 41, 41))
    bright, dark = scanned(share), scanned(share, grain=RESIN - (GRAIN - RESIN))
    labels = labelled(bright)
    assert only(labels, dark).particle.mesh.volume == pytest.approx(
        only(labels, bright).particle.mesh.volume, rel=1e-5
    )


def test_that_two_balls_that_touch_are_parted_where_their_masks_are() -> None:
    """Two balls of radius 12 whose centres are 20 apart: each lacks a cap of height 2."""
    left, right = np.array([18.2, 20.1, 20.3]), np.array([38.2, 20.1, 20.3])
    share = np.maximum(*(coverage(ball(centre, 12.0), (57, 41, 41)) for centre in (left, right)))
    grey = scanned(share, 0.03)
    side = np.arange(57)[:, None, None]
    labels = np.where(labelled(grey).array > 0, np.where(side <= 28, 1, 2), 0).astype(np.uint8)
    found = extract_particles(Volume(labels, (1, 1, 1), "labels", "two"), GREY, grey=grey).found
    cap = np.pi * 2**2 * (12 - 2 / 3)
    for each, centre in zip(found, (left, right), strict=True):
        assert each.surface == "grey"
        # the plane between the masks lies at 28.5, 0.3 voxels from the one between the centres
        moved = np.pi * (12**2 - 10**2) * 0.3 * (1 if centre is left else -1)
        assert each.particle.mesh.volume == pytest.approx(4 / 3 * np.pi * 12**3 - cap + moved, rel=0.01)


@pytest.mark.slow
def test_that_a_ball_that_touches_six_others_is_no_larger_than_one_alone() -> None:
    """With all brightness about the contacts counted for both sides it came out 2.5 % too large."""
    centre, radius = np.full(3, 34.3), 11.0
    neighbours = [centre + 2 * radius * sign * axis for axis in np.eye(3) for sign in (1, -1)]
    share = sum(coverage(ball(each, radius), (69, 69, 69), fine=3) for each in [centre, *neighbours])
    grey = scanned(np.minimum(share, 1.0), 0.03)
    labels = segment(grey).labels
    middle = labels.array[34, 34, 34]
    found = extract_particles(labels, GREY, grey=grey).found
    mesh = next(each.particle.mesh for each in found if each.label == middle)
    assert mesh.volume == pytest.approx(4 / 3 * np.pi * radius**3, rel=0.01)


def test_that_a_blur_that_differs_along_the_axes_stretches_nothing() -> None:
    """A blur of one length in voxels of 2 : 3 : 5 is three blurs in voxels; with one for all of them, extents
    along the finest axis were 3.8 % too large."""
    voxel = np.array([2.0, 3.0, 5.0])
    radius, centre = 11 * np.cbrt(voxel.prod()), 0.3 * voxel
    shape = tuple(int(2 * np.ceil(radius / edge) + 19) for edge in voxel)
    middle = (np.array(shape) // 2) * voxel + centre
    share = coverage(lambda at: (radius - np.linalg.norm(at * voxel - middle, axis=-1)) / voxel.max(), shape)
    values = RESIN + (GRAIN - RESIN) * ndimage.gaussian_filter(share, BLUR * np.cbrt(voxel.prod()) / voxel)
    grey = Volume(values.astype(np.float32), voxel, "grey", "scan")
    labels = Volume((values > (RESIN + GRAIN) / 2).astype(np.uint8), voxel, "labels", "grains")
    mesh = only(labels, grey).particle.mesh
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), 2 * radius, rtol=0.015)


def test_that_a_close_neighbour_takes_nothing_and_gives_nothing() -> None:
    centres = (np.array([18.2, 20.1, 20.3]), np.array([44.6, 20.1, 20.3]))
    share = sum(coverage(ball(centre, 12.0), (65, 41, 41)) for centre in centres)
    grey = scanned(share, 0.03)
    found = extract_particles(labelled(grey), GREY, grey=grey).found
    assert len(found) == 2
    for each in found:
        assert each.particle.mesh.volume == pytest.approx(4 / 3 * np.pi * 12**3, rel=4e-3)


def test_that_crumbs_that_are_no_grain_do_not_count() -> None:
    share = coverage(ball(np.array([20.3, 20.1, 20.2]), 12.0), (45, 41, 41))
    share[34:36, 19:22, 19:22] = 1.0
    grey = scanned(share)
    labels = Volume((labelled(grey).array == 1).astype(np.uint8), (1, 1, 1), "labels", "one")
    assert only(labels, grey).particle.mesh.volume == pytest.approx(4 / 3 * np.pi * 12**3, rel=4e-3)


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        (lambda mask: 100 + 0 * mask, "hardly brighter or darker"),
        (lambda mask: 60 + 80 * (mask & (np.arange(41) < 25)), "in part hardly brighter"),
        (lambda mask: 60 + 80 * ndimage.binary_erosion(mask, iterations=3), "hardly brighter or darker"),
    ],
)
def test_that_the_mask_is_taken_and_said_where_grey_values_do_not_tell(values, reason: str) -> None:
    mask = np.linalg.norm(np.moveaxis(np.indices((41, 41, 41)), 0, -1) - 20.0, axis=-1) <= 12.0
    noise = np.random.default_rng(0).standard_normal(mask.shape)
    grey = Volume((values(mask) + noise).astype(np.float32), (1, 1, 1), "grey", "odd")
    labels = Volume(mask.astype(np.uint8), (1, 1, 1), "labels", "ball")
    found = only(labels, grey)
    assert found.surface == "mask"
    assert reason in " ".join(found.particle.notes)
    assert found.particle.mesh.volume == pytest.approx(mask.sum())


def test_that_a_grain_that_fills_its_volume_has_the_surface_of_its_mask() -> None:
    mask = np.ones((20, 20, 20), dtype=np.uint8)
    grey = Volume(mask * np.float32(100), (1, 1, 1), "grey", "full")
    found = only(Volume(mask, (1, 1, 1), "labels", "full"), grey)
    assert "too little background" in " ".join(found.particle.notes)


def test_that_labels_without_grey_values_have_the_surfaces_of_masks() -> None:
    share = coverage(ball(np.array([20.3, 20.1, 20.2]), 12.0), (41, 41, 41))
    labels = labelled(scanned(share))
    found, plain = only(labels, None), only(labels, None, ExtractionSettings(exclude_border=False))
    assert found.surface == "mask"
    assert np.array_equal(found.particle.mesh.vertices, plain.particle.mesh.vertices)


def test_that_slabs_give_the_grey_surfaces_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    centres = (np.array([14.2, 14.1, 14.3]), np.array([14.2, 14.1, 36.3]))
    share = sum(coverage(ball(centre, 9.0), (30, 30, 52)) for centre in centres)
    grey = scanned(share, 0.05)
    whole = extract_particles(labelled(grey), GREY, grey=grey).found
    monkeypatch.setattr(volume_slabs, "SLAB_VOXELS", 1)
    monkeypatch.setattr(volume_slabs.slab_ranges, "__defaults__", (1,))
    thin = extract_particles(labelled(grey), GREY, grey=grey).found
    assert [each.surface for each in whole] == ["grey", "grey"]
    for one, other in zip(whole, thin, strict=True):
        assert np.array_equal(one.particle.mesh.vertices, other.particle.mesh.vertices)


def test_that_grey_values_of_another_shape_and_unknown_surfaces_are_refused() -> None:
    labels = Volume(np.ones((4, 4, 4), dtype=np.uint8), (1, 1, 1), "labels", "a")
    grey = Volume(np.ones((4, 4, 5), dtype=np.uint8), (1, 1, 1), "grey", "b")
    with pytest.raises(ValueError, match=r"shape \(4, 4, 4\) do not fit grey values of shape \(4, 4, 5\)"):
        extract_particles(labels, ExtractionSettings(min_voxels=1, exclude_border=False), grey=grey)
    with pytest.raises(InputError, match="surface must be one of grey, mask, got 'voxels'"):
        ExtractionSettings(surface="voxels")  # type: ignore[arg-type]


@pytest.mark.slow
def test_that_every_grain_of_the_shipped_scan_has_its_volume_within_two_percent() -> None:
    """Three minerals, one threshold: masks of the dark one are up to a fifth too small, others too large."""
    truth, grey = sample_volume("labels"), sample_volume("grey")
    labels = segment(grey).labels
    sizes = np.bincount(truth.array.ravel())
    errors = {}
    for surface in ("grey", "mask"):
        found = extract_particles(labels, ExtractionSettings(surface=surface), grey=grey).found
        true = [sizes[np.bincount(truth.array[labels.array == each.label]).argmax()] for each in found]
        measured = np.array([each.particle.mesh.volume for each in found]) / np.prod(grey.voxel_size)
        errors[surface] = measured / np.array(true) - 1
    assert len(errors["grey"]) > 40
    assert np.abs(errors["grey"]).max() < 0.02
    assert np.abs(errors["mask"]).max() > 0.15
    assert np.std(errors["grey"]) < 0.006 < 0.06 < np.std(errors["mask"])


def masks() -> list[np.ndarray]:
    generator = np.random.default_rng(0)
    holes = generator.random((24, 19, 31)) < 0.995
    blobs = ndimage.gaussian_filter(generator.standard_normal((21, 22, 23)), 2.0) > 0.0
    return [holes, blobs, ~blobs, blobs[:, ::2], np.zeros((3, 4, 5), dtype=bool)]


@pytest.mark.parametrize("case", range(5))
def test_that_depths_are_those_of_scipy_where_they_matter(case: int) -> None:
    mask = masks()[case]
    expected = np.minimum(ndimage.distance_transform_edt(mask), MAX_DEPTH)
    assert depth(mask) == pytest.approx(expected, abs=1e-6)
