"""Which part of a volume is worked on, and how finely: the settings of a region of interest."""

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.readers.settings import UNITS, unit_named
from regolith_studio.settings import check_settings, setting

if TYPE_CHECKING:  # the command line makes its options of these fields, and must not wait for numerics
    from regolith_studio.imaging.volume_slabs import SliceSource

_BOUND = r"\s*(?:(\d+(?:\.\d*)?|\.\d+)\s*([^\W\d_]*))?\s*"
_RANGE = re.compile(f"{_BOUND}:{_BOUND}")
_Bound = tuple[float | None, str]


@dataclass(frozen=True)
class RegionSettings:
    """Region of interest of a volume; picklable.

    - ``crop``: ranges along x, y and z, ``X0:X1,Y0:Y1,Z0:Z1``: voxels from X0 up to but not including X1, or
      lengths with a unit from the volume's outer faces on (``0.2:1.5mm``). A bound that is left out is the
      face. Empty for the whole volume.
    - ``bin``: edge in voxels of the cubes whose mean becomes one voxel.
    - ``outside``: grey value outside of the scanner's circle: a number, ``nan``, ``none`` if the scan fills
      its slices, or ``auto`` to look for one.

    Raises InputError if the ranges or the value cannot be understood.
    """

    crop: str = setting(
        "",
        N_("Crop"),
        N_(
            "Part of the volume to work on: X0:X1,Y0:Y1,Z0:Z1 in voxels, or in lengths with a unit, such as "
            "1:3mm,:,100:300. Particles keep their places in the whole volume."
        ),
        metavar="RANGES",
    )
    bin: int = setting(
        1,
        N_("Bin"),
        N_("Edge in voxels of the cubes whose mean becomes one voxel: 2 makes eight voxels one."),
        minimum=1,
        maximum=64,
    )
    outside: str = setting(
        "auto",
        N_("Outside"),
        N_(
            "Grey value outside of the scanner's circle, which is left out: a number, nan, none, "
            "or auto to look for it."
        ),
        metavar="VALUE",
    )

    def __post_init__(self) -> None:
        check_settings(self)
        _ranges(self.crop)
        if self.outside not in ("auto", "none", "nan") and not _is_number(self.outside):
            raise InputError(
                "The value outside of the scanner's circle is a number, nan, none or auto, got "
                f"{self.outside!r}."
            )

    @property
    def is_whole(self) -> bool:
        """Whether the volume is used as it is."""
        return self.bin == 1 and not self.crop

    def of(self, source: "SliceSource") -> "SliceSource":
        """This region of a volume, read slab by slab.

        Raises InputError as :class:`~regolith_studio.imaging.volume_slabs.VolumeRegion`.
        """
        if self.is_whole:
            return source
        import numpy as np

        from regolith_studio.imaging.volume import box_between
        from regolith_studio.imaging.volume_slabs import VolumeRegion

        edges = np.asarray(source.voxel_size, float).tolist()
        ranges = _ranges(self.crop) or (((None, ""), (None, "")),) * 3
        low = [_voxel(first, edge, 0) for (first, _), edge in zip(ranges, edges, strict=True)]
        high = [_voxel(stop, edge, n) for (_, stop), edge, n in zip(ranges, edges, source.shape, strict=True)]
        return VolumeRegion(source, box_between(low, high), self.bin)


def crop_of_rectangle(
    region: RegionSettings,
    origin: tuple[float, float, float],
    axis: int,
    low: tuple[int, int],
    high: tuple[int, int],
) -> str:
    """The crop of a rectangle in a slice of a region, in voxels of the whole volume; along `axis` it stays.

    - ``region``: what the slice belongs to.
    - ``origin``: of the region, as in a ``Volume``.
    - ``axis``: direction across the slice.
    - ``low``, ``high``: first voxels of the region along the two other axes, and those after the last.
    """
    parts = region.crop.split(",") if region.crop else [":"] * 3
    across = [each for each in range(3) if each != axis]
    for each, first, stop in zip(across, low, high, strict=True):
        start = round(origin[each] * region.bin - (region.bin - 1) / 2)
        parts[each] = f"{start + first * region.bin}:{start + stop * region.bin}"
    return ",".join(part.strip() for part in parts)


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _ranges(text: str) -> tuple[tuple[_Bound, _Bound], ...]:
    """Both bounds along x, y and z, each a number or None and the key of a unit or nothing for voxels."""
    if not text:
        return ()
    matches = [_RANGE.fullmatch(part) for part in text.split(",")]
    if len(matches) != 3 or not all(matches):
        raise InputError(
            f"A crop is X0:X1,Y0:Y1,Z0:Z1 in voxels or lengths, such as 0:256,:,0.1:0.5mm, got {text!r}."
        )
    return tuple(_bounds(each.groups(), text) for each in matches if each is not None)


def _bounds(groups: tuple[str | None, ...], text: str) -> tuple[_Bound, _Bound]:
    first, first_unit, stop, stop_unit = groups
    bounds = []
    for number, unit in ((first, first_unit or stop_unit), (stop, stop_unit or first_unit)):
        key = unit_named(unit or "") or ""
        if unit and key not in UNITS:
            units = ", ".join(each for each in UNITS if each != "voxel")
            raise InputError(f"There is no unit “{unit}” for a crop; the units are {units}.")
        if number and not key and not number.isdigit():
            raise InputError(f"A crop in voxels has whole numbers, got {text!r}; lengths need a unit.")
        bounds.append((float(number) if number else None, key))
    return bounds[0], bounds[1]


def _voxel(bound: _Bound, edge: float, default: int) -> int:
    """The face between voxels that is nearest to a bound."""
    number, unit = bound
    if number is None:
        return default
    return round(number * UNITS[unit] / edge) if unit else int(number)
