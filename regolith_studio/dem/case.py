"""A simulated test: particles drawn from a dataset, coarse-grained to the mass of the test; its scaling."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import (
    DRUM,
    PAPER_COARSE_GRAINING,
    PAPER_FILL_HEIGHT,
    ContactParameters,
    DrumRotation,
    LiftingCylinderTest,
)
from regolith_studio.dataset.sampling import sample_dataset
from regolith_studio.dem.angle_of_repose import COARSE_PILE, RELIABLE_N
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats, locked_integers
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.messages import N_, Message, Number

MICROMETRE = 1e-6
MIN_DIAMETERS_ACROSS = 3.0
"""Minimum diameter of the cylinder in mean particle diameters."""
MIN_DRUM_SHARE, MAX_DRUM_SHARE = 0.1, 0.7
"""Part of a drum's volume that its filling takes."""
MAX_BOND_NUMBER = 10_000
SOLID_FRACTION = 0.55
"""Estimate for a settled filling, before a run."""

ShapeKind = Literal["polyhedra", "spheres"]
CohesionKind = Literal["none", "given", "scaled"]


@dataclass(frozen=True)
class ReposeCase:
    """Parameters of a lifting-cylinder test, or of a rotating drum.

    Parameters
    ----------
    test, contact
        Tables 2 and 1. A drum is `height` deep between its end plates, which have the friction of the plate.
    n_particles
        Simulated particles.
    coarse_graining
        Factor on all diameters; 0: such that `n_particles` have the mass of the test.
    shapes
        The polyhedra of the dataset, or spheres of the same volumes for comparison.
    cohesion
        ``none``; the surface energy as ``given``; or ``scaled`` by the square of the coarse graining
        (relative to the paper's factor 10), which keeps the ratio of cohesion to weight.
    bond_number
        Pull-off force of two mean simulated particles over the weight of one, in place of the surface energy;
        0: `cohesion` says it.
    seed
        Of sizes, shapes, positions and orientations.
    drum
        How the cylinder turns on its side; without it, it is lifted.

    Raises
    ------
    InputError
        If a number is out of its range.
    """

    test: LiftingCylinderTest = field(default_factory=LiftingCylinderTest)
    contact: ContactParameters = field(default_factory=ContactParameters)
    n_particles: int = 1000
    coarse_graining: float = 0.0
    shapes: ShapeKind = "polyhedra"
    cohesion: CohesionKind = "none"
    bond_number: float = 0.0
    seed: int = 0
    drum: DrumRotation | None = None

    @classmethod
    def in_drum(cls, drum: DrumRotation, **values: Any) -> "ReposeCase":
        """A case of a rotating drum; `values` are other fields, `test` being :data:`DRUM` if omitted."""
        return cls(**{"test": DRUM, "drum": drum, **values})

    def __post_init__(self) -> None:
        if not 10 <= self.n_particles <= 5_000_000:
            raise InputError(
                f"The number of particles must lie between 10 and 5,000,000, got {self.n_particles}."
            )
        if not 0.0 <= self.coarse_graining <= 1e5:
            raise InputError(
                f"The coarse graining must lie between 0 and 100,000, got {self.coarse_graining:g}."
            )
        if self.seed < 0:
            raise InputError(f"The seed must not be negative, got {self.seed}.")
        if self.shapes not in ("polyhedra", "spheres"):
            raise InputError(f"Shapes are polyhedra or spheres, got {self.shapes!r}.")
        if self.cohesion not in ("none", "given", "scaled"):
            raise InputError(f"Cohesion is none, given or scaled, got {self.cohesion!r}.")
        if not 0.0 <= self.bond_number <= MAX_BOND_NUMBER:
            raise InputError(
                f"The Bond number must lie between 0 and {MAX_BOND_NUMBER:,}, got {self.bond_number:g}."
            )
        if self.bond_number > 0.0 and self.cohesion != "none":
            raise InputError(f"Give either a Bond number or cohesion {self.cohesion}.")

    @property
    def is_cohesive(self) -> bool:
        """Whether particles attract each other."""
        return self.bond_number > 0.0 or (self.cohesion != "none" and self.contact.surface_energy > 0.0)


@dataclass(frozen=True, eq=False)
class PreparedCase(LockedRecord):
    """A case with its particles. SI units.

    - ``case``: parameters of the test.
    - ``shapes``: vertices of each unit-volume shape about its centroid, each of shape (k, 3); of a compound
      those of all parts, one after the other.
    - ``class_index``: index of each particle's shape, shape (n,).
    - ``diameters``: equivalent diameters after coarse graining, in metres, shape (n,).
    - ``coarse_graining``: factor that was applied.
    - ``dataset_name``, ``dataset_hash``: of the dataset; the hash is empty if it is not on disk.
    - ``n_facets``: facets of each shape, if known.
    - ``parts``, ``inertias``: number of vertices of each convex part of each shape, and each shape's tensor
      of inertia at density 1, shape (3, 3), of a compound that of its union. Both empty where all shapes are
      convex.
    - ``filling``: the same particles at rest in the cylinder, from an earlier run; without it the cylinder
      is filled.
    - ``filling_notes``: sentences on what the filling remembers of that run and the case has not.
    """

    case: ReposeCase
    shapes: tuple[FloatArray, ...]
    class_index: IntArray
    diameters: FloatArray
    coarse_graining: float
    dataset_name: str = ""
    dataset_hash: str = ""
    n_facets: tuple[int, ...] = ()
    parts: tuple[tuple[int, ...], ...] = ()
    inertias: tuple[FloatArray, ...] = ()
    filling: ParticleState | None = None
    filling_notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        n = len(self.diameters)
        object.__setattr__(self, "diameters", locked_floats(self.diameters, (n,), "diameters"))
        object.__setattr__(self, "class_index", locked_integers(self.class_index, (n,), "class_index"))
        shapes = tuple(locked_floats(each, (None, 3), "shapes") for each in self.shapes)
        object.__setattr__(self, "shapes", shapes)

    def __len__(self) -> int:
        return len(self.diameters)

    @property
    def mean_diameter(self) -> float:
        """Of the simulated particles, in metres."""
        return float(self.diameters.mean())

    @cached_property
    def mass(self) -> float:
        """Of all particles, in kg."""
        return float(self.case.contact.density * np.pi / 6 * (self.diameters**3).sum())

    @property
    def scales(self) -> FloatArray:
        """Factor from the unit-volume shape to each particle, in metres, shape (n,)."""
        return np.asarray(self.diameters * (np.pi / 6) ** (1 / 3))

    @property
    def part_vertices(self) -> tuple[tuple[FloatArray, ...], ...]:
        """Vertices of the convex parts of each shape; a convex shape is its only part."""
        if not self.parts:
            return tuple((shape,) for shape in self.shapes)
        return tuple(
            tuple(np.split(shape, np.cumsum(counts)[:-1]))
            for shape, counts in zip(self.shapes, self.parts, strict=True)
        )

    @property
    def mean_facets(self) -> float | None:
        """Mean number of facets of a particle, or ``None`` if unknown or for spheres."""
        if not self.n_facets or self.case.shapes == "spheres":
            return None
        return float(np.array(self.n_facets)[self.class_index].mean())

    @property
    def are_compounds(self) -> bool:
        """Whether particles of several convex parts are simulated."""
        return bool(self.parts) and self.case.shapes == "polyhedra"

    @property
    def further_parts(self) -> float:
        """Mean number of convex parts of a particle besides its first one; 0 for spheres."""
        if not self.are_compounds:
            return 0.0
        return float(np.array([len(counts) for counts in self.parts])[self.class_index].mean()) - 1.0

    @property
    def fill_height(self) -> float:
        """Expected height of the settled filling in metres."""
        volume = self.mass / self.case.contact.density
        return volume / SOLID_FRACTION / self.case.test.area

    @property
    def surface_energy(self) -> float:
        """Simulated surface energy in J/m^2."""
        contact = self.case.contact
        if self.case.bond_number > 0.0:
            gravity = self.case.test.gravity
            return self.case.bond_number / bond_number(1.0, self.mean_diameter, contact.density, gravity)
        given = contact.surface_energy
        ratio = self.coarse_graining / PAPER_COARSE_GRAINING
        return {"none": 0.0, "given": given, "scaled": given * ratio**2}[self.case.cohesion]


def with_number(prepared: PreparedCase, n_particles: int) -> PreparedCase:
    """The same mass in another number of particles, for estimates: particles are repeated or left out."""
    picks = np.resize(np.arange(len(prepared)), n_particles)
    factor = (len(prepared) / n_particles) ** (1 / 3)
    return replace(
        prepared,
        case=replace(prepared.case, n_particles=n_particles),
        class_index=prepared.class_index[picks],
        diameters=prepared.diameters[picks] * factor,
        coarse_graining=prepared.coarse_graining * factor,
    )


def prepare(dataset: Dataset, case: ReposeCase, dataset_hash: str = "") -> PreparedCase:
    """Draw the particles of a case.

    Raises InputError if the cylinder is too narrow or too low for them.
    """
    drawn = sample_dataset(dataset, case.n_particles, case.seed)
    fine = drawn.diameter * MICROMETRE
    mass = case.contact.density * np.pi / 6 * float((fine**3).sum())
    factor = case.coarse_graining or (case.test.mass / mass) ** (1 / 3)
    prepared = PreparedCase(
        case=case,
        shapes=tuple(each.shape.vertices for each in dataset.representatives),
        class_index=drawn.class_index,
        diameters=fine * factor,
        coarse_graining=float(factor),
        dataset_name=dataset.name,
        dataset_hash=dataset_hash,
        n_facets=tuple(each.shape.n_facets for each in dataset.representatives),
        **_compounds(dataset),
    )
    _check_room(prepared)
    return prepared


def _compounds(dataset: Dataset) -> dict[str, Any]:
    """The fields `parts` and `inertias` of a case."""
    shapes = [each.shape for each in dataset.representatives]
    if not any(isinstance(shape, ConvexCompound) for shape in shapes):
        return {}
    return {
        "parts": tuple(tuple(len(mesh.vertices) for mesh in shape.part_meshes) for shape in shapes),
        "inertias": tuple(shape.mesh.inertia for shape in shapes),
    }


def _check_room(prepared: PreparedCase) -> None:
    test, mean = prepared.case.test, prepared.mean_diameter
    widest = float(prepared.diameters.max())
    vessel = "cylinder" if prepared.case.drum is None else "drum"
    if test.diameter < max(MIN_DIAMETERS_ACROSS * mean, 1.5 * widest):
        raise InputError(
            f"The {vessel} is {1e3 * test.diameter:.3g} mm wide, but the particles are {1e3 * mean:.3g} mm "
            f"in the mean and up to {1e3 * widest:.3g} mm; take more particles, less mass, a wider {vessel}."
        )
    if prepared.fill_height > test.height:
        raise InputError(
            f"{1e3 * prepared.mass:.3g} g fill the {vessel} to {1e2 * prepared.fill_height:.3g} cm, but it "
            f"is only {1e2 * test.height:.3g} cm high."
        )
    share = prepared.fill_height / test.height
    if prepared.case.drum is not None and not MIN_DRUM_SHARE <= share <= MAX_DRUM_SHARE:
        raise InputError(
            f"{1e3 * prepared.mass:.3g} g fill {100 * share:.0f} % of the drum; a surface to measure needs "
            f"{100 * MIN_DRUM_SHARE:.0f} to {100 * MAX_DRUM_SHARE:.0f} %."
        )


@dataclass(frozen=True)
class ScalingReport:
    """Dimensions and dimensionless numbers of a prepared case. SI units.

    - ``mean_diameter``, ``coarse_graining``: of the simulated particles, and the ratio of their size to the
      dataset's.
    - ``diameters_across``: diameter of the cylinder in mean diameters; should be 20 or more.
    - ``fill_height``: expected, from the mass and a solid fraction of 55 %.
    - ``bond_number``: pull-off force of Johnson, Kendall and Roberts over weight, for two mean particles: of
      the particles of the dataset, of the simulated particles with the given surface energy, and as
      simulated.
    - ``full_stiffness_steps``: steps a simulated second of a code that resolves the contacts at the given
      Young's modulus (a fifth of Rayleigh's time of the smallest particle).
    - ``sentences``: sentences for the user.
    """

    mean_diameter: float
    coarse_graining: float
    diameters_across: float
    fill_height: float
    bond_number: tuple[float, float, float]
    full_stiffness_steps: float
    sentences: tuple[str, ...]


def pull_off_force(surface_energy: float, diameter: float) -> float:
    """3/2 pi w R* for two equal spheres (R* = d/4), in N."""
    return 1.5 * np.pi * surface_energy * diameter / 4


def bond_number(surface_energy: float, diameter: float, density: float, gravity: float) -> float:
    """Ratio of the pull-off force of two equal spheres and the weight of one."""
    return pull_off_force(surface_energy, diameter) / (density * np.pi / 6 * diameter**3 * gravity)


def rayleigh_time(diameter: float, density: float, youngs_modulus: float, poissons_ratio: float) -> float:
    """Rayleigh time of a sphere, in s."""
    shear = youngs_modulus / (2 * (1 + poissons_ratio))
    return float(np.pi * diameter / 2 * np.sqrt(density / shear) / (0.1631 * poissons_ratio + 0.8766))


def scaling_report(prepared: PreparedCase) -> ScalingReport:
    """The report of a prepared case."""
    test, contact = prepared.case.test, prepared.case.contact
    mean, factor = prepared.mean_diameter, prepared.coarse_graining
    real = mean / factor

    def bond(energy: float, diameter: float) -> float:
        return bond_number(energy, diameter, contact.density, test.gravity)

    bonds = (
        bond(contact.surface_energy, real),
        bond(contact.surface_energy, mean),
        bond(prepared.surface_energy, mean),
    )
    smallest = float(prepared.diameters.min())
    rayleigh = rayleigh_time(smallest, contact.density, contact.youngs_modulus, contact.poissons_ratio)
    return ScalingReport(
        mean_diameter=mean,
        coarse_graining=factor,
        diameters_across=test.diameter / mean,
        fill_height=prepared.fill_height,
        bond_number=bonds,
        full_stiffness_steps=1.0 / (0.2 * rayleigh),
        sentences=tuple(_sentences(prepared, bonds)),
    )


def _sentences(prepared: PreparedCase, bonds: tuple[float, float, float]) -> list[str]:
    test, mean, factor = prepared.case.test, prepared.mean_diameter, prepared.coarse_graining
    scale = Message(
        N_(
            "{count} particles of {size} mm represent {mass} g: {factor} times the size of the dataset's "
            "(the paper: {paper})."
        ),
        count=Number(len(prepared), ","),
        size=Number(1e3 * mean, ".2g"),
        mass=Number(1e3 * test.mass, ".3g"),
        factor=Number(factor, ".0f"),
        paper=Number(PAPER_COARSE_GRAINING, ".0f"),
    )
    sentences: list[str] = [scale]
    across = test.diameter / mean
    if across < 20:
        narrow = (
            N_("The cylinder is only {across} particles wide; walls and single particles matter.")
            if prepared.case.drum is None
            else N_("The drum is only {across} particles wide; walls and single particles matter.")
        )
        sentences.append(Message(narrow, across=Number(across, ".1f")))
    if len(prepared) < RELIABLE_N and prepared.case.drum is None:
        sentences.append(COARSE_PILE)
    low, high = PAPER_FILL_HEIGHT
    if prepared.case.drum is not None:
        filled = N_("The filling takes {share} % of the drum; its Froude number is {froude}.")
        share, froude = prepared.fill_height / test.height, prepared.case.drum.froude(test)
        sentences.append(Message(filled, share=Number(100 * share, ".0f"), froude=Number(froude, ".2g")))
    elif not 0.9 * low <= prepared.fill_height <= 1.1 * high:
        filled = N_("The filling will be about {height} cm high (the paper: 2.5 to 3 cm).")
        sentences.append(Message(filled, height=Number(100 * prepared.fill_height, ".2g")))
    real, given, simulated = bonds
    if prepared.case.contact.surface_energy > 0.0:
        sentences.append(
            Message(
                N_(
                    "Cohesion over weight is {real} for the dataset's particles and {given} for the "
                    "simulated ones at the given surface energy; this run has {simulated}."
                ),
                real=_plain(real),
                given=_plain(given),
                simulated=_plain(simulated),
            )
        )
    if prepared.case.contact.static_friction != prepared.case.contact.dynamic_friction:
        one = N_("The constraint solver has one coefficient of friction; it takes the static one.")
        sentences.append(Message(one))
    return sentences


def _plain(number: float) -> Number:
    """Two significant digits without exponents below 1000."""
    return Number(number, ".2g" if number < 100 else ".0f")
