"""The engines; each module of this folder that defines ``ENGINE`` is one."""

import pkgutil
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module

from regolith_studio.dem.engine import Engine
from regolith_studio.errors import InputError


@cache
def _found() -> dict[str, Engine]:
    modules = [import_module(f"{__name__}.{each.name}") for each in pkgutil.iter_modules(__path__)]
    engines = [module.ENGINE for module in modules if hasattr(module, "ENGINE")]
    return {engine.key: engine for engine in sorted(engines, key=lambda engine: (engine.order, engine.key))}


class _Engines(Mapping[str, Engine]):
    """Looks into the folder when first asked, so that naming the package costs nothing."""

    def __getitem__(self, key: str) -> Engine:
        return _found()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(_found())

    def __len__(self) -> int:
        return len(_found())


ENGINES: Mapping[str, Engine] = _Engines()
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
