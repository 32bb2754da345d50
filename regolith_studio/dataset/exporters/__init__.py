"""The formats of exports; each module of this folder that defines ``EXPORTER`` is one."""

from typing import TYPE_CHECKING

from regolith_studio.registry import Registry

if TYPE_CHECKING:
    from regolith_studio.dataset.export import Exporter

EXPORTERS: "Registry[Exporter]" = Registry(
    __name__, "EXPORTER", "exporters", order=lambda each: each.label.casefold()
)
