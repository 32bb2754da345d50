"""Particles from label volumes: right volume, right area, nothing left out silently."""

import numpy as np
import pytest
import tifffile
from scipy import ndimage
from scipy.spatial import ConvexHull, HalfspaceIntersection
from scipy.special import ellipeinc, ellipkinc

from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging import volume_slabs
from regolith_studio.imaging.extraction import (
    border_weight,
    extract_particles,
    extraction_steps,
    pieces_of_cut_grains,
)
from regolith_studio.imaging.label_table import contact_areas, label_table
from regolith_studio.imaging.settings import ExtractionSettings
from regolith_studio.imaging.volume import Volume, sample_volume, touches
from tools.make_samples.grains import even_sphere, random_rotation

ALL = ExtractionSettings(exclude_border=False, min_voxels=0)


def grid(half: float, step=(1.0, 1.0, 1.0)) -> np.ndarray:
    axes = [np.arange(-n, n + 1) * s for s, n in ((s, int(np.ceil(half / s)) + 3) for s in step)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def labels(mask: np.ndarray, step=(1.0, 1.0, 1.0)) -> Volume:
    return Volume(mask.astype(np.uint8), step, "labels", "test")


def only_mesh(volume: Volume) -> Mesh:
    (particle,) = extract_particles(volume, ALL).particles
    return particle.mesh


def ellipsoid_area(a: float, b: float, c: float) -> float:
    """Legendre's formula for a > b > c."""
    angle = np.arccos(c / a)
    k = a**2 * (b**2 - c**2) / (b**2 * (a**2 - c**2))
    bracket = ellipeinc(angle, k) * np.sin(angle) ** 2 + ellipkinc(angle, k) * np.cos(angle) ** 2
    return 2 * np.pi * c**2 + 2 * np.pi * a * b / np.sin(angle) * bracket


@pytest.mark.parametrize("diameter", [24.0, 41.0])
def test_that_a_ball_of_24_voxels_has_its_volume_and_area(diameter: float) -> None:
    mask = np.linalg.norm(grid(diameter / 2) - [0.3, -0.2, 0.4], axis=-1) <= diameter / 2
    mesh = only_mesh(labels(mask))
    assert mesh.volume == pytest.approx(np.pi / 6 * diameter**3, rel=5e-3)
    assert mesh.surface_area == pytest.approx(np.pi * diameter**2, rel=5e-3)


@pytest.mark.parametrize("seed", range(4))
def test_that_an_ellipsoid_of_24_voxels_has_its_volume_and_area(seed: int) -> None:
    axes = 12.0 * np.array([1.5, 1.1, 1 / 1.65])
    turn = random_rotation(np.random.default_rng(seed))
    mesh = only_mesh(labels((((grid(18.0) - 0.25) @ turn / axes) ** 2).sum(axis=-1) <= 1.0))
    assert mesh.volume == pytest.approx(4 / 3 * np.pi * axes.prod(), rel=5e-3)
    assert mesh.surface_area == pytest.approx(ellipsoid_area(*axes), rel=0.012)


@pytest.mark.parametrize(("seed", "n_facets"), [(0, 14), (1, 14), (2, 8), (3, 8), (4, 40)])
def test_that_a_polyhedron_of_24_voxels_has_its_volume_and_area(seed: int, n_facets: int) -> None:
    generator = np.random.default_rng(seed)
    normals = even_sphere(n_facets).vertices + 0.3 * generator.standard_normal((n_facets, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = generator.uniform(0.85, 1.15, n_facets)
    unit = ConvexHull(HalfspaceIntersection(np.column_stack([normals, -offsets]), np.zeros(3)).intersections)
    scale = 12.0 / (3 * unit.volume / 4 / np.pi) ** (1 / 3)
    reach = scale * np.linalg.norm(unit.points, axis=1).max()
    mask = ((grid(reach) - 0.25) @ normals.T <= scale * offsets).all(axis=-1)
    mesh = only_mesh(labels(mask))
    assert mesh.volume == pytest.approx(unit.volume * scale**3, rel=5e-3)
    assert mesh.surface_area == pytest.approx(unit.area * scale**2, rel=0.015)


def test_that_anisotropic_voxels_give_the_same_ball_in_micrometres() -> None:
    step = (1.0, 1.0, 1.5)
    mask = np.linalg.norm(grid(25.0, step), axis=-1) <= 25.0
    mesh = only_mesh(labels(mask, step))
    assert mesh.volume == pytest.approx(4 / 3 * np.pi * 25.0**3, rel=5e-3)
    assert mesh.surface_area == pytest.approx(4 * np.pi * 25.0**2, rel=0.01)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx(50.0, rel=0.03)


def test_that_particles_stay_where_they_were_in_the_volume() -> None:
    array = np.zeros((40, 30, 50), dtype=np.uint16)
    array[20:32, 5:17, 30:42] = 7
    (particle,) = extract_particles(Volume(array, (2.0, 2.0, 2.0), "labels", "t")).particles
    assert particle.name == "particle_0007"
    assert particle.mesh.centroid == pytest.approx([51.0, 21.0, 71.0], abs=0.02)
    assert particle.mesh.volume == pytest.approx(12**3 * 8)


def test_that_border_and_small_labels_are_left_out_and_counted() -> None:
    array = np.zeros((40, 40, 40), dtype=np.int32)
    array[0:12, 10:22, 10:22] = 1
    array[20:32, 20:32, 20:32] = 2
    array[5:8, 30:33, 30:33] = 9
    volume = Volume(array, (1.0, 1.0, 1.0), "labels", "t")
    kept = extract_particles(volume)
    assert (kept.labels, kept.border, kept.small) == ((2,), (1,), (9,))
    assert "1 at the border, 1 too small" in kept.summary
    everything = extract_particles(volume, ALL)
    assert everything.labels == (1, 2, 9)
    assert everything.weights == (1.0, 1.0, 1.0)
    assert all(particle.mesh.volume > 0 for particle in everything.particles)


def test_that_separate_parts_and_closed_pores_are_mended_and_said() -> None:
    array = np.zeros((30, 30, 30), dtype=np.uint8)
    array[3:18, 3:18, 3:18] = 1
    array[9:11, 9:11, 9:11] = 0
    array[22:24, 22:24, 22:24] = 1
    (particle,) = extract_particles(Volume(array, (1.0, 1.0, 1.0), "labels", "t")).particles
    assert particle.mesh.volume == pytest.approx(15**3)
    assert any("2 separate parts" in note and "8 voxels dropped" in note for note in particle.notes)
    assert any("pores of 8 voxels" in note for note in particle.notes)


def test_that_what_is_kept_of_a_label_is_what_is_weighed() -> None:
    """Two strays in the corners of the volume made the box that of the volume, and the weight 84,480."""
    array = np.zeros((40, 40, 40), dtype=np.uint8)
    array[10:22, 12:24, 14:26] = 1
    clean = extract_particles(Volume(array.copy(), (1, 1, 1), "labels", "clean")).found[0]
    array[0, 0, 0] = array[39, 39, 39] = 1
    stray = extract_particles(Volume(array, (1, 1, 1), "labels", "stray"))
    (found,) = stray.found
    assert stray.border == ()
    assert found.weight == pytest.approx((40 / 27) ** 3) == clean.weight
    assert found.n_voxels == 12**3 == clean.n_voxels
    assert np.array_equal(found.particle.mesh.vertices, clean.particle.mesh.vertices)
    assert "3 separate parts; the largest was kept, 2 voxels dropped" in " ".join(found.particle.notes)


@pytest.mark.parametrize(("edges", "thin"), [((36, 9, 9), True), ((36, 36, 7), True), ((20, 20, 20), False)])
def test_that_the_warning_of_few_voxels_goes_by_the_thinnest_extent(
    edges: tuple[int, int, int], thin: bool
) -> None:
    """An ellipsoid with these axes: the ball of a needle's volume has 14 voxels across, of a plate's 21."""
    at = np.moveaxis(np.indices((44, 44, 44)), 0, -1) - 21.5
    mask = ((2 * at / edges) ** 2).sum(axis=-1) <= 1
    (found,) = extract_particles(Volume(mask.astype(np.uint8), (1, 1, 1), "labels", "one")).found
    notes = " ".join(found.particle.notes)
    assert ("voxels in diameter where it is thinnest" in notes) == bool(notes) == thin
    assert not thin or float(notes.split()[1]) == pytest.approx(min(edges), abs=0.3)


@pytest.mark.parametrize(
    ("volume", "message"),
    [
        (Volume(np.ones((3, 3, 3)), (1, 1, 1), "grey", "g"), "segment it"),
        (Volume(np.zeros((3, 3, 3), dtype=int), (1, 1, 1), "labels", "g"), "no particle"),
        (Volume(np.full((3, 3, 3), 10**9), (1, 1, 1), "labels", "g"), "without gaps"),
    ],
)
def test_that_volumes_without_usable_labels_are_refused(volume: Volume, message: str) -> None:
    with pytest.raises(InputError, match=message):
        extract_particles(volume)


def test_that_settings_without_meaning_are_refused() -> None:
    with pytest.raises(InputError, match="min_voxels must be a whole number"):
        ExtractionSettings(min_voxels=-1)
    with pytest.raises(InputError, match="pass_band must be a number"):
        ExtractionSettings(pass_band=0.0)


def test_that_a_mask_of_one_type_or_another_gives_the_same_particle() -> None:
    mask = np.linalg.norm(grid(9.0), axis=-1) <= 9.0
    hashes = {
        only_mesh(Volume(mask.astype(dtype), (1, 1, 1), "labels", "t")).content_hash
        for dtype in (bool, np.uint8, np.int64, np.uint32)
    }
    assert len(hashes) == 1


def test_that_the_border_weight_counts_the_places_of_a_grain() -> None:
    """Of N places of its first voxel along an axis, those that keep the whole grain off both borders."""
    n = 20
    for length in (1, 5, 17):
        kept = sum(first >= 1 and first + length <= n - 1 for first in range(n))
        box = (slice(3, 3 + length), slice(0, 1), slice(0, 1))
        assert border_weight(box, (n, 10**9, 10**9)) == pytest.approx(n / kept)


def scattered_grains(generator: np.random.Generator, size: int = 64, rim: int = 24) -> tuple[Volume, list]:
    """A scan cut out of a field of separate ellipsoids, and the voxels of each whose centre is in it."""
    field = np.zeros((size + 2 * rim,) * 3, dtype=np.uint16)
    counts = []
    for label, small in enumerate(generator.random(60) < 0.5, start=1):
        axes = (2.4 if small else 9.0) * generator.uniform(0.8, 1.25, 3)
        centre = generator.uniform(12, size + 2 * rim - 13, 3)
        low, high = np.ceil(centre - axes).astype(int), np.floor(centre + axes).astype(int) + 1
        points = np.stack(np.meshgrid(*map(np.arange, low, high), indexing="ij"), axis=-1)
        mask = (((points - centre) / axes) ** 2).sum(axis=-1) <= 1.0
        box = tuple(map(slice, low, high))
        if not field[box][mask].any():
            field[box][mask] = label
            if ((centre >= rim) & (centre < rim + size)).all():
                counts.append(np.count_nonzero(mask))
    return Volume(field[(slice(rim, -rim),) * 3], (1, 1, 1), "labels", "t"), counts


@pytest.mark.slow
def test_that_weighted_grains_have_the_mean_volume_of_all() -> None:
    """Monte Carlo: 300 scans of a mixture of small and large grains."""
    generator = np.random.default_rng(0)
    truth, volumes, weights = [], [], []
    for _ in range(300):
        volume, counts = scattered_grains(generator)
        truth.extend(counts)
        table = label_table(volume)
        for box, n_voxels in zip(table.boxes().values(), table.counts, strict=True):
            if not touches(box, volume.shape):
                volumes.append(n_voxels)
                weights.append(border_weight(box, volume.shape))
    expected = np.mean(truth)
    assert np.mean(volumes) < 0.7 * expected
    assert np.average(volumes, weights=weights) == pytest.approx(expected, rel=0.04)


@pytest.mark.slow
def test_that_slabs_give_the_particles_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    volume = sample_volume("labels")
    whole = extract_particles(volume)
    monkeypatch.setattr(volume_slabs.slab_ranges, "__defaults__", (1,))
    thin = extract_particles(volume)
    assert (thin.labels, thin.border, thin.small) == (whole.labels, whole.border, whole.small)
    assert [p.mesh.content_hash for p in thin.particles] == [p.mesh.content_hash for p in whole.particles]
    story = list(extraction_steps(volume, make=str))
    assert [step.done for step in story] == list(range(1, 48))


def test_that_the_table_of_labels_is_that_of_scipy() -> None:
    volume = sample_volume("labels")
    table = label_table(volume)
    expected = ndimage.find_objects(volume.array.astype(int))
    assert table.boxes() == dict(enumerate(expected, start=1))
    assert table.counts.tolist() == np.bincount(volume.array.ravel())[1:].tolist()


@pytest.mark.slow
def test_that_the_shipped_scan_gives_47_closed_particles() -> None:
    volume = sample_volume("labels")
    extraction = extract_particles(volume)
    assert (len(extraction.particles), len(extraction.border), len(extraction.small)) == (47, 13, 0)
    counts = np.bincount(volume.array.ravel())
    for particle, label in zip(extraction.particles, extraction.labels, strict=True):
        assert particle.mesh.volume == pytest.approx(counts[label] * 2.3**3, rel=0.02)
        edges = np.sort(particle.mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


@pytest.mark.slow
def test_that_the_real_label_volume_comes_in(real_data) -> None:
    array = tifffile.imread(real_data("cement140/labels_256.tif"))
    extraction = extract_particles(Volume(array.T, (1, 1, 1), "labels", "cement"))
    assert len(extraction.particles) + len(extraction.border) + len(extraction.small) == 150
    assert all(particle.mesh.volume > 0 for particle in extraction.particles)


def test_that_the_contact_of_two_halves_of_a_ball_has_the_area_of_its_cross_section() -> None:
    places = grid(12.0)
    ball = np.linalg.norm(places, axis=-1) <= 12.0
    for normal in ([1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.48, 0.6, 0.64]):
        halves = np.where(places @ normal > 0.3, 2, 1) * ball
        ((pair, area),) = contact_areas(
            Volume(halves.astype(np.uint8), (1, 1, 1), "labels", "halves")
        ).items()
        assert pair == (1, 2)
        assert area == pytest.approx(np.pi * 12.0**2, rel=0.08)


def test_that_a_lobe_of_a_cut_grain_is_left_out_with_it_and_a_grain_that_touches_it_is_kept() -> None:
    """Two balls of radius 9 whose centres are 9 apart share a disc of .87 radii; at 17.5 of .23."""
    at = np.stack(np.meshgrid(*[np.arange(60)] * 3, indexing="ij"), axis=-1)
    for distance, kept in ((9.0, 1), (17.5, 2)):
        near = [np.linalg.norm(at - [x, 30, 30], axis=-1) for x in (4.0, 4.0 + distance, 45.0)]
        solid = np.min(near, axis=0) <= 9.0
        numbers = np.where(solid, np.argmin(near, axis=0) + 1, 0).astype(np.uint8)
        grey = Volume((solid * 200).astype(np.uint8), (1, 1, 1), "grey", "scan")
        cut = Volume(numbers, (1, 1, 1), "labels", "labels")
        found = extract_particles(cut, grey=grey)
        assert len(found.labels) == kept
        assert len(extract_particles(cut).labels) == 2  # labels that were given are taken as they are
    sizes = {1: 900, 2: 9000, 3: 900, 4: 9000}
    necks = {(1, 2): 90.0, (2, 3): 90.0, (2, 4): 90.0}
    assert pieces_of_cut_grains(necks, sizes, [1]) == [2, 3]  # discs of 10.7; balls of 12.0 and 25.8


@pytest.mark.parametrize(("width", "left_out"), [(0.64, []), (0.66, [2]), (0.92, [2]), (0.94, [1, 2])])
def test_that_the_rest_of_a_cut_grain_takes_larger_labels_along_only_over_wider_necks(
    width: float, left_out: list[int]
) -> None:
    """Diameters of 20 and 10: label 2 touches a larger rest of a grain, label 1 a smaller one.

    Balls of 20 that touch close a gap of 2.16 over a disc of .93 times 10: 2 sqrt(2 * 2.16 * 5) = 9.3.
    """
    sizes = {label: round(np.pi / 6 * diameter**3) for label, diameter in enumerate((20, 10, 20, 10), 1)}
    area = np.pi / 4 * (10 * width) ** 2
    assert pieces_of_cut_grains({(2, 3): area, (1, 4): area}, sizes, [3, 4]) == left_out
