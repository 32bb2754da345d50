"""The evaluation of section 3.3 against cones of known angle and against what is no heap."""

import dataclasses
import pickle
import re

import numpy as np
import pytest
from scipy import stats

from benchmarks.heaps import HeapKind, heap, surface_of_revolution
from regolith_studio.dem.angle_of_repose import (
    azimuths_of,
    measure_repose,
    measurement_document,
    rough_tilt,
    standard_interval,
)
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.evaluation.profile import Discs, base_level, connected_tops, project
from regolith_studio.dem.evaluation.section import Line, NotAPileError, fit_asymmetric, fit_symmetric
from regolith_studio.errors import InputError
from regolith_studio.studies.figures.repose import framed, section_figure
from tests.dem.packings import cone, packing


@pytest.mark.parametrize(
    "angle", [15, *(pytest.param(each, marks=pytest.mark.slow) for each in (25, 35, 45))]
)
def test_that_a_cone_of_a_thousand_grains_is_measured_within_half_a_degree(angle: int) -> None:
    found = [measure_repose(cone(angle, 1000, seed), 1.0) for seed in range(5)]
    assert abs(np.mean([each.angle for each in found]) - angle) < 0.5
    assert abs(np.mean([each.symmetric.mean for each in found]) - angle) < 0.6
    assert max(abs(each.angle - angle) for each in found) < 1.3


def test_that_the_paper_s_letter_reads_a_coarse_cone_too_flat() -> None:
    letter = EvaluationSettings(grain_correction=False, toe=0.0, azimuths=2)
    found = [measure_repose(cone(30, 1000, seed), 1.0, letter).angle for seed in range(6)]
    assert 0.3 < 30.0 - np.mean(found) < 1.5


@pytest.mark.parametrize("angle", [20, 30, 40])
@pytest.mark.slow
def test_that_a_cut_off_top_does_not_change_the_angle(angle: int) -> None:
    found = [measure_repose(cone(angle, 1500, seed, plateau=0.7), 1.0).angle for seed in range(4)]
    assert np.mean(found) == pytest.approx(angle, abs=1.0)


@pytest.mark.slow
def test_that_a_leaning_cone_has_its_two_flanks_in_the_asymmetric_model() -> None:
    sections = [measure_repose(cone(30, 2000, seed, lean=0.3), 1.0).sections[0] for seed in range(2)]
    slope = np.tan(np.radians(30.0))
    left, right = np.degrees(np.arctan(slope / 1.3)), np.degrees(np.arctan(slope / 0.7))
    assert np.mean([each.asymmetric.left.angle for each in sections]) == pytest.approx(left, abs=1.2)
    assert np.mean([each.asymmetric.right.angle for each in sections]) == pytest.approx(right, abs=1.2)


def test_that_strays_around_and_above_a_pile_do_not_count() -> None:
    pile = cone(30, 1500, 0)
    generator = np.random.default_rng(0)
    around = np.column_stack([generator.uniform(-40, 40, (80, 2)), np.full(80, 0.5)])
    above = np.column_stack([generator.uniform(-5, 5, (6, 2)), np.full(6, 30.0)])
    clean = measure_repose(pile, 1.0, base=0.0).angle
    strewn = measure_repose(np.concatenate([pile, around, above]), 1.0, base=0.0).angle
    assert strewn == pytest.approx(clean, abs=0.4)


def test_that_unit_place_and_heading_do_not_matter() -> None:
    pile = cone(30, 1200, 3)
    here = measure_repose(pile, 1.0)
    there = measure_repose(pile * 2e-3 + [1.0, -2.0, 0.7], 2e-3, base=0.7)
    quarter = np.column_stack([-pile[:, 1], pile[:, 0], pile[:, 2]])
    assert there.angle == pytest.approx(here.angle, abs=1e-6)
    assert there.height == pytest.approx(2e-3 * here.height)
    assert measure_repose(quarter, 1.0).angle == pytest.approx(here.angle, abs=0.4)


def test_that_flat_particles_do_not_lower_the_plate() -> None:
    """The centre of a brick that lies flat is a quarter of its diameter above the plate."""
    pile = cone(30, 400, 2) - [0.0, 0.0, 0.25]
    assert measure_repose(pile, 1.0).base == 0.0
    assert measure_repose(pile, 1.0).angle == measure_repose(pile, 1.0, base=0.0).angle


def _refused(points: np.ndarray) -> NotAPileError:
    with pytest.raises(NotAPileError) as refusal:
        measure_repose(points, 1.0)
    return refusal.value


def test_that_what_is_no_pile_is_refused_with_the_reason() -> None:
    generator = np.random.default_rng(0)
    plug = packing(6, 14, 0)
    plug = plug[np.hypot(plug[:, 0], plug[:, 1]) < 4.5]
    layer = np.column_stack([generator.uniform(-15, 15, (900, 2)), np.full(900, 0.5)])
    scattered = np.column_stack([generator.uniform(-40, 40, (900, 2)), generator.uniform(0.5, 9, 900)])
    half, aside = cone(30, 700, 0), np.array([12.0, 0.0, 0.0])
    two_piles = np.concatenate([half - aside, half + aside])
    assert _refused(layer).status == "layer"
    assert _refused(plug).status == "column stands"
    assert _refused(cone(66, 1000, 0)).status == "column stands"
    assert _refused(cone(30, 100, 0)).status == "too few particles"
    assert _refused(scattered).status == "scattered"
    assert _refused(two_piles).status == "scattered"
    assert _refused(packing(9, 6, 0)).status == "no flanks"
    assert str(_refused(layer)).endswith(".")


def test_that_a_refusal_survives_the_way_between_processes() -> None:
    copy = pickle.loads(pickle.dumps(NotAPileError("It is flat.", "layer")))
    assert (str(copy), copy.status) == ("It is flat.", "layer")


def test_that_bad_numbers_are_refused() -> None:
    with pytest.raises(InputError, match="shape"):
        measure_repose(np.zeros((5, 2)), 1.0)
    with pytest.raises(InputError, match="positive"):
        measure_repose(np.zeros((5, 3)), 0.0)
    with pytest.raises(InputError, match="odd"):
        EvaluationSettings(median_window=4)
    with pytest.raises(InputError, match="even"):
        EvaluationSettings(azimuths=5)
    with pytest.raises(InputError, match="cut_top"):
        EvaluationSettings(cut_top=0.9)


def test_that_a_column_ends_at_the_first_wide_gap() -> None:
    stack = Discs(np.zeros(4), np.array([0.5, 1.6, 2.9, 5.0]), np.full(4, 0.5))
    place = np.array([0.0])
    assert connected_tops(stack, place, 1.0, gap=1.0) == pytest.approx([3.4])
    assert connected_tops(stack, place, 1.0, gap=0.2) == pytest.approx([2.1])
    assert connected_tops(stack, place, 1.0, gap=2.0) == pytest.approx([5.5])
    hanging = Discs(np.zeros(1), np.array([4.0]), np.full(1, 0.5))
    assert connected_tops(hanging, place, 1.0, gap=1.0) == pytest.approx([0.0])


def test_that_a_disc_is_read_on_its_chord() -> None:
    ball = Discs(np.zeros(1), np.array([0.5]), np.array([0.5]))
    tops = connected_tops(ball, np.array([-0.6, -0.3, 0.0, 0.3]), 0.3, gap=1.0)
    assert tops == pytest.approx([0.0, 0.9, 1.0, 0.9])


def test_that_sections_show_x_z_and_y_z() -> None:
    points = np.array([[1.0, 0.0, 0.5], [0.0, 2.0, 0.5], [0.0, 0.0, 0.5]])
    assert project(points, np.ones(3), 0.0, 0.0).u == pytest.approx([1, 0, 0])
    assert project(points, np.ones(3), 0.0, np.pi / 2).u == pytest.approx([0, 2, 0])
    assert len(project(points, np.ones(3), 0.0, 0.0, slab=1.0).u) == 2
    assert base_level(points + np.array([0.0, 0.0, 7.0]), np.ones(3)) == pytest.approx(7.0)
    assert azimuths_of(EvaluationSettings(azimuths=4)) == [0.0, 90.0, 45.0, 135.0]


def test_that_exact_roofs_are_found_exactly() -> None:
    u = np.linspace(-4.0, 6.0, 41)
    z = np.minimum(5.0 + 0.8 * (u - 0.3), 5.0 - 0.5 * (u - 0.3))
    two = fit_asymmetric(u, z, 4)
    assert two is not None
    assert two.left.slope == pytest.approx(0.8)
    assert two.right.slope == pytest.approx(-0.5)
    assert two.apex == pytest.approx((0.3, 5.0))
    assert two.r_squared == pytest.approx(1.0)
    one = fit_symmetric(u, 5.0 - 0.6 * np.abs(u - 0.77), 4)
    assert one is not None
    assert one.slope == pytest.approx(0.6)
    assert one.apex == pytest.approx((0.77, 5.0), abs=1e-5)
    assert fit_asymmetric(u[:7], z[:7], 4) is None
    assert fit_asymmetric(u, -z, 4) is None


def test_that_the_break_point_is_the_best_of_all() -> None:
    generator = np.random.default_rng(4)
    u = np.sort(generator.uniform(-5, 5, 40))
    z = 4.0 - 0.7 * np.abs(u - 0.5) + generator.normal(0, 0.2, 40)
    fit = fit_asymmetric(u, z, 4)
    assert fit is not None

    def loss(k: int) -> float:
        parts = ((u[:k], z[:k]), (u[k:], z[k:]))
        return sum(float(np.polyfit(x, y, 1, full=True)[1][0]) for x, y in parts)

    best = min(range(4, 37), key=loss)
    assert fit.break_point == pytest.approx((u[best - 1] + u[best]) / 2)
    assert fit.left.slope == pytest.approx(np.polyfit(u[:best], z[:best], 1)[0])


def test_that_the_interval_of_equal_flanks_has_no_width_and_of_noise_that_of_eight_values() -> None:
    assert standard_interval([31.0] * 24, 0.95) == 0.0
    noise = np.random.default_rng(0).normal(30.0, 2.0, 8)
    low, high = stats.ttest_1samp(noise, 0.0).confidence_interval(0.95)
    assert standard_interval(list(noise), 0.95) == pytest.approx((high - low) / 2)
    assert standard_interval(list(np.repeat(noise, 3)), 0.95) == pytest.approx((high - low) / 2)


@pytest.mark.parametrize(("n", "bias"), [(300, 2.0), (1000, 0.4)])
@pytest.mark.slow
def test_that_the_interval_holds_the_angle_of_rough_heaps_with_loose_grains(n: int, bias: float) -> None:
    """Flanks that end where the surface crosses the cuts are 2.4 and 1.0 degrees too flat here."""
    kind = HeapKind(roughness=0.3, loose=0.05)
    found = [measure_repose(*heap(angle, n, seed, kind)) for angle in (25, 35) for seed in range(6)]
    errors = np.array([each.angle for each in found]) - np.repeat([25, 35], 6)
    halves = np.array([np.ptp(each.interval) / 2 for each in found])
    assert abs(errors.mean()) < bias
    assert (np.abs(errors) <= halves).sum() >= 10


@pytest.mark.slow
def test_that_a_tip_rounded_within_a_fifth_of_the_base_does_not_count() -> None:
    found = [measure_repose(*heap(30, 3000, seed, HeapKind(tip=0.2))).angle for seed in range(4)]
    assert np.mean(found) == pytest.approx(30.0, abs=0.25)


@pytest.mark.parametrize(
    ("curve", "height", "word"),
    [("dome", 0.45, "convex"), ("dome", 0.7, "convex"), ("exponential", 1.0, "concave")],
)
def test_that_domes_and_exponential_heaps_are_refused(curve: str, height: float, word: str) -> None:
    with pytest.raises(NotAPileError, match=word.capitalize()) as refusal:
        measure_repose(*surface_of_revolution(1500, 3, 10 * height, 10.0, curve))
    assert refusal.value.status == word


def test_that_a_refused_heap_keeps_its_profiles_and_both_angles_of_its_flanks() -> None:
    with pytest.raises(NotAPileError) as refusal:
        measure_repose(*surface_of_revolution(1500, 3, 10.0, 10.0, "exponential"))
    heap = refusal.value
    assert len(heap.profiles) == len(heap.sections) == 12
    top, toe = np.mean([each.end_angles for each in heap.sections], axis=0)
    assert top > np.mean([each.flanks for each in heap.sections]) > toe
    assert f"{top:.0f} degrees at the top, {toe:.0f} degrees at the toe" in heap.sentence
    assert heap.section_at(90.0) is heap.sections[1]
    layer = _refused(np.column_stack([np.mgrid[-15:15, -15:15].reshape(2, -1).T, np.full(900, 0.5)]))
    assert (len(layer.profiles), layer.sections) == (12, ())


def test_that_a_straight_flank_has_one_angle_from_top_to_toe() -> None:
    top, toe = np.mean([each.end_angles for each in measure_repose(cone(30, 4000, 1), 1.0).sections], axis=0)
    assert (top, toe) == (pytest.approx(30.0, abs=4.0), pytest.approx(30.0, abs=4.0))


def test_that_the_document_names_both_planes_and_every_choice() -> None:
    found = measure_repose(cone(30, 1000, 0), 1.0)
    document = measurement_document(found)
    assert [each["plane"] for each in document["sections"][:3]] == ["x-z", "y-z", None]
    assert document["angle_deg"] == found.angle
    assert set(document["settings"]) == {each.name for each in dataclasses.fields(EvaluationSettings)}


@pytest.mark.slow
def test_that_sections_whose_lines_do_not_meet_at_the_tip_are_left_out_and_counted() -> None:
    """Rough heaps of 300 grains: fits that break on one flank are some 4 degrees too flat."""
    cases = [(angle, seed) for angle in (20, 30, 40) for seed in range(6)]
    found = [measure_repose(*heap(angle, 300, seed, HeapKind(roughness=0.3))) for angle, seed in cases]
    notes = [[word for word in each.warnings if "do not meet at a tip" in word] for each in found]
    assert max(map(len, notes)) == 1, "one sentence names all that are left out"
    lost = [len(re.findall(r"\d+", " ".join(words))) for words in notes]
    assert [len(each.sections) + n for each, n in zip(found, lost, strict=True)] == [12] * len(found)
    assert all(section.has_tip for each in found for section in each.sections)


def test_that_a_heap_that_is_not_round_says_that_the_paper_s_sections_differ() -> None:
    """A pyramid of 22 and 38 degrees along x, 30 and 30 along y: 30 in x-z and y-z."""
    slopes = np.tan(np.radians([22.0, 38.0, 30.0, 30.0]))
    centres = packing(26, 11, 0)
    x, y = centres[:, 0], centres[:, 1]
    surface = 10.0 - np.max([-slopes[0] * x, slopes[1] * x, -slopes[2] * y, slopes[3] * y], axis=0)
    found = measure_repose(centres[centres[:, 2] + 0.5 < surface], 1.0)
    assert found.paper_asymmetric.mean == pytest.approx(30.0, abs=1.0)
    assert any("the heap is not round" in word for word in found.warnings)
    assert not any("not round" in word for word in measure_repose(cone(30, 1000, 0), 1.0).warnings)


def test_that_a_picture_of_a_section_does_not_follow_nearly_flat_flanks_away_from_the_heap() -> None:
    section = measure_repose(cone(30, 1000, 0), 1.0).sections[0]
    reach, top = framed(section)
    flat = dataclasses.replace(section.symmetric, slope=section.symmetric.slope / 20.0)
    wide, height = framed(dataclasses.replace(section, symmetric=flat))
    half = max(abs(section.profile.u[[section.profile.first, section.profile.last]]))
    assert half < reach < 1.3 * half
    assert (wide, height) == (pytest.approx(1.3 * half), pytest.approx(top))


def test_that_the_interval_of_a_rough_heap_contains_the_tilt_of_its_surface() -> None:
    """A surface that jumps by 0.2 about lines of 30 degrees over a run of 10: 0.3 * 0.2 / 10 cos^2(30)."""
    slope = np.tan(np.radians(30.0))
    away = np.linspace(1.0, 11.0, 101)
    u = np.concatenate([-away[::-1], away])
    jumps = np.where(np.arange(len(u)) % 2, 0.2, -0.2)
    height = 12.0 * slope - slope * np.abs(u) + jumps
    section = measure_repose(cone(30, 1000, 1), 1.0).sections[0]
    profile = dataclasses.replace(section.profile, u=u, height=height)
    left, right = Line(slope, 0.0), Line(-slope, 0.0)
    lines = dataclasses.replace(section.asymmetric, left=left, right=right, break_point=0.0)
    rough = dataclasses.replace(section, profile=profile, used=np.full(len(u), True), asymmetric=lines)
    assert rough_tilt([rough]) == pytest.approx(np.degrees(0.3 * 0.2 / 10.0 * 0.75), rel=1e-3)


def test_that_the_figure_shows_the_surface_of_a_section_without_two_flanks() -> None:
    points = 1e-3 * cone(30, 1000, 1)
    diameters = np.full(len(points), 1e-3)
    found = measure_repose(points, diameters)
    found = dataclasses.replace(
        found, sections=tuple(each for each in found.sections if each.azimuth != 90.0)
    )
    whole, other = section_figure(points, diameters, found).axes
    assert other.get_title() == "y-z: no two straight flanks, so no angle"
    surface = other.lines[0].get_xydata()
    assert len(surface) > 10
    assert surface[:, 1].max() == pytest.approx(whole.lines[0].get_ydata().max(), rel=0.3)
    (left, right), (bottom, top) = other.get_xlim(), other.get_ylim()
    assert left < surface[:, 0].min() < surface[:, 0].max() < right
    assert bottom == 0.0
    assert surface[:, 1].max() < top < 2 * surface[:, 1].max()
