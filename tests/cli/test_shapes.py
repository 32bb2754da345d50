"""``fit``, ``coarsen``, ``extract`` and ``study``: what they write, and that a stranger can read it."""

import base64
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from regolith_studio.coarsening.weights import presets
from regolith_studio.geometry.sphere_points import icosphere


def test_that_a_fit_holds_the_mean_radius_of_a_ball(command, tmp_path: Path) -> None:
    ball = trimesh.Trimesh(icosphere(3).vertices * 25.0, icosphere(3).faces, process=False)
    ball.export(tmp_path / "ball.stl")
    result = command("fit", tmp_path / "ball.stl", "-o", tmp_path / "fit", "--l-max", 6)
    assert result.code == 0
    document = json.loads((tmp_path / "fit.json").read_text())
    entry = document["arrays"]["coefficients"]
    coefficients = np.frombuffer(base64.b64decode(entry["base64"]), "<f8").reshape(entry["shape"])
    assert coefficients.shape == (1, 49)
    assert coefficients[0, 0] / np.sqrt(4 * np.pi) == pytest.approx(25.0, rel=4e-3)
    assert document["particles"][0]["mean_radius"] == pytest.approx(25.0, rel=4e-3)
    assert document["particles"][0]["deviation_by_scale"].keys() == {"form", "roundness", "roughness"}
    assert document["particles"][0]["deviation_by_scale"]["form"] < 1e-3
    assert len(document["spectrum"]["values"]) == 7
    assert "orthonormal" in document["convention"]


def test_that_the_help_of_coarsen_names_every_preset(command) -> None:
    text = " ".join(command("coarsen", "--help").out.split())
    named = text.partition("Preset of the loss weights (Eq. 9): ")[2].partition(".")[0]
    assert named.replace(" or ", ", ").split(", ") == list(presets())


def test_that_the_surface_of_a_fit_is_a_solid_with_the_volume_of_its_particle(
    command, grains: Path, tmp_path: Path
) -> None:
    wanted = ("--surfaces", tmp_path / "surfaces", "--reference", "ellipsoid", "--l-max", 2)
    assert command("fit", grains, "-o", tmp_path / "fit", *wanted).code == 0
    assert json.loads((tmp_path / "fit.json").read_text())["particles"][0]["reference"]
    for path in sorted(grains.glob("*.stl")):
        surface = trimesh.load_mesh(tmp_path / "surfaces" / path.name)
        assert surface.is_watertight
        assert surface.volume == pytest.approx(trimesh.load_mesh(path).volume, rel=1e-3)


def test_that_what_a_fit_cannot_have_is_bad_use(command, grains: Path, tmp_path: Path) -> None:
    result = command("fit", grains, "-o", tmp_path / "fit", "--star-point", "middle")
    assert result.code == 2
    assert "must be one of centre_of_mass, kernel_centre, least_hidden_volume, got 'middle'" in result.err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_that_a_gallery_is_a_picture_and_an_animation_of_all_degrees(
    command, grains: Path, tmp_path: Path
) -> None:
    result = command("gallery", grains / "grain-c.stl", "-o", tmp_path / "g", "--degrees", "0,2,4", "--json")
    assert result.code == 0, result.err
    assert result.json["files"] == ["grain-c_degrees.png", "grain-c_degrees.gif"]
    with Image.open(tmp_path / "g" / "grain-c_degrees.gif") as animation:
        assert animation.n_frames == 5


def test_that_coarsening_writes_convex_bodies_that_another_program_reads(
    command, grains: Path, tmp_path: Path
) -> None:
    result = command("coarsen", grains, "-o", tmp_path / "c", "--facets", 16, "--method", "quadric", "--json")
    assert result.code == 0
    document = json.loads((tmp_path / "c" / "coarsening.json").read_text())
    assert result.json == document
    for entry in document["particles"]:
        body = trimesh.load_mesh(tmp_path / "c" / entry["file"])
        assert body.is_watertight
        assert len(body.faces) == entry["n_triangles"]
        assert body.volume == pytest.approx(entry["achieved"]["volume"], rel=1e-4)
        assert body.convex_hull.volume == pytest.approx(body.volume, rel=1e-4)
        assert entry["n_facets"] == entry["n_facets_asked"] == 16


@pytest.mark.slow
def test_that_the_number_of_processes_changes_no_byte(command, grains: Path, tmp_path: Path) -> None:
    common = ("coarsen", grains, "--facets", 12, "--seed", 3, "--l-max", 4)
    assert command(*common, "-o", tmp_path / "one", "--jobs", 1).code == 0
    assert command(*common, "-o", tmp_path / "two", "--jobs", 2).code == 0
    names = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "two").iterdir())
    for name in set(names) - {"times.json", "coarsen.sha256"}:  # the list holds the hash of the times
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


@pytest.mark.parametrize(
    "options",
    [
        ("--facets", 30, "--triangles", 100),
        ("--triangles", 100, "--max-error", 1),
        ("--vertices", 30, "--triangles", 100),
        ("--keep", "beauty"),
        ("--keep", "jaccard_distance"),
        ("--keep", "volume", "--method", "annealing"),
        ("--keep", "volume", "--method", "quadric"),
        ("--method", "magic"),
        ("--preset", "favourites"),
        ("--weight", "volume"),
        ("--weight", "volume=much"),
        ("--weight", "beauty=1"),
        ("--preset", "overlap", "--weight", "jaccard_distance=0"),
        ("--set", "colour=red"),
        ("--target", "moon"),
    ],
)
def test_that_options_that_mean_nothing_are_bad_use_and_write_nothing(
    command, grains: Path, tmp_path: Path, options: tuple[object, ...]
) -> None:
    result = command("coarsen", grains, "-o", tmp_path / "c", *options)
    assert result.code == 2
    assert not (tmp_path / "c").exists()


def test_that_a_weight_is_the_only_one_or_beside_a_preset_changes_it_and_zero_leaves_the_usual_ones(
    command, grains: Path, tmp_path: Path
) -> None:
    common = ("coarsen", grains / "grain-b.stl", "--method", "quadric", "-o", tmp_path, "--json")
    alone, beside, without = (
        command(*common, *options).json["order"]["weights"]
        for options in (
            ("--weight", "volume=2"),
            ("--preset", "all", "--weight", "volume=2"),
            ("--weight", "sphericity=0"),
        )
    )
    assert {key: value for key, value in alone.items() if value} == {"volume": 2.0}
    assert (beside["volume"], beside["sphericity"]) == (2.0, 1.0)
    assert {key for key, value in without.items() if not value} == {"sphericity"}


def test_that_only_the_terms_named_are_kept_exactly(command, grains: Path, tmp_path: Path) -> None:
    common = ("coarsen", grains / "grain-b.stl", "-o", tmp_path, "--json", "--facets", 12)
    document = command(*common, "--keep", "volume,max_diameter").json
    (entry,) = document["particles"]
    assert document["order"]["keep"] == ["max_diameter", "volume"]
    assert document["order"]["weights"]["sphericity"] == 1.0
    assert max(entry["errors"]["volume"], entry["errors"]["max_diameter"]) <= 1e-6
    nothing = command(*common, "--keep", "nothing").json["order"]
    assert nothing["keep"] == []


def test_that_a_budget_of_triangles_is_kept(command, grains: Path, tmp_path: Path) -> None:
    result = command("coarsen", grains / "grain-b.stl", "-o", tmp_path, "--triangles", 59, "--json")
    (entry,) = result.json["particles"]
    assert entry["n_facets"] == 17
    assert len(trimesh.load_mesh(tmp_path / "grain-b.stl").faces) == 56


@pytest.mark.slow
def test_that_the_fewest_facets_below_an_error_are_found(command, grains: Path, tmp_path: Path) -> None:
    common = ("coarsen", grains / "grain-c.stl", "--target", "particle", "--json")
    result = command(*common, "-o", tmp_path / "few", "--max-error", 1)
    (entry,) = result.json["particles"]
    assert result.json["order"]["largest_error"] == 0.01
    kept = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")
    assert max(entry["errors"][key] for key in kept) <= 0.01
    if entry["n_facets"] > 5:
        fewer = command(*common, "-o", tmp_path / "fewer", "--facets", entry["n_facets"] - 1)
        assert max(fewer.json["particles"][0]["errors"][key] for key in kept) > 0.01


def test_that_errors_bounds_and_reasons_are_shown(command, grains: Path, tmp_path: Path) -> None:
    result = command("coarsen", grains / "grain-b.stl", "-o", tmp_path, "--facets", 5, "--json")
    (entry,) = result.json["particles"]
    shown = command("coarsen", grains / "grain-b.stl", "-o", tmp_path, "--facets", 5)
    for word in ("facets", "vertices", "triangles", "Jaccard"):
        assert word in shown.out
    if entry["bounds"]["convex_hull_volume"] > 1e-6:
        assert f">= {100 * entry['bounds']['convex_hull_volume']:.2g}" in shown.out
    assert (entry["reason"] or "") in shown.err
    assert shown.out.splitlines()[-1] == f"1 of 1 particles coarsened in {tmp_path}"


def test_that_the_particle_itself_is_imitated_and_compared_with_where_no_target_is_named(
    command, grains: Path, tmp_path: Path
) -> None:
    """Its spherical-harmonics surface at l_max = 10 is rounder than the particle that was given."""
    told = ("coarsen", grains / "grain-b.stl", "--facets", 20, "--method", "quadric", "--json")
    (entry,) = command(*told, "-o", tmp_path / "c").json["particles"]
    (other,) = command(*told, "-o", tmp_path / "f", "--target", "fit").json["particles"]
    meshes = [trimesh.load_mesh(path) for path in (grains / "grain-b.stl", tmp_path / "c" / "grain-b.stl")]
    given, written = (np.cbrt(36 * np.pi * mesh.volume**2) / mesh.area for mesh in meshes)
    assert abs(entry["errors"]["sphericity"]) == pytest.approx(abs(written / given - 1), abs=1e-4)
    assert abs(other["errors"]["sphericity"]) != pytest.approx(abs(written / given - 1), abs=1e-4)
