"""Angle of repose against one value: many runs, one after the other, that go on where they were stopped."""

from collections.abc import Generator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.weights import presets
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dataset.reading import dataset_hash
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.host import EngineStopped
from regolith_studio.dem.run_document import case_document
from regolith_studio.dem.run_folder import read_run
from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.building import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.coarsening import CoarseningOrder
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.repose import PARTS, ReposeOrder, simulate_repose
from regolith_studio.studies.repose import runs_from, write_repose_study

CASE_KEYS = ("shapes", "cohesion", "n_particles", "coarse_graining")
"""What of a case can be varied besides the values of Tables 1 and 2."""
SHAPE_KEYS = ("n_facets", "preset")
"""What of the shapes can be varied, each value being a dataset of its own: facets, weights of the loss."""


@dataclass(frozen=True)
class StudyRow:
    """One value of what a study varies.

    Parameters
    ----------
    varied, value
        What, and to what.
    dataset
        Folder of the dataset.
    order
        How to run; its seed is the first of the repeats.
    """

    varied: str
    value: float | str
    dataset: Path
    order: ReposeOrder


def study_repose(rows: Sequence[StudyRow], folder: Path, repeats: int = 1) -> Steps:
    """Run every row `repeats` times, each run in a folder of its own; returns :class:`ReposeStudy`.

    Runs that a folder holds already, finished and of the same case, are not run again: a study that was
    stopped goes on where it was. A run that fails is a row without an angle.
    """
    plan = [(row, row.order.case.seed + k) for row in rows for k in range(repeats)]
    yield Started("Angle of repose: study", PARTS * len(plan))
    done: list[tuple[str, float | str, str, dict[str, Any]]] = []
    for number, (row, seed) in enumerate(plan):
        order = replace(row.order, case=replace(row.order.case, seed=seed), overwrite=True)
        place = folder / f"{row.varied}_{row.value}_seed{seed}".replace("/", "-").replace(" ", "-")
        document = _earlier(place, row.dataset, order)
        if document is None:
            document = yield from _study_run(row, order, place, number, len(plan))
        done.append((row.varied, row.value, place.name, document))
        yield Progress(PARTS * (number + 1), PARTS * len(plan), place.name)
        yield Partial(runs_from(done))
    return runs_from(done)


def _study_run(
    row: StudyRow, order: ReposeOrder, place: Path, number: int, total: int
) -> Generator[Step, None, dict[str, Any]]:
    steps = simulate_repose(row.dataset, place, order)
    try:
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                return dict(end.value.document)
            if isinstance(step, Progress):
                message = f"{row.varied} {row.value}: {step.message}"
                yield Progress(PARTS * number + step.done, PARTS * total, message)
    except EngineStopped:
        return dict(read_run(place).document)
    finally:
        steps.close()


def _earlier(place: Path, dataset: Path, order: ReposeOrder) -> dict[str, Any] | None:
    """The document of a finished run of the same case on the same dataset, if there is one."""
    try:
        document = read_run(place).document
    except FileError:
        return None
    engine = engine_named(order.engine)
    settings = asdict(engine.Settings() if order.settings is None else order.settings)
    same = (
        document["state"] == "finished"
        and document["dataset"]["sha256"] == dataset_hash(dataset)
        and document["case"] == case_document(order.case)
        and document["engine"]["key"] == engine.key
        and document["engine"]["settings"] == settings
        and document["measurement"].get("settings", asdict(order.evaluation)) == asdict(order.evaluation)
    )
    return document if same else None


def with_value(order: ReposeOrder, key: str, value: Any) -> ReposeOrder:
    """The same order with one value of Table 1, Table 2 or the case changed.

    Raises
    ------
    InputError
        If there is no such value, or it cannot be this.
    """
    case = order.case
    if key in CASE_KEYS:
        return replace(order, case=replace(case, **{key: value}))
    for part, kind in (("contact", ContactParameters), ("test", LiftingCylinderTest)):
        if key in {each.name for each in fields(kind)}:
            changed = replace(getattr(case, part), **{key: _number(key, value)})
            return replace(order, case=replace(case, **{part: changed}))
    known = [each.name for kind in (ContactParameters, LiftingCylinderTest) for each in fields(kind)]
    raise InputError(f"{key!r} cannot be varied; these can: {', '.join([*known, *CASE_KEYS])}.")


def _number(key: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"The value of {key} must be a number, got {value!r}.") from error


@dataclass(frozen=True, eq=False)
class StudyWish:
    """What is varied, and how; picklable.

    Parameters
    ----------
    key, values
        Of Table 1, Table 2, the case, or :data:`SHAPE_KEYS`.
    order
        Of every run, but for the value.
    dataset
        Folder of the dataset; not needed where the shapes are varied.
    repeats
        Runs of each value, with seeds one after the other.
    particles, coarsening
        What datasets are made from where the shapes are varied.

    Raises
    ------
    InputError
        If a value cannot be used, or what the study needs is missing.
    """

    key: str
    values: tuple[float | str, ...]
    order: ReposeOrder
    dataset: Path | None = None
    repeats: int = 1
    particles: tuple[Particle, ...] = ()
    coarsening: CoarseningOrder | None = None

    def __post_init__(self) -> None:
        if not self.values:
            raise InputError("A study needs values: write them with commas between them.")
        if self.key in SHAPE_KEYS:
            if not self.particles or self.coarsening is None:
                raise InputError("Shapes are varied from open particles; open some, or the shipped sample.")
            for value in self.values:
                _shaped(self.coarsening, self.key, value)
            return
        if self.dataset is None:
            raise InputError("There is no dataset yet: open one, or make one first.")
        for value in self.values:
            with_value(self.order, self.key, value)


def values_in(key: str, text: str) -> tuple[float | str, ...]:
    """Values written with commas between them: names, whole numbers or numbers, as the key has them.

    Raises
    ------
    InputError
        If one is none.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    if key in ("shapes", "cohesion", "preset"):
        return tuple(dict.fromkeys(words))
    whole = key in ("n_facets", "n_particles")
    try:
        return tuple(dict.fromkeys(int(word) if whole else float(word) for word in words))
    except ValueError as error:
        kind = "whole numbers" if whole else "numbers"
        raise InputError(f"Values of this kind are {kind} with commas between them, got {text!r}.") from error


def study_wish(wish: StudyWish, folder: Path) -> Steps:
    """Do what was wished in a folder of its own, tables and figure at the end; returns ``ReposeStudy``."""
    rows: list[StudyRow] = []
    if wish.key not in SHAPE_KEYS:
        assert wish.dataset is not None
        rows = [
            StudyRow(wish.key, value, wish.dataset, with_value(wish.order, wish.key, value))
            for value in wish.values
        ]
    else:
        yield Started("Angle of repose: datasets", len(wish.values))
        for number, value in enumerate(wish.values):
            place = folder / "datasets" / f"{wish.key}-{value}"
            yield from _made(wish, number, place)
            rows.append(StudyRow(wish.key, value, place, wish.order))
    study = yield from study_repose(rows, folder, wish.repeats)
    write_repose_study(study, folder)
    return study


def _made(wish: StudyWish, number: int, place: Path) -> Steps:
    """A dataset of the open particles with one of the values; the same particles give the same bytes."""
    assert wish.coarsening is not None
    value = wish.values[number]
    order = _shaped(wish.coarsening, wish.key, value)
    preset = str(value) if wish.key == "preset" else None
    options = DatasetOptions(name=f"{wish.key} {value}", preset=preset, overwrite=True)
    for step in build_dataset_folder(wish.particles, order, place, options):
        if isinstance(step, Progress):
            yield Progress(number, len(wish.values), f"dataset of {value}: {step.message}")


def _shaped(order: CoarseningOrder, key: str, value: float | str) -> CoarseningOrder:
    """The order with other facets or weights."""
    if key == "preset":
        known = presets()
        if value not in known:
            raise InputError(f"There is no preset {value!r}; there are {', '.join(known)}.")
        return replace(order, weights=known[str(value)].weights)
    if not isinstance(value, int) or not 4 <= value <= 1000:
        raise InputError(f"A particle has between 4 and 1,000 facets, got {value}.")
    return replace(order, n_facets=value, largest_error=None)
