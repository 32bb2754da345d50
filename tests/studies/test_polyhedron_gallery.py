"""The picture of Fig. 7 shows what can be seen of each polyhedron, and its table what is known of it."""

import itertools
import json

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.studies.figures.polyhedron_gallery import (
    VIEW,
    gallery_figure,
    visible_facets,
    write_gallery,
)
from regolith_studio.studies.polyhedron_gallery import GalleryPolyhedron, GalleryStudy, gallery_table


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


def test_that_the_view_is_a_rotation() -> None:
    np.testing.assert_allclose(VIEW @ VIEW.T, np.eye(3), atol=2e-3)
    assert np.linalg.det(VIEW) == pytest.approx(1.0, abs=2e-3)


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


def test_that_the_same_study_gives_the_same_bytes(brick: GalleryPolyhedron, tmp_path) -> None:
    study = GalleryStudy(("All", "V"), ("a", "b"), {(0, 0): brick, (1, 1): brick, (0, 1): "No."})
    one, other = write_gallery(study, tmp_path / "one"), write_gallery(study, tmp_path / "other")
    assert [path.name for path in one] == ["solids.csv", "solids.json", "solids.png", "solids.svg"]
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in other]
    assert len(gallery_figure(study).axes) == 4
