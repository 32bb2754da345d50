"""The polyhedra of Fig. 7: every row for every particle, failures included."""

import numpy as np
import pytest

from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.events import Partial, Progress
from regolith_studio.jobs.study_jobs import coarsen_gallery, study_gallery, study_of_cells
from regolith_studio.session.choices import Choices
from regolith_studio.session.study_requests import COMPOUND, chosen_rows
from regolith_studio.steps import result_of
from regolith_studio.studies.loss_variants import paper_variants
from regolith_studio.studies.polyhedron_gallery import gallery_table
from tests.coarsening.compound.unions import dumbbell
from tests.steps import played


@pytest.fixture(scope="module")
def coarsening_request() -> CoarseningRequest:
    return Choices(method="quadric", n_facets=12, l_max=4, level=2, target="particle").coarsening_request


def test_that_each_particle_is_coarsened_once_for_each_row(coarsening_request: CoarseningRequest) -> None:
    sphere = icosphere(3)
    eggs = [Particle(f"egg-{n}", Mesh(sphere.vertices * [n, 2, 3], sphere.faces)) for n in (1, 2)]
    events, cells = played(coarsen_gallery(eggs, coarsening_request))
    rows = len(paper_variants())
    assert {(each.row, each.column) for each in cells} == set(np.ndindex(rows, 2))
    assert all(each.outcome.coarsened.n_facets == 12 for each in cells)
    assert [len(each.value) for each in events if isinstance(each, Partial)] == list(range(1, 2 * rows + 1))
    counts = [(each.done, each.total) for each in events if isinstance(each, Progress)]
    assert counts == sorted(counts)
    assert counts[-1] == (2 * rows, 2 * rows)


def test_that_a_particle_that_cannot_be_coarsened_does_not_stop_the_rest(
    coarsening_request: CoarseningRequest,
) -> None:
    sphere = icosphere(2)
    flat = Particle("flat", Mesh(sphere.vertices * [1, 1, 0], sphere.faces))
    cells = result_of(coarsen_gallery([flat, Particle("ball", sphere)], coarsening_request))
    by_name = {name: [cell for cell in cells if cell.outcome.name == name] for name in ("flat", "ball")}
    assert all(each.outcome.coarsened is None and each.outcome.problem for each in by_name["flat"])
    assert all(each.outcome.coarsened is not None for each in by_name["ball"])


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.slow
def test_that_the_study_has_the_polyhedra_of_the_gallery(
    coarsening_request: CoarseningRequest, workers: int
) -> None:
    sphere = icosphere(2)
    eggs = [Particle(f"egg-{n}", Mesh(sphere.vertices * [n, 2, 3], sphere.faces)) for n in (1, 2, 0)]
    rows, names = paper_variants("quadric")[:3], [egg.name for egg in eggs]
    drawn = study_of_cells(
        result_of(coarsen_gallery(eggs, coarsening_request, rows)), [row.label for row in rows], names
    )
    study = result_of(study_gallery(eggs, coarsening_request, rows, workers))
    assert (study.rows, study.names) == (drawn.rows, drawn.names)
    assert gallery_table(study) == gallery_table(drawn)
    assert [isinstance(study.cells[0, column], str) for column in range(3)] == [False, False, True]


@pytest.mark.slow
def test_that_a_row_compound_stands_beside_rows_of_convex_polyhedra() -> None:
    choices = Choices(n_facets=24, target="particle", method="quadric")
    rows = chosen_rows(("quadric", "all", COMPOUND), choices)
    assert [row.method for row in rows] == ["quadric", "quadric", "compound"]
    cells = result_of(study_gallery([Particle("waist", dumbbell())], choices.coarsening_request, rows)).cells
    assert [cells[row, 0].method for row in range(3)] == ["quadric", "quadric", "compound"]
    assert isinstance(cells[2, 0].polyhedron, ConvexCompound)
    errors = [cells[row, 0].errors["convex_hull_volume"] for row in range(3)]
    assert errors[2] < 1e-6 < errors[1]
    assert cells[2, 0].reason is None


def test_that_a_particle_without_a_fit_is_reported_in_each_row() -> None:
    fitted = Choices(method="quadric", n_facets=12, l_max=4, level=2, target="fit").coarsening_request
    flat = Mesh(icosphere(2).vertices * [1, 1, 0], icosphere(2).faces)
    cells = result_of(coarsen_gallery([Particle("flat", flat)], fitted, paper_variants()[:2]))
    assert [bool(each.outcome.problem) for each in cells] == [True, True]
