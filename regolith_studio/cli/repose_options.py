"""Options of the commands of ``repose``, and the orders that they stand for."""

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.options import as_bad_use, values

if TYPE_CHECKING:
    from regolith_studio.dem.evaluation.settings import EvaluationSettings
    from regolith_studio.jobs.repose import ReposeOrder

Particles = Annotated[int, typer.Option("--particles", "-n", help="Simulated particles.", metavar="N")]
EngineKey = Annotated[str, typer.Option("--engine", help="See the command engines.", metavar="KEY")]
Contact = Annotated[
    list[str] | None, typer.Option("--contact", help="One value of Table 1, in SI.", metavar="KEY=VALUE")
]
Test = Annotated[
    list[str] | None, typer.Option("--test", help="One value of Table 2, in SI.", metavar="KEY=VALUE")
]
Measure = Annotated[
    list[str] | None, typer.Option("--measure", help="One setting of the evaluation.", metavar="KEY=VALUE")
]


def evaluation_settings(entries: list[str] | None) -> "EvaluationSettings":
    """Settings of the evaluation from KEY=VALUE entries; a wrong one is bad use."""
    from regolith_studio.dem.evaluation.settings import EvaluationSettings

    found: EvaluationSettings = filled(EvaluationSettings, values(entries, "setting"), "evaluation setting")
    return found


def order_from(
    engine: str,
    contact: list[str] | None,
    test: list[str] | None,
    settings: list[str] | None,
    measure: list[str] | None,
    **case: Any,
) -> "ReposeOrder":
    """The order that options stand for; a wrong one is bad use. `case` are fields of ``ReposeCase``."""
    from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
    from regolith_studio.dem.case import ReposeCase
    from regolith_studio.dem.engines import engine_named
    from regolith_studio.jobs.repose import ReposeOrder

    with as_bad_use():
        code = engine_named(engine)
    return ReposeOrder(
        filled(
            ReposeCase,
            {
                "test": filled(LiftingCylinderTest, values(test, "value"), "value of the test"),
                "contact": filled(ContactParameters, values(contact, "value"), "contact parameter"),
                **case,
            },
            "value of the case",
        ),
        engine,
        filled(code.Settings, values(settings, "setting"), f"setting of {code.label}"),
        evaluation_settings(measure),
    )


def filled(kind: type[Any], given: Mapping[str, Any], what: str) -> Any:
    """A settings dataclass with the given values; an unknown name or a bad value is bad use."""
    known = {each.name: each for each in dataclasses.fields(kind)}
    fitting = {}
    for name, value in given.items():
        if name not in known:
            raise typer.BadParameter(f"There is no {what} {name!r}; there are {', '.join(known)}.")
        default = known[name].default
        if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        elif default is not dataclasses.MISSING and not isinstance(value, type(default)):
            raise typer.BadParameter(f"The {what} {name} must be like {default!r}, got {value!r}.")
        fitting[name] = value
    with as_bad_use():
        return kind(**fitting)
