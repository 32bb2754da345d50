"""The formats of exports; each module of this folder that defines ``EXPORTER`` is one."""

import pkgutil
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from regolith_studio.dataset.exporting import Exporter


@cache
def _found() -> "dict[str, Exporter]":
    modules = [import_module(f"{__name__}.{each.name}") for each in pkgutil.iter_modules(__path__)]
    exporters: list[Exporter] = [module.EXPORTER for module in modules if hasattr(module, "EXPORTER")]
    return {each.key: each for each in sorted(exporters, key=lambda each: each.label.casefold())}


class _Exporters(Mapping[str, "Exporter"]):
    """Looks into the folder when first asked, so that naming the package costs nothing."""

    def __getitem__(self, key: str) -> "Exporter":
        return _found()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(_found())

    def __len__(self) -> int:
        return len(_found())


EXPORTERS: "Mapping[str, Exporter]" = _Exporters()
