"""Packing inside a heap, against crystals and volumes that are known."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.case import PreparedCase, ReposeCase, ShapeKind, prepare
from regolith_studio.dem.heap_packing import HeapPacking, measure_packing, within_particles
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.dem.verification.bodies import cuboid
from tests.dem.packings import cone

CUBE = cuboid(1, 1, 1).vertices
FACE_CENTRED = np.array([[0, 0, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]]) * np.sqrt(2)
"""Centres of touching balls of diameter 1 in a cell of edge sqrt(2)."""


def crystal_heap(cell: np.ndarray, edge: float, height: float = 12.0, slope: float = 0.7) -> np.ndarray:
    """Places of a lattice below a cone on z = 0, shape (n, 3)."""
    reach = int(np.ceil(height / slope / edge)) + 1
    steps = np.arange(-reach, reach + 1)
    corners = edge * np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    places = (corners[:, None] + cell).reshape(-1, 3) + np.array([0.013, 0.007, 0.5])
    return places[(places[:, 2] > 0.4) & (places[:, 2] < height - slope * np.hypot(*places[:, :2].T))]


def packing(
    places: np.ndarray, kind: ShapeKind, diameter: float, turn: Rotation | None = None
) -> HeapPacking | None:
    n = len(places)
    prepared = PreparedCase(
        ReposeCase(n_particles=n, shapes=kind), (CUBE,), np.zeros(n, dtype=int), np.full(n, diameter), 1.0
    )
    turns = np.tile((turn or Rotation.identity()).as_quat(scalar_first=True), (n, 1))
    heap = ParticleState(places, prepared.diameters, turns, prepared.class_index)
    return measure_packing(prepared, heap, measure_repose(places, diameter, base=0.0))


def test_that_close_packed_balls_fill_74_percent_and_touch_12_others() -> None:
    found = packing(crystal_heap(FACE_CENTRED, np.sqrt(2)), "spheres", 1.0)
    assert found is not None
    assert found.solid_fraction == pytest.approx(np.pi / np.sqrt(18), abs=0.01)
    assert found.coordination_number == 12.0


@pytest.mark.parametrize(("distance", "contacts"), [(1.005, 26.0), (1.03, 0.0)])
def test_that_cubes_on_a_lattice_touch_if_the_gap_is_within_the_margin(
    distance: float, contacts: float
) -> None:
    """Six facets, twelve edges and eight corners; a cube of edge 1 has a diameter of 1.24."""
    diameter = (6 / np.pi) ** (1 / 3)
    found = packing(crystal_heap(np.zeros((1, 3)), distance), "polyhedra", diameter)
    assert found is not None
    assert found.solid_fraction == pytest.approx(distance**-3, abs=0.01)
    assert found.coordination_number == contacts


def test_that_a_small_heap_has_no_packing() -> None:
    assert packing(cone(25, 200, 1), "spheres", 1.0) is None


def test_that_points_within_particles_have_the_share_of_their_volumes(boxes: Dataset) -> None:
    """Turned cuboids that are far apart, in a box of known volume."""
    prepared = prepare(boxes, ReposeCase(LiftingCylinderTest(mass=1e-4), n_particles=27, seed=3))
    pitch = 2.2 * prepared.diameters.max()
    places = pitch * np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    turns = Rotation.random(27, random_state=1).as_quat(scalar_first=True)
    particles = ParticleState(places, prepared.diameters, turns, prepared.class_index)
    points = np.random.default_rng(0).uniform(-pitch / 2, 2.5 * pitch, (200_000, 3))
    share = (np.pi / 6 * prepared.diameters**3).sum() / (3 * pitch) ** 3
    assert within_particles(prepared, particles, points).mean() == pytest.approx(share, rel=0.02)
