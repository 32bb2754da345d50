"""What is chosen when a radius is expanded: where it begins, which crossing, over what reference."""

from dataclasses import dataclass

from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.harmonics.radius_function import DEFAULT_RULE, RULES
from regolith_studio.harmonics.reference import REFERENCES
from regolith_studio.harmonics.star_point import STAR_POINT_RULES

AUTOMATIC = ""
"""The centre of mass and, where that lies outside the particle, the nearest good point."""


@dataclass(frozen=True)
class Expansion:
    """How radii are taken; picklable.

    Parameters
    ----------
    star_point
        Key of ``STAR_POINT_RULES``, or :data:`AUTOMATIC`.
    rule
        Key of ``radius_function.RULES``.
    reference
        Key of ``REFERENCES``.

    Raises
    ------
    InputError
        If a key is unknown.
    """

    star_point: str = AUTOMATIC
    rule: str = DEFAULT_RULE
    reference: str = "sphere"

    def __post_init__(self) -> None:
        known = {"star_point": (AUTOMATIC, *STAR_POINT_RULES), "rule": RULES, "reference": REFERENCES}
        for name, keys in known.items():
            if (value := getattr(self, name)) not in keys:
                choices = ", ".join(filter(None, keys))
                raise InputError(f"The {name.replace('_', ' ')} must be one of {choices}, got {value!r}.")

    def fit(self, mesh: Mesh, l_max: int) -> HarmonicFit:
        """:func:`fit_harmonics` by these choices."""
        point = self.star_point or None
        return fit_harmonics(mesh, l_max, star_point=point, rule=self.rule, reference=self.reference)


USUAL = Expansion()
"""Automatic star point, volume-preserving radius, no reference but the unit sphere."""
