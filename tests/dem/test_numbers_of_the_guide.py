"""Numbers in docs/repose*.md and docs/exporters.md against code and results of the benchmarks."""

import json
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from benchmarks.repose_intervals import ANGLES, line, measured
from regolith_studio.dataset.dataset import Dataset, Frame, Representative
from regolith_studio.dataset.export import ExportOptions
from regolith_studio.dataset.multisphere import COUNTS
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest, ScriptTimes
from regolith_studio.dataset.size_distributions import DiscreteSizeDistribution
from regolith_studio.dem.angle_of_repose import NEIGHBOURHOOD
from regolith_studio.dem.case import ReposeCase, prepare, rayleigh_time, scaling_report
from regolith_studio.dem.engine import DEEP_OVERLAP, MAX_DEEP_CONTACTS, MAX_OVERLAP
from regolith_studio.dem.engines.lammps.program import LammpsSettings
from regolith_studio.dem.engines.mujoco.simulation import MAX_MOVE, SMALLEST_SHARE
from regolith_studio.dem.evaluation import MAX_CURVATURE, EvaluationSettings
from regolith_studio.dem.verification.bodies import cuboid

ROOT = Path(__file__).parents[2]
REPOSE = "\n".join(path.read_text("utf-8") for path in sorted((ROOT / "docs").glob("repose*.md")))
ENGINES = ("mujoco", "lammps")
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


def test_that_the_plan_for_the_paper_s_particles_has_the_numbers_of_the_code() -> None:
    sizes = DiscreteSizeDistribution.of((25.0, 37.0, 56.0, 84.0, 125.0), (85.5, 12.6, 1.7, 0.23, 0.03))
    share, diameter = np.array(sizes.shares), np.array(sizes.diameters_um)
    volume = np.pi / 6 * (share @ (10e-6 * diameter) ** 3)
    count = round(LiftingCylinderTest().mass / ContactParameters().density / volume)
    frame = Frame(np.eye(3), np.zeros(3), 100.0)
    paper = Dataset("paper", (Representative("cube", cuboid(1, 1, 1), 1.0, sizes, frame),))
    prepared = prepare(paper, ReposeCase(n_particles=count, cohesion="given"))
    found, contact = scaling_report(prepared), prepared.case.contact
    smallest = float(prepared.diameters.min())
    seconds = ScriptTimes().duration(LiftingCylinderTest())
    soft = 0.2 * rayleigh_time(smallest, contact.density, 3e7, contact.poissons_ratio)
    for sentence in (
        f"coarse graining 10 | {count:,} (what",
        f"{1e3 * found.mean_diameter:.3f} mm, {1e3 * smallest:.3f} mm; "
        f"the cylinder is {found.diameters_across:.0f} particles wide",
        f"expected fill height | {100 * found.fill_height:.1f} cm",
        f"of 20 facets | {count * (4 * 20 - 12) / 1e6:.0f} million",
        f"contacts of 30 GPa | {found.full_stiffness_steps / 1e6:.0f} million",
        f"softened to 30 MPa | {1e-6 / soft:.2f} million",
        f"as simulated | {found.bond_number[2]:.0f} |",
        f"lift by 8 cm at 3 cm/s, rest | {seconds:.1f} s |",
        f"{1e-6 * seconds / soft:.1f} million steps instead of "
        f"{1e-6 * seconds * found.full_stiffness_steps:.0f} million",
        f"{10 * 378 ** (1 / 3):.0f} at 1,000 particles, {10 * 75.6 ** (1 / 3):.0f} at 5,000",
    ):
        assert sentence in one_line(REPOSE)


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
