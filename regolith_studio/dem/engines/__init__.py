"""DEM engines by key; each module of this folder that defines ``ENGINE`` is one."""

from dataclasses import asdict
from typing import Any

from regolith_studio.dem.engine import Engine
from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.registry import Registry

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
                **asdict(engine.capabilities),
                "compounds": engine.capabilities.compounds or N_("none: compounds are refused"),
                "drum": engine.capabilities.drum or N_("none: drums are refused"),
            }
        )
    return rows
