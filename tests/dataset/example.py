"""A small dataset that tests write, read and break."""

from dataclasses import dataclass, field

import numpy as np

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset, Provenance
from regolith_studio.dataset.schema import CoarseningRecord
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.particle import Particle, Source
from tests.geometry.solids import rotation

SIDES = np.vstack([np.eye(3), -np.eye(3)])


@dataclass(frozen=True)
class Coarse:
    """What a coarsening method returns, as far as a dataset looks at it."""

    polyhedron: Polyhedron
    centre: FloatArray
    errors: dict[str, float] = field(default_factory=lambda: {"volume": 0.0, "sphericity": 0.021})
    jaccard_distance: float = 0.1
    loss: float = 0.3
    method: str = "annealing"
    n_facets_asked: int = 20
    reason: str | None = None


def polyhedron(seed: int, n_facets: int = 20, size: float = 40.0) -> ConvexPolyhedron:
    generator = np.random.default_rng(seed)
    normals = generator.standard_normal((n_facets, 3))
    normals = np.concatenate([normals, -normals.sum(axis=0, keepdims=True)])
    return ConvexPolyhedron.from_half_spaces(
        HalfSpaces(normals, size * generator.uniform(0.8, 1.2, n_facets + 1) * (1.0, *[1.3] * n_facets))
    )


def entry(seed: int, n_facets: int = 20) -> tuple[Particle, Coarse]:
    shape = polyhedron(seed, n_facets)
    centre = np.array([10.0, -20.0, 5.0])
    mesh = shape.mesh.moved(shift=centre)
    return Particle(f"grain-{seed}", mesh, "simulant", Source("grain.stl", "0" * 64, "um")), Coarse(
        shape, centre
    )


def cuboid(x: float, y: float, z: float) -> ConvexPolyhedron:
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(SIDES, np.array([x, y, z, x, y, z]) / 2))


def elbow() -> ConvexCompound:
    """Two bars of 6 x 2 x 1 at a right angle, which share a corner of 2 x 2 x 1: volume 20."""
    parts = (cuboid(6, 2, 1), cuboid(2, 6, 1))
    return ConvexCompound(parts, np.array([[3.0, 1.0, 0.5], [1.0, 3.0, 0.5]])).moved(rotation=rotation(5))


def elbow_entry(name: str = "elbow") -> tuple[Particle, Coarse]:
    shape = elbow()
    return Particle(name, shape.mesh), Coarse(shape, np.zeros(3), method="compound", n_facets_asked=12)


def elbow_moments() -> FloatArray:
    """Principal moments of inertia of the elbow at volume and density 1, ascending.

    A square of edge 6 less the square of edge 4 between the bars, of thickness 1, about their own centre.
    """
    x = (36 * 3 - 16 * 4) / 20
    second = (36 * (3 + 9) - 16 * (4 / 3 + 16)) / 20 - x * x
    mixed = (36 * 9 - 16 * 16) / 20 - x * x
    flat = np.linalg.eigvalsh([[second, mixed], [mixed, second]])
    return np.array([flat[0] + 1 / 12, flat[1] + 1 / 12, flat.sum()]) / 20 ** (2 / 3)


def example_dataset(count: int = 3, first: int = 0, name: str = "test set") -> Dataset:
    story = Provenance(
        description="A set for tests.",
        processing_steps=("Drew polyhedra.", "Aligned them."),
        seed=7,
        l_max=10,
        angular_power_spectrum_um2=(3.0, 0.2, 0.1),
        coarsening=CoarseningRecord(
            method="annealing",
            n_facets=20,
            seed=7,
            target="particle",
            preset=None,
            weights={"volume": 1.0},
            settings={"steps": 100},
        ),
        software={"regolith-studio": "0.1.0"},
    )
    return build_dataset([entry(first + index) for index in range(count)], name=name, provenance=story)
