"""The dataset of section 2.5 as a value: representative shapes P_i, class weights, size distributions."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.dataset.alignment import Frame
from regolith_studio.dataset.size_distributions import (
    WEIGHT_TOLERANCE,
    SizeDistribution,
    Weighting,
    normalised_shares,
)
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.particle import Source

SHAPE_TOLERANCE = 1e-9
"""Tolerance of a shape's volume (1) and centroid (the origin)."""

Setting = bool | int | float | str | None


@dataclass(frozen=True)
class Approximation:
    """How a shape approximates its particle.

    Parameters
    ----------
    method
        Key of the coarsening method.
    n_facets_asked
        Requested number of facets; the shape has the real one.
    errors
        Relative error of each descriptor of the loss (Eq. 8).
    jaccard_distance
        Eq. 7 (the paper's IoU): 0 same, 1 disjoint.
    loss
        Eq. 9.
    reason
        Why a request was not met, in one sentence, or ``None``.
    """

    method: str
    n_facets_asked: int
    errors: Mapping[str, float]
    jaccard_distance: float
    loss: float
    reason: str | None = None


@dataclass(frozen=True)
class Representative:
    """One class i of a dataset.

    Parameters
    ----------
    name
        Of the chosen particle; unique within the dataset.
    shape
        Unit volume, centroid at the origin, principal axes along x, y, z; those of the union of a compound.
    weight
        alpha_i.
    sizes
        F_i, of equivalent diameters in micrometres.
    frame
        Pose of the shape in its particle.
    n_members
        Number of particles that the class stands for.
    approximation
        How the particle was coarsened, or ``None`` if it was a polyhedron already.
    group, source
        Of the particle.
    """

    name: str
    shape: Polyhedron
    weight: float
    sizes: SizeDistribution
    frame: Frame
    n_members: int = 1
    approximation: Approximation | None = None
    group: str = ""
    source: Source | None = None

    def __post_init__(self) -> None:
        volume, centroid = self.shape.volume, self.shape.centroid
        if abs(volume - 1.0) > SHAPE_TOLERANCE or np.abs(centroid).max() > SHAPE_TOLERANCE:
            raise ValueError(
                f"the shape of {self.name} must have unit volume and its centroid at the origin, "
                f"got {volume!r} and {centroid.tolist()}"
            )

    @property
    def convex(self) -> ConvexPolyhedron:
        """The shape, if it is a single convex polyhedron.

        Raises
        ------
        DatasetError
            If it is a compound.
        """
        if isinstance(self.shape, ConvexPolyhedron):
            return self.shape
        raise DatasetError(
            f"{self.name} is a compound of {self.shape.n_parts} convex parts, not one convex polyhedron."
        )


@dataclass(frozen=True)
class CoarseningRecord:
    """Settings of the coarsening of all shapes.

    Parameters
    ----------
    method, seed
        Of the method, and of its random numbers.
    n_facets
        Requested; if `max_error` is given, the upper limit.
    target
        ``particle`` or ``fit``: which surface was approximated.
    preset, weights
        Name of the preset, if one was used, and the loss weights of Eq. 9.
    settings
        Of the method, by name.
    max_error
        If given, each shape has the minimum number of facets with all weighted relative errors below it.
    """

    method: str
    n_facets: int
    seed: int
    target: str = "particle"
    preset: str | None = None
    weights: Mapping[str, float] = field(default_factory=dict)
    settings: Mapping[str, Setting] = field(default_factory=dict)
    max_error: float | None = None


@dataclass(frozen=True)
class Representation:
    """How well a dataset reproduces the population that its representatives were chosen from.

    Parameters
    ----------
    n_particles
        Of the population.
    errors
        Of the shapes in the dataset: Wasserstein distance per descriptor, in standard deviations of the
        population.
    source_errors
        The same of the particles that the shapes were made from.
    sampling_noise
        The same between the population and its material.
    population
        Quantiles of each descriptor of the population, at even shares.
    deviations
        Standard deviation of each descriptor of the population.
    """

    n_particles: int
    errors: Mapping[str, float]
    source_errors: Mapping[str, float]
    sampling_noise: Mapping[str, float]
    population: Mapping[str, tuple[float, ...]]
    deviations: Mapping[str, float]


@dataclass(frozen=True)
class Provenance:
    """Origin of a dataset (the metadata of section 2.5).

    Parameters
    ----------
    description
        Free text.
    processing_steps
        One sentence a step, in order.
    seed
        Of the random numbers.
    model
        Stochastic model of the shapes, or ``None`` for measured ones.
    l_max
        Highest degree of the spherical harmonics.
    angular_power_spectrum
        A_l for l = 0..l_max, in square micrometres: variance per order at degree l (real orthonormal
        harmonics).
    coarsening
        Settings of the coarsening.
    representation
        How well the shapes reproduce the population, if they were chosen from one.
    software
        Versions by package name.
    """

    description: str = ""
    processing_steps: tuple[str, ...] = ()
    seed: int | None = None
    model: str | None = None
    l_max: int | None = None
    angular_power_spectrum: tuple[float, ...] | None = None
    coarsening: CoarseningRecord | None = None
    representation: Representation | None = None
    software: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Dataset:
    """Representative particles with weights and sizes.

    Parameters
    ----------
    name
        Chosen by the user.
    representatives
        At least one; their weights add up to 1.
    weighting
        Whether the class weights count particles or their volume.
    provenance
        Origin of the data.
    """

    name: str
    representatives: tuple[Representative, ...]
    weighting: Weighting = "number"
    provenance: Provenance = field(default_factory=Provenance)

    def __post_init__(self) -> None:
        names = [representative.name for representative in self.representatives]
        if not names:
            raise ValueError("a dataset needs at least one representative")
        if len(set(names)) != len(names):
            raise ValueError("representatives must have different names")
        if (
            min(r.weight for r in self.representatives) < 0.0
            or abs(self.weights.sum() - 1.0) > WEIGHT_TOLERANCE
        ):
            raise ValueError(f"weights must not be negative and add up to 1, got {self.weights.tolist()}")

    def __len__(self) -> int:
        return len(self.representatives)

    @property
    def weights(self) -> FloatArray:
        """Class weights alpha_i as given, shape (n,)."""
        return np.array([representative.weight for representative in self.representatives])

    @property
    def compounds(self) -> tuple[Representative, ...]:
        """The representatives whose shapes are unions of convex parts."""
        return tuple(one for one in self.representatives if isinstance(one.shape, ConvexCompound))

    def class_weights(self, weighting: Weighting) -> FloatArray:
        """Class weights that count particles (``number``) or their volume, shape (n,)."""
        if weighting == self.weighting:
            return self.weights
        cubes = np.array([representative.sizes.mean_cube() for representative in self.representatives])
        factors = cubes / cubes.max() if weighting == "volume" else cubes.min() / cubes
        return np.array(normalised_shares(self.weights * factors))
