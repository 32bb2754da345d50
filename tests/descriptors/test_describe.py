"""Describing a particle, and refusing what is none."""

import pickle

import numpy as np
import pytest

from regolith_studio.descriptors.catalogue import DEFAULT_KEYS
from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.errors import GeometryError
from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces, Mesh
from tests.geometry.solids import cuboid, random_polyhedron

PLANES = HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), [1.5, 1.0, 0.5, 1.5, 1.0, 0.5])


def test_that_the_default_holds_all_quick_descriptors_in_the_order_of_the_catalogue() -> None:
    assert tuple(describe(cuboid(3.0, 2.0, 1.0))) == DEFAULT_KEYS


def test_that_only_what_is_asked_for_is_worked_out() -> None:
    some = describe(cuboid(3.0, 2.0, 1.0), keys=["surface_area", "volume"])
    assert dict(some) == pytest.approx({"volume": 6.0, "surface_area": 22.0})
    assert list(some) == ["volume", "surface_area"]


def test_that_a_polyhedron_and_its_mesh_are_described_alike() -> None:
    solid = ConvexPolyhedron.from_half_spaces(PLANES)
    assert dict(describe(solid)) == pytest.approx(dict(describe(cuboid(3.0, 2.0, 1.0))), rel=1e-12)


def test_that_the_box_of_trimesh_is_offered_and_differs() -> None:
    gaps = []
    for seed in range(12):
        solid = random_polyhedron(seed)
        exact, heuristic = describe(solid), describe(solid, box_metric="trimesh")
        assert heuristic["volume"] == exact["volume"]
        gaps.append(abs(heuristic["min_diameter"] / exact["min_diameter"] - 1.0))
    assert max(gaps) > 0.01


def test_that_values_cannot_be_changed_and_survive_pickling() -> None:
    values = describe(cuboid(3.0, 2.0, 1.0))
    with pytest.raises(TypeError):
        values["volume"] = 1.0  # type: ignore[index]
    with pytest.raises(AttributeError):
        values._values = {}
    again = pickle.loads(pickle.dumps(values))
    assert again == values
    assert hash(again) == hash(values)


def test_that_unknown_keys_and_metrics_are_refused() -> None:
    with pytest.raises(ValueError, match="unknown descriptors"):
        describe(cuboid(1.0, 1.0, 1.0), keys=["beauty"])
    with pytest.raises(ValueError, match="unknown descriptors"):
        Descriptors({"beauty": 1.0})
    with pytest.raises(ValueError, match="box_metric"):
        describe(cuboid(1.0, 1.0, 1.0), box_metric="guess")


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (Mesh(np.zeros((0, 3)), np.zeros((0, 3))), "has 0 faces"),
        (Mesh(np.eye(3), np.array([[0, 1, 2]])), "has 1 faces"),
        (Mesh(np.zeros((4, 3)), np.array([[0, 1, 2]] * 4)), "flat"),
        (Mesh(cuboid(1.0, 1.0, 1.0).vertices * [1.0, 1.0, 0.0], cuboid(1.0, 1.0, 1.0).faces), "flat"),
        (Mesh(cuboid(1.0, 1.0, 1.0).vertices, cuboid(1.0, 1.0, 1.0).faces[:, ::-1]), "inside out"),
    ],
)
def test_that_a_mesh_without_volume_is_refused_in_one_sentence(mesh: Mesh, words: str) -> None:
    with pytest.raises(GeometryError, match=words) as refusal:
        describe(mesh)
    assert str(refusal.value).endswith(".")
    assert "\n" not in str(refusal.value)
