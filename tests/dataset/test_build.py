"""Datasets from particles: unit volume, principal axes, weights that add up, and the way back."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.dataset.build import build_dataset, software_versions
from regolith_studio.dataset.dataset import Dataset, Frame, aligned, principal_axes, rebuilt
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.size_distributions import (
    DiscreteSizeDistribution,
    LogNormalSizeDistribution,
    ShapeClass,
    equivalent_diameter,
)
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import InputError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.particle import Particle
from tools.make_samples.samples import GRAINS

from .example import entry, polyhedron


def box(a: float, b: float, c: float) -> ConvexPolyhedron:
    return ConvexPolyhedron.from_half_spaces(
        HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.array([a, b, c, a, b, c]) / 2)
    )


def rotation(seed: int) -> np.ndarray:
    q, r = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


@pytest.mark.parametrize("seed", range(5))
def test_that_shapes_have_unit_volume_and_lie_along_their_principal_axes(seed: int) -> None:
    shape, _ = aligned(polyhedron(seed))
    hull = ConvexHull(shape.vertices)
    assert hull.volume == pytest.approx(1.0, rel=1e-12)
    assert np.abs(shape.centroid).max() < 1e-12
    inertia = shape.mesh.inertia
    assert np.abs(inertia - np.diag(np.diag(inertia))).max() < 1e-12
    assert (np.diff(np.diag(inertia)) >= 0).all()


def test_that_the_longest_edge_of_a_turned_box_comes_to_lie_along_x() -> None:
    turned = box(1.0, 4.0, 2.0).moved(rotation=rotation(1))
    shape, frame = aligned(turned)
    assert np.ptp(shape.vertices, axis=0) == pytest.approx(np.array([4.0, 2.0, 1.0]) / 2)
    assert frame.scale == pytest.approx(2.0)


@pytest.mark.parametrize("seed", range(5))
def test_that_a_turned_and_scaled_particle_gives_the_same_shape(seed: int) -> None:
    solid = polyhedron(seed)
    one, _ = aligned(solid)
    other, _ = aligned(solid.moved(rotation=rotation(seed + 10), scale=3.0))
    assert other.half_spaces.normals == pytest.approx(one.half_spaces.normals, abs=1e-8)
    assert other.half_spaces.offsets == pytest.approx(one.half_spaces.offsets, abs=1e-8)


def test_that_the_frame_leads_back_to_the_particle() -> None:
    particle, coarse = entry(3)
    shape, frame = aligned(coarse.polyhedron, coarse.centre)
    back = shape.vertices @ frame.rotation * frame.scale + frame.centroid
    assert np.ptp(back, axis=0) == pytest.approx(np.ptp(particle.mesh.vertices, axis=0))
    assert ConvexHull(back).volume == pytest.approx(particle.mesh.volume)
    assert back.mean(axis=0) == pytest.approx(coarse.polyhedron.vertices.mean(axis=0) + coarse.centre)


def test_that_axes_are_right_handed_even_for_a_cube() -> None:
    axes = principal_axes(box(1, 1, 1).mesh)
    assert axes @ axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_that_a_rebuilt_polyhedron_does_not_change_when_it_is_rebuilt_again() -> None:
    for seed in range(10):
        once, _ = aligned(polyhedron(seed))
        twice = rebuilt(once.half_spaces)
        assert np.array_equal(once.half_spaces.normals, twice.half_spaces.normals)
        assert np.array_equal(once.vertices, twice.vertices)
        assert once.facets == twice.facets


def test_that_each_entry_stands_for_itself_by_default() -> None:
    entries = [entry(seed) for seed in range(3)]
    dataset = build_dataset(entries)
    assert dataset.weights == pytest.approx([1 / 3] * 3)
    for representative, (particle, _) in zip(dataset.representatives, entries, strict=True):
        assert representative.sizes.quantile(0.5) == pytest.approx(equivalent_diameter(particle.mesh.volume))
        assert representative.source == particle.source
    assert abs(dataset.weights.sum() - 1) < 1e-12


def test_that_classes_bring_their_weights_and_sizes() -> None:
    sizes = [LogNormalSizeDistribution(median_um=median, log_deviation=0.2) for median in (40.0, 80.0)]
    classes = [ShapeClass(3, sizes[0], 3), ShapeClass(1, sizes[1], 1)]
    dataset = build_dataset([entry(0), entry(1)], classes)
    assert dataset.weights.tolist() == [0.75, 0.25]
    assert [r.sizes for r in dataset.representatives] == sizes
    assert [r.n_members for r in dataset.representatives] == [3, 1]


def test_that_one_size_distribution_can_serve_all_classes() -> None:
    sizes = DiscreteSizeDistribution.of([25, 37, 56, 84, 125], [1, 1, 1, 1, 1])
    dataset = build_dataset([entry(0), entry(1)], sizes=sizes)
    assert all(representative.sizes == sizes for representative in dataset.representatives)


def test_that_weights_by_volume_favour_the_class_of_big_particles() -> None:
    classes = [ShapeClass(1, DiscreteSizeDistribution.empirical([d])) for d in (10.0, 20.0)]
    dataset = build_dataset([entry(0), entry(1)], classes)
    assert dataset.class_weights("volume") == pytest.approx([1 / 9, 8 / 9])
    by_volume = build_dataset([entry(0), entry(1)], classes, weighting="volume")
    assert by_volume.class_weights("number") == pytest.approx([8 / 9, 1 / 9])


def test_that_particles_of_the_same_name_are_told_apart() -> None:
    dataset = build_dataset([entry(0), entry(0)])
    assert [r.name for r in dataset.representatives] == ["grain-0", "grain-0_2"]


def test_that_software_versions_are_recorded() -> None:
    dataset = build_dataset([entry(0)])
    assert dataset.provenance.software == software_versions()
    assert {"regolith-studio", "numpy", "scipy"} <= set(software_versions())


def test_that_a_dataset_of_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="at least one particle"):
        build_dataset([])
    with pytest.raises(InputError, match="need 1 classes"):
        build_dataset([entry(0)], [])


def test_that_a_dataset_checks_itself() -> None:
    good = build_dataset([entry(0), entry(1)])
    with pytest.raises(ValueError, match="add up to 1"):
        Dataset("x", good.representatives[:1])
    with pytest.raises(ValueError, match="at least one"):
        Dataset("x", ())
    with pytest.raises(ValueError, match="different names"):
        Dataset("x", (good.representatives[0],) * 2)


def test_that_a_particle_coarsened_by_the_program_becomes_a_dataset(tmp_path) -> None:
    particle = Particle("angular-2", next(g for g in GRAINS if g.name == "angular-2").mesh())
    coarse = coarsen(particle.mesh, n_facets=20, method="quadric")
    dataset = build_dataset([(particle, coarse)])
    assert validate_dataset(write_dataset(tmp_path / "set", dataset)) == []
    (one,) = dataset.representatives
    assert one.shape.n_facets == coarse.n_facets
    assert one.approximation.errors == dict(coarse.errors)
    back = one.shape.vertices @ one.frame.rotation * one.frame.scale + one.frame.centroid
    assert np.sort(back, axis=0) == pytest.approx(np.sort(coarse.mesh.vertices, axis=0), abs=1e-6)


def test_that_a_frame_without_a_rotation_is_refused() -> None:
    with pytest.raises(ValueError, match="proper rotation"):
        Frame(-np.eye(3), np.zeros(3), 1.0)
