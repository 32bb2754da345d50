"""The picture of Fig. 7 shows what can be seen of each polyhedron, and its table what is known of it."""

import itertools
import json
from dataclasses import replace

import manifold3d
import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.studies.figures.degrees import (
    EDGE,
    VIEW,
    degree_figure,
    union_picture,
    visible_facets,
)
from regolith_studio.studies.polyhedron_gallery import GalleryPolyhedron, GalleryStudy, gallery_table
from tests.coarsening.compound.unions import manifold_of
from tests.dataset.example import cuboid, elbow


@pytest.fixture(scope="module")
def elbow_cell(brick: GalleryPolyhedron) -> GalleryPolyhedron:
    return replace(brick, method="compound", polyhedron=elbow())


@pytest.fixture(scope="module")
def brick() -> GalleryPolyhedron:
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * (3.0, 2.0, 1.0)
    return GalleryPolyhedron.of(coarsen(Mesh(corners, np.empty((0, 3), dtype=np.int64)).hull, 6))


def test_that_the_outlines_cover_the_shadow_once() -> None:
    sides = np.vstack([np.eye(3), -np.eye(3)])
    cube = ConvexPolyhedron.from_half_spaces(HalfSpaces(sides, np.full(6, 0.5)))
    outlines, brightness = visible_facets(cube)
    assert len(outlines) == 3
    area = sum(
        abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2 for x, y in (each.T for each in outlines)
    )
    assert area == pytest.approx(np.abs(VIEW[2]).sum(), rel=1e-3)  # Cauchy: sum of the sides' projections
    assert ((brightness > 0.3) & (brightness <= 1.0)).all()


def test_that_the_picture_of_a_union_covers_the_shadow_that_manifold3d_finds() -> None:
    reach = 8.0
    cover = union_picture(elbow(), reach)[..., 3]
    turned = elbow().mesh.vertices @ VIEW.T
    footprint = manifold_of(replace(elbow().mesh, vertices=turned)).project()
    assert isinstance(footprint, manifold3d.CrossSection)
    assert cover.mean() * (2 * reach) ** 2 == pytest.approx(footprint.area(), rel=2e-3)
    rows, columns = np.nonzero(cover > 0.5)
    low, high = turned[:, :2].min(axis=0), turned[:, :2].max(axis=0)
    pixel = 2 * reach / len(cover)
    assert [columns.min(), len(cover) - 1 - rows.max()] == pytest.approx((low + reach) / pixel, abs=1.5)
    assert [columns.max(), len(cover) - 1 - rows.min()] == pytest.approx((high + reach) / pixel, abs=1.5)


def test_that_the_nearer_part_of_a_union_hides_the_farther_one() -> None:
    """A plate behind a cube, apart from it: in the middle the brightness is that of the cube's side."""
    towards = VIEW[2] / np.linalg.norm(VIEW[2])
    plate, cube = cuboid(6.0, 6.0, 0.2), cuboid(1.0, 1.0, 1.0)
    picture = union_picture(ConvexCompound((plate, cube), np.array([-9.0 * towards, 9.0 * towards])), 6.0)
    outlines, brightness = visible_facets(cube)
    inside = [x @ VIEW[:2].T for x in cube.half_spaces.normals if x @ VIEW[2] > 0]
    for outline, bright, middle in zip(outlines, brightness, inside, strict=True):
        assert np.allclose(outline.mean(axis=0), middle / 2, atol=2e-3)
        column, row = np.floor((middle / 2 * (1, -1) + 6.0) / 12.0 * len(picture)).astype(int)
        assert picture[row, column, 0] == pytest.approx(bright * 0.902, abs=1e-6)
    assert (np.abs(picture[..., :3] - float(EDGE)).max(axis=2) < 1e-9).any()


def test_that_numbers_and_failures_have_lines_of_their_own(brick: GalleryPolyhedron) -> None:
    study = GalleryStudy(("All", "V"), ("a",), {(0, 0): brick, (1, 0): "The mesh is open."})
    table = gallery_table(study)
    names = [column.name for column in table.columns]
    first, second = (dict(zip(names, row, strict=True)) for row in table.rows)
    assert (first["row"], first["name"], first["facets"], first["vertices"]) == ("All", "a", 6, 8)
    assert first["volume"] == pytest.approx(0.0, abs=1e-4)
    assert (second["volume"], second["reason"]) == (None, "The mesh is open.")


def test_that_a_solid_comes_back_from_text_to_the_bit(brick: GalleryPolyhedron) -> None:
    again = GalleryPolyhedron.from_document(json.loads(json.dumps(brick.document())))
    np.testing.assert_array_equal(again.polyhedron.vertices, brick.polyhedron.vertices)
    np.testing.assert_array_equal(again.polyhedron.half_spaces.normals, brick.polyhedron.half_spaces.normals)
    assert again.document() == brick.document()


def test_that_a_union_comes_back_from_text_to_the_bit(elbow_cell: GalleryPolyhedron) -> None:
    again = GalleryPolyhedron.from_document(json.loads(json.dumps(elbow_cell.document())))
    assert isinstance(again.polyhedron, ConvexCompound)
    np.testing.assert_array_equal(again.polyhedron.places, elbow().places)
    np.testing.assert_array_equal(again.polyhedron.vertices, elbow().vertices)
    assert again.document() == elbow_cell.document()


def test_that_a_name_with_dollars_stands_in_a_figure_as_it_is() -> None:
    name = r"a $\frac{1}{2 b$ c"  # as mathematics this cannot be set
    figure = degree_figure({name: icosphere(1), "$x_1$": None})
    figure.canvas.draw()
    shown = [axis.title._preprocess_math(axis.title.get_text()) for axis in figure.axes]
    assert shown == [(name, False), ("$x_1$", False)]
