"""DEM engines by key, what they represent, and what their certificates say beside an angle.

Each module of this folder that defines ``ENGINE`` is an engine.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict
from functools import cache
from typing import Any

from regolith_studio.dem.case import ReposeCase
from regolith_studio.dem.engine import Engine
from regolith_studio.errors import InputError
from regolith_studio.messages import N_, Message
from regolith_studio.registry import Registry
from regolith_studio.resources import results_folder

ENGINES: Registry[Engine] = Registry(
    __name__, "ENGINE", "engines", order=lambda engine: (engine.order, engine.key)
)
DEFAULT_ENGINE = "mujoco"


def engine_named(key: str) -> Engine:
    """The engine of this key.

    Raises InputError if there is none.
    """
    if key not in ENGINES:
        raise InputError(f"There is no engine {key!r}; there are {', '.join(ENGINES)}.")
    return ENGINES[key]


CAPABILITY_LABELS = {
    "shape": N_("Shape"),
    "normal": N_("Normal force"),
    "tangential": N_("Tangential force"),
    "cohesion": N_("Cohesion"),
    "rolling": N_("Rolling"),
    "coarse_graining": N_("Coarse graining"),
    "compounds": N_("Compounds"),
    "drum": N_("Rotating drum"),
    "missing": N_("Not represented"),
}


NEEDED: Mapping[str, tuple[str, Callable[[ReposeCase], bool]]] = {
    "cohesion": ("cohesion", lambda case: case.is_cohesive),
    "rolling": ("rolling resistance", lambda case: case.contact.rolling_friction > 0.0),
    "drum": ("rotating drum", lambda case: case.drum is not None),
}
"""By capability, what it is called and whether a case needs it."""


def check_capability(engine: Engine, key: str, what: str) -> None:
    """Check that an engine has a capability, which is called `what`.

    Raises InputError if it does not.
    """
    if not getattr(engine.capabilities, key):
        others = ", ".join(each.label for each in ENGINES.values() if getattr(each.capabilities, key))
        raise InputError(f"{engine.label} simulates no {what}; take one of the engines {others}.")


def check_case(engine: Engine, case: ReposeCase) -> None:
    """Check that an engine has what a case needs, but for its shapes.

    Raises InputError if it does not.
    """
    for key, (what, needs) in NEEDED.items():
        if needs(case):
            check_capability(engine, key, what)


def engine_rows() -> list[dict[str, Any]]:
    """One dictionary per engine: key, label, licence, version or problem, and capabilities."""
    rows = []
    for engine in ENGINES.values():
        status = engine.find()
        rows.append(
            {
                "key": engine.key,
                "label": engine.label,
                "licence": engine.licence,
                "version": status.version,
                "problem": status.problem,
                **{key: how or N_("none: refused") for key, how in asdict(engine.capabilities).items()},
            }
        )
    return rows


@cache
def shipped_certificates() -> dict[str, dict[str, Any]]:
    """The certificates that come with the program, by the key of the engine."""
    return dict(json.loads((results_folder() / "engine_certificates.json").read_text(encoding="utf-8")))


def engine_notes(engine: Engine) -> list[str]:
    """What to say beside an angle from an engine: the lines that it does not pass, or that it was not
    verified in its present version."""
    version = engine.find().version
    known = shipped_certificates().get(engine.key)
    if known is None:
        return [Message(N_("{engine} was not verified."), engine=engine.label)]
    notes: list[str] = []
    if known["version"] != version:
        template = N_("{engine} was verified in version {verified}, not in {version}.")
        notes.append(Message(template, engine=engine.label, verified=known["version"], version=version))
    failed = [line["key"] for line in known["lines"] if not line["passed"]]
    if failed:
        template = N_("{engine} does not pass these lines of its verification: {lines}.")
        notes.append(Message(template, engine=engine.label, lines=", ".join(failed).replace("_", " ")))
    return notes
