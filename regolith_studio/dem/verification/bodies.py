"""Bodies and cases of the verification: bricks, cubes, polyhedra of 20 facets, and their dataset."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset, Frame, Representative
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dataset.size_distributions import DiscreteSizeDistribution
from regolith_studio.dem.case import PreparedCase, ReposeCase
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces

DIAMETER = 1e-3
"""Equivalent diameter of the bodies of a scene in metres."""
N_SHAPES, N_FACETS = 10, 20
"""Of the dataset that heaps are made of."""
AXES = (1.0, 0.8, 0.65)
"""Half axes of the ellipsoid that the facets of the polyhedra touch: those of a lunar grain."""
SIZES, NUMBERS = (80.0, 100.0, 120.0), (1.0, 1.0, 1.0)
"""Equivalent diameters in micrometres, equally frequent."""


def cuboid(a: float, b: float, c: float) -> ConvexPolyhedron:
    """A cuboid of unit volume whose edges have these ratios, centred at the origin."""
    half = np.array([a, b, c]) / (a * b * c) ** (1 / 3) / 2
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, np.concatenate([half, half])))


def random_polyhedron(seed: int) -> ConvexPolyhedron:
    """A polyhedron of :data:`N_FACETS` planes that touch an ellipsoid, spread by repulsion.

    Equal seeds give equal polyhedra; its centroid is not exactly at the origin.
    """
    normals = Rotation.random(N_FACETS, random_state=seed).apply([0.0, 0.0, 1.0])
    for _ in range(50):
        apart = normals[:, None] - normals
        distance = np.linalg.norm(apart, axis=2) + np.eye(N_FACETS)
        normals = normals + 0.05 * (apart / distance[:, :, None] ** 3).sum(axis=1)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, np.linalg.norm(normals * AXES, axis=1)))


def polyhedra_dataset() -> Dataset:
    """Ten polyhedra of 20 facets with three sizes."""
    sizes = DiscreteSizeDistribution.of(SIZES, NUMBERS)
    frame = Frame(np.eye(3), np.zeros(3), 100.0)
    share = 1.0 / N_SHAPES
    shapes = [_centred(random_polyhedron(seed)) for seed in range(N_SHAPES)]
    rows = [Representative(f"shape {k}", each, share, sizes, frame) for k, each in enumerate(shapes)]
    return Dataset("polyhedra of the verification", tuple(rows))


def scene(shapes: Sequence[ConvexPolyhedron], friction: float, n: int) -> PreparedCase:
    """A case of `n` bodies of one size, of the shapes in turn; to be placed by hand.

    Its cylinder is so wide that the plate of every engine is large enough for what slides or falls.
    """
    test = LiftingCylinderTest(diameter=60 * DIAMETER, plate_friction=friction, wall_friction=friction)
    contact = ContactParameters(static_friction=friction, dynamic_friction=friction)
    return PreparedCase(
        case=ReposeCase(test, contact),
        shapes=tuple(_centred(each).vertices for each in shapes),
        class_index=np.arange(n) % len(shapes),
        diameters=np.full(n, DIAMETER),
        coarse_graining=1.0,
        n_facets=tuple(each.n_facets for each in shapes),
    )


def lowest_heights(prepared: PreparedCase) -> FloatArray:
    """Height of each body's centre in mean diameters where it stands on the plate unturned, shape (n,)."""
    below = np.array([-shape[:, 2].min() for shape in prepared.shapes])[prepared.class_index]
    return np.asarray(below * prepared.scales / prepared.mean_diameter)


def _centred(shape: ConvexPolyhedron) -> ConvexPolyhedron:
    """The shape with unit volume and its centroid at the origin."""
    mesh = shape.mesh
    scale = mesh.volume ** (-1 / 3)
    spaces = shape.half_spaces
    return ConvexPolyhedron.from_half_spaces(
        HalfSpaces(spaces.normals, scale * (spaces.offsets - spaces.normals @ mesh.centroid))
    )
