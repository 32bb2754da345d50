"""Contact parameters and lifting-cylinder test: Tables 1 and 2 of the paper.

Values that the paper does not give are marked as such.
"""

from dataclasses import dataclass, field, fields
from typing import Any, Literal

from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.settings import check_settings, setting

NOT_GIVEN = N_("not given in the paper")

GRAVITIES = {N_("Earth"): 9.81, N_("Moon"): 1.62, N_("Mars"): 3.71}
"""Accelerations at the surface in m/s^2."""


def _number(
    default: float,
    label: str,
    unit: str,
    low: float,
    high: float,
    source: str = NOT_GIVEN,
    factor: float = 1.0,
) -> Any:
    """A field in SI units; `factor` converts it into the displayed `unit`."""
    metadata = {
        "label": label,
        "unit": unit,
        "minimum": low,
        "maximum": high,
        "source": source,
        "factor": factor,
    }
    return field(default=default, metadata=metadata)


@dataclass(frozen=True)
class ContactParameters:
    """Contact parameters of Table 1. SI units.

    - ``density``: of the particles, in kg/m^3.
    - ``youngs_modulus``, ``poissons_ratio``: of their material, in Pa.
    - ``static_friction``, ``dynamic_friction``: coulomb's coefficients.
    - ``rolling_friction``: coefficient of rolling resistance, as a fraction of the radius.
    - ``restitution``: of a normal impact.
    - ``surface_energy``: of the model of Johnson, Kendall and Roberts, in J/m^2.

    Raises InputError if a value is out of its range.
    """

    density: float = _number(3075.0, N_("Particle density"), "g/cm³", 100.0, 3e4, N_("Table 1"), 1e-3)
    youngs_modulus: float = _number(30e9, N_("Young's modulus"), "GPa", 1e4, 1e13, N_("Table 1"), 1e-9)
    poissons_ratio: float = _number(0.2, N_("Poisson's ratio"), "", 0.0, 0.49, N_("Table 1"))
    static_friction: float = _number(0.8, N_("Static friction"), "", 0.0, 5.0, N_("Table 1"))
    dynamic_friction: float = _number(0.8, N_("Dynamic friction"), "", 0.0, 5.0, N_("Table 1"))
    rolling_friction: float = _number(0.0, N_("Rolling resistance"), "", 0.0, 2.0)
    restitution: float = _number(0.3, N_("Restitution"), "", 0.0, 1.0)
    surface_energy: float = _number(0.010, N_("Surface energy"), "mJ/m²", 0.0, 10.0, N_("Table 1"), 1e3)

    def __post_init__(self) -> None:
        check_limits(self, "contact parameter")


@dataclass(frozen=True)
class LiftingCylinderTest:
    """Lifting-cylinder test of Table 2: a filled cylinder is lifted off a plate. SI units.

    - ``diameter``, ``height``: of the cylinder.
    - ``mass``: of all particles, in kg.
    - ``lift_speed``: in m/s.
    - ``wall_friction``, ``plate_friction``: coulomb's coefficient between particles and cylinder, particles
      and plate.
    - ``gravity``: in m/s^2; :data:`GRAVITIES` names some.

    Raises InputError if a value is out of its range.
    """

    diameter: float = _number(0.02, N_("Cylinder diameter"), "cm", 1e-5, 10.0, N_("Table 2"), 1e2)
    height: float = _number(0.08, N_("Cylinder height"), "cm", 1e-5, 100.0, N_("Table 2"), 1e2)
    mass: float = _number(0.015, N_("Total mass"), "g", 1e-12, 1e6, N_("Table 2"), 1e3)
    lift_speed: float = _number(0.03, N_("Lift speed"), "cm/s", 1e-5, 10.0, factor=1e2)
    wall_friction: float = _number(0.3, N_("Wall friction"), "", 0.0, 5.0)
    plate_friction: float = _number(0.8, N_("Plate friction"), "", 0.0, 5.0)
    gravity: float = _number(9.81, N_("Gravity"), "m/s²", 1e-4, 1e4)

    def __post_init__(self) -> None:
        check_limits(self, "test parameter")

    @property
    def area(self) -> float:
        """Cross-section of the cylinder in m^2."""
        return 3.141592653589793 / 4 * self.diameter**2


@dataclass(frozen=True)
class DrumRotation:
    """How a drum turns about its horizontal axis.

    - ``rpm``: revolutions in a minute.
    - ``turns``: that are measured; a quarter of a turn before them is not.
    - ``moments``: at which the surface is measured.

    Raises InputError if a value is out of its range.
    """

    rpm: float = _number(10.0, N_("Speed of rotation"), N_("rpm"), 1e-3, 1e5)
    turns: float = _number(1.0, N_("Turns"), "", 0.05, 1000.0)
    moments: int = _number(300, N_("Measured moments"), "", 20, 100_000)

    def __post_init__(self) -> None:
        check_limits(self, "value of the drum")

    @property
    def angular_speed(self) -> float:
        """In radians a second."""
        return 2 * 3.141592653589793 * self.rpm / 60

    def froude(self, test: LiftingCylinderTest) -> float:
        """Centripetal over gravitational acceleration at the wall."""
        return self.angular_speed**2 * test.diameter / 2 / test.gravity


def rpm_of(froude: float, test: LiftingCylinderTest) -> float:
    """Revolutions in a minute at which a drum has a Froude number."""
    return float((2 * froude * test.gravity / test.diameter) ** 0.5 * 60 / (2 * 3.141592653589793))


@dataclass(frozen=True)
class ScriptTimes:
    """Waiting times, in seconds, of scripts that cannot detect when the particles are at rest.

    ``settling_time``: before the cylinder is lifted. ``resting_time``: after the cylinder has risen by its
    own height.

    Raises InputError if a value is out of its range.
    """

    settling_time: float = _number(1.0, N_("Settling time"), "s", 1e-4, 1e4)
    resting_time: float = _number(1.0, N_("Resting time"), "s", 1e-4, 1e4)

    def __post_init__(self) -> None:
        check_limits(self, "waiting time")

    def duration(self, test: LiftingCylinderTest) -> float:
        """Of the whole test: settle, lift the cylinder by its height, come to rest."""
        return self.settling_time + test.height / test.lift_speed + self.resting_time


PAPER_FILL_HEIGHT = (0.025, 0.030)
"""Fill height of Table 2 in metres; here a result of mass and packing."""
PAPER_COARSE_GRAINING = 10.0


def missing_in_paper(kind: type[Any]) -> tuple[str, ...]:
    """Names of the fields whose value the paper does not give."""
    return tuple(each.name for each in fields(kind) if each.metadata["source"] == NOT_GIVEN)


def check_limits(settings: Any, what: str) -> None:
    """Check that every field with a ``minimum`` lies between it and its ``maximum``.

    ``settings``: a dataclass; the metadata ``factor`` and ``unit`` of a field convert it for the message.
    ``what``: name of such a field in the message, for example "MuJoCo setting".

    Raises InputError naming the first field that does not; NaN is refused too.
    """
    for each in fields(settings):
        limits = each.metadata
        value = getattr(settings, each.name)
        if "minimum" in limits and not limits["minimum"] <= value <= limits["maximum"]:
            factor = limits.get("factor", 1)
            unit = f" {limits['unit']}" if limits.get("unit") else ""
            raise InputError(
                f"The {what} {each.name} must lie between {factor * limits['minimum']:g} and "
                f"{factor * limits['maximum']:g}{unit}, got {factor * value:g}."
            )


DRUM = LiftingCylinderTest(diameter=0.04, height=0.015, wall_friction=0.8, plate_friction=0.0)
"""A drum that 15 g fill by two fifths, with end plates without friction: a slice of a long one."""


@dataclass(frozen=True)
class RepresentativesSettings:
    """How the particles of a dataset are chosen."""

    count: int = setting(
        10,
        N_("Number of representatives"),
        "Number of representative particles; 0 keeps all particles.",
        minimum=0,
        maximum=100_000,
        option="--representatives",
    )
    weighting: Literal["number", "volume"] = setting(
        "number",
        N_("Weighting of the representatives"),
        "Weighting of the representatives.",
        choices={
            "number": N_("Each particle counts equally"),
            "volume": N_("Particles count by their volume"),
        },
        metavar="W",
    )
    size_importance: float = setting(
        0.0,
        "Weight of the size",
        "Weight of a standard deviation of ln d, relative to one of a shape feature, in the choice of "
        "representatives.",
        minimum=0.0,
        maximum=1e6,
        metavar="X",
    )

    def __post_init__(self) -> None:
        check_settings(self)


@dataclass(frozen=True)
class DatasetSettings(RepresentativesSettings):
    """Which particles a dataset holds, their sizes, and its name."""

    sizes: str = setting(
        "measured",
        N_("Kind of size distribution"),
        "Size distribution: measured, classes:25,37,..., fitted:log-normal, log-normal:50,0.4, ...",
        metavar="SPEC",
    )
    name: str = setting(
        "", N_("Name of the dataset"), "Name of the dataset; that of the folder if omitted.", metavar="NAME"
    )


@dataclass(frozen=True)
class ExportSettings:
    """Settings that all exporters share."""

    coarse_graining_factor: float = setting(
        1.0,
        N_("Coarse-graining factor"),
        "Factor on all diameters (section 2.6); 1 keeps the particles' sizes, the paper takes 10.",
        minimum=1e-6,
        maximum=1e6,
        option="--coarse-graining",
        metavar="F",
    )
    n_particles: int = setting(
        200,
        N_("Particles drawn"),
        "Number of particles in formats that list single ones.",
        minimum=1,
        maximum=1_000_000,
        option="--particles",
    )
    max_error: float = setting(
        0.0,
        "Error of spheres",
        "Largest mismatch (Jaccard distance) of shapes made of spheres; takes as many as needed.",
        minimum=0.0,
        maximum=0.9,
        metavar="E",
    )

    def __post_init__(self) -> None:
        check_settings(self)
