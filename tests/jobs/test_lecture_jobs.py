"""A lesson is the method itself, slowed down; a field is the model itself."""

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe, relative_errors
from regolith_studio.errors import InputError
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.events import Partial
from regolith_studio.jobs.lecture_jobs import BALLS, draw_field, trace_annealing, trace_degrees
from regolith_studio.shape_models.materials import materials
from tests.steps import played

WEIGHTS = LossWeights.from_preset("all")


def results_of(steps):
    """Partial results, and the result."""
    received, result = played(steps)
    return [step.value for step in received if isinstance(step, Partial)], result


@pytest.fixture(scope="module")
def egg():
    return icosphere(3).moved(rotation=np.diag([30.0, 20.0, 45.0]), shift=[0.1, 0.2, 0.3])


@pytest.fixture(scope="module")
def lesson(egg):
    order = CoarseningRequest(WEIGHTS, 12, "annealing", (("iterations", 60),), seed=5)
    partial, made = results_of(trace_annealing(egg, order))
    assert partial[0].exact is None
    assert partial[0].steps is made.steps
    return made


def test_that_a_lesson_is_the_method_step_by_step(egg, lesson):
    plain = coarsen(egg, 12, "annealing", WEIGHTS, 5, {"iterations": 60})
    assert [step.evaluation.loss for step in lesson.steps] == list(plain.loss_history)
    np.testing.assert_allclose(
        np.sort(lesson.steps[-1].polyhedron.facet_areas), np.sort(plain.polyhedron.facet_areas), rtol=1e-9
    )
    assert sum(step.move.accepted for step in lesson.steps[1:]) == plain.steps["accepted"]
    assert sum(step.proposal is None for step in lesson.steps[1:]) == plain.steps["refused"]
    assert lesson.exact.loss == coarsen(egg, 12, "exact", WEIGHTS, 5).loss


def test_that_a_move_is_taken_if_it_is_better_or_lucky_and_moves_one_plane_only(lesson):
    for before, step in zip(lesson.steps, lesson.steps[1:], strict=False):
        move = step.move
        assert move.probability == pytest.approx(0.2 * 0.9**step.number)
        wanted = move.proposed is not None and (
            move.proposed.loss < move.before.loss or move.drawn < move.probability
        )
        assert move.accepted == wanted
        assert step.before is before.polyhedron
        assert step.polyhedron is (step.proposal if wanted else step.before)
        assert step.evaluation is (move.proposed if wanted else move.before)


def test_that_the_facet_of_the_moved_plane_is_found_before_and_after(lesson):
    seen = 0
    for step in lesson.steps[1:]:
        if step.facet is None or step.proposed_facet is None:
            continue
        seen += 1
        before, after = step.before.half_spaces.points, step.proposal.half_spaces.points
        distance = np.linalg.norm(before[step.facet] - after[step.proposed_facet])
        assert distance == pytest.approx(step.distance, rel=1e-6)
    assert seen >= 5


def test_that_a_lesson_has_an_end_and_needs_a_weight(egg):
    with pytest.raises(InputError, match="at most 2,000"):
        next(trace_annealing(egg, CoarseningRequest(WEIGHTS, 12, "annealing", (("iterations", 9000),))))
    with pytest.raises(InputError, match="weights"):
        next(trace_annealing(egg, CoarseningRequest(LossWeights.of())))


def test_that_the_fit_grows_from_a_sphere_to_the_particle(egg):
    partial, steps = results_of(trace_degrees(egg, fit_harmonics(egg, 8), level=3))
    assert [len(each) for each in partial] == list(range(1, 10))
    radii = np.linalg.norm(steps[0].mesh.vertices - steps[0].mesh.centroid, axis=1)
    assert np.ptp(radii) < 1e-3 * radii.mean()
    assert steps[0].errors["sphericity"] > 10 * steps[8].errors["sphericity"]
    assert steps[8].errors["volume"] < 1e-2
    assert steps[0].radial_error > steps[4].radial_error > steps[8].radial_error


def test_that_the_balls_of_a_fit_have_the_sides_of_the_least_box(egg):
    fit = fit_harmonics(egg, 8)
    truth = describe(egg, LOSS_KEYS)
    _, steps = results_of(trace_degrees(egg, fit, level=3))
    for step in steps[: BALLS + 1]:
        exact = relative_errors(truth, describe(step.mesh, LOSS_KEYS), LOSS_KEYS)
        assert dict(step.errors) == pytest.approx(exact, abs=2e-3)  # of 1,280 triangles


def test_that_a_field_has_the_spectrum_that_was_asked_for():
    name = next(iter(materials()))
    amplitudes = np.array([0.0, 0.04, 0.02, 0.03])
    variances = [draw_field(name, amplitudes, seed, 3).values.var() for seed in range(300)]
    expected = ((2 * np.arange(1, 5) + 1) * amplitudes**2).sum()
    assert np.mean(variances) == pytest.approx(expected, rel=0.1)


def test_that_the_particle_of_a_field_swells_where_the_field_is_high():
    name = next(iter(materials()))
    drawn = draw_field(name, np.array([0.02, 0.06, 0.03]), 4, 3)
    radii = np.linalg.norm(drawn.mesh.vertices, axis=1)
    assert np.corrcoef(np.log(radii), drawn.values)[0, 1] > 0.999
    again = draw_field(name, np.array([0.02, 0.12, 0.03]), 4, 3)
    assert np.corrcoef(again.values, drawn.values)[0, 1] > 0.8  # the same numbers, louder
    with pytest.raises(InputError, match="no material"):
        draw_field("cheese", np.array([0.1]), 0)
