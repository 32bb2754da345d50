"""Settings of reading meshes: repair, and the length unit of files that state none."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.settings import setting, settings_in

UNITS: dict[str, float] = {"um": 1.0, "mm": 1e3, "m": 1e6, "nm": 1e-3, "cm": 1e4, "voxel": math.nan}
"""Micrometres in a unit; not a number for ``voxel``, whose size must be given: ``voxel:2.5``."""

FILE_UNITS = {**UNITS, "inch": 25_400.0, "foot": 304_800.0, "angstrom": 1e-4, "bohr": 5.29177210903e-5}
"""Micrometres in a unit, with those that only files state."""

MIN_VOXEL, MAX_VOXEL = 1e-12, 1e12
"""Range of the edge of a voxel, in any unit."""
_NAMES = {
    "um": ("um", "µm", "μm", "µ", "μ", "\\u00b5m", "\\u03bcm", "micron", "microns",
           "micrometer", "micrometre", "micrometers", "micrometres"),
    "mm": ("mm", "millimeter", "millimetre", "millimeters", "millimetres"),
    "m": ("m", "meter", "metre", "meters", "metres"),
    "nm": ("nm", "nanometer", "nanometre", "nanometers", "nanometres"),
    "cm": ("cm", "centimeter", "centimetre", "centimeters", "centimetres"),
    "inch": ("inch", "inches", "in"),
    "foot": ("foot", "feet", "ft"),
    "angstrom": ("angstrom", "angstroms", "å", "ångström"),
    "bohr": ("bohr",),
}  # fmt: skip
_KEYS = {name: key for key, names in _NAMES.items() for name in names}


def unit_named(text: str) -> str | None:
    """The key of `FILE_UNITS` for a unit as files spell it (``µm``, ``micron``, ``millimetre``), or None."""
    return _KEYS.get(text.strip().strip("\"'\0").strip().lower())


def in_one_unit(
    lengths: Sequence[float], names: Sequence[str | None]
) -> tuple[tuple[float, ...], str] | None:
    """Lengths in one of `UNITS`, from lengths in units as a file spells them; None if one is not known.

    They stay as they are where all are in one of `UNITS`, and become micrometres otherwise.

    ``lengths``, ``names``: one for each axis.
    """
    keys = [unit_named(name or "") for name in names]
    known = [key for key in keys if key is not None]
    if not known or len(known) < len(keys):
        return None
    if len(set(known)) == 1 and known[0] in UNITS:
        return tuple(lengths), known[0]
    return tuple(each * FILE_UNITS[key] for each, key in zip(lengths, known, strict=True)), "um"


def unit_factor(unit: str) -> float:
    """Micrometres in `unit`: a key of `FILE_UNITS`, or ``voxel:SIZE`` with the voxel's edge in micrometres.

    Raises InputError if there is no such unit, or the voxel size is missing or not positive.
    """
    key, _, size = unit.partition(":")
    if key == "voxel":
        try:
            factor = float(size)
        except ValueError:
            factor = math.nan
    else:
        factor = FILE_UNITS.get(unit, math.nan)
        if math.isnan(factor):
            raise InputError(f"There is no unit “{unit}”; the units are {', '.join(UNITS)}.")
    if not MIN_VOXEL <= factor <= MAX_VOXEL:
        raise InputError(
            "The unit voxel needs the size of a voxel in micrometres: write for example voxel:2.5, "
            f"from {MIN_VOXEL:g} to {MAX_VOXEL:g}."
        )
    return factor


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
