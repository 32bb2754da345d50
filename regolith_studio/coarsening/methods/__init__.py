"""The coarsening methods; each module of this folder that defines ``METHOD`` is one."""

from collections.abc import Generator
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from regolith_studio.registry import Registry

if TYPE_CHECKING:
    import numpy as np

    from regolith_studio.coarsening.progress import MethodStep
    from regolith_studio.coarsening.result import MethodResult
    from regolith_studio.coarsening.target import Target
    from regolith_studio.coarsening.weights import LossWeights
    from regolith_studio.geometry.half_spaces import HalfSpaces


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


@runtime_checkable
class GrowingMethod(Protocol):
    """A method that can begin with a result with fewer facets, besides its own starts."""

    def run_from_fewer(
        self,
        target: "Target",
        fewer: "HalfSpaces | None",
        n_facets: int,
        weights: "LossWeights",
        seed: "np.random.SeedSequence",
        settings: Any,
    ) -> "Generator[MethodStep, None, MethodResult]":
        """As :meth:`CoarseningMethod.run`; `fewer` is at unit volume."""
        ...


METHODS: Registry[CoarseningMethod] = Registry(
    __name__, "METHOD", "coarsening_methods", order=lambda method: method.key
)
