"""``describe`` against closed forms, and on input that is wrong."""

import math
import shutil
from pathlib import Path

import pytest
import trimesh

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.readers.particles import read_mesh


def test_that_an_ellipsoid_is_measured_in_micrometres(command, grains: Path) -> None:
    result = command("describe", grains / "grain-a.stl", "--json")
    assert result.code == 0
    assert result.err == ""
    (entry,) = result.json
    assert entry["name"] == "grain-a"
    assert entry["unit"] == "um"
    assert entry["volume"] == pytest.approx(4 / 3 * math.pi * 30 * 20 * 15, rel=0.02)
    assert entry["min_diameter"] == pytest.approx(30, rel=0.01)
    assert entry["max_diameter"] == pytest.approx(60, rel=0.01)
    assert entry["health"]["sound"] is True
    assert set(CATALOGUE) & set(entry) >= {"sphericity", "aspect_ratio", "convex_hull_volume"}


def test_that_the_unit_scales_lengths(command, grains: Path) -> None:
    (micro,) = command("describe", grains / "grain-b.stl", "--json").json
    (milli,) = command("describe", grains / "grain-b.stl", "--json", "--unit", "mm").json
    assert milli["max_diameter"] == pytest.approx(1e3 * micro["max_diameter"])
    assert milli["sphericity"] == pytest.approx(micro["sphericity"])


def test_that_a_table_names_particles_and_descriptors(command, grains: Path) -> None:
    result = command("describe", grains)
    assert result.code == 0
    for word in ("grain-a", "grain-c", "D_min [um]", "V [um^3]"):
        assert word in result.out


def test_that_the_table_tells_sound_mended_and_broken_meshes_apart(command, tmp_path: Path) -> None:
    box = trimesh.creation.box((30, 20, 10))
    box.export(tmp_path / "whole.ply")
    trimesh.Trimesh(box.vertices, box.faces[:, ::-1], process=False).export(tmp_path / "inside-out.ply")
    ends = {
        line.split()[0]: line.split()[-1] for line in command("describe", tmp_path).out.splitlines() if line
    }
    assert (ends["whole"], ends["inside-out"]) == ("yes", "repaired")
    left = command("describe", tmp_path / "inside-out.ply", "--no-repair").out
    assert left.splitlines()[1].split()[-1] == "no"


def test_that_a_file_that_is_no_mesh_is_one_sentence(command, tmp_path: Path) -> None:
    path = tmp_path / "letter.stl"
    path.write_text("Dear Sir")
    result = command("describe", path)
    assert result.code == 1
    assert len(result.err.strip().splitlines()) == 1
    assert "Traceback" not in result.err


def test_that_a_bad_file_among_good_ones_is_told_and_the_others_are_measured(
    command, grains: Path, tmp_path: Path
) -> None:
    result = command("describe", grains / "grain-a.stl", tmp_path / "missing.stl", "--json")
    assert result.code == 1
    assert [entry["name"] for entry in result.json] == ["grain-a"]
    assert "missing.stl" in result.err


@pytest.mark.parametrize(
    "arguments",
    [
        ("describe",),
        ("describe", "x.stl", "--unit", "furlong"),
        ("describe", "x.stl", "--colour"),
        ("describe", "x.stl", "--statistics", "--weighting", "mass"),
        ("juggle",),
    ],
)
def test_that_bad_use_is_exit_code_2(command, arguments: tuple[str, ...]) -> None:
    result = command(*arguments)
    assert result.code == 2
    assert result.out == ""
    assert "Traceback" not in result.err


def test_that_statistics_and_a_table_are_written_where_they_are_asked_for(
    command, grains: Path, tmp_path: Path
) -> None:
    plain = command("describe", grains, "--json").json
    result = command("describe", grains, "--json", "--statistics", "--csv", tmp_path / "t.csv")
    assert result.json["particles"] == plain
    rows = {row["descriptor"]: row for row in result.json["statistics"]}
    volumes = [entry["volume"] for entry in plain]
    assert rows["volume [um^3]"]["mean"] == pytest.approx(sum(volumes) / 3)
    assert rows["volume [um^3]"]["count"] == 3
    heavy = command("describe", grains, "--json", "--statistics", "--weighting", "volume").json["statistics"]
    square = sum(volume**2 for volume in volumes) / sum(volumes)
    assert next(row for row in heavy if row["descriptor"] == "volume [um^3]")["mean"] == pytest.approx(square)
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert len(lines) == 4
    assert lines[0].startswith("name,group,volume [um^3],equivalent_radius [um],surface_area [um^2]")
    cells = dict(zip(lines[0].split(","), lines[1].split(","), strict=True))
    assert (float(cells["hidden_surface_share"]), cells["repairs"]) == (0.0, "")


def test_that_tables_are_cut_at_a_degree_and_meshes_alone_are_refused_one(
    command, grains: Path, tmp_path: Path
) -> None:
    rows = {(0, 0): 10.0, (2, 0): 1.5, (2, -2): 0.6, (2, 2): 0.6, (4, 0): 1.0}
    orders = [(n, m) for n in range(5) for m in range(-n, n + 1)]
    text = "\n".join(f"{n} {m} {rows.get((n, m), 0.0)} 0" for n, m in orders)
    (tmp_path / "grain.anm").write_text(text)
    areas = []
    for options, degree in (((), None), (("--l-max", "2"), 2)):
        (entry,) = command("describe", tmp_path / "grain.anm", "--json", *options).json
        assert entry["source"]["l_max"] == degree
        expected = read_mesh(tmp_path / "grain.anm", l_max=degree).mesh.surface_area
        assert entry["surface_area"] == pytest.approx(expected, rel=1e-9)
        areas.append(expected)
    assert areas[1] < 0.98 * areas[0]
    refused = command("describe", grains, "--l-max", "10")
    assert refused.code == 2
    assert "--l-max is for tables of coefficients" in refused.err


def test_that_a_mesh_is_measured_as_it_is_where_repair_is_switched_off(command, tmp_path: Path) -> None:
    crumb = trimesh.creation.box((1, 2, 3), trimesh.transformations.translation_matrix((20, 0, 0)))
    trimesh.util.concatenate([trimesh.creation.box((4, 5, 6)), crumb]).export(tmp_path / "two.stl")
    (repaired,) = command("describe", tmp_path / "two.stl", "--json").json
    (as_it_is,) = command("describe", tmp_path / "two.stl", "--json", "--no-repair").json
    assert repaired["volume"] == pytest.approx(4 * 5 * 6)
    assert as_it_is["volume"] == pytest.approx(4 * 5 * 6 + 1 * 2 * 3)
    assert as_it_is["notes"] == ["It consists of 2 separate bodies."]
    assert (repaired["health"]["sound"], as_it_is["health"]["sound"]) == (True, False)
    assert (repaired["source"]["repaired"], as_it_is["source"]["repaired"]) == (True, False)


def test_that_a_mesh_inside_out_is_told_and_not_measured_where_repair_is_switched_off(
    command, tmp_path: Path
) -> None:
    box = trimesh.creation.box((4, 5, 6))
    box.invert()
    box.export(tmp_path / "inverted.stl")
    result = command("describe", tmp_path / "inverted.stl", "--no-repair")
    assert result.code == 1
    assert "inverted: The mesh is inside out: its signed volume is -120" in result.err


def test_that_json_tells_the_mesh_as_it_came_what_was_done_and_what_is_hidden(
    command, tmp_path: Path
) -> None:
    """A cube of 2 that lacks one face of 4 um^2, inside out, with a second cube of 1 beside it."""
    large = trimesh.creation.box((2, 2, 2))
    large.update_faces([face not in (0, 1) for face in range(12)])
    square = abs(large.area - 20) < 1e-9
    large.invert()
    small = trimesh.creation.box((1, 1, 1), transform=trimesh.transformations.translation_matrix((9, 0, 0)))
    path = tmp_path / "ugly.stl"
    path.write_bytes(trimesh.util.concatenate([large, small]).export(file_type="stl"))
    (entry,) = command("describe", path, "--json").json
    before, after, done = (entry[key] for key in ("health_before_repair", "health", "repair"))
    assert square
    assert (before["bodies"], before["watertight"], before["volume_sign"]) == (2, False, -1)
    assert (after["bodies"], after["watertight"], after["volume_sign"]) == (1, True, 1)
    for report in (before, after):
        assert {"consistent_winding", "euler_number", "self_intersections", "degenerate_faces"} <= set(report)
    assert after["volume"] == pytest.approx(8.0)
    assert after["hidden_surface_share"] == after["unrepresentable_volume_share"] == 0.0
    assert done["filled_area"] == pytest.approx(4.0)
    assert done["filled_share"] == pytest.approx(1 / 6)
    assert (done["filled_holes"], done["dropped_bodies"]) == (1, 1)
    assert any("pointed inwards" in action for action in done["actions"])
    (left,) = command("describe", path, "--json", "--no-repair").json
    assert left["repair"] is None
    assert left["health"]["hidden_surface_share"] is None
    assert left["health"]["volume"] == left["health_before_repair"]["volume"]


def test_that_a_broken_mesh_in_a_folder_counts_as_one_that_is_named(
    command, grains: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "grains"
    shutil.copytree(grains, folder)
    (folder / "letter.stl").write_text("Dear Sir")
    assert command("describe", folder).code == 1
    result = command("coarsen", folder, "-o", tmp_path / "coarse", "--method", "quadric")
    assert result.code == 1
    assert "3 of 4 particles coarsened" in result.out


def test_that_files_which_reading_a_folder_left_out_are_named(command, grains: Path, tmp_path: Path) -> None:
    folder = tmp_path / "grains"
    shutil.copytree(grains, folder)
    for name in ("heap.vtk", "table.txt", "README.txt", "particles.csv", "picture.png"):
        (folder / name).write_text("something")
    result = command("describe", folder)
    assert result.code == 0
    assert "grains: left out 2 files that no reader of meshes takes: heap.vtk, table.txt." in result.err


@pytest.mark.parametrize(
    ("convention", "radius"),
    [("complex", 10.0), ("shtools-ortho", 10.0), ("shtools-4pi", 10.0 * math.sqrt(4 * math.pi))],
)
def test_that_the_convention_of_a_table_can_be_named(convention, radius, command, tmp_path: Path) -> None:
    path = tmp_path / "stone.anm"
    # Not a ball, all of whose boxes tie: the search for the least takes 5 s.
    path.write_text(
        f"0 0 {10.0 * math.sqrt(4 * math.pi):.12f} 0\n1 0 0 0\n1 1 0 0\n2 0 5 0\n2 1 0 0\n2 2 2 0\n"
    )
    refused = command("describe", path)
    assert refused.code == 1
    assert "does not show its convention" in refused.err
    assert "--convention" in refused.err
    (entry,) = command("describe", path, "--json", "--convention", convention).json
    assert entry["equivalent_radius"] == pytest.approx(radius, rel=0.03)
    assert command("describe", path, "--convention", "old").code == 2
