"""Large heaps: what is left out cannot be seen, and what stands for it while the view turns looks alike."""

import numpy as np
import pytest
import pyvista as pv
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from benchmarks.heaps import HeapKind, heap
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.scene import cameras, instancing, plotter_setup
from tests.dataset.example import polyhedron

N = 6000
MILLIMETRE = 1e-3


@pytest.fixture(scope="module")
def pile() -> ParticleState:
    centres, diameters = (each[:N] for each in heap(35.0, N, 1, HeapKind()))
    turns = Rotation.random(N, random_state=2).as_quat(scalar_first=True)
    return ParticleState(
        MILLIMETRE * centres, MILLIMETRE * diameters, turns, np.random.default_rng(3).integers(0, 3, N)
    )


@pytest.fixture(scope="module")
def shapes() -> list[list[np.ndarray]]:
    bodies = [polyhedron(seed) for seed in (1, 2, 3)]
    return [[(body.vertices - body.mesh.centroid) / body.volume ** (1 / 3)] for body in bodies]


def picture(shapes, pile: ParticleState, direction, coarse: bool = False) -> np.ndarray:
    plotter_setup.choose_off_screen_window()
    plotter = pv.Plotter(off_screen=True, window_size=[320, 200])
    plotter_setup.set_stage(plotter)
    instancing.show_heap(plotter, shapes, pile, coarse=coarse)
    corners = instancing.box_corners(0.028, 0.02)
    cameras.apply_pose(plotter, cameras.framing_pose(corners, direction, 1.6))
    found = plotter.screenshot(return_img=True).astype(int)
    plotter.close()
    return found


SIDES = [
    cameras.Direction("", side, (0.0, 0.0, 1.0)) for side in ((0.35, -1, 0.22), (-1, 0.2, 1), (1, 1, 0.02))
]


@pytest.mark.parametrize("side", SIDES, ids=("low", "high", "level"))
def test_that_pictures_at_rest_are_those_of_all_particles(pile, shapes, side, monkeypatch) -> None:
    hidden = instancing.hidden_particles(pile, instancing.AT_REST)
    assert 0.05 < hidden.mean() < 0.9
    fewer = picture(shapes, pile, side)
    monkeypatch.setattr(instancing, "MANY_TRIANGLES", 10**9)
    every = picture(shapes, pile, side)
    assert (np.abs(fewer - every).max(axis=2) > 8).mean() < 3e-4


def test_that_octahedra_cover_what_the_particles_cover(pile, shapes) -> None:
    fine, coarse = (picture(shapes, pile, SIDES[0], coarse) for coarse in (False, True))
    drawn = [each[:, :, 0] - each[:, :, 2] > 15 for each in (fine, coarse)]
    assert (drawn[0] & drawn[1]).sum() > 0.93 * (drawn[0] | drawn[1]).sum()
    means = [each[inside].mean(axis=0) for each, inside in zip((fine, coarse), drawn, strict=True)]
    assert np.abs(means[0] - means[1]).max() < 16


def test_that_an_octahedron_has_the_volume_and_the_proportions_of_its_shape() -> None:
    turn = Rotation.from_euler("xyz", [20, 40, 60], degrees=True)
    box = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T * [2.0, 1.0, 0.5] / 2
    corners = instancing.octahedron_of([turn.apply(box)])
    assert ConvexHull(corners).volume == pytest.approx(1.0)
    along = turn.inv().apply(corners)
    assert np.ptp(along, axis=0) / np.ptp(along[:, 1]) == pytest.approx([2.0, 1.0, 0.5])


def test_that_only_what_lies_deep_is_hidden() -> None:
    """A block of 20 x 20 x 20 on the ground: the inner ones are hidden, down to the ground."""
    places = np.stack(np.meshgrid(*[np.arange(20)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) + 0.5
    ones, turns = np.ones(len(places)), np.tile([1.0, 0, 0, 0], (len(places), 1))
    block = ParticleState(places, ones, turns, np.zeros(len(places), dtype=int))
    hidden = instancing.hidden_particles(block, instancing.AT_REST)
    depth = np.minimum(np.minimum(places[:, :2], 20 - places[:, :2]).min(axis=1), 20 - places[:, 2])
    assert depth[hidden].min() > 4.0
    assert hidden[depth > 6.0].all()
    assert hidden[places[:, 2] == 0.5].any()


def test_that_few_large_and_far_particles_are_never_hidden() -> None:
    points = np.random.default_rng(0).uniform(0.0, 10.0, (4000, 3))
    points[0], points[1] = 5.0, 1e6
    diameters = np.ones(4000)
    diameters[0] = 6.0
    turns = np.tile([1.0, 0, 0, 0], (4000, 1))
    state = ParticleState(points, diameters, turns, np.zeros(4000, dtype=int))
    hidden = instancing.hidden_particles(state, instancing.AT_REST)
    assert hidden.any()
    assert not hidden[:2].any()
    empty = ParticleState(points[:0], diameters[:0], turns[:0], np.zeros(0, dtype=int))
    assert instancing.hidden_particles(empty, instancing.MOVING).shape == (0,)


def test_that_a_heap_of_many_sizes_hides_most_of_its_particles_while_the_view_turns() -> None:
    """Random places, two in three cubes of a mean diameter, as log-normal sizes fill them."""
    points = np.random.default_rng(1).uniform(0.0, 40.0, (42_000, 3))
    turns = np.tile([1.0, 0, 0, 0], (len(points), 1))
    state = ParticleState(points, np.ones(len(points)), turns, np.zeros(len(points), dtype=int))
    assert instancing.hidden_particles(state, instancing.MOVING).mean() > 0.5


def test_that_edges_are_smoothed_again_when_the_view_rests(pile, shapes) -> None:
    plotter_setup.choose_off_screen_window()
    plotter = pv.Plotter(off_screen=True, window_size=[64, 64])
    samples = []
    for coarse in (False, True, False):
        instancing.show_heap(plotter, shapes, pile, coarse=coarse)
        samples.append(plotter.render_window.GetMultiSamples())
    plotter.close()
    assert samples == [4, 0, 4]
