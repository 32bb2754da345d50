"""``repose measure`` as a user calls it."""

import json
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.cli.entry import run
from regolith_studio.dem.snapshot import ParticleState, particle_state_bytes
from tests.dem.packings import cone


@pytest.fixture
def pile_file(tmp_path: Path) -> Path:
    points = 2e-3 * cone(32, 1500, 1)
    n = len(points)
    pile = ParticleState(points, np.full(n, 2e-3), np.tile([1.0, 0, 0, 0], (n, 1)), np.zeros(n, dtype=int))
    path = tmp_path / "final.npz"
    path.write_bytes(particle_state_bytes(pile))
    return path


@pytest.mark.slow
def test_that_a_saved_pile_is_measured_and_drawn(
    pile_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["repose", "measure", str(pile_file), "--json", "-o", str(tmp_path / "out")]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["angle_deg"] == pytest.approx(32.0, abs=1.2)
    assert document["sections"][0]["plane"] == "x-z"
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "repose.json",
        "repose.sha256",
        "sections.png",
        "sections.svg",
    }
    assert json.loads((tmp_path / "out" / "repose.json").read_text("utf-8")) == document


def test_that_positions_of_other_programs_are_measured_and_types_and_velocities_are_no_positions(
    pile_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    points = 2.0 * cone(32, 1500, 1)
    table, bare, radii, types = (tmp_path / name for name in ("rocky.csv", "pile.xyz", "r.xyz", "types.xyz"))
    np.savetxt(table, np.column_stack([points, np.full(1500, 2.0)]), delimiter=",", header="x,y,z,diameter")
    rows = [f"{x:.6f} {y:.6f} {z:.6f}" for x, y, z in points]
    for path, row in ((bare, "A {} "), (radii, "{} 1.0"), (types, "1 {} 0 0 0")):
        path.write_text("\n".join(["1500", "Atoms. Timestep: 0", *map(row.format, rows), ""]))
    assert run(["repose", "measure", str(pile_file), "--json"]) == 0
    angle = json.loads(capsys.readouterr().out)["angle_deg"]
    for path, asked in ((bare, "--diameter"), (radii, "--columns")):
        assert run(_measure(path)) == 1
        assert asked in capsys.readouterr().err
    named = [(table, []), (radii, ["--columns", "x y z radius"])]
    for path, options in [*named, (bare, ["--diameter", "2"]), (types, ["--diameter", "2"])]:
        assert run([*_measure(path), *options]) == 0
        assert json.loads(capsys.readouterr().out)["angle_deg"] == pytest.approx(angle, abs=0.05)


def test_that_both_sections_of_the_paper_stand_beside_the_angle(
    pile_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Left, right and symmetric angle of each section, and the means of the two."""
    assert run(["repose", "measure", str(pile_file), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert run(["repose", "measure", str(pile_file)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert f"{len(document['sections'])} sections" in lines[0]
    flanks = []
    for section, line in zip(document["sections"], lines[1:3], strict=False):
        two, one = section["asymmetric"], section["symmetric"]
        assert line.split() == [
            *("section", section["plane"], "left", f"{two['left_deg']:.1f}"),
            *("right", f"{two['right_deg']:.1f}", "symmetric", f"{one['angle_deg']:.1f}"),
        ]
        flanks += [two["left_deg"], two["right_deg"]]
    assert [section["plane"] for section in document["sections"][:2]] == ["x-z", "y-z"]
    assert f"asymmetric {np.mean(flanks):.1f}" in lines[3]


def _measure(path: Path) -> list[str]:
    return ["repose", "measure", str(path), "--unit", "mm", "--json"]


def test_that_settings_reach_the_evaluation_and_bad_ones_are_bad_use(
    pile_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["repose", "measure", str(pile_file), "--set", "azimuths=2", "--set", "gap=2", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["sections"]) == 2
    for wrong in ("azimuths=3", "colour=red", "gap=wide", "cut_top=0.6"):
        assert run(["repose", "measure", str(pile_file), "--set", wrong]) == 2
    assert "Traceback" not in capsys.readouterr().err


def test_that_what_is_no_pile_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "few.npz").write_bytes(
        particle_state_bytes(
            ParticleState(
                np.zeros((5, 3)), np.ones(5), np.tile([1.0, 0, 0, 0], (5, 1)), np.zeros(5, dtype=int)
            )
        )
    )
    assert run(["repose", "measure", str(tmp_path / "few.npz")]) == 1
    assert capsys.readouterr().err.strip() == "5 particles are too few for a heap; at least 150 are needed."
    assert run(["repose", "measure", str(tmp_path / "absent.npz")]) == 1
