"""The dataset of section 2.5 as a value: representative shapes P_i, class weights, size distributions.

A shape has unit volume, its centroid at the origin, and its principal axes along x, y and z.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.dataset.schema import Approximation, CoarseningRecord, Representation
from regolith_studio.dataset.size_distributions import (
    WEIGHT_TOLERANCE,
    SizeDistribution,
    Weighting,
    normalised_shares,
)
from regolith_studio.errors import DatasetError, GeometryError
from regolith_studio.geometry.arrays import FloatArray, LockedRecord, locked_floats
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Source


@dataclass(frozen=True, eq=False)
class Frame(LockedRecord):
    """Pose of a unit-volume shape in its particle: x_shape = rotation @ (x_particle - centroid) / scale.

    - ``rotation``: proper rotation, shape (3, 3); its rows are the shape's axes in the particle's frame.
    - ``centroid``: centre of mass of the polyhedron in the particle's frame, in micrometres, shape (3,).
    - ``scale``: cube root of the polyhedron's volume, in micrometres.
    """

    rotation: FloatArray
    centroid: FloatArray
    scale: float

    def __post_init__(self) -> None:
        rotation = locked_floats(self.rotation, (3, 3), "rotation")
        proper = np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-9) and np.linalg.det(rotation) > 0
        if not proper or not self.scale > 0.0:
            raise ValueError("a frame needs a proper rotation and a positive scale")
        object.__setattr__(self, "rotation", rotation)
        object.__setattr__(self, "centroid", locked_floats(self.centroid, (3,), "centroid"))


def aligned(polyhedron: Polyhedron, centre: FloatArray | None = None) -> tuple[Polyhedron, Frame]:
    """The polyhedron at unit volume about its centroid, longest axis along x, shortest along z; and its pose.

    ``polyhedron``: about an origin in its interior, in micrometres; of a compound the union is aligned.
    ``centre``: position of that origin in the particle's frame; (0, 0, 0) if not given.

    Raises GeometryError if the polyhedron encloses no volume.
    """
    if not polyhedron.volume > 0.0:
        raise GeometryError("The polyhedron encloses no volume.")
    scale = polyhedron.volume ** (1 / 3)
    rotation = principal_axes(polyhedron.mesh)
    moved = polyhedron.moved(shift=-polyhedron.centroid, rotation=rotation, scale=1.0 / scale)
    origin = np.zeros(3) if centre is None else np.asarray(centre, dtype=np.float64)
    frame = Frame(rotation, origin + polyhedron.centroid, scale)
    if isinstance(moved, ConvexPolyhedron):
        return rebuilt(moved.half_spaces), frame
    return ConvexCompound(tuple(rebuilt(part.half_spaces) for part in moved.parts), moved.places), frame


def rebuilt(half_spaces: HalfSpaces) -> ConvexPolyhedron:
    """The polyhedron of half-spaces, with numbers that a second reconstruction does not change.

    Normals are normalised until they no longer change, and redundant half-spaces are removed, so that a
    shape read from a file is bit for bit the one that was written.
    """
    solid = ConvexPolyhedron.from_half_spaces(half_spaces)
    # Normalising a unit vector may change its last bit; two or three times and it does not any more.
    for _ in range(10):
        if np.array_equal(solid.half_spaces.normals, half_spaces.normals):
            break
        half_spaces = solid.half_spaces
        solid = ConvexPolyhedron.from_half_spaces(half_spaces)
    return solid


def principal_axes(mesh: Mesh) -> FloatArray:
    """Rows: axes of minimum, intermediate and maximum moment of inertia, right-handed, shape (3, 3).

    Sign: the third moment of the mass along the first two axes is positive; for a symmetric shape their
    largest component is.
    """
    _, columns = np.linalg.eigh(mesh.inertia)
    axes = columns.T
    for axis in axes[:2]:
        skew = _third_moment(mesh, axis)
        # Of a symmetric shape the moment is rounding, whose sign differs from one processor to the next.
        lean = skew if abs(skew) > 1e-9 * abs(mesh.volume) ** 2 else axis[np.abs(axis).argmax()]
        axis *= np.sign(lean)
    axes[2] = np.cross(axes[0], axes[1])
    return np.asarray(axes)


def _third_moment(mesh: Mesh, axis: FloatArray) -> float:
    """Integral of <x - centroid, axis>^3 over the solid: signed tetrahedra about the centroid."""
    corners = mesh.triangles - mesh.centroid
    six_volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    a, b, c = (corners @ axis).T
    homogeneous = (a + b + c) * (a * a + b * b + c * c) + a * b * c
    return float(six_volumes @ homogeneous / 120)


SHAPE_TOLERANCE = 1e-9
"""Tolerance of a shape's volume (1) and centroid (the origin)."""


@dataclass(frozen=True)
class Representative:
    """One class i of a dataset.

    - ``name``: of the chosen particle; unique within the dataset.
    - ``shape``: unit volume, centroid at the origin, principal axes along x, y, z; those of the union of a
      compound.
    - ``weight``: alpha_i.
    - ``sizes``: f_i, of equivalent diameters in micrometres.
    - ``frame``: pose of the shape in its particle.
    - ``n_members``: number of particles that the class stands for.
    - ``approximation``: how the particle was coarsened, or ``None`` if it was a polyhedron already.
    - ``group``, ``source``: of the particle.
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

        Raises DatasetError if it is a compound.
        """
        if isinstance(self.shape, ConvexPolyhedron):
            return self.shape
        raise DatasetError(
            f"{self.name} is a compound of {self.shape.n_parts} convex parts, not one convex polyhedron."
        )


@dataclass(frozen=True)
class Provenance:
    """Origin of a dataset (the metadata of section 2.5).

    - ``description``: free text.
    - ``processing_steps``: one sentence a step, in order.
    - ``seed``: of the random numbers.
    - ``model``: stochastic model of the shapes, or ``None`` for measured ones.
    - ``l_max``: highest degree of the spherical harmonics.
    - ``angular_power_spectrum_um2``: a_l for l = 0..l_max, in square micrometres: variance per order at
      degree l (real orthonormal harmonics).
    - ``coarsening``: settings of the coarsening.
    - ``representation``: how well the shapes reproduce the population, if they were chosen from one.
    - ``software``: versions by package name.
    """

    description: str = ""
    processing_steps: tuple[str, ...] = ()
    seed: int | None = None
    model: str | None = None
    l_max: int | None = None
    angular_power_spectrum_um2: tuple[float, ...] | None = None
    coarsening: CoarseningRecord | None = None
    representation: Representation | None = None
    software: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Dataset:
    """Representative particles with weights and sizes.

    - ``name``: chosen by the user.
    - ``representatives``: at least one; their weights add up to 1.
    - ``weighting``: whether the class weights count particles or their volume.
    - ``provenance``: origin of the data.
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
