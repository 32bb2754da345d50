"""Options of a spherical-harmonics fit: how the radii of a particle are taken."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from regolith_studio.messages import N_
from regolith_studio.settings import check_settings, setting

if TYPE_CHECKING:  # the command line makes its options of these fields, and must not wait for numerics
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.harmonics.fit import HarmonicFit

FIT_DEGREE = 30
"""Highest degree of the fits of meshes."""
LEVEL_LIMITS = (0, 7)
MAX_TABLE_DEGREE = 200
"""Of tables of coefficients that are read instead of meshes."""
AUTOMATIC = ""
"""The centre of mass or, where that is not inside, the point that hides the least volume."""


@dataclass(frozen=True)
class FitSurfaceSettings:
    """How fine the surface of a fit is.

    Raises InputError if a value is out of its range.
    """

    l_max: int = setting(
        10,
        N_("Maximum degree"),
        N_(
            "Degree at which the series is truncated: 0 is a sphere, 10 keeps the form, "
            "30 nearly all details."
        ),
        symbol="l_max",
        minimum=0,
        maximum=FIT_DEGREE,
        slider=(0, FIT_DEGREE),
        metavar="L",
    )
    level: int = setting(
        4,
        N_("Subdivisions"),
        N_("Subdivisions of the icosahedron that surfaces are drawn on; 4 gives 5,120 triangles."),
        minimum=LEVEL_LIMITS[0],
        maximum=LEVEL_LIMITS[1],
    )

    def __post_init__(self) -> None:
        check_settings(self)


@dataclass(frozen=True)
class FitOptions:
    """How the radius function is obtained from a mesh; picklable.

    - ``star_point``: key of ``STAR_POINT_RULES``, or :data:`AUTOMATIC`.
    - ``rule``: key of ``radius_function.RULES``.
    - ``reference``: key of ``REFERENCES``.

    Raises InputError if a key is unknown.
    """

    star_point: str = setting(
        AUTOMATIC,
        N_("Star point"),
        N_(
            "Origin of the radii. Automatic: the centre of mass or, where that is not inside, "
            "the point that hides the least volume."
        ),
        choices={
            AUTOMATIC: N_("Automatic"),
            "centre_of_mass": N_("Centre of mass"),
            "kernel_centre": N_("Centre of the kernel"),
            "least_hidden_volume": N_("Minimum hidden volume"),
        },
    )
    rule: str = setting(
        "volume",
        N_("Radius"),
        N_(
            "Which radius counts where a ray crosses the surface more than once. Keep the volume: the cube "
            "root of the signed sum of r³ over all crossings."
        ),
        choices={
            "volume": N_("Keep the volume"),
            "outermost": N_("Last crossing"),
            "first": N_("First crossing"),
        },
    )
    reference: str = setting(
        "sphere",
        N_("Reference surface"),
        N_(
            "Surface by which the radii are divided before the expansion. An ellipsoid reduces oscillations "
            "on flat and elongated particles."
        ),
        choices={"sphere": N_("Sphere"), "ellipsoid": N_("Best-fit ellipsoid")},
    )

    def __post_init__(self) -> None:
        check_settings(self)

    def fit(self, mesh: "Mesh", l_max: int) -> "HarmonicFit":
        """:func:`~regolith_studio.harmonics.fit.fit_harmonics` by these choices."""
        from regolith_studio.harmonics.fit import fit_harmonics

        point = self.star_point or None
        return fit_harmonics(mesh, l_max, star_point=point, rule=self.rule, reference=self.reference)


DEFAULT_FIT_OPTIONS = FitOptions()
"""Automatic star point, volume-preserving radius, no reference but the unit sphere."""
