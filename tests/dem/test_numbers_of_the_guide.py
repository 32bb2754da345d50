"""Numbers in docs/repose*.md and docs/changed_shapes.md against code and results of the benchmarks."""

import json
import re
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

from benchmarks.calibration import ANGLE_OFFSET, DENSITY_OFFSET, NOISE, SCATTER
from benchmarks.heaps import KINDS
from benchmarks.repose_intervals import ANGLES, flank_angle, line, measured
from benchmarks.sliding_friction import box
from regolith_studio.dataset.alignment import Frame
from regolith_studio.dataset.dataset import Dataset, Representative
from regolith_studio.dataset.export import ExportOptions
from regolith_studio.dataset.multisphere import COUNTS
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest, ScriptTimes
from regolith_studio.dataset.size_distributions import DiscreteSizeDistribution
from regolith_studio.dem.angle_of_repose import NEIGHBOURHOOD, ROUGH_SHARE
from regolith_studio.dem.case import ReposeCase, prepare
from regolith_studio.dem.engines.lammps.program import LammpsSettings
from regolith_studio.dem.engines.mujoco.simulation import MAX_MOVE, SMALLEST_SHARE
from regolith_studio.dem.engines.yade.program import YadeSettings
from regolith_studio.dem.evaluation.settings import MAX_CURVATURE, EvaluationSettings
from regolith_studio.dem.run_checks import DEEP_OVERLAP, MAX_DEEP_CONTACTS, MAX_OVERLAP
from regolith_studio.dem.scaling_report import rayleigh_time, scaling_report

ROOT = Path(__file__).parents[2]
REPOSE = "\n".join(path.read_text("utf-8") for path in sorted((ROOT / "docs").glob("repose*.md")))
ENGINES = ("mujoco", "lammps")
EXPORTERS = (ROOT / "docs" / "changed_shapes.md").read_text("utf-8")


def rows_of(text: str, header: str) -> list[list[str]]:
    """Cells of the rows of the table with this header."""
    rows = text.partition(header)[2].partition("\n\n")[0].splitlines()
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows[2:]]


def results(name: str) -> list[dict[str, Any]]:
    return list(json.loads((ROOT / "benchmarks" / "results" / name).read_text("utf-8")))


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


def test_that_the_table_of_sliding_friction_has_the_results_of_its_benchmark() -> None:
    table = json.loads((ROOT / "benchmarks/results/sliding_friction.json").read_text("utf-8"))
    found = table["slope of 50 degrees"]["rows"]
    said = rows_of(REPOSE, "| settings | all | cubes | bricks | tumbled | steps |")
    assert said == [
        [name, *(f"{each:.3f}" for each in row[:3]), f"{100 * row[3]:.0f} %", f"{row[4]:,.0f}"]
        for name, row in found.items()
    ]
    usual, single = found["as it is"], found["one step for all speeds"]
    assert f"with a friction of 0.8 feel {single[0]:.2f}" in one_line(REPOSE)
    assert f"bricks, which stay flat, feel {usual[2]:.2f}" in one_line(REPOSE)
    assert f"hop, tumble and feel {usual[1]:.2f}" in one_line(REPOSE)


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
    paper = Dataset("paper", (Representative("cube", box(1, 1, 1), 1.0, sizes, frame),))
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
        f"(`restarts`, {YadeSettings().restarts} times at most)",
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


def test_that_the_sentences_on_both_engines_have_the_results_of_their_runs() -> None:
    runs = {key: [row for row in results("repose_engines.json") if row["engine"] == key] for key in ENGINES}
    angles = [np.mean([row["angle_deg"] for row in runs[key]]) for key in ENGINES]
    heights = np.array([[row["fill_height_cm"] for row in runs[key]] for key in ENGINES])
    low, high = np.sort(100 * (1 - heights[1] / heights[0]))[[0, -1]]
    words = one_line(REPOSE)
    assert f"{angles[0]:.1f} and {angles[1]:.1f} degrees in the mean" in words
    assert f"fill the cylinder {low:.0f} to {high:.0f} % less high" in words
    deepest = max(row["max_overlap"] for row in runs["lammps"])
    assert f"spheres overlap by {100 * deepest:.1f} % of a diameter at most" in words
    assert not any("flew apart" in note for row in runs["lammps"] for note in row["notes"])
    assert not any(row["problems"] for key in ENGINES for row in runs[key])


@pytest.mark.parametrize("engine", ENGINES)
def test_that_the_table_of_engines_has_the_results_of_its_runs(engine: str) -> None:
    column = {"mujoco": 1, "lammps": 3}[engine]
    rows = rows_of(REPOSE, "| seed | MuJoCo: filled to, packed | angle | LAMMPS: filled to, packed | angle |")
    found = [row for row in results("repose_engines.json") if row["engine"] == engine]
    assert len(rows) == len(found) == 4
    for row, run in zip(rows, found, strict=True):
        low, high = run["interval_deg"]
        assert row[0] == str(run["seed"])
        assert row[column] == f"{run['fill_height_cm']:.2f} cm, {run['solid_fraction']:.2f}"
        assert row[column + 1] == f"{run['angle_deg']:.1f} ({low:.1f} to {high:.1f})"


def test_that_the_table_of_friction_has_the_results_of_its_runs() -> None:
    found: dict[str, list[dict[str, Any]]] = {}
    for run in results("repose_friction.json"):
        assert (run["particles"], run["problems"]) == (1000, [])
        found.setdefault(f"{run['value']:g}", []).append(run)
    rows = rows_of(REPOSE, "| friction | seed 0 | seed 1 | mean | filled to, packed |")
    assert {row[0] for row in rows} == set(found)
    for value, *cells in rows:
        runs = found[value]
        assert [run["seed"] for run in runs] == [0, 1]
        height, packed, angle = (
            np.mean([run[key] for run in runs]) for key in ("fill_height_cm", "solid_fraction", "angle_deg")
        )
        low_to_high = [" to ".join(f"{end:.1f}" for end in run["interval_deg"]) for run in runs]
        angles = [f"{run['angle_deg']:.1f} ({ends})" for run, ends in zip(runs, low_to_high, strict=True)]
        assert cells == [*angles, f"{angle:.1f}", f"{height:.2f} cm, {packed:.2f}"]
    means = [np.mean([run["angle_deg"] for run in found[value]]) for value in ("0.2", "0.8")]
    assert f"rises by {means[1] - means[0]:.1f} degrees from 0.2 to 0.8" in one_line(REPOSE)


@pytest.mark.parametrize(
    ("file", "kind", "words"),
    [
        ("repose_rapier.json", "", "{0:.1f} degrees on MuJoCo and {1:.1f} on Rapier"),
        ("repose_rapier_5000.json", ", 5,000", "stand at {1:.1f} degrees, MuJoCo's at {0:.1f}"),
    ],
)
def test_that_the_table_of_mujoco_and_rapier_has_the_results_of_its_runs(
    file: str, kind: str, words: str
) -> None:
    both = "filled to, packed | angle"
    header = f"| seed | MuJoCo{kind}: {both} | s | Rapier{kind}: {both} | deepest overlap | s |"
    said = {row[0]: row for row in rows_of(REPOSE, header)}
    found = [run for run in results(file) if run["particles"] <= 5000]
    for run in found:
        low, high = run["interval_deg"]
        cells = [
            f"{run['fill_height_cm']:.2f} cm, {run['solid_fraction']:.2f}",
            f"{run['angle_deg']:.1f} ({low:.1f} to {high:.1f})",
            f"{100 * run['max_overlap']:.1f} %",
            f"{run['processor_s']:,.0f}",
        ]
        row = said[str(run["seed"])]
        if run["engine"] == "mujoco":
            assert row[1:4] == [*cells[:2], cells[3]]
        else:
            assert row[4:8] == cells
    mujoco, rapier = (
        [run["angle_deg"] for run in found if run["engine"] == engine] for engine in ("mujoco", "rapier")
    )
    assert len(mujoco) == len(rapier) == len(said) == 5
    steeper = stats.ttest_rel(rapier, mujoco).confidence_interval()
    difference = np.mean(rapier) - np.mean(mujoco)
    assert words.format(np.mean(mujoco), np.mean(rapier)) in one_line(REPOSE)
    assert f"{difference:.1f} steeper ({steeper.low:.1f} to {steeper.high:.1f}" in one_line(REPOSE)


def test_that_the_table_of_creep_has_the_results_of_its_runs() -> None:
    found = results("heap_creep.json")
    rows = rows_of(
        REPOSE, "| contacts | way after 25 | after 100 | change of the angle after 25 | after 100 |"
    )
    variants = ("default", "half the step", "the solver's own softness")
    for variant, (_, *cells) in zip(variants, rows, strict=True):
        runs = [run for run in found if run["variant"] == variant]
        ways = np.mean([run["median_ways"] for run in runs], axis=0)
        angles = np.array([run["angles_deg"] for run in runs])
        changes = (angles[:, 1:] - angles[:, :1]).mean(axis=0)
        assert cells == [*(f"{way:.3f}" for way in ways), *(f"{change:.1f}" for change in changes)]


def test_that_the_table_of_deep_contacts_has_the_results_of_its_runs() -> None:
    found = json.loads((ROOT / "benchmarks/results/repose_deep_contacts.json").read_text("utf-8"))["phases"]
    rows = rows_of(REPOSE, "| heaps | settled filling | while the cylinder rises | at rest |")
    names = ("mujoco-1000", "8-facets", "20-facets", "rapier-10000")
    for name, (_, *cells) in zip(names, rows, strict=True):
        runs = [run for run in found if run["run"].startswith(name)]
        for phase, cell in zip(("settle", "lift", "rest"), cells, strict=True):
            shares = [100 * run["deep_share"] for run in runs if run["phase"] == phase]
            ends = dict.fromkeys(f"{each:.2f}" for each in (min(shares), max(shares)))
            deepest = max(run["max"] for run in runs if run["phase"] == phase)
            assert cell == f"{' to '.join(ends)} %, {100 * deepest:.1f} %"


def half_width(values: list[float]) -> float:
    """Of Student's interval of 95 % of a mean."""
    return float(stats.t.ppf(0.975, len(values) - 1) * stats.sem(values))


def welch(first: list[float], second: list[float]) -> tuple[str, str]:
    """Difference of two means with its interval of 95 %, as the guide writes it."""
    found = stats.ttest_ind(first, second, equal_var=False).confidence_interval()
    return f"{np.mean(first) - np.mean(second):.1f}", f"{found.low:.1f} to {found.high:.1f}"


def angles_by_coarsening(file: str = "repose_shapes.json") -> dict[str, list[float]]:
    """Angles of the runs of benchmarks.shape_heaps that have one."""
    found: dict[str, list[float]] = {}
    for run in results(file):
        if run["angle_deg"] is not None:
            found.setdefault(run["coarsening"], []).append(run["angle_deg"])
    return found


@pytest.mark.parametrize(
    ("file", "kind"),
    [("repose_shapes.json", ""), ("repose_shapes_5000.json", ", 5,000 particles")],
)
def test_that_the_table_of_facets_has_the_results_of_its_runs(file: str, kind: str) -> None:
    columns = "heaps | angle | deviation | filling, packed | contacts a particle"
    rows = rows_of(REPOSE, f"| facets{kind} | {columns} |")
    angles = angles_by_coarsening(file)
    assert [row[0] for row in rows] == list(angles)
    for name, *cells in rows:
        runs = [run for run in results(file) if run["coarsening"] == name]
        packed = np.mean([run["solid_fraction"] for run in runs])
        contacts = np.mean([run["coordination_number"] for run in runs if run["coordination_number"]])
        mean = f"{np.mean(angles[name]):.1f} ± {half_width(angles[name]):.1f}"
        spread = f"{np.std(angles[name], ddof=1):.1f}"
        assert cells == [f"{len(angles[name])}", mean, spread, f"{packed:.3f}", f"{contacts:.1f}"]


def test_that_differences_between_facets_are_those_of_the_runs() -> None:
    large = angles_by_coarsening("repose_shapes_5000.json")
    for first, second, words in (
        ("8", "60", "From 60 to 8 facets the angle rises by {} degrees ({}, Welch)"),
        ("8", "20", "from 20 to 8 by {} ({})"),
        ("20", "60", "from 60 to 20 by {} ({})"),
    ):
        assert words.format(*welch(large[first], large[second])) in one_line(REPOSE)
    angles = angles_by_coarsening()
    for first, second, words in (
        ("8", "60", "{} degrees from 60 to 8 ({}, Welch, 95 %)"),
        ("8", "20", "{} from 20 to 8 ({})"),
        ("20", "60", "{} from 60 to 20 ({})"),
        ("20 by quadrics", "20", "{} degrees with quadrics alone ({})"),
        ("20 with overlap", "20", "{} with the largest overlap ({})"),
    ):
        assert words.format(*welch(angles[first], angles[second])) in one_line(REPOSE)


def test_that_intervals_of_single_heaps_hold_the_mean_of_all_as_often_as_the_guide_says() -> None:
    angles = angles_by_coarsening()
    runs = [run for run in results("repose_shapes.json") if run["angle_deg"] is not None]
    held = [
        run["interval_deg"][0] <= np.mean(angles[run["coarsening"]]) <= run["interval_deg"][1] for run in runs
    ]
    freedom = len(runs) - len(angles)
    scatter = np.sqrt(sum(np.var(each) * len(each) for each in angles.values()) / freedom)
    words = one_line(REPOSE)
    assert f"of {len(runs)} heaps of 1,000 on Rapier" in words
    assert f"{sum(held)} ({100 * np.mean(held):.0f} %) have intervals" in words
    assert f"standard deviation of {scatter:.1f} degrees" in words
    calibration = one_line((ROOT / "docs" / "calibration.md").read_text("utf-8"))
    assert f"while heaps of other seeds differ by {scatter:.1f}" in calibration


def test_that_heaps_on_both_engines_differ_by_what_the_guide_says() -> None:
    mujoco = [run["angle_deg"] for run in results("repose_rapier.json") if run["engine"] == "mujoco"]
    rapier = angles_by_coarsening()["20"]
    mean, (difference, interval) = f"{np.mean(rapier):.1f}", welch(rapier, mujoco)
    words = f"{len(rapier)} heaps on Rapier stand at {mean} degrees in the mean, {difference} steeper"
    assert f"{words} ({interval}, Welch)" in one_line(REPOSE)


def test_that_the_table_of_surrogates_has_the_results_of_its_benchmark() -> None:
    text = (ROOT / "docs" / "calibration.md").read_text("utf-8")
    found = json.loads((ROOT / "benchmarks/results/calibration.json").read_text("utf-8"))["surrogates"]
    rows = rows_of(text, "| surrogates | covered of 100 | width, mean | width, median |")
    assert found["cases"] == 100
    assert rows == [
        [name, f"{covered:.0f}", f"{mean:.2f}", f"{median:.2f}"]
        for name, (covered, mean, median) in found["rows"].items()
    ]
    words = one_line(text)
    assert f"In the last row heaps scatter by {SCATTER} degrees, and state {NOISE}" in words
    assert f"differ by about {ANGLE_OFFSET:.0f} degrees and {DENSITY_OFFSET:.0f} kg/m³" in words


def test_that_the_table_of_blind_calibrations_has_the_results_of_its_runs() -> None:
    text = (ROOT / "docs" / "calibration.md").read_text("utf-8")
    found = [
        run
        for path in sorted((ROOT / "benchmarks/results").glob("blind_calibration*.json"))
        for run in json.loads(path.read_text("utf-8"))["calibrations"]
    ]
    for run in found:
        assert run["covered"] == (run["interval"][0] <= run["friction"] <= run["interval"][1])
    rows = rows_of(text, "| friction | calibrations | intervals that hold it | width, mean | width, range |")
    assert [row[0] for row in rows] == ["0.05 to 0.4", "0.4 to 0.8", "0.8 to 1.2"]
    for name, *said in rows:
        low, high = (float(end) for end in name.split(" to "))
        part = [run for run in found if low <= run["friction"] < high]
        widths = [run["width"] for run in part]
        assert said == [
            f"{len(part)}",
            f"{sum(run['covered'] for run in part)}",
            f"{np.mean(widths):.2f}",
            f"{min(widths):.2f} to {max(widths):.2f}",
        ]
    covered = sum(run["covered"] for run in found)
    chance = stats.binom.cdf(covered, len(found), 0.9)
    assert f"{covered} of {len(found)} intervals of 90 % hold the truth" in text
    assert f"come out with a probability of {chance:.2f}" in one_line(text)


def test_that_the_table_of_drawn_populations_has_the_results_of_its_runs() -> None:
    found = json.loads((ROOT / "benchmarks/results/population_heaps.json").read_text("utf-8"))
    rows = rows_of(REPOSE, "| form | roughness | aspect ratio | sphericity | angle | surface |")
    for row, (form, roughness, *cells) in zip(found["response_surface.json"]["rows"], rows, strict=True):
        assert row["dataset"] == f"form_{form}_roughness_{roughness}"
        low, high = row["surface_low"], row["surface_high"]
        surface = f"{row['surface']:.1f} ({low:.1f} to {high:.1f})"
        angle = f"{row['angle']:.1f}"
        assert cells == [f"{row['aspect_ratio']:.2f}", f"{row['sphericity']:.3f}", angle, surface]
    elongation, roundness = found["response_surface_terms.json"]["effects"]
    most, least = (-each for each in roundness["interval_deg"])
    low, high = elongation["interval_deg"]
    falls, rises = -roundness["change_over_range_deg"], elongation["change_over_range_deg"]
    assert f"falls by {falls:.1f} degrees ({least:.1f} to {most:.1f})" in one_line(REPOSE)
    assert f"rises by {rises:.1f} ({low:.1f} to {high:.1f})" in one_line(REPOSE)


def test_that_the_table_of_spheres_has_the_results_of_its_benchmark() -> None:
    found = results("clumps.json")
    counts = (8, 12, 20, 50)
    rows = rows_of(EXPORTERS, "| shape | 8 spheres | 12 | 20 | up to 50 |")
    assert len(rows) == 7
    for name, *cells in rows:
        family, *numbers = re.findall(r"[a-z]+|\d", name)
        shapes = [f"{family}-{number}" for number in numbers]
        for count, cell in zip(counts, cells, strict=True):
            measured = [row for row in found if row["shape"] in shapes and row["asked"] == count]
            said = [float(text) for text in re.findall(r"\.\d{3}\b", cell)]
            assert said == pytest.approx([row["jaccard"] for row in measured], abs=6e-4)
            percent = re.findall(r"([\d.]+) %", cell)
            worst = max(row["inertia"] for row in measured)
            if percent:
                assert 100 * worst == pytest.approx(float(percent[0]), abs=0.06)
            else:
                assert worst < 1e-3
    assert np.abs([row["volume"] for row in found]).max() < 1e-4
    twenty = [row for row in found if row["asked"] == 20]
    assert min(row["area"] for row in twenty) > -0.045
    assert all(row["jaccard"] < row["mss"] for row in twenty)
    low, high = (f"{bound(row['mss'] for row in twenty):.3f}".lstrip("0") for bound in (min, max))
    assert f"has {low} to {high} with 20 spheres" in one_line(EXPORTERS)


INTERVALS = json.loads((ROOT / "benchmarks/results/repose_intervals.json").read_text("utf-8"))


def test_that_the_table_of_intervals_has_the_results_of_its_benchmark() -> None:
    said = rows_of(REPOSE, "| heaps | grains | bias | spread | half width | covered, % | refused |")
    assert said == [[cell.strip() for cell in row.strip("|").split("|")] for row in INTERVALS["rows"]]
    first, heaps = INTERVALS["first_seed"], INTERVALS["heaps"]
    assert f"seeds from {first:,} on, {len(ANGLES) * heaps} heaps a row" in one_line(REPOSE)


def test_that_intervals_hold_the_angle_of_straight_flanks_as_often_as_the_guide_says() -> None:
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in INTERVALS["rows"]]
    kinds = [row for row in rows if row[0] != "all" and not row[0].startswith("hyperbolic")]
    covered = [int(row[5]) for row in kinds]
    assert min(covered) >= 92
    words = one_line(REPOSE)
    assert f"covers {min(covered)} to {max(covered)} %" in words
    flat = min(float(row[2]) for row in kinds if row[1] != "300")
    assert f"up to {-flat:.1f} degrees too flat" in words
    steep = [float(row[2]) for row in kinds if row[1] == "300"]
    assert f"is {min(steep):.1f} to {max(steep):.1f} degrees too steep" in words
    assert f"by {ROUGH_SHARE:g} of the scatter of a flank over its length" in words


def test_that_a_hyperbola_of_many_grains_is_as_much_flatter_as_the_guide_says() -> None:
    blunt = KINDS["hyperbolic tip, a = .08 R"].blunt
    flatter = [angle - flank_angle(angle, 10**6, blunt) for angle in ANGLES]
    assert f"{min(flatter):.2f} to {max(flatter):.2f} degrees flatter than its asymptotes" in one_line(REPOSE)
    assert [flank_angle(angle, 10**6, 0.0) for angle in ANGLES] == pytest.approx(ANGLES)


def test_that_the_table_of_refused_heaps_has_the_results_of_its_benchmark() -> None:
    found = json.loads((ROOT / "benchmarks/results/repose_refusals.json").read_text("utf-8"))
    refused: dict[str, list[str]] = {}
    for row in found["rows"]:
        refused.setdefault(row["heap"], []).append(str(row["refused"]))
    said = rows_of(REPOSE, "| heap, height over radius | 300 grains | 1,000 | 3,000 |")
    assert {name: counts for name, *counts in said} == refused
    assert {row["heaps"] for row in found["rows"]} == {4}
    assert f"seeds from {found['first_seed']:,} on (`python -m benchmarks.repose_refusals`)" in one_line(
        REPOSE
    )


def test_that_the_mean_of_five_fillings_has_student_s_interval() -> None:
    found = [run for run in results("repose_rapier.json") if run["engine"] == "mujoco"]
    angles = [run["angle_deg"] for run in found]
    *first, last = [f"{angle:.1f}" for angle in angles]
    mean = f"{np.mean(angles):.1f} ± {half_width(angles):.1f} in the mean"
    assert f"{', '.join(first)} and {last} degrees: {mean}" in one_line(REPOSE)


def test_that_the_table_of_larger_heaps_has_the_results_of_its_runs() -> None:
    said = rows_of(REPOSE, "| particles | processor time | clock | memory | angle | packed: cylinder, ")
    found = [run for run in results("repose_rapier.json") if run["engine"] == "rapier" and run["seed"] == 1]
    assert [run["particles"] for run in found] == [1000, 10_000, 100_000]
    for run, row in zip(found, said, strict=True):
        assert row[0] == f"{run['particles']:,}"
        assert float(row[4].partition(" ")[0]) == pytest.approx(run["angle_deg"], abs=0.051)
        low, high = run["interval_deg"]
        assert row[4].endswith(f"({low:.1f} to {high:.1f})")
        assert row[5].startswith(f"{run['solid_fraction']:.2f}, ")
        assert row[6].endswith(f"%, {100 * run['max_overlap']:.1f} %")
        assert f"{run['steps']:,}" in one_line(REPOSE)
    for run, row in zip(found[1:], said[1:], strict=True):
        assert row[1] == f"{run['processor_s']:,.0f} s"
        assert row[2] == f"{run['clock_s'] / 60:.2g} min"
    power = np.log10(found[2]["processor_s"] / found[1]["processor_s"])
    assert f"from 1,000 to 10,000 and {power:.2f} from there" in one_line(REPOSE)


def test_that_rolling_resistance_steepens_as_the_guide_says() -> None:
    found = [run for run in results("repose_rapier.json") if run["engine"] == "mujoco"]
    rolling = results("repose_rolling.json")
    assert [run["seed"] for run in rolling] == [run["seed"] for run in found]
    angles, without = ([run["angle_deg"] for run in runs] for runs in (rolling, found))
    steeper = stats.ttest_rel(angles, without).confidence_interval()
    *first, last = [f"{angle:.1f}" for angle in angles]
    difference = np.mean(angles) - np.mean(without)
    for words in (
        f"at {', '.join(first)} and {last} degrees",
        f"{difference:.1f} degrees steeper ({steeper.low:.1f} to {steeper.high:.1f}, Student, five pairs)",
    ):
        assert words in one_line(REPOSE)


@pytest.mark.slow
def test_that_a_row_of_the_table_of_intervals_is_measured_again() -> None:
    first, heaps = INTERVALS["first_seed"], INTERVALS["heaps"]
    cases = [("equal, clean", 300, angle, first + k) for angle in ANGLES for k in range(heaps)]
    assert line("equal, clean", 300, np.array([measured(case) for case in cases])) == INTERVALS["rows"][0]
