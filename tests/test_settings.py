"""A setting is one field: its check, recipe entry and command line option follow from its description."""

import inspect
from dataclasses import dataclass, fields

import pytest

from regolith_studio.cli.options import option_of, with_dataclass_options
from regolith_studio.errors import InputError
from regolith_studio.harmonics.fit_options import FitOptions
from regolith_studio.harmonics.radius_function import REFERENCES, RULES
from regolith_studio.harmonics.star_point import STAR_POINT_RULES
from regolith_studio.session.choices import Choices
from regolith_studio.session.recipe import Recipe
from regolith_studio.settings import check_settings, setting, setting_of, settings_of_kind


@dataclass(frozen=True)
class Cooking:
    degree: int = setting(3, "Degree", "How well done.", minimum=0, maximum=5)
    share: float = setting(0.5, "Share", "Of salt.", minimum=0.0)
    way: str = setting("boil", "Way", "How it is cooked.", choices={"boil": "Boil", "fry": "Fry"})

    def __post_init__(self) -> None:
        check_settings(self)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"degree": 6}, "degree must be a whole number from 0 to 5, got 6"),
        ({"degree": 2.0}, "whole number"),
        ({"degree": True}, "whole number"),
        ({"share": -0.1}, "share must be a number of at least 0.0, got -0.1"),
        ({"way": "bake"}, "way must be one of boil, fry, got 'bake'"),
    ],
)
def test_that_a_setting_out_of_its_range_is_refused_with_what_is_allowed(changes, words: str) -> None:
    with pytest.raises(InputError, match=words):
        Cooking(**changes)


def test_that_every_setting_of_the_choices_is_an_entry_of_a_recipe_with_its_help_and_range() -> None:
    entries = Recipe.model_json_schema()["properties"]
    for each in settings_of_kind(Choices):
        entry = entries[each.name]
        assert entry["description"] == each.metadata["tip"]
        assert entry["default"] == each.default
        assert entry.get("maximum") == each.metadata.get("maximum")
        assert set(entry.get("enum", ())) == set(each.metadata.get("choices", ()))


def test_that_a_command_has_an_option_for_each_setting_of_a_group() -> None:
    taken = []

    @with_dataclass_options
    def cook(*, how: Cooking) -> None:
        taken.append(how)

    options = inspect.signature(cook).parameters
    assert list(options) == [each.name for each in fields(Cooking)]
    assert "One of: boil, fry." in options["way"].annotation.__metadata__[0].help
    cook(degree=1, share=0.2, way="fry")
    assert taken == [Cooking(1, 0.2, "fry")]


def test_that_a_setting_of_another_dataclass_keeps_its_description_but_for_what_is_changed() -> None:
    @dataclass(frozen=True)
    class Dinner:
        done: int | None = setting_of(Cooking, "degree", default=None, option="--done")

        def __post_init__(self) -> None:
            check_settings(self)

    assert Dinner() == Dinner(None)
    assert fields(Dinner)[0].metadata["tip"] == "How well done."
    with pytest.raises(InputError, match="done must be a whole number from 0 to 5, got 9"):
        Dinner(9)


def test_that_a_fraction_that_is_shown_in_per_cent_is_an_option_in_per_cent() -> None:
    option = option_of(Choices, "largest_error")
    assert (option.default, option.metavar, option.max) == ("--max-error", "PERCENT", 50.0)


def test_that_a_switch_that_is_on_by_default_has_an_option_that_turns_it_off() -> None:
    assert option_of(Choices, "repair").default == "--repair/--no-repair"


def test_that_the_choices_of_the_fit_are_those_that_the_numerics_know() -> None:
    choices = {each.name: {key for key in each.metadata["choices"] if key} for each in fields(FitOptions)}
    assert choices == {
        "star_point": set(STAR_POINT_RULES),
        "rule": set(RULES),
        "reference": set(REFERENCES),
    }
