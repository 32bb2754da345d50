"""Job that calibrates contact parameters by runs of a lifting cylinder, one after the other."""

from collections import Counter
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import cast

from regolith_studio.dataset.folder_io import dataset_hash
from regolith_studio.dataset.parameters import DRUM, DrumRotation
from regolith_studio.dem.engines import check_capability, engine_named
from regolith_studio.dem.run_io import read_run
from regolith_studio.errors import FileError, InputError, RegolithError
from regolith_studio.io.atomic import JOURNAL
from regolith_studio.io.output_lock import output_lock
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.repose_jobs import PROGRESS_STEPS, ReposeRequest
from regolith_studio.jobs.repose_study import (
    CASE_KEYS,
    ReposeVariant,
    finished_run,
    simulate_study_run,
    study_place,
    with_value,
    write_with_runs,
)
from regolith_studio.messages import N_, Message
from regolith_studio.steps import as_events, result_of
from regolith_studio.studies.calibration import CalibrationParameter, WantedResult
from regolith_studio.studies.repose_calibration import (
    DATASET,
    CalibrationRun,
    ReposeCalibration,
    angle_target,
)

IN_DRUM = "_drum"
"""End of the name of the folder with the drum of a run."""
KIND = "calibration"
"""Of the folder in the journal, and of the list of files."""
MAX_PARAMETERS = 3
DEFAULT_RANGES = MappingProxyType({"static_friction": (0.05, 1.2)})


@dataclass(frozen=True, eq=False)
class ReposeCalibrationRequest:
    """What is wanted, and how it may be reached; picklable.

    - ``datasets``: folders. With several the choice of one of them is a parameter; they differ in content
      and name.
    - ``ranges``: lowest and highest value of each parameter of Table 1 or 2, in SI units.
    - ``targets``: wanted angle, and perhaps bulk density.
    - ``request``: of every run, but for the parameters; its seed is the first run's, and each run has the
      next one.
    - ``max_runs``: after which the calibration ends.
    - ``drum``: how a drum turns that is simulated for every run too, where its angle is among the targets.
    """

    datasets: tuple[Path, ...]
    ranges: Mapping[str, tuple[float, float]]
    targets: tuple[WantedResult, ...]
    request: ReposeRequest
    max_runs: int = 12
    drum: DrumRotation | None = None

    def __post_init__(self) -> None:
        if not 1 <= len(self.ranges) + (len(self.datasets) > 1) <= MAX_PARAMETERS:
            raise InputError(
                f"A calibration finds one to {MAX_PARAMETERS} parameters, got "
                f"{len(self.ranges) + (len(self.datasets) > 1)}."
            )
        names = Counter(folder.name for folder in self.datasets)
        if twice := [name for name, times in names.items() if times > 1]:
            raise InputError(f"Two datasets have the name {twice[0]}: give them different names.")
        if self.drum is not None:
            check_capability(engine_named(self.request.engine), "drum", "rotating drum")
        for name, (low, high) in self.ranges.items():
            if name in CASE_KEYS:
                raise InputError(f"{name} cannot be calibrated; a value of Table 1 or 2 can.")
            CalibrationParameter(name, low, high)
            for value in (low, high):
                with_value(self.request, name, value)


def calibration_steps(request: ReposeCalibrationRequest, folder: Path) -> Steps:
    """Run one test after the other in `folder`; returns :class:`ReposeCalibration`.

    After each run the folder holds the result so far; no other process writes to it meanwhile. Runs that are
    there already are data and are not run again, also where another angle is wanted.
    """
    total = PROGRESS_STEPS * request.max_runs
    yield Started(N_("Calibration"), total)
    datasets = _by_hash(request.datasets)
    calibration = ReposeCalibration.begin(_parameters(request), request.targets)
    yield Partial(calibration)
    with output_lock(folder):
        for number in range(request.max_runs):
            run = earlier = _earlier_run(request, datasets, folder, number)
            if run is None:
                run = yield from _next_run(request, folder, calibration)
            calibration = calibration.with_run(run)
            if earlier is None or number == request.max_runs - 1:
                write_calibration(calibration, folder)
            yield Progress(PROGRESS_STEPS * (number + 1), total, run.folder)
            yield Partial(calibration)
    return calibration


def kept_calibration(request: ReposeCalibrationRequest, folder: Path) -> Steps:
    """The result of the runs that are in `folder` already, as :class:`ReposeCalibration`."""
    yield Started(N_("Calibration"))
    datasets = _by_hash(request.datasets)
    calibration = ReposeCalibration.begin(_parameters(request), request.targets)
    for number in range(request.max_runs):
        run = _earlier_run(request, datasets, folder, number)
        if run is None:
            break
        calibration = calibration.with_run(run)
    return calibration


def calibrate_repose(
    dataset: Path | str,
    folder: Path | str,
    *,
    angle: float,
    angle_error: float = 1.0,
    ranges: Mapping[str, tuple[float, float]] = DEFAULT_RANGES,
    request: ReposeRequest | None = None,
    max_runs: int = 12,
) -> ReposeCalibration:
    """Find contact parameters that give a wanted angle of repose, by simulated tests.

    Parameters
    ----------
    dataset
        Folder of the dataset.
    folder
        For the runs and the result; runs that are there already are not run again.
    angle, angle_error
        Wanted angle and its standard error, in degrees.
    ranges, request, max_runs
        As in :class:`ReposeCalibrationRequest`; 1,000 particles on the default engine if omitted.

    Raises
    ------
    RegolithError
        If a range, the dataset or the folder cannot be used.
    """
    targets = (angle_target(angle, angle_error),)
    wanted = ReposeCalibrationRequest((Path(dataset),), ranges, targets, request or ReposeRequest(), max_runs)
    return cast("ReposeCalibration", result_of(calibration_steps(wanted, Path(folder))))


def write_calibration(calibration: ReposeCalibration, folder: Path) -> list[str]:
    """Write the result so far and the runs beside it in one step; names of the files."""
    from regolith_studio.studies.figures.repose import write_calibration_files  # matplotlib

    return write_with_runs(folder, KIND, lambda stage: write_calibration_files(calibration, stage))


def _by_hash(folders: Sequence[Path]) -> dict[str, int]:
    """Place of each dataset by the hash of its content."""
    places: dict[str, int] = {}
    for number, folder in enumerate(folders):
        earlier = places.setdefault(dataset_hash(folder), number)
        if earlier != number:
            raise InputError(
                f"{folders[earlier].name} and {folder.name} are the same dataset; give each once."
            )
    return places


def _parameters(request: ReposeCalibrationRequest) -> list[CalibrationParameter]:
    parameters = [CalibrationParameter(name, *ends) for name, ends in request.ranges.items()]
    if len(request.datasets) > 1:
        names = [folder.name for folder in request.datasets]
        parameters.append(CalibrationParameter.of_choices(DATASET, names))
    return parameters


def _variant(request: ReposeCalibrationRequest, number: int, values: Mapping[str, float]) -> ReposeVariant:
    """What the run of this number is with these values of the parameters."""
    one = replace(request.request, overwrite=True)
    for name in request.ranges:
        one = with_value(one, name, values[name])
    one = replace(one, case=replace(one.case, seed=one.case.seed + number))
    return ReposeVariant("run", number + 1, request.datasets[int(values.get(DATASET, 0))], one)


def _in_drum(request: ReposeCalibrationRequest, variant: ReposeVariant) -> ReposeVariant | None:
    """The same particles in the usual drum under the same gravity, if the calibration has one."""
    if request.drum is None:
        return None
    case = variant.request.case
    test = replace(DRUM, gravity=case.test.gravity)
    turned = replace(variant.request, case=replace(case, test=test, drum=request.drum))
    return replace(variant, request=turned)


def _earlier_run(
    request: ReposeCalibrationRequest, datasets: Mapping[str, int], folder: Path, number: int
) -> CalibrationRun | None:
    """A finished run of this number, whose parameters may have any values."""
    name = _run_name(number)
    place = study_place(folder, name, KIND)
    try:
        document = read_run(place).document
    except FileError:
        return None
    if document["state"] != "finished":
        return None
    known = document["case"]["contact"] | document["case"]["test"]
    values = {key: float(known[key]) for key in request.ranges}
    if len(datasets) > 1:
        values[DATASET] = datasets.get(document["dataset"]["sha256"], 0)
    variant = _variant(request, number, values)
    if finished_run(place, variant.dataset, variant.request) is None:
        raise FileError(
            f"{folder} holds a run of another dataset, engine, case or seed ({name}); choose another folder."
        )
    drum, turned = _in_drum(request, variant), None
    if drum is not None:
        turned = finished_run(study_place(folder, name + IN_DRUM, KIND), drum.dataset, drum.request)
        if turned is None:
            return None
    return CalibrationRun(name, tuple(values.values()), document, turned)


def _next_run(
    request: ReposeCalibrationRequest, folder: Path, calibration: ReposeCalibration
) -> Generator[Step, None, CalibrationRun]:
    """Simulate the run that is proposed; if it fails, it has no result."""
    number, name = len(calibration.runs), _run_name(len(calibration.runs))
    names = [each.name for each in calibration.parameters]
    values = calibration.next_values
    variant = _variant(request, number, dict(zip(names, values, strict=True)))
    documents, total = [], PROGRESS_STEPS * request.max_runs

    def events_of(step: Step) -> Iterator[Step]:
        if isinstance(step, Progress):
            message = Message(N_("run {number}: {step}"), number=number + 1, step=step.message)
            yield Progress(PROGRESS_STEPS * number + step.done, total, message)

    for suffix, each in (("", variant), (IN_DRUM, _in_drum(request, variant))):
        if each is None:
            continue
        known = finished_run(study_place(folder, name + suffix, KIND), each.dataset, each.request)
        place = folder / JOURNAL / KIND / (name + suffix)
        if known is None:
            steps = simulate_study_run(each.dataset, place, each.request)
            known = yield from as_events(steps, events_of)
        if known["state"] == "failed" and not calibration.runs:
            raise RegolithError(known["problem"])
        documents.append(known)
    return CalibrationRun(name, values, *documents)


def _run_name(number: int) -> str:
    return f"run_{number + 1:02d}"
