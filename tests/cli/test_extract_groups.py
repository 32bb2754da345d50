"""``extract`` from several scans: a folder for each, tables of all, and a second run that goes on."""

import json
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.session.batch.scan_groups import compare_groups
from regolith_studio.session.outputs.particles import ExtractionFolder
from tests.files import contents, csv_rows

RADII = {"fine": (5, 6), "coarse": (8, 9)}


def balls(radii: tuple[int, ...], value: int = 1) -> np.ndarray:
    """Slices first: labels of balls side by side."""
    z, y, x = np.mgrid[:26, :26, : 26 * len(radii)]
    volume = np.zeros(z.shape, dtype=np.uint8)
    for number, radius in enumerate(radii):
        volume[(x - 13 - 26 * number) ** 2 + (y - 13) ** 2 + (z - 13) ** 2 <= radius**2] = value + number
    return volume


@pytest.fixture
def scans(tmp_path: Path) -> Path:
    folder = tmp_path / "scans"
    folder.mkdir()
    for name, radii in RADII.items():
        np.save(folder / f"{name}.npy", balls(radii))
    return folder


ASKED = ("--kind", "labels", "--voxel-size", 2)


def test_that_each_scan_of_a_folder_is_a_group_and_tables_hold_all(
    command, scans: Path, tmp_path: Path
) -> None:
    result = command("extract", scans, "-o", tmp_path / "all", *ASKED)
    assert result.code == 0, result.err
    assert "extracted: 2, kept from an earlier run: 0" in result.out
    alone = command("extract", scans / "fine.npy", "-o", tmp_path / "fine", *ASKED)
    assert alone.code == 0
    assert contents(tmp_path / "fine") == contents(tmp_path / "all" / "fine")
    table = csv_rows(tmp_path / "all" / "particles.csv")
    assert [row["group"] for row in table] == ["coarse", "coarse", "fine", "fine"]
    radii = [float(row["equivalent_radius [um]"]) for row in table]
    assert radii == pytest.approx([16, 18, 10, 12], rel=0.02)
    groups = {(row["descriptor"], row["group"]): row for row in csv_rows(tmp_path / "all" / "groups.csv")}
    coarse = groups["equivalent_radius", "coarse"]
    assert float(coarse["count"]) == 2
    assert float(coarse["ks_distance"]) == 1.0
    assert float(coarse["quantile_10"]) == pytest.approx(16, rel=0.02)
    assert 4.0 < float(coarse["wasserstein_1"]) < 8.0


def test_that_a_second_run_extracts_only_what_is_missing_or_has_changed(
    command, scans: Path, tmp_path: Path
) -> None:
    output = tmp_path / "all"
    call = ("extract", scans / "fine.npy", scans / "coarse.npy", "-o", output, *ASKED)
    assert "extracted: 2" in command(*call).out
    before = contents(output)
    shutil.rmtree(output / "fine")
    assert "extracted: 1, kept from an earlier run: 1" in command(*call).out
    assert contents(output) == before
    (output / "coarse" / "particle_0001.stl").unlink()
    assert "extracted: 1, kept from an earlier run: 1" in command(*call).out
    assert contents(output) == before
    np.save(scans / "fine.npy", balls(RADII["fine"], value=5))
    assert "extracted: 1, kept from an earlier run: 1" in command(*call).out
    assert "extracted: 2" in command(*call, "--min-voxels", 100).out
    assert "extracted: 0, kept from an earlier run: 2" in command(*call, "--min-voxels", 100).out


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="kills a process by a signal")
def test_that_a_run_that_was_killed_goes_on_and_leaves_nothing_behind(command, tmp_path: Path) -> None:
    folder, output = tmp_path / "scans", tmp_path / "all"
    folder.mkdir()
    np.save(folder / "a.npy", balls((5, 6)))
    np.save(folder / "b.npy", np.concatenate([balls((7,) * 12)] * 4))
    options = [str(each) for each in (folder, "-o", output, *ASKED)]
    run = subprocess.Popen([sys.executable, "-m", "regolith_studio", "extract", *options])
    hidden = lambda: [path for path in output.glob(".*") if list(path.rglob("*.stl"))]  # noqa: E731
    deadline = time.monotonic() + 120.0
    while not ((output / "a").is_dir() and hidden()) and time.monotonic() < deadline:
        time.sleep(0.02)
    run.kill()
    assert run.wait() == -signal.SIGKILL
    assert not (output / "b").exists()
    result = command("extract", *options)
    assert "extracted: 1, kept from an earlier run: 1" in result.out, result.err
    assert sorted(path.name for path in output.iterdir()) == ["a", "b", "groups.csv", "particles.csv"]
    assert len(csv_rows(output / "particles.csv")) == 2 + 12


def test_that_a_broken_scan_is_named_and_the_others_are_extracted(
    command, scans: Path, tmp_path: Path
) -> None:
    (scans / "bad.npy").write_bytes(b"\x93NUMPY nothing")
    result = command("extract", scans, "-o", tmp_path / "all", *ASKED, "--json")
    assert result.code == 1
    assert result.err.startswith("bad.npy ")
    assert len(result.err.strip().splitlines()) == 1
    assert {row["group"] for row in json.loads(result.out)["rows"]} == {"fine", "coarse"}
    assert not (tmp_path / "all" / "bad").exists()


def test_that_scans_of_one_name_are_told_apart_by_their_folders(command, scans: Path, tmp_path: Path) -> None:
    for name in RADII:
        (tmp_path / name).mkdir()
        shutil.copy(scans / f"{name}.npy", tmp_path / name / "recon.npy")
    paths = [tmp_path / name / "recon.npy" for name in RADII]
    assert command("extract", *paths, "-o", tmp_path / "all", *ASKED).code == 0
    table = csv_rows(tmp_path / "all" / "particles.csv")
    assert [row["group"] for row in table] == ["fine_recon", "fine_recon", "coarse_recon", "coarse_recon"]
    assert (tmp_path / "all" / "fine_recon" / "particle_0001.stl").is_file()


def test_that_options_of_one_volume_and_folders_of_one_are_refused(
    command, scans: Path, tmp_path: Path
) -> None:
    for option in (("--labels", tmp_path / "l.tif"), ("--preview-h", "0.8")):
        result = command("extract", scans, "-o", tmp_path / "x", *option)
        assert result.code == 2
        assert "one volume at a time" in " ".join(result.err.split())
    assert command("extract", scans / "fine.npy", "-o", tmp_path / "one", *ASKED).code == 0
    result = command("extract", scans, "-o", tmp_path / "one", *ASKED)
    assert result.code == 1
    assert "holds the particles of one scan" in result.err


def test_that_weights_count_in_the_comparison_of_groups() -> None:
    def rows(*values: tuple[float, float]) -> list[dict[str, str]]:
        return [{"sphericity": str(value), "weight": str(weight)} for value, weight in values]

    table = compare_groups({"a": rows((0.5, 1.0), (0.9, 3.0)), "b": rows((0.7, 1.0)), "c": rows((0.7, 1.0))})
    row = dict(zip((column.name for column in table.columns), table.rows[0], strict=True))
    assert row["mean"] == pytest.approx(0.8)
    assert row["quantile_10"] == 0.5
    assert row["ks_distance"] == pytest.approx(0.75)
    assert row["wasserstein_1"] == pytest.approx(0.25 * 0.2 + 0.75 * 0.2)


@pytest.mark.parametrize("step", ["extract", "finish"])
def test_that_groups_are_not_written_to_a_folder_that_was_removed(
    command, scans: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    complete = getattr(ExtractionFolder, step)

    def remove(*arguments: object, **options: object) -> object:
        shutil.rmtree(tmp_path / "all", ignore_errors=True)
        return complete(*arguments, **options)

    monkeypatch.setattr(ExtractionFolder, step, remove)
    result = command("extract", scans, "-o", tmp_path / "all", *ASKED)
    assert (result.code, result.out) == (1, "")
    assert result.err == f"The folder {tmp_path / 'all'} was removed while it was written to.\n"
    assert not (tmp_path / "all").exists()


def with_table(scans: Path, *lines: str) -> Path:
    (scans.parent / "settings.csv").write_text("\n".join((*lines, "")), encoding="utf-8")
    return scans.parent / "settings.csv"


def test_that_a_table_gives_single_scans_settings_of_their_own(command, scans: Path, tmp_path: Path) -> None:
    table = with_table(
        scans, "scan,voxel-size,Crop,exclude-border", "fine.npy,3,,", "scans/coarse.npy,,:26%,no"
    )
    table.write_text(table.read_text().replace(":26%", '":26,:,:"'))
    output = tmp_path / "all"
    call = ("extract", scans, "-o", output, *ASKED, "--settings", table)
    assert command(*call).code == 0
    radii = {row["group"]: float(row["equivalent_radius [um]"]) for row in csv_rows(output / "particles.csv")}
    assert radii == pytest.approx({"fine": 3 * 6, "coarse": 2 * 8}, rel=0.03)
    chosen = json.loads((output / "coarse" / "extraction.json").read_text())
    assert chosen["region"]["crop"] == ":26,:,:"
    assert chosen["extraction"]["exclude_border"] is False
    assert "kept from an earlier run: 2" in command(*call).out
    with_table(scans, "scan,voxel-size", "fine,3", "coarse,2.5")
    assert "extracted: 1, kept from an earlier run: 1" in command(*call).out


def test_that_a_row_may_name_the_recipe_of_a_scan_beside_the_table(
    command, scans: Path, tmp_path: Path
) -> None:
    assert command("extract", scans / "fine.npy", "-o", tmp_path / "a", *ASKED, "--min-voxels", 700).code == 0
    shutil.copy(tmp_path / "a" / "extraction.json", tmp_path / "strict.json")
    table = with_table(scans, "scan,recipe", "fine,strict.json")
    assert command("extract", scans, "-o", tmp_path / "all", *ASKED, "--settings", table).code == 0
    rows = csv_rows(tmp_path / "all" / "particles.csv")
    assert [row["group"] for row in rows] == ["coarse", "coarse", "fine"]


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        (("name,unit", "fine,um"), "it has no column “scan”"),
        (("scan,colour", "fine,red"), "“colour” is no option"),
        (("scan,jobs", "fine,2"), "“jobs” is no option"),
        (("scan,unit,unit", "fine,um,um"), "two columns “unit”"),
        (("scan,unit", "fine,um,3"), "line 2 has more cells"),
        (("scan,unit", ",um"), "line 2 names no scan"),
        (("scan,unit", "other,um"), "line 2: “other” names none of the scans"),
        (("scan,unit", "fine,um", "fine.npy,mm"), "line 3: fine.npy has a row already, line 2"),
        (("scan,h-maxima", "fine,high"), "line 2: Invalid value for '--h-maxima'"),
        (("scan,opening", "fine,11"), "line 2: Invalid value for '--opening'"),
        (("scan,dark", "fine,perhaps"), "line 2: .*“dark” is yes or no, got 'perhaps'"),
        (("scan,crop", "fine,10-20"), "line 2: .*X0:X1,Y0:Y1,Z0:Z1"),
        (("scan,threshold", "fine,much"), "line 2: .*A threshold is otsu"),
        (("scan,recipe,dark", "fine,r.json,yes"), "line 2 has a recipe, which holds all settings"),
        (("scan,recipe", "fine,none.json"), "none.json"),
        (("scan,unit", '"fine,um'), "is no table of settings"),
    ],
)
def test_that_a_wrong_table_costs_one_sentence_and_nothing_is_written(
    lines: tuple[str, ...], sentence: str, command, scans: Path, tmp_path: Path
) -> None:
    table = with_table(scans, *lines)
    result = command("extract", scans, "-o", tmp_path / "all", *ASKED, "--settings", table)
    assert result.code == 1
    assert re.search(sentence, result.err), result.err
    assert len(result.err.splitlines()) == 1
    assert "made a mistake" not in result.err
    assert not (tmp_path / "all").exists()
