"""The polyhedra of Fig. 7: every row for every particle, failures included."""

from typing import Any

import numpy as np
import pytest

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.events import Partial, Progress, Steps
from regolith_studio.session.choices import Choices
from regolith_studio.session.study_requests import coarsen_gallery, solid_study, study_gallery
from regolith_studio.studies.loss_variants import paper_variants
from regolith_studio.studies.polyhedron_gallery import gallery_table


@pytest.fixture(scope="module")
def order() -> CoarseningRequest:
    return Choices(method="quadric", n_facets=12, l_max=4, level=2, target="particle").order


def test_that_each_particle_is_coarsened_once_for_each_row(order: CoarseningRequest) -> None:
    sphere = icosphere(3)
    eggs = [Particle(f"egg-{n}", Mesh(sphere.vertices * [n, 2, 3], sphere.faces)) for n in (1, 2)]
    told, story = [], coarsen_gallery(eggs, order)
    try:
        while True:
            told.append(next(story))
    except StopIteration as end:
        solids = end.value
    rows = len(paper_variants())
    assert {(each.row, each.column) for each in solids} == set(np.ndindex(rows, 2))
    assert all(each.outcome.coarsened.n_facets == 12 for each in solids)
    assert [len(each.value) for each in told if isinstance(each, Partial)] == list(range(1, 2 * rows + 1))
    counts = [(each.done, each.total) for each in told if isinstance(each, Progress)]
    assert counts == sorted(counts)
    assert counts[-1] == (2 * rows, 2 * rows)


def test_that_a_particle_that_cannot_be_coarsened_does_not_stop_the_rest(
    order: CoarseningRequest,
) -> None:
    sphere = icosphere(2)
    flat = Particle("flat", Mesh(sphere.vertices * [1, 1, 0], sphere.faces))
    story = coarsen_gallery([flat, Particle("ball", sphere)], order)
    try:
        while True:
            next(story)
    except StopIteration as end:
        solids = end.value
    by_name = {name: [s for s in solids if s.outcome.name == name] for name in ("flat", "ball")}
    assert all(each.outcome.coarsened is None and each.outcome.problem for each in by_name["flat"])
    assert all(each.outcome.coarsened is not None for each in by_name["ball"])


def ended(story: Steps) -> Any:
    while True:
        try:
            next(story)
        except StopIteration as end:
            return end.value


@pytest.mark.parametrize("workers", [1, 2])
def test_that_the_study_has_the_polyhedra_of_the_gallery(order: CoarseningRequest, workers: int) -> None:
    sphere = icosphere(2)
    eggs = [Particle(f"egg-{n}", Mesh(sphere.vertices * [n, 2, 3], sphere.faces)) for n in (1, 2, 0)]
    rows, names = paper_variants()[:3], [egg.name for egg in eggs]
    drawn = solid_study(ended(coarsen_gallery(eggs, order, rows)), [row.label for row in rows], names)
    study = ended(study_gallery(eggs, order, rows, workers))
    assert (study.rows, study.names) == (drawn.rows, drawn.names)
    assert gallery_table(study) == gallery_table(drawn)
    assert [isinstance(study.cells[0, column], str) for column in range(3)] == [False, False, True]


def test_that_a_particle_without_a_fit_is_told_for_each_row() -> None:
    fitted = Choices(method="quadric", n_facets=12, l_max=4, level=2, target="fit").order
    flat = Mesh(icosphere(2).vertices * [1, 1, 0], icosphere(2).faces)
    solids = ended(coarsen_gallery([Particle("flat", flat)], fitted, paper_variants()[:2]))
    assert [bool(each.outcome.problem) for each in solids] == [True, True]
