"""``run``: a recipe from file to results."""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
import trimesh

from regolith_studio.cli.entry import run
from regolith_studio.session.outputs.summary import Summary, summary_page
from regolith_studio.session.recipe import recipe_of
from tests.files import contents


def recipe(folder: Path, grains: Path, **entries: object) -> Path:
    path = folder / "recipe.json"
    base = {"inputs": [str(grains)], "method": "quadric", "level": 2, "l_max": 4, "n_facets": 12}
    path.write_text(json.dumps(base | entries))
    return path


def test_that_a_recipe_leaves_everything_it_asks_for(command, grains: Path, tmp_path: Path) -> None:
    given_recipe = recipe(tmp_path, grains, outputs={"fits": True})
    result = command("run", given_recipe, "-o", tmp_path / "out", "--json")
    assert result.code == 0
    files = set(result.json["files"])
    expected = {"recipe.json", "summary.html", "descriptors.csv", "descriptors.json", "fit.json"}
    assert expected <= files
    assert {"meshes/coarsening.json", "meshes/grain-a.stl", "dataset/dataset.json"} <= files
    page = (tmp_path / "out" / "summary.html").read_text()
    assert "grain-b" in page
    assert "12 facets" in page


def test_that_a_recipe_prints_what_readers_note(command, tmp_path: Path) -> None:
    """Files that were passed by, points that were left out and a choice of volumes were silent."""
    meshes, size = tmp_path / "meshes", 40.0
    meshes.mkdir()
    box = trimesh.creation.box((size, size, 2 * size))
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in [*box.vertices, (9 * size, 0.0, 0.0)])
    (meshes / "box.obj").write_text(corners + "".join(f"f {a} {b} {c}\n" for a, b, c in box.faces + 1))
    (meshes / "heap.vtk").write_text("# vtk DataFile Version 3.0\n")
    with h5py.File(tmp_path / "scan.h5", "w") as file:
        file["a"] = file["b"] = np.pad(np.ones((16, 16, 16), np.uint8), 4)
    scan = {"file": str(tmp_path / "scan.h5"), "voxel_size": 1.0, "extraction": {"surface": "mask"}}
    notes = [
        "meshes: left out 1 file that no reader of meshes takes: heap.vtk.",
        "scan.h5: The file holds 2 volumes; a was read.",
        "box: Left out 1 point that no triangle uses.",
    ]
    path = recipe(tmp_path, meshes, unit="um", volumes=[scan], outputs={"meshes": False, "dataset": False})
    for options in ((), ("--resume",)):
        result = command("run", path, "-o", tmp_path / "out", "--json", *options)
        assert result.code == 0
        assert result.err.splitlines() == result.json["notes"] == notes


def test_that_the_recipe_in_the_results_repeats_them(command, grains: Path, tmp_path: Path) -> None:
    given_recipe = recipe(tmp_path, grains, outputs={"meshes": True, "dataset": True, "summary": False})
    assert command("run", given_recipe, "-o", tmp_path / "one").code == 0
    assert command("run", tmp_path / "one" / "recipe.json", "-o", tmp_path / "two").code == 0
    for name in ("meshes/grain-a.stl", "meshes/grain-c.stl", "descriptors.json"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_that_a_bad_recipe_is_one_sentence(command, grains: Path, tmp_path: Path) -> None:
    for entries in ({"n_facets": 1}, {"lmax": 3}, {"inputs": ["nowhere.stl"]}):
        result = command("run", recipe(tmp_path, grains, **entries), "-o", tmp_path / "out")
        assert result.code == 1
        assert len(result.err.strip().splitlines()) == 1
        assert not (tmp_path / "out").exists()


def test_that_a_sentence_is_all_that_an_unknown_mistake_prints(capsys, monkeypatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("division by zero\nmore lines")

    monkeypatch.setattr("regolith_studio.cli.commands.app", broken)
    assert run(["describe"]) == 1
    assert capsys.readouterr().err == "The program made a mistake (ZeroDivisionError: division by zero).\n"


def test_that_runner_and_address_must_go_together(command, grains: Path, tmp_path: Path) -> None:
    given_recipe = recipe(tmp_path, grains)
    for options in (
        ("--runner", "hamster"),
        ("--address", "tcp://x:1"),
        ("--runner", "dask", "--address", "tls://x:1"),
    ):
        result = command("run", given_recipe, "-o", tmp_path / "out", *options)
        assert result.code == 2
        assert not (tmp_path / "out").exists()


STANDING = {
    "count": 2,
    "weighting": "volume",
    "size_importance": 0.5,
    "sizes": "classes:5,9,20",
    "name": "two",
}


@pytest.mark.slow
def test_that_representatives_and_exports_are_those_of_the_dataset_commands(
    command, grains: Path, tmp_path: Path
) -> None:
    exports = {"targets": ["yade", "rocky"], "coarse_graining_factor": 4, "n_particles": 7}
    exports |= {"settings": {"density": 2500.0}}
    whole = {"seed": 5, "level": 4, "representatives": STANDING}
    given_recipe = recipe(tmp_path, grains, **whole, exports=exports)
    assert command("run", given_recipe, "-o", tmp_path / "out").code == 0
    shape = ("--method", "quadric", "--l-max", 4, "--facets", 12, "--seed", 5)
    chosen = ("--representatives", 2, "--weighting", "volume", "--size-importance", 0.5)
    sizes = ("--sizes", "classes:5,9,20", "--name", "two")
    built = command("dataset", "build", grains, "-o", tmp_path / "ds", *shape, *chosen, *sizes)
    assert built.code == 0
    told = ("--coarse-graining", 4, "--particles", 7, "--seed", 5, "--set", "density=2500.0")
    assert (
        command("dataset", "export", tmp_path / "ds", "-o", tmp_path / "ex", "--to", "yade,rocky", *told).code
        == 0
    )
    assert contents(tmp_path / "out" / "dataset") == contents(tmp_path / "ds")
    assert contents(tmp_path / "out" / "exports") == contents(tmp_path / "ex")
    assert len(list((tmp_path / "out" / "meshes").glob("*.stl"))) > 2
    only = {"descriptors": False, "meshes": False, "summary": False}
    alone = recipe(tmp_path, grains, **whole, outputs=only)
    assert command("run", alone, "-o", tmp_path / "alone", "--jobs", 2).code == 0
    assert contents(tmp_path / "alone" / "dataset") == contents(tmp_path / "ds")


def test_that_a_wish_for_the_dataset_that_cannot_be_met_is_refused_before_the_work(
    command, grains: Path, tmp_path: Path
) -> None:
    for entries, sentence in (
        ({"representatives": {"count": 99}}, "99 representatives of 3 particles"),
        ({"representatives": {"sizes": "huge"}}, "huge"),
        ({"representatives": {"weighting": "beauty"}}, "representatives.weighting"),
        ({"exports": {"targets": ["crayon"]}}, "no format 'crayon'"),
        ({"exports": {"targets": ["yade"], "settings": {"colour": 1}}}, "no setting 'colour'"),
        ({"exports": {"targets": ["yade"]}, "outputs": {"dataset": False}}, "need the dataset"),
    ):
        result = command("run", recipe(tmp_path, grains, **entries), "-o", tmp_path / "out")
        assert result.code in (1, 2)
        assert sentence in result.err
        assert not (tmp_path / "out" / "dataset").exists()
        assert not (tmp_path / "out" / "journal").exists()


@pytest.mark.parametrize(
    ("inputs", "said"),
    [
        ({"inputs": ["sample:all"]}, ["sample:all"]),
        ({"inputs": [], "volumes": [{"file": "sample:grey"}]}, ["sample:grey"]),
        ({"inputs": ["grains"]}, []),
    ],
)
def test_that_the_summary_calls_what_ships_synthetic(inputs: dict[str, object], said: list[str]) -> None:
    page = summary_page(recipe_of(**inputs), Summary(), (), ())
    assert [each for each in said if f"Synthetic, not measured on a material: {each}." in page] == said
    assert ("ynthetic" in page) == bool(said)
