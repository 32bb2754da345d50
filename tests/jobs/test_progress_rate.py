"""Rate and remaining time of a batch."""

import pytest

from regolith_studio.descriptors.catalogue import DEFAULT_KEYS
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs import particle_jobs
from regolith_studio.jobs.events import Progress, ProgressRate, format_duration
from tests.steps import played


def test_that_the_pace_is_items_by_seconds_and_forgets_what_was_done_before() -> None:
    now = [0.0]
    rate = ProgressRate(1000, 400, clock=lambda: now[0])
    assert str(rate) == ""
    now[0] = 10.0
    rate.advance(50, failed=2)
    assert rate.rate == 5.0
    assert rate.seconds_left == 110.0
    assert str(rate) == "5 a second, 1 min 50 s left, 2 failed"


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(8.4, "8 s"), (99, "99 s"), (200, "3 min 20 s"), (1500, "25 min"), (7500, "2 h 5 min")],
)
def test_that_a_time_is_said_as_people_say_it(seconds: float, words: str) -> None:
    assert format_duration(seconds) == words


def test_that_the_parts_of_a_large_mesh_are_named_while_it_is_measured(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(particle_jobs, "LARGE", 300)
    particles = (Particle("small", icosphere(1)), Particle("large", icosphere(2)))
    steps, measured = played(particle_jobs.measure_sample(particles))
    story = []
    for step in steps:
        if isinstance(step, Progress) and (step.done, step.message) not in [(0, ""), *story[-1:]]:
            story.append((step.done, step.message))
    parts = 2 + len(DEFAULT_KEYS)
    assert story[0] == (1, "small")
    assert story[-1] == (2, "large")
    assert [message.split(":")[0] for _, message in story[1:-1]] == [
        f"large ({k}/{parts}" for k in range(1, parts + 1)
    ]
    assert measured[1].descriptors == describe(icosphere(2))
