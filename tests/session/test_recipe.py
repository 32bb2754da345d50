"""A recipe says the same after a round trip, and what is wrong with one is a sentence."""

import json
from pathlib import Path

import pytest

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import FileError, InputError, _shown
from regolith_studio.resources import resource
from regolith_studio.session.choices import Choices
from regolith_studio.session.recipe import (
    LARGEST,
    Outputs,
    Recipe,
    read_recipe,
    recipe_of,
    recipe_schema,
)


def written(folder: Path, text: str) -> Path:
    path = folder / "recipe.json"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    "choices",
    [
        Choices(),
        Choices(l_max=3, n_facets=12, seed=9, target="particle", unit="mm", level=2, box_metric="trimesh"),
        Choices().replaced(weights=LossWeights.of(volume=2.0, sphericity=0.1)),
        Choices(star_point="kernel_centre", rule="outermost", reference="ellipsoid"),
        Choices().replaced(method="quadric", settings=(("restore_volume", True),)),
        Choices(stop_at="error", largest_error=0.0035, n_triangles=99),
    ],
)
def test_that_choices_survive_the_recipe(tmp_path: Path, choices: Choices) -> None:
    recipe = Recipe.from_choices(choices, ["grains"], Outputs(fits=True))
    again = read_recipe(written(tmp_path, recipe.to_json()))
    assert again == recipe
    assert again.choices() == choices


def test_that_an_empty_recipe_means_the_defaults(tmp_path: Path) -> None:
    assert read_recipe(written(tmp_path, "{}")).choices() == Choices()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "not a recipe"),
        ("[1]", "not a recipe"),
        ('{"lmax": 3}', "lmax"),
        ('{"l_max": "3"}', "l_max"),
        ('{"l_max": 3.5}', "l_max"),
        ('{"inputs": []}', "inputs"),
        ('{"outputs": {"hologram": true}}', "outputs.hologram"),
        ('{"version": 3}', "version"),
        ('{"inputs": [], "volumes": []}', "inputs"),
        ('{"population": {"sources": [], "n": 3}}', "population.sources"),
        ('{"population": {"sources": ["ma165"], "n": 0}}', "population.n"),
        ('{"volumes": [{"file": "a.tif", "voxel": 2}]}', r"volumes\[0\]\.voxel is not known here"),
        (
            '{"volumes": [{"file": "a.tif", "kind": "gray"}]}',
            r"volumes\[0\]\.kind must be 'labels' or 'grey'",
        ),
        ('{"volumes": [{"file": "a.tif", "recipe": "e.json", "extraction": {"min_voxels": 9}}]}', "not both"),
        ('{"weights": {"volume": NaN}}', "not a recipe"),
    ],
)
def test_that_a_bad_recipe_is_refused_with_the_entry_named(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(FileError, match=words):
        read_recipe(written(tmp_path, text))


def test_that_volumes_and_a_population_stand_alone_unless_inputs_are_named(tmp_path: Path) -> None:
    entries = '"volumes": [{"file": "scan.tif", "voxel_size": [2, 2, 5]}]'
    assert read_recipe(written(tmp_path, f"{{{entries}}}")).inputs == []
    both = read_recipe(written(tmp_path, f'{{{entries}, "inputs": ["grains"]}}'))
    assert both.inputs == ["grains"]
    assert both.volumes[0].voxel_size == [2.0, 2.0, 5.0]
    assert read_recipe(written(tmp_path, both.to_json())) == both


def test_that_the_shipped_schema_is_that_of_recipes_and_takes_what_the_program_writes() -> None:
    schema = json.loads(resource("schema", "recipe.schema.json").read_text())
    assert schema == recipe_schema()
    jsonschema = pytest.importorskip("jsonschema")
    full = recipe_of(
        volumes=[{"file": "a.raw", "raw": {"shape": [2, 3, 4]}}], population={"sources": ["ma165"], "n": 3}
    )
    validator = jsonschema.Draft202012Validator(schema)
    for recipe in (Recipe(), full):
        assert not list(validator.iter_errors(json.loads(recipe.to_json())))
    assert list(validator.iter_errors({"l_max": "ten"}))
    assert list(validator.iter_errors({"hologram": True}))


def test_that_a_missing_recipe_is_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be opened"):
        read_recipe(tmp_path / "none.json")


def test_that_a_choice_out_of_range_is_found_when_the_recipe_is_made_or_used() -> None:
    with pytest.raises(InputError, match="l_max must be at most 30, not 99"):
        recipe_of(l_max=99)
    with pytest.raises(InputError, match="no term"):
        recipe_of(weights={"beauty": 1.0}).choices()


def test_that_a_recipe_is_plain_json_that_a_person_can_edit() -> None:
    document = json.loads(Recipe.from_choices(Choices(), ["a.stl"]).to_json())
    assert document["inputs"] == ["a.stl"]
    assert document["l_max"] == 10
    assert document["weights"] is None


class Unread:
    """Must not be looked at."""

    def __str__(self):
        raise AssertionError("read to the end")


def test_that_a_sentence_about_a_large_value_reads_its_beginning_only(tmp_path):
    """It was made of all of it, and cut at the end: 44 s for 90 MB in the window."""
    assert _shown([{"a": [1, 2, 3]}] * 50 + [Unread()]).startswith('[{"a": [1, 2, 3]}, {"a":')
    document = tmp_path / "large.json"
    document.write_text("[" + ",".join(["""{"a": [1, 2, 3]}"""] * 1_000) + "]", encoding="utf-8")
    with pytest.raises(FileError, match=r'not \[\{"a": \[1, 2, 3\]\}, \{"a": .*…'):
        read_recipe(document)
    with document.open("ab") as file:
        file.truncate(LARGEST + 1)
    with pytest.raises(FileError):
        read_recipe(document)
