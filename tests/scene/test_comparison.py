"""Veil, wipe and section in one picture; facets under the mouse."""

import numpy as np
import pytest
import pyvista as pv

from regolith_studio.geometry.cross_section import cross_section
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.scene import clipping, comparison, facets, plotter_setup, surfaces
from regolith_studio.scene.cameras import Projection, apply_pose, framing_pose, pose_of
from regolith_studio.scene.clipping import SectionPlane
from regolith_studio.scene.comparison import OTHER, Divider, arrange, show_cuts, show_other
from regolith_studio.scene.palette import PAPER
from regolith_studio.scene.shapes import FIT, PARTICLE, POLYHEDRON, SceneShape
from tests.dataset.example import elbow

SIZE = 160


@pytest.fixture
def plotter():
    plotter_setup.choose_off_screen_window()
    made = pv.Plotter(off_screen=True, window_size=[SIZE, SIZE])
    plotter_setup.set_stage(made, PAPER)
    yield made
    made.close()


@pytest.fixture
def divider(plotter):
    made = Divider(plotter, PAPER)
    yield made
    made.remove()


def picture(plotter):
    plotter.render()
    return plotter.screenshot(return_img=True)[..., :3].astype(int)


def yellowness(part):
    """Of the polyhedron: red above blue."""
    return float((part[..., 0] - part[..., 2]).mean())


def show_two(plotter, ball, cube, direction="isometric"):
    surfaces.show_polyhedron(plotter, cube)
    show_other(plotter, SceneShape(FIT, ball), False)
    apply_pose(plotter, framing_pose(cube.vertices, direction))


@pytest.mark.parametrize("direction", ["isometric", "front", "top"])
def test_that_the_wipe_shows_one_body_left_and_the_other_right_of_the_line(
    plotter, divider, ball, cube, direction
):
    show_two(plotter, ball, cube, direction)
    for share in (0.5, 0.35):
        divider.share = share
        arrange(plotter, divider, wipe=True, overlay=False, section=None)
        seen, middle = picture(plotter), round(share * SIZE)
        assert yellowness(seen[60:100, middle - 14 : middle - 6]) > 40
        assert yellowness(seen[60:100, middle + 6 : middle + 14]) < -40
    arrange(plotter, divider, wipe=False, overlay=False, section=None)
    show_other(plotter, None, False)
    assert yellowness(picture(plotter)[60:100, 60:100]) > 40


def test_that_a_section_is_as_large_as_the_cut_and_hides_the_half_before_it(plotter, divider, ball):
    surfaces.show_particle(plotter, ball)
    apply_pose(plotter, framing_pose(ball.vertices, "front"))
    plane = SectionPlane((0.0, -1.0, 0.0), 10.0)
    cut = cross_section(ball, plane.normal, plane.offset)
    show_cuts(plotter, PARTICLE, "", {PARTICLE: cut}, {PARTICLE: "#000000"})
    arrange(plotter, divider, wipe=False, overlay=False, section=plane)
    cap = plotter.actors[clipping.CAP].mapper.dataset
    assert cap.area == pytest.approx(cut.area, rel=1e-5)
    assert np.allclose(cap.points[:, 1], -10.0, atol=1e-5)
    seen = picture(plotter)
    assert np.ptp(seen[70:90, 70:90].reshape(-1, 3), axis=0).max() <= 2  # flat: the cut, not the ball
    show_cuts(plotter, PARTICLE, "", {}, {PARTICLE: "#000000"})
    arrange(plotter, divider, wipe=False, overlay=False, section=None)
    assert not plotter.actors[clipping.CAP].GetVisibility()
    assert np.abs(picture(plotter) - seen).max() > 20


@pytest.mark.parametrize("opacity", [comparison.VEIL, 1.0])
def test_that_the_cut_of_a_veil_lies_evenly_over_the_other_cut(
    plotter, divider, ball, cube, monkeypatch, opacity
):
    """Both lie in one plane: which is drawn must not change from pixel to pixel."""
    monkeypatch.setattr(comparison, "VEIL", opacity)
    surfaces.show_polyhedron(plotter, cube)
    show_other(plotter, SceneShape(PARTICLE, ball), True)
    apply_pose(plotter, framing_pose(ball.vertices, "isometric"))
    normal = (0.6, -0.64, 0.48)
    cuts = {PARTICLE: cross_section(ball, normal, 3.0), POLYHEDRON: cross_section(cube.mesh, normal, 3.0)}
    show_cuts(plotter, POLYHEDRON, PARTICLE, cuts, {}, overlay=True)
    arrange(plotter, divider, wipe=False, overlay=True, section=SectionPlane(normal, 3.0))
    middle = SIZE // 2
    seen = picture(plotter)[middle - 18 : middle + 18, middle - 18 : middle + 18].reshape(-1, 3)
    assert np.ptp(seen, axis=0).max() <= 2
    show_cuts(plotter, POLYHEDRON, "", cuts, {})
    alone = picture(plotter)[middle, middle]
    assert np.abs(seen[0] - alone).max() > 5, "the overlay is seen"


def test_that_the_frame_of_a_section_lies_in_its_plane_and_holds_the_particle(ball):
    corners = clipping.frame_corners(ball, SectionPlane((0.6, 0.0, 0.8), 12.0))
    assert np.allclose(corners @ [0.6, 0.0, 0.8], 12.0)
    assert np.linalg.norm(corners[0] - corners[1]) >= 60.0


def test_that_a_veil_begins_at_the_line_where_both_are_asked_for(plotter, divider, ball, cube):
    show_two(plotter, ball, cube, "front")
    show_other(plotter, SceneShape(FIT, ball), True)
    arrange(plotter, divider, wipe=True, overlay=True, section=None)
    assert plotter.actors[OTHER + surfaces.SURFACE].prop.opacity < 0.5
    assert not plotter.actors[surfaces.SURFACE].mapper.GetClippingPlanes()
    assert plotter.actors[OTHER + surfaces.SURFACE].mapper.GetClippingPlanes().GetNumberOfItems() == 1


@pytest.mark.parametrize("direction", ["isometric", "left", "bottom"])
def test_that_a_point_is_seen_where_its_ray_passes(direction, ball):
    sight = Projection(framing_pose(ball.vertices, direction), 320, 200)
    place = np.array([3.0, -7.0, 11.0])
    x, y = sight.seen(place)[0]
    start, towards = sight.ray(x, y)
    assert np.allclose(np.cross(place - start, towards), 0.0, atol=1e-9)


def test_that_a_drag_moves_a_plane_with_the_mouse(ball):
    sight = Projection(framing_pose(ball.vertices, "front"), 200, 200)
    for direction, drag in (((1, 0, 0), (30, 5)), ((0, 0, 1), (5, -30)), ((0, 0, -1), (5, 30))):
        before, after = sight.seen([np.zeros(3), sight.along(direction, *drag) * np.array(direction)])
        wanted = np.array(drag) * (np.abs(np.array(direction)[[0, 2]]) > 0)
        assert np.allclose(after - before, wanted)
    assert sight.along((0, -1, 0), 0, -30) == pytest.approx(-30 * sight.per_pixel)  # end on: up is inwards


def test_that_the_facet_under_the_mouse_is_the_one_that_a_ray_meets_first(cube):
    rng = np.random.default_rng(3)
    solid, met = cube, 0
    for direction in rng.normal(size=(200, 3)):
        towards = direction / np.linalg.norm(direction)
        start = -200 * towards + np.cross(towards, rng.normal(size=3)) * 12
        hits = radial_hits(solid.mesh, start, towards[None, :])
        entering = hits.face[hits.sign < 0]
        found = facets.facet_met(solid, start, towards)
        assert (found is None) == (not len(entering))
        if found is not None:
            met += 1
            assert found[0] == solid.triangle_facets[entering[0]]
            assert found[1] == pytest.approx(hits.distance[0])
    assert met > 100


def test_that_the_facet_below_the_mouse_of_a_union_is_that_of_its_surface():
    """Along rays from everywhere; what lies behind another part is not met."""
    union, rng, met = elbow().moved(shift=-elbow().centroid), np.random.default_rng(4), set()
    for direction in rng.normal(size=(300, 3)):
        towards = direction / np.linalg.norm(direction)
        start = -60 * towards + np.cross(towards, rng.normal(size=3)) * 2
        hits = radial_hits(union.mesh, start, towards[None, :])
        entering = hits.face[hits.sign < 0]
        found = facets.facet_met(union, start, towards)
        assert (found is None) == (not len(entering))
        if found is not None:
            assert found[1] == pytest.approx(hits.distance[0])
            a, b, c = union.mesh.vertices[union.mesh.faces[entering[0]]]
            across = np.cross(b - a, c - a)
            normal = facets.facet_of(union, found[0]).normal
            assert normal == pytest.approx(across / np.linalg.norm(across), abs=1e-9)
            met.add(found[0])
    assert len(met) >= 10


def test_that_a_facet_of_a_union_tells_what_is_exposed_of_it(plotter):
    """Of a side of 6 x 1 of the second bar of an elbow the first bar covers 2 x 1."""
    facet = facets.facet_of(elbow(), 6)
    assert (facet.part, facet.count) == (1, 12)
    assert facet.area == pytest.approx(4.0)
    assert facet.share == pytest.approx(4 / 64)
    edges = np.linalg.norm(facet.outline[:, 1] - facet.outline[:, 0], axis=1)
    assert edges.sum() == pytest.approx(2 * (4 + 1))
    facets.show_facet(plotter, facet)
    assert plotter.actors[facets.NUMBER].GetInput() == "7"


def test_that_a_facet_tells_its_numbers_and_is_outlined(plotter, cube):
    facet = facets.facet_of(cube, 2)
    assert facet.area == pytest.approx(1600.0)
    assert facet.share == pytest.approx(1 / 6)
    assert facet.offset == pytest.approx(20.0)
    facets.show_facet(plotter, facet, (1.0, 2.0, 3.0))
    outline = plotter.actors[facets.FACET].mapper.dataset
    assert outline.length == pytest.approx(40 * np.sqrt(2), rel=0.01)
    assert plotter.actors[facets.NUMBER].GetInput() == "3"
    facets.show_facet(plotter, None)
    assert not plotter.actors[facets.FACET].GetVisibility()
    assert not plotter.actors[facets.NUMBER].GetVisibility()


def test_that_the_number_of_a_slanted_facet_is_read_whole(plotter, cube):
    def ink(direction):
        """Pixels that the number of the facet towards +x changes."""
        apply_pose(plotter, framing_pose(cube.vertices, direction))
        facets.show_facet(plotter, facets.facet_of(cube, 0))
        with_number = picture(plotter)
        plotter.actors[facets.NUMBER].SetVisibility(False)
        return int((np.abs(with_number - picture(plotter)).max(axis=2) > 12).sum())

    surfaces.show_polyhedron(plotter, cube)
    straight = ink("right")
    assert straight > 20
    assert ink("isometric") == pytest.approx(straight, rel=0.2)


def test_that_the_pose_of_a_plotter_is_what_the_divider_follows(plotter, divider, cube):
    surfaces.show_polyhedron(plotter, cube)
    apply_pose(plotter, framing_pose(cube.vertices, "right"))
    divider.set_shown(True)
    divider.share = 0.25
    picture(plotter)
    sight = Projection(pose_of(plotter), SIZE, SIZE)
    assert np.allclose(divider.right.GetNormal(), sight.axes[0])
    assert sight.seen(divider.right.GetOrigin())[0, 0] == pytest.approx(SIZE / 4)
