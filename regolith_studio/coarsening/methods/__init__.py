"""The coarsening methods; each module of this folder that defines ``METHOD`` is one."""

from collections.abc import Generator
from typing import TYPE_CHECKING, Any, Protocol

from regolith_studio.registry import Registry

if TYPE_CHECKING:
    import numpy as np

    from regolith_studio.coarsening.progress import MethodStep
    from regolith_studio.coarsening.result import MethodResult
    from regolith_studio.coarsening.target import Target
    from regolith_studio.coarsening.weights import LossWeights
    from regolith_studio.geometry.half_spaces import HalfSpaces


class CoarseningMethod(Protocol):
    """A way to coarsen; `Settings` is a frozen dataclass whose fields carry label and range.

    `keeps_terms` says whether it can keep terms of the loss exactly, or knows their weights only.
    """

    key: str
    label: str
    keeps_terms: bool
    Settings: type[Any]

    def run(
        self,
        target: "Target",
        n_facets: int,
        weights: "LossWeights",
        seed: "np.random.SeedSequence",
        settings: Any,
        fewer: "HalfSpaces | None" = None,
    ) -> "Generator[MethodStep, None, MethodResult]":
        """Yield steps, the first one at once and with a polyhedron; return the result.

        `fewer` is a result with fewer facets at unit volume, from which a method may make one more start.
        """
        ...


METHODS: Registry[CoarseningMethod] = Registry(
    __name__, "METHOD", "coarsening_methods", order=lambda method: method.key
)
