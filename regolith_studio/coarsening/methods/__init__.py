"""The coarsening methods; each module of this folder that defines ``METHOD`` is one."""

import pkgutil
from collections.abc import Generator, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import numpy as np

    from regolith_studio.coarsening.progress import MethodStep
    from regolith_studio.coarsening.result import MethodResult
    from regolith_studio.coarsening.target import Target
    from regolith_studio.coarsening.weights import LossWeights


class CoarseningMethod(Protocol):
    """A way to coarsen; `Settings` is a frozen dataclass whose fields carry label and range."""

    key: str
    label: str
    Settings: type[Any]

    def run(
        self,
        target: "Target",
        n_facets: int,
        weights: "LossWeights",
        seed: "np.random.SeedSequence",
        settings: Any,
    ) -> "Generator[MethodStep, None, MethodResult]":
        """Yield steps, the first one at once and with a polyhedron; return the result."""
        ...


@cache
def _found() -> dict[str, CoarseningMethod]:
    modules = [import_module(f"{__name__}.{each.name}") for each in pkgutil.iter_modules(__path__)]
    methods = [module.METHOD for module in modules if hasattr(module, "METHOD")]
    return {method.key: method for method in sorted(methods, key=lambda method: method.key)}


class _Methods(Mapping[str, CoarseningMethod]):
    """Looks into the folder when first asked, so that naming the package costs nothing."""

    def __getitem__(self, key: str) -> CoarseningMethod:
        return _found()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(_found())

    def __len__(self) -> int:
        return len(_found())


METHODS: Mapping[str, CoarseningMethod] = _Methods()
