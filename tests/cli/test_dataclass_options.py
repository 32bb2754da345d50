"""Groups of options against commands that list theirs one by one."""

import json
from dataclasses import dataclass
from typing import Annotated

import typer
from typer.testing import CliRunner

from regolith_studio.cli.options import with_dataclass_options

Number = Annotated[int, typer.Option("--number", help="How many.")]
Unit = Annotated[str, typer.Option("--unit", help="Of lengths.")]
Names = Annotated[list[str] | None, typer.Option("--name", help="Of some.")]


@dataclass(frozen=True)
class Reading:
    unit: Unit = "um"
    names: Names = None


@dataclass(frozen=True, kw_only=True)
class Work:
    number: Number = 3
    reading: Reading


def run(command, *words: str):
    app = typer.Typer(rich_markup_mode=None)
    app.command()(command)
    return CliRunner().invoke(app, list(words))


@with_dataclass_options
def measure(*, file: str, work: Work, loud: bool = False) -> None:
    """Measure a file."""
    reading = work.reading
    typer.echo(json.dumps([file, work.number, reading.unit, reading.names, loud]))


def test_that_a_group_takes_its_defaults():
    assert json.loads(run(measure, "a.stl").output) == ["a.stl", 3, "um", None, False]


def test_that_options_reach_groups_within_groups():
    done = run(measure, "--unit", "mm", "--number", "7", "--name", "a", "--name", "b", "--loud", "a.stl")
    assert json.loads(done.output) == ["a.stl", 7, "mm", ["a", "b"], True]


def test_that_the_help_is_that_of_a_command_with_the_options_one_by_one():
    def one_by_one(
        file: str, number: Number = 3, unit: Unit = "um", names: Names = None, loud: bool = False
    ) -> None:
        """Measure a file."""

    one_by_one.__name__ = measure.__name__
    assert run(measure, "--help").output == run(one_by_one, "--help").output


def test_that_an_option_of_a_group_without_a_default_is_required():
    @dataclass(frozen=True)
    class Sizes:
        number: Number

    @with_dataclass_options
    def draw(*, sizes: Sizes) -> None:
        typer.echo(sizes.number)

    assert run(draw, "--number", "4").output == "4\n"
    assert run(draw).exit_code == 2


def test_that_a_wrong_value_of_a_group_is_bad_use():
    done = run(measure, "--number", "many", "a.stl")
    assert done.exit_code == 2
    assert "--number" in done.output
