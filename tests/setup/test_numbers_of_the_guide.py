"""Tables of the guide against the result files of the benchmarks."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.imaging.extraction import CLOSED_GAP, WIDE_NECK, WIDE_NECK_OF_SMALL
from regolith_studio.imaging.segmentation.morphology import CleaningSettings
from regolith_studio.imaging.segmentation.splitting import SplittingSettings, TileSettings

ROOT = Path(__file__).parents[2]
PAGES = {
    "shape_models": ("shape_model.md", "shape_model_quality.md"),
    "segmentation": ("segmentation.md", "grain_surfaces.md"),
    "harmonics": ("harmonics.md", "harmonics_quality.md"),
    "dataset": ("dataset.md",),
    "calibration": ("calibration.md",),
}
"""Pages that hold the tables of a result file."""
RESULTS: dict[str, dict[str, Any]] = {
    name: json.loads((ROOT / f"benchmarks/results/{name}.json").read_text("utf-8")) for name in PAGES
}
BEFORE = "area of contours, volume of thresholds"
"""Of masks that nothing has been done to; told in sentences, as are the ``particles`` of the datasets."""
TABLES = [
    (file, name) for file, tables in RESULTS.items() for name in tables if name not in ("particles", BEFORE)
]
POPULATIONS = ("cement", "ma165")
KEYS = ("r_eq", "A", "AR", "S", "V/CH")


def cells_of(line: str, marks: str = " `*") -> list[str]:
    """Cells of a row, without marks at their ends."""
    return [cell.strip(marks) for cell in line.strip("| ").split("|")]


def tables_of(file: str) -> dict[str, dict[str, list[float]]]:
    """Numbers by the first cell of each row, by the first cell of the table's header."""
    found: dict[str, dict[str, list[float]]] = {}
    for page in PAGES[file]:
        text = (ROOT / "docs" / page).read_text("utf-8")
        for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
            lines = [cells_of(line) for line in block.splitlines()]
            if lines[0][0] in RESULTS[file]:
                found[lines[0][0]] = {row[0]: [float(cell) for cell in row[1:] if cell] for row in lines[2:]}
    return found


@pytest.mark.parametrize(("file", "name"), TABLES)
def test_that_a_table_of_the_guide_has_the_results_of_its_benchmark(file: str, name: str) -> None:
    measured, said = RESULTS[file][name]["rows"], tables_of(file)[name]
    assert set(said) == set(measured)
    for row, numbers in said.items():
        decimals = 1 if file == "segmentation" and name in ("denoising", "h", "surface") else 9
        assert numbers == pytest.approx(measured[row], abs=0.51 * 10.0**-decimals)


@pytest.mark.parametrize("name", POPULATIONS)
def test_that_models_with_all_degrees_lie_within_twice_the_distance_of_halves(name: str) -> None:
    rows = RESULTS["shape_models"][name]["rows"]
    for model in ("recombined", "hull_field", "sample_matched"):
        pairs = zip(rows[model], rows["floor"], strict=False)
        far = [key for key, (found, floor) in zip(KEYS, pairs, strict=False) if found > 2 * floor]
        assert far == [], model


def test_that_the_sentence_on_the_model_of_the_paper_has_the_results_of_its_benchmark() -> None:
    rows = RESULTS["shape_models"]["cement cut at l = 10"]["rows"]
    ratios = [rows["gaussian_field"][2] / rows[key][2] for key in ("recombined", "sample_matched")]
    assert ratios == pytest.approx([3.7, 3.7], abs=0.05)
    assert "about 3.7 times nearer" in (ROOT / "docs/shape_model_quality.md").read_text("utf-8")


def test_that_only_draws_within_the_noise_are_set_in_bold() -> None:
    text = (ROOT / "docs/shape_model_quality.md").read_text("utf-8")
    for name in (*POPULATIONS, "cement cut at l = 10"):
        rows = RESULTS["shape_models"][name]["rows"]
        table = text.partition(f"| {name} | r_eq")[2].partition("\n\n")[0]
        for line in table.splitlines()[2:]:
            cells = cells_of(line, " ")
            if cells[0].startswith("`"):
                limits = rows["floor, 95th percentile"]
                within = [a <= b for a, b in zip(rows[cells[0].strip("`")], limits, strict=False)]
                assert [cell.startswith("**") for cell in cells[1:6]] == within, line


def test_that_draws_of_the_default_are_new_and_within_the_noise_of_the_halves() -> None:
    """Mirror images counted as the same; 1 is the distance of measured particles from each other."""
    assert RESULTS["shape_models"]["novelty"]["rows"]["recombined"][1] >= 0.9
    for name in POPULATIONS:
        rows = RESULTS["shape_models"][name]["rows"]
        limits = rows["floor, 95th percentile"]
        pairs = zip(KEYS, rows["recombined"], limits, strict=False)
        assert [key for key, far, limit in pairs if far > limit] == [], name


def test_that_the_sentences_on_random_choices_have_the_results_of_their_benchmark() -> None:
    rows = RESULTS["dataset"]["particles"]["rows"]
    words = " ".join((ROOT / "docs/dataset.md").read_text("utf-8").split())
    said, found = ("{:.2f}, {:.2f} and {:.2f}".format(*part) for part in (rows["150"][:3], rows["150"][3:]))
    assert f"it says {said} in AR, S and Dmin, and those 150 are {found} from all the others" in words
    assert (
        "Ten random particles with equal weights give {:.2f} in AR and {:.2f} in S".format(*rows["10"][3:5])
        in words
    )


def test_that_the_paper_s_shares_by_mass_are_those_by_number_times_the_cube_of_size() -> None:
    sizes = np.array([25.0, 37.0, 56.0, 84.0, 125.0])
    masses = np.array([85.5, 12.6, 1.7, 0.23, 0.03]) * sizes**3
    *first, last = [f"{share:.2g}" for share in 100 * masses / masses.sum()]
    words = " ".join((ROOT / "docs/dataset.md").read_text("utf-8").split())
    assert f"are {', '.join(first)} and {last} % by mass" in words


def test_that_the_card_of_a_sample_is_within_two_floors_of_other_particles() -> None:
    rows = RESULTS["shape_models"]["draws of a card"]["rows"]
    pairs = zip(rows["particles of the card"], rows["hull field"], strict=True)
    assert [key for key, (floor, found) in zip(KEYS, pairs, strict=True) if found > 2 * floor] == []


def test_that_the_volume_of_touching_grains_is_within_a_percent() -> None:
    rows = RESULTS["segmentation"]["contacts"]["rows"]
    assert set(rows) == {"0", "1", "6", "12"}
    assert max(abs(row[0]) for row in rows.values()) <= 1.0


def test_that_the_sentences_on_masks_as_they_are_have_the_results_of_their_benchmark() -> None:
    areas, volumes = np.transpose(list(RESULTS["segmentation"][BEFORE]["rows"].values()))
    words = " ".join((ROOT / "docs/grain_surfaces.md").read_text("utf-8").split())
    area, volume = (
        f"{np.floor(abs(each).min()):.0f} to {np.ceil(abs(each).max()):.0f} %" for each in (areas, volumes)
    )
    assert areas.min() > 0.0 > volumes.max()
    assert f"overstates the surface area by {area}" in words
    assert f"lacks {volume} of the volume" in words


def test_that_no_pieces_of_cut_grains_are_kept_and_few_whole_ones_are_lost() -> None:
    tables = RESULTS["segmentation"]
    assert not any(pieces for *_, pieces in tables["h"]["rows"].values())
    whole, lost = np.sum(list(tables["spread of ln d"]["rows"].values()), axis=0)
    assert lost / whole < 0.01


def test_that_the_page_on_scans_has_the_defaults_of_the_code() -> None:
    words = " ".join((ROOT / "docs/segmentation.md").read_text("utf-8").split())
    splitting = SplittingSettings()
    for sentence in (
        f"h is {splitting.h_maxima:g} voxels, or {100 * splitting.relative:g} % of the peak's height",
        f"Bodies of fewer than {CleaningSettings().min_voxels} voxels are dropped",
        f"more than {TileSettings().largest / 2**20:.0f} million voxels are worked on in tiles",
        f"more than {WIDE_NECK} of the smaller label's",
        f"that of w above {CLOSED_GAP} voxels",
        f"if its diameter is more than {WIDE_NECK_OF_SMALL}.",
    ):
        assert sentence in words


def test_that_unequal_voxels_stretch_round_grains_by_at_most_a_percent_and_edged_ones_as_told() -> None:
    rows = RESULTS["segmentation"]["voxels of"]["rows"]
    extents = {name: row[1:4] for name, row in rows.items()}
    assert max(abs(each) for name, row in extents.items() if "ellipsoids" in name for each in row) <= 1.0
    smallest = min(each for row in extents.values() for each in row)
    assert f"up to {-smallest:.1f} % too small" in (ROOT / "docs/grain_surfaces.md").read_text("utf-8")
    assert max(abs(row[0]) for row in rows.values()) <= 0.2


def test_that_errors_of_the_study_of_l_max_do_not_depend_on_the_level_of_its_meshes() -> None:
    for study_s, fine_s, study_c, fine_c in RESULTS["harmonics"]["l_max"]["rows"].values():
        assert study_s == pytest.approx(fine_s, rel=0.02)
        assert study_c == pytest.approx(fine_c, rel=0.02)


def test_that_published_volumes_and_areas_are_met_at_the_published_degree() -> None:
    rows = RESULTS["harmonics"]["tables cut"]["rows"]
    assert max(rows["at the published degree"]) <= 0.5
    assert max(rows["at all degrees"]) > 1.0
