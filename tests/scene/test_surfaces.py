"""What the functions put into a plotter."""

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkCoordinate

from regolith_studio.geometry import ConvexCompound, ConvexPolyhedron, HalfSpaces
from regolith_studio.scene import surfaces
from regolith_studio.scene.cameras import CameraPose, apply_pose, pose_of
from regolith_studio.scene.surfaces import signed_distances

POSE = CameraPose((0.0, -300.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 50.0)


@pytest.fixture
def plotter():
    made = pv.Plotter(off_screen=True, window_size=[200, 200])
    apply_pose(made, POSE)
    yield made
    made.close()


def test_that_a_second_surface_takes_the_place_of_the_first_and_leaves_the_camera(plotter, ball):
    surfaces.show_particle(plotter, ball)
    actor = plotter.actors[surfaces.SURFACE]
    surfaces.show_particle(plotter, ball.moved(scale=2.0))
    assert plotter.actors[surfaces.SURFACE] is actor
    assert len(plotter.actors) == 1
    assert actor.bounds[1] == pytest.approx(60.0, rel=0.01)
    assert pose_of(plotter) == POSE


def test_that_normals_of_a_sphere_point_outwards(plotter, ball):
    surfaces.show_particle(plotter, ball)
    data = plotter.actors[surfaces.SURFACE].mapper.dataset
    assert np.einsum("ij,ij->i", data.point_data["Normals"], ball.vertices / 30.0).min() > 0.99


def test_that_facets_are_outlined_and_triangles_are_not(plotter, cube):
    surfaces.show_polyhedron(plotter, cube)
    assert plotter.actors[surfaces.OUTLINE].mapper.dataset.n_lines == 12
    assert plotter.actors[surfaces.SURFACE].mapper.dataset.n_cells == 6


def test_that_a_polyhedron_lies_where_its_particle_lies(plotter, cube):
    surfaces.show_polyhedron(plotter, cube, centre=(100.0, 0.0, 0.0))
    assert plotter.actors[surfaces.SURFACE].center[0] == pytest.approx(100.0)


def test_that_the_distance_map_comes_and_goes(plotter, ball):
    surfaces.show_fit(plotter, ball, distances=ball.vertices[:, 2])
    mapper = plotter.actors[surfaces.SURFACE].mapper
    assert mapper.scalar_visibility
    assert tuple(mapper.scalar_range) == pytest.approx((-30.0, 30.0))
    assert len(plotter.scalar_bars) == 1
    table = next(iter(plotter.scalar_bars.values())).GetLookupTable()
    texts = [table.GetAnnotation(at) for at in range(table.GetNumberOfAnnotatedValues())]
    assert texts == ["-30 µm", "0 µm", "30 µm"]
    surfaces.show_fit(plotter, ball)
    assert not mapper.scalar_visibility
    assert len(plotter.scalar_bars) == 0


def test_that_a_wireframe_shows_the_ground_between_its_lines(plotter, ball):
    surfaces.show_particle(plotter, ball)
    surfaces.set_wireframe(plotter, True)
    assert plotter.actors[surfaces.SURFACE].prop.style == "Wireframe"


def test_that_distances_agree_with_vtk(ball):
    points = np.random.default_rng(4).uniform(-40, 40, (200, 3))
    surface = pv.PolyData.from_regular_faces(np.array(ball.vertices), np.array(ball.faces))
    reference = pv.PolyData(points).compute_implicit_distance(surface)["implicit_distance"]
    assert signed_distances(points, ball) == pytest.approx(np.asarray(reference), abs=1e-6)


def test_that_parts_of_a_compound_have_tones_of_their_own_and_a_polyhedron_after_it_has_one_colour(plotter):
    side = ConvexPolyhedron.from_half_spaces(HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.ones(6)))
    compound = ConvexCompound((side, side), np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]))
    one, two = np.unique(surfaces.part_shades(compound), axis=0).astype(float)
    ratio = (one / two) / (one / two).mean()
    assert np.ptp(ratio) > 0.2, "no light makes one tone of the other"
    assert len(surfaces.exposed_edges(compound)) == 3 * (12 + 12 + 6)
    surfaces.show_polyhedron(plotter, compound)
    assert plotter.actors[surfaces.SURFACE].mapper.scalar_visibility
    surfaces.show_polyhedron(plotter, side)
    assert not plotter.actors[surfaces.SURFACE].mapper.scalar_visibility


def test_that_edges_between_facets_are_drawn_whole(plotter):
    rng = np.random.default_rng(1)
    normals = rng.normal(size=(20, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    solid = ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, rng.uniform(20.0, 30.0, size=20)))
    plotter.window_size = [600, 600]
    surfaces.show_polyhedron(plotter, solid)
    plotter.actors[surfaces.OUTLINE].prop.color = "red"
    plotter.set_background("white")
    plotter.camera.enable_parallel_projection()
    seen = [False]
    for _ in range(6):
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        aside = np.cross(direction, (0.3, 0.5, 0.8))
        plotter.camera_position = [direction * 300.0, (0.0, 0.0, 0.0), aside]
        plotter.camera.parallel_scale = 45.0
        plotter.camera.clipping_range = (150.0, 450.0)
        plotter.render()
        image = plotter.screenshot(return_img=True).astype(int)
        red = (image[..., 0] - image[..., 1] > 100) & (image[..., 2] < 120)
        seen += [
            red[y - 1 : y + 2, x - 1 : x + 2].any() for x, y in _points_on_edges(solid, direction, plotter)
        ]
    assert len(seen) > 2000
    assert np.mean(seen) > 0.985


def _points_on_edges(solid, direction, plotter):
    """Pixels on the edges of facets that face the camera."""
    point = vtkCoordinate()
    point.SetCoordinateSystemToWorld()
    height = plotter.window_size[1]
    facing = solid.half_spaces.normals @ direction > 0.0
    faced = [set(facet) for facet, shown in zip(solid.facets, facing, strict=True) if shown]
    for edge in surfaces.facet_edges(solid).reshape(-1, 3)[:, 1:]:
        if any(facet.issuperset(edge.tolist()) for facet in faced):
            first, last = solid.vertices[edge]
            for share in np.linspace(0.1, 0.9, 17):
                point.SetValue(*(first + share * (last - first)))
                x, y = point.GetComputedDisplayValue(plotter.renderer)
                yield x, height - 1 - y
