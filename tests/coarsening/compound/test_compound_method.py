"""The compound method as a user meets it, judged by manifold3d and the exact box."""

import itertools

import numpy as np
import pytest
import trimesh

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.core.line_overlap import compound_distance
from regolith_studio.coarsening.stopping_criteria import coarsen_below
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe, relative_errors
from regolith_studio.errors import InputError
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.readers.particles import sample_particles
from tests.coarsening.compound.unions import dumbbell, manifold_of, measured, random_planes
from tests.geometry.solids import cuboid


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return dumbbell()


def test_that_a_compound_keeps_all_six_descriptors_where_a_convex_body_cannot(mesh: Mesh) -> None:
    found = coarsen(mesh, 24, "compound", settings={"parts": 2})
    errors = relative_errors(describe(mesh), describe(found.mesh), LOSS_KEYS)
    assert max(errors.values()) < 1e-6
    assert found.reason is None
    assert (found.n_parts, found.n_facets <= 24) == (2, True)
    convex = coarsen(mesh, 24)
    assert convex.errors["convex_hull_volume"] > 0.05
    assert found.jaccard_distance < 0.8 * convex.jaccard_distance


@pytest.mark.slow
def test_that_too_few_facets_for_two_parts_are_said_and_do_not_pass_for_the_fewest(mesh: Mesh) -> None:
    few = coarsen(mesh, 9, "compound")
    off = 100 * (1 - describe(few.mesh)["convex_hull_volume"] / describe(mesh)["convex_hull_volume"])
    assert few.reason == (
        "Two parts need 10 facets; with fewer the result is one convex polyhedron, which misses"
        f" convex hull volume by {off:.2g} %."
    )
    enough = coarsen_below(mesh, 0.01, method="compound", settings={"parts": 2})
    assert enough.n_parts == 2
    assert max(relative_errors(describe(mesh), describe(enough.mesh), LOSS_KEYS).values()) < 0.01
    assert coarsen_below(mesh, 0.01).errors["convex_hull_volume"] == pytest.approx(off / 100, rel=1e-3)


def test_that_the_distance_is_that_of_a_boolean_and_parts_lie_where_the_particle_lies(mesh: Mesh) -> None:
    found = coarsen(mesh, 20, "compound", settings={"parts": 2})
    union, particle = manifold_of(found.mesh), manifold_of(mesh)
    shared = (union ^ particle).volume()
    boolean = 1.0 - shared / (union.volume() + particle.volume() - shared)
    assert found.jaccard_distance == pytest.approx(boolean, abs=1e-3)
    solid = found.polyhedron
    assert isinstance(solid, ConvexCompound)
    moved = mesh.moved(shift=-found.centre)
    assert compound_distance(moved, solid) == pytest.approx(boolean, abs=1e-3)


@pytest.mark.slow
def test_that_parts_touch_on_demand_so_that_their_volumes_add_up(mesh: Mesh) -> None:
    found = coarsen(mesh, 24, "compound", settings={"parts": 2, "joint": "touch"})
    errors = relative_errors(describe(mesh), describe(found.mesh), LOSS_KEYS)
    assert max(errors.values()) < 1e-6
    solid = found.polyhedron
    assert isinstance(solid, ConvexCompound)
    one, two = map(manifold_of, solid.part_meshes)
    assert one.volume() + two.volume() == pytest.approx((one + two).volume(), rel=1e-6)
    assert len((one + two).decompose()) == 1


def test_that_parts_which_no_plane_separates_must_not_meet() -> None:
    apart = random_planes(0, 2)._replace(partner=np.full(20, -1))
    assert measured(apart._replace(partner=None))[2]
    assert not measured(apart)[2]


@pytest.mark.slow
def test_that_four_parts_of_an_agglutinate_touch_and_keep_six_descriptors() -> None:
    mesh = next(each.mesh for each in sample_particles() if each.name == "agglutinate-1")
    found = coarsen(mesh, 40, "compound", settings={"joint": "touch"})
    assert found.reason is None
    assert max(found.errors.values()) < 1e-6
    assert found.jaccard_distance < 0.5 * coarsen(mesh, 40).jaccard_distance
    solids = [manifold_of(part) for part in found.polyhedron.part_meshes]
    assert len(solids) > 2
    shared = [(a ^ b).volume() for a, b in itertools.combinations(solids, 2)]
    assert max(shared) < 1e-6 * found.target["volume"]


@pytest.mark.slow
def test_that_the_same_seed_gives_the_same_compound(mesh: Mesh) -> None:
    one, two = (coarsen(mesh, 16, "compound", settings={"parts": 2}, seed=3) for _ in range(2))
    assert one.mesh.content_hash == two.mesh.content_hash


@pytest.mark.slow
def test_that_a_weight_of_zero_frees_a_descriptor(mesh: Mesh) -> None:
    weights = LossWeights.of(jaccard_distance=1.0, volume=1.0, convex_hull_volume=1.0)
    found = coarsen(mesh, 16, "compound", weights, settings={"parts": 2})
    assert max(found.errors["volume"], found.errors["convex_hull_volume"]) < 1e-6
    assert found.errors["sphericity"] > 1e-6


def test_that_only_the_terms_named_are_kept_exactly(mesh: Mesh) -> None:
    """What is not named costs its weight, so that of a small one little is kept."""
    named = ["volume", "convex_hull_volume"]
    weights = LossWeights.of(
        jaccard_distance=10.0, volume=1.0, convex_hull_volume=1.0, sphericity=0.1
    ).keeping(named)
    found = coarsen(mesh, 16, "compound", weights, settings={"parts": 2})
    assert found.reason is None
    assert max(found.errors["volume"], found.errors["convex_hull_volume"]) <= 1e-6
    assert found.errors["sphericity"] > 1e-6


def test_that_a_compound_is_not_worse_than_one_convex_body(mesh: Mesh) -> None:
    weights = LossWeights.of(jaccard_distance=1.0, volume=1.0)
    one = coarsen(mesh, 12, "exact", weights)
    union = coarsen(mesh, 12, "compound", weights, settings={"parts": 2})
    assert union.reason is None
    assert union.jaccard_distance <= one.jaccard_distance + 1e-9


def test_that_a_convex_particle_gets_the_polyhedron_of_the_exact_method() -> None:
    brick = cuboid(3.0, 2.0, 1.0)
    found, exact = coarsen(brick, 12, "compound"), coarsen(brick, 12, "exact")
    assert isinstance(found.polyhedron, ConvexPolyhedron)
    assert found.n_parts == 1
    assert found.mesh.content_hash == exact.mesh.content_hash


def test_that_one_body_takes_the_place_of_two_poor_parts_and_says_what_it_misses(mesh: Mesh) -> None:
    found = coarsen(mesh, 10, "compound")
    assert found.n_parts == 1
    assert "No compound of 2 parts with 10 facets" in str(found.reason)
    assert "convex hull volume" in str(found.reason)


def test_that_parts_neither_overlap_nor_touch_is_one_sentence(mesh: Mesh) -> None:
    with pytest.raises(InputError, match="either overlap or touch, got 'weld'"):
        coarsen(mesh, 20, "compound", settings={"joint": "weld"})


@pytest.mark.parametrize("parts", [1, 9, 2.5, True])
def test_that_a_number_of_parts_out_of_range_is_one_sentence(mesh: Mesh, parts: float) -> None:
    with pytest.raises(InputError, match="must be a whole number"):
        coarsen(mesh, 20, "compound", settings={"parts": parts})


@pytest.mark.slow
def test_that_a_ring_whose_tunnel_is_lost_says_so() -> None:
    """Two convex parts cannot surround a tunnel."""
    ring = trimesh.creation.torus(30.0, 10.0, major_sections=24, minor_sections=12)
    found = coarsen(Mesh(ring.vertices, ring.faces), 24, "compound", settings={"parts": 2})
    assert found.genus == (1, 0)
    assert found.warning is not None
    assert "genus 1" in found.warning
    assert "genus 0" in found.warning
