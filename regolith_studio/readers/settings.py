"""Settings of reading meshes: the unit of files without one, and repair."""

from dataclasses import dataclass
from typing import Any, Self

from regolith_studio.messages import N_
from regolith_studio.settings import setting, settings_in


@dataclass(frozen=True)
class ReadingSettings:
    """How meshes are read."""

    unit: str = setting(
        "um",
        N_("Unit"),
        N_("Length unit of files without one: um, mm, m, nm, cm or voxel:SIZE."),
        metavar="U",
    )
    repair: bool = setting(
        True, N_("Repair meshes"), N_("Repair defects of the meshes and report the repairs.")
    )

    @classmethod
    def of(cls, values: Any) -> Self:
        """Those that options, choices or entries of a recipe hold."""
        return cls(**settings_in(cls, values))


AS_USUAL = ReadingSettings()
