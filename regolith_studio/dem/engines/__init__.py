"""The engines; each module of this folder that defines ``ENGINE`` is one."""

from regolith_studio.dem.engine import Engine
from regolith_studio.errors import InputError
from regolith_studio.registry import Registry

ENGINES: Registry[Engine] = Registry(
    __name__, "ENGINE", "engines", order=lambda engine: (engine.order, engine.key)
)
DEFAULT_ENGINE = "mujoco"


def engine_named(key: str) -> Engine:
    """The engine of this key.

    Raises
    ------
    InputError
        If there is none.
    """
    if key not in ENGINES:
        raise InputError(f"There is no engine {key!r}; there are {', '.join(ENGINES)}.")
    return ENGINES[key]
