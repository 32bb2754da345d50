"""The certificates that come with the program, and what they say beside an angle."""

import json
from functools import cache
from typing import Any

from regolith_studio.dem.engine import Engine
from regolith_studio.messages import N_, Message
from regolith_studio.resources import results_folder


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
