"""A small dataset that tests write, read and break."""

from dataclasses import dataclass, field

import numpy as np

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import CoarseningRecord, Dataset, Provenance
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.particle import Particle, Source


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


def example_dataset(count: int = 3, first: int = 0, name: str = "test set") -> Dataset:
    story = Provenance(
        description="A set for tests.",
        processing_steps=("Drew polyhedra.", "Aligned them."),
        seed=7,
        l_max=10,
        angular_power_spectrum=(3.0, 0.2, 0.1),
        coarsening=CoarseningRecord("annealing", 20, 7, weights={"volume": 1.0}, settings={"steps": 100}),
        software={"regolith-studio": "0.1.0"},
    )
    return build_dataset([entry(first + index) for index in range(count)], name=name, provenance=story)
