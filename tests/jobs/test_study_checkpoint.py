"""StudyCheckpoint that were kept are given again to the bit, and only for the same question."""

import json
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.study_jobs import MAX_NUMBERS, StudyCheckpoint, hash_of_particles

GIVEN: dict[int, Any] = {
    0: np.array([[0.1, -0.0, np.nan], [np.inf, 1e-308, 2.0 / 3.0]]),
    1: "The mesh is open.",
    2: (np.array([[1.0 / 3.0]]), (True,)),
    3: object(),  # cannot be kept
    4: np.zeros(MAX_NUMBERS + 1),  # too large
    5: np.empty((0, 4)),
}


def asked(path: Path, resume: bool, until: int = len(GIVEN)) -> tuple[list[Any], list[int]]:
    """All answers, and for which items there was work to do; the work is broken off at item `until`."""
    worked: list[int] = []

    def work(item: int) -> Any:
        if item == until:
            raise KeyboardInterrupt
        worked.append(item)
        return GIVEN[item]

    with StudyCheckpoint(path, resume) as answers:
        answers.open("counting", ("abc", 1), "inputs")
        mapper = answers.wrap(map)
        found = [*mapper(work, [0, 1, 2]), *mapper(work, iter([3, 4, 5]))]
    return found, worked


def test_that_what_was_known_is_not_worked_out_again_and_is_the_same_to_the_bit(tmp_path: Path) -> None:
    path = tmp_path / "out" / "journal" / "study.sqlite"
    with pytest.raises(KeyboardInterrupt):
        asked(path, False, until=5)
    found, worked = asked(path, True)
    assert worked == [3, 4, 5]
    for at, answer in enumerate(found):
        given = GIVEN[at]
        if isinstance(given, np.ndarray):
            assert answer.tobytes() == given.tobytes()
            assert answer.shape == given.shape
        elif isinstance(given, tuple):
            assert answer[0].tobytes() == given[0].tobytes()
            assert answer[1] == given[1]
        else:
            assert answer == given
    assert not (tmp_path / "out").exists()  # there was nothing else in it


def test_that_an_answer_that_was_damaged_is_worked_out_again(tmp_path: Path) -> None:
    path = tmp_path / "out" / "journal" / "study.sqlite"
    with pytest.raises(KeyboardInterrupt):
        asked(path, False, until=3)
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("UPDATE records SET content = replace(content, 'open', 'shut')")
    assert asked(path, True)[1] == [1, 3, 4, 5]


@pytest.mark.parametrize(
    ("other", "words"),
    [
        ({"study": "weighing"}, "another study"),
        ({"options": ("abc", 2)}, "another set of options"),
        ({"inputs": "others"}, "another set of particles"),
    ],
)
def test_that_answers_to_another_question_are_refused(
    tmp_path: Path, other: dict[str, Any], words: str
) -> None:
    path = tmp_path / "out" / "journal" / "study.sqlite"
    with pytest.raises(KeyboardInterrupt):
        asked(path, False, until=2)
    before = path.read_bytes()
    question = {"study": "counting", "options": ("abc", 1), "inputs": "inputs"} | other
    with pytest.raises(FileError, match=words), StudyCheckpoint(path, True) as answers:
        answers.open(**question)
    assert path.read_bytes() == before


def test_that_without_resume_a_study_begins_anew(tmp_path: Path) -> None:
    path = tmp_path / "out" / "journal" / "study.sqlite"
    with pytest.raises(KeyboardInterrupt):
        asked(path, False, until=2)
    assert asked(path, False)[1] == list(GIVEN)


def test_that_other_versions_of_programs_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "out" / "journal" / "study.sqlite"
    with pytest.raises(KeyboardInterrupt):
        asked(path, False, until=2)
    with closing(sqlite3.connect(path)) as database, database:
        (text,) = database.execute("SELECT content FROM notes WHERE name = 'subject'").fetchone()
        subject = json.loads(text)
        subject["set of program versions"]["numpy"] = "0.1"
        database.execute("UPDATE notes SET content = ? WHERE name = 'subject'", (json.dumps(subject),))
    with pytest.raises(FileError, match="another set of program versions"):
        asked(path, True)


def test_that_a_fingerprint_knows_names_groups_and_coordinates() -> None:
    ball = icosphere(1)
    first = Particle("a", ball, "g")
    others = [
        (),
        (first, first),
        (Particle("b", ball, "g"),),
        (Particle("a", ball, "h"),),
        (Particle("ag", ball, ""),),
        (Particle("a", ball.moved(scale=1.0 + 1e-15), "g"),),
    ]
    assert hash_of_particles((first,)) == hash_of_particles((Particle("a", icosphere(1), "g"),))
    assert len({hash_of_particles(each) for each in [(first,), *others]}) == 1 + len(others)
