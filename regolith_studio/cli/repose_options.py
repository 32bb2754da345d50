"""Options of the commands of ``repose``, and the requests that they define."""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.options import usage_errors, values

if TYPE_CHECKING:
    from regolith_studio.dem.evaluation import EvaluationSettings
    from regolith_studio.jobs.repose_jobs import ReposeRequest

Particles = Annotated[
    int,
    typer.Option(
        "--particles", "-n", min=10, max=5_000_000, help="Number of simulated particles.", metavar="N"
    ),
]
EngineKey = Annotated[
    str, typer.Option("--engine", help="DEM engine; listed by `repose engines`.", metavar="KEY")
]
Contact = Annotated[
    list[str] | None,
    typer.Option(
        "--contact", help="A contact parameter of Table 1 in SI units; may be repeated.", metavar="KEY=VALUE"
    ),
]
EngineSettings = Annotated[
    list[str] | None,
    typer.Option("--set", help="A setting of the engine; may be repeated.", metavar="KEY=VALUE"),
]
Test = Annotated[
    list[str] | None,
    typer.Option(
        "--test",
        help="A parameter of the cylinder test of Table 2 in SI units; may be repeated.",
        metavar="KEY=VALUE",
    ),
]
Measure = Annotated[
    list[str] | None,
    typer.Option("--measure", help="A setting of the evaluation; may be repeated.", metavar="KEY=VALUE"),
]


@dataclass(frozen=True)
class CaseOptions:
    """Options of the simulation of a lifting cylinder and of its evaluation."""

    engine: EngineKey = "mujoco"
    contact: Contact = None
    test: Test = None
    set_: EngineSettings = None
    measure: Measure = None

    def request(self, drum: Mapping[str, Any] | None = None, **case: Any) -> "ReposeRequest":
        """The request of the options; wrong ones are usage errors.

        `drum`: fields of ``DrumRotation``, whose case begins with the drum's own cylinder. `case`: fields of
        ``ReposeCase``.
        """
        from regolith_studio.dataset.parameters import (
            DRUM,
            ContactParameters,
            DrumRotation,
            LiftingCylinderTest,
        )
        from regolith_studio.dem.case import ReposeCase
        from regolith_studio.dem.engines import engine_named
        from regolith_studio.jobs.repose_jobs import ReposeRequest

        with usage_errors():
            engine = engine_named(self.engine)
        test_values = values(self.test, "value")
        if drum is not None:
            test_values = dataclasses.asdict(DRUM) | test_values
        test = settings_from(LiftingCylinderTest, test_values, "value of the test")
        contact = settings_from(ContactParameters, values(self.contact, "value"), "contact parameter")
        simulated = settings_from(ReposeCase, {"test": test, "contact": contact, **case}, "value of the case")
        if drum is not None:
            turning = settings_from(DrumRotation, drum, "value of the drum")
            simulated = dataclasses.replace(simulated, drum=turning)
        return ReposeRequest(
            simulated,
            self.engine,
            settings_from(engine.Settings, values(self.set_, "setting"), f"setting of {engine.label}"),
            evaluation_settings(self.measure),
        )


@dataclass(frozen=True)
class DrumOptions(CaseOptions):
    """The same for a rotating drum, which MuJoCo does not turn."""

    engine: EngineKey = "rapier"


def check_results_folder(output: Path, datasets: Sequence[Path]) -> None:
    """Refuse to write many runs into the folder of a dataset, as bad use."""
    if any(output.resolve() == each.resolve() for each in datasets):
        raise typer.BadParameter(f"{output} is the folder of a dataset; name another one for the results.")


def varied_values(text: str, form: str = "what varies as KEY=V1,V2") -> tuple[str, list[Any]]:
    """Name and values of ``KEY=V1,V2``; nothing of an empty text. `form`: what should have been written."""
    if not text:
        return "", []
    key, equals, points = text.partition("=")
    if not equals or not all(point.strip() for point in points.split(",")):
        raise typer.BadParameter(f"Write {form}, got {text!r}.")
    return key, [values([f"{key}={point}"], "value")[key] for point in points.split(",")]


def evaluation_settings(entries: list[str] | None) -> "EvaluationSettings":
    """Settings of the evaluation from KEY=VALUE entries; a wrong one is a usage error."""
    from regolith_studio.dem.evaluation import EvaluationSettings

    settings: EvaluationSettings = settings_from(
        EvaluationSettings, values(entries, "setting"), "evaluation setting"
    )
    return settings


def settings_from(kind: type[Any], given: Mapping[str, Any], what: str) -> Any:
    """A settings dataclass with the given values; an unknown name or a bad value is a usage error."""
    by_name = {each.name: each for each in dataclasses.fields(kind)}
    checked = {}
    for name, value in given.items():
        if name not in by_name:
            raise typer.BadParameter(f"There is no {what} {name!r}; there are {', '.join(by_name)}.")
        default = by_name[name].default
        if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        elif default is not dataclasses.MISSING and not isinstance(value, type(default)):
            raise typer.BadParameter(f"The {what} {name} must be like {default!r}, got {value!r}.")
        checked[name] = value
    with usage_errors():
        return kind(**checked)
