"""``generate`` and ``study population``: what they write, and that a stranger can read it."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from regolith_studio.cli.entry import run
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes
from tests.files import csv_rows


@pytest.fixture(scope="module")
def ellipsoids(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with 24 bumpy ellipsoids of different sizes, elongations and directions.

    The box of a smooth one takes longer than all the rest.
    """
    folder = tmp_path_factory.mktemp("ellipsoids")
    rng = np.random.default_rng(0)
    sphere = icosphere(3)
    for number in range(24):
        axes = 20 * np.exp(0.3 * rng.normal()) * np.array([1.0, *np.exp(0.2 * rng.normal(size=2))])
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        turn *= np.linalg.det(turn)
        bumps = 1 + 0.1 * np.cos(sphere.vertices @ rng.normal(size=(3, 3)) * 4).prod(axis=1)
        body = Mesh(sphere.vertices * bumps[:, None] * axes @ turn.T, sphere.faces)
        (folder / f"grain-{number:02d}.stl").write_bytes(stl_bytes(body.triangles, "test"))
    return folder


@pytest.fixture(scope="module")
def fit(ellipsoids: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fitted") / "fit"
    assert run(["fit", str(ellipsoids), "-o", str(folder), "--l-max", "8"]) == 0
    return folder


@pytest.mark.slow
def test_that_the_card_of_a_sample_is_read_back(command, fit: Path, tmp_path: Path) -> None:
    path = tmp_path / "my-soil.json"
    named = ("--label", "My soil", "--origin", "Ellipsoids of a test.")
    made = command("card", fit, "-o", path, *named, "--json")
    assert made.code == 0, made.err
    assert (made.json["name"], made.json["n_particles"]) == ("my_soil", 24)
    assert command("card", path, "--json").json == made.json
    shown = command("card", path).out
    assert shown.startswith("My soil: Ellipsoids of a test.\nDraws differ from the sample of the card by")
    assert command("generate", path, "-n", 3, "-o", tmp_path / "v").code == 0


def test_that_a_shipped_card_says_what_is_measured_and_what_assumed(command, tmp_path: Path) -> None:
    said = command("card", "itokawa").out
    assert "Measured: mean axial ratios S/I = 0.707" in said
    assert "Assumed: the sizes are those of lunar soil 10084" in said
    assert command("card", "itokawa", "-o", tmp_path / "card.json").code == 2


@pytest.mark.slow
def test_that_each_virtual_particle_is_a_closed_mesh_inside_the_range(
    command, fit: Path, tmp_path: Path
) -> None:
    result = command(
        "generate", fit, "-n", 5, "-o", tmp_path / "v", "--l-max", 4, "--size-range", 15, 25, "--json"
    )
    assert result.code == 0, result.err
    assert result.json == json.loads((tmp_path / "v" / "generation.json").read_text()) | {
        "folder": str(tmp_path / "v")
    }
    assert result.json["model"] == "recombined"
    rows = csv_rows(tmp_path / "v" / "particles.csv")
    assert [row["name"] for row in rows] == [f"virtual-00000{i}" for i in range(1, 6)]
    for row in rows:
        body = trimesh.load_mesh(tmp_path / "v" / f"{row['name']}.stl")
        assert body.is_watertight
        assert body.volume == pytest.approx(float(row["volume [um^3]"]), rel=1e-5)
        radius = float(np.cbrt(3 * body.volume / (4 * np.pi)))
        assert radius == pytest.approx(float(row["equivalent_radius [um]"]), rel=1e-5)
        assert 15 * (1 - 1e-5) <= radius <= 25 * (1 + 1e-5)
        assert row["sound"] == "true"


def test_that_a_mesh_of_the_sample_that_cannot_be_read_is_named_and_makes_the_exit_code_1(
    command, ellipsoids: Path, tmp_path: Path
) -> None:
    (tmp_path / "broken.stl").write_bytes(b"solid nothing")
    meshes = [*sorted(ellipsoids.glob("grain-0[0-3].stl")), tmp_path / "broken.stl"]
    asked = ("-n", 2, "--model", "gaussian_field", "--l-max", 2, "--level", 1)
    result = command("generate", *meshes, *asked, "-o", tmp_path / "drawn")
    assert result.code == 1
    assert "broken.stl" in result.err
    assert len(csv_rows(tmp_path / "drawn" / "particles.csv")) == 2


@pytest.mark.slow
def test_that_workers_and_repetition_do_not_change_a_byte(command, fit: Path, tmp_path: Path) -> None:
    quick = ("--model", "gaussian_field", "--l-max", 4, "--level", 2)
    for place, jobs in (("one", 1), ("two", 2)):
        result = command("generate", fit, "-n", 23, "-o", tmp_path / place, *quick, "--jobs", jobs)
        assert result.code == 0, result.err
    names = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert len([name for name in names if name.endswith(".stl")]) == 23
    for name in names:
        assert (tmp_path / "two" / name).read_bytes() == (tmp_path / "one" / name).read_bytes(), name
    command("generate", fit, "-n", 2, "-o", tmp_path / "few", *quick)
    first = "virtual-000001.stl"
    assert (tmp_path / "few" / first).read_bytes() == (tmp_path / "one" / first).read_bytes()


def test_that_coefficients_of_many_particles_go_into_one_archive(command, tmp_path: Path) -> None:
    result = command("generate", "ma165", "-n", 2000, "-o", tmp_path / "v", "--format", "npz", "--seed", 3)
    assert result.code == 0, result.err
    assert sorted(path.name for path in (tmp_path / "v").iterdir()) == [
        "generate.sha256",
        "generation.json",
        "particles.csv",
        "particles.npz",
    ]
    rows = csv_rows(tmp_path / "v" / "particles.csv")
    with np.load(tmp_path / "v" / "particles.npz") as arrays:
        assert arrays["coefficients"].shape == (2000, 121)
        assert arrays["names"].tolist() == [row["name"] for row in rows]
        radii = arrays["equivalent_radius"]
    assert radii.tolist() == pytest.approx([float(row["equivalent_radius [um]"]) for row in rows])
    document = json.loads((tmp_path / "v" / "generation.json").read_text())
    assert document["seed"] == 3
    assert "ln radius" in document["coefficients"]


def test_that_draws_are_compared_with_their_sample(command, fit: Path, tmp_path: Path) -> None:
    wanted = ("-n", 30, "--format", "npz", "--model", "gaussian_field", "--l-max", 2)
    result = command("generate", fit, "-o", tmp_path / "v", *wanted)
    assert result.code == 0, result.err
    compared = json.loads((tmp_path / "v" / "generation.json").read_text())["comparison"]
    assert (compared["measured"], compared["drawn"]) == (24, 30)
    ratios = [
        max(row["wasserstein_in_floors"], row["kolmogorov_smirnov_in_floors"]) for row in compared["rows"]
    ]
    assert ratios == sorted(ratios, reverse=True)
    lines = result.out.splitlines()
    assert compared["assessment"] in lines
    assert sum(line.startswith(("sphericity", "convexity")) for line in lines) == 4


@pytest.mark.slow
def test_that_a_saved_model_draws_the_same_particles_again(command, fit: Path, tmp_path: Path) -> None:
    wanted = ("-n", 4, "--format", "npz", "--l-max", 4)
    made = command("generate", fit, "-o", tmp_path / "a", *wanted, "--save-model", tmp_path / "m.json")
    assert made.code == 0, made.err
    assert sorted(path.name for path in tmp_path.glob("m.*")) == ["m.json"]
    assert command("generate", tmp_path / "m", "-o", tmp_path / "b", *wanted).code == 0
    assert (tmp_path / "a/particles.npz").read_bytes() == (tmp_path / "b/particles.npz").read_bytes()
    result = command("generate", tmp_path / "m", "-o", tmp_path / "c", "--model", "log_field")
    assert result.code == 1
    assert "begin with the fit of the sample" in result.err


@pytest.mark.slow
def test_that_the_parts_of_a_mixture_can_be_named(command, fit: Path, tmp_path: Path) -> None:
    wanted = ("--model", "gaussian_mixture", "--set", "n_components=2", "--format", "npz", "--l-max", 3)
    result = command("generate", fit, "-n", 40, "-o", tmp_path / "v", *wanted, "--names", "basalt, glass")
    assert result.code == 0, result.err
    groups = [row["group"] for row in csv_rows(tmp_path / "v" / "particles.csv")]
    assert set(groups) <= {"basalt", "glass"}
    document = json.loads((tmp_path / "v" / "generation.json").read_text())
    assert {part["name"]: part["drawn"] for part in document["components"]} == {
        name: groups.count(name) for name in ("basalt", "glass")
    }


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--model", "wavelets"), 2, "no model called 'wavelets'"),
        (("--set", "charm=1"), 2, "has no setting 'charm'"),
        (("--set", "turn=much", "--model", "sample_matched"), 2, "cannot be 'much'"),
        (("-n", 0), 2, "greater than or equal to 1"),
        (("--size-range", 3, 2), 2, "range of sizes"),
        (("--l-max", 40), 2, "less than or equal to 30"),
        (("--format", "obj"), 2, "must be stl or npz"),
        (("--names", "a,b", "--model", "gaussian_field", "--l-max", 3), 2, "Only a mixture"),
        (("--model", "gaussian_mixture", "--names", "a,b,c,d,e,f,g,h,i,j", "--l-max", 3), 2, "names, got 10"),
        (("--l-max", 9), 1, "expanded to l_max = 8"),
        (("--level", 99), 2, "level"),
    ],
)
def test_that_what_cannot_be_drawn_is_one_sentence(
    command, fit: Path, tmp_path: Path, arguments: tuple[object, ...], code: int, words: str
) -> None:
    result = command("generate", fit, "-o", tmp_path / "v", *arguments)
    assert result.code == code
    assert words in result.err
    assert "Traceback" not in result.err
    assert not (tmp_path / "v").exists()


@pytest.mark.parametrize(
    ("sources", "words"),
    [
        (["nothing.json"], "nothing.json cannot be opened"),
        (["no-such-material"], "no-such-material"),
        (["ma165", "cement116"], "Give one fit, card or model"),
    ],
)
def test_that_a_source_that_is_none_is_one_sentence(
    command, tmp_path: Path, sources: list[str], words: str
) -> None:
    result = command("generate", *sources, "-o", tmp_path / "v")
    assert result.code in (1, 2)
    assert words in result.err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_that_models_are_judged_on_what_they_have_not_seen(command, fit: Path, tmp_path: Path) -> None:
    wanted = ("--models", "gaussian_field,sample_matched", "--l-max", 4, "--splits", 2, "--repeats", 1)
    result = command("study", "population", fit, "-o", tmp_path / "p", *wanted, "--draws", 20, "--json")
    assert result.code == 0, result.err
    written = {path.name for path in (tmp_path / "p").iterdir()}
    assert written == {*result.json["files"], "population_study.sha256"}
    distances = csv_rows(tmp_path / "p" / "population_distances.csv")
    assert len(distances) == 2 * 2 * 5
    for row in distances:
        assert float(row["wasserstein_low [%]"]) <= float(row["wasserstein [%]"])
        assert float(row["wasserstein [%]"]) <= float(row["wasserstein_high [%]"])


@pytest.mark.parametrize(
    ("source", "arguments", "words"),
    [
        ("ma165", (), "holds no measured particles"),
        (None, ("--models", "wavelets"), "got wavelets"),
        (None, ("--descriptors", "charm"), "got charm"),
    ],
)
def test_that_a_study_that_cannot_be_made_is_one_sentence(
    command, fit: Path, tmp_path: Path, source: str | None, arguments: tuple[object, ...], words: str
) -> None:
    result = command("study", "population", source or fit, "-o", tmp_path / "p", "--l-max", 4, *arguments)
    assert result.code == 1
    assert words in result.err
    assert not (tmp_path / "p").exists()
