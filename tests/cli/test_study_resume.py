"""Studies that are stopped go on where they were, and come to the same bytes."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from regolith_studio.jobs import study_jobs
from regolith_studio.studies import coarsening, lmax, population

STUDIES: dict[str, tuple[Any, str, tuple[object, ...]]] = {
    "coarsening": (coarsening, "coarsening_errors", ("--method", "quadric", "--target", "particle")),
    "sensitivity": (
        coarsening,
        "coarsening_errors",
        ("--method", "annealing", "--set", "iterations=5", "--weight", "volume=1", "--facets", 12),
    ),
    "solids": (
        study_jobs,
        "coarsen_column",
        ("--method", "quadric", "--loss", "all", "--loss", "only_volume"),
    ),
    "lmax": (lmax, "errors_or_reason", ("--degrees", "1,4")),
}


@pytest.fixture
def broken_off(monkeypatch: pytest.MonkeyPatch) -> Callable[[str, int], list[object]]:
    """Lets a function of a study be called so many times, then ends the program; keeps what it was given."""

    def begin(study: str, calls: int) -> list[object]:
        module, name, _ = STUDIES[study]
        work, given = getattr(module, name), []

        def counted(item: Any, **options: Any) -> Any:
            if len(given) == calls:
                raise KeyboardInterrupt
            given.append(item)
            return work(item, **options)

        monkeypatch.setattr(module, name, counted)
        return given

    yield begin
    monkeypatch.undo()


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in {".csv", ".json"}}


@pytest.mark.slow
@pytest.mark.parametrize("study", STUDIES)
def test_that_a_study_that_was_stopped_goes_on_to_the_same_bytes(
    command, grains: Path, tmp_path: Path, broken_off, monkeypatch: pytest.MonkeyPatch, study: str
) -> None:
    words = ("study", study, grains, *STUDIES[study][2])
    broken_off(study, 2)
    assert command(*words, "-o", tmp_path / "out").code not in (0, 2)
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["journal"]
    monkeypatch.undo()
    left = broken_off(study, 1)
    assert command(*words, "-o", tmp_path / "out", "--resume").code == 0
    assert len(left) == 1
    monkeypatch.undo()
    assert command(*words, "-o", tmp_path / "whole").code == 0
    assert contents(tmp_path / "out") == contents(tmp_path / "whole")
    assert not (tmp_path / "out" / "journal").exists()


def test_that_other_options_and_other_inputs_are_refused(
    command, grains: Path, tmp_path: Path, broken_off, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(grains, tmp_path / "grains")
    words = ("study", "lmax", tmp_path / "grains", "-o", tmp_path / "out", "--degrees")
    broken_off("lmax", 1)
    command(*words, "1,4")
    monkeypatch.undo()
    result = command(*words, "1,5", "--resume")
    assert result.code == 1
    assert "another set of options" in result.err
    (tmp_path / "grains" / "grain-c.stl").unlink()
    result = command(*words, "1,4", "--resume")
    assert result.code == 1
    assert "another set of particles" in result.err


@pytest.mark.slow
def test_that_a_judgement_of_models_goes_on_to_the_same_bytes(
    command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert command("generate", "ma165", "-n", 24, "-o", tmp_path / "g", "--l-max", 4).code == 0
    words = ("study", "population", tmp_path / "g", "--l-max", 4, "--models", "gaussian_field")
    words += ("--splits", 1, "--repeats", 2, "--draws", 20)
    work, given = population.descriptors_of, []

    def counted(draws: Any, **options: Any) -> Any:
        if len(given) == 3:
            raise KeyboardInterrupt
        given.append(draws)
        return work(draws, **options)

    monkeypatch.setattr(population, "descriptors_of", counted)
    assert command(*words, "-o", tmp_path / "out").code not in (0, 2)
    given.clear()
    assert command(*words, "-o", tmp_path / "out", "--resume").code == 0
    monkeypatch.undo()
    assert len(given) == 1
    assert command(*words, "-o", tmp_path / "whole").code == 0
    assert contents(tmp_path / "out") == contents(tmp_path / "whole")
