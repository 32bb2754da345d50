"""Half-spaces to polyhedra without Qhull."""

import numpy as np
import pytest

from regolith_studio.coarsening.polyhedra import polyhedron_of
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_that_the_polyhedron_is_that_of_qhull(scale: float) -> None:
    rng = np.random.default_rng(2)
    half_spaces = HalfSpaces(rng.normal(size=(30, 3)), scale * rng.uniform(0.8, 1.6, 30))
    mine, qhull = polyhedron_of(half_spaces), ConvexPolyhedron.from_half_spaces(half_spaces)
    assert (mine.n_facets, mine.n_vertices) == (qhull.n_facets, qhull.n_vertices)
    assert mine.volume == pytest.approx(qhull.volume, rel=1e-12)
    assert mine.facet_areas == pytest.approx(qhull.facet_areas, rel=1e-9)
    assert (mine.facet_areas > 0).all()


def test_that_planes_on_one_side_bound_nothing() -> None:
    with pytest.raises(GeometryError, match="unbounded"):
        polyhedron_of(HalfSpaces(np.vstack([np.eye(3), [[0.1, 0.2, 0.97]]]), np.ones(4)))
