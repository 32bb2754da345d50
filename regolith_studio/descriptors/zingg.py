"""Zingg's four classes of form (1935), from elongation I/L and flatness S/I."""

from collections.abc import Mapping
from enum import StrEnum

THRESHOLD = 2 / 3
"""Where Zingg drew both lines."""


class ZinggClass(StrEnum):
    """Form of a particle by its three diameters."""

    EQUANT = "equant"
    DISC = "disc"
    ROD = "rod"
    BLADE = "blade"


def zingg_class(descriptors: Mapping[str, float]) -> ZinggClass:
    """Class from the keys ``elongation`` (I/L) and ``flatness`` (S/I)."""
    wide = descriptors["elongation"] >= THRESHOLD
    thick = descriptors["flatness"] >= THRESHOLD
    if wide:
        return ZinggClass.EQUANT if thick else ZinggClass.DISC
    return ZinggClass.ROD if thick else ZinggClass.BLADE
