"""Means over the repeats of a study against textbook numbers."""

from typing import Any

import pytest

from regolith_studio.studies.repose import repose_means, runs_from


def document(seed: int, angle: float | None, contacts: float | None = None) -> dict[str, Any]:
    """Of a run, as far as tables of studies read it."""
    heap = None if contacts is None else {"bulk_density": 1600.0, "coordination_number": contacts}
    return {
        "case": {"seed": seed, "n_particles": 500},
        "measurement": {"status": "monolayer" if angle is None else "pile", "angle_deg": angle},
        "packing": {"filled_bulk_density": 1700.0, "heap": heap},
    }


def test_that_means_have_student_s_intervals_over_the_runs_that_became_piles() -> None:
    """Three angles with a standard deviation of 2: half width 4.303 * 2 / sqrt(3), from a table of t."""
    rows = [
        ("friction", 0.4, "a", document(1, 28.0, 6.0)),
        ("friction", 0.4, "b", document(2, 30.0, 7.0)),
        ("friction", 0.4, "c", document(3, 32.0)),
        ("friction", 0.4, "d", document(4, None)),
        ("friction", 0.2, "e", document(1, 20.0, 5.0)),
        ("friction", 0.1, "f", document(1, None)),
    ]
    table = repose_means(runs_from(rows))
    assert table is not None
    half = 4.303 * 2 / 3**0.5
    first, single, none = table.rows
    assert first[:3] == ("friction", 0.4, 3)
    expected = [30.0, 30.0 - half, 30.0 + half, 2.0, 1700.0, 1600.0, 6.5]
    assert first[3:] == pytest.approx(expected, rel=1e-4)
    assert single == ("friction", 0.2, 1, 20.0, None, None, None, 1700.0, 1600.0, 5.0)
    assert none == ("friction", 0.1, 0, None, None, None, None, None, None, None)


def test_that_a_study_without_repeats_has_no_table_of_means() -> None:
    rows = [("friction", value, f"{value}", document(1, 30.0)) for value in (0.2, 0.4)]
    assert repose_means(runs_from(rows)) is None
