"""What is shown while choices change faster than work is done; the test decides when which job runs."""

from collections.abc import Callable

import numpy as np
import pytest

from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.coarsening.weights import WEIGHT_KEYS, LossWeights
from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.events import Job, Listener, Partial
from regolith_studio.jobs.runners import run_job
from regolith_studio.session.choices import Choices
from regolith_studio.session.recompute import STOPPED
from regolith_studio.session.session import Session


class Held:
    """A runner whose jobs wait until the test lets the newest of a queue run."""

    def __init__(self) -> None:
        self.waiting: dict[str, list[Held.Handle]] = {}

    def submit(self, job: Job, listener: Listener, queue: str = "") -> "Held.Handle":
        handle = Held.Handle(job, listener)
        self.waiting.setdefault(queue, []).append(handle)
        return handle

    def let(self, queue: str, between: Callable[[], None] = lambda: None) -> bool:
        """Run the oldest job of a queue to its end; says whether there was one that was not cancelled."""
        if not self.waiting.get(queue):
            return False
        handle = self.waiting[queue].pop(0)

        def listen(event: object) -> None:
            handle.listener(event)  # type: ignore[arg-type]
            between()

        handle.listener(run_job(handle.job, listen, lambda: handle.cancelled))
        return not handle.cancelled

    def all(self) -> None:
        while any(self.waiting.values()):
            for queue in list(self.waiting):
                self.let(queue)

    def close(self) -> None: ...

    class Handle:
        done = False

        def __init__(self, job: Job, listener: Listener) -> None:
            self.job, self.listener, self.cancelled = job, listener, False

        def cancel(self) -> None:
            self.cancelled = True


@pytest.fixture
def held() -> Held:
    return Held()


@pytest.fixture
def session(held: Held) -> Session:
    made = Session(held, Choices(method="quadric", level=2, l_max=4, target="fit"))
    egg = icosphere(3)
    made.adopt([Particle("egg", egg.moved(scale=20.0))])
    held.all()
    assert made.results.coarsened is not None
    return made


def test_that_a_surface_under_way_is_shown_although_the_slider_has_gone_on(
    session: Session, held: Held
) -> None:
    for l_max in (5, 6, 7):
        session.choose("drag", l_max=l_max)
    assert held.let("surface")
    assert session.results.surface_l_max == 5
    assert len(held.waiting["surface"]) == 1
    session.choose("drag", l_max=9)
    assert held.let("surface")
    assert session.results.surface_l_max == 7
    held.all()
    assert session.results.surface_l_max == 9
    assert session.results.coarsened is not None


def test_that_a_coarsening_shows_its_first_polyhedron_before_it_makes_room(
    session: Session, held: Held
) -> None:
    session.choose("drag", n_facets=12)
    for n_facets in (13, 14):
        session.choose("drag", n_facets=n_facets)
    shown: list[int] = []
    session.events.coarsening.connect(
        lambda: shown.append(session.results.polyhedron.n_facets if session.results.polyhedron else 0)
    )
    assert not held.let("coarsening")  # stopped as soon as it had shown something
    assert 12 in shown
    held.all()
    assert session.results.coarsened is not None
    assert session.results.coarsened.n_facets_asked == 14


def test_that_the_search_for_the_fewest_facets_shows_every_trial(session: Session, held: Held) -> None:
    session.choose(stop_at="error", largest_error=0.08)
    shown: list[int] = []

    def look() -> None:
        solid = session.results.polyhedron
        if solid is not None and (not shown or shown[-1] != solid.n_facets):
            shown.append(solid.n_facets)

    assert held.let("coarsening", look)
    done = session.results.coarsened
    assert done is not None
    assert done.reason is None
    assert len(set(shown)) > 3  # doubled, then halved
    assert shown[-1] == done.n_facets
    assert max(done.errors[key] for key in ("sphericity", "min_diameter", "max_diameter")) <= 0.08


def test_that_another_particle_never_waits_for_the_surface_of_the_last(session: Session, held: Held) -> None:
    session.adopt([Particle("pea", icosphere(2).moved(scale=3.0))], add=True)
    held.all()
    session.choose(l_max=6)
    session.select("egg")
    held.all()
    assert session.selected is not None
    assert session.results.surface is not None
    volume = session.selected.particle.mesh.volume
    assert session.results.surface.volume == pytest.approx(volume, rel=0.05)


def test_that_an_outdated_failure_is_not_told(session: Session, held: Held) -> None:
    failures: list[str] = []
    session.events.failed.connect(lambda failure: failures.append(failure.sentence))
    session.choose(l_max=5)
    handle = held.waiting["surface"][0]
    handle.job = Job(_refuse)
    session.choose(l_max=6)
    held.all()
    assert failures == []
    assert session.results.surface_l_max == 6


def test_that_nothing_is_made_of_a_surface_that_could_not_be_drawn(session: Session, held: Held) -> None:
    failures: list[str] = []
    session.events.failed.connect(lambda failure: failures.append(failure.sentence))
    session.choose(l_max=5)
    held.waiting["surface"][0].job = Job(_refuse)
    held.all()
    assert len(failures) == 1
    session.choose(n_facets=15)
    session.choose(box_metric="trimesh")
    held.all()
    assert len(failures) == 1
    assert session.results.coarsened is None
    session.choose(l_max=6)
    held.all()
    assert session.results.coarsened is not None
    assert session.results.coarsened.n_facets_asked == 15


def test_that_a_curve_has_one_point_a_step_and_a_total_that_never_falls(session: Session, held: Held) -> None:
    session.choose(n_facets=15)
    held.waiting["coarsening"][0].job = Job(_in_searches)
    seen: list[str] = []

    def look() -> None:
        now = session.results.coarsening_progress
        seen.append(f"{now.step} of {now.steps}" if now else "")
        assert [step for step, _ in session.results.loss_history] == list(range((now.step + 1) if now else 0))

    held.let("coarsening", look)
    assert seen == ["0 of 9", "1 of 9", "1 of 9", "2 of 23", "3 of 23"]


def test_that_a_failed_coarsening_leaves_its_reason_and_nothing_else(session: Session, held: Held) -> None:
    session.choose(n_facets=15)
    held.waiting["coarsening"][0].job = Job(_in_searches)
    held.all()
    results = session.results
    assert (results.best, results.coarsened, results.coarsening_progress) == (None, None, None)
    assert results.loss_history == ()
    assert "no polyhedron" in results.failures["coarsening"]


def test_that_what_a_user_has_stopped_is_not_being_computed(session: Session, held: Held) -> None:
    session.choose(l_max=5)
    session.cancel(next(task.id for task in session.tasks if task.queue == "surface"))
    held.all()
    assert session.results.failures["coarsening"] == STOPPED
    session.choose(l_max=6)
    held.all()
    assert not session.results.failures
    assert session.results.coarsened is not None


def test_that_the_last_result_stays_where_other_weights_begin_with_a_worse_polyhedron(
    session: Session, held: Held
) -> None:
    last = session.results.coarsened
    assert last is not None
    weights = LossWeights(tuple(3.0 if key == "volume" else 1.0 for key in WEIGHT_KEYS))
    best = []
    for changes, loss in (({"weights": weights}, 9.0), ({"weights": weights, "n_facets": 9}, 9.0)):
        session.choose(**changes)
        step = CoarseningProgress(0, 1, loss, last.polyhedron, last.centre)
        held.waiting["coarsening"][-1].listener(Partial(step))
        best.append(session.results.best)
        held.all()
    assert best[0] is not None
    assert best[0].loss == pytest.approx(last.loss + 2 * last.errors["volume"])
    assert best[0].errors == last.errors
    assert best[1] is not None
    assert best[1].loss == 9.0, "a polyhedron with other facets says nothing"


def test_that_a_step_of_a_method_that_keeps_terms_follows_a_result_of_one_that_cannot(
    session: Session, held: Held
) -> None:
    last = session.results.coarsened
    assert last is not None
    weights = LossWeights.of(volume=1.0, max_diameter=1.0).keeping(["volume"])
    session.choose(method="exact", weights=weights)
    held.waiting["coarsening"][-1].listener(
        Partial(CoarseningProgress(0, 1, 9.0, last.polyhedron, last.centre))
    )
    assert session.results.best is not None
    assert session.results.best.loss == 9.0
    held.all()


def test_that_another_particle_has_no_curve_of_the_last(session: Session, held: Held) -> None:
    session.adopt([Particle("pea", icosphere(2).moved(scale=3.0))], add=True)
    held.all()
    assert session.results.loss_history
    session.choose(selected="egg")
    assert session.results.loss_history == ()
    assert session.results.best is None


def _in_searches():  # type: ignore[no-untyped-def]
    for step, total in ((0, 9), (1, 9), (1, 9), (2, 23), (3, 20)):
        yield Partial(CoarseningProgress(step, total, 1.0 - 0.1 * step, None, np.zeros(3)))
    raise InputError("There is no polyhedron.")


def _refuse():  # type: ignore[no-untyped-def]
    raise ValueError("an old degree")
    yield
