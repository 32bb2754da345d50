"""The models; each module of this folder that defines ``MODEL`` is one."""

import pkgutil
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from regolith_studio.shape_models.protocol import ShapeModel

DEFAULT_MODEL = "sample_matched"
"""The one that reaches the sampling noise; ``log_field`` is the one to extrapolate with."""


@cache
def _found() -> "dict[str, ShapeModel]":
    modules = [import_module(f"{__name__}.{each.name}") for each in pkgutil.iter_modules(__path__)]
    models = [module.MODEL for module in modules if hasattr(module, "MODEL")]
    return {model.key: model for model in sorted(models, key=lambda model: str(model.key))}


class _Models(Mapping[str, "ShapeModel"]):
    """Looks into the folder when first asked, so that naming the package costs nothing."""

    def __getitem__(self, key: str) -> "ShapeModel":
        return _found()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(_found())

    def __len__(self) -> int:
        return len(_found())


MODELS: Mapping[str, "ShapeModel"] = _Models()
