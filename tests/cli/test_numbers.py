"""Every number that a command takes has a range; what lies outside is refused before anything is done."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from regolith_studio.cli.commands import app
from regolith_studio.shape_models.materials import materials
from tests.cli.conftest import Said


def commands(command: Any, words: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """All commands below one, with the words that name them."""
    if not hasattr(command, "commands"):
        yield words, command
        return
    for name, each in command.commands.items():
        yield from commands(each, (*words, name))


def is_number(option: Any) -> bool:
    return option.get_runtime_param().annotation in (int, float)


NUMBERS = [
    (words, command, option)
    for words, command in commands(typer.main.get_command(app))
    for option in command.params
    if is_number(option)
]
DISTINCT = {(option.opts[0], option.min, option.max): each for *each, option in NUMBERS}


def required(command: Any, folder: Path, but: str = "") -> Iterator[str]:
    """Arguments that a command does not run without, but for one; no file is there."""
    for each in command.params:
        if each.required and each.opts[0] != but:
            yield from (each.opts[0],) if each.param_type_name == "option" else ()
            yield "1" if is_number(each) else str(folder / "absent.stl")


def test_that_every_number_has_a_range() -> None:
    assert len(NUMBERS) > 90
    for words, _, option in NUMBERS:
        assert None not in (option.min, option.max), (words, option.opts)
        assert math.isfinite(option.max - option.min), (words, option.opts)


@pytest.mark.parametrize(("range_", "words", "sub"), [(key, *each) for key, each in DISTINCT.items()])
def test_that_a_number_out_of_range_is_bad_use(
    range_: tuple[str, float, float],
    words: tuple[str, ...],
    sub: Any,
    tmp_path: Path,
    command: Callable[..., Said],
) -> None:
    option, low, high = range_
    beyond = high + 1 if isinstance(high, int) else 1.001 * high
    for value in (*(each for each in (0, -1) if each < low), low - 1, beyond, 1e30, "nan", "inf"):
        done = command(*words, f"{option}={value}", *required(sub, tmp_path, option))
        assert done.code == 2
        assert f"'{option}'" in done.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "words", [("generate", "CARD", "--l-max", 10, "-n"), ("dataset", "sample", "D", "--json", "-n")]
)
def test_that_more_particles_than_the_memory_holds_are_refused_before_they_are_drawn(
    words: tuple[Any, ...], tmp_path: Path, command: Callable[..., Said], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("regolith_studio.io.machine_memory.machine_memory", lambda: 2 * 10**9)
    given = [min(materials()) if word == "CARD" else word for word in words]
    done = command(*given, 10_000_000, "-o", tmp_path / "out")
    assert done.code == 1
    assert "GB of memory, and this machine has 2" in done.err
    assert not list(tmp_path.iterdir())


WITHIN_TEXT = [
    ("fit", "--unit", "voxel:{}"),
    ("extract", "--voxel-size", "{}"),
    ("extract", "--voxel-size", "1,{},1"),
    ("extract", "--threshold", "multi-otsu:{}:1"),
    ("coarsen", "--weight", "volume={}"),
    ("coarsen", "--set", "retries={}"),
    ("dataset build", "--sizes", "log-normal:{},0.4"),
    ("generate", "--set", "candidates={}"),
    ("study lmax", "--degrees", "1-{}"),
    ("study facets", "--facets", "{}"),
    ("study sensitivity", "--factors", "{}"),
    ("repose run", "--test", "mass={}"),
    ("repose run", "--contact", "density={}"),
    ("repose run", "--set", "stiffness={}"),
    ("repose study", "--vary", "n_particles={}"),
    ("repose calibrate", "--parameter", "static_friction=0.1,{}"),
    ("repose measure", "--set", "azimuths={}"),
]


@pytest.mark.parametrize("number", ["-1", "1e300", "nan"])
@pytest.mark.parametrize(("words", "option", "text"), WITHIN_TEXT)
def test_that_a_number_within_a_text_is_refused_too(
    words: str, option: str, text: str, number: str, tmp_path: Path, command: Callable[..., Said]
) -> None:
    sub = dict(commands(typer.main.get_command(app)))[tuple(words.split())]
    done = command(*words.split(), *required(sub, tmp_path), f"{option}={text.format(number)}")
    assert done.code == 2, done.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("size", [("nan", "3"), ("1e300", "1e301"), ("-1", "3"), ("1", "inf")])
def test_that_a_range_of_sizes_is_checked(
    size: tuple[str, str], tmp_path: Path, command: Callable[..., Said]
) -> None:
    done = command("generate", tmp_path / "absent.stl", "-o", tmp_path / "out", "--size-range", *size)
    assert done.code == 2
