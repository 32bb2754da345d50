"""Numbers in docs/repose*.md and docs/exporters.md against code and results of the benchmarks."""

import json
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from benchmarks.repose_intervals import ANGLES, line, measured
from regolith_studio.dataset.export import ExportOptions
from regolith_studio.dataset.multisphere import COUNTS
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import NEIGHBOURHOOD
from regolith_studio.dem.case import ReposeCase
from regolith_studio.dem.engine import DEEP_OVERLAP, MAX_DEEP_CONTACTS, MAX_OVERLAP
from regolith_studio.dem.engines.lammps.program import LammpsSettings
from regolith_studio.dem.engines.mujoco.simulation import MAX_MOVE, SMALLEST_SHARE
from regolith_studio.dem.evaluation import MAX_CURVATURE, EvaluationSettings

ROOT = Path(__file__).parents[2]
REPOSE = "\n".join(path.read_text("utf-8") for path in sorted((ROOT / "docs").glob("repose*.md")))
EXPORTERS = (ROOT / "docs" / "exporters.md").read_text("utf-8")


def rows_of(text: str, header: str) -> list[list[str]]:
    """Cells of the rows of the table with this header."""
    rows = text.partition(header)[2].partition("\n\n")[0].splitlines()
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows[2:]]


def one_line(text: str) -> str:
    return " ".join(text.split())


def test_that_the_table_of_the_evaluation_has_the_default_settings() -> None:
    said = {row[1]: row[2] for row in rows_of(REPOSE, "| step | setting | default |")}
    defaults = asdict(EvaluationSettings())
    assert len(said) == 8
    for keys, text in said.items():
        for key in re.findall(r"`(\w+)`", keys):
            value = {True: "on", False: "off"}.get(defaults[key]) if text == "on" else defaults[key]
            assert text.partition(":")[0] == (value if isinstance(value, str) else f"{value:g}")


def test_that_the_table_of_choices_has_the_default_parameters() -> None:
    said = {row[0]: row[1] for row in rows_of(REPOSE, "| not given | chosen |")}
    contact, test = ContactParameters(), LiftingCylinderTest()
    assert said == {
        "restitution": f"{contact.restitution:g}",
        "rolling resistance": f"{contact.rolling_friction:g}",
        "speed of the cylinder": f"{100 * test.lift_speed:g} cm/s",
        "friction at the wall, on the plate": f"{test.wall_friction:g}, {test.plate_friction:g}",
        "gravity": f"{test.gravity:g} m/s²",
    }


def test_that_sentences_have_the_limits_of_the_code() -> None:
    lammps, words = LammpsSettings(), one_line(REPOSE)
    for sentence in (
        f"--particles {ReposeCase().n_particles}",
        f"rigid clumps of {lammps.spheres} overlapping spheres",
        f"(`restarts`, {lammps.restarts} times at most)",
        f"at most {100 * MAX_DEEP_CONTACTS:g} % of the contacts of the heap at rest are deeper than "
        f"{100 * DEEP_OVERLAP:g} % of the mean diameter, and none is deeper than {100 * MAX_OVERLAP:g} %",
        f"flanks within {NEIGHBOURHOOD:g} degrees counted as one",
        f"fewer than {EvaluationSettings().min_particles} particles",
    ):
        assert sentence in words
    assert "by more than half of itself between foot and top" in words
    assert MAX_CURVATURE == 0.5
    assert (
        "halved, up to three times, while one particle in a hundred moves further than a hundredth" in words
    )
    assert (SMALLEST_SHARE, MAX_MOVE) == (0.5**3, 0.01)
    assert f"({ExportOptions().n_spheres} by default" in one_line(EXPORTERS)
    assert f"{', '.join(map(str, COUNTS[:9]))} ... {COUNTS[-1]}" in one_line(EXPORTERS)


INTERVALS = json.loads((ROOT / "benchmarks/results/repose_intervals.json").read_text("utf-8"))


@pytest.mark.slow
def test_that_a_row_of_the_table_of_intervals_is_measured_again() -> None:
    first, heaps = INTERVALS["first_seed"], INTERVALS["heaps"]
    cases = [("equal, clean", 150, angle, first + k) for angle in ANGLES for k in range(heaps)]
    assert line("equal, clean", 150, np.array([measured(case) for case in cases])) == INTERVALS["rows"][0]
