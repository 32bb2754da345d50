"""The session with real jobs on small bodies; run inline, or by threads where time matters."""

import queue
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.session.choices import Choices, Kind
from regolith_studio.session.session import Session

SMALL = Choices(method="quadric", level=2, l_max=4, target="fit")


def ellipsoid(a: float, b: float, c: float) -> Mesh:
    sphere = icosphere(3)
    return Mesh(sphere.vertices * [a, b, c], sphere.faces)


@pytest.fixture(scope="module")
def grains(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("grains")
    for number, axes in enumerate([(30, 20, 15), (22, 21, 20), (40, 25, 12)]):
        (folder / f"grain-{number}.stl").write_bytes(stl_bytes(ellipsoid(*axes).triangles, "test"))
    return folder


@pytest.fixture
def session() -> Iterator[Session]:
    session = Session(InlineRunner(), SMALL)
    yield session
    session.close()


@pytest.fixture
def opened(session: Session, grains: Path) -> Session:
    session.open([grains])
    return session


def listen(session: Session, *events: str) -> list[str]:
    received: list[str] = []
    for event in events:
        getattr(session.events, event).connect(lambda *_, name=event: received.append(name))
    return received


def test_that_opening_selects_the_first_particle_and_computes_everything(opened: Session) -> None:
    assert [entry.id for entry in opened.particles] == ["grain-0", "grain-1", "grain-2"]
    assert opened.choices.selected == "grain-0"
    results = opened.results
    assert results.fit is not None
    assert results.fit.l_max == 30
    assert results.surface is not None
    assert len(results.surface.faces) == 320
    assert results.coarsened is not None
    assert results.coarsened.n_facets == 20
    assert set(results.fit_errors) == set(results.coarsened.errors)
    assert opened.tasks == ()


def test_that_moving_l_max_draws_another_surface_and_keeps_the_fit(opened: Session) -> None:
    before = opened.results
    received = listen(opened, "fit", "surface", "descriptors", "coarsening")
    opened.choose(l_max=2)
    assert opened.results.fit is before.fit
    assert opened.results.surface is not before.surface
    assert received[0] == "surface"
    assert "fit" not in received
    assert {"descriptors", "coarsening"} <= set(received)


def test_that_the_particle_itself_can_be_imitated(opened: Session) -> None:
    assert opened.selected is not None
    opened.choose(target="particle")
    assert opened.results.coarsened is not None
    target = opened.results.coarsened.target
    assert target["volume"] == pytest.approx(opened.selected.particle.mesh.volume)
    assert opened.results.against_particle is None


def test_that_a_polyhedron_of_the_fit_is_compared_with_the_particle(opened: Session) -> None:
    """At l_max = 0 the fit is a sphere: what the polyhedron meets of it says nothing of the particle."""
    opened.choose(l_max=0, method="quadric")
    found, coarsened = opened.results.against_particle, opened.results.coarsened
    assert found is not None
    assert coarsened is not None
    mesh = opened.selected.particle.mesh if opened.selected else None
    assert mesh is not None
    volume = coarsened.achieved["volume"]
    assert found.errors["volume"] == pytest.approx(abs(1.0 - volume / mesh.volume), rel=1e-6)
    assert found.errors["aspect_ratio"] > 0.4  # axes of 60 x 40 x 30: 2 against about 1
    assert found.jaccard_distance > 0.2


def test_that_another_reference_makes_another_fit_and_going_back_finds_the_first(opened: Session) -> None:
    first, loss = opened.results.fit, opened.results.coarsened.loss  # type: ignore[union-attr]
    opened.choose(reference="ellipsoid")
    other = opened.results.fit
    assert other is not None
    assert other.reference is not None
    assert opened.results.coarsened.loss != loss  # type: ignore[union-attr]
    opened.choose(reference="sphere")
    assert opened.results.fit is first
    assert opened.results.coarsened.loss == loss  # type: ignore[union-attr]
    opened.choose(reference="ellipsoid")
    assert opened.results.fit is other


def test_that_undo_and_redo_bring_the_results_back(opened: Session) -> None:
    loss = opened.results.coarsened.loss  # type: ignore[union-attr]
    for faces in (12, 14, 16):
        opened.choose("faces", n_facets=faces)
    opened.undo()
    assert opened.choices.n_facets == 20
    assert opened.results.coarsened.loss == loss  # type: ignore[union-attr]
    opened.redo()
    assert opened.choices.n_facets == 16
    assert not opened.can_redo


def test_that_a_refused_choice_changes_nothing(opened: Session) -> None:
    before = opened.choices
    with pytest.raises(InputError, match="from 5 to 500"):
        opened.choose(n_facets=1)
    with pytest.raises(InputError, match="grain-9"):
        opened.select("grain-9")
    assert opened.choices is before


def test_that_files_that_cannot_be_read_are_told_and_cost_nothing(session: Session, grains: Path) -> None:
    problems: list[str] = []
    session.events.problems.connect(lambda found: problems.extend(each.sentence for each in found))
    session.open([grains / "grain-0.stl", grains / "nothing.stl"])
    assert [entry.id for entry in session.particles] == ["grain-0"]
    assert len(problems) == 1


def test_that_opening_nothing_useful_fails_with_a_sentence_and_keeps_what_was_there(opened: Session) -> None:
    failures: list[str] = []
    opened.events.failed.connect(lambda failure: failures.append(failure.sentence))
    opened.open(["/nowhere/nothing.stl"])
    assert len(failures) == 1
    assert len(opened.particles) == 3


def test_that_particles_of_the_same_name_are_told_apart(opened: Session, grains: Path) -> None:
    opened.open([grains / "grain-0.stl"], add=True)
    ids = [entry.id for entry in opened.particles]
    assert len(set(ids)) == 4
    assert opened.choices.selected == ids[3]


def test_that_a_study_is_outdated_by_another_l_max_and_fresh_again_after_undo(opened: Session) -> None:
    opened.start_study(Kind.LMAX_STUDY, degrees=(1, 2))
    assert opened.results.lmax_study is not None
    assert opened.results.lmax_study.degrees == (1, 2)
    opened.choose(level=3)
    assert opened.results.outdated == {"lmax_study"}
    opened.undo()
    assert opened.results.outdated == frozenset()


def test_that_work_without_particles_is_refused(session: Session) -> None:
    with pytest.raises(InputError, match="open a mesh"):
        session.start_study("lmax_study")


class Desk:
    """A session run by threads, whose event loop is in the hands of the test."""

    def __init__(self) -> None:
        self.calls: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.session = Session(ThreadRunner(self.calls.put), SMALL)

    def run_until(self, condition: Callable[[], bool]) -> None:
        end = time.monotonic() + 60
        while not condition():
            assert time.monotonic() < end, f"still running: {self.session.tasks}"
            try:
                self.calls.get(timeout=0.02)()
            except queue.Empty:
                continue


@pytest.fixture
def desk() -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.session.close()
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("queue ")]


def test_that_by_threads_the_last_of_many_choices_wins(desk: Desk, grains: Path) -> None:
    session = desk.session
    session.open([grains])
    desk.run_until(lambda: bool(session.particles) and not session.tasks)
    for l_max in (2, 3, 5, 6, 7, 8, 9, 0):
        session.choose("l_max", l_max=l_max)
    desk.run_until(lambda: not session.tasks)
    assert session.results.surface is not None
    radii = np.linalg.norm(session.results.surface.vertices - session.results.fit.star_point, axis=1)  # type: ignore[union-attr]
    assert np.ptp(radii) < 0.01 * radii.mean()
    target = session.results.coarsened.target  # type: ignore[union-attr]
    assert target["sphericity"] > 0.98
    session.undo()
    desk.run_until(lambda: not session.tasks)
    assert session.choices.l_max == SMALL.l_max


def test_that_choosing_another_particle_at_once_never_mixes_results(desk: Desk, grains: Path) -> None:
    session = desk.session
    session.open([grains])
    desk.run_until(lambda: bool(session.particles))
    for name in ("grain-1", "grain-2", "grain-1", "grain-0", "grain-2"):
        session.select(name)
    desk.run_until(lambda: not session.tasks)
    assert session.selected is not None
    volume = session.selected.particle.mesh.volume
    assert session.selected.id == "grain-2"
    assert session.results.surface.volume == pytest.approx(volume, rel=0.02)  # type: ignore[union-attr]
    assert session.results.coarsened.target["volume"] == pytest.approx(volume, rel=0.02)  # type: ignore[union-attr]


def test_that_a_cancelled_task_leaves_the_session_usable(desk: Desk, grains: Path) -> None:
    session = desk.session
    session.open([grains])
    desk.run_until(lambda: bool(session.particles) and not session.tasks)
    task = session.start_study("lmax_study")
    session.cancel(task)
    desk.run_until(lambda: not session.tasks)
    session.choose(l_max=3)
    desk.run_until(lambda: not session.tasks)
    assert session.results.coarsened is not None


def test_that_a_fit_that_cannot_be_made_shows_nothing_and_is_told_once(
    opened: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise InputError("The grain is too shy.")

    failures: list[str] = []
    opened.events.failed.connect(lambda failure: failures.append(failure.sentence))
    monkeypatch.setattr("regolith_studio.harmonics.fit.fit_harmonics", refuse)
    opened.select("grain-1")
    results = opened.results
    assert failures == ["The grain is too shy."]
    assert (results.fit, results.surface, results.best) == (None, None, None)
    opened.choose(l_max=7)
    assert len(failures) == 1
    opened.choose(target="particle")
    assert opened.results.coarsened is not None


def test_that_a_degree_without_a_solid_clears_the_old_picture(
    opened: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise InputError("The expansion has a negative radius.")

    monkeypatch.setattr("regolith_studio.jobs.particle_jobs.reconstruct", refuse)
    opened.choose(l_max=7)
    results = opened.results
    assert results.fit is not None
    assert (results.surface, results.fit_descriptors, results.best) == (None, None, None)
    monkeypatch.undo()
    opened.choose(l_max=6)
    assert opened.results.surface is not None
    assert opened.results.coarsened is not None


def test_that_a_change_of_choices_names_the_fields_that_have_changed(opened: Session) -> None:
    changes: list[frozenset[str]] = []
    opened.events.choices.connect(changes.append)
    opened.choose(l_max=7, seed=opened.choices.seed)
    opened.choose(method="annealing", l_max=7)
    opened.undo()
    opened.choose(l_max=7)
    assert changes == [{"l_max"}, {"method"}, {"method"}]
    opened.select("grain-1")
    assert changes[-1] == {"selected"}
